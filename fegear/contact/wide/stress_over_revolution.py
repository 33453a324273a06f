"""Root stress of every tooth of a gear with a width over all base pitches until the same teeth meet again.

From the line loads of each base pitch that differs from the others: up the fillets of each tooth, on either side of the
mouth of a crack, at places all along the face, under its own load and that of the teeth beside it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.over_revolution import StressOfTeeth
from fegear.contact.wide.root_stress import SIGN, places_along, rooted_lines, rooted_teeth
from fegear.fem.solid.odd.odd_solid import OddSolid
from fegear.fem.solid.solution import SolidSolution

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.contact.wide.lines import ContactLines
    from fegear.contact.wide.loaded import FlankPair
    from fegear.contact.wide.over_revolution import FollowedFlanks
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.fem.plane.influence import Side
    from fegear.geometry.pair import Member


def wide_stress_over_revolution(followed: FollowedFlanks, member: Member, side: Side = "tension") -> StressOfTeeth:
    """Largest root stress over the face of every tooth of a gear, tooth after tooth.

    Parameters
    ----------
    followed : FollowedFlanks
        Of solid gears.
    member : {"driver", "driven"}
    side : {"tension", "compression"}

    Returns
    -------
    StressOfTeeth
        Of teeth that are on a contact line; zero elsewhere.
    """
    flanks, number, count = followed.flanks, followed.over.number, followed.cycles
    pair, found = flanks.pair, []
    for lines, forces in followed.parts:
        z = places_along(lines, pair.driver.module)
        stress = np.zeros((count, number.size, lines.roll.size))
        for pitches, force in zip(followed.pitches, forces, strict=True):
            here = pitches[pitches < count]
            for one in _rooted(flanks, member, lines, int(pitches[0])):
                largest = one.stress(side, force, z).largest(SIGN[side])[0]
                position, j = one.teeth.T
                on = np.isin(j, number)
                stress[here[:, None], np.searchsorted(number, j[on]), position[on]] = largest[on]
        found.append(stress)
    numbered = min(pair.gear(member).teeth, count)
    order = np.argsort(np.concatenate([lines.roll for lines, _ in followed.parts]), kind="stable")
    cycle = np.arange(count)[:, None]
    tooth = number - cycle if member == "driver" else cycle - number
    every = np.concatenate(found, axis=2)[:, :, order]
    return StressOfTeeth(member, side, followed.over.x, tooth % numbered, every, numbered)


def _rooted(flanks: FlankPair, member: Member, lines: ContactLines, cycle: int) -> Iterable[RootedLines]:
    """Contact lines on the teeth of a gear in a base pitch."""
    gear, known = flanks.gears[member], flanks.cache
    if isinstance(gear, OddSolid):
        return rooted_teeth(flanks.pair, member, lines, gear, cycle, coupling=flanks.coupling).values()
    assert isinstance(gear, SolidSolution)  # noqa: S101  (all that is followed over a revolution is solid)
    return [known.call(rooted_lines, flanks.pair, member, lines, gear, coupling=flanks.coupling).value]
