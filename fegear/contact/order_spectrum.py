"""Orders of a measured transmission error: over whole turns of the shaft, and those of the mating gear between them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.shown import shown

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array

#: Orders of each gear that are fitted together, and periods over the trace that tell two of them apart.
_LINES, _APART = 3, 0.35
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class OrderLine:
    """One order of a trace: amplitude cos(order angle - phase) [m], [rad]."""

    order: float
    amplitude: float
    phase: float

    def at(self, angle: Array) -> Array:
        """[m]."""
        return np.asarray(self.amplitude * np.cos(self.order * angle - self.phase))


@dataclass(frozen=True)
class OrderSpectrum(ReadOnlyArrays):
    """Orders of a trace over whole turns of the shaft, or over whole tooth pitches where it has no whole turn.

    Parameters
    ----------
    turns : float
        That it is taken over.
    order, amplitude : ndarray, shape (N,)
        Per turn of the shaft, from the first above zero; 0-peak [m].
    phase : ndarray, shape (N,)
        Of cos(order angle - phase) [rad].
    """

    turns: float
    phase: Array = shown("deg", "phase: order times the rotation of the shaft at the maximum")
    order: Array = shown("", "order per revolution of the shaft of the angle", label="order")
    amplitude: Array = shown("um", "amplitude of the measured transmission error", label="amplitude")

    def line(self, order: float) -> OrderLine | None:
        """An order that it has; None of a trace without a whole turn."""
        at = int(np.abs(self.order - order).argmin())
        if self.turns < 1.0 or abs(self.order[at] - order) > 1e-6:
            return None
        return OrderLine(order, float(self.amplitude[at]), float(self.phase[at]))

    def beside(self, lines: Sequence[OrderLine]) -> OrderSpectrum:
        """With further lines, in the place of any of the same order."""
        if not lines:
            return self
        added = np.array([one.order for one in lines])
        kept = np.abs(self.order[:, None] - added).min(axis=1) > 1e-9
        orders = np.concatenate([self.order[kept], added])
        ascending = np.argsort(orders, kind="stable")
        phase, amplitude = (
            np.concatenate([known[kept], more])[ascending]
            for known, more in (
                (self.phase, [one.phase for one in lines]), (self.amplitude, [one.amplitude for one in lines])
            )
        )  # fmt: skip
        return OrderSpectrum(self.turns, phase, orders[ascending], amplitude)


def order_spectrum(values: Array, turns: float, start: float) -> OrderSpectrum:
    """Orders of evenly spaced samples.

    Parameters
    ----------
    values : ndarray, shape (N,)
        [m].
    turns : float
        That these are over.
    start : float
        Angle of the first one [rad].
    """
    found = np.fft.rfft(values - values.mean()) * 2.0 / values.size
    if values.size % 2 == 0:
        found[-1] *= 0.5
    order = np.arange(1, found.size) / turns
    return OrderSpectrum(turns, np.mod(order * start - np.angle(found[1:]), _TURN), order, np.abs(found[1:]))


def lines_of_mate(values: Array, angle: Array, turns: float, ratio: float) -> tuple[OrderLine, ...]:
    """Lines of the mating gear, which a spectrum over whole turns of the shaft would spread over its neighbours.

    By least squares together with the first orders of the shaft. Lines that stand too near to whole orders are left to
    those.

    Parameters
    ----------
    values, angle : ndarray, shape (N,)
    turns : float
        That these are over.
    ratio : float
        Order of one revolution of the mating gear; 0 for none.
    """
    if turns < 1.0 or ratio * turns < 1.0:
        return ()
    own, orders = np.arange(1.0, _LINES + 1.0), ratio * np.arange(1, _LINES + 1)
    orders = orders[np.abs(orders - np.round(orders)) * turns >= _APART]
    if not orders.size or orders[0] != ratio:
        return ()
    both = np.multiply.outer(angle, np.concatenate([own, orders]))
    found = np.linalg.lstsq(np.hstack([np.cos(both), np.sin(both), np.ones((angle.size, 1))]), values, rcond=None)[0]
    cosine, sine = found[: both.shape[1]][own.size :], found[both.shape[1] : -1][own.size :]
    return tuple(
        OrderLine(float(order), math.hypot(c, s), math.atan2(s, c) % _TURN)
        for order, c, s in zip(orders, cosine.tolist(), sine.tolist(), strict=True)
    )
