"""Compliance and root stress over load positions, and root stress along the fillets."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.output.pictures.style import BLACK, BLUE, GREEN, ORANGE, RED, Picture, figure, in_house_style, save

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from fegear.engine.outcome import Table
    from fegear.geometry import Gear

    Array = NDArray[np.float64]


def _shown(table: Table) -> dict[str, Array]:
    return {column.name: cast("Array", column.shown) for column in table.columns}


def _radius_axis(axes: Axes, gear: Gear) -> None:
    """Second scale at the top: the load radius that belongs to a roll angle."""
    rb = gear.base_radius * 1e3

    def radius(roll: ArrayLike) -> Array:
        return rb * np.hypot(1.0, np.deg2rad(np.asarray(roll, dtype=float)))

    def roll(r: ArrayLike) -> Array:
        return np.rad2deg(np.sqrt(np.maximum((np.asarray(r, dtype=float) / rb) ** 2 - 1.0, 0.0)))

    axes.secondary_xaxis("top", functions=(radius, roll)).set_xlabel("load radius [mm]")


def _mark_pitch(axes: Axes, gear: Gear, order: Array) -> None:
    pitch = np.rad2deg(np.sqrt((gear.pitch_radius / gear.base_radius) ** 2 - 1.0))
    if order.min() <= pitch <= order.max():
        axes.axvline(pitch, color="0.5", lw=0.9, ls=":")
        axes.annotate(
            "pitch point", (pitch, 1.0), xycoords=("data", "axes fraction"), xytext=(3, -10),
            textcoords="offset points", fontsize=8, color="0.4",
        )  # fmt: skip


def _curve(axes: Axes, x: Array, y: Array, error: Array, colour: str, style: str, label: str) -> None:
    marker = "o" if x.size < 12 else ""
    axes.plot(x, y, style, color=colour, marker=marker, ms=4, label=label)
    axes.fill_between(x, y - error, y + error, color=colour, alpha=0.25, lw=0)


@in_house_style
def draw_compliance(gear: Gear, table: Table, path: Path, name: str) -> Picture:
    """Draw c_0 and c_1 against roll angle."""
    t = _shown(table)
    order = np.argsort(t["roll_angle"])
    t = {key: values[order] for key, values in t.items()}
    made, (top, bottom) = figure(2, 1, size=(7.2, 6.0), sharex=True)
    roll = t["roll_angle"]
    _curve(top, roll, t["c_self"], t["c_self_error"], BLUE, "-", "$c_0$, loaded tooth at the contact")
    _curve(bottom, roll, t["c_next"], t["c_neighbour_error"], ORANGE, "-", "$c_{+1}$, next tooth")
    _curve(bottom, roll, t["c_prev"], t["c_neighbour_error"], GREEN, "--", "$c_{-1}$, previous tooth")
    for axes in (top, bottom):
        axes.set_ylabel("compliance [µm·mm/N]")
        _mark_pitch(axes, gear, roll)
        axes.legend(loc="best", fontsize=9)
    bottom.set_xlabel("roll angle [deg]")
    _radius_axis(top, gear)
    worst = float(np.max(np.abs(t["c_self_error"] / t["c_self"])))
    width = f"{t['contact_half_width'].min():.4g}"
    if t["contact_half_width"].max() > 1.0001 * t["contact_half_width"].min():
        width += f" to {t['contact_half_width'].max():.4g}"
    caption = (
        f"Gear {name}: deflection per line load of the loaded tooth and of its neighbours at the same radius, "
        f"whole ring, contact half-width {width} mm. Estimated error of c_0 at most {worst:.1e} of it."
    )
    return save(made, path, f"Compliance of gear {name}", caption)


@in_house_style
def draw_root_stress(gear: Gear, table: Table, path: Path, name: str) -> Picture:
    """Draw the largest root stresses against load position."""
    t = _shown(table)
    order = np.argsort(t["roll_angle"])
    t = {key: values[order] for key, values in t.items()}
    roll = t["roll_angle"]
    made, axes = figure()
    _curve(axes, roll, t["root_tension"], t["root_tension_error"], RED, "-", "tension, fillet below the loaded flank")
    compression = -t["root_compression"]
    _curve(axes, roll, compression, t["root_compression_error"], BLUE, "--", "compression, other fillet (magnitude)")
    axes.set_ylabel("largest root stress per line load\n[MPa·mm/N]")
    axes.set_xlabel("roll angle of the load [deg]")
    axes.set_ylim(bottom=min(0.0, float(compression.min())))
    axes.legend(loc="best", fontsize=9)
    _mark_pitch(axes, gear, roll)
    _radius_axis(axes, gear)
    i = int(np.argmax(t["root_tension"]))
    caption = (
        f"Gear {name}: largest tangential fillet stress per line load. At its largest the tension sits at radius "
        f"{t['root_tension_radius'][i]:.5g} mm, where the fillet's tangent makes {t['root_tension_angle'][i]:.1f} deg "
        "with the tooth's centre line (ISO 6336-3 looks at 30 deg)."
    )
    return save(made, path, f"Root stress of gear {name}", caption)


@in_house_style
def draw_fillet(table: Table, radius: float, path: Path, name: str) -> Picture:
    """Draw the stress along both fillets for one load position."""
    t = _shown(table)
    made, (left, right) = figure(1, 2, size=(9.6, 4.2), sharey=True)
    for axes, side, colour, title in (
        (left, "tension", RED, "Fillet below the loaded flank"),
        (right, "compression", BLUE, "Fillet of the other flank"),
    ):
        here = t["side"] == side
        arc, tangent = t["arc"][here], t["tangent_angle"][here]
        axes.plot(arc, t["stress"][here], color=colour, label="loaded tooth")
        axes.plot(arc, t["stress_next"][here], "--", color=ORANGE, label="next tooth")
        axes.plot(arc, t["stress_prev"][here], ":", color=GREEN, label="previous tooth")
        if tangent.min() < 30.0 < tangent.max():
            at = float(np.interp(-30.0, -tangent, arc))
            axes.axvline(at, color="0.5", lw=0.9, ls=":")
            axes.annotate(
                "30° tangent", (at, 0.0), xycoords=("data", "axes fraction"), xytext=(3, 4),
                textcoords="offset points", fontsize=8, color="0.4",
            )  # fmt: skip
        axes.axhline(0.0, color=BLACK, lw=0.6)
        axes.set_xlabel("arc length from the root land [mm]")
        axes.set_title(title)
        axes.legend(loc="best", fontsize=9)
    left.set_ylabel("tangential stress per line load\n[MPa·mm/N]")
    caption = f"Gear {name}: tangential stress along both fillets with the load at radius {radius * 1e3:.6g} mm."
    return save(made, path, f"Stress along the fillets of gear {name}", caption)
