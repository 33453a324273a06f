"""The tool rolling through one space of either gear of a pair in mesh: its positions, whose envelope is the profile."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.geometry.outline import tool_in_space
from fegear.geometry.pair import MEMBERS
from fegear.results.drawn_pair import placed_in_mesh

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member

#: Positions of the tool in one space.
_POSITIONS = 31
#: Beside which teeth: clear of the teeth in contact on either side.
_BESIDE: Mapping[Member, int] = {"driver": 1, "driven": -1}


def tool_envelope(pair: GearPair) -> dict[Member, Array]:
    """The rack tool's positions in the space beside a tooth next to the one that touches at the pitch point.

    Parameters
    ----------
    pair : GearPair

    Returns
    -------
    dict of str to ndarray, shape (positions, 2, N)
        By member, where `placed_in_mesh` puts the tooth [m].
    """
    found: dict[Member, Array] = {}
    for member in MEMBERS:
        gear = pair.gear(member)
        at = tool_in_space(gear.tooth, _POSITIONS) * gear.module
        found[member] = placed_in_mesh(pair, member, at.transpose(1, 0, 2), _BESIDE[member]).transpose(1, 0, 2)
    return found
