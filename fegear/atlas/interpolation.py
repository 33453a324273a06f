"""Polynomials through values at nodes in several coordinates, and what those of one degree less leave out."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array

_chebyshev = np.polynomial.chebyshev


def series(nodes: Array) -> Array:
    """Matrix from values at nodes in -1 to 1 to the coefficients of the Chebyshev series through them."""
    return np.asarray(np.linalg.inv(_chebyshev.chebvander(nodes, nodes.size - 1)))


def weights(nodes: Array, at: float) -> Array:
    """Weights of the values at nodes in the polynomial's value at a coordinate."""
    hit = np.flatnonzero(nodes == at)
    if hit.size:  # to the last bit
        return np.eye(nodes.size)[hit[0]]
    return np.asarray(_chebyshev.chebvander(np.array([at]), nodes.size - 1)[0] @ series(nodes))


def contracted(values: Array, factors: list[Array]) -> Array:
    """Values over a grid of nodes summed with a row of weights along each coordinate; further axes stay."""
    for factor in factors:
        values = np.tensordot(factor, values, (0, 0))
    return values


def left_out(values: Array, nodes: tuple[Array, ...], at: tuple[float, ...]) -> list[list[Array]]:
    """The last terms of the Chebyshev series along each coordinate that varies, at a place along the others.

    Parameters
    ----------
    values : ndarray, shape (*nodes, ...)
    nodes : tuple of ndarray
        Of each coordinate.
    at : tuple of float

    Returns
    -------
    list of list of ndarray
        By coordinate: coefficients of the highest degree, of the next lower ones, three at most. A Chebyshev
        polynomial is no larger than 1, so a coefficient is all that its term can be.
    """
    factors = [weights(one, place) for one, place in zip(nodes, at, strict=True)]
    found = []
    for axis, one in enumerate(nodes):
        if one.size > 1:
            rows = series(one)
            found.append([
                contracted(values, [rows[-n] if other == axis else factor for other, factor in enumerate(factors)])
                for n in range(1, min(one.size, 3) + 1)
            ])  # fmt: skip
    return found


def truncation(last: list[Array]) -> Array:
    """Estimated error of a series from sizes of its last coefficients, the highest degree first, elementwise.

    Coefficients go on falling as they fell: between Chebyshev's points a polynomial misses twice the first one that
    it has not. The slower of the last two steps counts, for a single coefficient may vanish by chance. Of one degree
    the term is all that is known.
    """
    if len(last) < 3:
        return np.asarray(last[0])
    steps = [
        np.divide(after, before, out=np.ones_like(after), where=before > after) for after, before in pairwise(last)
    ]
    return np.asarray(2.0 * np.maximum(*steps) ** 2 * last[1])
