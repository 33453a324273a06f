"""Gaps that bent and tilted shafts open between the flanks of a pair, under each of several loads."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays


@dataclass(frozen=True)
class ShaftGaps(ReadOnlyArrays):
    """Gaps over the face, straight between heights and between loads, in proportion below and above all loads.

    Parameters
    ----------
    load : ndarray, shape (L,)
        Along the transverse line of action, ascending [N]; empty for parallel shafts.
    height : ndarray, shape (n,)
        From the middle of the common face [m].
    gap : ndarray, shape (L, 2, n)
        Along the transverse line of action at x = 0 [m], and its slope over x.
    """

    load: Array = field(default_factory=lambda: np.empty(0))
    height: Array = field(default_factory=lambda: np.empty(0))
    gap: Array = field(default_factory=lambda: np.empty((0, 2, 0)))

    @property
    def given(self) -> bool:
        """Whether there are any."""
        return bool(self.gap.any())

    def under(self, load: float) -> ShaftGaps:
        """The same as it is under one load [N], at which it stays."""
        return ShaftGaps(np.array([load]), self.height, self._at_load(load)[None]) if self.given else self

    def at(self, x: Array, z: Array, load: ArrayLike | None = None) -> Array:
        """Gaps at places of the plane of action [m].

        Parameters
        ----------
        x, z : ndarray
            From the pitch point along the line of action, from the middle of the common face [m].
        load : array_like, optional
            [N]; may be left out where the gaps are known under one load, at which they stay.

        Returns
        -------
        ndarray, of the shape of `x` and that of `load`
        """
        if load is None:
            return self._over(x, z, self.gap[-1])
        loads = np.asarray(load, dtype=float)
        found = [self._over(x, z, self._at_load(one)) for one in loads.ravel().tolist()]
        return np.stack(found, axis=-1).reshape(*x.shape, *loads.shape)

    def _over(self, x: Array, z: Array, gap: Array) -> Array:
        return np.asarray(np.interp(z, self.height, gap[0]) + x * np.interp(z, self.height, gap[1]))

    def _at_load(self, load: float) -> Array:
        """Shape (2, n)."""
        known = self.load
        if known.size == 1 or not known[0] < load < known[-1]:
            i = 0 if load <= known[0] else -1
            return np.asarray(self.gap[i] * (load / known[i]))
        i = int(np.searchsorted(known, load))
        share = (load - known[i - 1]) / (known[i] - known[i - 1])
        return np.asarray((1.0 - share) * self.gap[i - 1] + share * self.gap[i])


#: Shafts that stay parallel.
RIGID = ShaftGaps()
