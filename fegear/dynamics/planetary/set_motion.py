"""A planetary set in motion with contact loss: what the integrator of `dynamics.motion` takes of it.

Teeth are one-sided springs, each mesh delayed by its phase; all modes of the set about its mean load are damped alike.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.shown import shows
from fegear.dynamics.motion.effort import of_one
from fegear.dynamics.motion.motion_model import MotionParts
from fegear.dynamics.motion.steady_state import SteadyState, steady_state
from fegear.dynamics.planetary.set_response import LinearSet, forced_response
from fegear.dynamics.train.excitation import MeshExcitation


@dataclass(frozen=True)
class OddMeshes:
    """Meshes of a set some of whose teeth differ.

    Parameters
    ----------
    teeth : tuple of tuple of MeshExcitation
        Of each planet's mesh with the sun, and of each planet's with the ring, over the base pitches until the same
        teeth meet again.
    delays : ndarray, shape (2, planets)
        Whole ones (`whole_delays`) [base pitches].
    """

    teeth: tuple[tuple[MeshExcitation, ...], tuple[MeshExcitation, ...]]
    delays: Array

    @property
    def base_pitches(self) -> int:
        """Until the same teeth mesh again."""
        parts = (part for mesh in self.teeth for one in mesh for part in (*one.stiffness, *one.separation))
        return math.lcm(*(part.pitches for part in parts))


@dataclass(frozen=True)
class SetMotion:
    """A planetary set at one speed, as `steady_state` and `propagate` take it.

    Its meshes stand in the order sun 1, 2, ..., ring 1, 2, ...

    Parameters
    ----------
    linear : LinearSet
        With the damping ratio of its modes.
    mesh_frequency : float
        [Hz]
    pin_errors : ndarray, shape (2, planets), optional
        Radially outward and counter-clockwise [m].
    backlash : float
        Along the line of action of every mesh [m]; infinite where back flanks never touch.
    odd : OddMeshes, optional
        Where teeth differ; the modes and the mean stiffnesses are those of ordinary teeth.
    """

    linear: LinearSet
    mesh_frequency: float
    pin_errors: Array | None = None
    backlash: float = math.inf
    odd: OddMeshes | None = None

    def __post_init__(self) -> None:
        """Refuse standstill."""
        if not (math.isfinite(self.mesh_frequency) and self.mesh_frequency > 0.0):
            raise RangeError("speed", self.mesh_frequency, "must be positive", "use the static result for zero speed")

    @property
    def speed(self) -> float:
        """Angular frequency of the mesh [rad/s]: the speed that messages name."""
        return 2.0 * math.pi * self.mesh_frequency

    @property
    def period(self) -> float:
        """Of all excitations [s]: one mesh cycle, or as many as it takes until the same teeth mesh again."""
        return (1 if self.odd is None else self.odd.base_pitches) / self.mesh_frequency

    @cached_property
    def static(self) -> Array:
        """Mean mesh forces of planets that carry alike [N], shape (2 planets,)."""
        meshed = self.linear.meshed
        return np.repeat(meshed.mean_forces, meshed.model.count)

    def at_speed(self, speed: float) -> SetMotion:
        """The same at another angular frequency of the mesh [rad/s]."""
        return replace(self, mesh_frequency=speed / (2.0 * math.pi))

    def more_damped(self, factor: float) -> SetMotion:
        """The same with so many times the damping."""
        ratio = min(factor * self.linear.damping_ratio, 0.99)
        return replace(self, linear=replace(self.linear, damping_ratio=ratio))

    def parts(self) -> MotionParts:
        """The set in its modes; free turning of the whole set is not felt and stays out."""
        linear, meshed = self.linear, self.linear.meshed
        model, modes = meshed.model, linear.modes
        flexible = modes.frequency > 0.0
        shapes = modes.shapes[:, flexible]
        natural = 2.0 * math.pi * modes.frequency[flexible]
        errors = np.zeros((2, model.count)) if self.pin_errors is None else np.array(self.pin_errors, dtype=float)
        errors[1] *= -1.0 if model.mirrored else 1.0
        load = model.torque_load(meshed.sun_torque)
        if math.isfinite(model.planet.pin):
            load = load - model.planet.pin * errors.ravel() @ model.pin_rows.reshape(-1, model.size)
        start = model.with_pin_errors(errors)
        sun, ring = ((one,) * model.count for one in meshed.teeth)
        odd = self.odd or OddMeshes((sun, ring), meshed.delays)
        excitations = tuple(
            replace(
                one,
                separation=tuple(gap.plus(-float(model.mesh_rows[mesh, n] @ start)) for gap in one.separation),
                phase=one.phase - float(odd.delays[mesh, n]),
            )
            for mesh, teeth in enumerate(odd.teeth)
            for n, one in enumerate(teeth)
        )
        count = 2 * model.count
        return MotionParts(
            shapes=shapes,
            free=np.ones(natural.size, dtype=bool),
            fastest=float(natural[-1]),
            damping=np.diag(2.0 * linear.damping_ratio * natural),
            stiffness=shapes.T @ model.held_stiffness() @ shapes,
            load=load @ shapes,
            approach=model.mesh_rows.reshape(-1, model.size) @ shapes,
            lever=np.zeros((count, 2, natural.size)),
            excitations=excitations,
            mesh_stiffness=np.repeat(linear.stiffness, model.count),
            mesh_damping=np.zeros(count),
            backlash=np.full(count, self.backlash),
            static=self.static,
            frequency=np.full(count, self.mesh_frequency),
            momentary=np.zeros(count, dtype=bool),
        )


@dataclass(frozen=True)
class SetSweep:
    """Steady motions of a set over speed, and what they do to its meshes.

    Parameters
    ----------
    states : tuple of SteadyState
        In increasing order of speed.
    mean_force : float
        In every mesh with the sun where all planets carry alike [N].
    tolerance : float
        Of the largest forces of motions that repeat, over the mean force.
    by_teeth : ndarray, shape (speeds,)
        What the estimated errors of the teeth change of the largest dynamic force while all teeth touch, over the mean
        force.
    ring_lever : float
        Mean force in the sun's meshes over that in the ring's (`PlanetarySet.ring_lever`).
    """

    states: tuple[SteadyState, ...]
    mean_force: float
    tolerance: float
    by_teeth: Array
    ring_lever: float = 1.0

    def _of(self, values: str, mesh: int) -> Array:
        """Values of the meshes with sun (0) or ring (1), shape (speeds, planets)."""
        found = np.array([getattr(state, values) for state in self.states])
        return np.asarray(found.reshape(len(self.states), 2, -1)[:, mesh])

    @property
    @shows("Hz", "mesh frequency")
    def mesh_frequency(self) -> Array:
        """Shape (speeds,)."""
        return np.array([state.model.speed for state in self.states]) / (2.0 * math.pi)

    @property
    @shows("", "maximum sun mesh force / equal share", label="sun mesh")
    def sun_factor(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._of("largest", 0).max(axis=1) / self.mean_force)

    @property
    @shows("", "maximum ring mesh force / equal share", label="ring mesh")
    def ring_factor(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._of("largest", 1).max(axis=1) * self.ring_lever / self.mean_force)

    @property
    @shows("", "maximum tooth pair force (sun or ring) / equal share")
    def tooth_factor(self) -> Array:
        """Shape (speeds,)."""
        levers = (1.0, self.ring_lever)
        both = [self._of("tooth_force", mesh).max(axis=1) * lever for mesh, lever in enumerate(levers)]
        return np.asarray(np.maximum(*both) / self.mean_force)

    @property
    @shows("", "maximum fraction of time without contact, sun mesh")
    def apart_sun(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._of("apart", 0).max(axis=1))

    @property
    @shows("", "maximum fraction of time without contact, ring mesh")
    def apart_ring(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._of("apart", 1).max(axis=1))

    @property
    @shows("", "maximum fraction of time with back-side contact")
    def behind(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(np.maximum(*(self._of("behind", mesh).max(axis=1) for mesh in (0, 1))))

    @property
    @shows("", "period of the motion in mesh periods; 0: not periodic")
    def periods(self) -> NDArray[np.intp]:
        """Shape (speeds,)."""
        return np.array([state.periods for state in self.states], dtype=np.intp)

    @property
    @shows("", "estimated error of the factors of periodic motions; blank for non-periodic motions (sampled)")
    def error(self) -> Array:
        """That of the integration, and what errors of the teeth do to linear vibration, shape (speeds,)."""
        repeats = np.array([state.repeats for state in self.states])
        return np.where(repeats, self.tolerance + self.by_teeth, math.nan)


def set_sweep(
    run: SetMotion,
    mesh_frequency: Array,
    tolerance: float = 5e-4,
    direction: Literal["up", "down", "static", "rest"] = "down",
    progress: Callable[[float], None] | None = None,
) -> SetSweep:
    """Steady motions over the mesh frequencies, with contact loss.

    Parameters
    ----------
    run : SetMotion
        At any speed.
    mesh_frequency : ndarray, shape (speeds,)
        Increasing [Hz].
    tolerance : float
        Of the largest forces of motions that repeat, over the mean force.
    direction : {"up", "down", "static", "rest"}
        Whether each speed starts from the motion of the one before, or afresh.
    progress : callable, optional
    """
    order = mesh_frequency[::-1] if direction == "down" else mesh_frequency
    start: str | tuple[Array, Array] = direction if direction in ("static", "rest") else "static"
    states: list[SteadyState] = []
    for number, frequency in enumerate(order):
        within = of_one(progress, number, order.size)
        at_frequency = replace(run, mesh_frequency=float(frequency))
        state = steady_state(at_frequency, start=start, tolerance=tolerance, progress=within)
        states.append(state)
        if direction in ("up", "down"):
            start = (state.x, state.v)
        if progress is not None:
            progress((number + 1) / order.size)
    found = tuple(states[::-1] if direction == "down" else states)
    meshed = run.linear.meshed
    by_teeth = _by_teeth(run.linear, mesh_frequency)
    return SetSweep(found, meshed.mean_force, tolerance, by_teeth, meshed.model.found.ring_lever)


def _by_teeth(linear: LinearSet, mesh_frequency: Array) -> Array:
    """Changes of the largest dynamic force by the errors of the teeth, over the mean force; nan at a bare resonance."""
    try:
        vibration = forced_response(linear, mesh_frequency)
    except RangeError:
        return np.full(mesh_frequency.size, math.nan)
    return np.asarray(vibration.shift(lambda one: one.largest_force) / linear.meshed.mean_force)
