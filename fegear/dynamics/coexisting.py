"""Stable motions that exist beside one that does not repeat: continued from more damping, where motions are simple.

A chaotic or endless motion says nothing of whether the same train, started otherwise, runs quietly at the same speed.
With more damping on the gear pairs every start leads to a motion of few periods; damping is then taken away in steps,
Newton following the motion, until the train's own is left.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.motion import propagate, starting_state
from fegear.dynamics.packing import pack
from fegear.dynamics.shooting import Orbit, close, moving
from fegear.errors import ConvergenceError, RangeError

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.motion_model import MotionModel

#: Shares of more damping from which motions are continued, and how much of it is taken away at a time.
FROM, STEP = (3.0, 9.0), 3.0**-0.25
#: Periods that a more damped motion settles over, and multiples of the excitation's period that are looked at.
SETTLING, MULTIPLES = 60, (1, 2, 3)
#: Distance of two states, beside the static deflection, below which they are one.
SAME = 1e-4


def stable_motions(model: MotionModel, step: float) -> tuple[Orbit, ...]:
    """Stable motions of one to three periods that are found by taking damping away, each once.

    Parameters
    ----------
    model : MotionModel
        What moves.
    step : float
        Largest truncated term of a step in time.
    """
    found: list[Orbit] = []
    for factor in FROM:
        settled = _settled(_damped(model, factor), step)
        for multiple in MULTIPLES:
            orbit = _continued(model, factor, settled, multiple, step) if settled is not None else None
            if orbit is not None and not any(_same(orbit, other, step) for other in found):
                found.append(orbit)
    return tuple(found)


def _damped(model: MotionModel, factor: float) -> MotionModel:
    """The model with so many times the damping of its gear pairs."""
    meshes = tuple(replace(mesh, damping=factor * mesh.damping) for mesh in model.train.meshes)
    return replace(model, train=replace(model.train, meshes=meshes))


def _settled(model: MotionModel, step: float) -> tuple[Array, Array] | None:
    packed = pack(model)
    x, v = starting_state(packed, "static")
    try:
        passage = propagate(packed, x, v, SETTLING * packed.period, tolerance=step, peaks=False)
    except ConvergenceError:
        return None
    return passage.x, passage.v


def _continued(
    model: MotionModel, factor: float, state: tuple[Array, Array], multiple: int, step: float
) -> Orbit | None:
    """The motion that Newton follows down to the train's own damping, if it is stable there and closes no sooner."""
    orbit: Orbit | None = None
    while True:
        factor = max(factor * STEP, 1.0) if orbit is not None else factor
        try:
            orbit = close(pack(_damped(model, factor)), *state, multiple, step)
        except RangeError:  # without damping at resonance
            return None
        if orbit is None:
            return None
        if factor == 1.0:
            break
        state = orbit.x, orbit.v
    return orbit if orbit.stable and not _closes_sooner(orbit, step) else None


def _closes_sooner(orbit: Orbit, step: float) -> bool:
    return any(
        float(np.max(np.abs(point - orbit.state))) < SAME for point in _points(orbit, step)[:-1]
    )  # fmt: skip


def _points(orbit: Orbit, step: float) -> list[Array]:
    """State of an orbit after each period of the excitation, the last being where it began."""
    packed, use = orbit.packed, moving(orbit.packed)
    x, v, found = orbit.x, orbit.v, []
    for _ in range(orbit.periods):
        passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=False)
        x, v = passage.x, passage.v
        found.append(np.concatenate([x, v])[use])
    return found


def _same(one: Orbit, other: Orbit, step: float) -> bool:
    if one.periods != other.periods:
        return False
    return any(float(np.max(np.abs(point - other.state))) < SAME for point in _points(one, step))
