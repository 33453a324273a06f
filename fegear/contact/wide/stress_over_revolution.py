"""Root stress of every tooth of a gear with a width over all base pitches until the same teeth meet again.

From the line loads of each base pitch that differs from the others: up the fillets of each tooth, on either side of the
mouth of a crack, at places all along the face, under its own load and that of the teeth beside it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.stress_over_revolution import StressOfTeeth, off_of_largest, peak_positions, with_peaks
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

#: What is taken for an error of what longer panels and coarser gears change: root stress of a random pair with a crack
#: was off by 1.8 times as much.
_OF_CHANGES = 2.0


def wide_stress_over_revolution(followed: FollowedFlanks, member: Member, side: Side = "tension") -> StressOfTeeth:
    """Largest root stress over the face of every tooth of a gear, tooth after tooth.

    Its error is what longer panels and coarser gears change of it.

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
    found = with_peaks(_stress(followed, member, side), lambda roll: _stress(followed.at(roll), member, side))
    peaks = peak_positions(found)
    others = [_stress(one, member, side) for one in followed.less_exactly(peaks)]
    if not others:
        return found
    here = found.only(peaks)
    changes = [np.abs(one.stress - here.stress) for one in others]
    return replace(found, off=off_of_largest(here, _OF_CHANGES * np.sum(changes, axis=0)))


def usual_errors(*gears: StressOfTeeth) -> tuple[StressOfTeeth, ...]:
    """Both gears of a pair, errors of no tooth relatively below those of most teeth of either.

    What coarser gears change of the stress of one gear, or of one tooth, may be small by chance: beside a missing tooth
    it was a sixth of that of the other gear, whose stress was no farther off.
    """
    known = [(one.off, np.abs(one.largest)) for one in gears if one.off is not None]
    usual = max((float(np.median(off) / np.median(size)) for off, size in known), default=0.0)
    return tuple(
        one if one.off is None else replace(one, off=np.maximum(one.off, usual * np.abs(one.largest))) for one in gears
    )


def _stress(followed: FollowedFlanks, member: Member, side: Side) -> StressOfTeeth:
    """At the roll positions that were followed."""
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
    roll = np.concatenate([lines.roll for lines, _ in followed.parts])
    order = np.argsort(roll, kind="stable")
    cycle = np.arange(count)[:, None]
    tooth = number - cycle if member == "driver" else cycle - number
    every = np.concatenate(found, axis=2)[:, :, order]
    return StressOfTeeth(member, side, roll[order], pair.base_pitch, number, tooth % numbered, every, numbered)


def _rooted(flanks: FlankPair, member: Member, lines: ContactLines, cycle: int) -> Iterable[RootedLines]:
    """Contact lines on the teeth of a gear in a base pitch."""
    gear, known = flanks.gears[member], flanks.cache
    if isinstance(gear, OddSolid):
        return rooted_teeth(flanks.pair, member, lines, gear, cycle, coupling=flanks.coupling).values()
    assert isinstance(gear, SolidSolution)  # noqa: S101  (all that is followed over a revolution is solid)
    return [known.call(rooted_lines, flanks.pair, member, lines, gear, coupling=flanks.coupling).value]
