"""One tooth on its way through the mesh: which teeth are loaded beside it, where on their flanks, and how much."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.alike_teeth import meshing_order

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.over_revolution import OverRevolution
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence
    from fegear.geometry.pair import Member


@dataclass(frozen=True)
class ToothInMesh:
    """A tooth of a gear whose teeth are known by number, under the loads of a revolution.

    Parameters
    ----------
    engagement : Engagement
    found : OverRevolution
        Its loads.
    member : {"driver", "driven"}
        Which gear.
    influence : OddGearInfluence
        Of this gear.
    tooth : int
        By its own number.
    """

    engagement: Engagement
    found: OverRevolution
    member: Member
    influence: OddGearInfluence
    tooth: int

    @property
    def order(self) -> int:
        """Its number in meshing order: the base pitch in which it is on pair 0."""
        return meshing_order(self.tooth, self.influence.gear.teeth, self.member)

    @property
    def width(self) -> float:
        """Common face width [m]."""
        return self.engagement.compliance.face_width

    @cached_property
    def radius(self) -> Array:
        """Where pairs touch the gear, on its flanks, shape (n, P) [m]."""
        contacts, known = self.engagement.grid(self.found.x).contacts, self.influence.ordinary
        radius = contacts.radius_driver if self.member == "driver" else contacts.radius_driven
        return np.clip(radius, known.lowest_radius, known.highest_radius)

    def in_pitch(self, pitch: int) -> tuple[Array, list[int]]:
        """Loads of all pairs [N], shape (n, P), and the gear's teeth on them, so many base pitches after `order`."""
        cycle = self.order + pitch
        loads = self.found.loads[cycle % self.found.loads.shape[0]]
        return loads, [self.engagement.compliance.tooth(self.member, int(row), cycle) for row in self.found.number]
