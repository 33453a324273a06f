"""Results that cannot be changed: dataclasses with read-only arrays, equal where their content is.

Names of the arrays that annotations speak of, written once; imported for type checking only.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.brief import Brief


def same(one: object, other: object) -> bool:
    """Whether two things have the same content: arrays entry by entry, and what is no number twice is the same.

    Parameters
    ----------
    one, other : object
        Dataclasses count by the fields that count in comparisons.
    """
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _same_arrays(one, other)
    if type(one) is not type(other):
        return bool(one == other)
    if is_dataclass(one) and not isinstance(one, type):
        compared = [field.name for field in fields(one) if field.compare]
        return all(same(getattr(one, name), getattr(other, name)) for name in compared)
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, (tuple, list)) and isinstance(other, (tuple, list)):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, partial) and isinstance(other, partial):
        return all(same(getattr(one, name), getattr(other, name)) for name in ("func", "args", "keywords"))
    return bool(one == other) or (one != one and other != other)


def _same_arrays(one: object, other: object) -> bool:
    if not (isinstance(one, np.ndarray) and isinstance(other, np.ndarray)) or one.shape != other.shape:
        return False
    if one.dtype == object or other.dtype == object:
        return all(map(same, one.ravel().tolist(), other.ravel().tolist()))
    return np.array_equal(one, other, equal_nan=one.dtype.kind in "fc" and other.dtype.kind in "fc")


class Alike(Brief):
    """Base of dataclasses that hold arrays: two of them are equal where their content is the `same`.

    The comparison that dataclasses have by themselves asks arrays for one truth value, and raises.
    """

    __slots__ = ()

    def __init_subclass__(cls) -> None:
        """Compare by content, in the place of what the decorator of a dataclass would write."""
        super().__init_subclass__()
        if "__eq__" not in cls.__dict__:
            cls.__eq__ = _alike  # type: ignore[method-assign]  # on purpose


def _alike(one: object, other: object) -> bool:
    if type(one) is not type(other) or not getattr(one, "__dataclass_params__").eq:  # noqa: B009  (mypy does not know it)
        return NotImplemented
    return same(one, other)


class ReadOnlyArrays(Alike):
    """Base of frozen dataclasses that makes every array of theirs read-only."""

    __slots__ = ()

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for field in fields(self):  # type: ignore[arg-type]  # heirs are dataclasses
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)


#: Sizes that differ by less than this share are equal: the places of a symmetric thing are, but for round-off.
_TIE = 1e-9


def first_of_largest(values: ArrayLike, axis: int | None = None, tie: float = _TIE) -> Index:
    """Where the largest of values stands, and the first of those that equal it but for a share of its size.

    With `np.argmax` the last bit decides where a symmetric thing is largest, and another processor says another place.

    Parameters
    ----------
    values : array_like
        Without NaN; -inf never counts.
    axis : int, optional
        Along which it is looked for; without one the answer is the place among all of them, as of `np.argmax`.
    tie : float
        Share of the largest size below which two values are equal.

    Returns
    -------
    ndarray of int
        Of the shape of `values` without the axis; of shape () without one.
    """
    of = np.asarray(values)
    top = of.max(axis=axis, keepdims=True)
    return np.asarray(np.argmax(of >= top - tie * np.abs(top), axis=axis))


#: Real numbers.
Array = NDArray[np.float64]


#: Real numbers of single or double precision, for searches that are quicker in single.
Floats = NDArray[np.floating]


#: Numbers of nodes, unknowns, teeth, rows.
Index = NDArray[np.int64]


#: Amplitudes and spectra, with exp(+i w t).
Complex = NDArray[np.complex128]


#: What holds and what does not.
Mask = NDArray[np.bool_]


def distinct(*places: ArrayLike, within: float = 1e-9) -> Array:
    """Places in ascending order, once each: of those that only round-off distinguishes the one given first.

    An even grid that meets a given place in all but its last digit has one place there, whatever that digit is.

    Parameters
    ----------
    *places : array_like, shapes (n,)
        The exact ones first.
    within : float
        Over the extent of all: nearer ones are the same.

    Returns
    -------
    ndarray, shape (k,)
    """
    x = np.concatenate([np.atleast_1d(np.asarray(some, dtype=float)) for some in places])
    order = np.argsort(x, kind="stable")
    starts = np.flatnonzero(np.append(True, np.diff(x[order]) > within * np.ptp(x)))
    return x[np.minimum.reduceat(order, starts)]
