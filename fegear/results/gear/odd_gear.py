"""Stage ``odd-gear-solution``: a gear with odd teeth, solved from the same gear of ordinary ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.notes import exceeding
from fegear.base.printed import percent, percents
from fegear.case.built.odd_gears import loaded_on_both_flanks, on_other_flank, reshaped_gears
from fegear.case.built.odd_teeth import OddTeeth, check_odd_gear, odd_teeth_of
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.results.forecasts import RING
from fegear.results.gear.solved_gear import needs_solution, solution_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence

#: The stage's name.
ODD = "odd-gear-solution"
#: That of the same gears on the flanks with which they drive, where they are driven by the others.
OTHER = "odd-gear-other-flank"
#: Both.
ODD_SOLUTIONS = (ODD, OTHER)
#: Seconds of a ring with one odd sector with the default settings, and of each further odd tooth.
_RING, _CRACK = 0.12, 0.08
#: Places over the flank at which a crack is looked at; beyond which share of them it counts as closed.
_PLACES, _MOSTLY = 11, 0.5
#: What results on cracks rest on.
CRACKS = (
    *RING,
    Citation("henshell-shaw", "quarter-point elements at the crack tip"),
    Citation("yau-wang-corten", "stress intensity factors by the interaction integral"),
)


def needs_odd_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks that solve gears with odd teeth."""
    return tuple(Task(ODD, name) for name in dict.fromkeys(gears))


def needs_odd_solution_in(scene: Scene, pair: str, *gears: str) -> tuple[Task, ...]:
    """The same on the flanks that a pair loads."""
    return tuple(Task(OTHER if on_other_flank(scene, pair, name) else ODD, name) for name in dict.fromkeys(gears))


def odd_solution_of(upstream: Upstream, gear: str) -> OddGearInfluence:
    """A gear with odd teeth that was solved, on the flank that was asked for."""
    found = upstream.get(Task(ODD, gear)) or upstream[Task(OTHER, gear)]
    return cast("OddGearInfluence", found)


def _compute(asked: OddTeeth, upstream: Upstream, work: Work) -> OddGearInfluence:
    from fegear.fem.plane.odd.odd_solution import solve_cracked_gear

    ordinary = solution_of(upstream, asked.name)
    return solve_cracked_gear(ordinary, asked.by_number(ordinary.gear.teeth), cache=work.cache)


def _forecast(scene: Scene, name: str) -> Forecast:
    return Forecast(seconds=_RING + _CRACK * len(scene.case.gear[name].odd_tooth))


def _closed(seen: Seen) -> Iterator[str]:
    """Cracks that loads on their own tooth press together: whether open faces are exact, and what they are taken as."""
    found: OddGearInfluence = seen.data
    for tooth, crack in seen.asked.cracks:
        number = meshing_order(tooth, found.gear.teeth, seen.asked.member)
        low, high = found.ends(found.from_middle(number))
        radii = np.linspace(low, high, _PLACES)[1:-1]
        who = f"Gear {seen.asked.name}: loads on tooth {tooth}"
        if crack.closing:
            share = found.faces_under(number, {number: (radii, np.ones(np.shape(radii)))})
            if share.any():
                yield (
                    f"{who} close {percents(float(share.min()), float(share.max()))} of its crack faces "
                    "(frictionless contact)."
                )
            else:
                yield (
                    f'{who} open its crack over the full length; crack_faces = "open" gives the same deflection under '
                    "them, and a negative K_I where loads on neighbouring teeth close it."
                )
            continue
        shut = found.stress_intensity(number, number, radii)[0][0] < 0.0
        if shut.mean() > _MOSTLY:
            yield exceeding(
                f"{who} close its crack (K_I negative over {percent(float(shut.mean()))} of the flank). Open "
                "faces are assumed: its deflection, and the reduction of the mesh stiffness, are overestimated many "
                'times; set crack_faces = "closing".'
            )


ODD_GEAR = Stage(
    subjects=reshaped_gears,
    needs=lambda _scene, name: needs_solution(name),
    inputs=odd_teeth_of,
    compute=_compute,
    present=Sheet(remarks=(_closed,)).present,
    check=check_odd_gear,
    cites=citing(*CRACKS),
    forecast=_forecast,
)


#: Gears that drive with one flank and are driven by the other: planets.
ODD_GEAR_OTHER_FLANK = Stage(
    subjects=loaded_on_both_flanks,
    needs=lambda _scene, name: needs_solution(name),
    inputs=lambda scene, name: odd_teeth_of(scene, name).on_other_flank(),
    compute=_compute,
    present=Sheet().present,
    check=check_odd_gear,
    cites=citing(*CRACKS),
    forecast=_forecast,
)
