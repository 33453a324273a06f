"""Contact of a tip corner with the mating flank before and after the nominal path: exact gap from the tooth curves.

Off the path the corner (or the rounding) of one gear's tip, T, approaches the involute of the other gear, F. With the
contact at radius rho on F the triangle of the two centres and the contact point fixes both gears' positions in closed
form; rho follows from the position by a table read sideways and corrected until it fits. Rolled lengths u are counted
from the end of the path outward:

    u_T = r_bT [A_T(rho) - A_T(rho_0)],    u_F = r_bF [A_F(rho) - A_F(rho_0) - inv(rho) + inv(rho_0)],

A_T and A_F the triangle's angles at the centres. Their differences follow from those of their cosines (`_turned`):
angles of order one, subtracted, would leave errors of 1e-12 of a deflection. The gap along the line of action is
u_T - u_F; the position is taken midway, u = (u_T + u_F)/2, so that a pair and its reverse see the same. The rounding is
an offset curve: the same formulas hold for its centre and the offset involute, which is an involute of the same base
circle.

In an internal pair the path may end beyond the pitch point: rho then falls before it rises, and it is the angle by
which the corner has turned that both positions follow from. The ring's roll lengths are negative, and so is its inv.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.tally import tallied
from fegear.contact.plane.spline import Spline, spline
from fegear.geometry.gear import Gear
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
        tip = float(self.pair.x_of_radius(self.pair.gear(self.tip_of).involute_tip_radius, self.tip_of))
        return abs(tip - self._end) <= 1e-12 * self.pair.base_pitch and self._lengths[1] > self._lengths[0]

    @property
    def rounding(self) -> float:
        """Radius of the tip rounding [m], 0 for a sharp corner."""
        gear = self.pair.gear(self.tip_of)
        return gear.tooth.tip_rounding * gear.module

    @property
    def radius_of_curvature(self) -> float:
        """Of what touches the mate: the rounding, or the flank that a sharp corner ends [m], negative where hollow."""
        gear = self.pair.gear(self.tip_of)
        return self.rounding if self.rounding > 0.0 else _roll_length(gear, gear.involute_tip_radius)

    def distance(self, x: ArrayLike) -> Array:
        """Length of flank [m] between the contact at x on the path and this tip's corner; infinite if rounded."""
        at = np.asarray(x, dtype=float)
        if self.rounding > 0.0:
            return np.full(at.shape, np.inf)
        gear = self.pair.gear(self.tip_of)
        length = self.pair.flank_curvature_radius(at, self.tip_of)
        apart = gear.tooth.side * (self.radius_of_curvature**2 - length * length)
        return np.maximum(apart / (2.0 * gear.base_radius), 0.0)

    @cached_property
    def _corner_radius(self) -> float:
        """Distance of the corner, or of its rounding's centre, from its gear's centre [m]."""
        gear, rounding = self.pair.gear(self.tip_of), self.rounding
        return gear.involute_tip_radius if rounding == 0.0 else gear.tip_radius - gear.tooth.side * rounding

    @property
    def _end(self) -> float:
        """Where the path ends on this side [m]."""
        return self.pair.x_start if self.tip_of == "driven" else self.pair.x_end

    @cached_property
    def _lengths(self) -> tuple[float, float]:
        """Roll lengths [m] of the (offset) flank at the end of the path and at its own tip."""
        low = float(self.pair.flank_curvature_radius(self._end, self.flank_of)) + self.rounding
        flank = self.pair.gear(self.flank_of)
        return low, max(_roll_length(flank, flank.involute_tip_radius) + self.rounding, low)

    @cached_property
    def _span(self) -> tuple[float, float]:
        """First and last place on the corner's way, as `_turned` takes them."""
        return self._lengths

    def _length(self, at: Array) -> Array:
        """Roll length of the (offset) flank at a place [m], which the place is."""
        return at

    def _turned(self, at: Array) -> tuple[Array, Array]:
        """By how much the tip's and the flank's gear have turned since the path's end [rad].

        cos(A) - cos(A_0) by the law of cosines has the factor rho^2 - rho_0^2, which roll lengths give without loss.
        """
        a, r, rb = self.pair.centre_distance, self._corner_radius, self.pair.gear(self.flank_of).base_radius
        start = self._span[0]
        first, rho = math.hypot(rb, start), np.hypot(rb, at)
        farther = (at - start) * (at + start)
        s, s_0 = 0.5 * (a + r + rho), 0.5 * (a + r + first)
        tips = _triangle_angle(s, a, r, rho) + _triangle_angle(s_0, a, r, first)
        flanks = _triangle_angle(s, a, rho, r) + _triangle_angle(s_0, a, first, r)
        of_tip = _difference(-farther / (2.0 * a * r), tips)
        bent = 1.0 - (a - r) * (a + r) / (rho * first)
        of_flank = _difference(farther / (rho + first) / (2.0 * a) * bent, flanks)
        return of_tip, of_flank - self._rolled_back(at)

    def _rolled_back(self, length: Array) -> Array:
        """Difference of the polar angles of the (offset) flank at a roll length [m] and where the path ends [rad]."""
        start, rb = self._lengths[0], self.pair.gear(self.flank_of).base_radius
        step = (length - start) / rb
        return np.asarray(step - np.arctan(step / (1.0 + length * start / (rb * rb))))

    def _rolled(self, at: Array) -> tuple[Array, Array]:
        """Both gears' rolled lengths u_T, u_F at a place on the corner's way."""
        tip_turned, flank_turned = self._turned(at)
        of_tip, of_flank = self.pair.gear(self.tip_of), self.pair.gear(self.flank_of)
        return of_tip.base_radius * tip_turned, of_flank.base_radius * flank_turned

    @cached_property
    def reach(self) -> float:
        """How far beyond the path's end the corner still faces the mate's involute [m]."""
        if not self.exists:
            return 0.0
        u_t, u_f = self._rolled(np.asarray(self._span[1]))
        return float(0.5 * (u_t + u_f))

    @cached_property
    def _place_of_position(self) -> Spline:
        """Place over the position u: u grows monotonely with it, so the inverse is a table read sideways."""
        places = np.linspace(*self._span, 201)
        u_t, u_f = self._rolled(places)
        return spline(0.5 * (u_t + u_f), places)

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
        table, inside = self._place_of_position, np.clip(u, 0.0, self.reach)
        wanted = table(inside)
        place = np.clip(wanted, *self._span)
        for _ in range(3):  # the table's own slope turns what is missing in u into a place
            u_t, u_f = self._rolled(place)
            place = np.clip(place + wanted - table(0.5 * (u_t + u_f)), *self._span)
        u_t, u_f = self._rolled(place)
        gap = np.where(u > self.reach * (1.0 + 1e-12), np.inf, np.maximum(u_t - u_f, 0.0))
        return gap, self._length(place) - self.rounding, self._tilt(place)

    def _tilt(self, at: Array) -> Array:
        """Angle between the tangents from the corner to the two base circles [rad]."""
        a, r = self.pair.centre_distance, self._corner_radius
        rbf, rbt = self.pair.gear(self.flank_of).base_radius, self.pair.gear(self.tip_of).base_radius
        rho = np.hypot(rbf, at)
        # The corner sees the centres on opposite sides of the line of action: on the path the angle between them is
        # pi less the one tangent's angle to its centre plus the other's.
        at_corner = np.arccos(np.clip((rho * rho + r * r - a * a) / (2.0 * rho * r), -1.0, 1.0))
        to_f, to_t = np.arctan2(rbf, at), math.asin(rbt / r)
        return np.maximum(math.pi - at_corner + to_t - to_f, 0.0)


