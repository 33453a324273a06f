"""Where a formula is near the finite elements: the widest range in which it is, and a sentence that says so.

The range is looked for on one half of the gears and what it promises is counted on the other half, so that a range
that fits by chance does not pass for a finding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.printed import percent

#: A formula is near where it is within this of the finite elements, and so many of the points there have to be.
NEAR, SURE = 0.10, 0.95
#: Conditions in a sentence at most, and points in a range at least.
_MOST, _FEWEST = 3, 24
#: Ends at which ranges may begin or stop, as quantiles of the population.
_ENDS = (0.15, 0.3, 0.45, 0.6, 0.75)


@dataclass(frozen=True, slots=True)
class Condition:
    """``name >= at`` or ``name <= at``."""

    name: str
    at: float
    above: bool


@dataclass(frozen=True, slots=True)
class Reach:
    """How far a formula is from the finite elements over a population.

    Parameters
    ----------
    formula : str
    low, median, high : float
        5th, 50th and 95th percentile of formula over finite elements; NaN where it answers nowhere.
    rated : (float, float, float)
        The same of loads where ratings put them.
    near : float
        Share of all points within `NEAR`.
    silent : float
        Share of all points at which it gives nothing.
    range : tuple of Condition or None
        The widest range in which it is near; empty for everywhere, None where there is none worth naming.
    held, held_points : float, int
        Share of the points in the range that are near, on the half of the gears on which it was not looked for.
    part : float
        Share of the population in the range.
    """

    formula: str
    low: float
    median: float
    high: float
    rated: tuple[float, float, float]
    near: float
    silent: float
    range: tuple[Condition, ...] | None
    held: float
    held_points: int
    part: float


def reach(formula: str, ratio: Array, columns: Mapping[str, Array], gear: Array, rated: NDArray[np.bool_]) -> Reach:
    """Look for the widest range in which a formula is near.

    Parameters
    ----------
    formula : str
    ratio : ndarray, shape (N,)
        Formula over finite elements; NaN where it gives nothing.
    columns : mapping of str to ndarray, shape (N,)
        What the range may speak of.
    gear : ndarray of int, shape (N,)
        Which gear each point is of: the ranges are looked for on even ones and compared with odd ones.
    rated : ndarray of bool, shape (N,)
        Points whose load is where ratings put it.
    """
    ok = np.isfinite(ratio)
    near = ok & (np.abs(np.where(ok, ratio, 0.0) - 1.0) <= NEAR)
    low, median, high = _percentiles(ratio)
    looked = gear % 2 == 0
    best = _widest(near, looked, columns)
    held, held_points, part = math.nan, 0, 0.0
    if best is not None:
        inside = _inside(best, columns, ratio.size)
        other = inside & ~looked
        held_points, part = int(other.sum()), float(inside.mean())
        held = float(near[other].mean()) if held_points else math.nan
    share, silent = float(near.mean()), float(1.0 - ok.mean())
    return Reach(formula, low, median, high, _percentiles(ratio[rated]), share, silent, best, held, held_points, part)


def _percentiles(ratio: Array) -> tuple[float, float, float]:
    known = ratio[np.isfinite(ratio)]
    if not known.size:
        return math.nan, math.nan, math.nan
    low, median, high = (float(q) for q in np.quantile(known, [0.05, 0.5, 0.95]))
    return low, median, high


def _inside(conditions: Sequence[Condition], columns: Mapping[str, Array], size: int) -> NDArray[np.bool_]:
    inside = np.ones(size, dtype=bool)
    for c in conditions:
        inside &= columns[c.name] >= c.at if c.above else columns[c.name] <= c.at
    return inside


def _widest(
    near: NDArray[np.bool_], looked: NDArray[np.bool_], columns: Mapping[str, Array]
) -> tuple[Condition, ...] | None:
    """The range of most points, of up to three conditions, in which enough points that were looked at are near."""
    conditions = [
        Condition(name, _round(float(np.quantile(values, q))), above)
        for name, values in columns.items()
        if np.ptp(values) > 0.0
        for q in _ENDS
        for above in (True, False)
    ]
    conditions = list(dict.fromkeys(conditions))
    masks = [_inside((c,), columns, near.size)[looked] for c in conditions]
    hit = near[looked]
    best: tuple[int, ...] | None = None
    most = _FEWEST - 1
    for count in range(_MOST + 1):
        for chosen in combinations(range(len(conditions)), count):
            if len({(conditions[i].name, conditions[i].above) for i in chosen}) < count:
                continue
            inside = np.logical_and.reduce([masks[i] for i in chosen]) if chosen else np.ones(hit.size, dtype=bool)
            points = int(np.count_nonzero(inside))
            if points > most and np.count_nonzero(inside & hit) >= SURE * points:
                best, most = chosen, points
    return None if best is None else tuple(conditions[i] for i in best)


def _round(value: float) -> float:
    """Two digits: what a sentence can say."""
    return float(f"{value:.2g}")


def sentence(found: Reach, words: Mapping[str, tuple[str, str]], rated: str = "loads on the upper half") -> str:
    """What a designer reads.

    Parameters
    ----------
    found : Reach
    words : mapping of str to (str, str)
        Word and unit by which each column is called.
    rated : str
        What loads the percentiles `Reach.rated` are of.
    """
    if not np.isfinite(found.median):
        return f"{found.formula} gives no value for any gear of this population."
    silent = f"; no value at {percent(found.silent, whole=True)} of the points" if found.silent >= 0.005 else ""
    over = f"{_ends(found.low, found.median, found.high)} over all loads{silent}"
    if np.isfinite(found.rated[1]):
        over = f"{_ends(*found.rated)} under {rated}, {over}"
    whole = f"90 % of its values are {over}"
    if found.range is None:
        text = f"{found.formula}: no parameter range found in which it is within {100.0 * NEAR:g} % of FE; {whole}."
    else:
        where = " and ".join(_condition(c, words) for c in found.range)
        text = (
            f"{found.formula} is within {100.0 * NEAR:g} % of FE {'for ' + where if where else 'everywhere'}, "
            f"{percent(found.part, whole=True)} of the population (confirmed for {percent(found.held, whole=True)} "
            f"of {found.held_points} points on other gears); {whole}."
        )
    return text


def _ends(low: float, median: float, high: float) -> str:
    return f"{off(low)} to {off(high)} (median {off(median)})"


def _condition(c: Condition, words: Mapping[str, tuple[str, str]]) -> str:
    word, unit = words[c.name]
    return f"{word} {'>=' if c.above else '<='} {c.at:g}{' ' if unit not in ('', '°') else ''}{unit}"


def off(ratio: float) -> str:
    """How far off a ratio is, in words: "3 % low", "right"."""
    miss = ratio - 1.0
    return "right" if abs(miss) < 0.005 else f"{percent(abs(miss), whole=True)} {'high' if miss > 0.0 else 'low'}"
