"""Stable motions that exist with one that does not repeat: continued from more damping, where motions are simple.

A chaotic or endless motion says nothing of whether the same train, started otherwise, runs quietly at the same speed.
With more damping on the gear pairs every start leads to a motion of few periods; damping is then taken away in steps,
Newton following the motion, until the train's own is left.

Motion that does not repeat: followed until it settles, distinguished from slow transients, and measured.

What a motion that never repeats does over N periods is a sample, not a number with a tolerance: the largest force of
every period is kept, so that the largest over N periods and the quantiles can be reported with N beside them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError, RangeError
from fegear.dynamics.motion.effort import Effort
from fegear.dynamics.motion.motion import Passage, propagate, starting_state
from fegear.dynamics.motion.motion_model import Moving
from fegear.dynamics.motion.packed_model import Packed, pack
from fegear.dynamics.motion.shooting import Orbit, close, moving

#: Shares of more damping from which motions are continued, and how much of it is taken away at a time.
FROM, STEP = (3.0, 9.0), 3.0**-0.25


#: Periods that a more damped motion settles over, and multiples of the excitation's period that are looked at.
SETTLING, MULTIPLES = 60, (1, 2, 3)


#: Distance of two states, relative to the static deflection, below which they are one.
SAME = 1e-4


def stable_motions(model: Moving, step: float) -> tuple[Orbit, ...]:
    """Stable motions of one to three periods that are found by taking damping away, each once.

    Parameters
    ----------
    model : Moving
        What moves.
    step : float
        Largest truncated term of a step in time.
    """
    found: list[Orbit] = []
    for factor in FROM:
        settled = _settled(model.more_damped(factor), step)
        for multiple in MULTIPLES:
            orbit = _continued(model, factor, settled, multiple, step) if settled is not None else None
            if orbit is not None and not any(_same(orbit, other, step) for other in found):
                found.append(orbit)
    return tuple(found)


def _settled(model: Moving, step: float) -> tuple[Array, Array] | None:
    packed = pack(model)
    x, v = starting_state(packed, "static")
    try:
        passage = propagate(packed, x, v, SETTLING * packed.period, tolerance=step, peaks=False)
    except ConvergenceError:
        return None
    return passage.x, passage.v


def _continued(model: Moving, factor: float, state: tuple[Array, Array], multiple: int, step: float) -> Orbit | None:
    """The motion that Newton follows down to the train's own damping, if it is stable there and closes no sooner."""
    orbit: Orbit | None = None
    while True:
        factor = max(factor * STEP, 1.0) if orbit is not None else factor
        try:
            orbit = close(pack(model.more_damped(factor)), *state, multiple, step)
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


#: Periods of the first and of the longest window, how many may be followed for a transient to die, and over how many
#: growth is averaged.
WINDOW, LONGEST_WINDOW, PATIENCE, LYAPUNOV = 250, 4000, 60_000, 250


#: Periods after which a chaotic motion that still spreads is given up: teeth that strike in time with the varying
#: stiffness throw each other ever further apart, in proportion to the time, and never settle.
CHAOTIC_PATIENCE = 12_000


#: Growth of tangents per period beyond which a motion counts as chaotic.
CHAOTIC_GROWTH = 0.01


#: Change of the spread of states from window to window below which a motion has settled: one that is smooth, and one
#: that is chaotic, whose windows are samples.
SETTLED, SETTLED_CHAOS = 0.03, 0.25


@dataclass(frozen=True)
class Window:
    """Some periods of a motion: the state after each, shape (periods, n), and what was measured in each."""

    states: Array
    passages: tuple[Passage, ...]
    x: Array
    v: Array

    @property
    def spread(self) -> float:
        """Standard deviation of the states about their mean, of the coordinate that moves most."""
        return float(np.max(np.std(self.states, axis=0)))

    @property
    def middle(self) -> Array:
        """Mean state."""
        return np.asarray(np.mean(self.states, axis=0))


def follow(
    packed: Packed, x: Array, v: Array, periods: int, step: float, *, peaks: bool, effort: Effort | None = None
) -> Window:
    """Integrate over a number of periods, one by one; what it takes is counted as spent."""
    use = moving(packed)
    states, passages = [], []
    for _ in range(periods):
        passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=peaks)
        x, v = passage.x, passage.v
        if effort is not None:
            effort.spend(passage.steps * packed.size)
        states.append(np.concatenate([x, v])[use])
        if peaks:
            passages.append(passage)
    return Window(np.array(states), tuple(passages), x, v)


def growth(packed: Packed, x: Array, v: Array, step: float, periods: int = LYAPUNOV) -> float:
    """Largest Lyapunov exponent per period of the excitation, over a number of periods after a fifth of them."""
    use = np.flatnonzero(moving(packed))
    direction = np.full(use.size, 1.0 / math.sqrt(use.size))
    total = 0.0
    for period in range(periods + periods // 5):
        passage = propagate(packed, x, v, packed.period, tolerance=step, tangents=True, peaks=False)
        direction = passage.tangent[np.ix_(use, use)] @ direction
        size = float(np.linalg.norm(direction))
        if size == 0.0:
            return -math.inf
        direction = direction / size
        # the first periods turn the direction towards the one that grows most
        total += math.log(size) if period >= periods // 5 else 0.0
        x, v = passage.x, passage.v
    return total / periods


def drifting(before: Window, after: Window, *, chaotic: bool = False) -> bool:
    """Whether the states of a window still spread and lie otherwise than those of the window before."""
    scale = max(after.spread, 1e-9)
    allowed = (SETTLED_CHAOS if chaotic else SETTLED) * scale
    moved = float(np.max(np.abs(after.middle - before.middle)))
    return abs(before.spread - after.spread) > allowed or moved > allowed


def recurrences(states: Array, longest: int, near: float) -> list[int]:
    """Numbers of periods after which the last state has come back to within `near`, nearest first; 1 and 2 always."""
    reach = min(longest, states.shape[0] - 1)
    distance = {m: float(np.max(np.abs(states[-1] - states[-1 - m]))) for m in range(1, reach + 1)}
    found = [m for m in sorted(distance, key=lambda m: (distance[m], m)) if distance[m] <= near or m <= 2]
    # a motion of period m also comes back after 2 m: the shortest first
    return sorted(found)[:8]
