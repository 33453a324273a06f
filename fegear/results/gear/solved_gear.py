"""A gear solved by finite elements, plane or with its width: the stages that solve one, and how results get at it.

The two kinds answer in their own terms: a plane gear per line load, in SI; a solid one for bands of pressure on its
flank, in modules. What results of a pair need of either comes through `fegear.contact.loaded_teeth`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, cast

from fegear.base.errors import RangeError
from fegear.case.built.atlas_teeth import (
    GearFromAtlas,
    atlas_remarks,
    check_atlas_gear,
    from_atlas,
    known_teeth,
    solved_remarks,
    why_not_known,
)
from fegear.case.built.rated_duty import thin_rim_remarks
from fegear.case.built.solid_influence import (
    SolidGearToSolve,
    check_solid_gear,
    seconds_of_solid_gear,
    solid_gear_to_solve,
    solid_settings_of,
    solid_solution_settings,
    solid_support_remarks,
    solve_solid_influence,
)
from fegear.case.built.tooth_influence import (
    GearToSolve,
    check_plane_gear,
    gear_to_solve,
    mesh_settings,
    solution_remarks,
    solution_settings,
    solve_influence_functions,
)
from fegear.case.reading import Scene
from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import RING

if TYPE_CHECKING:
    from fegear.atlas.atlas_gear import AtlasGear
    from fegear.contact.plane.fe_compliance import SolvedTeeth
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Influence
    from fegear.fem.solid.influence import SolidInfluence

#: Stages of plane gears, solved and from an atlas, and of gears with their width.
PLANE, ATLAS, SOLID = "gear-solution", "atlas-gear", "solid-solution"
#: How many times the solution of a plane gear reports that it goes on, about.
_STEPS = 4
#: Seconds of a gear from an atlas.
_LOOK_UP = 0.02


def _needs(stage: str, gears: tuple[str, ...]) -> tuple[Task, ...]:
    return tuple(Task(stage, name) for name in dict.fromkeys(gears))


def needs_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks that solve plane gears, each once."""
    return _needs(PLANE, gears)


