"""A ring some of whose sectors differ from the others.

Sectors -R..R stand for themselves, the z - 2 R - 1 others are one chain (`chain_of`), and what is left is the stiffness
between the 2 R + 2 sides of the former. With H its inverse and A, B, G those of each sector's own kind (`BetweenSides`)

    u_i = A_i (H_ij A_j' + H_i,j+1 B_j') f + B_i (H_i+1,j A_j' + H_i+1,j+1 B_j') f + (i = j) G_i f.

An odd sector needs the ordinary one's nodes on its sides, nothing else; any pattern of them fits, and nothing is found
as a difference of two rings. Without one this is the ordinary ring to round-off.

Where the bore is free below some teeth and held below the others (`Held`), sides between two free sectors have all
their unknowns, and those of a held one only what its bore leaves.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from fegear.base.arrays import Array, Mask
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
    patch : int
        h of sectors -h..h that are one: their sides are its ends; -1 without.
    """

    reach: int
    motion: Array
    patch: int = -1

    def between(self, watched: int, loaded: int) -> Array:
        """Motion of the sides A and B of one sector under forces on those of another, shape (2 m, 2 m)."""
        m = self.motion.shape[1]
        i, j = self._sides(watched), self._sides(loaded)
        return np.asarray(self.motion[i, :, j].reshape(2 * m, 2 * m))

    def _sides(self, sector: int) -> slice:
        """Sides A and B of a sector, or of the patch that it is in."""
        if abs(sector) <= self.patch:
            low, high = self.reach - self.patch, self.reach + self.patch + 1
            return slice(low, high + 1, high - low)
        return slice(sector + self.reach, sector + self.reach + 2)


@dataclass(frozen=True)
class Held:
    """Ordinary sectors whose bore is held, in a ring whose other sectors' bores are free.

    Parameters
    ----------
    half : int
        Sectors -half..half are free, all others held.
    free : ndarray of bool, shape (m,)
        Unknowns of a free sector's side that are not on the bore.
    part : BetweenSides
        With the unknowns of a free sector's sides, those on the bore unmoved.
    """

    half: int
    free: Mask
    part: BetweenSides

    def of(self, k: int) -> bool:
        """Whether a sector's bore is held."""
        return abs(k) > self.half

    def chain(self, count: int) -> Array | None:
        """A row of them as one, shape (2 m, 2 m)."""
        twice = np.flatnonzero(np.tile(self.free, 2))
        found = np.zeros_like(self.part.held)
        found[np.ix_(twice, twice)] = chain_of(self.part.held[np.ix_(twice, twice)], count)
        return found


def held_sectors(half: int, bore: Mask, part: BetweenSides) -> Held:
    """Held sectors in terms of the sides of free ones.

    Parameters
    ----------
    half : int
        As of `Held`.
    bore : ndarray of bool, shape (m,)
        Which unknowns of a free sector's side are on the bore.
    part : BetweenSides
        Of a held one.
    """
    free, twice = ~bore, np.flatnonzero(np.tile(~bore, 2))
    held = np.zeros((2 * bore.size, 2 * bore.size))
    held[np.ix_(twice, twice)] = part.held
    follow_a, follow_b = (np.zeros((one.shape[0], bore.size)) for one in (part.follow_a, part.follow_b))
    follow_a[:, free], follow_b[:, free] = part.follow_a, part.follow_b
    return Held(half, free, replace(part, follow_a=follow_a, follow_b=follow_b, held=held))


