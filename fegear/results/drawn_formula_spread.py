"""How often each root-stress formula is how far off over a population of gears: a picture, a sentence a formula."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel, Zone

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.arrays import Array

#: Columns of a range, and the words and units by which a sentence calls them.
WORDS = {
    "teeth": ("z", ""),
    "profile_shift": ("x", ""),
    "rack_tip_radius": ("rack tip radius", "modules"),
    "rack_dedendum": ("rack dedendum", "modules"),
    "pressure_angle": ("pressure angle", "deg"),
    "load_position": ("load position", ""),
}
#: Ratios that the picture shows; what lies beyond stands at its edges.
_SHOWN = (0.5, 1.5)
#: Load positions from which on a load counts as high: about where the outer point of single pair contact begins.
HIGH = 0.5


def _number(table: Mapping[str, Array], key: str) -> Array:
    return np.asarray(table[key], dtype=float)


def names_of(table: Mapping[str, Array]) -> tuple[str, ...]:
    """Names of the formulas of a table of a study, in its order."""
    return tuple(dict.fromkeys(str(n) for n in table["formula"]))


def fe_error(table: Mapping[str, Array]) -> float:
    """95th percentile of the estimated relative error of the finite elements."""
    fe, off = _number(table, "stress_fe"), _number(table, "stress_fe_error")
    known = np.isfinite(fe) & np.isfinite(off)
    return float(np.quantile(off[known] / fe[known], 0.95)) if known.any() else 0.0


def sentences(table: Mapping[str, Array]) -> tuple[str, ...]:
    """A sentence for each formula: where it is near the finite elements, and how far off it is over all gears.

    Parameters
    ----------
    table : mapping of str to ndarray
        Columns of table ``root_stress_study`` of gears that were drawn.
    """
    from fegear.contact.formula_reach import reach, sentence

    found = []
    for name in names_of(table):
        rows = np.asarray(table["formula"]) == name
        columns = {key: _number(table, key)[rows] for key in WORDS}
        keys = np.stack([columns[key] for key in WORDS if key != "load_position"], axis=1)
        _, gear = np.unique(np.nan_to_num(keys), axis=0, return_inverse=True)
        # Numbered in the order of drawing: any run of them fills the box evenly, sorted ones would not.
        order = {int(g): i for i, g in enumerate(dict.fromkeys(gear.ravel().tolist()))}
        number = np.array([order[int(g)] for g in gear.ravel()])
        high = columns["load_position"] >= HIGH
        found.append(sentence(reach(name, _number(table, "ratio_to_fe")[rows], columns, number, high), WORDS))
    return tuple(found)


def bounds_in_words(table: Mapping[str, Array]) -> str:
    """What the population spans."""
    parts = []
    for key, (word, unit) in WORDS.items():
        values = _number(table, key)
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        tail = f" {unit}" if unit else ""
        parts.append(f"{word} {low:.3g}{tail}" if low == high else f"{word} {low:.3g} to {high:.3g}{tail}")
    return ", ".join(parts)


def spread_figure(table: Mapping[str, Array], key: str = "root_stress_spread") -> Figure:
    """Cumulative distribution of formula over finite elements, a curve for each formula: all loads, and high ones."""
    off, upper = fe_error(table), _number(table, "load_position") >= HIGH
    panels = [_panel(table, np.ones(upper.size, dtype=bool), "all loads", off)]
    if upper.any() and not upper.all():
        panels.append(_panel(table, upper, "loads on the upper half, where ratings put them", off))
    gears = len(np.unique(np.stack([_number(table, k) for k in WORDS if k != "load_position"], axis=1), axis=0))
    points = int((np.asarray(table["formula"]) == names_of(table)[0]).sum())
    return Figure(
        key,
        "How often each root-stress formula is how far off",
        f"{points} loads on {gears} gears drawn evenly over {bounds_in_words(table)} (share of the roll angle). What "
        "lies left of 1 is low, unsafe; the steeper a curve, the better one number mends the formula. Grey, and "
        f"narrower than the dotted line where it is not seen: estimated error of the finite elements, "
        f"{100.0 * off:.2g} % at 95 % of the points.",
        tuple(panels),
        columns=2,
    )


def _panel(table: Mapping[str, Array], rows: NDArray[np.bool_], title: str, off: float) -> Panel:
    curves = []
    for number, name in enumerate(names_of(table)):
        ratio = _number(table, "ratio_to_fe")[rows & (np.asarray(table["formula"]) == name)]
        curves.append(spread_curve(ratio, name, f"series:{number}"))
    return Panel(
        Axis("root stress, formula / FE", limits=_SHOWN),
        Axis("points with a smaller ratio", "%", limits=(0.0, 100.0)),
        tuple(c for c in curves if c is not None),
        (Zone("x", 1.0 - off, 1.0 + off), Mark("x", 1.0), Mark("y", 50.0)),
        title=title,
    )


def spread_curve(ratio: Array, name: str, role: str) -> Curve | None:
    """Share of points [%] below each ratio, of those at which the formula answers; None where it answers nowhere."""
    known = np.sort(ratio[np.isfinite(ratio)])
    if not known.size:
        return None
    share = 100.0 * np.arange(1, known.size + 1) / known.size
    below = 100.0 * float((known < _SHOWN[0]).mean())
    x = np.concatenate([[_SHOWN[0]], np.clip(known, *_SHOWN), [_SHOWN[1]]])
    return Curve(x, np.concatenate([[below], share, [100.0]]), name, role, dash="steps", markers=False)
