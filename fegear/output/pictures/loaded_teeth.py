"""Load share, Hertzian pressure, transmission error, mesh stiffness, harmonics and root stress of a loaded pair."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import BLUE, DASHES, GREEN, ORANGE, PURPLE, RED, Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fegear.geometry import GearPair
    from fegear.results.load_sharing import LoadSharingData
    from fegear.results.root_stress_history import RootStressData
    from fegear.results.transmission_error import TransmissionErrorData

    Array = NDArray[np.float64]

#: Loads drawn at most: more curves cannot be told apart.
MOST_CURVES = 6
_HARMONICS_SHOWN = 16


def chosen(loads: tuple[float, ...] | list[float], nominal: float) -> list[int]:
    """Which loads are drawn: all, or evenly many of them with the nominal one."""
    n = len(loads)
    if n <= MOST_CURVES:
        return list(range(n))
    few = {round(i) for i in np.linspace(0, n - 1, MOST_CURVES)}
    return sorted(few | {int(np.argmin(np.abs(np.array(loads) - nominal)))})


def load_colours(count: int) -> list[tuple[float, float, float, float]]:
    """One colour for each load, from light to dark, told apart in grey too."""
    from matplotlib import colormaps

    if count == 1:
        return [colormaps["viridis_r"](0.7)]
    return [colormaps["viridis_r"](0.15 + 0.8 * i / (count - 1)) for i in range(count)]


def load_label(load: float, nominal: float) -> str:
    """``1615 N``, with a word where it is the nominal load of several."""
    return f"{load:.5g} N" + (" (nominal)" if load == nominal else "")


def legend(axes: Axes, count: int) -> None:
    """Put the legend to the right of the axes, where no curve is, if there is more than one curve."""
    if count > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=9)


def _mark_ends(axes: Axes, pair: GearPair) -> None:
    """Ends of the path of contact."""
    for x in (pair.x_start, pair.x_end):
        axes.axvline(x * 1e3, color="0.5", lw=0.9, ls=":")


@in_house_style
def draw_load_sharing(data: LoadSharingData, path: Path, name: str) -> Picture:
    """Draw load and pressure of one tooth pair from first to last contact."""
    h, loads = data.history, data.pair.loads
    made, (top, bottom) = figure(2, 1, size=(8.2, 6.2), sharex=True)
    picked = chosen(loads, data.pair.nominal)
    for colour, i in zip(load_colours(len(picked)), picked, strict=True):
        top.plot(h.x * 1e3, h.load[:, i], color=colour, label=load_label(loads[i], data.pair.nominal))
        bottom.plot(h.x * 1e3, h.hertz_pressure[:, i] * 1e-6, color=colour)
    top.set_ylabel("load on the pair [N]")
    bottom.set_ylabel("largest Hertzian pressure [MPa]")
    bottom.set_xlabel("position on the line of action from the pitch point [mm]")
    for axes in (top, bottom):
        _mark_ends(axes, data.pair.engagement.pair)
        axes.set_ylim(bottom=0.0)
    legend(top, len(picked))
    caption = (
        f"Pair {name}: one tooth pair from its first to its last contact; dotted: ends of the path of contact"
        + (", beyond which tip corners touch. " if data.pair.engagement.corner_contact else ". ")
        + f"Compliances: {'; '.join(data.pair.sources)}."
    )
    return save(made, path, f"Load on a tooth pair of {name}", caption)


@in_house_style
def draw_te(data: TransmissionErrorData, path: Path, name: str) -> Picture:
    """Draw transmission error (for all loads) and mesh stiffness over one base pitch."""
    pair, curve = data.pair, data.curve
    made, (top, bottom) = figure(2, 1, size=(8.2, 6.2), sharex=True)
    picked = chosen(pair.loads, pair.nominal)
    x = curve.x * 1e3
    for colour, i in zip(load_colours(len(picked)), picked, strict=True):
        te = curve.transmission_error[:, i] * 1e6
        top.plot(x, te, color=colour, label=load_label(pair.loads[i], pair.nominal))
    i = pair.loads.index(pair.nominal)
    bottom.plot(x, data.stiffness[:, i] * 1e-6, color=BLUE, label="secant")
    bottom.plot(x, curve.local_stiffness[:, i] * 1e-6, DASHES[1], color=ORANGE, label="local slope")
    top.set_ylabel("transmission error [µm]")
    bottom.set_ylabel("mesh stiffness [N/µm]")
    bottom.set_xlabel("roll position over one base pitch [mm]")
    bottom.set_ylim(bottom=0.0)
    legend(top, len(picked))
    legend(bottom, 2)
    te_exact = data.exact[i]
    caption = (
        f"Pair {name}: loaded transmission error over one base pitch (Harris map of its loads), and the mesh stiffness "
        f"at {pair.nominal:.5g} N: mean {te_exact.average_stiffness * 1e-6:.4g} N/µm by the local slope. Peak to peak "
        f"{te_exact.peak_to_peak * 1e6:.3g} µm, effective error A_e {te_exact.effective_error * 1e6:.3g} µm."
    )
    return save(made, path, f"Transmission error of {name}", caption)


@in_house_style
def draw_harmonics(data: TransmissionErrorData, path: Path, name: str) -> Picture:
    """Draw the amplitudes of the tooth-mesh harmonics."""
    pair = data.pair
    picked = chosen(pair.loads, pair.nominal)
    made, axes = figure(size=(8.2, 4.0))
    width = 0.8 / len(picked)
    n = np.arange(1, _HARMONICS_SHOWN + 1)
    for place, (colour, i) in enumerate(zip(load_colours(len(picked)), picked, strict=True)):
        amplitude = data.exact[i].series.amplitude[:_HARMONICS_SHOWN] * 1e6
        at = n + (place - 0.5 * (len(picked) - 1)) * width
        axes.bar(at, amplitude, width, color=colour, label=load_label(pair.loads[i], pair.nominal))
    axes.set_xticks(n)
    axes.set_xlabel("harmonic of the tooth-mesh frequency")
    axes.set_ylabel("amplitude of the transmission error [µm, 0-peak]")
    legend(axes, len(picked))
    caption = f"Pair {name}: harmonics of the static transmission error, integrated exactly between its jumps."
    return save(made, path, f"Harmonics of the transmission error of {name}", caption)


@in_house_style
def draw_root_stress(data: RootStressData, path: Path, name: str, gears: dict[str, str]) -> Picture:
    """Draw the root stress of a tooth of either gear on its way through the mesh."""
    pair = data.pair
    i = pair.loads.index(pair.nominal)
    made, axes = figure(size=(8.2, 4.4))
    for (member, s), colour, style in zip(data.stress.items(), (RED, BLUE), DASHES, strict=False):
        x, label = s.x * 1e3, f"{member} {gears[member]}"
        axes.plot(x, s.tension[:, i] * 1e-6, style, color=colour, label=f"{label}, tension")
        low, high = (s.tension[:, i] - s.tension_error[:, i]) * 1e-6, (s.tension[:, i] + s.tension_error[:, i]) * 1e-6
        axes.fill_between(x, low, high, color=colour, alpha=0.25, lw=0)
        other = PURPLE if member == "driver" else GREEN
        axes.plot(x, s.compression[:, i] * 1e-6, style, color=other, label=f"{label}, compression", lw=1.2)
    axes.axhline(0.0, color="0.3", lw=0.6)
    _mark_ends(axes, pair.engagement.pair)
    axes.set_xlabel("position of the tooth's contact on the line of action [mm]")
    axes.set_ylabel("largest root stress [MPa]")
    legend(axes, 4)
    largest = {member: s.tension[:, i].max() * 1e-6 for member, s in data.stress.items()}
    told = " and ".join(f"{value:.4g} MPa ({member})" for member, value in largest.items())
    caption = (
        f"Pair {name} at {pair.nominal:.5g} N: fillet stress of one tooth, its own load and its neighbours' added. "
        f"Dotted: ends of the path of contact. Largest tension {told}."
    )
    return save(made, path, f"Root stress through the mesh, {name}", caption)
