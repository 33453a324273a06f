"""How often each root-stress formula is how far off over a population of gears: a picture, a sentence a formula."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark, Zone
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.seen import Seen, Text
from fegear.results.gear.crosscheck_rows import HIGH
from fegear.results.gear.formula_names import ROOT_FORMULAS, formula_called

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.engine.figure.figure import Figure


#: Columns of a range, and the words and units by which a sentence calls them.
WORDS = {
    "teeth": ("z", ""),
    "profile_shift": ("x", ""),
    "rack_tip_radius": ("rack tip radius", "modules"),
    "rack_dedendum": ("rack dedendum", "modules"),
    "pressure_angle": ("pressure angle", "°"),
    "load_position": ("load position", ""),
}


#: Ratios that the picture shows at most; what lies beyond stands at its edges.
_SHOWN = (0.5, 1.5)


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
    from fegear.contact.compared.formula_reach import reach, sentence

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
        ratio = _number(table, "ratio_to_fe")[rows]
        found.append(sentence(reach(ROOT_FORMULAS.get(name, name), ratio, columns, number, high), WORDS))
    return tuple(found)


def bounds_in_words(table: Mapping[str, Array]) -> str:
    """What the population spans."""
    parts = []
    for key, (word, unit) in WORDS.items():
        values = _number(table, key)
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        tail = ("" if unit == "°" else " ") + unit if unit else ""
        parts.append(f"{word} {low:.3g}{tail}" if low == high else f"{word} {low:.3g} to {high:.3g}{tail}")
    return ", ".join(parts)


@dataclass(frozen=True)
class Spread:
    """Share of points below each ratio, of those at which a formula answers."""

    ratio: Array = shown("", "root stress, formula / FE")
    share: Array = shown("%", "fraction of points with a smaller ratio")


def spread(ratio: Array) -> Spread | None:
    """Of ratios within those that the picture shows; None where a formula answers nowhere."""
    known = np.sort(ratio[np.isfinite(ratio)])
    if not known.size:
        return None
    share = np.arange(1, known.size + 1) / known.size
    x = np.concatenate([[_SHOWN[0]], np.clip(known, *_SHOWN), [_SHOWN[1]]])
    return Spread(x, np.concatenate([[(known < _SHOWN[0]).mean()], share, [1.0]]))


@dataclass(frozen=True)
class SomeLoads:
    """Spreads of all formulas over some of the loads."""

    title: str
    spreads: dict[str, Spread | None]


@dataclass(frozen=True)
class Population:
    """Columns of table ``root_stress_study`` of gears that were drawn, as they are read."""

    table: Mapping[str, Array]

    @property
    def loads(self) -> list[SomeLoads]:
        """All of them, and high ones where there are others, too."""
        upper = _number(self.table, "load_position") >= HIGH
        found = [self._some("all loads", np.ones(upper.size, dtype=bool))]
        if upper.any() and not upper.all():
            found.append(self._some("loads on the upper half of the flank (as in ratings)", upper))
        return found

    def _some(self, title: str, rows: NDArray[np.bool_]) -> SomeLoads:
        ratio, formula = _number(self.table, "ratio_to_fe"), np.asarray(self.table["formula"])
        return SomeLoads(title, {name: spread(ratio[rows & (formula == name)]) for name in names_of(self.table)})

    @property
    def about(self) -> str:
        """How many loads on which gears."""
        gears = np.unique(np.stack([_number(self.table, k) for k in WORDS if k != "load_position"], axis=1), axis=0)
        points = int((np.asarray(self.table["formula"]) == names_of(self.table)[0]).sum())
        return f"{points} loads on {len(gears)} gears, uniformly distributed over {bounds_in_words(self.table)}"


def spread_chart(
    name: str, title: str, caption: Text, quantity: str, error: Callable[[Seen], float],
    limits: Callable[[Seen], tuple[float, float]],
) -> Chart:  # fmt: skip
    """Cumulative distributions of formula over finite elements, of what has `SomeLoads` as ``loads``: a panel each.

    Parameters
    ----------
    name, title : str
    caption : text
    quantity : str
        Name of the axis of ratios.
    error : callable
        Relative error of the finite elements.
    limits : callable
        Of the axis of ratios (`spread_limits`).
    """

    def marks(seen: Seen) -> tuple[Zone | Mark, ...]:
        off = error(seen)
        return Zone("x", 1.0 - off, 1.0 + off), Mark("x", 1.0), Mark("y", 50.0)

    line = Line(
        "share", x="ratio", each=Family("spreads", formula_called, most=None), look={"dash": "steps", "markers": False}
    )
    panel = Over(
        lambda seen: Axis(quantity, limits=limits(seen)), (line,),
        Axis("fraction of points with a smaller ratio", "%", limits=(0.0, 100.0)), marks, title="{one.title}",
        each="loads",
    )  # fmt: skip
    return Chart(name, title, caption, (panel,), columns=2)


def spread_limits(ratio: Array) -> tuple[float, float]:
    """Axis about 1 and all known ratios, in whole tenths, within what a spread shows."""
    known = ratio[np.isfinite(ratio)]
    low, high = min(1.0, *known, _SHOWN[1]), max(1.0, *known, _SHOWN[0])
    return max(_SHOWN[0], math.floor(10.0 * low - 0.2) / 10.0), min(_SHOWN[1], math.ceil(10.0 * high + 0.2) / 10.0)


def _beyond(table: Mapping[str, Array]) -> str:
    """What is said of points that lie beyond the axis."""
    ratio = _number(table, "ratio_to_fe")
    return f" Points below {_SHOWN[0]:g} are counted where curves begin." if np.any(ratio < _SHOWN[0]) else ""


_FIGURE = spread_chart(
    "root_stress_spread", "Distribution of the errors of the root-stress formulas",
    lambda seen: f"{seen.data.about} (share of the roll angle). Left of 1: stress underestimated (unsafe). "
    f"The steeper the curve, the better a constant correction factor works.{_beyond(seen.data.table)} Estimated error "
    f"of the finite elements (grey band about 1): {percent(fe_error(seen.data.table))} at 95 % of the points.",
    "root stress, formula / FE", lambda seen: fe_error(seen.data.table),
    limits=lambda seen: spread_limits(_number(seen.data.table, "ratio_to_fe")),
)  # fmt: skip


def spread_figure(table: Mapping[str, Array], key: str = "root_stress_spread") -> Figure:
    """Cumulative distribution of formula over finite elements, a curve for each formula: all loads, and high ones."""
    (figure,) = replace(_FIGURE, name=key).figures(Seen(Population(table)))
    return figure
