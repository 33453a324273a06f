"""Designed reliefs, what they leave, Harris maps, charts of tip reliefs and their robustness."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.loaded_teeth import chosen, legend, load_colours, load_label
from fegear.output.pictures.style import (
    BLACK,
    BLUE,
    DASHES,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    Picture,
    figure,
    in_house_style,
    save,
)

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.results.relief import ReliefData
    from fegear.results.relief_chart import ReliefChartData, RobustnessData

    Array = NDArray[np.float64]

_MOST_PANELS = 4
_LOOKS = {
    "no relief": (BLACK, ":"),
    "designed": (BLUE, "-"),
    "diagonal only": (RED, "--"),
    "linear tip relief": (ORANGE, "-."),
    "parabolic tip relief": (GREEN, (0, (5, 1, 1, 1, 1, 1))),
    "relief of the case": (PURPLE, "--"),
}


@in_house_style
def draw_reliefs(data: ReliefData, path: Path, name: str, gears: dict[str, str]) -> Picture:
    """Draw the relief of both gears with what a shop can grind."""
    from fegear.design import minimum_excitation

    diagonal = minimum_excitation(data.designed, data.loading, data.load, full_matrix=False)
    made, both = figure(1, 2, size=(10.0, 4.4), sharey=True)
    for axes, (member, table) in zip(both, data.tables.items(), strict=True):
        roll = np.rad2deg(table.roll_angle)
        colour, style = _LOOKS["designed"]
        axes.plot(roll, table.relief * 1e6, style, color=colour, label="designed")
        if "diagonal only" in data.te:
            plain = diagonal.driver_relief if member == "driver" else diagonal.driven_relief
            colour, style = _LOOKS["diagonal only"]
            axes.plot(roll, plain.removal(table.roll_angle) * 1e6, style, color=colour, label="diagonal only")
        for shape, ground in data.ground.items():
            relief = ground.driver if member == "driver" else ground.driven
            colour, style = _LOOKS[f"{shape} tip relief"]
            axes.plot(roll, relief.removal(table.roll_angle) * 1e6, ls=style, color=colour, label=f"{shape} tip relief")
        axes.set_title(f"{member}: gear {gears[member]}")
        axes.set_xlabel("roll angle [deg]")
        loaded = roll[table.load > 0.0]
        axes.axvspan(loaded.min(), loaded.max(), color="0.5", alpha=0.08, lw=0)
    both[0].set_ylabel("material to remove [µm]")
    legend(both[1], 2)
    caption = (
        f"Pair {name}: relief of both gears for {data.load:.5g} N over the active profile. Shaded: the design zone, "
        "where the tooth is loaded at the design load. Ground reliefs are at the tips only; a constant over the whole "
        "flank makes no difference."
    )
    return save(made, path, f"Profile relief of {name}", caption)


@in_house_style
def draw_candidates(data: ReliefData, path: Path, name: str) -> Picture:
    """Draw the transmission error that each candidate leaves at the design load."""
    made, axes = figure(size=(8.6, 4.4))
    for label, curve in data.curves.items():
        i = int(np.argmin(np.abs(curve.load - data.load)))
        te = curve.transmission_error[:, i] * 1e6
        colour, style = _LOOKS[label]
        left = data.te[label].peak_to_peak * 1e6
        told = f"{left:.3g} µm" if left > 1e-6 else "0"
        axes.plot(curve.x * 1e3, te - data.te[label].mean * 1e6, ls=style, color=colour, label=f"{label}: {told}")
    axes.set_xlabel("roll position over one base pitch [mm]")
    axes.set_ylabel("transmission error less its mean [µm]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=9, title="peak to peak")
    caption = f"Pair {name}: what each relief leaves of the transmission error at the design load, {data.load:.5g} N."
    if "diagonal only" in data.te:
        caption += (
            " Diagonal only: relief designed without the neighbours' loads (Mark, Eq. 5.4), on teeth that do deflect "
            "each other."
        )
    return save(made, path, f"Transmission error with and without relief, {name}", caption)


@in_house_style
def draw_harris(data: ReliefData, path: Path, name: str) -> Picture:
    """Draw Harris maps without relief, with the designed one and with the best ground one."""
    shown = ["no relief", "designed"]
    if data.ground:
        best = min(data.ground, key=lambda shape: data.te[f"{shape} tip relief"].peak_to_peak)
        shown.append(f"{best} tip relief")
    made, panels = figure(1, len(shown), size=(3.4 * len(shown) + 1.4, 4.2), sharey=True)
    for axes, label in zip(panels, shown, strict=True):
        curve = data.curves[label]
        loads = [float(w) for w in curve.load]
        picked = chosen(loads, data.load)
        for colour, i in zip(load_colours(len(picked)), picked, strict=True):
            text = f"{loads[i]:.5g} N" + (" (design)" if loads[i] == data.load else "")
            axes.plot(curve.x * 1e3, curve.transmission_error[:, i] * 1e6, color=colour, label=text)
        axes.set_title(label)
    panels[0].set_ylabel("transmission error [µm]")
    panels[len(shown) // 2].set_xlabel("roll position over one base pitch [mm]")
    panels[0].set_ylim(bottom=min(0.0, panels[0].get_ylim()[0]))
    legend(panels[-1], 2)
    caption = f"Pair {name}: Harris maps, transmission error over the mesh cycle for a family of loads."
    return save(made, path, f"Harris map of {name}", caption)


@in_house_style
def draw_chart(data: ReliefChartData, path: Path, name: str) -> Picture | None:
    """Draw A_e over amount and length for several loads with the optimum line; None without enough candidates."""
    from matplotlib.ticker import MaxNLocator

    chart = data.chart
    if chart.amounts.size < 2 or chart.lengths.size < 3:
        return None
    picked = sorted({round(i) for i in np.linspace(0, chart.loads.size - 1, min(_MOST_PANELS, chart.loads.size))})
    columns = min(2, len(picked))
    rows = math.ceil(len(picked) / columns)
    made, panels = figure(
        rows, columns, size=(4.6 * columns + 1.2, 3.4 * rows + 0.6), sharex=True, sharey=True, squeeze=False
    )
    values = chart.effective_error[:, :, picked] * 1e6
    levels = MaxNLocator(14).tick_values(float(values.min()), float(values.max()))
    optimum = chart.optimum_lengths()
    shown = None
    for axes, i in zip(panels.ravel(), picked, strict=False):
        shown = axes.contourf(
            chart.lengths, chart.amounts * 1e6, chart.effective_error[:, :, i] * 1e6, levels, cmap="viridis"
        )
        inside = (optimum[:, i] > chart.lengths[0]) & (optimum[:, i] < chart.lengths[-1])
        axes.plot(optimum[inside, i], chart.amounts[inside] * 1e6, color="white", lw=2.2, label="optimum length")
        axes.axhline(data.delta * 1e6, color="white", lw=0.9, ls=":")
        axes.set_title(load_label(float(chart.loads[i]), data.pair.nominal))
        axes.grid(visible=False)
    for axes in panels.ravel()[len(picked) :]:
        axes.set_visible(False)
    made.supxlabel("length of tip relief (1: tip to HPSTC on the line of action)", fontsize=10)
    made.supylabel("amount at both tips [µm]", fontsize=10)
    if shown is not None:
        made.colorbar(shown, ax=panels, label="effective transmission error A_e [µm]", format="%.3g")
    caption = (
        f"Pair {name}: effective error A_e (NASA TM-89901) with equal tip relief on both gears. White: length with "
        f"the least A_e for each amount. Dotted: Delta = {data.delta * 1e6:.4g} µm, the largest transmission error "
        f"without relief at {data.pair.nominal:.5g} N."
    )
    return save(made, path, f"Chart of tip reliefs of {name}", caption)


@in_house_style
def draw_robustness(data: RobustnessData, path: Path, name: str, metric: str) -> Picture:
    """Draw the worst excitation over the load for every candidate."""
    made, axes = figure(size=(8.6, 4.2))
    for (label, r), dash in zip(data.candidates.items(), (*DASHES, *DASHES), strict=False):
        colour, _ = _LOOKS[label]
        order = np.argsort(r.load_factors)
        worst = r.values.max(axis=(1, 2))[order] * 1e6
        best = r.values.min(axis=(1, 2))[order] * 1e6
        factors = r.load_factors[order]
        axes.plot(factors, best, dash, color=colour, lw=0.9)
        axes.plot(factors, worst, dash, color=colour, marker="o", ms=4, label=label)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("load over design load")
    axes.set_ylabel(("peak-to-peak" if metric == "peak_to_peak" else "effective") + " transmission error [µm]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=9, title="worst (thick), least (thin)")
    caption = f"Pair {name}: worst (thick) and least (thin) of all combinations of spacing error and relief tolerance."
    return save(made, path, f"Robustness of the reliefs of {name}", caption)
