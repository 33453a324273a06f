"""The figure of one effect: the curve that it changes most, without it and with it, the change, and the seconds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel
from fegear.studies.effect_study import CURVES

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.engine.outcome import Table
    from fegear.studies.effect_study import Measured, Switched

    #: Tables without and with the effect, abscissa, ordinate.
    EffectCurve = tuple[Table, Table, str, str]

_TITLES = {
    "dynamic_factor": "dynamic factor",
    "te": "transmission error",
    "force": "force on one tooth pair",
    "load": "load on one tooth pair",
    "stress": "root stress",
    "relief": "relief",
}
_NAMES = {"hertz": "contacts that widen with load", "parametric": "stiffness that varies in time"}
_ABSCISSAE = {"x": "position on the line of action", "speed": "speed", "phi1": "pinion angle"}
_SMALLEST_CHANGE = 1e-9


def curves_of(measured: Measured) -> dict[str, Table]:
    """Tables of a run by name."""
    return {table.name: table for table in measured.results.tables}


def clearest_curve(found: Switched) -> EffectCurve | None:
    """The curve to draw: of the first kind that the runs have, the table that the effect changes most."""
    before, after = curves_of(found.without), curves_of(found.with_it)
    for start, x, y in CURVES:
        shared = [name for name in before if name.startswith(start) and name in after and _is_curve(before[name], x, y)]
        changed = [(_change(before[name], after[name], x, y), name) for name in shared]
        if changed and max(changed)[0] > _SMALLEST_CHANGE:
            name = max(changed)[1]
            return before[name], after[name], x, y
    return None


def _is_curve(table: Table, x: str, y: str) -> bool:
    """Whether a table holds one curve, and not one for each of several loads."""
    names = {column.name for column in table.columns}
    return {x, y} <= names and "total_load" not in names


def _change(before: Table, after: Table, x: str, y: str) -> float:
    """Largest change of a curve over its largest value, where both reach."""
    xa, ya, xb, yb = (np.asarray(table[column], dtype=float) for table in (before, after) for column in (x, y))
    inside = (xa >= xb[0]) & (xa <= xb[-1])
    scale = float(np.nanmax(np.abs(ya), initial=0.0))
    if not inside.any():
        return 0.0
    change = float(np.nanmax(np.abs(np.interp(xa[inside], xb, yb) - ya[inside])))
    return change / scale if scale > 0.0 else change


def _shown(table: Table, name: str) -> Array:
    return np.asarray(table[name], dtype=float)


def effect_figure(found: Switched, curve: EffectCurve | None, title: str) -> Figure:
    """Describe one effect.

    Parameters
    ----------
    found : Switched
    curve : tuple, optional
        What `clearest_curve` gives.
    title : str
        Of the case.
    """
    name = _NAMES.get(found.effect, found.effect.replace("_", " "))
    name = f"{name[0].upper()}{name[1:]}"
    panels, what = _compared(curve, f"{name}\n{title}"), "what it takes" if curve is None else "the change"
    seconds = (
        Bars([0.0], [found.without.seconds], "", "without"), Bars([1.0], [found.with_it.seconds], "", "with")
    )  # fmt: skip
    labels = tuple(
        f"{word}: {one.seconds:.2g} s" for word, one in (("without", found.without), ("with", found.with_it))
    )
    none = f"{name}\n{title} (no curve of this case changes)" if curve is None else ""
    panels.append(
        Panel(Axis("processor time of the run", categories=labels), Axis("time", "s", zero=True), seconds,
              title=none, height=0.5, stacked=True)
    )  # fmt: skip
    drawn = "no curve" if curve is None else _TITLES.get(curve[3], curve[3])
    return Figure(
        f"effect_{found.effect}",
        f"Effect of {name[0].lower()}{name[1:]}",
        f"{name}: {drawn} with it and without it, {what}, and the processor seconds of the whole run.",
        tuple(panels),
    )


def _compared(curve: EffectCurve | None, title: str) -> list[Panel]:
    if curve is None:
        return []
    before, after, x, y = curve
    unit = after.column(y).unit
    axis = Axis(_ABSCISSAE.get(x, x), after.column(x).unit)
    both = tuple(
        Curve(_shown(table, x), _shown(table, y), word, word, markers=False)
        for table, word in ((before, "without"), (after, "with"))
    )
    a, b = _shown(before, x), _shown(after, x)
    at = a[(a >= b[0]) & (a <= b[-1])]
    change = np.interp(at, b, _shown(after, y)) - np.interp(at, a, _shown(before, y))
    difference = Curve(at, change, "", "with", width=1.2, fill=True, markers=False)
    return [
        Panel(axis, Axis(_TITLES.get(y, y), unit), both, title=title, height=1.3),
        Panel(axis, Axis("change", unit), (difference,), height=0.6),
    ]
