"""Steady motion by the iteration of TM-100180: start each period from the mean of the last one's start and end.

The report integrates one period of the excitation from an assumed state and compares its end with it. "Unless the
differences between them are sufficiently small, the procedure is repeated by using the average of the initial and
calculated values as new initial values." Here a period is integrated as everywhere, to a tolerance (the report cuts it
into n intervals, n not given), and a difference is small below that tolerance, in static deflections and, for speeds,
static deflections in the time of the fastest mode over 2 pi.

A vibration that a period multiplies by rho is multiplied by (1 + rho)/2 in a repetition: never by more than one where
the motion is stable, but by almost one where a mode makes a whole number of turns in a period and damping is small;
and by less than one for some motions that are not stable (rho between -3 and -1), to which no machine would come.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.tally import tallied
from fegear.dynamics.motion.motion import Passage, propagate, starting_state
from fegear.dynamics.motion.motion_model import Moving
from fegear.dynamics.motion.packed_model import Packed, pack
from fegear.dynamics.motion.shooting import Orbit, moving
from fegear.dynamics.motion.steady_state import UNBOUNDED, SteadyState, growing_motion, periodic_motion, step_for

#: Repetitions after which the iteration is given up, and the last of them that are looked at then.
REPETITIONS, LOOKED_AT = 1000, 100


@tallied("steady motions")
def averaged_motion(
    model: Moving,
    *,
    start: str | tuple[Array, Array] = "static",
    tolerance: float = 1e-6,
    repetitions: int = REPETITIONS,
    progress: Callable[[float], None] | None = None,
) -> SteadyState:
    """Find the motion that the averaging iteration of TM-100180 comes to, or say that it comes to none.

    Parameters
    ----------
    model : Moving
        What moves.
    start : {"static", "rest"} or (x, v)
        The assumed state; the report takes shafts wound up by the torque, and the speed of the machine.
    tolerance : float
        Difference of start and end of a period that is small enough, relative to the static deflection.
    repetitions : int
        After how many the iteration is given up.
    progress : callable, optional
        Told the share of the repetitions that are spent.

    Returns
    -------
    SteadyState
        Of the kind "periodic", or "unstable" where the motion found is one that small disturbances leave; "not
        settled" where the iteration was given up. `followed` is the number of repetitions, `residual` the difference
        that is left and `off` what it leaves in the largest tooth force.
    """
    packed = pack(model)
    step = step_for(tolerance)
    use = moving(packed)
    x, v = starting_state(packed, start)
    seen: list[Passage] = []
    left = math.inf
    for count in range(1, repetitions + 1):
        late = repetitions - count < LOOKED_AT
        passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=late)
        difference = np.concatenate([passage.x - x, passage.v - v])[use]
        left = float(np.max(np.abs(difference))) if difference.size else 0.0
        if not left <= UNBOUNDED:
            return replace(growing_motion(packed, step), followed=count)
        if left <= tolerance:
            return _closed(packed, x, v, count, left, step)
        if late:
            seen.append(passage)
        x, v = 0.5 * (x + passage.x), 0.5 * (v + passage.v)
        if progress is not None and count % LOOKED_AT == 0:
            progress(count / repetitions)
    return _given_up(packed, x, v, seen, repetitions, left)


def _closed(packed: Packed, x: Array, v: Array, count: int, left: float, step: float) -> SteadyState:
    """The motion whose period starts and ends alike, and what a step of Newton's method would still change of it."""
    short = propagate(packed, x, v, packed.period, tolerance=step, peaks=True, tangents=True)
    orbit, use, n = Orbit(packed, x, v, 1, short, left), moving(packed), packed.size
    difference = np.concatenate([short.x - x, short.v - v])[use]
    state = np.concatenate([x, v])
    state[use] += np.linalg.lstsq(np.eye(difference.size) - orbit.monodromy, difference, rcond=1e-12)[0]
    nearer = propagate(packed, state[:n], state[n:], packed.period, tolerance=step, peaks=True)
    force = np.where(packed.model.static > 0.0, packed.model.static, math.inf)
    off = float(np.max(np.abs(nearer.tooth_force - short.tooth_force) / force))
    kind = "periodic" if orbit.stable else "unstable"
    return replace(periodic_motion(orbit), kind=kind, residual=left, followed=count, off=off)


def _given_up(packed: Packed, x: Array, v: Array, seen: list[Passage], count: int, left: float) -> SteadyState:
    """What the last repetitions looked like where start and end of a period did not become alike."""
    per_period = np.array([p.tooth_force for p in seen])
    return SteadyState(
        packed.model, "not settled", 0, np.zeros(0, dtype=complex), math.nan,
        np.max([p.largest for p in seen], axis=0), np.min([p.smallest for p in seen], axis=0),
        np.max(per_period, axis=0), np.mean([p.apart for p in seen], axis=0),
        np.mean([p.behind for p in seen], axis=0), sum(p.changes for p in seen), left, x, v, per_period,
        followed=count,
    )  # fmt: skip
