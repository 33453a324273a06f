"""Faces of a crack on its way through the mesh: how much of them presses under the loads that the teeth share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.tooth_in_mesh import ToothInMesh
from fegear.geometry.pair import Member

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.over_revolution import OverRevolution
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence


#: Share of the load below which a tooth carries next to nothing: there its neighbours' loads alone move the faces.
_CARRIES = 0.01


@dataclass(frozen=True)
class FacesInMesh:
    """Faces of one crack while its tooth carries load, shape (P,).

    Parameters
    ----------
    tooth : int
        In meshing order.
    member : {"driver", "driven"}
    closed : ndarray
        Share of the faces' nodes that press on each other.
    """

    tooth: int
    member: Member
    closed: Array


def faces_in_mesh(
    engagement: Engagement, found: OverRevolution, member: Member, influence: OddGearInfluence, tooth: int
) -> FacesInMesh:
    """Follow the faces of a crack that may close.

    Parameters
    ----------
    engagement : Engagement
    found : OverRevolution
        Its loads.
    member : {"driver", "driven"}
        The gear that has the crack.
    influence : OddGearInfluence
        Of this gear.
    tooth : int
        The cracked tooth by its own number.
    """
    way = ToothInMesh(engagement, found, member, influence, tooth)
    closed = [np.zeros(0)]
    for row_of_tooth, number in enumerate(found.number):  # base pitches in which its tooth is on this pair
        loads, teeth = way.in_pitch(int(number))
        at = np.flatnonzero(loads[row_of_tooth] > _CARRIES * found.load)
        if not at.size:
            continue
        here = {
            one: (way.radius[row, at], loads[row, at] / way.width)
            for row, one in enumerate(teeth)
            if (loads[row, at] > 0.0).any()
        }
        closed.append(influence.faces_under(teeth[row_of_tooth], here))
    return FacesInMesh(way.order, member, np.concatenate(closed))
