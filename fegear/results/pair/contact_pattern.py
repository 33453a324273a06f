"""Stage ``contact-pattern``: where marking compound prints under the loads of a pair with a width."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.family import few
from fegear.engine.sheet.chart import Chart, Map, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Upstream, Work
from fegear.results import forecasts
from fegear.results.pair.load_distribution import flank_stage
from fegear.results.pair.loaded_flanks import loaded_flanks

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.pair_history import ContactPattern

#: Loads that are drawn.
_DRAWN = 4
#: Of the nominal load: that of a pair turned by hand, beside the loads of the case.
_LIGHT = 0.01


@dataclass(frozen=True)
class ContactPatternInputs:
    """What is read of the case besides the loaded flanks: the thickness of the coat [m]."""

    name: str = field(compare=False)
    coat: float = shown("um", "thickness of the coat", compare=False)


@dataclass(frozen=True)
class ContactPatternData:
    """What the stage hands to table and picture.

    Parameters
    ----------
    loaded : LoadedWidePair
    loads : tuple of float
        A light one, and those of the case [N].
    pattern : ContactPattern
        Under each of them.
    """

    loaded: LoadedWidePair
    loads: tuple[float, ...]
    pattern: ContactPattern


def _inputs(scene: Scene, name: str) -> ContactPatternInputs:
    return ContactPatternInputs(name, scene.case.load_distribution.coat)


def _compute(inputs: ContactPatternInputs, upstream: Upstream, _work: Work) -> ContactPatternData:
    from fegear.contact.wide.pair_history import contact_pattern

    loaded = loaded_flanks(upstream, inputs.name)
    loads = (_LIGHT * loaded.nominal, *loaded.loads)
    found = loaded.flanks.solve(loads, loaded.gaps, loaded.known)
    return ContactPatternData(loaded, loads, contact_pattern(found, loaded.gaps.at(found.pair, found.lines, loads)))


@dataclass(frozen=True)
class PrintedLoads:
    """What the coat prints under every load: arrays of shape (L,), NaN where nothing is printed."""

    load: Array = shown("N", "along the line of action")
    printed_share: Array = shown("", "fraction of the flank")
    z_first: Array = shown("mm", "start of the pattern along the face width")
    z_last: Array = shown("mm", "end of the pattern")
    x_first: Array = shown("mm", "start of the pattern along the line of action")
    x_last: Array = shown("mm", "end of the pattern")


@dataclass(frozen=True)
class PrintedFlank:
    """The driver's flank under one load, over radius and face."""

    load: float = shown("N", "along the line of action")
    share: float = shown("", "of the flank that is printed")
    z: Array = shown("mm", "face position z")
    radius: Array = shown("mm", "radius on the driver")
    separation: Array = shown("um", "separation")

    @property
    def printed_percent(self) -> float:
        """`share` in per cent."""
        return 100.0 * self.share


@dataclass(frozen=True)
class Printed:
    """What a coat of marking compound shows of the loaded flanks."""

    found: ContactPatternData
    coat: float

    @cached_property
    def over_loads(self) -> PrintedLoads:
        """Extent of the pattern under every load."""
        pattern = self.found.pattern
        printed = pattern.printed(self.coat)
        z = np.array([_ends(pattern.z, one.any(axis=1)) for one in printed])
        x = np.array([_ends(pattern.x, one.any(axis=0)) for one in printed])
        return PrintedLoads(np.array(self.found.loads), pattern.printed_share(self.coat), *z.T, *x.T)

    @property
    def nominal_share(self) -> float:
        """Of the flank, under the nominal load."""
        return float(self.over_loads.printed_share[1 + self.found.loaded.at])

    @property
    def light(self) -> PrintedFlank:
        """Under the light load."""
        return self.drawn[0]

    @cached_property
    def drawn(self) -> list[PrintedFlank]:
        """The flank under some loads, the light and the nominal one among them."""
        pattern, loads = self.found.pattern, self.over_loads
        radius = self.found.loaded.found.pair.radius(pattern.x, "driver")
        return [
            PrintedFlank(
                loads.load[i], loads.printed_share[i], pattern.z, radius,
                np.where(pattern.separation[i] < self.coat, pattern.separation[i], np.nan).T,
            )
            for i in few(loads.load.size, (0, 1 + self.found.loaded.at), _DRAWN)
        ]  # fmt: skip


def _ends(places: Array, printed: Array) -> tuple[float, float]:
    """First and last of the places at which anything is printed; NaN where nothing is."""
    on = places[printed]
    return (float(on[0]), float(on[-1])) if on.size else (np.nan, np.nan)


_SHEET = Sheet(
    of=lambda data, asked: Printed(data, asked.coat),
    tables=(
        Rows(
            "contact_pattern_{name}", "Contact pattern of pair {name} for every load",
            (
                "load", Cell("printed_share", further=", by a coat of {asked.coat:.4g!} um"),
                "z_first", "z_last", "x_first", "x_last",
            ),
            of="over_loads",
        ),
    ),
    values=(
        Number(
            "printed_share", of="over_loads", si="nominal_share",
            further=" that a coat of {asked.coat:.4g!} um prints",
        ),
    ),
    figures=(
        Chart(
            "contact_pattern_{name}", "Contact pattern of pair {name}",
            "Pair {name}: the driver's flank with the pattern of a coat of marking compound, {asked.coat:.4g!} um "
            "thick, after passage of the contact lines; blank where the gap is larger. {d.light.load:.4g} is about "
            "the load when turned by hand.",
            (
                Over(
                    "z", (Map("separation", "radius", limits=lambda seen: (0.0, seen.asked.coat)),), each="drawn",
                    title="{one.load:.5g}: {one.printed_percent:.0f} % printed",
                ),
            ),
            columns=2,
        ),
    ),
    settings={"coat": lambda seen: seen.asked.coat},
)  # fmt: skip


CONTACT_PATTERN = flank_stage(
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(Citation("iso-21771", "contact lines in the plane of action", "5.4")),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
