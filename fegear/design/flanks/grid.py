"""The modifications that are tried: lists of amounts and lengths, and the families that combine them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.design.flanks.forms import LENGTHS, NUMBERS

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


#: Amounts of tip reliefs that are tried, over the mean transmission error.
TIP_AMOUNTS = (0.15, 0.4, 0.8, 1.5, 3.0, 6.0)

#: Where a number is as good as at an end of the box, over the extent of the box.
_AT_END = 1e-3


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
    reach : mapping of str to (float, float), optional
        Least and largest of some of the nine numbers that a descent may lead to where these are beyond the lists [m].
    utmost : mapping of str to (float, float), optional
        How far `reach` may be widened where the best lies at an end of it [m]; not at all by default.
    """

    tip_amounts: tuple[float, ...]
    tip_lengths: tuple[float, ...]
    crownings: tuple[float, ...]
    end_amounts: tuple[float, ...]
    end_lengths: tuple[float, ...]
    slopes: tuple[float, ...]
    biases: tuple[float, ...]
    reach: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    utmost: Mapping[str, tuple[float, float]] = field(default_factory=dict)

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
        """Least and largest value of each of the nine numbers, shape (9,) each: the box of the grid, or more."""
        low, high = np.zeros(len(NUMBERS)), np.zeros(len(NUMBERS))
        for group in FAMILIES[family]:
            values = self.choices(group)
            for column, number in enumerate(GROUPS[group]):
                seen = values[1:, column] if column else values[:, column]
                if values.shape[0] > 1:
                    seen = np.append(seen, self.reach.get(NUMBERS[number], ()))
                if seen.size:
                    low[number], high[number] = seen.min(), seen.max()
        return low, high

    def at_ends(self, family: Family, numbers: Array) -> dict[str, bool]:
        """Which numbers of a modification lie at an end of the box, and whether at its upper one.

        What is not ground lies at none, and neither do lengths of it.
        """
        low, high = self.limits(family)
        slack = _AT_END * (high - low)
        ground = np.abs(numbers) > slack
        for amount, length in LENGTHS.items():
            ground[NUMBERS.index(length)] &= ground[NUMBERS.index(amount)]
        upper = numbers >= high - slack
        at = np.flatnonzero((high > low) & ground & (upper | (numbers <= low + slack)))
        return {NUMBERS[k]: bool(upper[k]) for k in at}

    def widened(self, family: Family, numbers: Array) -> ReliefGrid:
        """The grid with a box twice as wide past every end at which a modification lies; itself where none may be."""
        low, high = self.limits(family)
        reach = dict(self.reach)
        for name, upper in self.at_ends(family, numbers).items():
            k = NUMBERS.index(name)
            least, most = self.utmost.get(name, (low[k], high[k]))
            span = float(high[k] - low[k])
            wide = (float(low[k]), min(most, float(high[k]) + span)) if upper else (
                max(least, float(low[k]) - span), float(high[k])
            )  # fmt: skip
            if wide[1] - wide[0] > (1.0 + _AT_END) * span:
                reach[name] = wide
        return self if reach == self.reach else replace(self, reach=reach)

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
        reach=dict.fromkeys(("driver_tip_length", "driven_tip_length"), (0.1 * path, path)),
        utmost={
            **dict.fromkeys(("driver_tip", "driven_tip", "crowning", "end_relief"), (0.0, math.inf)),
            **dict.fromkeys(("slope", "bias"), (-math.inf, math.inf)),
            "end_relief_length": (0.05 * face, 0.5 * face),
        },
    )  # fmt: skip
