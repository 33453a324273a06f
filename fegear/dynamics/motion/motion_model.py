"""A gear train at one speed with what its gear pairs do to it: what moves."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.matrices import damping_matrix, elements, projected, static_forces
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.segments import segment_shapes
from fegear.dynamics.train.torque_ripple import CommonPeriod, TorqueRipple, common_period
from fegear.dynamics.train.train import Train, common_multiple


@dataclass(frozen=True)
class MotionParts:
    """What of a model moves, in SI: bodies in coordinates of their own, and the gear pairs between them.

    Parameters
    ----------
    shapes : ndarray, shape (size, n)
        Motion of the bodies per coordinate.
    free : ndarray of bool, shape (n,)
        Coordinates whose position matters (all but a rigid-body angle).
    fastest : float
        Largest natural frequency [rad/s], which sets the unit of time.
    damping, stiffness : ndarray, shape (n, n)
        Without those of the gear pairs, for unit masses.
    load : ndarray, shape (n,)
    approach : ndarray, shape (meshes, n)
        Approach of each gear pair [m].
    lever : ndarray, shape (meshes, 2, n)
        Rotation of its two bodies [rad], on which friction acts.
    excitations : tuple of MeshExcitation
    mesh_stiffness, mesh_damping, backlash, static, frequency : ndarray, shape (meshes,)
        Mean stiffness [N/m], damping at it [N s/m], backlash [m], mean force [N], mesh frequency [Hz].
    momentary : ndarray of bool, shape (meshes,)
        Whether the damping follows the stiffness of the teeth that touch.
    """

    shapes: Array
    free: NDArray[np.bool_]
    fastest: float
    damping: Array
    stiffness: Array
    load: Array
    approach: Array
    lever: Array
    excitations: tuple[MeshExcitation, ...]
    mesh_stiffness: Array
    mesh_damping: Array
    backlash: Array
    static: Array
    frequency: Array
    momentary: NDArray[np.bool_]
    swings: Swings | None = None


@dataclass(frozen=True)
class Swings:
    """Torques that fluctuate, line by line, in SI: load cos(rate t + phase).

    Parameters
    ----------
    load : ndarray, shape (lines, n)
        In the coordinates of `MotionParts`.
    rate, phase : ndarray, shape (lines,)
        [rad/s, rad].
    """

    load: Array
    rate: Array
    phase: Array


class Moving(Protocol):
    """What motion in time can be asked of: a gear train, a planetary set."""

    @property
    def speed(self) -> float:
        """Speed that messages name [rad/s]."""

    @property
    def period(self) -> float:
        """Common period of all excitations [s]."""

    @property
    def static(self) -> Array:
        """Mean mesh forces [N]."""

    def parts(self) -> MotionParts:
        """What moves."""

    def at_speed(self, speed: float) -> Moving:
        """The same at another speed [rad/s]."""

    def more_damped(self, factor: float) -> Moving:
        """The same with so many times the damping."""


@dataclass(frozen=True)
class MotionModel:
    """A gear train at one speed with what its gear pairs do to it.

    Parameters
    ----------
    train : Train
        The train; its torques set the mean load.
    excitations : tuple of MeshExcitation
        One for each gear pair.
    speed : float
        Speed of the first body [rad/s], positive.
    loss_taken_by : str
        Body whose torque makes up for the mean friction loss (by default the one of the train's last torque).
    ripple : tuple of TorqueRipple
        Torques that fluctuate about the constant ones.
    """

    train: Train
    excitations: tuple[MeshExcitation, ...]
    speed: float
    loss_taken_by: str = ""
    ripple: tuple[TorqueRipple, ...] = ()

    def __post_init__(self) -> None:
        if len(self.excitations) != len(self.train.meshes):
            raise InputError(
                "excitations", len(self.excitations), f"must be {len(self.train.meshes)}, one per gear pair"
            )
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise RangeError("speed", self.speed, "must be positive", "use the static result for zero speed")
        for index, mesh in enumerate(self.train.meshes):
            if self.static[index] < -1e-9 * float(np.max(np.abs(self.static))):
                raise InputError(
                    f"mesh.{mesh.name}", f"{self.static[index]:.6g} N",
                        "is a negative mean force (working flanks separated)",
                    "change the sign of the torques, or of both base radii",
                )  # fmt: skip

    def at_speed(self, speed: float) -> MotionModel:
        """The same train at another speed [rad/s]."""
        return replace(self, speed=speed)

    def more_damped(self, factor: float) -> MotionModel:
        """The same with so many times the damping of its gear pairs."""
        meshes = tuple(replace(mesh, damping=factor * mesh.damping) for mesh in self.train.meshes)
        return replace(self, train=replace(self.train, meshes=meshes))

    @cached_property
    def static(self) -> Array:
        """Mean mesh forces [N]."""
        return static_forces(self.train)

    @cached_property
    def mesh_periods(self) -> tuple[Fraction, ...]:
        """Period of each gear pair's excitation in turns of the first body."""
        return tuple(
            Fraction(math.lcm(*(f.pitches for f in _functions(e)))) / order
            for e, order in zip(self.excitations, self.train.mesh_orders, strict=True)
        )

    @cached_property
    def mesh_turns(self) -> Fraction:
        """Common period of all gear pairs in turns of the first body."""
        return common_multiple(self.mesh_periods)

    @cached_property
    def common(self) -> CommonPeriod:
        """How many of these periods close a motion under torque ripple, and what frequencies that takes."""
        if not self.ripple:
            return CommonPeriod(1, ())
        return common_period(self.mesh_turns, max(self.train.mesh_orders), self.speed, self.ripple)

    @cached_property
    def period(self) -> float:
        """Common period of all excitations [s]."""
        return float(self.mesh_turns * self.common.count) * 2.0 * math.pi / self.speed

    def _swings(self, shapes: Array) -> Swings | None:
        """Torque ripple in coordinates whose shapes are columns of rotation angles."""
        if not self.ripple:
            return None
        rows, rates, phases = [], [], []
        for one, stretch in zip(self.ripple, self.common.stretch, strict=True):
            rows.append(np.outer(np.abs(one.torques), shapes[self.train.dof[one.body]]))
            rates.append(2.0 * math.pi * stretch * one.frequencies(self.speed))
            phases.append(np.angle(one.torques))
        return Swings(np.concatenate(rows), np.concatenate(rates), np.concatenate(phases))

    def parts(self) -> MotionParts:
        """The train in its modes, or in its segments where they are many; see `LONG`."""
        train = self.train
        shape = modes(train)
        basis = shape.shapes if train.size <= LONG else segment_shapes(train)
        slipping = damping_matrix(train, meshes=False) @ basis[:, :1]
        keep_rigid = bool(np.any(np.abs(slipping) > 0.0)) and not _geared_damping(train)
        shapes = basis if keep_rigid else basis[:, 1:]
        free = np.ones(shapes.shape[1], dtype=bool)
        if keep_rigid:
            free[0] = False
        ends = np.array([[train.dof[m.a], train.dof[m.b]] for m in train.meshes])
        stiff, damped = (projected(train, shapes, of) for of in ("stiffness", "damping"))
        return MotionParts(
            shapes=shapes,
            free=free,
            fastest=2.0 * math.pi * float(shape.frequencies[-1]),
            damping=damped,
            stiffness=stiff,
            load=shapes.T @ (train.torque + friction_loss_torque(self)),
            approach=train.approach @ shapes,
            lever=shapes[ends],
            excitations=self.excitations,
            mesh_stiffness=np.array([m.stiffness for m in train.meshes]),
            mesh_damping=np.array([m.damping for m in train.meshes]),
            backlash=np.array([m.backlash for m in train.meshes]),
            static=self.static,
            frequency=train.mesh_frequencies(self.speed),
            momentary=np.array([m.damping_law == "momentary" for m in train.meshes]),
            swings=self._swings(shapes),
        )


def _functions(excitation: MeshExcitation) -> tuple[Periodic, ...]:
    """All functions that a motion repeats with."""
    back = () if excitation.back is None else (excitation.back.stiffness,)
    return (*excitation.stiffness, *excitation.separation, *back)


def friction_loss_torque(model: MotionModel) -> Array:
    """Torque that makes up for the mean tooth friction under static tooth loads [N m], shape (size,).

    Raises
    ------
    InputError
        If the friction of a gear pair would drive the train: it was made for the other body driving.
    """
    train = model.train
    extra = np.zeros(train.size)
    loss = 0.0
    for m, (mesh, excitation) in enumerate(zip(train.meshes, model.excitations, strict=True)):
        if not excitation.friction:
            continue
        s = (np.arange(512) + 0.5) / 512
        error = excitation.approach(model.static[m], s)
        ratio_a, ratio_b = train.ratios[train.dof[mesh.a]], train.ratios[train.dof[mesh.b]]
        own = 0.0
        for slot, (on_a, on_b) in enumerate(excitation.friction):
            force = excitation.tooth_force(slot, s, error)
            own += float(np.mean(force * (ratio_a * on_a(s) + ratio_b * on_b(s))))
        if own > 0.0:
            raise InputError(
                f"mesh.{mesh.name}.friction", f"{own:.6g} W per rad/s",
                    "adds power to the train: with these torques the other "
                    "body drives", "use the side returned by train_mesh.a_drives in with_friction",
            )  # fmt: skip
        loss += own
    if loss != 0.0:
        body = model.loss_taken_by or train.torques[-1].body
        if body not in train.dof:
            raise InputError("loss_taken_by", body, "is not a body of this train")
        extra[train.dof[body]] = -loss / train.ratios[train.dof[body]]
    return extra


#: Bodies beyond which the coordinates are segments of the train and not modes: the work of a step then grows with the
#: number of bodies and not with its square.
LONG = 32


def _geared_damping(train: Train) -> bool:
    """Whether every damper follows the rigid-body motion, so that the mean turning cannot be felt."""
    return all(part.geared or part.damping == 0.0 for part in elements(train))
