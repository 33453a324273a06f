"""Stage ``solid-rack-solution``: the teeth of a rack with their width solved by finite elements."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple, cast

from fegear.case.built.rack import check_body, is_wide_rack, rack_inputs, racks
from fegear.case.built.solid_influence import seconds_of_solid_gear, solid_settings_of
from fegear.case.part import at
from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solid_solution

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.solid.rack.rack_flank import SolidRackSpec
    from fegear.fem.solid.rack.solid_rack import SolidRack
    from fegear.fem.solid.settings import SolidSettings
    from fegear.geometry.toothed_rack import Rack

#: Name of the stage.
SOLUTION = "solid-rack-solution"


@dataclass(frozen=True)
class SolidRackToSolve:
    """A rack with its width, and how finely it is solved."""

    rack: Rack
    settings: SolidSettings
    reach: int
    name: str = field(compare=False)
    pinion: str = field(compare=False)

    @classmethod
    def of(cls, scene: Scene, name: str) -> SolidRackToSolve:
        """As `Stage.inputs`."""
        asked = rack_inputs(scene, name)
        settings = replace(solid_settings_of(scene, asked.pinion), source="solid")
        return cls(asked.pair.rack, settings, math.ceil(asked.pair.total_contact_ratio), name, asked.pinion)

    def spec(self, settings: SolidSettings) -> SolidRackSpec:
        """The rack in modules."""
        from fegear.fem.solid.rack.rack_flank import SolidRackSpec

        rack, pins, m = self.rack, self.rack.pins, self.rack.module
        held = () if pins is None else tuple(pins.holds(i) for i in range(rack.teeth))
        return SolidRackSpec(
            rack.tooth, rack.slide, rack.face_width / m, rack.body / m, rack.teeth, rack.material.poisson_ratio,
            settings, self.reach, held, 0.0 if pins is None else pins.width / m,
        )  # fmt: skip


class BothRacks(NamedTuple):
    """A solved rack, and a coarser solution that shows its error."""

    fine: SolidRack
    coarse: SolidRack


def _compute(asked: SolidRackToSolve, _upstream: Upstream, work: Work) -> BothRacks:
    from fegear.base.errors import InputError
    from fegear.fem.solid.rack.solid_rack import solve_solid_rack

    coarser = asked.settings.coarser(asked.rack.face_width / asked.rack.module)
    try:
        fine, coarse = (work.cache.call(solve_solid_rack, asked.spec(one)).value for one in (asked.settings, coarser))
    except InputError as error:
        raise at(f"rack.{asked.name}", error) from None
    return BothRacks(fine, coarse)


def solid_rack_of(upstream: Upstream, name: str) -> BothRacks:
    """A rack that was solved with its width."""
    return cast("BothRacks", upstream[Task(SOLUTION, name)])


def needs_solid_rack(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks that solve a rack and its pinion with their width."""
    return (Task(SOLUTION, name), *needs_solid_solution(rack_inputs(scene, name).pinion))


def _check(scene: Scene, name: str) -> None:
    from fegear.base.errors import InputError, RangeError
    from fegear.fem.solid.settings import check_width

    asked = SolidRackToSolve.of(scene, name)
    rack, m = asked.rack, asked.rack.module
    check_body(name, rack)
    given = scene.case.rack[name].face_width is not None or scene.case.gear[asked.pinion].face_width is not None
    if not given:
        raise InputError(f"rack.{name}.face_width", "(not given)", "is required for 3D racks",
                         'set face_width = "20 mm"')  # fmt: skip
    try:
        check_width(rack.face_width / m, asked.settings)
    except RangeError as error:
        raise at(f"rack.{name}", error) from None


def _forecast(scene: Scene, name: str) -> Forecast:
    asked = SolidRackToSolve.of(scene, name)
    width = asked.rack.face_width / asked.rack.module
    seconds = seconds_of_solid_gear(
        asked.settings, width, apart=asked.rack.slide == 0.0, on_a_web=False, rim_free=False, holed=False
    )
    return Forecast(asdict(asked.settings), seconds)


def wide_racks(scene: Scene) -> tuple[str, ...]:
    """Racks that are solved with their width."""
    return tuple(name for name in racks(scene) if is_wide_rack(scene, name))


SOLID_RACK_SOLUTION = Stage(
    subjects=wide_racks,
    inputs=SolidRackToSolve.of,
    compute=_compute,
    present=lambda data, _asked: Outcome(data, settings={"unknowns": data.fine.unknowns}),
    check=_check,
    cites=citing(*RING),
    forecast=_forecast,
)
