"""What a trace of a gauge has once per turn of its gear: bending of the shaft, runout, a slip ring.

Where the tooth of the gauge is far from the mesh nothing strains it but what turns with the gear: a wave of one period
there is no strain of the mesh. It is fitted there with a constant and a drift over the turns, so that neither the
computed curve nor a difference of shape has a part in it, and subtracted everywhere where that is asked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask

#: Lengths of the computed curve about its middle that count as in or near the mesh.
_NEAR = 1.5
#: Eighths of a turn outside of it that need samples, and fewest samples.
_EIGHTHS, _FEWEST = 4, 40
#: Usual deviations beyond which a sample does not count, and how often that is looked at.
_CUT, _ROUNDS = 5.0, 3
#: Normal deviation over its median absolute value.
_OF_MEDIAN = 1.4826
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class OncePerTurn:
    """amplitude cos(angle - place): a wave of one period per turn.

    Parameters
    ----------
    amplitude, error : float
        In the unit of the trace, and its standard error.
    place : float
        Measured angle of its maximum [rad].
    """

    amplitude: float
    error: float
    place: float

    def at(self, angle: Array) -> Array:
        """At measured angles [rad]."""
        return np.asarray(self.amplitude * np.cos(angle - self.place))


def outside_mesh(angle: Array, shift: float, curve_angle: Array) -> Mask:
    """Which samples of a trace are far from the mesh of the tooth of its gauge, shape (N,).

    Parameters
    ----------
    angle : ndarray, shape (N,)
        As measured [rad].
    shift : float
        By which the measured curve lags behind the computed one [rad].
    curve_angle : ndarray, shape (Q,)
        Of the computed curve, ascending [rad].
    """
    middle, half = 0.5 * (curve_angle[0] + curve_angle[-1]), 0.5 * (curve_angle[-1] - curve_angle[0])
    beside = np.abs(np.mod(angle - shift - middle + math.pi, _TURN) - math.pi)
    return np.asarray(beside > _NEAR * half)


def once_per_turn(
    angle: Array, measured: Array, turns: Array, shift: float, curve_angle: Array
) -> OncePerTurn | None:  # fmt: skip
    """The wave of a trace outside the mesh; None where too little of a turn was measured there.

    Parameters
    ----------
    angle, measured : ndarray, shape (N,)
        As measured [rad].
    turns : ndarray, shape (N,)
        Of the samples along the trace.
    shift : float
        By which the measured curve lags behind the computed one [rad].
    curve_angle : ndarray, shape (Q,)
        Of the computed curve, ascending [rad].
    """
    used = outside_mesh(angle, shift, curve_angle)
    eighths = np.unique(np.floor(np.mod(angle[used], _TURN) / _TURN * 8.0))
    if np.count_nonzero(used) < _FEWEST or eighths.size < _EIGHTHS:
        return None
    at, y, turns = angle[used], measured[used], turns[used]
    columns = np.stack([np.ones(at.size), np.cos(at), np.sin(at)], axis=1)
    if float(np.ptp(turns)) > 1.0:  # a drift over the turns would be a wave in each of them
        columns = np.column_stack([columns, turns - turns.mean()])
    found, kept = np.zeros(columns.shape[1]), np.ones(at.size, dtype=bool)
    for _ in range(_ROUNDS):
        found = np.linalg.lstsq(columns[kept], y[kept], rcond=None)[0]
        rest = y - columns @ found
        usual = _OF_MEDIAN * float(np.median(np.abs(rest[kept])))
        kept = np.abs(rest) <= _CUT * max(usual, float(np.finfo(float).tiny))
        if np.count_nonzero(kept) < _FEWEST:
            return None
    amplitude = math.hypot(found[1], found[2])
    spread = np.linalg.pinv(columns[kept].T @ columns[kept]) * float(rest[kept].var())
    way = np.zeros(found.size)
    way[1:3] = found[1:3] / (amplitude or 1.0)
    return OncePerTurn(amplitude, math.sqrt(max(float(way @ spread @ way), 0.0)), math.atan2(found[2], found[1]))
