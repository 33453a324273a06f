"""Stage ``gear-solution``: the influence functions of a gear by finite elements, for every result that needs them."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, cast

from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.models.settings import mesh_settings
from fegear.models.tooth_influence import (
    gear_to_solve,
    solution_remarks,
    solution_settings,
    solve_influence_functions,
)
from fegear.results import forecasts
from fegear.results.sources import RING

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem import GearInfluence
    from fegear.models.tooth_influence import GearToSolve

#: How many times a solution reports that it goes on, about.
_STEPS = 4


def needs_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks of this stage for gears, each once."""
    return tuple(Task("gear-solution", name) for name in dict.fromkeys(gears))


def solution_of(upstream: Upstream, gear: str) -> GearInfluence:
    """What this stage computed for a gear."""
    return cast("GearInfluence", upstream[Task("gear-solution", gear)])


def _compute(asked: GearToSolve, _upstream: Upstream, work: Work) -> GearInfluence:
    steps = iter(range(_STEPS))
    return solve_influence_functions(asked, work.cache, lambda _title: work.progress(next(steps, _STEPS) / _STEPS))


def _present(influence: GearInfluence, asked: GearToSolve) -> Outcome:
    remarks = solution_remarks(asked.name, influence, asked.tolerance)
    return Outcome(influence, settings=solution_settings(influence), remarks=remarks)


def _forecast(scene: Scene, name: str) -> Forecast:
    settings = mesh_settings(scene.case.accuracy)
    if scene.case.gear[name].tooth_mesh is not None:
        return Forecast({"mesh": scene.case.gear[name].tooth_mesh, "order": settings.order})
    return Forecast(asdict(settings), 0.0, forecasts.shapes(scene, [name]))


GEAR_SOLUTION = Stage(
    subjects=lambda scene: tuple(scene.spur_gears),
    inputs=gear_to_solve,
    compute=_compute,
    present=_present,
    cites=citing(*RING),
    forecast=_forecast,
)
