"""Where curves over a base pitch are largest, found closer than the samples that they were looked at."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fegear.base.arrays import Array, first_of_largest

#: Each pass puts so many points on either side of a maximum's largest sample, and narrows its bracket as much and once.
_POINTS = 4

#: Five passes leave 3e-4 of the distance of two samples: at a kink, where a tip corner takes over from a tooth pair,
#: the error of a peak is in proportion to what is left.
PASSES = 5

#: What they leave of that distance.
LEFT = (_POINTS + 1.0) ** -PASSES


#: A local maximum of the samples may lead to the largest value of a stress where it lacks no more than this part of it.
LACKS = 0.05

#: Local maxima of one curve that are followed.
_FOLLOWED = 4


def refined_peaks(
    curves: Callable[[Array], Array],
    x: Array,
    lacks: float = LACKS,
    followed: int = _FOLLOWED,
    passes: int = PASSES,
) -> tuple[Array, Array]:
    """Follow the largest value of each curve between the samples, through smooth maxima, kinks and up to jumps.

    A tooth's stress peaks where another pair begins to bear, at a kink that moves with the load and with every effect:
    samples that are a hundredth of the base pitch apart miss it by up to a percent, and the difference of two such
    maxima is then the samples' and not the effect's.

    Parameters
    ----------
    curves : callable
        Positions, shape (P,), to the values of all curves, shape (C, P).
    x : ndarray, shape (P,)
        Samples, ascending, with both sides of every jump among them.
    lacks : float
        Part of the largest sample by which others may be lower whose neighbourhood is looked at.
    followed : int
        Local maxima of one curve that are followed at most, the highest samples first.
    passes : int
        Each leaves a fifth of the distance between two samples.

    Returns
    -------
    at, largest : ndarray, shape (C,)
        Where each curve is largest, first of several places where it is, and its value there.
    """
    sampled = curves(x)
    peak = sampled.max(axis=1)
    padded = np.pad(sampled, ((0, 0), (1, 1)), constant_values=-np.inf)
    local = (
        (sampled >= padded[:, :-2]) & (sampled >= padded[:, 2:]) & (sampled >= (peak - lacks * np.abs(peak))[:, None])
    )
    starts: list[tuple[int, int]] = []
    for c, row in enumerate(local):
        several = np.flatnonzero(row)
        starts += [(c, i) for i in several[np.argsort(-sampled[c, several], kind="stable")[:followed]]]
    curve, middle = np.array(starts).T
    low, at, high = x[np.maximum(middle - 1, 0)], x[middle], x[np.minimum(middle + 1, x.size - 1)]
    value, every = sampled[curve, middle], np.arange(curve.size)
    inside = np.arange(1, _POINTS + 1)[:, None] / (_POINTS + 1)
    for _ in range(passes):
        places = np.concatenate([low[None], low + inside * (at - low), at[None], at + inside * (high - at), high[None]])
        new = np.concatenate([places[1 : _POINTS + 1], places[_POINTS + 2 : -1]])
        found = curves(new.ravel())[np.tile(curve, new.shape[0]), np.arange(new.size)].reshape(new.shape)
        ends = np.full((1, curve.size), -np.inf)
        values = np.concatenate([ends, found[:_POINTS], value[None], found[_POINTS:], ends])
        best = values.argmax(axis=0)
        low, at, high, value = (
            places[best - 1, every],
            places[best, every],
            places[best + 1, every],
            values[best, every],
        )
    # Of peaks of one height, as symmetric curves have them, the first: the last bit decides nothing.
    order = np.lexsort((at, curve))
    parts = np.split(order, np.flatnonzero(np.diff(curve[order])) + 1)
    first = [part[first_of_largest(value[part])] for part in parts]
    return at[first], np.array([value[part].max() for part in parts])
