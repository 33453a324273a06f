"""Sectors in a row: joined to one, or with free ends, as a plain finite-element model cuts a few teeth out of a gear.

The stiffness between the sides of a row is block tridiagonal, so one sweep from either end leaves the two sides of the
loaded sector.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import FegearError
from fegear.fem.plane.condensation import symmetric


def chain_coupling(condensed: Array, teeth: int, reach: int) -> tuple[dict[int, Array], dict[int, Array]]:
    """Motion of the sides of a row of equal sectors, both ends free, the middle one loaded.

    Parameters
    ----------
    condensed : ndarray, shape (2 m, 2 m)
        Stiffness of one sector between its sides A and B, in polar components.
    teeth : int
        Sectors of the row; of an even number the first of the middle two is loaded.
    reach : int
        At most (teeth - 1) // 2.

    Returns
    -------
    from_a, from_b : dict of int to ndarray, shape (m, m)
        Motion of side A of sector k under forces on side A, and on side B, of sector 0, for k = -reach..reach + 1.
    """
    m = condensed.shape[0] // 2
    aa, ab, bb = condensed[:m, :m], condensed[:m, m:], condensed[m:, m:]
    middle = (teeth - 1) // 2
    # Stiffness of a side with all sectors on its left (on its right) behind it.
    left = [np.zeros((m, m))]
    right = [np.zeros((m, m))]
    for _ in range(teeth):
        left.append(bb - ab.T @ np.linalg.solve(aa + left[-1], ab))
        right.append(aa - ab @ np.linalg.solve(bb + right[-1], ab.T))
    right.reverse()
    found = []
    for loaded in (middle, middle + 1):
        motion = {loaded: np.linalg.inv(left[loaded] + right[loaded])}
        for side in range(loaded + 1, teeth + 1):
            motion[side] = -np.linalg.solve(bb + right[side], ab.T @ motion[side - 1])
        for side in range(loaded - 1, -1, -1):
            motion[side] = -np.linalg.solve(aa + left[side], ab @ motion[side + 1])
        found.append({k: motion[middle + k] for k in range(-reach, reach + 2)})
    return found[0], found[1]


def chain_of(condensed: Array, count: int) -> Array | None:
    """A row of equal sectors as one, between its ends, in some log2(count) steps; None of no sectors.

    Parameters
    ----------
    condensed : ndarray, shape (2 m, 2 m)
        Stiffness of one sector between its sides A and B, in components that agree between neighbours.
    count : int
    """
    rest: Array | None = None
    power, left = condensed, count
    while left:
        if left & 1:
            rest = power if rest is None else joined(rest, power).chain
        left >>= 1
        power = joined(power, power).chain if left else power
    return rest if rest is None or rest is condensed else symmetric(rest).T


class Join(NamedTuple):
    """Two chains as one, and how the side between them, which is gone, follows its ends.

    Attributes
    ----------
    chain : ndarray, shape (2 m, 2 m)
        Stiffness between the ends, its lower triangle.
    factor : ndarray, shape (m, m)
        L, of the stiffness of the side between.
    border : ndarray, shape (2 m, m)
        B: the side moves by -L^-T B^T u, u the motion of both ends.
    """

    chain: Array
    factor: Array
    border: Array

    def between(self, ends: Array) -> Array:
        """Motion of the side between from that of both ends, shape (m, P) from (2 m, P)."""
        from scipy.linalg import blas

        inner = np.asfortranarray(self.border.T @ ends)
        return np.asarray(blas.dtrsm(-1.0, self.factor, inner, lower=1, trans_a=1, overwrite_b=1))


def joined(one: Array, other: Array) -> Join:
    """Two chains with the side between them eliminated; of both only the lower triangle is read."""
    from scipy.linalg import blas

    m = one.shape[0] // 2
    factor = factored(one[m:, m:] + other[:m, :m])
    border = np.empty((2 * m, m), order="F")
    border[:m], border[m:] = one[m:, :m].T, other[m:, :m]
    chain = np.zeros(one.shape, order="F")
    chain[:m, :m], chain[m:, m:] = one[:m, :m], other[m:, m:]
    border = blas.dtrsm(1.0, factor, border, side=1, lower=1, trans_a=1, overwrite_b=1)
    return Join(np.asarray(blas.dsyrk(-1.0, border, beta=1.0, c=chain, lower=1, overwrite_c=1)), factor, border)


def factored(stiffness: Array) -> Array:
    """Lower Cholesky factor.

    Raises
    ------
    FegearError
        If the stiffness is not positive definite.
    """
    from scipy.linalg import lapack

    factor, failed = lapack.dpotrf(stiffness, lower=1)
    if failed:
        raise FegearError("the sector's stiffness cannot be factored: it is not positive definite")
    return np.asarray(factor)
