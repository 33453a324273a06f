"""What a grinder can do to the flanks of a pair, in a few numbers: tip reliefs, crowning, end relief, slope, bias.

The modifications that are tried: lists of amounts and lengths, and the families that combine them.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.base.shown import shown
from fegear.geometry.pair import GearPair


@dataclass(frozen=True, slots=True)
class GroundRelief:
    """Modification of both flanks together, the same along the face or along the profile but for the bias.

    Tip reliefs are straight lines, the driver's to the end of the path of contact and the driven gear's to its start.
    The crowning of the lead is a parabola, nothing in the middle of the face; the end relief grows as a straight line.
    Of the bias (twist of the flank) a quarter is taken from the driver's tip at +b/2 and from its root at -b/2, and
    left at the two other corners.
    """

    driver_tip: float = shown("um", "tip relief of the driver", default=0.0)
    driver_tip_length: float = shown("mm", "of that relief, along the line of action", default=0.0)
    driven_tip: float = shown("um", "tip relief of the driven gear", default=0.0)
    driven_tip_length: float = shown("mm", "of that relief, along the line of action", default=0.0)
    crowning: float = shown("um", "of the lead, at both ends", default=0.0)
    end_relief: float = shown("um", "at both ends of the face", default=0.0)
    end_relief_length: float = shown("mm", "along the face", default=0.0)
    slope: float = shown("um", "of the helix, at +b/2 less at -b/2", default=0.0)
    bias: float = shown("um", "profile slope at +b/2 less at -b/2, of the driver", default=0.0)

    @property
    def numbers(self) -> Array:
        """All of them in the order of `NUMBERS`, shape (9,)."""
        return np.array([getattr(self, name) for name in NUMBERS])

    @classmethod
    def of(cls, numbers: Array) -> GroundRelief:
        """From numbers in the order of `NUMBERS`; a relief of no amount has no length."""
        given = dict(zip(NUMBERS, (float(v) for v in numbers), strict=True))
        for amount, length in LENGTHS.items():
            if given[amount] == 0.0:
                given[length] = 0.0
        return cls(**given)

    def removal(self, pair: GearPair, x: ArrayLike, z: ArrayLike) -> Array:
        """Removal at points of the plane of action, not negative on the flank [m]."""
        base = 0.5 * abs(self.slope) + 0.25 * abs(self.bias)
        return np.asarray(FormsAt.over(pair, x, z).removed(self.numbers) + base)


LENGTHS = {
    "driver_tip": "driver_tip_length", "driven_tip": "driven_tip_length", "end_relief": "end_relief_length",
}  # fmt: skip


@dataclass(frozen=True)
class FormsAt(ReadOnlyArrays):
    """Places of the plane of action, as the modifications count them; arrays of any one shape.

    Parameters
    ----------
    driver_depth, driven_depth : ndarray
        Distance along the path from where the driver's, and the driven gear's, tip leaves contact [m].
    end_depth : ndarray
        Distance from the nearer end of the face [m].
    across, along : ndarray
        -1 to 1 from the driver's root to its tip, and from one end of the face to the other.
    """

    driver_depth: Array
    driven_depth: Array
    end_depth: Array
    across: Array
    along: Array

    @classmethod
    def over(cls, pair: GearPair, x: ArrayLike, z: ArrayLike) -> FormsAt:
        """Places of a pair."""
        first, second = np.asarray(x, dtype=float), np.asarray(z, dtype=float)
        half = 0.5 * pair.face_width
        middle = 0.5 * (pair.x_start + pair.x_end)
        return cls(
            pair.x_end - first, first - pair.x_start, half - np.abs(second),
            2.0 * (first - middle) / pair.path_length, second / half,
        )  # fmt: skip

    def removed(self, numbers: Array) -> Array:
        """Removal by nine numbers, without the constant that keeps it from being negative, shape of the places [m]."""
        tip, tip_length, foot, foot_length, crowning, end, end_length, slope, bias = numbers.tolist()
        total = crowning * self.along**2 + 0.5 * slope * self.along + 0.25 * bias * self.across * self.along
        ends = ((tip, tip_length, self.driver_depth), (foot, foot_length, self.driven_depth),
                (end, end_length, self.end_depth))  # fmt: skip
        for amount, length, depth in ends:
            if amount != 0.0:
                total = total + amount * np.maximum(1.0 - depth / length, 0.0)
        return np.asarray(total)

    def slopes(self, numbers: Array) -> Array:
        """Derivative by each of the nine numbers, shape (9, ...)."""
        found = np.zeros((len(NUMBERS), *self.across.shape))
        for i, depth in ((0, self.driver_depth), (2, self.driven_depth), (5, self.end_depth)):
            amount, length = numbers[i], numbers[i + 1]
            if length > 0.0:
                inside = depth < length
                found[i] = np.where(inside, 1.0 - depth / length, 0.0)
                found[i + 1] = np.where(inside, amount * depth / length**2, 0.0)
        found[4], found[7], found[8] = self.along**2, 0.5 * self.along, 0.25 * self.across * self.along
        return found


#: The nine numbers, and the amounts that go with a length.
NUMBERS: tuple[str, ...] = tuple(f.name for f in fields(GroundRelief))


Family = Literal["profile", "lead", "crowning-and-end-relief", "profile-and-lead", "profile-lead-and-bias"]


#: The groups of numbers that each family may choose; all others are zero. Later families hold earlier ones.
FAMILIES: Mapping[Family, tuple[str, ...]] = {
    "profile": ("driver_tip", "driven_tip"),
    "crowning-and-end-relief": ("crowning", "end_relief"),
    "lead": ("crowning", "end_relief", "slope"),
    "profile-and-lead": ("driver_tip", "driven_tip", "crowning", "end_relief", "slope"),
    "profile-lead-and-bias": ("driver_tip", "driven_tip", "crowning", "end_relief", "slope", "bias"),
}


#: Numbers of each group, by their place among the nine.
GROUPS: Mapping[str, tuple[int, ...]] = {
    "driver_tip": (0, 1), "driven_tip": (2, 3), "crowning": (4,), "end_relief": (5, 6), "slope": (7,), "bias": (8,),
}  # fmt: skip


def held_by(family: Family) -> tuple[Family, ...]:
    """Families whose every candidate is one of this family's, too."""
    own = set(FAMILIES[family])
    return tuple(f for f, groups in FAMILIES.items() if f != family and set(groups) <= own)


