"""What a wrongly set or modified cutter takes off a pinion's designed flank, over roll angle and face (TM-107451)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.involute import polar_angle
from fegear.geometry.rack_flank import RackFlank
from fegear.helical.as_cut import as_cut

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry.gear import Gear

#: Places over the height of the flank between which the profile's deviation is smooth.
_PLACES = 129


@dataclass(frozen=True)
class CutRemoval:
    """Removal from the designed pinion by its cutter: errors of profile and lead angle, parabola, lengthwise crown.

    The flank as cut is one section turned by twist z - crown z^2, so that the removal is a function of the roll angle
    plus one of the height. It counts from the pitch point in the middle of the face: the pinion's pitch radius follows
    its lead angle (Appendix 2), and the centre distance with it.

    Parameters
    ----------
    gear : Gear
        The pinion as designed.
    profile_angle, lead_angle : float
        Errors of the normal profile angle and the lead angle [rad].
    parabola, crown : float
        See `RackFlank`; the crown in [rad/m^2].

    Raises
    ------
    GeometryError
        If the cut leaves no tooth or no regular flank.
    """

    gear: Gear
    profile_angle: float = 0.0
    lead_angle: float = 0.0
    parabola: float = 0.0
    crown: float = 0.0

    @cached_property
    def _cut(self) -> RackFlank:
        cut = as_cut(self.gear, profile_angle=self.profile_angle, lead_angle=self.lead_angle)
        return RackFlank(cut, self.parabola, self.crown)

    @cached_property
    def _profile(self) -> CubicSpline:
        """Azimuth of the section as cut ahead of the designed one [rad], over the designed roll angle."""
        flank, base = self._cut, self.gear.base_radius
        section, _ = flank.profile(np.linspace(flank.s_form, flank.s_tip, _PLACES))
        section = section[np.abs(section) > base]
        radius = np.abs(section)
        roll = np.sqrt((radius - base) * (radius + base)) / base
        offset = InvoluteHelicoid.of(self.gear, "space").offset
        return CubicSpline(roll, np.angle(section) - (offset - polar_angle(roll)))

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """None."""
        return ()

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Material removed [m] at roll angles [rad] and heights [m]; heights are those of `flank_modification`."""
        up = -np.asarray(z, dtype=float)  # the paper's pinion turns counter-clockwise
        turn = (self._cut.gear.twist - self.gear.twist) * up - self.crown * up**2
        pitch = np.sqrt((self.gear.pitch_radius / self.gear.base_radius) ** 2 - 1.0)
        return np.asarray(-self.gear.base_radius * (self._profile(roll) - self._profile(pitch) + turn))