def odd_ring(
    ordinary: Array, odd: Mapping[int, BetweenSides], teeth: int, reach: int, held: Held | None = None
) -> OddRing:
    """Close a ring of sectors of several kinds.

    Parameters
    ----------
    ordinary : ndarray, shape (2 m, 2 m)
        Stiffness of an ordinary sector between its sides.
    odd : mapping of int to BetweenSides
        By the number of the sector, -reach to reach.
    teeth, reach : int
        z, and R as of `OddRing`.
    held : Held, optional
        Which sectors of a ring whose ordinary ones' bores are free are held.

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
    m, sides = ordinary.shape[0] // 2, 2 * reach + 2
    if any(part.follow_a.shape[1] != m for part in odd.values()):
        raise InputError("mesh", "side_a", "of an odd sector has other nodes than the ordinary sector's")

    def between(k: int) -> Array:
        if k in odd:
            return odd[k].held
        return ordinary if held is None or not held.of(k) else held.part.held

    chains: list[tuple[Array | None, int, int]] = [
        (between(k), k + reach, k + reach + 1) for k in range(-reach, reach + 1)
    ]
    fixed = {side for k in range(-reach, reach + 1) if held and held.of(k) for side in (k + reach, k + reach + 1)}
    others = [k if 2 * k < teeth else k - teeth for k in range(reach + 1, teeth - reach)]
    if not others:  # side R + 1 is side -R
        chains[-1] = (chains[-1][0], sides - 2, 0)
        fixed = {side % (sides - 1) for side in fixed}
    runs = [(kind, len(list(run))) for kind, run in groupby(others, lambda k: held is not None and held.of(k))]
    first, count = sides - 1, sides if others else sides - 1
    for n, (kind, members) in enumerate(runs):
        last = 0 if n == len(runs) - 1 else count
        row = held.chain(members) if held is not None and kind else chain_of(ordinary, members)
        chains.append((row, first, last))
        if kind:
            fixed |= {first, last}
        first, count = last, max(count, last + 1)
    motion = _motion(closed_stiffness(chains, count, m), fixed, held)
    twice = np.arange(sides * m) if others else np.r_[np.arange((sides - 1) * m), np.arange(m)]
    return OddRing(reach, motion[np.ix_(twice, twice)].reshape(sides, m, sides, m))


def patched_ring(ordinary: Array, patch: Array, half: int, teeth: int, reach: int) -> OddRing:
    """Close a ring whose sectors -half..half are one; stiffness between the sides of either, (2 m, 2 m) each.

    Raises
    ------
    InputError
        If the ends of the patch are not the ordinary sector's sides, or there are not so many sectors.
    FegearError
        If the stiffness is not positive definite.
    """
    m = ordinary.shape[0] // 2
    if patch.shape != ordinary.shape:
        raise InputError("mesh", "side_a", "of an odd sector has other nodes than the ordinary sector's")
    if not half <= reach <= (teeth - 2) // 2:
        raise InputError("reach", reach, f"must be at least {half} and at most {(teeth - 2) // 2}")
    sides = [side for side in range(-reach, reach + 2) if not -half < side <= half]
    place = {side: n for n, side in enumerate(sides)}
    chains: list[tuple[Array | None, int, int]] = [
        (ordinary, place[k], place[k + 1]) for k in range(-reach, reach + 1) if abs(k) > half
    ]
    chains.append((patch, place[-half], place[half + 1]))
    chains.append((chain_of(ordinary, teeth - 2 * reach - 1), place[reach + 1], 0))
    count = len(sides)
    found = _inverse(closed_stiffness(chains, count, m).reshape(count * m, -1)).reshape(count, m, count, m)
    motion, known = np.zeros((2 * reach + 2, m, 2 * reach + 2, m)), np.array(sides) + reach
    motion[np.ix_(known, np.arange(m), known, np.arange(m))] = found
    return OddRing(reach, motion, half)


def _motion(whole: Array, fixed: set[int], held: Held | None) -> Array:
    """Motions of all sides under forces on them; bores of the sides `fixed` do not move."""
    sides, m = whole.shape[:2]
    square = whole.reshape(sides * m, -1)
    if held is None:
        return _inverse(square)
    moves = np.ones((sides, m), dtype=bool)
    moves[sorted(fixed)] = held.free
    at = np.flatnonzero(moves)
    found = np.zeros_like(square)
    found[np.ix_(at, at)] = _inverse(square[np.ix_(at, at)])
    return found


def _inverse(stiffness: Array) -> Array:
    """Inverse of a symmetric positive definite matrix."""
    from scipy.linalg import lapack

    lower = np.tril(lapack.dpotri(factored(stiffness), lower=1)[0])
    return np.asarray(lower + np.tril(lower, -1).T)
