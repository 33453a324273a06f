"""Measure one configuration: solve, answer, compare, take the seconds.

Measure one configuration of a pair that is loaded over its face: solve its gears, load it, take the seconds.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.shafts import gearbox_of, on_shafts
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.case.built.tooth_influence import gear_to_solve, needed_reach, solve_influence_functions
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide.on_shafts import gaps_of_even_loads
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.supported_section import supported_sector
from fegear.fem.solid.slices import solve_slices, solve_thin_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.pair import MEMBERS, Member
from fegear.studies.cost.answers import (
    CaseTable,
    ComplianceFormula,
    FiniteElements,
    Source,
    StressFormula,
    answer,
    pair_compliance,
    without_neighbours,
)
from fegear.studies.cost.ladder import Configuration, FlankConfiguration, Ladder
from fegear.studies.cost.quantities import Miss, Quantity, miss
from fegear.studies.cost.result import NOTHING, Knob, Measured, Seconds, timed

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.fem.plane.settings import MeshSettings
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.fem.solid.settings import SolidSettings
    from fegear.geometry.gear import Gear
    from fegear.studies.cost.asked import Asked


#: Gauss points of the reference's transmission error; a run takes 16.
_REFERENCE_ORDER = 48


#: The check of the reference loads the mesh with a pressure so much wider.
_WIDER = 1.25


#: No error is claimed to be smaller than this: a force that statics alone decides has no other.
_ROUND_OFF = 1e-13


@dataclass
class Found:
    """What has been found so far; grows configuration by configuration.

    Parameters
    ----------
    asked : Asked
    rows : list of Measured
    values : dict of (Configuration, quantity) to ndarray
    reference : dict of quantity to ndarray
    floors, mesh_floors : dict of quantity to float
        What the reference does not know (largest), and how much of that is its mesh (root mean square); relative.
    compliance : ndarray or None
        Of the pair by the reference, see `pair_compliance`; None where no quantity stands on it.
    knobs : list of Knob
    remarks : list of str
    """

    asked: Asked
    rows: list[Measured] = field(default_factory=list)
    values: dict[tuple[Configuration, str], Array] = field(default_factory=dict)
    reference: dict[str, Array] = field(default_factory=dict)
    floors: dict[str, float] = field(default_factory=dict)
    mesh_floors: dict[str, float] = field(default_factory=dict)
    compliance: Array | None = None
    knobs: list[Knob] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)


def _solve(gear: Gear, settings: MeshSettings, reach: int, sector_teeth: int) -> Influence:
    """Mesh and solve, past every cache."""
    support = gear.support_in_modules
    mesh = supported_sector(gear.tooth, gear.bore_radius / gear.module, settings, support)
    return solve_influence(
        gear.tooth, mesh, gear.material.poisson_ratio, gear.plane_assumption,
        order=settings.order, reach=reach, corner_distance=settings.corner_distance, sector_teeth=sector_teeth,
        support=support, solver=settings.solver,
    )  # fmt: skip


def solve_gears(asked: Asked, configuration: Configuration) -> tuple[dict[str, Influence], dict[str, Seconds]]:
    """Solve every gear that is needed by finite elements, from nothing; equal shapes once.

    Parameters
    ----------
    asked : Asked
    configuration : Configuration
        With settings.

    Returns
    -------
    influences, seconds : dict
        By the gears' names; a gear of the same shape as an earlier one takes no time.
    """
    settings = configuration.settings
    if settings is None:
        raise ValueError(f"{configuration.label} is not an FE configuration")
    found: dict[str, Influence] = {}
    seconds: dict[str, Seconds] = {}
    shapes: dict[object, Influence] = {}
    for name in asked.gears:
        gear = asked.scene.gears[name]
        shape = (gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption)
        if shape not in shapes:
            shapes[shape], seconds[name] = timed(
                functools.partial(_solve, gear, settings, needed_reach(asked.scene, name), configuration.teeth)
            )
        found[name] = shapes[shape]
        seconds.setdefault(name, NOTHING)
    return found, seconds


def finite_elements(asked: Asked, configuration: Configuration, solved: Mapping[str, Influence]) -> FiniteElements:
    """Solved gears with the patch of a configuration."""
    settings = configuration.settings
    if settings is None:
        raise ValueError(f"{configuration.label} is not an FE configuration")
    gears = asked.scene.gears
    return FiniteElements({name: GearInfluence(gears[name], one, None, settings, {}) for name, one in solved.items()})


def _record(found: Found, configuration: Configuration, source: Source, seconds: Mapping[str, Seconds]) -> None:
    """Answer and compare every quantity that a source knows."""
    asked = found.asked
    here = without_neighbours(asked) if configuration.family == "compliance-formula" else asked
    compliance = _compliance_error(found, here, source) if configuration.family != "stress-formula" else 0.0
    for quantity in answered(asked, configuration):
        solve = NOTHING
        for name in asked.gears_for(quantity):
            solve = solve.plus(seconds.get(name, NOTHING))
        try:
            values, own = timed(functools.partial(answer, here, quantity, source))
        except FegearError as problem:
            nothing = Miss(math.nan, math.nan, 0.0)
            found.rows.append(Measured(configuration, quantity.name, math.nan, nothing, solve, NOTHING, str(problem)))
            continue
        found.values[configuration, quantity.name] = values
        off = miss(quantity.name, values, found.reference[quantity.name])
        # A pair's quantity may be right by luck, of what cancels here, with a compliance that is wrong.
        stands_on = 0.0 if quantity.of_gear else compliance
        fixed = NOTHING if quantity.of_gear else own
        found.rows.append(
            Measured(configuration, quantity.name, largest(values), off, solve, own, "", stands_on, fixed)
        )


def _compliance_error(found: Found, asked: Asked, source: Source) -> float:
    """Largest relative error of the pair's c_0 by a source; infinite where it has none, zero where none is needed."""
    if found.compliance is None:
        return 0.0
    try:
        return miss("c_0", pair_compliance(asked, source), found.compliance).largest
    except FegearError:
        return math.inf


