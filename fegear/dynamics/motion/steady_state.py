"""Steady motion: Newton on the state after a period, Floquet multipliers, motion that does not repeat.

A train whose teeth never part is linear and is closed in one Newton step, exactly; if its motion grows, it has no
steady motion, and the answer says by how much it grows. With contact loss the motion runs from its start until it
stands in the neighbourhood of a stable motion of up to 32 periods, which Newton closes. An unstable motion is never
reported. What comes near none is followed until it spreads no further, and measured over many periods.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.errors import RangeError
from fegear.base.tally import tallied
from fegear.dynamics.motion.coexisting import (
    CHAOTIC_GROWTH,
    CHAOTIC_PATIENCE,
    LONGEST_WINDOW,
    PATIENCE,
    WINDOW,
    Window,
    drifting,
    follow,
    growth,
    recurrences,
    stable_motions,
)
from fegear.dynamics.motion.effort import Effort, effort_for
from fegear.dynamics.motion.motion import Trajectory, propagate, starting_state
from fegear.dynamics.motion.motion_model import Moving
from fegear.dynamics.motion.packed_model import Packed, pack
from fegear.dynamics.motion.shooting import Orbit, close, leads_to, leap, moving

#: Most periods of excitation that one period of the motion may take.
LONGEST_MULTIPLE = 32
#: Periods integrated before Newton starts, how often they are doubled, and periods that measure what never repeats.
SETTLING, DOUBLINGS, MEASURED = 12, 5, 1000
#: Periods after which motions of more than two periods are looked for.
LATER = 80
#: Longest transient without changes of contact that is followed to see whether contact changes on the way.
TRANSIENT = 100
#: Motion so many times that of a static deflection in the time of the fastest mode grows for ever: no train holds that.
UNBOUNDED = 1e5


@dataclass(frozen=True)
class SteadyState:
    """Steady motion of a train at one speed, stable; or that there is none, and by how much motions grow.

    Attributes
    ----------
    model : Moving
        What moves.
    kind : str
        "periodic", "quasi-periodic", "chaotic", "long-period" (comes back, but after more than 32 periods),
        "not settled" (still changing when the effort of `motion.effort` was spent, or after 60,000 periods, a chaotic
        motion after 12,000), or "growing" (without bound: forces are infinite); of the averaging iteration
        (`averaging`) also "unstable".
    periods : int
        Periods of the excitation after which the motion repeats; 0 if it does not.
    multipliers : ndarray, complex
        Floquet multipliers of the motion (of the motion that others grow away from), largest first; empty if it does
        not repeat.
    growth : float
        Logarithm of the largest multiplier per period of excitation, or the largest Lyapunov exponent.
    largest, smallest : ndarray, shape (meshes,)
        Largest and smallest mesh force [N]; negative on the back flanks.
    tooth_force : ndarray, shape (meshes,)
        Largest force on one tooth pair [N].
    apart, behind : ndarray, shape (meshes,)
        Share of the time without contact and on the back flanks.
    changes : int
        Changes of contact in the motion's period (in the measured periods if it does not repeat).
    residual : float
        What the motion misses closing by, relative to the static deflection; nan if it does not repeat.
    x, v : ndarray
        State at time zero, in the coordinates of `motion.pack`.
    per_period : ndarray, shape (N, meshes)
        Largest force on one tooth pair [N] in each of the N periods of excitation that were measured: a sample of a
        motion that does not repeat, one row of a motion that does.
    drift : float
        Change of the spread of a motion that does not repeat from its last window to the measured periods, as a share.
    coexisting : tuple of SteadyState
        Stable motions that repeat and exist at this speed with one that does not (those that were found, not all).
    followed : int
        Periods of excitation that a motion which does not repeat was followed before it was measured, or repetitions
        of the averaging iteration (`averaging`), which leave start and end of a period apart by `residual`.
    off : float
        What the difference that the averaging iteration leaves may change of the largest tooth force, relative to the
        mean mesh force.
    """

    model: Moving
    kind: str
    periods: int
    multipliers: Complex
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
    per_period: Array
    drift: float = 0.0
    coexisting: tuple[SteadyState, ...] = ()
    followed: int = 0
    off: float = 0.0

    @property
    def multiplier(self) -> float:
        """By how much what lies beside the motion grows over one period of excitation; above one, nothing holds it."""
        return math.exp(min(self.growth, 700.0))

    @property
    def repeats(self) -> bool:
        """Whether the motion repeats: only then do its largest forces have a tolerance."""
        return self.kind == "periodic"

    @property
    def measured(self) -> int:
        """Periods of excitation that the largest forces are taken over: those after which it repeats, or N."""
        return self.periods or (0 if self.kind == "growing" else int(self.per_period.shape[0]))

    def quantile(self, share: float) -> Array:
        """Force on one tooth pair [N] that so large a share of the periods does not exceed, shape (meshes,).

        Of a motion that repeats, its largest. Always a force that occurs, never one between two that do.
        """
        return np.asarray(np.quantile(self.per_period, share, axis=0, method="inverted_cdf"))

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
                "use `largest` and `tooth_force` for an idling gear pair",
            )  # fmt: skip
        return self.model.static

    def trajectory(self, periods: int = 0, *, tolerance: float = 1e-10) -> Trajectory:
        """The motion over its period, or over a number of periods of excitation."""
        packed = pack(self.model)
        count = periods or max(self.periods, 1)
        length = count * packed.period
        # steps end where pieces of a stiffness do
        ends = float(np.diff(packed.first) @ packed.rate) * length
        passage = propagate(
            packed, self.x, self.v, length, tolerance=tolerance, record=1000 * count + int(8 * length + 2 * ends),
            peaks=False,
        )  # fmt: skip
        return Trajectory(packed, passage)


@tallied("steady motions")
def steady_state(
    model: Moving,
    *,
    start: str | tuple[Array, Array] = "static",
    tolerance: float = 1e-6,
    settling: int = SETTLING,
    measured: int = MEASURED,
    progress: Callable[[float], None] | None = None,
) -> SteadyState:
    """Find the steady motion that a start leads to.

    Parameters
    ----------
    model : Moving
        What moves.
    start : {"static", "rest"} or (x, v)
        Where the motion begins; a state of another speed continues its branch.
    tolerance : float
        Accuracy of the largest forces of a repeating motion, relative to the mean force; steps and closure stay well
        below it.
    settling : int
        Periods integrated before Newton (when contact is lost).
    measured : int
        Periods over which a motion that does not repeat is measured; fewer of one that is not settled, if they are
        long.
    progress : callable, optional
        Told the share of the most effort that is spent, while a motion takes long.

    Raises
    ------
    RangeError
        If the tolerance is out of range, or a train without damping is at resonance.
    """
    step = step_for(tolerance)
    packed = pack(model)
    x, v = starting_state(packed, start)
    if not np.any(packed.side):
        return _linear(packed, x, v, step)
    passage = propagate(packed, x, v, packed.period, tolerance=step, peaks=False)
    if passage.changes == 0:
        orbit = close(packed, x, v, 1, step)
        if orbit is not None and orbit.passage.changes == 0:
            if not orbit.stable:
                x, v = leap(orbit, x, v, step)
            elif _keeps_contact(orbit, x, v, step):
                return periodic_motion(orbit)
    run, periods = 0, max(settling, 1)
    states = np.zeros((0, int(moving(packed).sum())))
    ahead: Orbit | None = None
    for _ in range(DOUBLINGS + 1):
        window = follow(packed, x, v, periods, step, peaks=False)
        x, v = window.x, window.v
        if not _bounded(packed, window):
            return growing_motion(packed, step)
        states = np.concatenate([states, window.states])
        # one seen from the window before: one look shows whether the motion is near it now
        if ahead is not None and periods % ahead.periods == 0 and leads_to(ahead, x, v, step):
            return periodic_motion(ahead)
        found, ahead, (x, v) = _settled(packed, states, x, v, step)
        if found is not None:
            return found
        run += periods
        periods = run
    return _wander(packed, x, v, step, measured, effort_for(packed, passage.steps * packed.size, progress))


def step_for(tolerance: float) -> float:
    """Tolerance of a step of the integration [static deflections], well below that of the largest forces.

    Raises
    ------
    RangeError
        If the tolerance is out of range.
    """
    if not 1e-13 < tolerance <= 1e-2:
        raise RangeError("tolerance", tolerance, "must be between 1e-13 and 1e-2")
    return max(1e-3 * tolerance, 1e-14)


def growing_motion(packed: Packed, step: float) -> SteadyState:
    """No steady motion, and by how much a motion that starts at rest under the load grows."""
    return _growing(packed, growth(packed, *starting_state(packed, "static"), step))


def _linear(packed: Packed, x: Array, v: Array, step: float) -> SteadyState:
    """Steady motion of teeth that never part: the one fixed point, if motions tend to it."""
    orbit = close(packed, x, v, 1, step)
    if orbit is None:
        return _growing(packed, growth(packed, x, v, step))
    if not orbit.stable:
        return _growing(packed, math.log(orbit.radius), orbit.multipliers)
    return periodic_motion(orbit)


def _keeps_contact(orbit: Orbit, x: Array, v: Array, step: float) -> bool:
    """Whether contact does not change on the way from a start to an orbit on which it does not."""
    use = moving(orbit.packed)
    far = float(np.max(np.abs(np.concatenate([x, v])[use] - orbit.state)))
    shrinks = -math.log(max(orbit.radius, 1e-300))
    # what is left of the way after so many periods is a thousandth of the static deflection
    needed = math.log(max(far, 1e-3) / 1e-3) / shrinks if shrinks > 0.0 else math.inf
    periods = math.ceil(min(needed, TRANSIENT))
    if periods <= 1:
        return True
    way = propagate(orbit.packed, x, v, periods * orbit.packed.period, tolerance=step, peaks=False)
    return way.changes == 0


def _growing(packed: Packed, rate: float, multipliers: Complex | None = None) -> SteadyState:
    """No steady motion: the varying mesh stiffness feeds it more than damping takes, so much a period (logarithm)."""
    meshes = packed.damping.size
    x, v = starting_state(packed, "static")
    endless, none = np.full(meshes, math.inf), np.zeros(meshes)
    return SteadyState(
        packed.model, "growing", 0, np.zeros(0, dtype=complex) if multipliers is None else multipliers, rate, endless,
        -endless, endless, none, none, 0, math.nan, x, v, endless[None, :],
    )  # fmt: skip


def _bounded(packed: Packed, window: Window) -> bool:
    """Whether velocities stay in bounds; distances may be large, while teeth that struck each other fly apart."""
    velocities = window.states[:, int(packed.free.sum()) :]
    return bool(np.all(np.isfinite(window.states)) and np.max(np.abs(velocities)) <= UNBOUNDED)


def _settled(
    packed: Packed, states: Array, x: Array, v: Array, step: float
) -> tuple[SteadyState | None, Orbit | None, tuple[Array, Array]]:
    """The stable motion of up to 32 periods that a motion has come to, if any; else a stable one that may lie ahead.

    Last, from where to follow the motion further.

    Beside an unstable orbit growth may take very long: as far as it is linear it is leapt over, once none of the
    orbits is what the motion has come to. (A motion of two periods that has just grown out of one lies so near to it
    that the unstable one, tried first, would take the motion away from where it stands.)
    """
    ahead: Orbit | None = None
    unstable = []
    # a vibration that still dies away seems to come back after its own period: long ones are for later
    longest = LONGEST_MULTIPLE if states.shape[0] >= LATER else 2
    for multiple in recurrences(states, longest, 0.2):
        orbit = close(packed, x, v, multiple, step)
        if orbit is None:
            continue
        if not orbit.stable:
            unstable.append(orbit)
        elif leads_to(orbit, x, v, step):
            return periodic_motion(orbit), orbit, (x, v)
        else:
            ahead = orbit
    for orbit in unstable:
        after = leap(orbit, x, v, step)
        if after[0] is not x:
            return None, ahead, after
    return None, ahead, (x, v)


def periodic_motion(orbit: Orbit) -> SteadyState:
    """The motion that closes on an orbit, over the fewest periods after which it does."""
    packed, x, v = orbit.packed, orbit.x, orbit.v
    use = moving(packed)
    for divisor in range(1, orbit.periods):
        if orbit.periods % divisor:
            continue
        # a motion of period 1 also closes after 2: report the shortest
        short = propagate(packed, x, v, divisor * packed.period, tolerance=1e-13, peaks=False, tangents=True)
        miss = float(np.max(np.abs(np.concatenate([short.x - x, short.v - v])[use])))
        if miss < 1e-5:
            orbit = Orbit(packed, x, v, divisor, short, miss)
            break
    final = propagate(packed, x, v, orbit.periods * packed.period, tolerance=1e-13, peaks=True)
    return SteadyState(
        packed.model, "periodic", orbit.periods, orbit.multipliers,
        math.log(max(orbit.radius, 1e-300)) / orbit.periods, final.largest, final.smallest, final.tooth_force,
        final.apart, final.behind, final.changes, orbit.miss, x, v, final.tooth_force[None, :],
    )  # fmt: skip


def _wander(packed: Packed, x: Array, v: Array, step: float, measured: int, effort: Effort) -> SteadyState:
    """Follow a motion that came to no orbit until it settles, stays as it is or the effort is spent, and measure it."""
    rate = growth(packed, x, v, step)
    window = follow(packed, x, v, WINDOW, step, peaks=False, effort=effort)
    run, sample = WINDOW, None
    while sample is None and run < (CHAOTIC_PATIENCE if rate > CHAOTIC_GROWTH else PATIENCE):
        if not _bounded(packed, window):
            return _growing(packed, rate)
        found, _, (x, v) = _settled(packed, window.states, window.x, window.v, step)
        if found is not None:
            return found
        length = min(2 * window.states.shape[0], LONGEST_WINDOW)
        if length > effort.left:  # a shorter window than the one before says nothing of a drift
            break
        before, window = window, follow(packed, x, v, length, step, peaks=False, effort=effort)
        run += length
        chaotic = rate > CHAOTIC_GROWTH
        if drifting(before, window, chaotic=chaotic):
            continue
        rate = growth(packed, window.x, window.v, step, WINDOW if chaotic else 4 * WINDOW)
        # growth may be that of a transient: only what still grows is chaotic
        if chaotic and rate <= CHAOTIC_GROWTH:
            continue
        sample = follow(packed, window.x, window.v, measured, step, peaks=True)
        # chaos may spread on and on, in leaps that a window misses: what is measured must lie as the window before
        if chaotic and drifting(window, sample, chaotic=True):
            window, sample = sample, None
            run += measured
    kind = "not settled" if sample is None else _kind(rate)
    if sample is None:
        # what is still on its way is shown, not measured: not longer than it was followed
        sample = follow(packed, window.x, window.v, min(measured, run), step, peaks=True)
    if not _bounded(packed, sample):
        return _growing(packed, rate)
    if kind != "chaotic":
        found, _, _ = _settled(packed, sample.states, sample.x, sample.v, step)
        if found is not None:
            return found
    return replace(_measured(packed, kind, rate, window, sample, step), followed=run)


def _kind(rate: float) -> str:
    """What a motion is that neither repeats nor drifts, by its growth: on a torus neighbours neither part nor close in.

    Where they close in, the motion repeats after all, if after more periods than were looked at.
    """
    if rate > CHAOTIC_GROWTH:
        return "chaotic"
    return "quasi-periodic" if rate > -CHAOTIC_GROWTH else "long-period"


def _measured(
    packed: Packed, kind: str, rate: float, window: Window, sample: Window, step: float
) -> SteadyState:  # fmt: skip
    """A motion that does not repeat, from what a sample of its periods did."""
    parts = sample.passages
    per_period = np.array([p.tooth_force for p in parts])
    beside = tuple(periodic_motion(orbit) for orbit in stable_motions(packed.model, step))
    return SteadyState(
        packed.model, kind, 0, np.zeros(0, dtype=complex), rate,
        np.max([p.largest for p in parts], axis=0), np.min([p.smallest for p in parts], axis=0),
        np.max(per_period, axis=0), np.mean([p.apart for p in parts], axis=0),
        np.mean([p.behind for p in parts], axis=0), sum(p.changes for p in parts), math.nan, window.x, window.v,
        per_period, sample.spread / max(window.spread, 1e-9) - 1.0, beside,
    )  # fmt: skip


def speed_sweep(
    model: Moving,
    speeds: Sequence[float] | Array,
    *,
    start: str = "follow",
    tolerance: float = 1e-6,
) -> tuple[SteadyState, ...]:
    """Steady motions over speeds [rad/s] in the given order.

    Parameters
    ----------
    model : Moving
        What moves; its own speed is not used.
    speeds : sequence of float
        In the order in which they are run; run them up and down to see hysteresis.
    start : {"follow", "static", "rest"}
        Whether each speed starts from the motion of the one before, or afresh.
    tolerance : float
        Accuracy of the largest forces, relative to the mean force.
    """
    found: list[SteadyState] = []
    begin: str | tuple[Array, Array] = "static" if start == "follow" else start
    for speed in speeds:
        state = steady_state(model.at_speed(float(speed)), start=begin, tolerance=tolerance)
        found.append(state)
        if start == "follow":
            begin = (state.x, state.v)
    return tuple(found)