class InternalCornerContact(CornerContact):
    """The same in an internal pair, followed by the angle that the corner has turned by since the path's end.

    The path may end beyond the pitch point: the radius of the contact then falls before it rises. Where the pinion's
    centre lies between that of the ring and the contact, angles are counted from the centre line that runs on.
    """

    @cached_property
    def _first(self) -> float:
        """Angle of the corner from the centre line at the path's end [rad]."""
        pair, gear = self.pair, self.pair.gear(self.tip_of)
        length = float(pair.flank_curvature_radius(self._end, self.tip_of)) - self.rounding
        return math.atan(length / gear.base_radius) - gear.tooth.side * pair.working_pressure_angle

    @cached_property
    def _span(self) -> tuple[float, float]:
        pair, r = self.pair, self._corner_radius
        top = np.hypot(pair.gear(self.flank_of).base_radius, self._lengths[1])
        last = float(_triangle_angle(0.5 * (pair.centre_distance + r + top), pair.centre_distance, r, top))
        return 0.0, max((last if pair.gear(self.tip_of).tooth.internal else math.pi - last) - self._first, 0.0)

    @property
    def _lever(self) -> float:
        """r a, the sign that of the mate's flank [m^2]."""
        return self.pair.gear(self.flank_of).tooth.side * self._corner_radius * self.pair.centre_distance

    def _length(self, at: Array) -> Array:
        """By the law of cosines, rho^2 - rho_0^2 = -2 r a (cos(A) - cos(A_0)) [m]."""
        farther = 4.0 * self._lever * np.sin(0.5 * at) * np.sin(self._first + 0.5 * at)
        side = self.pair.gear(self.flank_of).tooth.side
        return np.asarray(side * np.sqrt(np.maximum(self._lengths[0] ** 2 + farther, 0.0)))

    def _turned(self, at: Array) -> tuple[Array, Array]:
        """By the lines from the mate's centre to the corner, then and now: their cross and their scalar product."""
        r, first, lever = self._corner_radius, self._first, self._lever
        away = lever / r
        along, across = r * math.cos(first) - away, r * math.sin(first)
        cross = r * r * np.sin(at) - 2.0 * lever * np.sin(0.5 * at) * np.cos(first + 0.5 * at)
        scalar = along * (r * np.cos(first + at) - away) + across * r * np.sin(first + at)
        return at, np.arctan2(cross, scalar) - self._rolled_back(self._length(at))

    def _tilt(self, at: Array) -> Array:
        """By how far both normals have turned since the path's end: the flank's along its involute, too [rad]."""
        of_tip, of_flank = self._turned(at)
        rb = self.pair.gear(self.flank_of).base_radius
        return np.abs(of_tip - of_flank - (self._length(at) - self._lengths[0]) / rb)


