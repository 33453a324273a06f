"""Axes of a panel: what they show, in which unit, on which scale."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.engine.figure.fixed import fixed

#: Logarithmic axes that span less have plain numbers at 1, 2, 3 and 5 times the powers of ten.
FEW_DECADES = 100.0


@dataclass(frozen=True, slots=True)
class Scale:
    """A second scale on the far side of an axis: which value belongs to which place.

    Parameters
    ----------
    label, unit : str
    at, value : array_like, shape (N,)
        Both rising.
    """

    label: str
    unit: str
    at: ArrayLike
    value: ArrayLike

    def ticks(self) -> tuple[Array, tuple[str, ...]]:
        """Places and texts of its marks, at round values."""
        at, value = fixed(self.at), fixed(self.value)
        shown = round_numbers(float(value[0]), float(value[-1]))
        return np.interp(shown, value, at), tuple(f"{v:.6g}" for v in shown)


def round_numbers(low: float, high: float, most: int = 7) -> Array:
    """Multiples of 1, 2 or 5 times a power of ten between two values, at most so many."""
    if not high > low:
        return np.array([low])
    power = 10.0 ** math.floor(math.log10((high - low) / most))
    step = next(s * power for s in (1.0, 2.0, 5.0, 10.0) if (high - low) / (s * power) <= most)
    return fixed(np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1) * step)


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of a panel.

    Parameters
    ----------
    label, unit : str
        The unit as in a column of a table.
    log : bool
    zero : bool
        Whether it starts at zero.
    categories : tuple of str
        Names of the places 0, 1, 2, ...
    whole : bool
        Whether only whole numbers have a meaning.
    limits : (float, float), optional
        Where some curves would stretch it too far.
    second : Scale, optional
    ticks : tuple of (float, str)
        Places that bear words in place of numbers; what is drawn may stand between them.
    hidden : bool
        Without numbers: only the lines at the other axis's names.
    """

    label: str = ""
    unit: str = ""
    log: bool = False
    zero: bool = False
    categories: tuple[str, ...] = ()
    whole: bool = False
    limits: tuple[float, float] | None = None
    second: Scale | None = None
    ticks: tuple[tuple[float, str], ...] = ()
    hidden: bool = False

    def like(self, other: Axis) -> bool:
        """Whether two axes show the same thing on the same scale."""
        return (self.label, self.unit, self.log, self.categories) == (
            other.label, other.unit, other.log, other.categories,
        )  # fmt: skip
