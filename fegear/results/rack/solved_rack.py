"""Stage ``rack-solution``: the teeth of a rack solved by finite elements, with the settings of its pinion."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, NamedTuple, cast

from fegear.case.built.rack import check_body, rack_inputs, rack_pinion, racks
from fegear.case.part import at
from fegear.engine.citation import citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solution, solution_of

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.rack.rack_teeth import RackCompliance, RackTeeth
    from fegear.engine.stage import Forecast, Upstream, Work
    from fegear.fem.plane.gear import GearInfluence
    from fegear.geometry.rack_and_pinion import RackAndPinion
    from fegear.geometry.toothed_rack import Rack

#: Name of the stage.
SOLUTION = "rack-solution"
#: Neighbours on either side that a loaded tooth of a rack is coupled to.
REACH = 2
#: Seconds of one sector and its row, besides that of the pinion.
_SECONDS = 0.15


@dataclass(frozen=True)
class RackToSolve:
    """A rack, and on which pinion."""

    rack: Rack
    name: str = field(compare=False)
    pinion: str = field(compare=False)

    @classmethod
    def of(cls, scene: Scene, name: str) -> RackToSolve:
        """As `Stage.inputs`."""
        asked = rack_inputs(scene, name)
        return cls(asked.pair.rack, name, asked.pinion)


class BothOrders(NamedTuple):
    """A rack's teeth by elements of two orders, of which the lower shows the error; None where it is not asked for."""

    fine: RackTeeth
    coarse: RackTeeth | None


def _compute(asked: RackToSolve, upstream: Upstream, _work: Work) -> BothOrders:
    from fegear.base.errors import InputError
    from fegear.contact.rack.rack_teeth import RackTeeth
    from fegear.fem.plane.rack.solved_rack import solve_rack_teeth
    from fegear.fem.plane.settings import LEVEL_RATIO

    rack, known = asked.rack, solution_of(upstream, asked.pinion)
    settings, pins = known.settings, rack.pins
    held = () if pins is None else tuple(pins.holds(i) for i in range(rack.teeth))
    try:
        fine, coarse, _ = solve_rack_teeth(
            rack.tooth, rack.body / rack.module, rack.teeth, rack.material.poisson_ratio, rack.plane, settings,
            reach=REACH, held=held, pin_width=0.0 if pins is None else pins.width / rack.module,
        )  # fmt: skip
    except InputError as error:
        raise at(f"rack.{asked.name}", error) from None
    coarser = settings.refined(LEVEL_RATIO)
    other = None
    if known.states_error:
        lower = replace(coarse, corner_distance=coarser.corner_distance)
        other = RackTeeth(rack, lower, coarser.patch_half_width)
    return BothOrders(RackTeeth(rack, fine, settings.patch_half_width), other)


def needs_rack(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks that solve a rack and its pinion."""
    return (Task(SOLUTION, name), *needs_solution(rack_pinion(scene, name)))


def rack_of(upstream: Upstream, name: str) -> BothOrders:
    """A rack that was solved."""
    return cast("BothOrders", upstream[Task(SOLUTION, name)])


def compliances(
    pair: RackAndPinion, rack: BothOrders, pinion: GearInfluence
) -> tuple[RackCompliance, RackCompliance | None]:
    """The loaded pair by both orders of elements."""
    from fegear.contact.plane.fe_compliance import finite_element_compliance
    from fegear.contact.rack.rack_teeth import RackCompliance

    fine = RackCompliance(pair, finite_element_compliance(pinion), rack.fine)
    if rack.coarse is None or pinion.coarse is None:
        return fine, None
    lower = replace(pinion, fine=pinion.coarse, estimate=None)
    return fine, RackCompliance(pair, finite_element_compliance(lower), rack.coarse)


def _present(data: BothOrders, _asked: RackToSolve) -> Outcome:
    return Outcome(data, settings={"unknowns": data.fine.solved.unknowns})


def _check(scene: Scene, name: str) -> None:
    check_body(name, rack_inputs(scene, name).pair.rack)


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return forecasts.constant(_SECONDS)


RACK_SOLUTION = Stage(
    subjects=racks,
    needs=lambda scene, name: needs_solution(rack_pinion(scene, name)),
    inputs=RackToSolve.of,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(*RING),
    forecast=_forecast,
)