def corner_contact(pair: GearPair, tip_of: Member) -> CornerContact:
    """The tip of one gear of a pair, external or internal, against its mate's flank."""
    return (InternalCornerContact if pair.internal else CornerContact)(pair, tip_of)


def _triangle_angle(s: ArrayLike, a: float, own: ArrayLike, other: ArrayLike) -> Array:
    """Angle at a gear's centre between the centre line and the contact, from half the circumference and the radii.

    That is the arccos of the law of cosines, written with half angles so that flat triangles keep their digits.
    """
    s, own, other = (np.asarray(one) for one in (s, own, other))
    across, along = np.sqrt(np.maximum((s - a) * (s - own), 0)), np.sqrt(np.maximum(s * (s - other), 0))
    return np.asarray(2.0 * np.arctan2(across, along))


def _difference(of_cosines: Array, total: Array) -> Array:
    """Difference of two angles from 0 to pi, by that of their cosines and by their sum."""
    sine = np.sin(0.5 * total)
    half = np.divide(-of_cosines, 2.0 * sine, out=np.zeros(np.shape(total)), where=sine > 0.0)
    return np.asarray(2.0 * np.arcsin(np.clip(half, -1.0, 1.0)))


def _roll_length(gear: Gear, radius: float) -> float:
    """Roll length of the flank at a radius [m]; negative on an internal gear."""
    return gear.tooth.side * math.sqrt((radius - gear.base_radius) * (radius + gear.base_radius))
