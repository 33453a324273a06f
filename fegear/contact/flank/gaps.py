"""What keeps unloaded flanks apart: profile, lead and topographic modifications, errors of teeth and of the shafts.

All of it is measured along the transverse line of action and counts positive as removed material, at the places where
unmodified, aligned flanks touch.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.frozen import ReadOnlyArrays
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import UNMODIFIED, Relief
from fegear.tally import note

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.flank.lines import ContactLines
    from fegear.geometry.flank_modification import FlankModification
    from fegear.geometry.pair import GearPair


@dataclass(frozen=True)
class FlankGaps(ReadOnlyArrays):
    """What keeps unloaded flanks apart along the line of action, removal positive.

    Parameters
    ----------
    driver_relief, driven_relief : Relief
        Over the roll angle, the same all over the face.
    face_position, line_gap : ndarray, shape (n,)
        Gap over the face position from the middle of the common face [m], straight between: deflected shafts and
        whatever else belongs to no single gear. Empty for none.
    driver_flank, driven_flank : tuple of FlankModification
        Of each gear over its own face: lead modifications, bias, topography. They add up.
    """

    driver_relief: Relief = UNMODIFIED
    driven_relief: Relief = UNMODIFIED
    face_position: Array = field(default_factory=lambda: np.empty(0))
    line_gap: Array = field(default_factory=lambda: np.empty(0))
    driver_flank: tuple[FlankModification, ...] = ()
    driven_flank: tuple[FlankModification, ...] = ()

    def at(self, pair: GearPair, lines: ContactLines) -> Array:
        """Gap at the stations, shape (P, M) [m]."""
        gap = np.zeros(lines.x.shape)
        reliefs, flanks = (self.driver_relief, self.driven_relief), (self.driver_flank, self.driven_flank)
        for member, relief, parts in zip(MEMBERS, reliefs, flanks, strict=True):
            roll = pair.roll_angle(lines.x, member)
            gap += relief.removal(roll)
            note("reliefs", len(parts))
            for part in parts:
                gap += part.removal(roll, lines.z)
        if self.line_gap.size:
            gap += np.interp(lines.z, self.face_position, self.line_gap)
        return gap