def largest(values: Array) -> float:
    """The value of largest size; NaN where there is none."""
    known = values[np.isfinite(values)]
    return float(known[np.argmax(np.abs(known))]) if known.size else math.nan


def refer(found: Found, ladder: Ladder) -> FiniteElements:
    """Solve the reference and the coarser one that shows its error."""
    asked = found.asked
    solved, _ = solve_gears(asked, ladder.reference)
    best = finite_elements(asked, ladder.reference, solved)
    settings = ladder.check.settings
    wider = ladder.check if settings is None else replace(
        ladder.check, settings=replace(settings, patch_half_width=_WIDER * settings.patch_half_width)
    )  # fmt: skip
    coarse, _ = solve_gears(asked, ladder.check)
    second = finite_elements(asked, wider, coarse)
    if asked.pair and not asked.tabled:
        found.compliance = pair_compliance(asked, best)
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


def _tolerance(found: Found, configuration: Configuration) -> None:
    """The time that a run takes for a tolerance: all solutions it makes, those for its own error estimate included."""
    scene = found.asked.scene
    accuracy = type(scene.case.accuracy)(tolerance=configuration.tolerance)
    wanted = replace(scene, case=scene.case.model_copy(update={"accuracy": accuracy}))
    solved: dict[str, GearInfluence] = {}
    seconds: dict[str, Seconds] = {}
    cache = SolutionCache()  # gears of one shape are solved once, as in a run
    for name in found.asked.gears:
        solved[name], seconds[name] = timed(
            functools.partial(solve_influence_functions, gear_to_solve(wanted, name), cache), repeat=False
        )
    _record(found, configuration, FiniteElements(solved), seconds)


def measure_alone(found: Found, configuration: Configuration) -> None:
    """A configuration on its own: a closed form, the case's table, or a tolerance."""
    if configuration.family == "tolerance":
        _tolerance(found, configuration)
    elif configuration.family == "table":
        _record(found, configuration, CaseTable(), {})
    elif configuration.family == "stress-formula":
        _record(found, configuration, StressFormula(configuration.formula), {})
    else:
        _record(found, configuration, ComplianceFormula(configuration.formula), {})


def measure_meshes(found: Found, group: tuple[Configuration, ...]) -> None:
    """Configurations that differ in the patch alone: the gears are solved once, and each is charged for that."""
    solved, seconds = solve_gears(found.asked, group[0])
    for configuration in group:
        _record(found, configuration, finite_elements(found.asked, configuration, solved), seconds)


