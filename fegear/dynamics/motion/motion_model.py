"""A gear train at one speed with what its gear pairs do to it: what moves.

A model as the plain arrays that the integrator takes, in units of its own.
"""

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
from fegear.dynamics.motion.kernel.arrays import MeshArrays, SpringArrays, TrainArrays
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


@dataclass(frozen=True)
class Packed:
    """A model as arrays of `kernel.integration.travel`, in its own units: time 1/w_max, length and force of the mesh.

    Attributes
    ----------
    free : ndarray of bool, shape (n,)
        Coordinates whose position matters (all but the rigid-body angle).
    shapes : ndarray, shape (size, n)
        Rotation angles [rad] per coordinate.
    damping, stiffness : ndarray, shape (meshes,)
        Damping of each gear pair at its mean stiffness, and that stiffness.
    momentary : ndarray of bool, shape (meshes,)
        Whether the damping follows the stiffness of the teeth that touch.
    """

    model: Moving
    time_unit: float
    length_unit: float
    force_unit: float
    shapes: Array
    free: NDArray[np.bool_]
    K: Array
    C: Array
    f: Array
    approach: Array
    damping: Array
    stiffness: Array
    momentary: NDArray[np.bool_]
    lever: Array
    mesh_of: NDArray[np.int64]
    side: Array
    rate: Array
    phase: Array
    first: NDArray[np.int64]
    cuts: Array
    poly: Array
    swing: Array
    swing_rate: Array
    swing_phase: Array

    @property
    def period(self) -> float:
        """Common period in time units."""
        return self.model.period / self.time_unit

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.free.size)

    @property
    def springs(self) -> int:
        """Number of one-sided springs."""
        return int(self.mesh_of.size)

    @cached_property
    def train_arrays(self) -> TrainArrays:
        """What the integrator knows of the train."""
        return TrainArrays(
            self.K, self.C, self.f, self.free.astype(np.int64), self.swing, self.swing_rate, self.swing_phase
        )

    @cached_property
    def mesh_arrays(self) -> MeshArrays:
        """What it knows of the gear pairs."""
        return MeshArrays(self.approach, self.lever, self.damping, self.stiffness, self.momentary.astype(np.int64))

    @cached_property
    def spring_arrays(self) -> SpringArrays:
        """What it knows of their springs."""
        return SpringArrays(self.mesh_of, self.side, self.rate, self.phase, self.first, self.cuts, self.poly)

    def varies(self, spring: int) -> bool:
        """Whether the stiffness of a spring varies in time."""
        stiffness = self.poly[self.first[spring] : self.first[spring + 1], 0]
        return bool(np.any(stiffness[:, 1:]) or np.ptp(stiffness[:, 0]) > 0.0)


def on_breaks(part: Periodic, cuts: Array, pitches: int, degree: int) -> Array:
    """Coefficients of a periodic function on finer break points over a longer period, shape (pieces, degree + 1)."""
    rows = np.zeros((cuts.size - 1, degree + 1))
    middle = 0.5 * (cuts[:-1] + cuts[1:]) * pitches / part.pitches
    half = 0.5 * np.diff(cuts) * pitches / part.pitches
    s = middle - np.floor(middle)
    piece = np.clip(np.searchsorted(part.breaks, s, side="right") - 1, 0, part.breaks.size - 2)
    start, end = part.breaks[piece], part.breaks[piece + 1]
    centre, scale = ((s - start) - (end - s)) / (end - start), 2.0 * half / (end - start)
    row = part.coefficients[piece]  # of all pieces together: a speed of a sweep is mostly this
    for k in range(row.shape[1]):
        rows[:, k] = np.polynomial.polynomial.polyval(centre, row.T, tensor=False) * scale**k / math.factorial(k)
        row = row[:, 1:] * np.arange(1, row.shape[1])
    return rows


