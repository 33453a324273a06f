"""Mains hum of a trace: a part at 50 or 60 Hz that is no multiple of the frequency of the shaft.

A gauge repeats with every turn of its gear, mains do not. Where its tooth is far from the mesh, and less what repeats
there from turn to turn, a trace has noise and what comes from elsewhere; a line near 50 or 60 Hz stands out of that. A
torque that fluctuates strains the tooth in the mesh only, and is none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.once_per_turn import outside_mesh

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Frequencies of mains [Hz], part of one by which the speed of a shaft and mains are uncertain, and what a line has to
#: be away from whole orders [periods over the trace].
_MAINS, _REACH, _APART = (50.0, 60.0), 0.02, 1.0
#: Fewest turns of a trace, places of a turn whose means are taken off, and fewest samples of a place.
_TURNS, _PLACES, _EACH = 3.0, 720, 2
#: Steps of the search in periods over the trace, and standard errors by which a line stands out at least.
_STEP, _CERTAIN = 0.2, 8.0
#: Deviations beyond this many of the usual ones count as that many; normal deviation over its median absolute value.
_CUT, _OF_MEDIAN = 5.0, 1.4826
#: Degree of the polynomial that takes off a drift.
_SLOW = 3
#: Largest order that samples resolve, over their number in a turn.
_RESOLVED = 0.25
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class MainsHum:
    """amplitude cos(order turns - phase), with turns in radians along the trace.

    Parameters
    ----------
    frequency : float
        [Hz].
    order : float
        Per turn.
    amplitude : float
        In the unit of the trace.
    phase : float
        [rad].
    """

    frequency: float
    order: float
    amplitude: float
    phase: float

    def at(self, turns: Array) -> Array:
        """Along a trace, by the turns from its beginning."""
        return np.asarray(self.amplitude * np.cos(_TURN * self.order * turns - self.phase))


def mains_hum(
    angle: Array, measured: Array, turns: Array, speed: float | None, shift: float, curve_angle: Array
) -> MainsHum | None:  # fmt: skip
    """The hum of a trace; None where there is none, or where it could not be told.

    Parameters
    ----------
    angle, measured : ndarray, shape (N,)
        As measured [rad].
    turns : ndarray, shape (N,)
        Of the samples along the trace, from its beginning.
    speed : float or None
        Of the gear [rad/s].
    shift : float
        By which the measured curve lags behind the computed one [rad].
    curve_angle : ndarray, shape (Q,)
        Of the computed curve, ascending [rad].
    """
    length = float(turns[-1])
    used = outside_mesh(angle, shift, curve_angle)
    if not speed or length < _TURNS or np.count_nonzero(used) < _EACH * length * 8.0:
        return None
    line = _Line(turns[used], measured[used], length)
    found: MainsHum | None = None
    for mains in _MAINS:
        middle = mains * _TURN / speed
        orders = np.arange(middle * (1.0 - _REACH), middle * (1.0 + _REACH) + _STEP / length, _STEP / length)
        orders = orders[np.abs(orders - np.round(orders)) * length > _APART]
        if not orders.size or orders[-1] > _RESOLVED * turns.size / length:
            continue
        at = int(np.argmin([line.left(one) for one in orders]))
        if not 0 < at < orders.size - 1:  # what goes on beyond is another line
            continue
        order = line.refined(float(orders[at]), _STEP / length)
        cosine, sine, error = line.fitted(order)
        one = MainsHum(order * speed / _TURN, order, math.hypot(cosine, sine), math.atan2(sine, cosine))
        if one.amplitude > _CERTAIN * error and (found is None or one.amplitude > found.amplitude):
            found = one
    return found


class _Line:
    """A line of any order in what does not repeat from turn to turn.

    Parameters
    ----------
    turns, measured : ndarray, shape (M,)
        Of the samples outside the mesh.
    length : float
        Turns of the trace.
    """

    def __init__(self, turns: Array, measured: Array, length: float) -> None:
        self._turns = turns
        places = int(min(_PLACES, max(measured.size / length / _EACH, 8.0)))
        self._place = (np.mod(turns, 1.0) * places).astype(int) % places
        self._count = np.maximum(np.bincount(self._place), 1)
        along = 2.0 * (turns - turns[0]) / length - 1.0
        slow = [self._less_means(along**power) for power in range(1, _SLOW + 1)]
        self._slow = np.linalg.qr(np.stack(slow, axis=1))[0]
        rest = self._not_repeating(measured)
        usual = _OF_MEDIAN * float(np.median(np.abs(rest)))
        self._rest = np.clip(rest, -_CUT * usual, _CUT * usual)

    def left(self, order: float) -> float:
        """Sum of squares that it leaves."""
        columns = self._columns(order)
        found = np.linalg.lstsq(columns, self._rest, rcond=None)[0]
        return float(((self._rest - columns @ found) ** 2).sum())

    def refined(self, order: float, step: float) -> float:
        """The best order about one."""
        from scipy.optimize import minimize_scalar

        ends = order - step, order + step
        return float(minimize_scalar(self.left, bounds=ends, method="bounded", options={"xatol": 1e-3 * step}).x)

    def fitted(self, order: float) -> tuple[float, float, float]:
        """Factors of cosine and sine, and the standard error of either."""
        columns = self._columns(order)
        cosine, sine = np.linalg.lstsq(columns, self._rest, rcond=None)[0]
        error = math.sqrt(2.0 * self.left(order)) / self._rest.size
        return float(cosine), float(sine), error

    def _columns(self, order: float) -> Array:
        along = _TURN * order * self._turns
        return np.stack([self._not_repeating(np.cos(along)), self._not_repeating(np.sin(along))], axis=1)

    def _not_repeating(self, values: Array) -> Array:
        """Less the mean of all turns at the same place, and less what drifts along the trace."""
        rest = self._less_means(values)
        return np.asarray(rest - self._slow @ (self._slow.T @ rest))

    def _less_means(self, values: Array) -> Array:
        return np.asarray(values - (np.bincount(self._place, values) / self._count)[self._place])
