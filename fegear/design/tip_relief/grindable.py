"""The best tip relief that a shop can grind: straight or parabolic, on both gears, over a range of loads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Mask
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.fourier import effective_error
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.charts import Metric
from fegear.design.load_range import LoadRange, proportions
from fegear.design.tip_relief.relief_limits import ReliefLimits
from fegear.design.tip_relief.search import FOUND, SHARE, search
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.design.tip_relief.tolerated_search import TOLERATED, tolerated_search
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.relief import UNMODIFIED, EndRelief, Shape, roll_of_radius

#: Reliefs and what they leave are found again within this of themselves whatever the last digits of inputs are.
REPEATED = 1e-6
#: What is left below this is nothing [m].
_NOTHING = 1e-15


@dataclass(frozen=True)
class TipReliefPair:
    """Tip relief of both gears, what it leaves, and what vouches that nothing leaves less.

    Parameters
    ----------
    driver, driven : EndRelief
    loads : ndarray, shape (L,)
        [N].
    effective_error, peak_to_peak : ndarray, shape (L,)
        Left at each load [m].
    before : ndarray, shape (L,)
        The metric of the unmodified pair [m].
    objective : float
        Worst metric over the loads, each in proportion to its load and times its weight, at the largest load [m].
    least : float
        What the best of all reliefs of this shape leave [m], by the search's own roll positions. These, and all up to
        1 % above, count as equally good: of them the one with the least removal is taken, and of two such the longer.
    driver_band, driven_band : tuple of EndRelief
        From where to where equally good reliefs go: least amount and length, and largest. Like gears have the same, and
        the driver takes the deeper relief.
    error, band_error : ndarray, shapes (4,), (2, 4)
        Estimated errors of the reliefs taken and of the ends of the bands: amount [m] and roll angle of the start
        [rad] of the driver's, then of the driven gear's.
    candidates : int
        Combinations of amounts and lengths scanned.
    evaluations : int
        Load sharings over a base pitch solved exactly on the way.
    starts : int
        Places of the scan from which searches went out.
    least_error : float
        How far the least of two independent searches, from every other of these places each, are apart [m]; not below
        `objective_error`.
    objective_error : float
        How far what is left by the search's own roll positions is from `objective` [m].
    seconds : float
        Processor time of the search.
    undeviated : tuple of EndRelief or None
        What leaves the least as drawn, where these leave the least at the worst place within their tolerances.
    """

    driver: EndRelief
    driven: EndRelief
    loads: Array
    effective_error: Array
    peak_to_peak: Array
    before: Array
    objective: float
    least: float
    driver_band: tuple[EndRelief, EndRelief]
    driven_band: tuple[EndRelief, EndRelief]
    error: Array
    band_error: Array
    candidates: int
    evaluations: int
    starts: int
    least_error: float
    objective_error: float
    seconds: float
    undeviated: tuple[EndRelief, EndRelief] | None = None

    @property
    def removal_error(self) -> float:
        """By how much what both take off a pair may differ from one run to the next, and so the transmission error [m].

        Amounts and lengths are found again within `REPEATED`; a removal changes with its length by `power` times as
        much, over both.
        """
        return REPEATED * sum((1.0 + one.power) * one.amount for one in (self.driver, self.driven))

    def applied(self, engagement: Engagement) -> Engagement:
        """The pair with this relief instead of its own."""
        return replace(engagement, driver_relief=self.driver, driven_relief=self.driven)


def optimise_tip_relief(
    engagement: Engagement,
    loads: ArrayLike,
    shape: Shape = "linear",
    metric: Metric = "effective_error",
    weights: ArrayLike | None = None,
    *,
    banded: bool = True,
    limits: ReliefLimits | None = None,
    cache: SolutionCache | None = None,
) -> TipReliefPair:
    """Find amount and length of tip relief on both gears for the least excitation over a range of loads.

    All amounts up to six times the mean transmission error, or what the tooth can take, and all lengths from a fiftieth
    of the path to the whole of it are searched; see `tip_relief_search`.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced; its spacing errors do not count.
    loads : array_like, shape (L,)
        [N]; the worst of them counts, each excitation in proportion to its load.
    shape : {"linear", "parabolic"}
    metric : {"effective_error", "peak_to_peak"}
    weights : array_like, shape (L,), optional
        What each load counts, over the largest of them; one of weight zero does not count. All the same by default.
    banded : bool
        Whether to look for the band of equally good reliefs; without it bands are the reliefs, errors nan.
    limits : ReliefLimits, optional
        Of amounts and lengths; those of the teeth by default.
    cache : SolutionCache, optional
        Where searches are recalled from and kept.

    Raises
    ------
    InputError
        Without loads, or with one that is not positive; with weights that are not one for each load, or none positive.
    """
    w = np.atleast_1d(np.asarray(loads, dtype=float))
    if w.size == 0:
        raise InputError("design.loads", "[]", "must contain at least one load")
    if not (np.isfinite(w).all() and (w > 0.0).all()):
        raise InputError("design.loads", f"{w.min()} N", "must be positive and finite")
    power = 1.0 if shape == "linear" else 2.0
    weight, counts = _weights(weights, w)
    plain = _plain(engagement)
    further = () if limits is None and banded else (banded,) if limits is None else (banded, limits)
    asked = plain, w[counts], power, metric, weight, *further
    found = (cache or SolutionCache()).call_kept_if_known(FOUND, search, *asked)  # compliances may be functions
    pair = engagement.pair
    gears = pair.driver, pair.driven
    tips, *ends = (
        [relief_over_path(gear, pair.path_length, p[2 * i], p[2 * i + 1], power) for i, gear in enumerate(gears)]
        for p in (found.best, *np.where(np.isnan(found.band), found.best, found.band))
    )
    driver_band, driven_band = ((ends[0][i], ends[1][i]) for i in (0, 1))
    before = _left(plain, w)
    after = _left(replace(plain, driver_relief=tips[0], driven_relief=tips[1]), w)
    objective = float((after[metric][counts] * proportions(w[counts], weight)).max())
    # More may be left than the search saw, or less: what is allowed moves by as much; over the whole band it is SHARE.
    off = max(abs(objective - found.left), REPEATED * objective)
    per_left = np.abs(found.band - found.best).max(axis=0) / max(SHARE * found.least, _NOTHING)
    by_roll = _by_roll(pair)
    error = np.maximum(off * per_left, REPEATED * np.abs(found.best)) * by_roll
    return TipReliefPair(
        tips[0], tips[1], w, after["effective_error"], after["peak_to_peak"], before[metric], objective, found.least,
        driver_band, driven_band, error, found.band_error * by_roll, found.candidates, found.evaluations, found.starts,
        max(found.spread, off), off, found.seconds,
    )  # fmt: skip


def tolerated(
    engagement: Engagement, load: float | LoadRange, shape: Shape, tolerances: tuple[TipTolerance, TipTolerance], *,
    limits: ReliefLimits | None = None, cache: SolutionCache | None = None,
) -> TipReliefPair:  # fmt: skip
    """Find the tip reliefs whose largest peak-to-peak transmission error within their tolerances is least.

    Parameters
    ----------
    engagement, load, shape, limits, cache
        As those of `grindable`.
    tolerances : tuple of TipTolerance
        Of driver and driven gear.
    """
    over = load if isinstance(load, LoadRange) else LoadRange((load,))
    w, power, pair = np.array(over.loads), 1.0 if shape == "linear" else 2.0, engagement.pair
    weight, counts = _weights(over.weights, w)
    plain = _plain(engagement)
    asked = plain, w[counts], power, tolerances, weight, limits
    found = (cache or SolutionCache()).call_kept_if_known(TOLERATED, tolerated_search, *asked)
    tips, drawn = (
        tuple(
            relief_over_path(gear, pair.path_length, p[2 * i], p[2 * i + 1], power)
            for i, gear in enumerate((pair.driver, pair.driven))
        )
        for p in (found.best, found.undeviated)
    )
    after = _left(replace(plain, driver_relief=tips[0], driven_relief=tips[1]), w)
    objective = float((after["peak_to_peak"][counts] * proportions(w[counts], weight)).max())
    error = np.maximum(found.error, REPEATED * np.abs(found.best)) * _by_roll(pair)
    off = max(found.spread, REPEATED * objective)
    return TipReliefPair(
        tips[0], tips[1], w, after["effective_error"], after["peak_to_peak"], _left(plain, w)["peak_to_peak"],
        objective, objective, (tips[0], tips[0]), (tips[1], tips[1]), error, np.stack([error, error]),
        found.candidates, found.evaluations, found.starts, off, off, found.seconds, (drawn[0], drawn[1]),
    )  # fmt: skip


def _plain(engagement: Engagement) -> Engagement:
    """The pair without reliefs and spacing errors."""
    return replace(
        engagement, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED,
        driver_spacing=np.empty(0), driven_spacing=np.empty(0),
    )  # fmt: skip


def _by_roll(pair: GearPair) -> Array:
    """What errors of the four numbers are of amounts [m] and roll angles [rad]."""
    return np.array([v for gear in (pair.driver, pair.driven) for v in (1.0, pair.path_length / gear.base_radius)])


def _weights(weights: ArrayLike | None, loads: Array) -> tuple[Array | None, Mask]:
    """Weights of the loads that count, None where all count the same, and which do."""
    every = np.ones(loads.size, dtype=bool)
    if weights is None:
        return None, every
    given = np.atleast_1d(np.asarray(weights, dtype=float))
    if given.shape != loads.shape:
        raise InputError("weights", given.tolist(), f"must have one weight for each of the {loads.size} loads")
    if not (np.isfinite(given).all() and (given >= 0.0).all() and given.any()):
        raise InputError("weights", given.tolist(), "must be finite and not negative, one of them positive")
    counts = given > 0.0
    return (None if (given[counts] == given.max()).all() else given[counts]), counts


def relief_over_path(gear: Gear, path: float, amount: float, length: float, power: float) -> EndRelief:
    """Tip relief of an amount [m] and a length over the path of contact [m]; power 1 is straight, 2 parabolic."""
    tip = float(roll_of_radius(gear, gear.involute_tip_radius))
    return EndRelief(float(amount), tip - float(length) * path / gear.base_radius, tip, power)


def _left(engagement: Engagement, loads: Array) -> dict[str, Array]:
    """Both metrics at every load, with a break point at every kink."""
    solved = [transmission_error(engagement, float(load), 12) for load in loads]
    return {
        "effective_error": np.array([float(effective_error(t.series)) for t in solved]),
        "peak_to_peak": np.array([t.peak_to_peak for t in solved]),
    }


def grindable(
    engagement: Engagement, load: float | LoadRange, shape: Shape = "linear", metric: Metric = "peak_to_peak", *,
    banded: bool = True, limits: ReliefLimits | None = None, cache: SolutionCache | None = None,
) -> TipReliefPair:  # fmt: skip
    """Find the straight or parabolic tip reliefs that leave the least error at the design load, or over a range.

    Parameters
    ----------
    engagement : Engagement
        Its reliefs, those of (4.6) say, are replaced.
    load : float or LoadRange
        Design load [N], or the loads of a range.
    shape : {"linear", "parabolic"}
    metric : {"peak_to_peak", "effective_error"}
    banded : bool
        Whether to look for the band of equally good reliefs.
    limits : ReliefLimits, optional
        Of amounts and lengths.
    cache : SolutionCache, optional
        Where searches are recalled from and kept.
    """
    over = load if isinstance(load, LoadRange) else LoadRange((load,))
    return optimise_tip_relief(
        engagement, over.loads, shape, metric, over.weights, banded=banded, limits=limits, cache=cache
    )
