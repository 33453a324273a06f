"""Where the teeth of a pinion and a rack touch: on the path of contact, or at a tip corner before or after it.

Off the path one body's tip corner meets the other's flank away from the line of action. In the frame of the pinion's
axis, a along the line of action and b across it toward the rack (the line lies at b = r_b), a turn by delta beyond the
end of the path takes

    the pinion's corner from (rho_a, r_b) to (rho_a cos d + r_b sin d, r_b cos d - rho_a sin d), d = delta,
    the rack's corner from (rho_s, r_b) to (rho_s + r_b d, r_b - r d sin alpha),

rho_a and rho_s the pinion's roll lengths at the ends of the path. The rack's flank stays normal to a, at
rho_a + r_b d; the pinion's is the involute whose string leaves the base circle at the angle tau and is
rho_s + r_b (d - tau) long. What is left between corner and flank is the gap. A rounding's centre moves as a corner
does, against the offset flank.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.meshing import Contacts

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Index, Mask
    from fegear.geometry.rack_and_pinion import RackAndPinion

#: Zero is the gap of flanks on the path alone [m].
_OFF_PATH = float(np.finfo(float).tiny)
#: Corners are looked for so far beyond the path [base pitches].
_FARTHEST = 1.0


@dataclass(frozen=True)
class RackContacts:
    """Finds the contacts of a rack and pinion.

    Parameters
    ----------
    pair : RackAndPinion
    corners : bool
        Whether tip corners may touch beyond the path.
    """

    pair: RackAndPinion
    corners: bool = True

    @cached_property
    def numbers(self) -> Index:
        """Pairs that can touch in the base pitch that starts at x_start; pair j has come into contact before j - 1."""
        ahead = math.ceil(self.pair.contact_ratio * (1.0 - 1e-12)) - 1
        return np.arange(-1, ahead + 2) if self.corners else np.arange(ahead + 1)

    @cached_property
    def _roundings(self) -> tuple[float, float]:
        """Tip roundings of the rack and of the pinion [m]."""
        pair = self.pair
        return pair.rack.tooth.tip_rounding * pair.rack.module, pair.pinion.tooth.tip_rounding * pair.pinion.module

    @cached_property
    def starts_at_tip(self) -> bool:
        """Whether the path starts at the rack's tip, and not at what undercut leaves of the pinion's flank."""
        pair = self.pair
        tip = pair.x_of_height(pair.rack.tooth.flank_end * pair.rack.module)
        return abs(tip - pair.x_start) <= 1e-12 * pair.rack.base_pitch

    def contacts(self, x: ArrayLike, tooth: int) -> Contacts:
        """Contacts of all pairs at roll positions, pair 0 on a tooth of the rack, pair j on the tooth j before it.

        Parameters
        ----------
        x : array_like, shape (P,)
            Of pair 0, each within a base pitch from x_start [m].
        tooth : int
            Its number on the rack, which may lie beyond an end: there is then no such pair.

        Returns
        -------
        Contacts
            Of the pinion as driver; "radius_driven" is the height on the rack [m], "roll_driven" zero.
        """
        pair = self.pair
        at = np.atleast_1d(np.asarray(x, dtype=float))
        xs = at + self.numbers[:, None] * pair.rack.base_pitch
        gap, length, height, curvature, edge = self.touching(xs)
        on_rack = tooth - self.numbers
        gap[(on_rack < 0) | (on_rack >= pair.rack.teeth)] = np.inf
        rb = pair.pinion.base_radius
        relative = np.maximum(1.0 / curvature, 1e-6 * pair.pinion.module)
        return Contacts(
            self.numbers, xs, gap < np.inf, np.hypot(rb, length), height, length / rb, np.zeros(xs.shape), relative,
            edge, gap,
        )  # fmt: skip

    def touching(self, x: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Gap, the pinion's roll length, height on the rack, curvature of both together, and `Contacts.edge`."""
        pair = self.pair
        slack = 1e-10 * pair.rack.base_pitch
        inside = (x >= pair.x_start - slack) & (x <= pair.x_end + slack)
        on_path = np.clip(x, pair.x_start, pair.x_end)
        length, height = pair.roll_length(on_path), pair.height(on_path)
        gap, edge = np.where(inside, 0.0, np.inf), np.full(x.shape, -np.inf)
        curvature = 1.0 / length
        if not self.corners:
            return gap, length, height, curvature, edge
        of_rack, of_pinion = self._roundings
        if of_pinion == 0.0:
            last, rb = float(pair.roll_length(pair.x_end)), pair.pinion.base_radius
            edge = np.maximum(edge, np.where(inside, -(last**2 - length**2) / (2.0 * rb), -np.inf))
        if of_rack == 0.0 and self.starts_at_tip:
            along = (on_path - pair.x_start) * math.tan(pair.rack.pressure_angle)
            edge = np.maximum(edge, np.where(inside, -along, -np.inf))
        farthest = _FARTHEST * pair.rack.base_pitch
        after = ~inside & (x > pair.x_end) & (x < pair.x_end + farthest)
        if after.any():
            self._pinion_corner(x[after] - pair.x_end, after, gap, height, curvature, edge)
            length[after] = float(pair.roll_length(pair.x_end))
        before = ~inside & (x < pair.x_start) & (x > pair.x_start - farthest)
        if before.any() and self.starts_at_tip:
            self._rack_corner(x[before] - pair.x_start, before, gap, length, curvature, edge)
        return gap, length, height, curvature, edge

    def _pinion_corner(
        self, beyond: Array, where: Mask, gap: Array, height: Array, curvature: Array, edge: Array
    ) -> None:
        pair, r = self.pair, self._roundings[1]
        rb, alpha = pair.pinion.base_radius, pair.rack.pressure_angle
        turn, last = beyond / rb, float(pair.roll_length(pair.x_end))
        along = (last - r) * np.cos(turn) + rb * np.sin(turn) + r
        across = rb * np.cos(turn) - (last - r) * np.sin(turn)
        apart = last + beyond - along
        at = pair.distance - along * math.sin(alpha) - across * math.cos(alpha)
        top = pair.rack.tooth.flank_end * pair.rack.module
        gap[where] = np.where(at <= top, np.maximum(apart, _OFF_PATH), np.inf)
        height[where] = np.minimum(at, top)
        curvature[where] = 1.0 / (r or last)
        edge[where] = -np.inf if r else turn * last

    def _rack_corner(
        self, beyond: Array, where: Mask, gap: Array, length: Array, curvature: Array, edge: Array
    ) -> None:
        pair, r = self.pair, self._roundings[0]
        rb, alpha = pair.pinion.base_radius, pair.rack.pressure_angle
        turn, first = beyond / rb, float(pair.roll_length(pair.x_start))
        along, across = first + r + beyond, rb - pair.pinion.pitch_radius * turn * math.sin(alpha)
        string = np.sqrt(np.maximum(along**2 + across**2 - rb**2, 0.0))
        leaves = np.arctan2(along, across) - np.arctan2(string, rb)
        apart = string - r - first - beyond + rb * leaves
        last = float(pair.roll_length(pair.x_end))
        on_flank = np.clip(string - r, first, last)
        gap[where] = np.where(string - r <= last, np.maximum(apart, _OFF_PATH), np.inf)
        length[where] = on_flank
        curvature[where] = 1.0 / np.maximum(on_flank, 1e-12) + (1.0 / r if r else 0.0)
        edge[where] = -np.inf if r else np.abs(leaves) * on_flank
