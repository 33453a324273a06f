"""A jump of the zero of a trace: connector, slip ring, or a bridge that was balanced while it was recorded.

Where its tooth is far from the mesh a gauge has its zero, noise, and what drifts. Of two stretches with two zeros and a
drift the one is taken that leaves less; a torque that is stepped strains the tooth in the mesh only, and is none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.once_per_turn import outside_mesh

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Fewest turns of a trace, and fewest samples on either side of a jump.
_TURNS, _FEWEST = 1.5, 20
#: What two zeros have to leave at most of the scatter about one, and of what a drift leaves.
_OF_ALL, _OF_DRIFT = 0.25, 0.25


@dataclass(frozen=True)
class ZeroJump:
    """By how much the zero of a trace jumps, in its unit, and after how many turns."""

    height: float
    turn: float


def zero_jump(angle: Array, measured: Array, turns: Array, shift: float, computed: Array) -> ZeroJump | None:
    """The jump of the zero that explains nearly all that varies outside the mesh; None for none.

    Parameters
    ----------
    angle, measured, turns : ndarray, shape (N,)
        Of the samples in the order of the trace [rad], any unit, and turns from its beginning.
    shift : float
        Angle by which the trace lags [rad].
    computed : ndarray, shape (Q,)
        Angles of the computed curve, ascending [rad].
    """
    outside = outside_mesh(angle, shift, computed)
    values, turn = measured[outside], turns[outside]
    if values.size <= 2 * _FEWEST or turn[-1] - turn[0] < _TURNS:
        return None
    values, t = values - values.mean(), turn - turn.mean()
    every = float(values @ values)
    before = np.arange(1, values.size)
    total = np.cumsum(values)[:-1]
    explained = total**2 * values.size / (before * (values.size - before))
    explained[: _FEWEST - 1] = explained[values.size - _FEWEST :] = 0.0
    k = int(explained.argmax())
    left, drift_left = every - float(explained[k]), every - float(t @ values) ** 2 / float(t @ t)
    if left > min(_OF_ALL * every, _OF_DRIFT * drift_left):
        return None
    height = values[k + 1 :].mean() - values[: k + 1].mean()
    return ZeroJump(float(height), 0.5 * float(turn[k] + turn[k + 1]))
