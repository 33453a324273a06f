"""Largest root stresses of a pair with a width under all its loads, with their errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import permutations
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.contact.plane.tooth_stress import LargestBetween, ToothStress
from fegear.fem.plane.influence import Side
from fegear.fem.plane.root_stress import curves_apart, usually_apart
from fegear.fem.solid.influence import BESIDE_LARGEST, OF_OTHER_FILLET, SolidInfluence
from fegear.fem.solid.solution import SolidSolution
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from fegear.contact.wide.error import FlankError
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.over_pitch import OverPitch
    from fegear.contact.wide.root_stress import RootedLines, StressOverFace

#: What is taken for an error of root stress, of the parts for single entries of influence: load lies all along a line
#: (six helical gears need 0.75; one of 116 places of a seventh is 1.36 times as much off). Of the largest stress of all
#: positions, which is one number, so much of the root mean square beside it counts (eight pairs need 0.6).
_OF_LINES, _OF_LARGEST = 1.0, 0.7
#: On teeth that only their neighbours' loads stress both solutions may agree by chance: no position errs by less than
#: this part of the root mean square of all (of eight helical gears two had 1.7 times the stated error there).
_OF_ALL_POSITIONS = 0.25
#: Both fillets, and the sign of the stress that is looked for.
_SIDES: Final[tuple[tuple[Side, float], ...]] = (("tension", 1.0), ("compression", -1.0))


class RootedPair(Protocol):
    """What is asked of a loaded pair: see `LoadedWidePair`."""

    @property
    def found(self) -> LoadedFlanks:
        """Under every load."""

    @property
    def over(self) -> OverPitch:
        """At the roll positions of the whole base pitch."""

    @property
    def error(self) -> FlankError:
        """Errors of `found`."""

    @property
    def at(self) -> int:
        """Number of the nominal load."""

    @property
    def estimated(self) -> bool:
        """Whether errors were estimated."""

    @property
    def places_along(self) -> Array:
        """Places along the face [m]."""

    def rooted(self, member: Member, found: LoadedFlanks, solution: SolidSolution) -> RootedLines:
        """Contact lines of all roll positions on a gear."""


def largest_over_face(
    loaded: RootedPair,
    member: Member,
    influence: SolidInfluence,
    over_face: dict[Member, dict[Side, StressOverFace]],
) -> tuple[ToothStress, float]:
    """Largest root stress over the face under every load, and that of tension across the root at the nominal load.

    Parameters
    ----------
    loaded : RootedPair
    member : {"driver", "driven"}
    influence : SolidInfluence
        Of that gear.
    over_face : mapping of {"driver", "driven"} to mapping
        Gets what it is all over the face at the nominal load.
    """
    coarse, z = loaded.error.coarse, loaded.places_along
    rooted, again, across = loaded.rooted(member, loaded.found, influence.fine), None, 0.0
    if loaded.estimated and influence.coarse:
        again = loaded.rooted(member, coarse, influence.coarse)
    largest: dict[Side, list[Array]] = {"tension": [], "compression": []}
    off: dict[Side, list[Array]] = {"tension": [], "compression": []}
    off_largest: dict[Side, list[float]] = {"tension": [], "compression": []}
    for i in range(loaded.found.load.size):
        force = loaded.found.contact.force[:, :, i]
        surface = {side: rooted.surface(side, force, z) for side, _ in _SIDES}
        felt = {side: rooted.stress(side, force, z, surface[side]) for side, _ in _SIDES}
        if i == loaded.at:
            over_face[member] = felt
            many = loaded.over.found
            across = loaded.rooted(member, many, influence.fine).largest(
                "tension", many.contact.force[:, :, i], z, across=True
            )
        apart: dict[Side, Array] = {}
        usual: dict[Side, float] = {}
        for side, sign in _SIDES:
            largest[side].append(felt[side].largest(sign)[0])
            if again:
                other = again.stress(side, coarse.contact.force[:, :, i], z)
                by_coarse = np.stack([np.interp(rooted.x, other.x, one) for one in other.value.T], axis=1)
                curves = sign * felt[side].value, sign * by_coarse
                share = _OF_LINES * influence.entry_shares[f"root_{side}"]
                apart[side] = no_less_than_usual(share * curves_apart(curves[0], curves[1], BESIDE_LARGEST))
                worst = int(np.argmax(sign * largest[side][-1]))
                usual[side] = share * float(usually_apart(curves[0][worst], curves[1][worst], BESIDE_LARGEST))
            else:  # slices know how far they are off
                off[side].append(influence.error.get(f"root_{side}", np.nan) * np.abs(largest[side][-1]))
                off_largest[side].append(float(off[side][-1].max()))
        scale = {side: np.abs(largest[side][-1]).max() for side in apart}
        for one, two in permutations(apart, 2):
            part = OF_OTHER_FILLET * scale[one] / scale[two]
            off[one].append(np.maximum(apart[one], part * apart[two]))
            off_largest[one].append(_OF_LARGEST * max(usual[one], part * usual[two]))
    stacked = [np.stack(one, axis=1) for one in (*largest.values(), *off.values())]
    tension, compression, tension_off, compression_off = stacked
    between = _largest_between(loaded, member, influence.fine, off_largest)
    return ToothStress(rooted.x, tension, compression, tension_off, compression_off, between), across


def _largest_between(
    loaded: RootedPair, member: Member, solution: SolidSolution, off: Mapping[Side, Sequence[float]]
) -> LargestBetween:
    """Largest root stresses at the roll positions of the whole base pitch: those of the table miss up to 6 %.

    Their errors are what coarser gears leave of them under each load, `off`, and what the positions do, which knows
    nothing of that.
    """
    from fegear.contact.wide.load_factors import left_of_largest

    found, z = loaded.over.found, loaded.places_along
    rooted = loaded.rooted(member, found, solution)
    most, x, along, error = {}, {}, {}, {}

    def left(values: Array) -> Array:
        return left_of_largest(values, rooted.teeth[:, 0], found.lines.roll.size)

    for side, sign in _SIDES:
        felt = [rooted.stress(side, found.contact.force[:, :, i], z).largest(sign) for i in range(found.load.size)]
        values, places = (np.stack([one[k] for one in felt], axis=1) for k in (0, 1))
        at = first_of_largest(sign * values, axis=0), np.arange(found.load.size)
        most[side], x[side], along[side] = values[at], rooted.x[at[0]], places[at]
        error[side] = np.hypot(off[side], left(sign * values))
        if side == "tension":
            least = values.min(axis=0), left(-values)
    return LargestBetween(
        most["tension"], most["compression"], x["tension"], along["tension"], x["compression"], error["tension"],
        error["compression"], *least,
    )  # fmt: skip


def no_less_than_usual(error: Array) -> Array:
    """Errors at the positions of a tooth, shape (T,), none less than a part of their root mean square."""
    return np.maximum(error, _OF_ALL_POSITIONS * float(np.sqrt(np.mean(error**2))))
