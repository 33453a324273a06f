"""A mesh of a moving train until the same teeth mesh again: its transmission error, force and acceleration in time.

The motion is averaged in step with the teeth (as in vibration monitoring), so that what repeats otherwise is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.shown import shown, shows
from fegear.contact.plane.sidebands import (
    HIGHEST,
    ConditionIndicators,
    amplitudes,
    indicators_of,
    without_mesh_harmonics,
)
from fegear.dynamics.motion.steady_state import SteadyState
from fegear.geometry.pair import MEMBERS, GearPair

#: Even samples over a base pitch, and over all of them at most (but so many a base pitch at least).
_SAMPLES, _MOST, _FEWEST = 128, 20_000, 16
_TURN = 2.0 * math.pi


@dataclass(frozen=True)
class MotionOrders:
    """Lines of a mesh over C base pitches, by their number n = 1..N."""

    n: Index = shown("", "harmonic of all base pitches until the same teeth mesh again", table="orders")
    mesh_order: Array = shown("", "order of the tooth-mesh frequency", table="orders")
    frequency: Array = shown("Hz", "frequency of the line", table="orders")
    te: Array = shown("um", "amplitude of the dynamic transmission error", label="transmission error", table="orders")
    force: Array = shown("N", "amplitude of the mesh force", label="mesh force", table="orders")
    acceleration: Array = shown(
        "m/s^2", "amplitude of the acceleration along the line of action", label="acceleration", table="orders"
    )


@dataclass(frozen=True)
class MotionOverRevolution:
    """A mesh over C base pitches, one sample after the other.

    Parameters
    ----------
    pair : GearPair
        As it runs.
    cycles : int
        C.
    frequency : float
        Tooth-mesh frequency [Hz].
    averaged : int
        Over how many times C base pitches the motion is averaged.
    repeats : bool
        Whether it repeats.
    behind : float
        Share of the time in which the non-working flanks carry load.
    """

    pair: GearPair
    cycles: int
    frequency: float
    averaged: int
    repeats: bool
    driver_angle: Array = shown(
        "deg",
        "rotation of the driver, zero with the first teeth in contact at the pitch point",
        label="rotation of the driver",
        table="revolution",
    )
    time: Array = shown("s", "time", table="revolution", name="t")
    te: Array = shown(
        "um",
        "dynamic transmission error (approach of the gears)",
        label="dynamic transmission error",
        table="revolution",
    )
    te_residual: Array = shown("um", "dynamic transmission error without its mesh harmonics", table="revolution")
    force: Array = shown("N", "mesh force with damping", label="mesh force", table="revolution")
    acceleration: Array = shown("m/s^2", "acceleration along the line of action", table="revolution")
    behind: float = 0.0

    @property
    @shows("N", "maximum mesh force over the base pitches")
    def mesh_force_max(self) -> float:
        """[N]."""
        return float(self.force.max())

    @property
    @shows("N", "maximum mesh force in an ordinary base pitch")
    def mesh_force_max_ordinary(self) -> float:
        """[N]."""
        return float(self._ordinary(self.force).max())

    @cached_property
    @shows(
        "um",
        "dynamic transmission error minus that of an ordinary base pitch",
        label="change from an ordinary base pitch",
        table="revolution",
    )
    def te_change(self) -> Array:
        """Less the median of all base pitches, as the residual of a pair at rest is defined, shape (M,) [m]."""
        return np.asarray((self.te.reshape(self.cycles, -1) - self._ordinary(self.te)).ravel())

    @property
    @shows("um", "maximum change: dynamic transmission error minus that of an ordinary base pitch")
    def dynamic_te_change_max(self) -> float:
        """[m]."""
        return float(np.abs(self.te_change).max())

    def _ordinary(self, values: Array) -> Array:
        """Of an ordinary base pitch: the median of all, sample by sample."""
        return np.asarray(np.median(values.reshape(self.cycles, -1), axis=0))

    @property
    @shows("um", "maximum residual of the dynamic transmission error")
    def dynamic_te_residual_max(self) -> float:
        """[m]."""
        return float(np.abs(self.te_residual).max())

    @cached_property
    def orders(self) -> MotionOrders:
        """Lines up to eight mesh harmonics."""
        n = np.arange(1, HIGHEST * self.cycles + 1)
        lines = [amplitudes(one, n.size) for one in (self.te, self.force, self.acceleration)]
        return MotionOrders(n, n / self.cycles, n * self.frequency / self.cycles, *lines)

    @cached_property
    def indicators(self) -> ConditionIndicators:
        """Condition indicators of the dynamic transmission error."""
        teeth = [self.pair.gear(member).teeth for member in MEMBERS]
        return indicators_of(self.te, self.cycles, teeth)


def motion_over_revolution(
    state: SteadyState, mesh: int, pair: GearPair, cycles: int, phase: float
) -> MotionOverRevolution:
    """A steady motion as a mesh sees it over a number of base pitches.

    Parameters
    ----------
    state : SteadyState
    mesh : int
        Number of the mesh in its train.
    pair : GearPair
        As it runs.
    cycles : int
        Base pitches after which its excitation repeats.
    phase : float
        Its phase at time zero [base pitches].
    """
    trajectory = state.trajectory()
    model = state.model
    frequency = float(model.parts().frequency[mesh])
    samples = max(_FEWEST, min(_SAMPLES, _MOST // cycles))
    duration = trajectory.duration
    averaged = max(1, round(duration * frequency / cycles))
    s = np.arange(averaged * cycles * samples) / samples
    time = np.mod((s - phase) / frequency, duration)

    def mean(values: Array) -> Array:
        return np.asarray(values.reshape(averaged, -1).mean(axis=0))

    te, acceleration = (mean(trajectory.approach(time, order)[:, mesh]) for order in (0, 2))
    force = mean(trajectory.mesh_forces(time)[:, mesh])
    turned = s[: cycles * samples]
    return MotionOverRevolution(
        pair, cycles, frequency, averaged, state.repeats, _TURN / pair.driver.teeth * turned, turned / frequency, te,
        without_mesh_harmonics(te, cycles), force, acceleration, float(state.behind[mesh]),
    )  # fmt: skip
