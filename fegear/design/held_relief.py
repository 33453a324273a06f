"""How a relief holds up when load, spacing and grinding are not what the drawing says."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.plane.engagement import Engagement
from fegear.design.charts import Metric
from fegear.design.relief_bench import bench


@dataclass(frozen=True)
class Robustness:
    """Excitation over every combination of the deviations asked for.

    Shapes (A,), (B,), (C,) of the deviations, and (A, B, C) of the metric.
    """

    load_factors: Array = shown("", "load over design load", name="load_factor", label="load over design load")
    spacing_errors: Array = shown("um", "pitch deviation of every second tooth pair", name="spacing_error")
    relief_errors: Array = shown("", "relative error of the relief amount", name="relief_error")
    values: Array = shown("um", "excitation")
    nominal: float = shown("um", "without deviations")

    @property
    def worst(self) -> float:
        """Largest value of all [m]."""
        return float(self.values.max())

    @property
    def worst_case(self) -> tuple[float, float, float]:
        """Load factor, spacing error [m] and relief error that give it."""
        i, j, k = np.unravel_index(int(self.values.argmax()), self.values.shape)
        return float(self.load_factors[i]), float(self.spacing_errors[j]), float(self.relief_errors[k])


def robustness(
    engagement: Engagement,
    load: float,
    load_factors: ArrayLike = (0.7, 0.85, 1.0, 1.15, 1.3),
    spacing_errors: ArrayLike = (0.0,),
    relief_errors: ArrayLike = (-0.2, 0.0, 0.2),
    metric: Metric = "peak_to_peak",
) -> Robustness:
    """Try every combination of load, spacing error and relief tolerance.

    Parameters
    ----------
    engagement : Engagement
        With the reliefs to be tried.
    load : float
        Nominal load [N].
    load_factors : array_like
        Loads over the nominal one, positive.
    spacing_errors : array_like
        Removal on every second pair [m]: neighbours then differ by it, and with either sign.
    relief_errors : array_like
        Relative error of the depth of both reliefs: 0.1 is 10 % too deep.
    metric : {"peak_to_peak", "effective_error"}
    """
    w, e, d = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (load_factors, spacing_errors, relief_errors))
    if (w <= 0.0).any():
        raise InputError("design.load_factors", float(w.min()), "must be positive")
    # Peaks sit at kinks of the reliefs and where pairs part: break points at the former, many positions for the latter.
    table = bench(engagement, waves=48, breaks=engagement.breaks)
    m = table.removal(engagement.driver_relief, engagement.driven_relief)
    second = (table.grid.contacts.number % 2 == 1).astype(float)[:, None]
    cases, loads = [], []
    for factor, error, depth in product(w, e, d):
        for parity in (second, 1.0 - second) if error != 0.0 else (second,):
            cases.append(m * (1.0 + depth) + error * parity)
            loads.append(load * factor)
    values = table.errors(np.stack(cases, axis=2), np.array(loads)).of(metric)
    table_of_values, position = np.empty((w.size, e.size, d.size)), 0
    for i, j, k in np.ndindex(table_of_values.shape):
        count = 2 if e[j] != 0.0 else 1
        table_of_values[i, j, k] = values[position : position + count].max()
        position += count
    nominal = float(table.errors(m[:, :, None], load).of(metric)[0])
    return Robustness(w, e, d, table_of_values, nominal)
