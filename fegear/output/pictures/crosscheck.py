"""Every closed form beside the finite elements over load positions: value, ratio, place."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.output.pictures.style import (
    BLACK,
    BLUE,
    DASHES,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    Picture,
    figure,
    in_house_style,
    save,
)

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from fegear.engine.outcome import Table

    Array = NDArray[np.float64]

_COLOURS = (BLUE, ORANGE, GREEN, RED, SKY, PURPLE)
#: With no more positions than this every one is marked.
_FEW = 12
#: The band around agreement that is shaded.
_BAND = 0.05


def _formulas(table: Table) -> list[str]:
    return list(dict.fromkeys(str(name) for name in table["formula"]))


def _draw(axes: Axes, table: Table, column: str, scale: float, fe: Array | None, x: Array, *, label: bool) -> None:
    """Draw a column by formula over x; `fe` in black, as wide as one formula's rows."""
    names, every = _formulas(table), np.asarray(table[column], dtype=float) * scale
    rows = every.reshape(len(names), -1)
    marker = "o" if rows.shape[1] <= _FEW else ""
    if fe is not None:
        axes.plot(x, fe, "-", color=BLACK, lw=2.6, marker=marker, ms=5, label="finite elements" if label else None)
    for i, (name, row) in enumerate(zip(names, rows, strict=True)):
        style = DASHES[i % len(DASHES)]
        axes.plot(x, row, style, color=_COLOURS[i % 6], marker=marker, ms=4, label=name if label else None)


def _ratio(axes: Axes, table: Table, x: Array) -> None:
    axes.axhspan(1.0 - _BAND, 1.0 + _BAND, color="0.92", zorder=0)
    axes.axhline(1.0, color=BLACK, lw=1.2)
    _draw(axes, table, "ratio_to_fe", 1.0, None, x, label=False)
    axes.set_ylabel("formula / FE\n(grey: ±5 %)")


def _first(table: Table, column: str, scale: float) -> Array:
    return np.asarray(table[column], dtype=float)[: len(table["formula"]) // len(_formulas(table))] * scale


def _silent(table: Table) -> str:
    """Tell which formulas give nothing at some positions."""
    names = dict.fromkeys(str(f) for f, r in zip(table["formula"], table["reason"], strict=True) if r)
    return f" Out of range at some positions (see the table's reasons): {', '.join(names)}." if names else ""


@in_house_style
def draw_root_stress_check(table: Table, path: Path, name: str) -> Picture:
    """Draw root stress, its ratio to the finite elements, and its place."""
    made, (top, middle, bottom) = figure(3, 1, size=(7.4, 8.4), sharex=True, height_ratios=(1.2, 1.0, 1.0))
    degrees, stress = 180.0 / math.pi, 1e-3
    x = _first(table, "roll_angle", degrees)
    _draw(top, table, "root_tension", stress, _first(table, "root_tension_fe", stress), x, label=True)
    top.set_ylabel("root stress per line load\n[MPa per N/mm]")
    _ratio(middle, table, x)
    _draw(bottom, table, "place_angle", degrees, _first(table, "place_angle_fe", degrees), x, label=False)
    bottom.set_ylabel("fillet tangent to\ntooth centre line [deg]")
    bottom.set_xlabel("roll angle of the load [deg]")
    made.legend(loc="outside upper center", ncols=4, fontsize=9)
    caption = (
        f"Gear {name}: largest fillet stress under a load normal to the flank, its ratio to the finite elements, and "
        f"its place (ISO looks at 30 deg always).{_silent(table)}"
    )
    return save(made, path, f"Root stress of gear {name}: closed forms and finite elements", caption)


@in_house_style
def draw_compliance_check(table: Table, path: Path) -> Picture:
    """Draw the compliance of a tooth or a tooth pair and its ratio to the finite elements."""
    made, (top, bottom) = figure(2, 1, size=(7.4, 6.2), sharex=True)
    of_pair = table.columns[1].name == "x"
    x = _first(table, "x", 1e3) if of_pair else _first(table, "roll_angle", 180.0 / math.pi)
    scale = 1e9  # m^2/N to um mm/N
    _draw(top, table, "compliance", scale, _first(table, "compliance_fe", scale), x, label=True)
    top.set_ylabel("deflection per line load\n[µm per N/mm]")
    top.set_ylim(bottom=0.0)
    _ratio(bottom, table, x)
    bottom.set_xlabel("contact point from the pitch point [mm]" if of_pair else "roll angle of the load [deg]")
    made.legend(loc="outside upper center", ncols=4, fontsize=9)
    subject = table.title.split(":", maxsplit=1)[0]
    caption = f"{subject}, along the line of action (secant), and its ratio to the finite elements.{_silent(table)}"
    return save(made, path, table.title, caption)
