"""A ring some of whose sectors differ from the others.

Sectors -R..R stand for themselves, the z - 2 R - 1 others are one chain (`chain_of`), and what is left is the stiffness
between the 2 R + 2 sides of the former. With H its inverse and A, B, G those of each sector's own kind (`BetweenSides`)

    u_i = A_i (H_ij A_j' + H_i,j+1 B_j') f + B_i (H_i+1,j A_j' + H_i+1,j+1 B_j') f + (i = j) G_i f.

An odd sector needs the ordinary one's nodes on its sides, nothing else; any pattern of them fits, and nothing is found
as a difference of two rings. Without one this is the ordinary ring to round-off.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.fem.plane.chain import chain_of, factored
from fegear.fem.plane.ring_closure import closed_stiffness
from fegear.fem.plane.sector_sides import BetweenSides


@dataclass(frozen=True)
class OddRing:
    """A closed ring of condensed sectors of several kinds; E = 1, lengths in modules.

    Parameters
    ----------
    reach : int
        R: sectors -R..R can be loaded and watched.
    motion : ndarray, shape (2 R + 2, m, 2 R + 2, m)
        H, motions of the sides -R..R + 1 under forces on them, in polar components.
    """

    reach: int
    motion: Array

    def between(self, watched: int, loaded: int) -> Array:
        """Motion of the sides A and B of one sector under forces on those of another, shape (2 m, 2 m)."""
        i, j, m = watched + self.reach, loaded + self.reach, self.motion.shape[1]
        return self.motion[i : i + 2, :, j : j + 2].reshape(2 * m, 2 * m)


def odd_ring(ordinary: BetweenSides, odd: Mapping[int, BetweenSides], teeth: int, reach: int) -> OddRing:
    """Close a ring of sectors of several kinds.

    Parameters
    ----------
    ordinary : BetweenSides
    odd : mapping of int to BetweenSides
        By the number of the sector, -reach to reach.
    teeth, reach : int
        z, and R as of `OddRing`.

    Raises
    ------
    InputError
        If there are not so many sectors, or an odd one's sides are not the ordinary one's.
    FegearError
        If the stiffness is not positive definite.
    """
    if 2 * reach + 1 > teeth or any(abs(k) > reach for k in odd):
        raise InputError(
            "reach", reach, f"must be at least {max(map(abs, odd), default=0)} and at most {(teeth - 1) // 2}"
        )
    m, sides = ordinary.follow_a.shape[1], 2 * reach + 2
    if any(part.follow_a.shape[1] != m for part in odd.values()):
        raise InputError("mesh", "side_a", "of an odd sector has other nodes than the ordinary sector's")
    chains: list[tuple[Array | None, int, int]] = [
        (odd.get(k, ordinary).held, k + reach, k + reach + 1) for k in range(-reach, reach + 1)
    ]
    rest = teeth - 2 * reach - 1
    if rest:
        chains.append((chain_of(ordinary.held, rest), sides - 1, 0))
        whole = closed_stiffness(chains, sides, m)
        motion = _inverse(whole.reshape(sides * m, -1))
    else:  # side R + 1 is side -R
        chains[-1] = (chains[-1][0], sides - 2, 0)
        n = (sides - 1) * m
        once = _inverse(closed_stiffness(chains, sides - 1, m).reshape(n, -1))
        twice = np.r_[np.arange(n), np.arange(m)]
        motion = once[np.ix_(twice, twice)]
    return OddRing(reach, motion.reshape(sides, m, sides, m))


def _inverse(stiffness: Array) -> Array:
    """Inverse of a symmetric positive definite matrix."""
    from scipy.linalg import lapack

    lower = np.tril(lapack.dpotri(factored(stiffness), lower=1)[0])
    return np.asarray(lower + np.tril(lower, -1).T)