def _spring_tables(
    parts: MotionParts, length: float, force: float
) -> tuple[list[tuple[int, float, Array, Array, int, float]], int]:
    """(mesh, side, cuts, polynomials, pitches, shift) of each spring in units, and their common degree."""
    springs = []
    for m, (backlash, excitation) in enumerate(zip(parts.backlash, parts.excitations, strict=True)):
        none = Periodic.constant(0.0)
        for j, (k, e) in enumerate(zip(excitation.stiffness, excitation.separation, strict=True)):
            a, b = excitation.friction[j] if excitation.friction else (none, none)
            springs.append((m, 1.0 if excitation.parting else 0.0, (k, e, a, b), 0.0))
        if math.isfinite(backlash) and excitation.parting:
            total, shift = excitation.stiffness[0], 0.0
            if excitation.back is not None:
                total, shift = excitation.back.stiffness, excitation.back.shift
            elif len(excitation.stiffness) > 1:
                total = excitation.total_stiffness()
            springs.append((m, -1.0, (total, Periodic.constant(-float(backlash)), none, none), shift))
    degree = max(part.coefficients.shape[1] - 1 for _, _, own, _ in springs for part in own)
    found = []
    for m, side, own, shift in springs:
        pitches = math.lcm(*(part.pitches for part in own))
        cuts = np.unique(np.concatenate([part.breaks_over(pitches) for part in own])) / pitches
        cuts = cuts[np.append(True, np.diff(cuts) > 1e-11)]
        cuts[-1] = 1.0
        table = np.stack([on_breaks(part, cuts, pitches, degree) for part in own], axis=1)
        table[:, 0] *= length / force
        table[:, 1] /= length
        found.append((m, side, cuts, table, pitches, shift))
    return found, degree


def pack(model: Moving) -> Packed:
    """Turn a model into arrays for the integrator."""
    parts = model.parts()
    rows = np.where(parts.free, parts.approach, 0.0)
    length = float(np.max(parts.static / parts.mesh_stiffness))
    if length <= 0.0:
        largest = [float(np.max(np.abs(e.coefficients))) for x in parts.excitations for e in x.separation]
        length = max(*largest, 1e-9)
    unit = length / float(np.max(np.abs(rows)))
    time = 1.0 / parts.fastest
    force = unit**2 / (time**2 * length)
    springs, degree = _spring_tables(parts, length, force)
    swings = parts.swings or Swings(np.zeros((0, parts.free.size)), np.zeros(0), np.zeros(0))
    K = parts.stiffness * time**2
    K[~parts.free, :] = 0.0
    K[:, ~parts.free] = 0.0
    mesh_of = np.array([s[0] for s in springs], dtype=np.int64)
    pieces = [s[3].shape[0] for s in springs]
    return Packed(
        model=model,
        time_unit=time,
        length_unit=length,
        force_unit=force,
        shapes=parts.shapes * unit,
        free=parts.free,
        K=K,
        C=parts.damping * time,
        f=parts.load * time**2 / unit,
        approach=rows * unit / length,
        damping=parts.mesh_damping * length / (force * time),
        stiffness=parts.mesh_stiffness * length / force,
        momentary=parts.momentary,
        lever=parts.lever * unit / length,
        mesh_of=mesh_of,
        side=np.array([s[1] for s in springs]),
        rate=np.array([parts.frequency[s[0]] / s[4] for s in springs]) * time,
        phase=np.array([(parts.excitations[s[0]].phase + s[5]) / s[4] for s in springs]),
        first=np.concatenate([[0], np.cumsum(pieces)]).astype(np.int64),
        cuts=np.concatenate([s[2] for s in springs]),
        poly=np.concatenate([s[3] for s in springs]).reshape(-1, 4, degree + 1),
        swing=swings.load * (time**2 / unit),
        swing_rate=swings.rate * time,
        swing_phase=swings.phase,
    )


def _geared_damping(train: Train) -> bool:
    """Whether every damper follows the rigid-body motion, so that the mean turning cannot be felt."""
    return all(part.geared or part.damping == 0.0 for part in elements(train))
