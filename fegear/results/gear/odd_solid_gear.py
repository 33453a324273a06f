"""Stage ``odd-solid-solution``: a 3D gear with cracked or missing teeth."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, cast

from fegear.base.notes import exceeding, neglecting
from fegear.case.built.odd_gears import reshaped_solid_gears
from fegear.case.built.odd_solid_teeth import (
    OddSolidToSolve,
    check_odd_solid_gear,
    odd_solid_to_solve,
    solve_odd_solid_gear,
)
from fegear.case.built.solid_influence import check_solid_gear, seconds_of_solid_gear, solid_settings_of
from fegear.engine.citation import citing
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.gear.odd_gear import CRACKS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.solid.odd.odd_solid_influence import OddSolidInfluence

#: The stage's name.
ODD_SOLID = "odd-solid-solution"
#: How much longer a gear with one odd tooth takes, and each further one adds.
_RING, _TOOTH = 1.8, 0.6


def needs_odd_solid(*gears: str) -> tuple[Task, ...]:
    """The tasks that solve 3D gears with odd teeth."""
    return tuple(Task(ODD_SOLID, name) for name in dict.fromkeys(gears))


def odd_solid_of(upstream: Upstream, gear: str) -> OddSolidInfluence:
    """A 3D gear with odd teeth that was solved."""
    return cast("OddSolidInfluence", upstream[Task(ODD_SOLID, gear)])


def _compute(asked: OddSolidToSolve, _upstream: Upstream, work: Work) -> OddSolidInfluence:
    return solve_odd_solid_gear(asked, work.cache)


def _check(scene: Scene, name: str) -> None:
    check_solid_gear(scene, name)
    check_odd_solid_gear(scene, name)


def _open(seen: Seen) -> Iterator[str]:
    """What is assumed of cracks."""
    asked: OddSolidToSolve = seen.asked
    gear = asked.teeth.name
    for tooth, crack in asked.teeth.cracks:
        if crack.back:
            yield exceeding(
                f"Gear {gear}: loads on tooth {tooth} close its crack (fillet of the opposite flank). Open "
                "faces are assumed in 3D: its deflection is overestimated many times; use a plane (2D) pair with "
                'crack_faces = "closing".'
            )
        else:
            yield neglecting(
                f"Gear {gear}: contact of the crack faces of tooth {tooth} is neglected (3D pair): loads on the tooth "
                "open them, loads on the next tooth close them."
            )


def _settings(seen: Seen) -> dict[str, object]:
    found: OddSolidInfluence = seen.data
    settings = asdict(found.settings)
    return {**settings, "seconds": {key: round(seconds, 6) for key, seconds in found.seconds.items()}}


def _forecast(scene: Scene, name: str) -> Forecast:
    settings, gear = solid_settings_of(scene, name), scene.gears[name]
    width, body = gear.face_width / gear.module, gear.body
    apart = gear.flank_twist == 0.0 and (body is None or body.even)
    usual = seconds_of_solid_gear(settings, width, apart=apart, on_a_web=body is not None)
    more = _TOOTH * (len(scene.case.gear[name].odd_tooth) - 1)
    return Forecast(asdict(settings), (_RING + more) * usual)


ODD_SOLID_GEAR = Stage(
    subjects=reshaped_solid_gears,
    inputs=odd_solid_to_solve,
    compute=_compute,
    present=Sheet(remarks=(_open,), settings=_settings).present,
    check=_check,
    cites=citing(*CRACKS[:-1]),
    forecast=_forecast,
)
