"""Stage ``solid-solution``: the influence functions of a gear with its width, for every result that needs them."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, cast

from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.models.solid_influence import (
    check_solid_gear,
    seconds_of_solid_gear,
    solid_gear_to_solve,
    solid_settings_of,
    solid_solution_settings,
    solve_solid_influence,
)
from fegear.results.sources import RING

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.solid import SolidInfluence
    from fegear.models.solid_influence import SolidGearToSolve


def needs_solid_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks of this stage for gears, each once."""
    return tuple(Task("solid-solution", name) for name in dict.fromkeys(gears))


def solid_solution_of(upstream: Upstream, gear: str) -> SolidInfluence:
    """What this stage computed for a gear."""
    return cast("SolidInfluence", upstream[Task("solid-solution", gear)])


def _compute(asked: SolidGearToSolve, _upstream: Upstream, work: Work) -> SolidInfluence:
    return solve_solid_influence(asked, work.cache)


def _present(influence: SolidInfluence, _asked: SolidGearToSolve) -> Outcome:
    return Outcome(influence, settings=solid_solution_settings(influence))


def _forecast(scene: Scene, name: str) -> Forecast:
    settings, gear = solid_settings_of(scene, name), scene.gears[name]
    return Forecast(asdict(settings), seconds_of_solid_gear(settings, gear.face_width / gear.module))


SOLID_SOLUTION = Stage(
    subjects=lambda scene: tuple(scene.gears),
    inputs=solid_gear_to_solve,
    compute=_compute,
    present=_present,
    check=check_solid_gear,
    cites=citing(*RING),
    forecast=_forecast,
)
