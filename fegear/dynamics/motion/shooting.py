"""Shooting: Newton on the state after some periods, Floquet multipliers, and whether a motion leads to an orbit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import ConvergenceError, RangeError
from fegear.dynamics.motion.motion import Passage, propagate
from fegear.dynamics.motion.packed_model import Packed

#: How far a multiplier may exceed one before the motion counts as unstable.
UNSTABLE = 1e-6
#: Growth per radian of the fastest mode that integration cannot distinguish from none (undamped trains: 7e-13).
RESOLVED = 2e-12
#: An orbit is where a motion leads if a period takes it there as its multipliers say: to this share of the way, and
#: not further from it than the static deflection.
BENT, NEAR = 0.1, 1.0
#: Share of the way below which it counts as straight, and longest way looked at.
STRAIGHT, FARTHEST = 1e-3, 1e3
#: Bend that round-off and the steps of the integration leave of a straight way.
LEAST_BENT = 1e-6
#: Distances from an orbit at which the motion is on it, relative to the static deflection.
ON_IT = 1e-6


@dataclass(frozen=True)
class Orbit:
    """A motion that closes after some periods of the excitation.

    Attributes
    ----------
    x, v : ndarray, shape (n,)
        State at time zero, in the units of `packed`.
    periods : int
        Periods of the excitation after which it closes.
    passage : Passage
        Over these periods, with the monodromy matrix.
    miss : float
        What it misses closing by.
    """

    packed: Packed
    x: Array
    v: Array
    periods: int
    passage: Passage
    miss: float

    @property
    def state(self) -> Array:
        """The part of (x, v) that matters for the motion."""
        return np.concatenate([self.x, self.v])[moving(self.packed)]

    @property
    def monodromy(self) -> Array:
        """Derivative of the state after the periods by the state before."""
        use = moving(self.packed)
        return self.passage.tangent[np.ix_(use, use)]

    @property
    def multipliers(self) -> Complex:
        """Floquet multipliers, largest first."""
        values = np.asarray(np.linalg.eigvals(self.monodromy), dtype=complex)
        return values[np.argsort(-np.abs(values), kind="stable")]

    @property
    def radius(self) -> float:
        """Largest size of a multiplier."""
        return float(abs(self.multipliers[0]))

    @property
    def stable(self) -> bool:
        """Whether no multiplier lies outside the unit circle."""
        return self.radius <= 1.0 + UNSTABLE + RESOLVED * self.packed.period * self.periods


def has_fixed_direction(monodromy: Array) -> bool:
    """Whether a period leaves some direction of the state where it is, to ten digits.

    Coordinates and velocities are put on scales of their own first: in units of the fastest mode a slow one's
    velocities are as small as the fastest one's inertia is, and would look like nothing.
    """
    from scipy.linalg import matrix_balance

    balanced, _ = matrix_balance(monodromy, permute=False)
    near = np.linalg.svd(balanced - np.eye(balanced.shape[0]), compute_uv=False)[-1]
    return bool(near <= 1e-10 * np.linalg.norm(balanced, 2))


def moving(packed: Packed) -> NDArray[np.bool_]:
    """Entries of the state (x, v) that matter for the motion: all but the free turning angle."""
    return np.concatenate([packed.free, np.ones(packed.size, dtype=bool)])


def close(packed: Packed, x: Array, v: Array, periods: int, step: float) -> Orbit | None:
    """Newton on the state after so many periods; None where it does not settle.

    Raises
    ------
    RangeError
        If the train is undamped at resonance and nothing parts.
    """
    use = moving(packed)
    n = packed.size
    y = np.concatenate([x, v])
    before, closed = math.inf, False
    for _ in range(16):
        try:
            passage = propagate(
                packed, y[:n], y[n:], periods * packed.period, tolerance=step, tangents=True, peaks=False
            )
        except ConvergenceError:
            return None
        miss = (np.concatenate([passage.x, passage.v]) - y)[use]
        size = float(np.max(np.abs(miss))) if miss.size else 0.0
        if closed:
            return Orbit(packed, y[:n].copy(), y[n:].copy(), periods, passage, size)
        if not np.isfinite(size) or size > 8.0 * before:
            return None
        before = size
        tangent = passage.tangent[np.ix_(use, use)]
        if not np.all(np.isfinite(tangent)):
            return None
        matrix = tangent - np.eye(int(use.sum()))
        if has_fixed_direction(tangent):
            if passage.changes == 0 and not np.any(passage.apart > 0.0) and not np.any(passage.behind > 0.0):
                raise RangeError(
                    "speed",
                    f"{packed.model.speed:.9g} rad/s",
                    "is an undamped resonance: no steady-state solution",
                    "specify damping or remove this speed",
                )
            return None
        change = np.linalg.solve(matrix, miss)
        y[use] -= change
        # what the last change leaves is of second order; round-off in the largest coordinate bounds it below
        largest = float(np.max(np.abs(y[use])))
        closed = bool(np.max(np.abs(change)) <= max(10.0 * step, 1e-12 * largest))
    return None


@dataclass(frozen=True)
class Way:
    """How a motion that stands beside an orbit goes on over the orbit's periods.

    Attributes
    ----------
    far : float
        Largest distance of a coordinate from the orbit, relative to the static deflection.
    bent : float
        Share of the distance by which the periods take it elsewhere than the monodromy matrix says.
    shrinks : float
        Distance after the periods over that before, along the Floquet directions.
    alike : bool
        Whether contact changes as often as on the orbit.
    """

    far: float
    bent: float
    shrinks: float
    alike: bool


def way_beside(orbit: Orbit, x: Array, v: Array, step: float) -> Way:
    """Follow a motion that stands at (x, v) over the periods of an orbit, and compare it with the multipliers."""
    packed, use = orbit.packed, moving(orbit.packed)
    away = np.concatenate([x, v])[use] - orbit.state
    far = float(np.max(np.abs(away)))
    if far <= ON_IT:
        return Way(far, 0.0, orbit.radius, alike=True)
    after = propagate(packed, x, v, orbit.periods * packed.period, tolerance=step, peaks=False)
    left = np.concatenate([after.x, after.v])[use] - orbit.state
    frame = floquet_frame(orbit.monodromy)
    size = float(np.linalg.norm(frame @ away))
    bent = float(np.linalg.norm(frame @ (left - orbit.monodromy @ away))) / size
    return Way(far, bent, float(np.linalg.norm(frame @ left)) / size, after.changes == orbit.passage.changes)


def leads_to(orbit: Orbit, x: Array, v: Array, step: float) -> bool:
    """Whether a motion that stands at (x, v) ends on a stable orbit.

    It does where the orbit's own multipliers already say how it comes nearer: the periods of the orbit shrink the
    distance, measured along its Floquet directions, at least half as fast as the slowest multiplier alone would, and
    what they leave is what the monodromy matrix leaves, to a tenth of the distance.
    """
    way = way_beside(orbit, x, v, step)
    if way.far <= ON_IT or way.bent <= straight(orbit):
        return True
    return way.far <= NEAR and way.bent <= BENT and way.shrinks <= 0.5 * (1.0 + min(orbit.radius, 1.0))


def straight(orbit: Orbit) -> float:
    """Share of the way by which it may bend and still count as straight: far less than the multipliers make of it.

    Next to a bifurcation neighbours hardly grow or shrink in a period, and a bend as small as that decides where they
    end: a motion of two periods round an unstable one of multiplier -1.0005 bends by five parts in 10,000.
    """
    return min(STRAIGHT, max(0.1 * abs(1.0 - orbit.radius), LEAST_BENT))


def floquet_frame(monodromy: Array) -> Complex:
    """Matrix into Floquet directions, in each of which a period multiplies; the identity if they all but coincide."""
    _, directions = np.linalg.eig(monodromy)
    if np.linalg.cond(directions) > 1e8:
        return np.eye(monodromy.shape[0], dtype=complex)
    return np.asarray(np.linalg.inv(directions), dtype=complex)


def leap(orbit: Orbit, x: Array, v: Array, step: float) -> tuple[Array, Array]:
    """Where growth beside an unstable orbit takes a motion while it still is linear; the same state if it is not.

    Powers of the monodromy matrix stand for as many periods. A start exactly on the orbit is moved off it by 1e-9 of
    the static deflection, as round-off would in time.
    """
    packed, use = orbit.packed, moving(orbit.packed)
    values, directions = np.linalg.eig(orbit.monodromy)
    away = np.concatenate([x, v])[use] - orbit.state
    grows = np.real(directions[:, int(np.argmax(np.abs(values)))])
    away = away + 1e-9 * grows / float(np.max(np.abs(grows)))

    def at(distance: Array) -> tuple[Array, Array]:
        y = np.concatenate([orbit.x, orbit.v])
        y[use] += distance
        return y[: packed.size], y[packed.size :]

    def linear(distance: Array) -> bool:
        # far out, where teeth touch on either flank, all is linear again: contact must change as on the orbit
        if not float(np.max(np.abs(distance))) < FARTHEST:
            return False
        way = way_beside(orbit, *at(distance), step)
        return way.alike and way.bent <= straight(orbit)

    if not linear(away):
        return x, v
    powers = [orbit.monodromy]
    while len(powers) < 40 and float(np.max(np.abs(powers[-1] @ away))) < FARTHEST:
        powers.append(powers[-1] @ powers[-1])
    for power in reversed(powers):
        if linear(power @ away):
            away = power @ away
    return at(away)
