"""The best tip relief that a shop can grind: straight or parabolic, on both gears, over a range of loads."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.design.evaluation import Bench, bench
from fegear.errors import InputError
from fegear.geometry.relief import EndRelief, Relief, Shape, roll_of_radius

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.contact.engagement import Engagement
    from fegear.design.charts import Metric

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class TipReliefPair:
    """Tip relief of both gears and what it leaves.

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
        Worst metric over the loads, each in proportion to its load, at the largest load [m].
    evaluations : int
    """

    driver: EndRelief
    driven: EndRelief
    loads: Array
    effective_error: Array
    peak_to_peak: Array
    before: Array
    objective: float
    evaluations: int

    def applied(self, engagement: Engagement) -> Engagement:
        """The pair with this relief instead of its own."""
        return replace(engagement, driver_relief=self.driver, driven_relief=self.driven)


def _reliefs(table: Bench, parameters: Array, shape: Shape, scale: float) -> tuple[EndRelief, EndRelief]:
    """Amounts in units of `scale` and lengths in units of the path beyond one base pitch, both kept positive."""
    pair = table.engagement.pair
    power = 1.0 if shape == "linear" else 2.0
    found = []
    for gear, amount, length in (
        (pair.driver, parameters[0], parameters[1]),
        (pair.driven, parameters[2], parameters[3]),
    ):
        tip = float(roll_of_radius(gear, gear.involute_tip_radius))
        span = np.clip(length, 0.02, 1.0) * pair.path_length / gear.base_radius
        found.append(EndRelief(scale * max(float(amount), 0.0), tip - float(span), tip, power))
    return found[0], found[1]


def optimise_tip_relief(
    engagement: Engagement,
    loads: ArrayLike,
    shape: Shape = "linear",
    metric: Metric = "effective_error",
    start: tuple[Relief, Relief] | None = None,
    iterations: int = 250,
) -> TipReliefPair:
    """Find amount and length of tip relief on both gears for the least excitation over a range of loads.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    loads : array_like, shape (L,)
        [N]; the worst of them counts, each excitation in proportion to its load.
    shape : {"linear", "parabolic"}
    metric : {"effective_error", "peak_to_peak"}
    start : (Relief, Relief), optional
        Reliefs to start near, for example those of (4.6); by default a scan of equal reliefs on both gears.
    iterations : int
        Limit for the simplex search.
    """
    from scipy.optimize import minimize

    w = np.atleast_1d(np.asarray(loads, dtype=float))
    if w.size == 0:
        raise InputError("design.loads", "[]", "must name at least one load")
    table = bench(engagement)
    n, positions = table.grid.contacts.x.shape
    before = table.errors(np.zeros((n, positions, w.size)), w)
    scale = float(before.mean.max())
    weight = w.max() / w

    def candidates(parameters: Array) -> Array:
        """Worst metric of each row of parameters."""
        m = np.stack([table.removal(*_reliefs(table, p, shape, scale)) for p in parameters], axis=2)
        cases = np.repeat(m, w.size, axis=2)
        values = table.errors(cases, np.tile(w, parameters.shape[0])).of(metric)
        return np.asarray((values.reshape(-1, w.size) * weight).max(axis=1))

    if start is None:
        grid = np.array([(a, b) for a in np.linspace(0.2, 2.0, 10) for b in np.linspace(0.05, 0.6, 12)])
        trial = np.concatenate([grid, grid], axis=1)
    else:
        trial = _fit(table, start, shape, scale)[None]
    values = candidates(trial)
    best = trial[int(values.argmin())]
    result = minimize(
        lambda p: float(candidates(p[None])[0]),
        best,
        method="Nelder-Mead",
        options={"maxiter": iterations, "xatol": 1e-4, "fatol": 1e-5 * scale, "initial_simplex": _simplex(best)},
    )
    driver, driven = _reliefs(table, result.x, shape, scale)
    after = table.errors(np.repeat(table.removal(driver, driven)[:, :, None], w.size, axis=2), w)
    return TipReliefPair(
        driver, driven, w, after.effective_error, after.peak_to_peak, before.of(metric), float(result.fun),
        int(result.nfev) + trial.shape[0],
    )  # fmt: skip


def _simplex(centre: Array) -> Array:
    """A first simplex a tenth of each parameter wide."""
    steps = np.diag(np.maximum(0.1 * np.abs(centre), 0.02))
    return np.concatenate([centre[None], centre + steps])


def _fit(table: Bench, start: tuple[Relief, Relief], shape: Shape, scale: float) -> Array:
    """Least-squares tip reliefs nearest to the combined modification of two given reliefs.

    Root relief of one gear acts like tip relief of its mate, so each side of the path is fitted with the tip relief
    of the gear whose tip is there, above a constant that only turns the gears.
    """
    pair = table.engagement.pair
    x = np.linspace(pair.x_start, pair.x_end, 201)
    total = start[0].removal(pair.roll_angle(x, "driver")) + start[1].removal(pair.roll_angle(x, "driven"))
    total = total - total.min()
    power = 1.0 if shape == "linear" else 2.0
    best: tuple[float, Array] = (np.inf, np.zeros(4))
    fractions = np.linspace(0.05, 0.7, 27)
    for first in fractions:
        for second in fractions:
            s1 = np.maximum(1.0 - (pair.x_end - x) / (first * pair.path_length), 0.0) ** power
            s2 = np.maximum(1.0 - (x - pair.x_start) / (second * pair.path_length), 0.0) ** power
            basis = np.stack([s1, s2, np.ones_like(x)], axis=1)
            solution, *_ = np.linalg.lstsq(basis, total, rcond=None)
            misfit = float(((basis @ solution - total) ** 2).sum())
            if misfit < best[0] and solution[0] > 0.0 and solution[1] > 0.0:
                best = misfit, np.array([solution[0] / scale, first, solution[1] / scale, second])
    return best[1] if np.isfinite(best[0]) else np.array([0.5, 0.25, 0.5, 0.25])


def grindable(
    engagement: Engagement, load: float, shape: Shape = "linear", metric: Metric = "peak_to_peak"
) -> TipReliefPair:
    """Turn the designed reliefs of a pair into the straight or parabolic tip reliefs that leave the least error.

    Parameters
    ----------
    engagement : Engagement
        With the reliefs of (4.6).
    load : float
        Design load [N].
    shape : {"linear", "parabolic"}
    metric : {"peak_to_peak", "effective_error"}
    """
    start = (engagement.driver_relief, engagement.driven_relief)
    return optimise_tip_relief(engagement, [load], shape, metric, start=start)
