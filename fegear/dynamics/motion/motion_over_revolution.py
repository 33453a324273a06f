"""A mesh of a moving train until the same teeth mesh again: its transmission error, force and acceleration in time.

The motion is averaged in step with the teeth (as in vibration monitoring), so that what repeats otherwise is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from fegear.dynamics.train.mesh_resonance import MeshResonance

#: Even samples over a base pitch, and over all of them at most (but so many a base pitch at least).
_SAMPLES, _MOST, _FEWEST = 128, 20_000, 16
#: Parts of a sample in which maxima are looked for.
_PARTS = 8
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
class RevolutionErrors:
    """Estimated errors of a `MotionOverRevolution`, by the names of its quantities.

    Parameters
    ----------
    te, te_residual, te_change, force, acceleration : ndarray, shape (M,)
        [m], [N], [m/s^2].
    te_order, force_order, acceleration_order : ndarray, shape (N,)
        Of the amplitudes of its orders.
    mesh_force_max, mesh_force_max_ordinary, dynamic_te_change_max, dynamic_te_residual_max : float
    indicators : ConditionIndicators
    """

    te: Array
    te_residual: Array
    te_change: Array
    force: Array
    acceleration: Array
    te_order: Array
    force_order: Array
    acceleration_order: Array
    mesh_force_max: float
    mesh_force_max_ordinary: float
    dynamic_te_change_max: float
    dynamic_te_residual_max: float
    indicators: ConditionIndicators


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
    fine_te, fine_force : ndarray
        Transmission error and mesh force at eight times as many samples, for their maxima [m], [N].
    errors : RevolutionErrors, optional
        Estimated; of a motion that repeats, with teeth whose errors are stated.
    resonance : MeshResonance, optional
        Of the mesh, and how near the speed is to it.
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
    fine_te: Array = field(kw_only=True)
    fine_force: Array = field(kw_only=True)
    errors: RevolutionErrors | None = None
    resonance: MeshResonance | None = None

    @property
    @shows("N", "maximum mesh force over the base pitches")
    def mesh_force_max(self) -> float:
        """[N]."""
        return float(self.fine_force.max())

    @property
    @shows("N", "maximum mesh force in an ordinary base pitch")
    def mesh_force_max_ordinary(self) -> float:
        """[N]."""
        return float(self._ordinary(self.fine_force).max())

    @cached_property
    @shows(
        "um",
        "dynamic transmission error minus that of an ordinary base pitch",
        label="change from an ordinary base pitch",
        table="revolution",
    )
    def te_change(self) -> Array:
        """Less the median of all base pitches, as the residual of a pair at rest is defined, shape (M,) [m]."""
        return self._change(self.te)

    @property
    @shows("um", "maximum change: dynamic transmission error minus that of an ordinary base pitch")
    def dynamic_te_change_max(self) -> float:
        """[m]."""
        return float(self.fine_change.max())

    @cached_property
    def fine_change(self) -> Array:
        """Amount of `te_change` at the fine samples [m]."""
        return np.abs(self._change(self.fine_te))

    @cached_property
    def fine_residual(self) -> Array:
        """Amount of `te_residual` at the fine samples [m]."""
        return np.abs(without_mesh_harmonics(self.fine_te, self.cycles))

    def _change(self, values: Array) -> Array:
        return np.asarray((values.reshape(self.cycles, -1) - self._ordinary(values)).ravel())

    def _ordinary(self, values: Array) -> Array:
        """Of an ordinary base pitch: the median of all, sample by sample."""
        return np.asarray(np.median(values.reshape(self.cycles, -1), axis=0))

    @property
    @shows("um", "maximum residual of the dynamic transmission error")
    def dynamic_te_residual_max(self) -> float:
        """[m]."""
        return float(self.fine_residual.max())

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
    state: SteadyState, mesh: int, pair: GearPair, cycles: int, phase: float, *, tolerance: float = 1e-10
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
    tolerance : float
        Of the steps through the motion.
    """
    trajectory = state.trajectory(tolerance=tolerance)
    model = state.model
    frequency = float(model.parts().frequency[mesh])
    samples = max(_FEWEST, min(_SAMPLES, _MOST // cycles))
    duration = trajectory.duration
    averaged = max(1, round(duration * frequency / cycles))
    s = np.arange(averaged * cycles * samples * _PARTS) / (samples * _PARTS)
    time = np.mod((s - phase) / frequency, duration)

    def mean(values: Array) -> Array:
        return np.asarray(values.reshape(averaged, -1).mean(axis=0))

    fine_te = mean(trajectory.approach(time, 0)[:, mesh])
    fine_force = mean(trajectory.mesh_forces(time)[:, mesh])
    acceleration = mean(trajectory.approach(time[::_PARTS], 2)[:, mesh])
    te, force = fine_te[::_PARTS], fine_force[::_PARTS]
    turned = s[: cycles * samples * _PARTS : _PARTS]
    return MotionOverRevolution(
        pair, cycles, frequency, averaged, state.repeats, _TURN / pair.driver.teeth * turned, turned / frequency, te,
        without_mesh_harmonics(te, cycles), force, acceleration, float(state.behind[mesh]),
        fine_te=fine_te, fine_force=fine_force,
    )  # fmt: skip
