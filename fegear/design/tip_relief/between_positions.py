"""Places between roll positions: load sharing there, and where pairs part or touch or a relief starts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Floats, Index, Mask


@dataclass(frozen=True)
class Places:
    """K places of candidates under loads.

    Parameters
    ----------
    x : ndarray, shape (K,)
        [m].
    where : ndarray of int, shape (3, K)
        Candidate, position before, and load.
    on : ndarray of bool, shape (n, K)
        Pairs that bear.
    loads : ndarray, shape (n, K)
        Theirs, nearly at first [N].
    """

    x: Floats
    where: Index
    on: Mask
    loads: Floats


@dataclass(frozen=True)
class State:
    """Load sharing at K places.

    Parameters
    ----------
    loads, weight : ndarray, shape (n, K)
        [N], and derivatives of the transmission error by removals.
    error, rise : ndarray, shape (K,)
        Transmission error [m] and its slope over the roll position.
    rises : ndarray, shape (n, K)
        Slopes of each pair's approach at these loads.
    by_number : ndarray, shape (4, n, K)
        Derivatives of the removals by the numbers of a candidate.
    off, off_rise : ndarray, shape (n, K)
        How far every pair is from bearing [m], and its slope.
    depth_rise : ndarray, shape (2, n, K)
        Slopes of depths.
    tangent : ndarray, shape (n, n, K)
        Of all pairs at these loads.
    """

    loads: Floats
    weight: Floats
    error: Floats
    rise: Floats
    rises: Floats
    by_number: Floats
    off: Floats
    off_rise: Floats
    depth_rise: Floats
    tangent: Floats

    def slope(self, weight: Floats | None = None) -> Floats:
        """Derivatives of the error by the numbers at a place that stays, shape (K, 4)."""
        return np.einsum("jk,qjk->kq", self.weight if weight is None else weight, self.by_number)


@dataclass(frozen=True)
class Bends:
    """K places at which the slope of the transmission error over the roll position jumps.

    Parameters
    ----------
    x, jump : ndarray, shape (K,)
        Place [m] and jump.
    where : ndarray of int, shape (3, K)
        Candidate, position before, and load.
    moved, grown : ndarray, shape (K, 4)
        Derivatives of place and jump by the numbers of a candidate; pairs that part or touch are taken to keep theirs.
    """

    x: Floats
    jump: Floats
    where: Index
    moved: Floats
    grown: Floats


@dataclass(frozen=True)
class HandOver:
    """K places where a pair parts or touches.

    Parameters
    ----------
    at : Places
    found : State
        Load sharing without that pair.
    pair : ndarray of int, shape (K,)
    leaves : ndarray of bool, shape (K,)
        Whether it parts, in rolling on.
    weight : ndarray, shape (n, K)
        Derivatives of the transmission error by removals, that pair bearing.
    """

    at: Places
    found: State
    pair: Index
    leaves: Mask
    weight: Floats

    @cached_property
    def together(self) -> Floats:
        """Slope of the transmission error with that pair, shape (K,); without it, see `found`."""
        return np.asarray((self.weight * self.found.rises).sum(axis=0))

    @cached_property
    def met(self) -> Mask:
        """Where the place was found."""
        return np.asarray(np.abs(self.found.off[self.pair, np.arange(self.pair.size)]) < 1e-6 * self.found.error)

    def peaks(self) -> tuple[Mask, Floats]:
        """Which are peaks, and the weights with which these change as if they stayed."""
        together, apart = self.together, self.found.rise
        peak = np.where(self.leaves, (together > 0.0) & (apart < 0.0), (apart > 0.0) & (together < 0.0)) & self.met
        part = np.where(peak, -together / np.where(peak, apart - together, 1.0), 1.0)
        return peak, part * self.found.weight + (1.0 - part) * self.weight

    def bends(self) -> Bends:
        """What the slope does there."""
        found, k = self.found, np.arange(self.pair.size)
        y, *by = solved(found.tangent, self.at.on, np.ones_like(found.loads), *found.by_number)
        loads = found.slope().T[:, None] * y - np.array(by)
        off = np.einsum("jk,qjk->kq", np.where(self.at.on, found.tangent[self.pair, :, k].T, 0.0), loads)
        off += found.by_number[:, self.pair, k].T - found.slope()
        rise = found.off_rise[self.pair, k]
        moved = -off / np.where(rise == 0.0, 1.0, rise)[:, None]
        jump = np.where(self.leaves, 1.0, -1.0) * (found.rise - self.together)
        return Bends(self.at.x, np.where(self.met, jump, 0.0), self.at.where, moved, np.zeros_like(moved))


def solved(tangent: Floats, on: Mask, *right: Floats) -> Floats:
    """Solutions for several right sides, shape (S, n, K), of the pairs that bear."""
    system = np.where(on[:, None] & on, tangent, np.eye(on.shape[0])[:, :, None])
    sides = np.where(on, np.array(right), 0.0)
    return np.moveaxis(
        np.linalg.solve(np.moveaxis(system, 2, 0), np.moveaxis(sides, 2, 0).swapaxes(1, 2)), (0, 2), (2, 0)
    )
