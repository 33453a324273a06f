"""What keeps unloaded flanks apart: profile, lead and topographic modifications, errors of teeth and of the shafts.

All of it is measured along the transverse line of action and counts positive as removed material, at the places where
unmodified, aligned flanks touch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.tally import note
from fegear.contact.wide.lines import ContactLines, base_twist
from fegear.contact.wide.shaft_gaps import RIGID, ShaftGaps
from fegear.geometry.flank_modification import FlankModification
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.relief import UNMODIFIED, Relief
from fegear.geometry.shaft_tilt import PARALLEL, ShaftTilt

if TYPE_CHECKING:
    from fegear.contact.odd_flank import OddFlank


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
        Of each gear over its own face: lead modifications, bias, topography, errors of its cutter. They add up.
    tilt : ShaftTilt
        Deviation of the axes.
    driver_spacing, driven_spacing : ndarray
        Spacing error of each tooth in the order of meshing [m]; empty for none.
    base_pitch : int
        Which teeth meet: pair j is on teeth base_pitch - j.
    shafts : ShaftGaps
        What the shafts of a gearbox open as its meshes load them.
    driver_odd, driven_odd : tuple of (int, OddFlank)
        Flanks of single teeth that differ, by their number in the order of meshing. Gaps are infinite where there is
        no flank: see `OddFlank.gap_over_face`.
    """

    driver_relief: Relief = UNMODIFIED
    driven_relief: Relief = UNMODIFIED
    face_position: Array = field(default_factory=lambda: np.empty(0))
    line_gap: Array = field(default_factory=lambda: np.empty(0))
    driver_flank: tuple[FlankModification, ...] = ()
    driven_flank: tuple[FlankModification, ...] = ()
    tilt: ShaftTilt = PARALLEL
    driver_spacing: Array = field(default_factory=lambda: np.empty(0))
    driven_spacing: Array = field(default_factory=lambda: np.empty(0))
    base_pitch: int = 0
    shafts: ShaftGaps = RIGID
    driver_odd: tuple[tuple[int, OddFlank], ...] = ()
    driven_odd: tuple[tuple[int, OddFlank], ...] = ()

    def under(self, load: float) -> FlankGaps:
        """The same with the shafts as they are under one load [N]."""
        return replace(self, shafts=self.shafts.under(load)) if self.shafts.given else self

    def at(self, pair: GearPair, lines: ContactLines, load: ArrayLike | None = None) -> Array:
        """Gap at the stations [m]: the sum of all, where unmodified flanks touch.

        Parameters
        ----------
        pair : GearPair
        lines : ContactLines
        load : array_like, shape (L,), optional
            [N]: which shafts' gaps hang on; without it, those of `under`.

        Returns
        -------
        ndarray, shape (P, M), or (P, M, L) where shafts bend under loads
        """
        gap = self.of_pair(lines.pair, lines.z)
        for member in MEMBERS:
            gap = gap + self.removed(member, lines.roll_angle(pair, member), lines.z + pair.face_height(member))
        for member in MEMBERS if self.driver_odd or self.driven_odd else ():
            gap = gap + self._of_odd_teeth(pair, member, lines)
        if self.tilt != PARALLEL:
            note("misaligned flanks")
            gap = gap + self.tilt.gap(pair, lines.x, lines.z)
        if lines.edges is not None:
            gap = gap + lines.edges.gap
        if self.shafts.given:
            note("misaligned flanks")
            bent = self.shafts.at(lines.x, lines.z, load)
            gap = bent + (gap if load is None else gap[..., None])
        return np.asarray(gap)

    def _of_odd_teeth(self, pair: GearPair, member: Member, lines: ContactLines) -> Array:
        """What single teeth of a gear have of gaps besides, shape (P, M) [m]."""
        gear, found = pair.gear(member), np.zeros(lines.x.shape)
        usual, flanks = (
            (self.driver_relief, self.driver_odd) if member == "driver" else (self.driven_relief, self.driven_odd)
        )
        for order, flank in flanks:
            on = lines.present & (np.mod(self.base_pitch - lines.pair, gear.teeth) == order)
            if not on.any():
                continue
            roll = lines.roll_angle(pair, member)[on]
            if flank.relief is not None:
                found[on] += flank.relief.removal(roll) - usual.removal(roll)
            found[on] += flank.deviation.removal(roll)
            up, lean = lines.middle[on], math.cos(gear.base_helix_angle)
            z, on_path = lines.z[on] + up + pair.face_height(member), lines.x[on]
            toward = pair.flank_curvature_radius(on_path - base_twist(pair) * up, member)
            length = lines.roll_length(pair, member)[on] + toward - pair.flank_curvature_radius(on_path, member)
            found[on] += flank.gap_over_face(pair.place_of_length(length, member), z, gear.face_width) / lean
        return found

    def removed(self, member: Member, roll: Array, z: Array) -> Array:
        """What is missing from a gear's flank at roll angles [rad] and heights on its own face [m]."""
        driver = member == "driver"
        total = (self.driver_relief if driver else self.driven_relief).removal(roll)
        parts = self.driver_flank if driver else self.driven_flank
        note("reliefs", len(parts))
        for part in parts:
            total = total + part.removal(roll, z)
        return np.asarray(total)

    def of_pair(self, pair: NDArray[np.int64], z: Array) -> Array:
        """What tooth pairs j have at heights [m] whatever their flanks are: `line_gap` and spacing errors [m]."""
        total = np.zeros(z.shape)
        for errors in (self.driver_spacing, self.driven_spacing):
            if errors.size:
                note("spacing errors")
                total += errors[np.mod(self.base_pitch - pair, errors.size)]
        if self.line_gap.size:
            total += np.interp(z, self.face_position, self.line_gap)
        return total
