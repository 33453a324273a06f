"""Which configurations nothing beats in both time and error, and the cheapest for a tolerance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def pareto_front(seconds: ArrayLike, error: ArrayLike) -> NDArray[np.intp]:
    """Indices of the configurations that no other configuration beats, from quick and rough to slow and accurate.

    Parameters
    ----------
    seconds, error : array_like, shape (n,)
        NaN where a configuration has no answer; such configurations are never on the front.

    Returns
    -------
    ndarray of int
        Errors fall strictly along it, seconds rise strictly.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    front: list[int] = []
    best = np.inf
    for i in np.lexsort((e, t)):
        if np.isfinite(t[i]) and e[i] < best:
            front.append(int(i))
            best = e[i]
    return np.array(front, dtype=np.intp)


def cheapest(tolerance: float, seconds: ArrayLike, error: ArrayLike) -> int | None:
    """Index of the cheapest configuration whose error is within a tolerance, of equally cheap ones the best; or None.

    Parameters
    ----------
    tolerance : float
    seconds, error : array_like, shape (n,)
        NaN where a configuration has no answer.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    good = np.flatnonzero(np.isfinite(t) & (e <= tolerance))
    return int(good[np.lexsort((e[good], t[good]))[0]]) if good.size else None
