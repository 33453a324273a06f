"""Ratios of the root-stress formulas to the finite elements over what a study varies: tiles, and a panel a quantity."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.shown import shown
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import HeatMap, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.seen import Seen
from fegear.results.gear.formula_names import ROOT_FORMULAS, formula_called

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array

#: What a study can vary, in the order of its rows: alone at an axis, beside others, and how a value is written.
_OF_GEARS = {
    "teeth": ("number of teeth", "teeth", ".0f"),
    "profile_shift": ("profile shift", "shift", "+.2g"),
    "rack_tip_radius": ("rack tip radius [modules]", "rack radius", ".2g"),
}
_LOAD = ("load position: fraction of roll angle (0 start, 1 end)", "load position", "g")
_VARIED = {**_OF_GEARS, "load_position": _LOAD}

#: Ratios beyond 1 -+ this have the full colour; heights of a row of tiles and of a letter beside them.
_FULL, _TILE, _LETTER = 0.4, 0.1, 0.037

#: Share of the room of a value in which formulas stand next to each other, and of a formula's in which its points do.
_LANES, _IN_LANE = 0.84, 0.6


@dataclass(frozen=True)
class Ratios:
    """Points of one formula over one quantity, beside those of the other formulas."""

    notes: tuple[str, ...]
    place: Array = shown("", "number of the value, offset for other formulas and points")
    ratio: Array = shown("", "formula / FE")


@dataclass(frozen=True)
class Varied:
    """A quantity of which a study has several values."""

    key: str
    values: Array
    formulas: dict[str, Ratios]

    @property
    def axis(self) -> Axis:
        """Its values, equally spaced."""
        label, _, how = _VARIED[self.key]
        ticks = tuple((float(k), f"{value:{how}}") for k, value in enumerate(self.values))
        return Axis(label, ticks=ticks, limits=(-0.5, len(ticks) - 0.5))

    @property
    def marks(self) -> tuple[Mark, ...]:
        """Between its values, and where formulas agree with the finite elements."""
        between = (Mark("x", k + 0.5) for k in range(self.values.size - 1))
        return *between, Mark("y", 1.0)


def keys_varied(table: Mapping[str, NDArray[Any]], among: Mapping[str, Any] = _VARIED) -> tuple[str, ...]:
    """Columns with several values; the number of teeth where all have one."""
    return tuple(key for key in among if np.unique(table[key]).size > 1) or ("teeth",)


def varied(table: Mapping[str, NDArray[Any]]) -> tuple[Varied, ...]:
    """What a study varies, of columns of table ``root_stress_study`` without units.

    Points of one formula and one value stand next to each other in the order of their load positions; over the load
    position in that of the first quantity of the gears.
    """
    names, keys = tuple(dict.fromkeys(str(name) for name in table["formula"])), keys_varied(table)
    lane, found = _LANES / len(names), []
    for key in keys:
        values, place = np.unique(table[key], return_inverse=True)
        beside = "load_position" if key != "load_position" else keys[0]
        others, order = np.unique(table[beside], return_inverse=True)
        aside = _IN_LANE * lane * ((order.ravel() + 0.5) / others.size - 0.5)
        formulas = {}
        for number, name in enumerate(names):
            own, called = table["formula"] == name, ROOT_FORMULAS.get(name, name)
            shift = lane * (number - 0.5 * (len(names) - 1))
            columns = {one: table[one][own] for one in _VARIED}
            notes = tuple(
                f"{called}: {z:.0f} teeth, shift {x:.3g}, rack tip radius {r:.3g}, load position {p:.3g}"
                for z, x, r, p in zip(*columns.values(), strict=True)
            )
            formulas[name] = Ratios(notes, place.ravel()[own] + aside[own] + shift, table["ratio_to_fe"][own])
        found.append(Varied(key, values, formulas))
    return tuple(found)


_RATIOS = Chart(
    "root_stress_ratios", "Root-stress formulas relative to FE",
    "",
    (
        Over(
            lambda seen: seen.one.axis,
            (
                Line(
                    "ratio", x="place", kind="points", each=Family("formulas", formula_called, most=None),
                    look=lambda seen: {"size": 4.5, "notes": seen.one.notes},
                ),
            ),
            Axis("formula / FE"), lambda seen: seen.one.marks, each="varied",
        ),
    ),
)  # fmt: skip


@dataclass(frozen=True)
class _Study:
    varied: tuple[Varied, ...]


def ratios_figure(table: Mapping[str, NDArray[Any]], about: str) -> Figure:
    """Every ratio, a panel for each quantity that is varied; `about` ends the caption."""
    found = varied(table)
    keys = [one.key for one in found]
    order = " From left to right in each column of points: the load from the start to the end of the involute."
    caption = (
        "One point for each gear and load position, one column of points for each formula; 1 agrees, above 1 is safe."
        f"{order if 'load_position' in keys and len(keys) > 1 else ''} In the report, hover over a point to identify "
        f"the gear. {about}"
    )
    (figure,) = replace(_RATIOS, caption=caption).figures(Seen(_Study(found)))
    return figure


def tiles_figure(table: Mapping[str, NDArray[Any]], about: str) -> Figure:
    """A tile for every gear, load position and formula; `about` ends the caption."""
    names = tuple(dict.fromkeys(str(name) for name in table["formula"]))
    gears = list(dict.fromkeys(zip(*(table[key] for key in _OF_GEARS), strict=True)))
    positions = list(dict.fromkeys(float(p) for p in table["load_position"]))
    keys = keys_varied(table, _OF_GEARS)
    word = 0 if len(keys) == 1 else 1
    label = " | ".join(_OF_GEARS[key][word] for key in keys)
    values = [dict(zip(_OF_GEARS, gear, strict=True)) for gear in gears]
    rows = tuple(" | ".join(f"{one[key]:{_OF_GEARS[key][2]}}" for key in keys) for one in values)
    edges = np.flatnonzero(np.diff([z for z, *_ in gears])) if len(keys) > 1 else ()
    marks = tuple(Mark("y", len(gears) - 1.5 - int(edge)) for edge in edges)
    axes = (Axis(_LOAD[0], categories=tuple(f"{p:g}" for p in positions)), Axis(label, categories=rows[::-1]))
    ratios = table["ratio_to_fe"].reshape(len(gears), len(names), len(positions))
    across, down = np.arange(len(positions)), np.arange(len(gears))[::-1]
    height = max(_TILE * len(gears), _LETTER * len(label))
    called = [ROOT_FORMULAS.get(name, name) for name in names]
    views = tuple(
        View(name if np.isfinite(ratios[:, i]).all() else f"{name} (×: not applicable)", (Panel(
            *axes, (HeatMap(across, down, ratios[:, i], "formula / FE", centre=(1.0, _FULL), numbers=True),),
            marks, height=height,
        ),))
        for i, name in enumerate(called)
    )  # fmt: skip
    of_rows = " Rack tip radius in modules." if "rack_tip_radius" in keys and len(keys) > 1 else ""
    return Figure(
        "root_stress_study",
        "Over- and underestimation of each root-stress formula",
        "Root stress of one tooth under a load normal to the flank, formula over finite elements: white: agreement, "
        "orange: overestimate (conservative), blue: underestimate, × on grey: formula not applicable (reason in the "
        f"table).{of_rows} {about}",
        views=views,
        most_views=len(views),
    )
