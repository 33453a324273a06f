"""Design charts: Harris maps, and excitation over amount, length and load of the relief (TM-89901, Figs. 7 to 11)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.contact.engagement import Engagement
from fegear.design.evaluation import bench
from fegear.errors import InputError
from fegear.geometry.relief import Shape, roll_of_radius

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.contact.engagement import Loaded

Metric = Literal["effective_error", "peak_to_peak"]


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

    Parameters
    ----------
    amounts : ndarray, shape (A,)
        Removal at the tips [m].
    lengths : ndarray, shape (B,)
        Lengths in the unit that `unit_length` gives.
    loads : ndarray, shape (L,)
        [N].
    unit_length : float
        Roll length [m] of length 1: tip to HPSTC of the driver.
    effective_error, peak_to_peak : ndarray, shape (A, B, L)
        [m].
    """

    amounts: Array
    lengths: Array
    loads: Array
    unit_length: float
    effective_error: Array
    peak_to_peak: Array

    def optimum_lengths(self, metric: Metric = "effective_error") -> Array:
        """Length with the least excitation for each amount and load, shape (A, L); parabola through the lowest three.

        An optimum at either end of the range is that end.
        """
        values = self.effective_error if metric == "effective_error" else self.peak_to_peak
        i = values.argmin(axis=1)
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
        """Amount [m] and length whose worst excitation over the loads, relative to the load, is least."""
        values = self.effective_error if metric == "effective_error" else self.peak_to_peak
        worst = (values / self.loads).max(axis=2)
        a, b = np.unravel_index(int(worst.argmin()), worst.shape)
        return float(self.amounts[a]), float(self.lengths[b])


def relief_chart(
    engagement: Engagement, amounts: ArrayLike, lengths: ArrayLike, loads: ArrayLike, shape: Shape = "linear"
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
    """
    a, b, w = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (amounts, lengths, loads))
    if (b <= 0.0).any():
        raise InputError("relief.lengths", float(b.min()), "must be positive")
    if (a < 0.0).any():
        raise InputError("relief.amounts", float(a.min()), "must not be negative")
    pair = engagement.pair
    unit = pair.path_length - pair.base_pitch * (
        1.0 if pair.contact_ratio < 2.0 else np.floor(pair.contact_ratio) - 0.5
    )
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
    return ReliefChart(a, b, w, unit, metrics.effective_error.reshape(shape3), metrics.peak_to_peak.reshape(shape3))


def welbourn_amount(engagement: Engagement, load: float, largest_spacing_error: float = 0.0) -> float:
    """Delta of TM-89901 after Welbourn [m]: combined tooth deflection at the HPSTC plus twice the spacing error.

    Parameters
    ----------
    engagement : Engagement
        Its reliefs and spacing errors do not count; its contact ratio lies between 1 and 2.
    load : float
        Design load [N].
    largest_spacing_error : float
        [m].
    """
    pair = engagement.pair
    if not 1.0 <= pair.contact_ratio < 2.0:
        raise InputError(
            "relief.amount", f"contact ratio {pair.contact_ratio:.4f}", "has no highest point of single tooth contact"
        )
    perfect = Engagement(engagement.compliance)
    at = pair.x_hpstc - 1e-9 * pair.base_pitch
    return float(perfect.solve(perfect.grid([at]), [load]).transmission_error[0, 0]) + 2.0 * largest_spacing_error


def unit_amount(engagement: Engagement, load: float) -> float:
    """Largest transmission error of the unmodified pair [m]: Welbourn's Delta for contact ratios between 1 and 2."""
    from fegear.contact import transmission_error

    if 1.0 <= engagement.pair.contact_ratio < 2.0:
        return welbourn_amount(engagement, load)
    return float(transmission_error(engagement.unmodified(), load, 12).values.max())
