"""Charts of tip reliefs of teeth with a width, and how one holds up when load, pitch and depth deviate.

A chart has some thousand reliefs: their contact is solved with few stations and straight compliances (`QuickFlanks`)
at every load on its own; how far that is off is measured on some of them.
"""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.contact.fourier import Panels, effective_error, fourier_series
from fegear.design.charts import ReliefChart, unit_length
from fegear.design.flanks.quick import QuickFlanks, quick_flanks
from fegear.design.flanks.tip_bench import HARMONICS
from fegear.design.flanks.trials import FlankTrials
from fegear.design.held_relief import Robustness

#: Coarse panels over the face; reliefs of a chart that are solved exactly, too.
_PANELS, _COMPARED = 12, 8


def _numbers(amount: float, length: float) -> Array:
    """Nine numbers of equal tip reliefs."""
    return np.array([amount, length, amount, length, 0.0, 0.0, 0.0, 0.0, 0.0])


def quick_at_loads(trials: FlankTrials) -> list[QuickFlanks]:
    """The quick way for each load, straight about the forces of flanks without relief."""
    plain = trials.of_gap(np.zeros(trials.known.lines.x.shape)).found[0].contact.force
    cells = trials.cells
    return [quick_flanks(trials.known, plain[:, :, i], _PANELS, cells) for i in range(trials.loads.size)]


def tip_chart(
    trials: FlankTrials, quick: list[QuickFlanks], points: Panels, amounts: ArrayLike, lengths: ArrayLike
) -> ReliefChart:
    """Equal tip reliefs on both gears over amount, length and load.

    Parameters
    ----------
    trials : FlankTrials
        At the roll positions of `points`, under the loads of the chart.
    quick : list of QuickFlanks
        For each load.
    points : Panels
    amounts : array_like, shape (A,)
        [m].
    lengths : array_like, shape (B,)
        Over `unit_length`.
    """
    a, b = (np.asarray(v, dtype=float) for v in (amounts, lengths))
    unit = unit_length(trials.pair)
    shapes = np.stack([trials.gap(_numbers(1.0, float(length) * unit)) for length in b])
    effective, ripple = (np.empty((a.size, b.size, trials.loads.size)) for _ in range(2))
    for i, (way, load) in enumerate(zip(quick, trials.loads.tolist(), strict=True)):
        gaps = a[:, None, None, None] * way.gaps(shapes) + way.gaps(trials.apart_under(i)[None])
        te, _ = way.solve(gaps.reshape(-1, *gaps.shape[2:]), load)
        ripple[:, :, i] = np.ptp(te, axis=1).reshape(a.size, b.size)
        effective[:, :, i] = effective_error(fourier_series(points, te.T, HARMONICS)).reshape(a.size, b.size)
    weights = None if trials.weights is None else np.array(trials.weights)
    return ReliefChart(a, b, trials.loads, unit, effective, ripple, weights)


def chart_error(chart: ReliefChart, trials: FlankTrials) -> float:
    """By how much peak-to-peak values of a chart are off, largest of some reliefs over the largest of the chart."""
    worst = 0.0
    for k in range(_COMPARED):
        i, j = (3 * k + 1) % chart.amounts.size, (5 * k + 2) % chart.lengths.size
        numbers = _numbers(float(chart.amounts[i]), float(chart.lengths[j]) * chart.unit_length)
        exact = trials.of_numbers(numbers).peak_to_peak[0]
        worst = max(worst, float(np.abs(exact - chart.peak_to_peak[i, j]).max()))
    return worst / float(chart.peak_to_peak.max())


def tip_robustness(
    trials: FlankTrials, removal: Array, load_factors: ArrayLike, spacing_errors: ArrayLike,
    relief_errors: ArrayLike,
) -> Robustness:  # fmt: skip
    """Every combination of load, pitch deviation of every second tooth pair and depth of a relief.

    Parameters
    ----------
    trials : FlankTrials
        Under the design load times each of the factors, and at last under the design load itself.
    removal : ndarray, shape (P, M)
        By the relief at the stations [m].
    load_factors, spacing_errors, relief_errors : array_like
        As in `fegear.design.held_relief.robustness`.
    """
    w, e, d = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (load_factors, spacing_errors, relief_errors))
    second = np.where(trials.known.lines.pair % 2 == 1, 1.0, 0.0)
    values = np.zeros((w.size, e.size, d.size))
    for j, k in product(range(e.size), range(d.size)):
        for parity in (second, 1.0 - second) if e[j] != 0.0 else (second,):
            gap = removal * (1.0 + d[k]) + e[j] * parity
            gap = np.where(trials.known.lines.present, gap, 0.0)
            values[:, j, k] = np.maximum(values[:, j, k], trials.of_gap(gap).peak_to_peak[0, : w.size])
    nominal = float(trials.of_gap(removal).peak_to_peak[0, -1])
    return Robustness(w, e, d, values, nominal)
