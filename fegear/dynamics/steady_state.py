"""Steady motion by shooting: Newton on the state after a period, Floquet multipliers, non-periodic motion named.

A linear train (no change of contact) is closed in one Newton step, exactly. With contact loss the motion first runs
a few periods from its start, so that it ends on the branch the start leads to, and Newton closes what is left. When no
stable motion of up to 32 periods is found, the largest Lyapunov exponent tells quasi-periodic from chaotic motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.motion import Passage, Trajectory, propagate, starting_state
from fegear.dynamics.packing import Packed, pack
from fegear.errors import ConvergenceError, RangeError
from fegear.tally import tallied

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fegear.dynamics.motion_model import MotionModel

    Array = NDArray[np.float64]
    ComplexArray = NDArray[np.complex128]

#: Most periods of excitation that one period of the motion may take.
LONGEST_MULTIPLE = 32
#: Periods integrated before Newton starts, and windows of the search for a repeating motion.
SETTLING, SEARCH = 12, 160
#: Periods over which a non-periodic motion is measured.
MEASURED = 200
#: Growth of tangents per period beyond which a non-periodic motion counts as chaotic.
CHAOTIC_GROWTH = 0.01
#: Motion so many times the static deflection of a mesh grows for ever: no gear train holds that.
UNBOUNDED = 1e5
#: How far a multiplier may exceed one before the motion counts as unstable.
UNSTABLE = 1e-6


@dataclass(frozen=True)
class SteadyState:
    """Steady motion of a train at one speed.

    Attributes
    ----------
    model : MotionModel
        What moves.
    kind : str
        "periodic", "quasi-periodic", "chaotic", or "long-period" (repeats, but after more than 32 periods).
    periods : int
        Periods of the excitation after which the motion repeats; 0 if it does not.
    multipliers : ndarray, complex
        Floquet multipliers of the motion, largest first; empty if it does not repeat.
    growth : float
        Logarithm of the largest multiplier per period of excitation, or the largest Lyapunov exponent.
    largest, smallest : ndarray, shape (meshes,)
        Largest and smallest mesh force [N]; negative on the back flanks.
    tooth_force : ndarray, shape (meshes,)
        Largest force on one tooth pair [N].
    apart, behind : ndarray, shape (meshes,)
        Share of the time without contact and on the back flanks.
    changes : int
        Changes of contact in the motion's period (in the measured window if it does not repeat).
    residual : float
        What the motion misses closing by, beside the static deflection.
    x, v : ndarray
        State at time zero, in the coordinates of `motion.pack`.
    """

    model: MotionModel
    kind: str
    periods: int
    multipliers: ComplexArray
    growth: float
    largest: Array
    smallest: Array
    tooth_force: Array
    apart: Array
    behind: Array
    changes: int
    residual: float
    x: Array
    v: Array

    @property
    def dynamic_factor(self) -> Array:
        """Largest force on one tooth pair over the mean mesh force (TM-89901: dynamic over static tooth load)."""
        return self.tooth_force / self._mean_force()

    @property
    def mesh_force_factor(self) -> Array:
        """Largest mesh force, all teeth in contact together, over the mean mesh force."""
        return self.largest / self._mean_force()

    def _mean_force(self) -> Array:
        if not np.all(self.model.static > 0.0):
            raise RangeError(
                "dynamic factor", f"{float(np.min(self.model.static)):.6g} N", "is the mean force: must be positive",
                "look at `largest` and `tooth_force` of an idling gear pair",
            )  # fmt: skip
        return self.model.static

    def trajectory(self, periods: int = 0, *, tolerance: float = 1e-10) -> Trajectory:
        """The motion over its period, or over a number of periods of excitation."""
        packed = pack(self.model)
        count = periods or max(self.periods, 1)
        length = count * packed.period
        passage = propagate(
            packed, self.x, self.v, length, tolerance=tolerance, record=1000 * count + int(8 * length), peaks=False
        )
        return Trajectory(packed, passage)


@tallied("steady motions")
def steady_state(
    model: MotionModel,
    *,
    start: str | tuple[Array, Array] = "static",
    tolerance: float = 1e-6,
    settling: int = SETTLING,
) -> SteadyState:
    """Find the steady motion that a start leads to.

    Parameters
    ----------
    model : MotionModel
        What moves.
    start : {"static", "rest"} or (x, v)
        Where the motion begins; a state of another speed continues its branch.
    tolerance : float
        Accuracy of the largest forces, beside the mean force; steps and closure are held well below it.
    settling : int
        Periods integrated before Newton (when contact is lost).

    Raises
    ------
    RangeError
        If the tolerance is out of range, a train without damping is at resonance, or the motion grows without bound
        (parametric instability of teeth that touch on either flank).
    """
    if not 1e-13 < tolerance <= 1e-2:
        raise RangeError("tolerance", tolerance, "must lie between 1e-13 and 1e-2")
    packed = pack(model)
    step = max(1e-3 * tolerance, 1e-14)
    x, v = starting_state(packed, start)
    passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=False, tangents=True)
    if passage.changes == 0:
        found = _close(packed, x, v, 1, step)
        if found is not None and found[2].changes == 0:
            return _periodic(packed, *found, 1)
    x, v = passage.x, passage.v
    if settling > 1:
        passage = propagate(packed, x, v, (settling - 1) * packed.period, tolerance=step, peaks=False)
        x, v = passage.x, passage.v
    for further in (0, 2 * settling, 4 * settling):
        if further:
            passage = propagate(packed, x, v, further * packed.period, tolerance=step, peaks=False)
            x, v = passage.x, passage.v
        for multiple in (1, 2):
            found = _close(packed, x, v, multiple, step)
            if found is not None and _radius(packed, found[2]) <= 1.0 + UNSTABLE:
                return _periodic(packed, *found, multiple)
    return _search(packed, x, v, step)


def _moving(packed: Packed) -> NDArray[np.bool_]:
    """Entries of the state (x, v) that matter for the motion: all but the free turning angle."""
    return np.concatenate([packed.free, np.ones(packed.size, dtype=bool)])


def _close(packed: Packed, x: Array, v: Array, multiple: int, step: float) -> tuple[Array, Array, Passage] | None:
    """Newton on the state after `multiple` periods; None when it does not settle."""
    use = _moving(packed)
    n = packed.size
    y = np.concatenate([x, v])
    before, closed = math.inf, False
    for _ in range(16):
        try:
            passage = propagate(
                packed, y[:n], y[n:], multiple * packed.period, tolerance=step, tangents=True, peaks=False
            )
        except ConvergenceError:
            return None
        miss = (np.concatenate([passage.x, passage.v]) - y)[use]
        size = float(np.max(np.abs(miss))) if miss.size else 0.0
        if closed:
            return y[:n], y[n:], passage
        if not np.isfinite(size) or size > 8.0 * before:
            return None
        before = size
        tangent = passage.tangent[np.ix_(use, use)]
        matrix = tangent - np.eye(int(use.sum()))
        if np.linalg.svd(matrix, compute_uv=False)[-1] <= 1e-10 * np.linalg.norm(tangent, 2):
            if passage.changes == 0 and not np.any(passage.apart > 0.0) and not np.any(passage.behind > 0.0):
                raise RangeError(
                    "speed",
                    f"{packed.model.speed:.9g} rad/s",
                    "meets a resonance without damping: there is no bounded steady motion",
                    "give the train damping or leave this speed out",
                )
            return None
        change = np.linalg.solve(matrix, miss)
        y[use] -= change
        # what the last change leaves is of second order; round-off in the largest coordinate bounds it below
        largest = float(np.max(np.abs(y[use])))
        closed = bool(np.max(np.abs(change)) <= max(10.0 * step, 1e-12 * largest))
    return None


def _radius(packed: Packed, passage: Passage) -> float:
    use = _moving(packed)
    return float(np.max(np.abs(np.linalg.eigvals(passage.tangent[np.ix_(use, use)]))))


def _periodic(packed: Packed, x: Array, v: Array, passage: Passage, multiple: int) -> SteadyState:
    use = _moving(packed)
    for divisor in range(1, multiple):
        if multiple % divisor:
            continue
        # a motion of period 1 also closes after 2: report the shortest
        short = propagate(packed, x, v, divisor * packed.period, tolerance=1e-13, peaks=False, tangents=True)
        if np.max(np.abs(np.concatenate([short.x - x, short.v - v])[use])) < 1e-5:
            passage, multiple = short, divisor
            break
    values = np.asarray(np.linalg.eigvals(passage.tangent[np.ix_(use, use)]), dtype=complex)
    values = values[np.argsort(-np.abs(values), kind="stable")]
    miss = np.concatenate([passage.x - x, passage.v - v])[use]
    final = propagate(packed, x, v, multiple * packed.period, tolerance=1e-13, peaks=True)
    growth = math.log(max(abs(values[0]), 1e-300)) / multiple
    return SteadyState(
        packed.model, "periodic", multiple, values, growth, final.largest, final.smallest, final.tooth_force,
        final.apart, final.behind, final.changes, float(np.max(np.abs(miss))), x, v,
    )  # fmt: skip


def _search(packed: Packed, x: Array, v: Array, step: float) -> SteadyState:
    """Let the motion run until it repeats, or measure how it does not."""
    use = _moving(packed)
    past: list[Array] = []
    for period in range(SEARCH):
        passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=False)
        x, v = passage.x, passage.v
        past.append(np.concatenate([x, v])[use])
        if np.max(np.abs(past[-1])) > UNBOUNDED:
            raise RangeError(
                "speed",
                f"{packed.model.speed:.9g} rad/s",
                "lets the motion grow without bound: the varying mesh stiffness feeds it more than damping takes",
                "give the meshes damping or leave this speed out",
            )
        if period < 20 or period % 20 != 0:
            continue
        for multiple in range(1, LONGEST_MULTIPLE + 1):
            # close to itself is worth a try; Newton decides
            if multiple >= len(past) or np.max(np.abs(past[-1] - past[-1 - multiple])) > 0.2:
                continue
            found = _close(packed, x, v, multiple, step)
            if found is not None and _radius(packed, found[2]) <= 1.0 + UNSTABLE:
                near = np.max(np.abs(np.concatenate([found[0] - x, found[1] - v])[use]))
                if near <= 0.5:
                    return _periodic(packed, *found, multiple)
    return _measure(packed, x, v, step)


def _measure(packed: Packed, x: Array, v: Array, step: float) -> SteadyState:
    """Forces and growth of tangents over a long stretch of motion that does not repeat."""
    use = np.flatnonzero(_moving(packed))
    frame = np.eye(use.size)
    first = x, v
    total, parts = 0.0, []
    for _ in range(MEASURED):
        passage = propagate(packed, x, v, packed.period, tolerance=step, tangents=True)
        frame, upper = np.linalg.qr(passage.tangent[np.ix_(use, use)] @ frame)
        total += math.log(max(abs(upper[0, 0]), 1e-300))
        x, v = passage.x, passage.v
        parts.append(passage)
    growth = total / MEASURED
    # on a torus neighbours neither part nor close in; where they close in, the motion repeats after all
    settled = "quasi-periodic" if growth > -CHAOTIC_GROWTH else "long-period"
    kind = "chaotic" if growth > CHAOTIC_GROWTH else settled
    return SteadyState(
        packed.model, kind, 0, np.zeros(0, dtype=complex), growth,
        np.max([p.largest for p in parts], axis=0), np.min([p.smallest for p in parts], axis=0),
        np.max([p.tooth_force for p in parts], axis=0), np.mean([p.apart for p in parts], axis=0),
        np.mean([p.behind for p in parts], axis=0), sum(p.changes for p in parts),
        float(np.max(np.abs(np.concatenate([x - first[0], v - first[1]])[use]))), *first,
    )  # fmt: skip


def speed_sweep(
    model: MotionModel,
    speeds: Sequence[float] | Array,
    *,
    start: str = "follow",
    tolerance: float = 1e-6,
) -> tuple[SteadyState, ...]:
    """Steady motions over speeds [rad/s] in the given order.

    Parameters
    ----------
    model : MotionModel
        What moves; its own speed is not used.
    speeds : sequence of float
        In the order in which they are run; run them up and down to see hysteresis.
    start : {"follow", "static", "rest"}
        Whether each speed starts from the motion of the one before, or afresh.
    tolerance : float
        Accuracy of the largest forces, beside the mean force.
    """
    found: list[SteadyState] = []
    begin: str | tuple[Array, Array] = "static" if start == "follow" else start
    for speed in speeds:
        state = steady_state(model.at_speed(float(speed)), start=begin, tolerance=tolerance)
        found.append(state)
        if start == "follow":
            begin = (state.x, state.v)
    return tuple(found)
