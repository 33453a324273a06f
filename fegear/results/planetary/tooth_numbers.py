"""Stage ``tooth-numbers``: numbers of teeth of a planetary set described as data that give a wanted ratio."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import figures, percent
from fegear.base.shown import shown
from fegear.case.built.compound import compound_inputs, compound_part
from fegear.case.nearest import nearest
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.planetary.compound_set import compound_sets

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.built.compound import CompoundInputs
    from fegear.case.reading import Scene
    from fegear.dynamics.compound.tooth_search import Candidate, Wanted
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: By how much numbers of teeth vary without a range, and the fewest.
_VARIES, _FEWEST = 0.2, 12


@dataclass(frozen=True)
class SearchInputs:
    """The set, and what is wanted of it."""

    asked: CompoundInputs
    wanted: Wanted
    most: int
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> SearchInputs:
    from fegear.dynamics.compound.tooth_search import Wanted, gears_of

    part, asked = compound_part(scene, name), compound_inputs(scene, name)
    search, key = part.search, f"compound.{name}"
    if search is None:
        raise InputError(f"{key}.search", "(not given)", "is required for this result", "set search = { ratio = 4.0 }")
    if not asked.input:
        raise InputError(f"{key}.input", "(not given)", "is required for this result (fixed, driving and loaded shaft)",
                         'set input = "SHAFT" and torque')  # fmt: skip
    gears = gears_of(asked.found)
    unknown = next((one for one in search.teeth if one not in gears), None)
    if unknown is not None:
        raise InputError(f"{key}.search.teeth.{unknown}", search.teeth[unknown], "is not a gear in mesh of this set",
                         nearest(unknown, gears))  # fmt: skip
    ranges = {
        gear: (
            max(_FEWEST, math.ceil(wheel.teeth * (1.0 - _VARIES))), max(_FEWEST, int(wheel.teeth * (1.0 + _VARIES)))
        )
        for gear, wheel in gears.items()
    } | {gear: (one[0], one[1]) for gear, one in search.teeth.items()}  # fmt: skip
    modules = {gear: scene.gears[gear].transverse_module for gear in gears}
    wanted = Wanted(search.ratio, search.tolerance, ranges, modules, search.coaxial, search.clearance)
    return SearchInputs(asked, wanted, search.most, name)


def _compute(inputs: SearchInputs, _upstream: Upstream, _work: Work) -> tuple[Candidate, ...]:
    from fegear.dynamics.compound.tooth_search import search

    drive = inputs.asked.drive
    if drive is None:  # refused before
        return ()
    try:
        return search(inputs.asked.found, drive, inputs.wanted, inputs.most)
    except InputError as error:
        raise at(f"compound.{inputs.name}.search", error) from None


@dataclass(frozen=True)
class TeethOfGear:
    """Numbers of teeth of one gear in all combinations."""

    teeth: NDArray[np.intp] = shown("", "number of teeth of gear")


@dataclass(frozen=True)
class ShownNumbers:
    """Combinations as they are shown, shape (N,)."""

    gears: dict[str, TeethOfGear]
    ratio: Array = shown("", "ratio of input to output speed")
    off: Array = shown("%", "relative deviation from the wanted ratio", name="deviation")
    coaxial: Array = shown(
        "", "largest difference of reference centre distances of one planet, in modules (balanced by profile shifts)"
    )
    clearance: Array = shown("mm", "minimum distance between tip circles of planets; blank: one planet")
    size: Array = shown("mm", "largest pitch diameter of gears on shafts, or over planets")
    common: NDArray[np.intp] = shown("", "number of meshes with a common factor of the numbers of teeth")
    in_phase: NDArray[np.str_] = shown(
        "", "meshes with shafts whose planets are all in phase (torque adds up, radial forces cancel)"
    )


def _shown(found: tuple[Candidate, ...], _inputs: SearchInputs) -> ShownNumbers:
    names = found[0].teeth if found else ()
    gaps = np.array([one.clearance for one in found])
    return ShownNumbers(
        {name: TeethOfGear(np.array([one.teeth[name] for one in found])) for name in names},
        np.array([one.ratio for one in found]), np.array([one.off for one in found]),
        np.array([one.coaxial for one in found]), np.where(np.isinf(gaps), math.nan, gaps),
        np.array([one.size for one in found]), np.array([one.common for one in found]),
        np.array([one.in_phase for one in found]),
    )  # fmt: skip


def _answer(seen: Seen) -> Iterator[str]:
    data = seen.data
    teeth = ", ".join(f"{name} {one.teeth[0]}" for name, one in data.gears.items())
    yield (
        f"Set {seen.name}: {teeth} teeth give ratio {figures(float(data.ratio[0]), 5)} "
        f"({percent(float(data.off[0]), signed=True)}), the first of {data.ratio.size} combinations."
    )


def _remarks(seen: Seen) -> Iterator[str]:
    yield (
        f"Set {seen.name}: combinations are by reference centre distances; where `coaxial` is not zero the profile "
        "shifts of a planet's meshes must differ."
    )


_SHEET = Sheet(
    answer=Answer(_answer),
    of=_shown,
    tables=(
        Rows(
            "tooth_numbers_{name}", "Numbers of teeth of set {name} for the wanted ratio",
            (
                Cell("teeth", each="gears", name="teeth_{key}", further=" {key}"),
                "ratio", "off", "coaxial", "clearance", "size", "common", "in_phase",
            ),
        ),
    ),
    remarks=(_remarks,),
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _inputs(scene, name)


TOOTH_NUMBERS = Stage(
    subjects=compound_sets,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("parker", "modes excited by planets in phase")),
    forecast=lambda _scene, _name: forecasts.constant(2.0),
)
