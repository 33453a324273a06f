"""Design charts: Harris maps, and excitation over amount, length and load of the relief (TM-89901, Figs. 7 to 11)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.flanks import welbourn_amount
from fegear.design.load_range import NEAR, proportions
from fegear.design.relief_bench import bench
from fegear.geometry.pair import GearPair
from fegear.geometry.relief import Shape, roll_of_radius

Metric = Literal["effective_error", "peak_to_peak"]

#: Reliefs that may be near the optimum of a finer chart: so many times the least of the coarse one, whose valleys lie
#: between its points. The finer one has at most so many times as many amounts and lengths, and so many points in all.
_MAYBE, _FINER, _POINTS = 2.0, 4, 5000


def harris_map(engagement: Engagement, loads: ArrayLike, positions: int = 200) -> Loaded:
    """Transmission error over one base pitch for a family of loads (Harris).

    Parameters
    ----------
    engagement : Engagement
    loads : array_like, shape (L,)
        [N].
    positions : int
        Roll positions, evenly spaced inside the base pitch, none of them on a change of pairs.
    """
    pair = engagement.pair
    x = pair.x_start + pair.base_pitch * (np.arange(positions) + 0.5) / positions
    return engagement.solve(engagement.grid(x), loads)


@dataclass(frozen=True)
class ReliefChart:
    """Excitation over amount, length and load of equal tip reliefs on both gears.

    Amounts have shape (A,), lengths (B,), loads (L,), both errors (A, B, L). Length 1 is from tip to HPSTC of the
    driver.
    """

    amounts: Array = shown(
        "um", "amount of relief at both tips", name="amount", label="amount of tip relief (both gears)"
    )
    lengths: Array = shown(
        "", "relief length relative to the length from tip to HPSTC on the line of action", name="length",
        label="length of tip relief (1: tip to HPSTC)",
    )  # fmt: skip
    loads: Array = shown("N", "total load along the line of action", name="total_load")
    unit_length: float = shown("mm", "length 1 of the chart, on the line of action")
    effective_error: Array = shown(
        "um", "effective transmission error A_e (amplitude, NASA TM-89901)", name="te_effective",
        label="effective transmission error A_{e}", table="chart",
    )  # fmt: skip
    peak_to_peak: Array = shown("um", "peak-to-peak value", name="te_peak_to_peak", table="chart")
    weights: Array | None = None

    @property
    @shows("", "length with minimum A_e", table="optimum")
    def length_effective(self) -> Array:
        """For each amount and load, shape (A, L)."""
        return self.optimum_lengths("effective_error")

    @property
    @shows("", "length with minimum peak-to-peak transmission error", table="optimum")
    def length_peak_to_peak(self) -> Array:
        """For each amount and load, shape (A, L)."""
        return self.optimum_lengths("peak_to_peak")

    def optimum_lengths(self, metric: Metric = "effective_error") -> Array:
        """Length with the least excitation for each amount and load, shape (A, L); parabola through the lowest three.

        An optimum at either end of the range is that end.
        """
        return self.lowest(self._of(metric))

    def lowest(self, values: Array) -> Array:
        """The same of other values over amounts and lengths, shape (A, B, L)."""
        i = values.argmin(axis=1)
        if self.lengths.size < 3:
            return self.lengths[i]
        inner = np.clip(i, 1, self.lengths.size - 2)
        f = [np.take_along_axis(values, (inner + s)[:, None], axis=1)[:, 0] for s in (-1, 0, 1)]
        h = [self.lengths[inner + s] for s in (-1, 0, 1)]
        left, right = (f[1] - f[0]) / (h[1] - h[0]), (f[2] - f[1]) / (h[2] - h[1])
        bend = (right - left) / (h[2] - h[0])
        safe = bend > 0.0
        vertex = np.where(safe, 0.5 * (h[0] + h[1]) - left / (2.0 * np.where(safe, bend, 1.0)), h[1])
        at_end = (i == 0) | (i == self.lengths.size - 1)
        return np.asarray(np.where(at_end, self.lengths[i], np.clip(vertex, h[0], h[2])))

    def best(self, metric: Metric = "effective_error") -> tuple[float, float]:
        """Amount [m] and length whose worst excitation over the loads, over the load and by its weight, is least."""
        a, b = self.best_point(metric)
        return float(self.amounts[a]), float(self.lengths[b])

    def best_point(self, metric: Metric = "effective_error") -> tuple[int, int]:
        """Numbers of that amount and length."""
        worst = self.worst(metric)
        a, b = np.unravel_index(int(worst.argmin()), worst.shape)
        return int(a), int(b)

    def worst(self, metric: Metric = "effective_error") -> Array:
        """Excitation at the worst of the loads, in proportion to load and weight, shape (A, B) [m]."""
        return np.asarray((self._of(metric) * proportions(self.loads, self.weights)).max(axis=2))

    def boundary(self, within: float = NEAR, metric: Metric = "effective_error") -> tuple[Array, Array]:
        """Amounts [m] and lengths at which the worst excitation is so much above that of `best`, linear between points.

        Shape (N,) each, with nan between separate parts; empty where there is one amount or one length only.
        """
        from contourpy import contour_generator

        worst = self.worst(metric)
        if min(worst.shape) < 2:
            return np.empty(0), np.empty(0)
        level = (1.0 + within) * float(worst.min())
        parts = contour_generator(self.lengths, self.amounts, worst).lines(level)
        if not parts:
            return np.empty(0), np.empty(0)
        gap = np.full((1, 2), np.nan)
        points = np.concatenate([one for part in parts for one in (np.asarray(part), gap)])[:-1]
        return points[:, 1], points[:, 0]

    def finer(self) -> tuple[Array, Array]:
        """Amounts and lengths of a finer chart around the optimum."""
        maybe = (worst := self.worst()) <= _MAYBE * worst.min()
        ends = []
        for axis in (1, 0):
            there = np.flatnonzero(maybe.any(axis=axis))
            ends.append((max(int(there[0]) - 1, 0), min(int(there[-1]) + 1, maybe.shape[1 - axis] - 1)))
        cells = max(math.prod(last - first for first, last in ends), 1) * self.loads.size
        n = int(np.clip(math.sqrt(_POINTS / cells), 1, _FINER))
        found = (
            np.interp(np.arange(n * first, n * last + 1) / n, np.arange(grid.size), grid)
            for grid, (first, last) in zip((self.amounts, self.lengths), ends, strict=True)
        )
        return next(found), next(found)

    def _of(self, metric: Metric) -> Array:
        return self.effective_error if metric == "effective_error" else self.peak_to_peak


def relief_chart(
    engagement: Engagement,
    amounts: ArrayLike,
    lengths: ArrayLike,
    loads: ArrayLike,
    shape: Shape = "linear",
    weights: ArrayLike | None = None,
) -> ReliefChart:
    """Try equal tip reliefs on both gears over amount, length and load.

    Parameters
    ----------
    engagement : Engagement
        Its own reliefs are replaced.
    amounts : array_like, shape (A,)
        Removal at the tips [m].
    lengths : array_like, shape (B,)
        L_n of TM-89901: 1 runs from the tip to the HPSTC in roll angle; for contact ratios above 2, where there is
        none, 1 is the part of the path beyond the innermost base pitch, half of each.
    loads : array_like, shape (L,)
        [N].
    shape : {"linear", "parabolic"}
    weights : array_like, shape (L,), optional
        What each load counts for the single best; all the same by default.
    """
    a, b, w = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (amounts, lengths, loads))
    if (b <= 0.0).any():
        raise InputError("relief.lengths", float(b.min()), "must be positive")
    if (a < 0.0).any():
        raise InputError("relief.amounts", float(a.min()), "must not be negative")
    pair = engagement.pair
    unit = unit_length(pair)
    table = bench(engagement)
    contacts = table.grid.contacts
    removal: Array = np.zeros((*contacts.x.shape, b.size))
    for gear, roll in ((pair.driver, contacts.roll_driver), (pair.driven, contacts.roll_driven)):
        tip = float(roll_of_radius(gear, gear.involute_tip_radius))
        s = np.maximum(1.0 - (tip - roll)[:, :, None] * gear.base_radius / (b * unit), 0.0)
        removal = removal + (s if shape == "linear" else s * s)
    cases = removal[:, :, None, :, None] * a[:, None, None] * np.ones(w.size)
    flat = cases.reshape(*contacts.x.shape, -1)
    metrics = table.errors(flat, np.broadcast_to(w, (a.size, b.size, w.size)).ravel())
    shape3 = (a.size, b.size, w.size)
    counts = None if weights is None else np.asarray(weights, dtype=float)
    return ReliefChart(
        a, b, w, unit, metrics.effective_error.reshape(shape3), metrics.peak_to_peak.reshape(shape3), counts
    )  # fmt: skip


def unit_length(pair: GearPair) -> float:
    """Length 1 of charts, on the line of action [m]: see `relief_chart`."""
    inner = 1.0 if pair.contact_ratio < 2.0 else math.floor(pair.contact_ratio) - 0.5
    return pair.path_length - pair.base_pitch * inner


def meaning_of_unit(pair: GearPair) -> str:
    """What `unit_amount` of a pair is."""
    if 1.0 <= pair.contact_ratio < 2.0:
        return "Welbourn's Delta, the deflection at the HPSTC"
    return "maximum transmission error without relief"


def unit_amount(engagement: Engagement, load: float) -> float:
    """Unit of normalised amounts [m]: Welbourn's Delta for contact ratios between 1 and 2.

    For others the largest transmission error of the unmodified pair, which of unequal gears Delta is not.
    """
    from fegear.contact.plane.transmission_error import transmission_error

    if 1.0 <= engagement.pair.contact_ratio < 2.0:
        return welbourn_amount(engagement, load)
    return float(transmission_error(engagement.unmodified(), load, 12).values.max())
