"""Contact of a tip corner with the mating flank before and after the nominal path: exact gap from the tooth curves.

Off the path the corner (or the rounding) of one gear's tip, T, approaches the involute of the other gear, F. With the
contact at radius rho on F the triangle of the two centres and the contact point fixes both gears' positions in closed
form; rho follows from the position by a table read sideways and corrected until it fits. Rolled lengths u are counted
from the end of the path outward:

    u_T = r_bT [A_T(rho) - A_T(rho_0)],    u_F = r_bF [A_F(rho) - A_F(rho_0) - inv(rho) + inv(rho_0)],

A_T and A_F the triangle's angles at the centres. The gap along the line of action is u_T - u_F; the position is taken
midway, u = (u_T + u_F)/2, so that a pair and its reverse see the same. The rounding is an offset curve: the same
formulas hold for its centre and the offset involute, which is an involute of the same base circle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.tally import tallied
from fegear.contact.plane.fe_compliance import Spline, spline
from fegear.geometry.involute import polar_angle

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.pair import GearPair, Member


@dataclass(frozen=True)
class CornerContact:
    """The tip of one gear against the flank of its mate beyond the path of contact.

    Parameters
    ----------
    pair : GearPair
    tip_of : {"driver", "driven"}
        "driven" is the approach side (before the path), "driver" the recess side (after it).
    """

    pair: GearPair
    tip_of: Member

    @property
    def flank_of(self) -> Member:
        """The other gear."""
        return "driven" if self.tip_of == "driver" else "driver"

    @cached_property
    def exists(self) -> bool:
        """Whether the path ends at this tip (and not at the mate's form circle) and the mate's flank goes on."""
        end = self.pair.x_start if self.tip_of == "driven" else self.pair.x_end
        tip = float(self.pair.x_of_radius(self.pair.gear(self.tip_of).involute_tip_radius, self.tip_of))
        return abs(tip - end) <= 1e-12 * self.pair.base_pitch and self._span[1] > self._span[0]

    @property
    def rounding(self) -> float:
        """Radius of the tip rounding [m], 0 for a sharp corner."""
        gear = self.pair.gear(self.tip_of)
        return gear.tooth.tip_rounding * gear.module

    @property
    def radius_of_curvature(self) -> float:
        """Of what touches the mate: the rounding, or the flank that a sharp corner ends [m]."""
        gear = self.pair.gear(self.tip_of)
        tip, base = gear.involute_tip_radius, gear.base_radius
        return self.rounding if self.rounding > 0.0 else math.sqrt((tip - base) * (tip + base))

    def distance(self, x: ArrayLike) -> Array:
        """Length of flank [m] between the contact at x on the path and this tip's corner; infinite if rounded."""
        at = np.asarray(x, dtype=float)
        if self.rounding > 0.0:
            return np.full(at.shape, np.inf)
        gear = self.pair.gear(self.tip_of)
        length = self.pair.flank_curvature_radius(at, self.tip_of)
        return np.maximum((self.radius_of_curvature**2 - length * length) / (2.0 * gear.base_radius), 0.0)

    @cached_property
    def _corner_radius(self) -> float:
        """Distance of the corner, or of its rounding's centre, from its gear's centre [m]."""
        gear, rounding = self.pair.gear(self.tip_of), self.rounding
        return gear.involute_tip_radius if rounding == 0.0 else gear.tip_radius - rounding

    @cached_property
    def _span(self) -> tuple[float, float]:
        """Smallest and largest roll length [m] of the (offset) flank that the corner meets."""
        x = self.pair.x_start if self.tip_of == "driven" else self.pair.x_end
        low = float(self.pair.flank_curvature_radius(x, self.flank_of)) + self.rounding
        flank = self.pair.gear(self.flank_of)
        top = math.sqrt(
            (flank.involute_tip_radius - flank.base_radius) * (flank.involute_tip_radius + flank.base_radius)
        )
        return low, max(top + self.rounding, low)

    def _angles(self, length: Array) -> tuple[Array, Array]:
        """Angles of the tip's and the flank's gear for contact at a roll length of the (offset) flank."""
        a, r, rbf = self.pair.centre_distance, self._corner_radius, self.pair.gear(self.flank_of).base_radius
        rho = np.hypot(rbf, length)
        # arccos of the law of cosines, written with half angles so that flat triangles keep their digits
        s = 0.5 * (a + r + rho)
        at_f = 2.0 * np.arctan2(np.sqrt(np.maximum((s - a) * (s - rho), 0)), np.sqrt(np.maximum(s * (s - r), 0)))
        at_t = 2.0 * np.arctan2(np.sqrt(np.maximum((s - a) * (s - r), 0)), np.sqrt(np.maximum(s * (s - rho), 0)))
        return at_t, at_f - polar_angle(length / rbf)

    @cached_property
    def _start(self) -> tuple[Array, Array]:
        """Where the path ends."""
        return self._angles(np.asarray(self._span[0]))

    def _rolled(self, length: Array) -> tuple[Array, Array]:
        """Both gears' rolled lengths u_T, u_F for contact at a roll length of the (offset) flank."""
        (start_t, start_f), (now_t, now_f) = self._start, self._angles(length)
        of_tip, of_flank = self.pair.gear(self.tip_of), self.pair.gear(self.flank_of)
        return of_tip.base_radius * (now_t - start_t), of_flank.base_radius * (now_f - start_f)

    @cached_property
    def reach(self) -> float:
        """How far beyond the path's end the corner still faces the mate's involute [m]."""
        if not self.exists:
            return 0.0
        u_t, u_f = self._rolled(np.asarray(self._span[1]))
        return float(0.5 * (u_t + u_f))

    @cached_property
    def _length_of_position(self) -> Spline:
        """Roll length over the position u: u grows monotonely with it, so the inverse is a table read sideways."""
        lengths = np.linspace(*self._span, 201)
        u_t, u_f = self._rolled(lengths)
        return spline(0.5 * (u_t + u_f), lengths)

    @tallied("corner searches")
    def locate(self, beyond: ArrayLike) -> tuple[Array, Array, Array]:
        """Gap and place of contact at distances beyond the end of the path.

        Parameters
        ----------
        beyond : array_like
            u [m], 0 at the end of the path, positive outward; larger than `reach` gives an infinite gap.

        Returns
        -------
        gap : ndarray
            Distance along the line of action that the gears must approach until the corner touches [m], >= 0.
        flank_roll_length : ndarray
            Roll length of the contact point on the mate's flank [m].
        tilt : ndarray
            Angle [rad] between the two flanks' normals at the corner: they part inward from it with this slope.
        """
        u = np.asarray(beyond, dtype=float)
        table, inside = self._length_of_position, np.clip(u, 0.0, self.reach)
        wanted = table(inside)
        length = np.clip(wanted, *self._span)
        for _ in range(3):  # the table's own slope turns what is missing in u into length
            u_t, u_f = self._rolled(length)
            length = np.clip(length + wanted - table(0.5 * (u_t + u_f)), *self._span)
        u_t, u_f = self._rolled(length)
        gap = np.where(u > self.reach * (1.0 + 1e-12), np.inf, np.maximum(u_t - u_f, 0.0))
        return gap, length - self.rounding, self._tilt(length)

    def _tilt(self, length: Array) -> Array:
        """Angle between the tangents from the corner to the two base circles [rad]."""
        a, r = self.pair.centre_distance, self._corner_radius
        rbf, rbt = self.pair.gear(self.flank_of).base_radius, self.pair.gear(self.tip_of).base_radius
        rho = np.hypot(rbf, length)
        # The corner sees the centres on opposite sides of the line of action: on the path the angle between them is
        # pi less the one tangent's angle to its centre plus the other's.
        at_corner = np.arccos(np.clip((rho * rho + r * r - a * a) / (2.0 * rho * r), -1.0, 1.0))
        to_f, to_t = np.arctan2(rbf, length), math.asin(rbt / r)
        return np.maximum(math.pi - at_corner + to_t - to_f, 0.0)
