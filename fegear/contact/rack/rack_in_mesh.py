"""A pinion on a rack as contact over the flank takes two gears in mesh: heights on the rack stand for roll lengths.

In the plane of action the contact lines of a rack are those of any pair, x = x_0 + j p_bt - z tan(beta_b), and beyond
the path of contact they go on along the tip edges by the plane corners of `rack_contacts`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.rack.rack_contacts import RackContacts
from fegear.contact.wide.tip_edges import FARTHEST, TipEdges, edge_reach, reach_of_corner, tip_edges

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.gear import Gear, Material
    from fegear.geometry.pair import Member
    from fegear.geometry.rack_and_pinion import RackAndPinion


@dataclass(frozen=True)
class RackMember:
    """What contact asks of the rack as a member of a pair.

    Parameters
    ----------
    material : Material
    base_radius : float
        What lengths along the flank are divided by for a roll angle: 1 m, so that reliefs are asked at heights [m].
    """

    material: Material
    base_radius: float = 1.0


@dataclass(frozen=True)
class RackInMesh:
    """A pinion that drives a rack, with what contact over the flank asks of a `GearPair`.

    Parameters
    ----------
    meshing : RackAndPinion
    """

    meshing: RackAndPinion

    @property
    def driver(self) -> Gear:
        """The pinion."""
        return self.meshing.pinion

    def gear(self, member: Member) -> Gear | RackMember:
        """Pinion or rack."""
        return self.driver if member == "driver" else RackMember(self.meshing.rack.material)

    @property
    def base_pitch(self) -> float:
        """p_bt [m]."""
        return self.meshing.rack.base_pitch

    @property
    def face_width(self) -> float:
        """Common face width [m]."""
        return self.meshing.face_width

    def face_height(self, member: Member) -> float:  # noqa: ARG002  (both faces have their middles at one height)
        """Height of the middle of the common face above that of a member's face: none [m]."""
        return 0.0

    @property
    def x_start(self) -> float:
        """Start of the path of contact [m]."""
        return self.meshing.x_start

    @property
    def x_end(self) -> float:
        """End of the path of contact [m]."""
        return self.meshing.x_end

    def place_of_length(self, length: ArrayLike, member: Member) -> Array:
        """Radius on the pinion of a roll length; on the rack lengths are heights [m]."""
        found = np.asarray(length, dtype=float)
        return np.hypot(self.driver.base_radius, found) if member == "driver" else found

    @cached_property
    def contacts(self) -> RackContacts:
        """Contacts of the transverse section, those of tip corners among them."""
        return RackContacts(self.meshing)


@edge_reach.register(RackInMesh)
def _(pair: RackInMesh, most_gap: float) -> tuple[float, float]:
    def beyond(end: float, sign: float) -> float:
        return reach_of_corner(
            lambda far: pair.contacts.touching(end + sign * far)[0], FARTHEST * pair.base_pitch, most_gap
        )

    return (beyond(pair.x_start, -1.0), beyond(pair.x_end, 1.0)) if most_gap > 0.0 else (0.0, 0.0)


@tip_edges.register(RackInMesh)
def _(pair: RackInMesh, x: ArrayLike) -> TipEdges:
    gap, length, height, curvature, edge = pair.contacts.touching(np.asarray(x, dtype=float))
    return TipEdges(gap, length, height, np.maximum(1.0 / curvature, 1e-6 * pair.driver.module), edge)
