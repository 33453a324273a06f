"""Motion that does not repeat: followed until it settles, distinguished from slow transients, and measured.

What a motion that never repeats does over N periods is a sample, not a number with a tolerance: the largest force of
every period is kept, so that the largest over N periods and the quantiles can be reported with N beside them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.motion import Passage, propagate
from fegear.dynamics.shooting import moving

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.packing import Packed

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


def follow(packed: Packed, x: Array, v: Array, periods: int, step: float, *, peaks: bool) -> Window:
    """Integrate over a number of periods, one by one."""
    use = moving(packed)
    states, passages = [], []
    for _ in range(periods):
        passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=peaks)
        x, v = passage.x, passage.v
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
