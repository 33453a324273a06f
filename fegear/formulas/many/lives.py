"""S-N lines of arrays of pairs: permissible stress over load cycles, straight between knots, both axes in logarithms.

The twin of `fegear.formulas.iso6336.life.Knots`: the cycles of the knots are those of the material, the same for all
pairs; the values are arrays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array

#: Halvings of the interval of a safety: to round-off.
_HALVINGS = 60


@dataclass(frozen=True, slots=True)
class ManyKnots:
    """Lines of many pairs.

    Parameters
    ----------
    cycles : tuple of float
        Of the knots, rising.
    values : tuple of ndarray, shape (N,)
        Permissible stress at each knot.
    """

    cycles: tuple[float, ...]
    values: tuple[Array, ...]

    @property
    def falling(self) -> ManyKnots:
        """The same, no value above an earlier one."""
        found = [self.values[0]]
        for value in self.values[1:]:
            found.append(np.minimum(found[-1], value))
        return ManyKnots(self.cycles, tuple(found))

    def at(self, cycles: Array) -> Array:
        """Values at numbers of load cycles, shape (N,)."""
        found = np.broadcast_to(self.values[-1], np.broadcast_shapes(np.shape(self.values[-1]), cycles.shape))
        spans = list(zip(pairwise(self.cycles), pairwise(self.values), strict=True))
        for (n_0, n_1), (y_0, y_1) in reversed(spans):
            inside = cycles <= n_1
            if not inside.any():
                continue
            part = np.maximum(np.log(cycles / n_0) / math.log(n_1 / n_0), 0.0)
            found = np.where(inside, y_0 * (y_1 / y_0) ** part, found)
        return np.where(cycles <= self.cycles[0], self.values[0], found)

    def cycles_to_failure(self, stress: Array) -> Array:
        """N of stresses on the line: 0 above its static value, inf at and below its last one."""
        found = np.zeros(stress.shape)
        inside = stress <= self.values[0]
        for (n_0, n_1), (s_0, s_1) in zip(pairwise(self.cycles), pairwise(self.values), strict=True):
            here = inside & (stress > s_1)
            if here.any():
                with np.errstate(divide="ignore", invalid="ignore"):
                    part = np.log(stress / s_0) / np.log(s_1 / s_0)
                    found = np.where(here, n_0 * (n_1 / n_0) ** part, found)
            inside = inside & ~here
        return np.where(stress <= self.values[-1], np.inf, found)


@dataclass(frozen=True, slots=True)
class ManyBins:
    """One level of a spectrum: stress [Pa] and load cycles of many pairs, and the line of its speed."""

    stress: Array
    cycles: Array
    line: ManyKnots

    def damage(self, safety: Array | float = 1.0) -> Array:
        """n_i / N_i of the stress times a safety; inf where it is not borne at all."""
        bearable = self.line.cycles_to_failure(self.stress * safety)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where((self.cycles == 0.0) | (self.stress == 0.0), 0.0, self.cycles / bearable)


def damages(bins: Sequence[ManyBins], safety: Array | float = 1.0) -> Array:
    """Miner sums of a spectrum whose stresses are raised by a safety."""
    return np.asarray(sum((one.damage(safety) for one in bins[1:]), bins[0].damage(safety)))


def spectrum_safeties(bins: Sequence[ManyBins]) -> Array:
    """Safety factors in stress: the largest by which all stresses may be raised before the Miner sum passes 1.

    Raises
    ------
    RangeError
        If no level has stress and load cycles.
    """
    loaded = [one for one in bins if (one.stress > 0.0).any() and (one.cycles > 0.0).any()]
    if not loaded:
        raise RangeError("spectrum", "(no load)", "must have a bin with a load and a share of the time")
    high = np.min([one.line.values[0] / one.stress for one in loaded], axis=0)
    low = np.min([one.line.values[-1] / one.stress for one in loaded], axis=0)
    static = damages(loaded, high) <= 1.0
    low = np.where(static, high, low)
    for _ in range(_HALVINGS):
        middle = np.sqrt(low * high)
        good = damages(loaded, middle) <= 1.0
        low, high = np.where(good, middle, low), np.where(good, high, middle)
    return np.asarray(low)