def answered(asked: Asked, configuration: Configuration) -> list[Quantity]:
    """Quantities that a configuration knows anything of."""
    if asked.over_face:
        return list(asked.quantities)
    kinds: dict[str, frozenset[str]] = {
        "compliance-formula": ComplianceFormula.answers, "stress-formula": StressFormula.answers,
        "table": CaseTable.answers,
    }  # fmt: skip
    known = kinds.get(configuration.family, FiniteElements.answers)
    return [q for q in asked.quantities if q.name in known and asked.solves(q) != (configuration.family == "table")]


_SOLVERS: dict[str, Callable[..., FlankBody]] = {
    "thin-slices": solve_thin_slices, "coupled-slices": solve_slices, "solid": solve_solid,
}  # fmt: skip


#: Less is the round-off of the contact.
_WIDE_ROUND_OFF = 1e-13


def solve_bodies(scene: Scene, pair: str, body: str, settings: SolidSettings) -> dict[Member, FlankBody]:
    """Both gears of a pair as one kind of body, past every cache."""
    part, found = scene.case.pair[pair], {}
    for member, name in zip(MEMBERS, (part.driver, part.driven), strict=True):
        wanted = solid_gear_to_solve(scene, name)
        gear = wanted.gear
        # Slices know no web and no rim's support: what they neglect shows in their difference from the solid.
        more = {"body": gear.body_in_modules, "support": gear.support_in_modules} if body == "solid" else {}
        found[member] = _SOLVERS[body](
            gear.tooth, gear.twist * gear.module, gear.face_width / gear.module, gear.material.poisson_ratio,
            gear.bore_radius / gear.module, settings, reach=wanted.reach, **more,
        )  # fmt: skip
    return found


def refer_flanks(found: Found, ladder: Ladder) -> None:
    """Solve the reference, and what shows its error: coarser gears and fewer panels, each alone and both.

    Their largest difference counts: of both together alone, one could make up for the other.
    """
    asked, best, check = found.asked, ladder.reference, ladder.check
    fine, coarse = _solve_wide(asked, best), _solve_wide(asked, check)
    values = _values(_load(asked, best, fine))
    others = [_values(_load(asked, one, bodies)) for one, bodies in ((check, fine), (best, coarse), (check, coarse))]
    for quantity in asked.quantities:
        name = quantity.name
        found.reference[name] = values[name]
        found.floors[name] = max(_WIDE_ROUND_OFF, *(miss(name, other[name], values[name]).largest for other in others))


def measure_flanks(found: Found, group: tuple[Configuration, ...]) -> None:
    """Configurations of the same gears, which are solved once; each is charged for that."""
    bodies, solve = timed(partial(_solve_wide, found.asked, group[0]), repeat=False)
    for one in group:
        loaded, own = timed(partial(_load, found.asked, one, bodies))
        for name, value in _values(loaded).items():
            if name in found.reference:
                off = miss(name, value, found.reference[name])
                found.rows.append(Measured(one, name, float(value[0]), off, solve, own))


def _flank(configuration: Configuration) -> FlankConfiguration:
    if not isinstance(configuration, FlankConfiguration):
        raise TypeError(f"{configuration.label} is not a 3D pair")
    return configuration


def _solve_wide(asked: Asked, configuration: Configuration) -> dict[Member, FlankBody]:
    one = _flank(configuration)
    return solve_bodies(asked.scene, asked.pair, one.body, one.solid)


def _load(asked: Asked, configuration: Configuration, bodies: dict[Member, FlankBody]) -> LoadedFlanks:
    """The pair under its load as the case has it, but for panels, neighbours and shafts, whose loads stay even."""
    one, case = _flank(configuration), pair_spec(asked.scene, asked.pair, over_face=True)
    if case.misalignment and on_shafts(asked.scene, asked.pair):
        case = case.on(gaps_of_even_loads(gearbox_of(asked.scene), asked.pair))
    divided = replace(case.face, panels=one.panels)
    wanted = replace(case, wide=divided, neighbour_coupling=one.neighbours, loads=(case.nominal,))
    return load_flanks(wanted, bodies, SolutionCache())[2]


def _values(loaded: LoadedFlanks) -> dict[str, Array]:
    """Every quantity, shape (1,) each; SI."""
    return {
        "te-mean": loaded.mean_transmission_error,
        "te-peak-to-peak": np.ptp(loaded.transmission_error, axis=0),
        "face-load-factor": loaded.face_load_factor,
    }