@dataclass(frozen=True, slots=True)
class ReliefGrid:
    """Amounts and lengths whose every combination is tried; zero always is.

    Parameters
    ----------
    tip_amounts, tip_lengths : tuple of float
        Of both gears' tip reliefs [m]; lengths along the path of contact.
    crownings : tuple of float
        [m].
    end_amounts, end_lengths : tuple of float
        Of the end relief [m].
    slopes, biases : tuple of float
        [m].
    """

    tip_amounts: tuple[float, ...]
    tip_lengths: tuple[float, ...]
    crownings: tuple[float, ...]
    end_amounts: tuple[float, ...]
    end_lengths: tuple[float, ...]
    slopes: tuple[float, ...]
    biases: tuple[float, ...]

    def choices(self, group: str) -> Array:
        """What a group of numbers may be, the first of them nothing, shape (n, numbers of the group)."""
        if group in ("driver_tip", "driven_tip", "end_relief"):
            amounts, lengths = (
                (self.end_amounts, self.end_lengths) if group == "end_relief" else (self.tip_amounts, self.tip_lengths)
            )
            pairs = [(0.0, 0.0), *itertools.product(sorted({a for a in amounts if a}), sorted(set(lengths)))]
            return np.array(pairs)
        single = {"crowning": self.crownings, "slope": self.slopes, "bias": self.biases}[group]
        return np.array([0.0, *sorted({v for v in single if v})])[:, None]

    def limits(self, family: Family) -> tuple[Array, Array]:
        """Least and largest value of each of the nine numbers, shape (9,) each: the box that the grid fills."""
        low, high = np.zeros(len(NUMBERS)), np.zeros(len(NUMBERS))
        for group in FAMILIES[family]:
            values = self.choices(group)
            for column, number in enumerate(GROUPS[group]):
                seen = values[1:, column] if column else values[:, column]
                if seen.size:
                    low[number], high[number] = seen.min(), seen.max()
        return low, high

    def combinations(self, family: Family) -> Index:
        """Every combination as one choice of each of the family's groups, shape (C, groups)."""
        counts = [self.choices(group).shape[0] for group in FAMILIES[family]]
        return np.stack(np.unravel_index(np.arange(int(np.prod(counts))), counts), axis=1)

    def numbers(self, family: Family, combination: Index) -> Array:
        """The nine numbers of combinations of shape (C, groups), shape (C, 9)."""
        found = np.zeros((combination.shape[0], len(NUMBERS)))
        for column, group in enumerate(FAMILIES[family]):
            found[:, GROUPS[group]] = self.choices(group)[combination[:, column]]
        return found


def usual_grid(depth: float, path: float, face: float, base_pitch: float) -> ReliefGrid:
    """Amounts in parts of the deepest relief of the exact topography, lengths in parts of path and face.

    Parameters
    ----------
    depth : float
        Largest less least removal of the topography [m].
    path, face, base_pitch : float
        [m].
    """
    double = max(path - base_pitch, 0.1 * path)
    return ReliefGrid(
        tip_amounts=tuple(depth * f for f in (0.5, 0.85, 1.2)),
        tip_lengths=tuple(sorted({0.5 * path, min(double, 0.9 * path)})),
        crownings=tuple(depth * f for f in (0.1, 0.25)),
        end_amounts=tuple(depth * f for f in (0.15, 0.4)),
        end_lengths=tuple(face * f for f in (0.15, 0.35)),
        slopes=tuple(depth * f for f in (-0.1, 0.1)),
        biases=tuple(depth * f for f in (-1.0, -0.4, 0.4, 1.0)),
    )  # fmt: skip
