"""Climb one rung: solve, answer, compare, tell the seconds."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import FegearError
from fegear.fem.gear import solve_gear
from fegear.fem.influence import solve_influence
from fegear.fem.sector import mesh_sector
from fegear.fem.settings import MeshSettings
from fegear.models.tooth_influence import gear_to_solve, needed_reach, solve_influence_functions
from fegear.solution_cache import SolutionCache
from fegear.studies.cost.answers import answer
from fegear.studies.cost.quantities import Miss, miss
from fegear.studies.cost.result import Measured
from fegear.studies.cost.sources import CaseTable, ComplianceFormula, FiniteElements, StressFormula, without_neighbours
from fegear.studies.cost.timing import NOTHING, Seconds, timed

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.fem.gear import GearInfluence
    from fegear.fem.influence import Influence
    from fegear.geometry import Gear
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.ladder import Ladder
    from fegear.studies.cost.quantities import Quantity
    from fegear.studies.cost.result import Knob
    from fegear.studies.cost.rung import Rung
    from fegear.studies.cost.sources import Source

    Array = NDArray[np.float64]

#: Gauss points of the reference's transmission error; a run takes 16.
_REFERENCE_ORDER = 48
#: The check beside the reference loads the mesh with a pressure so much wider.
_WIDER = 1.25
#: No error is claimed to be smaller than this: a force that statics alone decides has no other.
_ROUND_OFF = 1e-13


@dataclass
class Found:
    """What has been found so far; grows rung by rung.

    Parameters
    ----------
    asked : Asked
    rows : list of Measured
    values : dict of (Rung, quantity) to ndarray
    reference : dict of quantity to ndarray
    floors, mesh_floors : dict of quantity to float
        What the reference does not know (largest), and how much of that is its mesh (root mean square); relative.
    knobs : list of Knob
    remarks : list of str
    """

    asked: Asked
    rows: list[Measured] = field(default_factory=list)
    values: dict[tuple[Rung, str], Array] = field(default_factory=dict)
    reference: dict[str, Array] = field(default_factory=dict)
    floors: dict[str, float] = field(default_factory=dict)
    mesh_floors: dict[str, float] = field(default_factory=dict)
    knobs: list[Knob] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def _solve(gear: Gear, settings: MeshSettings, reach: int, sector_teeth: int) -> Influence:
    """Mesh and solve, past every cache."""
    mesh = mesh_sector(gear.tooth, gear.bore_radius / gear.module, settings)
    return solve_influence(
        gear.tooth, mesh, gear.material.poisson_ratio, gear.plane_assumption,
        order=settings.order, reach=reach, corner_distance=settings.corner_distance, sector_teeth=sector_teeth,
    )  # fmt: skip


def solve_gears(asked: Asked, rung: Rung) -> tuple[dict[str, Influence], dict[str, Seconds]]:
    """Solve every gear that is needed by finite elements, from nothing; equal shapes once.

    Parameters
    ----------
    asked : Asked
    rung : Rung
        With settings.

    Returns
    -------
    influences, seconds : dict
        By the gears' names; a gear of the same shape as an earlier one takes no time.
    """
    settings = rung.settings
    if settings is None:
        raise ValueError(f"{rung.label} is no finite-element rung")
    found: dict[str, Influence] = {}
    seconds: dict[str, Seconds] = {}
    shapes: dict[object, Influence] = {}
    for name in asked.gears:
        gear = asked.scene.gears[name]
        shape = (gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption)
        if shape not in shapes:
            shapes[shape], seconds[name] = timed(
                functools.partial(_solve, gear, settings, needed_reach(asked.scene, name), rung.teeth)
            )
        found[name] = shapes[shape]
        seconds.setdefault(name, NOTHING)
    return found, seconds


def finite_elements(asked: Asked, rung: Rung, solved: Mapping[str, Influence]) -> FiniteElements:
    """Solved gears with the patch of a rung."""
    settings = rung.settings
    if settings is None:
        raise ValueError(f"{rung.label} is no finite-element rung")
    gears = asked.scene.gears
    return FiniteElements(
        {name: replace(_any_solution(gears[name]), fine=one, settings=settings) for name, one in solved.items()}
    )


@functools.lru_cache(maxsize=8)
def _any_solution(gear: Gear) -> GearInfluence:
    """A gear's influence functions in SI, whose solution others take the place of; nobody is charged for it."""
    return solve_gear(gear, MeshSettings().scaled(4.0), estimate_error=False)


