"""A planetary set in motion until the same teeth mesh again: transmission error and mesh forces in time.

The motion is averaged in step with the teeth (as in vibration monitoring), so that what repeats otherwise is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.plane.sidebands import without_mesh_harmonics
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_signals import SetSignals

if TYPE_CHECKING:
    from fegear.contact.plane.sidebands import ConditionIndicators
    from fegear.dynamics.motion.steady_state import SteadyState
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_model import SetModel
    from fegear.dynamics.planetary.set_motion import SetMotion
    from fegear.dynamics.planetary.set_signals import RingLines, SetOrders

#: Even samples over a base pitch: whole parts for three to six planets, whose lines cancel then; and over all base
#: pitches at most, but so many a base pitch at least.
_SAMPLES, _MOST, _FEWEST = 240, 40_000, 60


@dataclass(frozen=True)
class SetMotionOverRevolution:
    """A steady motion of a set over C base pitches, even samples, M of them.

    Parameters
    ----------
    signals : SetSignals
    averaged : int
        Over how many times C base pitches the motion is averaged.
    kind : str
        That of the motion (`SteadyState`).
    apart : float
        Longest share of the time without contact of any mesh.
    mesh_force_max : float
        Between samples as well [N].
    """

    signals: SetSignals
    averaged: int
    kind: str
    apart: float = shown("", "maximum time fraction without contact of any mesh")
    mesh_force_max: float = shown("N", "maximum mesh force of a planet, at sun or ring")
    s: Array = shown("", "mesh position, in base pitches of the sun mesh of the first planet")
    time: Array = shown("s", "time", name="t")
    te: Array = shown(
        "um", "dynamic transmission error of the set, at the base circle of the driving member or at the pins"
    )
    te_residual: Array = shown("um", "dynamic transmission error without its mesh harmonics", label="residual")
    acceleration: Array = shown("m/s^2", "second time derivative of the dynamic transmission error")

    @property
    def base_pitches(self) -> int:
        """C."""
        return self.signals.base_pitches

    @property
    def mesh_force(self) -> Array:
        """At sun (0) and ring (1) [N], shape (2, planets, M)."""
        return self.signals.mesh_force

    @property
    @shows("um", "maximum residual of the dynamic transmission error")
    def dynamic_te_residual_max(self) -> float:
        """[m]."""
        return float(np.abs(self.te_residual).max())

    @property
    def orders(self) -> SetOrders:
        """Lines up to eight mesh harmonics."""
        return self.signals.orders

    @cached_property
    def indicators(self) -> ConditionIndicators:
        """Condition indicators of the dynamic transmission error."""
        return self.signals.indicators

    @property
    def at_ring(self) -> RingLines:
        """What a pick-up on the ring sees of the mesh forces as the planets pass it."""
        return self.signals.at_ring


def transmission_error_row(model: SetModel, driving: Central) -> Array:
    """Row that turns coordinates into the transmission error of a set, shape (size,).

    How far the driving member turns ahead of the rigid motion of all members: the rotations that the outer torques
    work on, over what the driving member has of them. Rigid motion of the set leaves it zero.
    """
    work = model.torque_load(1.0)
    return work / abs(work[3 * CENTRALS.index(driving) + 2])


def set_motion_over_revolution(
    run: SetMotion, state: SteadyState, odd_planet: int, teeth: tuple[int, ...], clockwise: bool
) -> SetMotionOverRevolution:
    """A steady motion of a set over all base pitches until the same teeth mesh again.

    Parameters
    ----------
    run : SetMotion
    state : SteadyState
        Its motion.
    odd_planet : int
        The planet that has the odd teeth of the planets, from 0.
    teeth : tuple of int
        Numbers of teeth of the gears with odd teeth.
    clockwise : bool
        Whether the sun turns clockwise relative to the carrier.
    """
    meshed, frequency = run.linear.meshed, run.mesh_frequency
    model = meshed.model
    trajectory = state.trajectory()
    cycles = round(run.period * frequency)
    samples = max(_FEWEST, min(_SAMPLES, _MOST // cycles))
    averaged = max(1, round(trajectory.duration * frequency / cycles))
    s = np.arange(averaged * cycles * samples) / samples
    time = np.mod(s / frequency, trajectory.duration)

    def mean(values: Array) -> Array:
        """Over the times C base pitches, shape (..., M)."""
        return np.asarray(values.T.reshape(*values.shape[1:], averaged, -1).mean(axis=-2))

    row = transmission_error_row(model, meshed.driving)
    te, acceleration = (mean(trajectory.angles(time, order) @ row) for order in (0, 2))
    force = mean(trajectory.mesh_forces(time)).reshape(2, model.count, -1)
    turned = s[: cycles * samples]
    signals = SetSignals(model.found, cycles, odd_planet, teeth, frequency, clockwise, meshed.mean_force, te, force)
    return SetMotionOverRevolution(
        signals, averaged, state.kind, float(state.apart.max()), float(state.largest.max()), turned,
        turned / frequency, te, without_mesh_harmonics(te, cycles), acceleration,
    )  # fmt: skip
