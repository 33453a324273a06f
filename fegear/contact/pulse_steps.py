"""Steps of a transmission error that one of two encoders makes where it loses or counts a pulse too many.

The means over tooth pitches have nothing of the mesh. Less a drift and the first orders of both gears they are even,
but for a step that stays: what varies slowly passes over many pitches, a pulse is lost within one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Orders of each gear that are taken off, tooth pitches at most, and steps that are looked for.
_LINES, _MOST, _STEPS = 2, 2000, 4
#: Fewest turns; pitches on either side of a step; scatter of the means that it exceeds, part of what is left that it
#: explains, and part of its height within a pitch to either side.
_TURNS, _FEWEST, _CERTAIN, _EXPLAINS, _SUDDEN = 1.0, 4, 12.0, 0.15, 0.5
#: Pitches within which two are one.
_ONE = 2
#: Normal deviation over the median absolute difference of two.
_OF_MEDIAN = 1.0483
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class PulseStep:
    """By how much a transmission error steps [m], and at which measured angle, to a tooth pitch [rad]."""

    height: float
    angle: float


def pulse_steps(values: Array, angle: Array, places: int, teeth: int, ratio: float) -> tuple[PulseStep, ...]:
    """Steps of a transmission error, in their order along the trace.

    Parameters
    ----------
    values, angle : ndarray, shape (N,)
        Evenly spaced, over whole tooth pitches [m], [rad].
    places, teeth : int
        Samples of a tooth pitch, and pitches of a turn of the shaft.
    ratio : float
        Order of one revolution of the mating gear; 0 for none.
    """
    means, at = values.reshape(-1, places).mean(axis=1), angle[::places] + 0.5 * places * (angle[1] - angle[0])
    if means.size < _TURNS * teeth or means.size > _MOST:
        return ()
    orders = np.arange(1.0, _LINES + 1.0)
    both = np.multiply.outer(at, np.concatenate([orders, ratio * orders]) if ratio else orders)
    basis = np.linalg.qr(np.hstack([np.vander(at - at.mean(), 2), np.cos(both), np.sin(both)]))[0]
    stairs = np.tri(means.size, k=-1)[:, :-1]  # column k rises between pitches k and k + 1
    found: list[int] = []
    for _ in range(_STEPS):
        rest, rising = means - basis @ (basis.T @ means), stairs - basis @ (basis.T @ stairs)
        size = np.maximum((rising**2).sum(axis=0), 1e-9)
        height = rising.T @ rest / size
        explained, jump = height**2 * size, np.zeros_like(height)
        jump[1:-1] = rest[3:] - rest[:-3]  # from before pitch k to behind pitch k + 1
        explained[jump * height < _SUDDEN * height**2] = 0.0
        explained[: _FEWEST - 1] = explained[means.size - _FEWEST :] = 0.0
        k = int(explained.argmax())
        scatter = _OF_MEDIAN * float(np.median(np.abs(np.diff(rest))))
        if explained[k] < _EXPLAINS * float(rest @ rest) or abs(height[k]) < _CERTAIN * scatter:
            break
        found.append(k)
        basis = np.linalg.qr(np.column_stack([basis, stairs[:, k]]))[0]
    if not found:
        return ()
    own = np.hstack([np.vander(at - at.mean(), 2), np.cos(both), np.sin(both), stairs[:, found]])
    heights = np.linalg.lstsq(own, means, rcond=None)[0][-len(found) :]
    together: list[tuple[int, float]] = []
    for k, one in sorted(zip(found, heights.tolist(), strict=True)):
        last = together[-1] if together else None
        if last is not None and k - last[0] <= _ONE and last[1] * one > 0.0:  # within a pitch it is a part in two means
            together[-1] = (k if abs(one) > abs(last[1]) else last[0], last[1] + one)
        else:
            together.append((k, one))
    return tuple(PulseStep(one, float(0.5 * (at[k] + at[k + 1]))) for k, one in together)
