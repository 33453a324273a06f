"""What draws tell: percentiles with their sampling error, and which deviation moves a result most."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown

#: Confidence of the intervals of percentiles.
CONFIDENCE = 0.95
#: Draws to a class of equal numbers, from whose means the share of one deviation follows, and most classes.
_LEAST_IN_CLASS, _MOST_CLASSES = 20, 20
#: Sets of draws resampled with repetition, by which a difference of percentiles is judged.
_RESAMPLED = 400


@dataclass(frozen=True)
class Percentile:
    """A percentile of draws and the order statistics that enclose the population's with 95 % confidence.

    Parameters
    ----------
    percent, value, low, high : float
        The ends are infinite where the draws are too few to tell.
    """

    percent: float
    value: float
    low: float
    high: float


def percentile(values: Array, percent: float) -> Percentile:
    """Percentile of independent draws.

    The value interpolates between order statistics (Hyndman and Fan, definition 8, nearly unbiased for its median);
    how many draws fall below the population's percentile is binomial, whatever the distribution, so its quantiles
    number the order statistics of the interval (David and Nagaraja, Order Statistics, 7.1). Quasi-random draws
    scatter less.

    Parameters
    ----------
    values : ndarray, shape (D,)
        NaN for draws without a result, which do not count.
    percent : float
        0 to 100.
    """
    from scipy.stats import binom

    ordered = np.sort(values[np.isfinite(values)])
    count, share, tail = ordered.size, percent / 100.0, 0.5 * (1.0 - CONFIDENCE)
    if count == 0:
        return Percentile(percent, np.nan, -np.inf, np.inf)
    # [x_(r), x_(s)] holds the percentile with the probability that r <= draws below it < s (numbers from 1).
    first, last = int(binom.ppf(tail, count, share)), int(binom.ppf(1.0 - tail, count, share)) + 1
    low = ordered[first - 1] if first >= 1 else -np.inf
    high = ordered[last - 1] if last <= count else np.inf
    value = float(np.quantile(ordered, share, method="median_unbiased"))
    return Percentile(percent, value, float(low), float(high))


def sure_of_less(values: Array, others: Array, percent: float) -> tuple[float, float, float]:
    """Percentiles of two results of the same draws, and the share of resampled draws in which the first is less.

    Parameters
    ----------
    values, others : ndarray, shape (D,)
        NaN where a draw has no result.
    percent : float
    """
    both = np.isfinite(values) & np.isfinite(others)
    pair, share = np.stack([values[both], others[both]]), percent / 100.0
    here, there = np.quantile(pair, share, axis=1, method="median_unbiased")
    generator = np.random.default_rng(0)
    less = 0
    for _ in range(_RESAMPLED):
        again = pair[:, generator.integers(0, pair.shape[1], pair.shape[1])]
        one, other = np.quantile(again, share, axis=1, method="median_unbiased")
        less += bool(one < other)
    return float(here), float(there), less / _RESAMPLED


@dataclass(frozen=True)
class Influence:
    """How one deviation goes with one result.

    The rank correlation is Spearman's, -1 to 1: zero for what acts alike to both sides. The share of the result's
    variance is what is left between the means of classes of the deviation (correlation ratio eta^2, less what chance
    leaves): the first-order effect of the deviation alone, to either side. Without bias, so that chance takes it below
    zero as often as above for a deviation that changes nothing. Its standard error is NaN where draws are too few.
    """

    rank_correlation: float = shown("", "rank correlation")
    share: float = shown("", "share of the variance by this deviation only; values around zero: none")
    error: float = shown("", "standard error of the share")

    @property
    def resolved(self) -> bool:
        """Whether the share is twice its error at least."""
        return self.share > 2.0 * self.error


def influences(deviations: Sequence[Array], values: Array) -> tuple[Influence, ...]:
    """How every deviation, shape (D,) each, goes with a result, shape (D,); zero for those that do not vary."""
    known = np.isfinite(values)
    return tuple(_influence(deviation[known], values[known]) for deviation in deviations)


def together(found: Sequence[Influence]) -> tuple[float, float]:
    """Share of the variance that no deviation explains alone, which is that of their interactions, and its error."""
    share, error = np.array([(one.share, one.error) for one in found]).T
    return float(1.0 - share.sum()), float(np.sqrt((error**2).sum()))


def _influence(deviation: Array, values: Array) -> Influence:
    if values.size < 3 or np.ptp(deviation) == 0.0 or np.ptp(values) == 0.0:
        return Influence(0.0, 0.0, 0.0)
    a, b = (_ranks(v) - 0.5 * (v.size - 1) for v in (deviation, values))
    rank = float((a * b).sum() / np.sqrt((a * a).sum() * (b * b).sum()))
    classes = min(_MOST_CLASSES, values.size // _LEAST_IN_CLASS)
    if classes < 2:
        return Influence(rank, np.nan, np.nan)
    groups = np.array_split(values[np.argsort(deviation, kind="stable")], classes)
    between = sum(group.size * (group.mean() - values.mean()) ** 2 for group in groups)
    whole = float(((values - values.mean()) ** 2).sum())
    # Classes of independent numbers have means that differ by chance: epsilon^2 of Kelley takes that away.
    chance = (classes - 1) * (whole - between) / (values.size - classes)
    share = float((between - chance) / whole)
    return Influence(rank, share, _share_error(share, classes, values.size))


def _share_error(share: float, classes: int, count: int) -> float:
    """Standard error of epsilon^2: of class means that differ by chance, and of a squared correlation in large samples.

    The former is 2 (k - 1) / n^2 for k classes of n numbers, the latter 4 s (1 - s)^2 / n for the share s.
    """
    some = float(np.clip(share, 0.0, 1.0))
    return (1.0 - some) * math.sqrt(2.0 * (classes - 1) / count**2 + 4.0 * some / count)


def _ranks(values: Array) -> Array:
    """Ranks from 0, ties sharing their mean."""
    _, place, count = np.unique(values, return_inverse=True, return_counts=True)
    return np.asarray((np.cumsum(count) - 0.5 * (count + 1))[place])
