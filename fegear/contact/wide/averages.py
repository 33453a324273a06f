"""Line loads averaged over about a contact's width along its line: what the Hertzian half-width follows.

A contact that is 2 b wide does not follow a line load that changes over less than that: the logarithm of b is a law for
slowly changing loads, and with the load of a single point in it short panels would have no positive stiffness. So b
goes with the load averaged from z - H to z + H, mirrored at the ends of the line: an even load stays what it is, and so
does the sum of any. Panels that are long beside H see none of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays

if TYPE_CHECKING:
    from fegear.contact.wide.lines import ContactLines


_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)

#: Points on a panel as shares of its length, and their weights.
GAUSS = (0.5 + 0.5 * _POINTS, 0.5 * _WEIGHTS)


@dataclass(frozen=True)
class Averages(ReadOnlyArrays):
    """How the averaged load at the Gauss points of the panels follows from the line loads of the stations about them.

    Parameters
    ----------
    reach : int
        r: at a point of the panel from station i to i + 1 stations i - r to i + 1 + r count.
    rows : ndarray, shape (Gauss points, P, M - 1, 2 r + 2)
        Their weights, which add up to 1.
    """

    reach: int
    rows: Array


def averages(lines: ContactLines, window: Array | None) -> Averages:
    """Weights of the stations about each Gauss point.

    Parameters
    ----------
    lines : ContactLines
    window : ndarray, shape (P, M), or None
        H, the same all along a line [m]; None for the load at the point itself.
    """
    h = lines.panel
    a, b = (np.broadcast_to(part[:, None, None], (GAUSS[0].size, *h.shape)) for part in (1.0 - GAUSS[0], GAUSS[0]))
    if window is None or not h.any():
        return Averages(0, np.stack([a, b], axis=3))
    low, high = (part[:, :-1] for part in _ends(lines))
    z = a * lines.z[:, :-1] + b * lines.z[:, 1:]
    wide = np.where(h > 0.0, np.clip(window[:, :-1], 1e-6 * h, high - low), 1.0)
    left, right = z - wide, z + wide
    pieces = (
        (np.maximum(left, low), np.minimum(right, high)),
        (low, np.maximum(2.0 * low - left, low)),
        (np.minimum(2.0 * high - right, high), high),
    )
    reach = max(0, math.ceil(float(np.max(wide[h > 0.0] / h[h > 0.0])) - 1e-9))
    most = lines.z.shape[1]
    rows = np.zeros((*z.shape, 2 * reach + 2))
    for k in range(-reach, reach + 2):
        at = np.arange(most - 1) + k
        i = np.clip(at, 0, most - 1)
        same = (at == i) & (lines.pair[:, i] == lines.pair[:, :-1]) & lines.present[:, i] & (h > 0.0)
        below = np.where(i > 0, h[:, np.maximum(i - 1, 0)], 0.0)
        above = np.where(i < most - 1, h[:, np.minimum(i, most - 2)], 0.0)
        for first, last in pieces:
            part = _hat_below(last - lines.z[:, i], below, above) - _hat_below(first - lines.z[:, i], below, above)
            rows[..., k + reach] += np.where(same, part / (2.0 * wide), 0.0)
    return Averages(reach, rows)


def _ends(lines: ContactLines) -> tuple[Array, Array]:
    """Heights of the ends of each station's line, shape (P, M) each [m]."""
    low, high = lines.z.copy(), lines.z.copy()
    for p in range(lines.roll.size):
        for s in lines.at(p):
            low[p, s], high[p, s] = lines.z[p, s][0], lines.z[p, s][-1]
    return low, high


def _hat_below(away: Array, below: Array, above: Array) -> Array:
    """Integral of a hat of height 1 from its middle to `away`, negative on the lower side."""
    up = np.clip(away, 0.0, above)
    down = np.clip(-away, 0.0, below)
    rising = up - 0.5 * up**2 / np.where(above > 0.0, above, 1.0)
    return rising - (down - 0.5 * down**2 / np.where(below > 0.0, below, 1.0))


class LocalMatrix:
    """Sums over Gauss points of slope r r^T and load r, r their rows: a band matrix, and a vector beside it."""

    def __init__(self, shape: tuple[int, ...], reach: int) -> None:
        self._problems, self._most, self._reach = shape[0], shape[1], reach
        padded = self._most + 2 * reach
        self._bands = np.zeros((2 * reach + 2, self._problems, padded))
        self.constant = np.zeros((self._problems, padded))
        self.inside = slice(reach, reach + self._most)

    def _at(self, k: int) -> slice:
        """Stations that are the k-th of the panels' rows, in the padded arrays."""
        return slice(k, k + self._most - 1)

    def read(self, rows: Array, values: Array) -> Array:
        """Averages of values (B, M) at a Gauss point of each panel, shape (B, M - 1)."""
        padded = np.zeros((self._problems, self._most + 2 * self._reach))
        padded[:, self.inside] = values
        return np.asarray(sum(rows[:, :, k] * padded[:, self._at(k)] for k in range(rows.shape[2])))

    def add(self, rows: Array, slope: Array, load: Array) -> None:
        """Add a Gauss point of each panel, (B, M - 1) each."""
        for k in range(rows.shape[2]):
            self.constant[:, self._at(k)] += rows[:, :, k] * load
            weighted = rows[:, :, k] * slope
            for other in range(k, rows.shape[2]):
                self._bands[other - k][:, self._at(k)] += weighted * rows[:, :, other]

    def into(self, matrix: Array, density: Array) -> None:
        """Add it to matrices (B, M, M) of forces, whose loads are force times density (B, M)."""
        at = np.arange(self._most)
        for k, band in enumerate(self._bands[: self._most]):
            part = band[:, self.inside][:, : self._most - k] * density[:, : self._most - k] * density[:, k:]
            matrix[:, at[: self._most - k], at[k:]] += part
            if k:
                matrix[:, at[k:], at[: self._most - k]] += part