def needs_solid_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks that solve gears with their width, each once."""
    return _needs(SOLID, gears)


def needs_teeth_of(scene: Scene, *gears: str) -> tuple[Task, ...]:
    """The tasks that give what contact asks of plane gears: solved, or from an atlas where the case says so."""
    return tuple(Task(ATLAS if from_atlas(scene, name) else PLANE, name) for name in dict.fromkeys(gears))


def held_by_atlases(scene: Scene, gears: Iterable[str], tolerance: float) -> frozenset[str]:
    """Those of some gears that an atlas answers about with a tolerance."""
    return frozenset(name for name in gears if not why_not_known(scene, name, tolerance))


def teeth_of(upstream: Upstream, gear: str) -> SolvedTeeth:
    """What contact asks of a plane gear that was solved or is from an atlas."""
    task = Task(ATLAS, gear)
    return cast("SolvedTeeth", upstream[task] if task in upstream else upstream[Task(PLANE, gear)])


def solution_of(upstream: Upstream, gear: str) -> GearInfluence:
    """A plane gear that was solved."""
    return cast("GearInfluence", upstream[Task(PLANE, gear)])


def solid_solution_of(upstream: Upstream, gear: str) -> SolidInfluence:
    """A gear that was solved with its width."""
    return cast("SolidInfluence", upstream[Task(SOLID, gear)])


def _solve(asked: GearToSolve, _upstream: Upstream, work: Work) -> GearInfluence:
    steps = iter(range(_STEPS))
    return solve_influence_functions(asked, work.cache, lambda _title: work.progress(next(steps, _STEPS) / _STEPS))


def _present(influence: GearInfluence, asked: GearToSolve) -> Outcome:
    remarks = (*solved_remarks(asked.name, asked.why), *solution_remarks(asked.name, influence, asked.tolerance))
    return Outcome(influence, settings=solution_settings(influence), remarks=remarks)


def _look_up(asked: GearFromAtlas, _upstream: Upstream, _work: Work) -> AtlasGear:
    return known_teeth(asked.gear)


def _present_from_atlas(known: AtlasGear, asked: GearFromAtlas) -> Outcome:
    return Outcome(known, settings={"atlas": asked.made_from[:12]}, remarks=atlas_remarks(asked, known))


def _forecast(scene: Scene, name: str) -> Forecast:
    settings = mesh_settings(scene.case.accuracy)
    if scene.case.gear[name].tooth_mesh is not None:
        return Forecast({"mesh": scene.case.gear[name].tooth_mesh, "order": settings.order})
    return Forecast(asdict(settings), 0.0, forecasts.shapes(scene, [name]))


def _solve_solid(asked: SolidGearToSolve, _upstream: Upstream, work: Work) -> SolidInfluence:
    return solve_solid_influence(asked, work.cache)


def _present_solid(influence: SolidInfluence, asked: SolidGearToSolve) -> Outcome:
    body = asked.gear.body
    tooth = None if body is None or body.holes is None else body.holes.tooth
    remarks = solid_support_remarks(asked.name, influence, tooth)
    if body is None and not asked.cut:
        remarks += thin_rim_remarks(asked.name, asked.gear)
    return Outcome(influence, settings=solid_solution_settings(influence), remarks=remarks)


def _forecast_solid(scene: Scene, name: str) -> Forecast:
    settings, gear = solid_settings_of(scene, name), scene.gears[name]
    if gear.support is not None and not gear.tooth.internal:
        raise RangeError(
            f"gear.{name}.rim_support.kind", f'"{gear.support.kind}"',
            "is available for plane (2D) gears and internal gears only", "specify rim and web in body",
        )  # fmt: skip
    body, width = gear.body, gear.face_width / gear.module
    apart = gear.flank_twist == 0.0 and (body is None or body.even)
    seconds = seconds_of_solid_gear(
        settings, width, apart=apart, on_a_web=body is not None, rim_free=gear.support is not None,
        holed=body is not None and body.holes is not None,
    )  # fmt: skip
    return Forecast(asdict(settings), seconds)


@dataclass(frozen=True)
class Reach:
    """What a table of unit loads on one gear depends on besides the gear's solution."""

    teeth: int


def of_solved_gear(compute: Callable[[Influence, int], Any], reach: int, seconds: float) -> Stage:
    """The stage of what one solved spur gear gives by itself, for results of its pairs.

    Parameters
    ----------
    compute : callable
        ``compute(fine, reach)``, of the gear's finer solution.
    reach : int
        Neighbours to either side of the loaded tooth that it is known for.
    seconds : float
        What it takes.
    """

    def found(asked: Reach, upstream: Upstream, _work: Work) -> Any:
        (influence,) = upstream.values()
        return compute(cast("GearInfluence", influence).fine, asked.teeth)

    return Stage(
        subjects=lambda scene: tuple(scene.spur_gears),
        needs=lambda _scene, name: needs_solution(name),
        inputs=lambda _scene, _name: Reach(reach),
        compute=found,
        present=lambda data, _inputs: Outcome(data),
        cites=citing(*RING),
        forecast=lambda _scene, _name: forecasts.constant(seconds),
    )


GEAR_SOLUTION = Stage(
    subjects=lambda scene: tuple(scene.spur_gears),
    inputs=gear_to_solve,
    compute=_solve,
    present=_present,
    check=check_plane_gear,
    cites=citing(*RING),
    forecast=_forecast,
)


ATLAS_GEAR = Stage(
    subjects=lambda scene: tuple(scene.spur_gears),
    inputs=GearFromAtlas.of,
    compute=_look_up,
    present=_present_from_atlas,
    check=check_atlas_gear,
    cites=citing(*RING),
    forecast=lambda _scene, _name: forecasts.constant(_LOOK_UP),
)


SOLID_SOLUTION = Stage(
    subjects=lambda scene: tuple(scene.gears),
    inputs=solid_gear_to_solve,
    compute=_solve_solid,
    present=_present_solid,
    check=check_solid_gear,
    cites=citing(*RING),
    forecast=_forecast_solid,
)
