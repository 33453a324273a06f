"""A model of motion as the plain arrays that the integrator takes, in units of its own."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.dynamics.motion.kernel.arrays import MeshArrays, SpringArrays, TrainArrays
from fegear.dynamics.motion.motion_model import MotionParts, Moving, Swings
from fegear.dynamics.train.periodic import Periodic


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
