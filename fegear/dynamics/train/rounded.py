"""Numbers that carry a bound of their own round-off, to first order, for whole arrays of frequencies at once.

The bound counts units of the last place, whatever the length of the floats: times the machine epsilon it is an error.
It says which of two ways to one number kept more digits, and when longer floats are worth their time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.inexact]
Bounds = NDArray[np.floating]


@dataclass(frozen=True, slots=True)
class Rounded:
    """A value and the size of its round-off in machine epsilons.

    Attributes
    ----------
    value : ndarray, shape (frequencies,)
    error : ndarray, shape (frequencies,)
        Bound of the absolute error, divided by the machine epsilon.
    """

    value: Values
    error: Bounds

    @classmethod
    def given(cls, value: Values) -> Rounded:
        """A number that comes from input: right to its last place."""
        return cls(value, np.abs(value))

    @classmethod
    def zero(cls, like: Values) -> Rounded:
        """Zero, exactly."""
        return cls(np.zeros_like(like), np.zeros(like.shape, dtype=np.abs(like[:0]).dtype))

    def __neg__(self) -> Rounded:
        return Rounded(-self.value, self.error)

    def __add__(self, other: Rounded) -> Rounded:
        value = self.value + other.value
        return Rounded(value, self.error + other.error + np.abs(value))

    def __sub__(self, other: Rounded) -> Rounded:
        value = self.value - other.value
        return Rounded(value, self.error + other.error + np.abs(value))

    def __mul__(self, other: Rounded) -> Rounded:
        size, times = np.abs(self.value), np.abs(other.value)
        return Rounded(self.value * other.value, size * other.error + self.error * times + 2.0 * size * times)

    def __truediv__(self, other: Rounded) -> Rounded:
        by = np.abs(other.value)
        value = self.value / other.value
        return Rounded(value, (self.error + np.abs(value) * other.error) / by + 3.0 * np.abs(value))

    def times(self, factor: float | np.floating) -> Rounded:
        """The number times one that is exact."""
        value = np.multiply(self.value, factor)
        return Rounded(value, np.multiply(self.error, np.abs(factor)) + np.abs(value))


def beside_zero(one: Rounded, other: Rounded) -> Values:
    """The sum of two numbers; where they cancel altogether, a unit of their last place (one, if both are zero)."""
    total = one.value + other.value
    size = np.abs(one.value) + np.abs(other.value)
    last = np.finfo(size.dtype).eps * size
    return np.asarray(np.where(total == 0.0, np.where(last == 0.0, 1.0, last), total))


def share(part: Rounded, rest: Rounded, whole: Values | None = None) -> Rounded:
    """part / (part + rest), each error by its true derivative: a small rest matters little, however uncertain.

    `whole`: their sum, where it is known and kept from zero already.
    """
    whole = beside_zero(part, rest) if whole is None else whole
    size, left, by = np.abs(part.value), np.abs(rest.value), np.abs(whole)
    value = part.value / whole
    return Rounded(value, (left * part.error + size * rest.error) / by**2 + 3.0 * np.abs(value))


def in_series(one: Rounded, other: Rounded, total: Values, elsewhere: Bounds | float = 0.0) -> Rounded:
    """one x other / total, the total being their sum with others whose errors add up to `elsewhere`.

    Each error counts by its true derivative: a huge admittance in series with a small one passes on the small one,
    however uncertain it is itself.
    """
    value = one.value * other.value / total
    size, by = np.abs(total), np.abs(value)
    a, b = np.abs(one.value), np.abs(other.value)
    error = b * np.abs(total - one.value) * one.error + a * np.abs(total - other.value) * other.error
    return Rounded(value, (error / size + by * elsewhere) / size + 3.0 * by)
