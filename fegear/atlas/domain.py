"""A region of a family over which everything is smooth, its coordinates, and the gears that may be solved in it.

Tables are smooth in the logarithm of the number of teeth, not in its reciprocal, in the profile shift, in the tip
height, and in the logarithm of the bore's ratio over that of the rim. They break where the rack begins to cut off the
involute: a region lies on one side of that line, and where the line is one of its ends the profile shift counts from
there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.atlas.family import Place
from fegear.base.errors import InputError

if TYPE_CHECKING:
    from fegear.atlas.family import Family
    from fegear.base.arrays import Array, Mask

Side = Literal["whole", "undercut"]
Ends = tuple[float, float]
#: Outside by no more than this share of a region's extent is at its end.
ROUND_OFF = 1e-9
#: What the coordinates are called, as keys of a gear.
KEYS = ("teeth", "profile_shift", "tip_diameter", "bore_radius")
#: Fractions of the steps of a sequence that fills four dimensions evenly: powers of the root of s^5 = s + 1.
_STEPS = np.array([0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101])


@dataclass(frozen=True)
class Domain:
    """A region of a family.

    Parameters
    ----------
    teeth, shift, tip_height, bore : tuple of float
        Ends of each number of `Place`; equal ones where it does not vary. On the undercut side the profile shift
        counts from the undercut line, and both ends are negative.
    side : {"whole", "undercut"}
        On which side of the undercut line it lies.
    highest_at_first : float, optional
        Upper end of the profile shift at the fewest teeth, from where it goes linearly in the logarithm of the number
        of teeth to that of `shift` at the most: teeth of small gears become pointed. Of whole gears only.
    """

    teeth: tuple[int, int]
    shift: Ends
    tip_height: Ends = (1.0, 1.0)
    bore: Ends = (0.5, 0.5)
    side: Side = "whole"
    highest_at_first: float | None = None

    def __post_init__(self) -> None:
        """Refuse regions without extent, or whose numbers no gear has."""
        for name in ("teeth", "shift", "tip_height", "bore"):
            low, high = getattr(self, name)
            if not (math.isfinite(low) and math.isfinite(high) and low <= high):
                raise InputError(name, f"{low:.6g} to {high:.6g}", "must be two finite numbers in ascending order")
        if not 0.0 < self.bore[0] <= self.bore[1] < 1.0:
            raise InputError("bore", f"{self.bore[0]:.6g} to {self.bore[1]:.6g}", "must be between 0 and 1")
        if self.side not in ("whole", "undercut"):
            raise InputError("side", f'"{self.side}"', 'must be "whole" or "undercut"')
        if self.side == "undercut" and not self.shift[1] < 0.0:
            raise InputError("shift", f"{self.shift[1]:.6g}", "must be below 0 on the undercut side (from its line)")

    @property
    def varies(self) -> tuple[bool, bool, bool, bool]:
        """Which numbers vary."""
        shift = self.side == "whole" or self.shift[0] < self.shift[1]
        first, _, height, bore = (low < high for low, high in (self.teeth, self.shift, self.tip_height, self.bore))
        return first, shift and self.shift[0] < self.shift[1], height, bore

    def check(self, family: Family) -> None:
        """Refuse a region whose end in profile shift changes over from a number to the undercut line.

        Raises
        ------
        InputError
            With the number of teeth at which to cut it.
        """
        if self.side == "undercut":
            return
        lowest = self.shift[0]
        first, last = (family.least_shift(z) for z in self.teeth)
        if first > lowest + ROUND_OFF and last < lowest - ROUND_OFF:
            cut = self.teeth[0] + (first - lowest) * (self.teeth[1] - self.teeth[0]) / (first - last)
            raise InputError(
                "teeth", f"{self.teeth[0]} to {self.teeth[1]}",
                f"crosses the undercut line at z = {cut:.2f} (x = {lowest:.6g})",
                f"end one region at {math.floor(cut)} teeth and begin the next at {math.ceil(cut)}",
            )  # fmt: skip
        for z in self.teeth:
            low, high = self.shift_ends(family, z)
            if low > high:
                raise InputError(
                    "shift", f"{self.shift[0]:.6g} to {self.shift[1]:.6g}",
                    f"has no gears on its side of the undercut line at z = {z}",
                )  # fmt: skip

    def shift_ends(self, family: Family, teeth: float) -> Ends:
        """Ends of the profile shift at a number of teeth."""
        low, high = self._shift_ends(family, np.asarray(teeth, dtype=float))
        return float(low), float(high)

    def _shift_ends(self, family: Family, teeth: Array) -> tuple[Array, Array]:
        line, (low, high) = family.least_shift_of(teeth), self.shift
        if self.side == "undercut":
            return line + low, line + high
        top = np.full(teeth.shape, high)
        if self.highest_at_first is not None:
            share = 0.5 + 0.5 * _within(np.log(teeth), *np.log(np.array(self.teeth, dtype=float)))
            top = self.highest_at_first + share * (high - self.highest_at_first)
        return np.maximum(low, line), top

    def _ends(self, family: Family, teeth: Array) -> list[tuple[Array, Array]]:
        """Ends of the four numbers of gears with so many teeth."""
        others = ((np.full(teeth.shape, one[0]), np.full(teeth.shape, one[1])) for one in (self.tip_height, self.bore))
        first = (np.full(teeth.shape, float(self.teeth[0])), np.full(teeth.shape, float(self.teeth[1])))
        return [first, self._shift_ends(family, teeth), *others]

    def outside(self, family: Family, place: Place) -> tuple[int, Ends] | None:
        """Which number of a gear lies outside, and the ends that it lies outside of; None of a gear inside."""
        if not self.teeth[0] <= place.teeth <= self.teeth[1]:
            return 0, self.teeth
        at = np.array(place, dtype=float)[:, None]
        inside = self._inside(family, at)
        if inside.all():
            return None
        number = int(np.flatnonzero(~inside[:, 0])[0])
        low, high = self._ends(family, at[0])[number]
        return number, (float(low[0]), float(high[0]))

    def _inside(self, family: Family, places: Array) -> Mask:
        """Which numbers of gears lie inside, shape (4, N)."""
        found = np.empty(places.shape, dtype=bool)
        for number, (value, (low, high)) in enumerate(zip(places, self._ends(family, places[0]), strict=True)):
            slack = ROUND_OFF * np.maximum(1.0, high - low)
            found[number] = (value >= low - slack) & (value <= high + slack)
        return found

    def holds(self, family: Family, places: Array) -> Mask:
        """Which gears lie inside, shape (N,), of places of shape (4, N)."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self._inside(family, places).all(axis=0))

    def coordinates(self, family: Family, places: Array) -> Array:
        """Coordinates from -1 to 1, shape (4, N), of places of that shape; 0 where a number does not vary."""
        teeth, shift, height, bore = self._ends(family, places[0])
        return np.stack([
            _within(np.log(places[0]), np.log(teeth[0]), np.log(teeth[1])),
            _within(places[1], *shift),
            _within(places[2], *height),
            _within(_of_bore(places[3]), _of_bore(bore[0]), _of_bore(bore[1])),
        ])  # fmt: skip

    def place(self, family: Family, at: Array) -> Place:
        """The gear at four coordinates, or next to them: teeth are whole."""
        first, last = (math.log(z) for z in self.teeth)
        teeth = round(math.exp(first + 0.5 * (1.0 + at[0]) * (last - first)))
        low, high = self.shift_ends(family, teeth)
        begin, end = (float(_of_bore(np.asarray(one))) for one in self.bore)
        ratio = math.exp(begin + 0.5 * (1.0 + at[3]) * (end - begin))
        height = self.tip_height[0] + 0.5 * (1.0 + at[2]) * (self.tip_height[1] - self.tip_height[0])
        return Place(teeth, low + 0.5 * (1.0 + float(at[1])) * (high - low), float(height), ratio / (1.0 + ratio))

    def candidates(self, family: Family, count: int) -> list[Place]:
        """Gears that may be solved: corners, middles of sides, and others crowding to the ends as Chebyshev's points.

        Parameters
        ----------
        count : int
            Of the others.
        """
        corners = np.array(list(product((-1.0, 0.0, 1.0), repeat=4)))
        spread = np.mod(0.5 + np.arange(1, count + 1)[:, None] * _STEPS, 1.0)
        every = np.concatenate([corners, -np.cos(math.pi * spread)]) * np.array(self.varies)
        rounded = (self.place(family, at) for at in every)
        # upwards: what should be on the undercut line would be undercut in its last digit, and other gears by 2e-3
        return list(dict.fromkeys(place._replace(shift=math.ceil(place.shift * 1e9) * 1e-9) for place in rounded))


def _of_bore(ratio: Array) -> Array:
    """Of a small bore its logarithm counts, of a thin rim that of the rim."""
    return np.log(ratio / (1.0 - ratio))


def _within(value: Array, low: Array, high: Array) -> Array:
    extent = np.asarray(high - low)
    shape = np.broadcast_shapes(np.shape(value), extent.shape)
    found = np.divide(2.0 * value - low - high, extent, out=np.zeros(shape), where=extent > 0.0)
    return np.asarray(np.clip(found, -1.0, 1.0))
