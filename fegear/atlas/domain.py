"""A region of a family over which everything is smooth, its coordinates, and the gears that are solved in it.

Tables are smooth in the logarithm of the number of teeth, not in its reciprocal, in the profile shift, the tip height
and the logarithm of the bore ratio. They break where the rack begins to cut off the involute: a region lies on one side
of that line, and where the line is one of its ends the profile shift counts from there.
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
    from fegear.base.arrays import Array

Side = Literal["whole", "undercut"]
Ends = tuple[float, float]
#: A gear with undercut keeps so much profile shift from the line: at the line its flank starts in no corner.
_BELOW_LINE = 2e-3
#: Outside by no more than this share of a region's extent is at its end.
ROUND_OFF = 1e-9
#: What the coordinates are called, as keys of a gear.
KEYS = ("teeth", "profile_shift", "tip height", "bore ratio")


@dataclass(frozen=True)
class Domain:
    """A region of a family.

    Parameters
    ----------
    teeth, shift, tip_height, bore : tuple of float
        Ends of each number of `Place`; equal ones where it does not vary.
    side : {"whole", "undercut"}
        On which side of the undercut line it lies.
    """

    teeth: tuple[int, int]
    shift: Ends
    tip_height: Ends = (1.0, 1.0)
    bore: Ends = (0.5, 0.5)
    side: Side = "whole"

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

    def check(self, family: Family) -> None:
        """Refuse a region whose end in profile shift changes over from a number to the undercut line.

        Raises
        ------
        InputError
            With the number of teeth at which to cut it.
        """
        of = self.shift[0] if self.side == "whole" else self.shift[1]
        first, last = (family.least_shift(z) for z in self.teeth)
        if first > of + ROUND_OFF and last < of - ROUND_OFF:
            cut = self.teeth[0] + (first - of) * (self.teeth[1] - self.teeth[0]) / (first - last)
            raise InputError(
                "teeth", f"{self.teeth[0]} to {self.teeth[1]}",
                f"crosses the undercut line at z = {cut:.2f} (x = {of:.6g})",
                f"end one region at {math.floor(cut)} teeth and begin the next at {math.ceil(cut)}",
            )  # fmt: skip
        for z in self.teeth:
            low, high = self.shift_ends(family, z)
            if low > high:
                raise InputError(
                    "shift", f"{self.shift[0]:.6g} to {self.shift[1]:.6g}",
                    f"leaves nothing on its side of the undercut line at z = {z}",
                )  # fmt: skip

    def shift_ends(self, family: Family, teeth: float) -> Ends:
        """Ends of the profile shift at a number of teeth."""
        line, (low, high) = family.least_shift(teeth), self.shift
        return (max(low, line), high) if self.side == "whole" else (low, min(high, line - _BELOW_LINE))

    def ends(self, family: Family, teeth: float) -> tuple[Ends, ...]:
        """Ends of the four numbers of gears with so many teeth."""
        return self.teeth, self.shift_ends(family, teeth), self.tip_height, self.bore

    def outside(self, family: Family, place: Place) -> tuple[int, Ends] | None:
        """Which number of a gear lies outside, and the ends that it lies outside of; None of a gear inside."""
        if not self.teeth[0] <= place.teeth <= self.teeth[1]:
            return 0, self.teeth
        for number, (value, (low, high)) in enumerate(zip(place, self.ends(family, place.teeth), strict=True)):
            slack = ROUND_OFF * max(1.0, high - low)
            if not low - slack <= value <= high + slack:
                return number, (low, high)
        return None

    def coordinates(self, family: Family, place: Place) -> Array:
        """Coordinates from -1 to 1, shape (4,); 0 where a number does not vary."""
        ends = self.ends(family, place.teeth)
        return np.array([
            _within(math.log(value), math.log(low), math.log(high)) if number in (0, 3) else _within(value, low, high)
            for number, (value, (low, high)) in enumerate(zip(place, ends, strict=True))
        ])  # fmt: skip

    def place(self, family: Family, teeth: int, at: tuple[float, float, float]) -> Place:
        """The gear with so many teeth at the other three coordinates."""
        (low, high), shift = self.shift_ends(family, teeth), at[0]
        first, last = (math.log(one) for one in self.bore)
        height = self.tip_height[0] + 0.5 * (1.0 + at[1]) * (self.tip_height[1] - self.tip_height[0])
        bore = math.exp(first + 0.5 * (1.0 + at[2]) * (last - first))
        return Place(teeth, low + 0.5 * (1.0 + shift) * (high - low), height, bore)

    def nodes(self, counts: tuple[int, int, int, int]) -> Nodes:
        """Where gears are solved: Chebyshev's points of each coordinate with its ends, teeth rounded to whole ones.

        Parameters
        ----------
        counts : tuple of int
            Of each number; 1 where it does not vary. Numbers of teeth that fall together are one.
        """
        places = []
        for name, count in zip(("teeth", "shift", "tip_height", "bore"), counts, strict=True):
            low, high = getattr(self, name)
            if (count == 1) != (low == high) or count < 1:
                rule = "must be 1 where the ends are equal and at least 2 elsewhere"
                raise InputError(f"nodes of {name}", count, rule)
            places.append(np.zeros(1) if count == 1 else -np.cos(math.pi * np.arange(count) / (count - 1)))
        low, high = (math.log(z) for z in self.teeth)
        teeth = np.unique(np.rint(np.exp(low + 0.5 * (1.0 + places[0]) * (high - low))).astype(int))
        return Nodes(tuple(teeth.tolist()), (places[1], places[2], places[3]))


@dataclass(frozen=True)
class Nodes:
    """Numbers of teeth, and coordinates of the other three numbers, of the gears that are solved."""

    teeth: tuple[int, ...]
    others: tuple[Array, Array, Array]

    @property
    def shape(self) -> tuple[int, ...]:
        """How many of each number."""
        return len(self.teeth), *(one.size for one in self.others)

    def coordinates(self, domain: Domain) -> tuple[Array, ...]:
        """Coordinates from -1 to 1 along each number."""
        low, high = (math.log(z) for z in domain.teeth)
        return np.array([_within(math.log(z), low, high) for z in self.teeth]), *self.others

    def places(self, domain: Domain, family: Family) -> list[Place]:
        """All of them, the last number fastest."""
        return [
            domain.place(family, teeth, (float(shift), float(height), float(bore)))
            for teeth, shift, height, bore in product(self.teeth, *self.others)
        ]


def _within(value: float, low: float, high: float) -> float:
    return 0.0 if high == low else min(max((2.0 * value - low - high) / (high - low), -1.0), 1.0)