def _record(found: Found, rung: Rung, source: Source, seconds: Mapping[str, Seconds]) -> None:
    """Answer and compare every quantity that a source knows."""
    asked = found.asked
    here = without_neighbours(asked) if rung.family == "compliance-formula" else asked
    for quantity in answered(asked, rung):
        solve = NOTHING
        for name in asked.gears_for(quantity):
            solve = solve.plus(seconds.get(name, NOTHING))
        try:
            values, own = timed(functools.partial(answer, here, quantity, source))
        except FegearError as problem:
            nothing = Miss(math.nan, math.nan, 0.0)
            found.rows.append(Measured(rung, quantity.name, math.nan, nothing, solve, NOTHING, str(problem)))
            continue
        found.values[rung, quantity.name] = values
        off = miss(quantity.name, values, found.reference[quantity.name])
        found.rows.append(Measured(rung, quantity.name, largest(values), off, solve, own))


def largest(values: Array) -> float:
    """The value of largest size; NaN where there is none."""
    known = values[np.isfinite(values)]
    return float(known[np.argmax(np.abs(known))]) if known.size else math.nan


def refer(found: Found, ladder: Ladder) -> FiniteElements:
    """Solve the reference and the coarser one that tells its error."""
    asked = found.asked
    solved, _ = solve_gears(asked, ladder.reference)
    best = finite_elements(asked, ladder.reference, solved)
    settings = ladder.check.settings
    wider = ladder.check if settings is None else replace(
        ladder.check, settings=replace(settings, patch_half_width=_WIDER * settings.patch_half_width)
    )  # fmt: skip
    coarse, _ = solve_gears(asked, ladder.check)
    second = finite_elements(asked, wider, coarse)
    for quantity in asked.quantities:
        sources = (best, second) if asked.solves(quantity) else (CaseTable(), CaseTable())
        values = answer(asked, quantity, sources[0], _REFERENCE_ORDER)
        found.reference[quantity.name] = values
        floor = miss(quantity.name, answer(asked, quantity, sources[1]), values).largest
        found.floors[quantity.name] = max(floor, _ROUND_OFF)
        if asked.solves(quantity):
            same_width = finite_elements(asked, ladder.check, coarse)
            found.mesh_floors[quantity.name] = miss(quantity.name, answer(asked, quantity, same_width), values).rms
    return best


def _tolerance(found: Found, rung: Rung) -> None:
    """What a run pays for a tolerance: every solution it makes, the ones for its own error estimate among them."""
    scene = found.asked.scene
    accuracy = type(scene.case.accuracy)(tolerance=rung.tolerance)
    wanted = replace(scene, case=scene.case.model_copy(update={"accuracy": accuracy}))
    solved: dict[str, GearInfluence] = {}
    seconds: dict[str, Seconds] = {}
    cache = SolutionCache()  # gears of one shape pay once, as they do in a run
    for name in found.asked.gears:
        solved[name], seconds[name] = timed(
            functools.partial(solve_influence_functions, gear_to_solve(wanted, name), cache), repeat=False
        )
    _record(found, rung, FiniteElements(solved), seconds)


def climb(found: Found, rung: Rung) -> None:
    """A rung on its own: a closed form, the case's table, or a tolerance."""
    if rung.family == "tolerance":
        _tolerance(found, rung)
    elif rung.family == "table":
        _record(found, rung, CaseTable(), {})
    elif rung.family == "stress-formula":
        _record(found, rung, StressFormula(rung.formula), {})
    else:
        _record(found, rung, ComplianceFormula(rung.formula), {})


def climb_mesh(found: Found, group: tuple[Rung, ...]) -> None:
    """Rungs that differ in the patch alone: the gears are solved once, and each rung is charged for that."""
    solved, seconds = solve_gears(found.asked, group[0])
    for rung in group:
        _record(found, rung, finite_elements(found.asked, rung, solved), seconds)


def answered(asked: Asked, rung: Rung) -> list[Quantity]:
    """Quantities that a rung knows anything of."""
    kinds: dict[str, frozenset[str]] = {
        "compliance-formula": ComplianceFormula.answers, "stress-formula": StressFormula.answers,
        "table": CaseTable.answers,
    }  # fmt: skip
    known = kinds.get(rung.family, FiniteElements.answers)
    return [q for q in asked.quantities if q.name in known and asked.solves(q) != (rung.family == "table")]
