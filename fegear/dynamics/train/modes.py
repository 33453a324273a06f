"""Natural frequencies and mode shapes of a gear train, damped eigenvalues, and the Campbell diagram.

Undamped natural modes with rigid-body motion kept apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex, first_of_largest
from fegear.base.errors import RangeError
from fegear.base.shown import shown, shows
from fegear.dynamics.train.matrices import damping_matrix, elements
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import Train

#: A squared frequency below this part of the largest one counts as rigid-body motion.
RIGID = 1e-12
#: Components of a shape that differ by less than this share are equal in size.
_TIE = 1e-6


@dataclass(frozen=True)
class Modes:
    """Undamped modes of a train with its mean mesh stiffness, the rigid-body motion first, which is exactly zero.

    Attributes
    ----------
    frequencies : ndarray, shape (size,)
        Increasing.
    shapes : ndarray, shape (size, size)
        Column k is mode k.
    mesh_energy : ndarray, shape (size, meshes)
        Zero for the rigid-body motion.
    """

    frequencies: Array = shown("Hz", "undamped natural frequency with mean mesh stiffness", name="frequency")
    shapes: Array = shown("", "rotation angle for unit modal mass [rad/(kg^0.5 m)]", name="shape")
    mesh_energy: Array = shown("", "share of the mode's strain energy in this mesh", name="energy")

    @property
    @shows("", "mode number; 0: rigid-body motion", name="mode")
    def number(self) -> NDArray[np.int64]:
        """0 to size - 1."""
        return np.arange(self.frequencies.size)


def modes(train: Train) -> Modes:
    """Natural frequencies and mode shapes.

    They are the singular values of sqrt(k) G / sqrt(J), element by body, and not the square roots of eigenvalues of
    the stiffness matrix: a soft mode among stiff ones keeps its digits.
    """
    parts = [e for e in elements(train) if e.stiffness > 0.0]
    root = np.sqrt(train.inertia)
    rigid = train.ratios * root
    rigid = rigid / np.linalg.norm(rigid)
    rows = np.zeros((len(parts), train.size))
    for index, part in enumerate(parts):
        rows[index, part.a] += math.sqrt(part.stiffness) * part.radius_a
        rows[index, part.b] += math.sqrt(part.stiffness) * part.radius_b
    rows /= root
    _, values, vectors = np.linalg.svd(np.vstack([rows, np.zeros((train.size, train.size))]), full_matrices=False)
    order = np.argsort(values)
    omega, shape = values[order], vectors[order].T
    omega[0] = 0.0
    shape[:, 0] = rigid
    shape[:, 1:] -= np.outer(rigid, rigid @ shape[:, 1:])
    shape[:, 1:] /= np.linalg.norm(shape[:, 1:], axis=0)
    shapes = shape / root[:, None]
    shapes[:, 1:] = same_way_up(shapes[:, 1:])
    energy = np.array([mesh.stiffness for mesh in train.meshes])[:, None] * (train.approach @ shapes) ** 2
    share = np.zeros((train.size, len(train.meshes)))
    share[1:] = (energy[:, 1:] / omega[1:] ** 2).T
    for array in (omega, shapes, share):
        array.flags.writeable = False
    return Modes(omega / (2.0 * math.pi), shapes, share)


def damped_eigenvalues(train: Train) -> Complex:
    """Eigenvalues [rad/s] of the damped train with mean mesh stiffness, sorted by modulus, shape (2 size,).

    In modal coordinates, with the free turning taken out beforehand: as a double zero it would come back as a pair of
    the size of the square root of round-off, one of them growing.
    """
    found, size = modes(train), train.size
    damping = found.shapes.T @ damping_matrix(train) @ found.shapes
    if all(part.geared or part.damping == 0.0 for part in elements(train)):
        damping[0, :] = damping[:, 0] = 0.0
    flexible = size - 1
    state = np.zeros((flexible + size, flexible + size))
    state[:flexible, size:] = np.eye(flexible)
    state[flexible:, flexible:] = -damping
    state[size:, :flexible] = -np.diag((2.0 * math.pi * found.frequencies[1:]) ** 2)
    values = np.append(np.linalg.eigvals(state), 0.0)
    return np.asarray(values[np.argsort(np.abs(values), kind="stable")], dtype=complex)


@dataclass(frozen=True)
class Campbell:
    """Where mesh harmonics meet natural frequencies.

    Attributes
    ----------
    speeds : ndarray, shape (speeds,)
        Speeds of the first body [rad/s].
    natural : ndarray, shape (modes,)
        Natural frequencies above zero [Hz].
    lines : ndarray, shape (meshes, harmonics, speeds)
        Mesh harmonics [Hz]: line h - 1 is harmonic h.
    critical : ndarray, shape (meshes, harmonics, modes)
        Speed [rad/s] at which the harmonic meets the mode, inside the range or not.
    """

    speeds: Array
    natural: Array
    lines: Array
    critical: Array


def campbell(train: Train, speeds: ArrayLike, harmonics: int = 3) -> Campbell:
    """Campbell diagram of a train over a range of speeds [rad/s] of the first body."""
    if harmonics < 1:
        raise RangeError("harmonics", harmonics, "must be at least 1")
    speed = np.array(speeds, dtype=float)
    order = np.arange(1, harmonics + 1)
    mesh = train.mesh_frequencies(speed)
    natural = np.array(modes(train).frequencies[1:])
    per_turn = np.array([float(value) for value in train.mesh_orders])
    critical = 2.0 * math.pi * natural / (per_turn[:, None, None] * order[:, None])
    lines = mesh[:, None, :] * order[:, None]
    for array in (speed, natural, lines, critical):
        array.flags.writeable = False
    return Campbell(speed, natural, lines, critical)


def ripple_critical(one: TorqueRipple, natural: Array) -> Array:
    """Speeds of the first body [rad/s] at which harmonics of a ripple meet modes [Hz], shape (harmonics, modes)."""
    if one.order is None:
        raise RangeError("frequency", one.frequency, "is fixed: it meets a mode at every speed or at none")
    return 2.0 * math.pi * natural / (one.order[0] / one.order[1] * one.harmonics[:, None])


def same_way_up(shapes: Array) -> Array:
    """Mode shapes, as columns, with the sign that makes the first of their largest components positive.

    Components that differ by less than a millionth of the largest are equally large: of those symmetry makes alike.
    """
    first = first_of_largest(np.abs(shapes), axis=0, tie=_TIE)
    return np.asarray(shapes * np.sign(shapes[first, np.arange(shapes.shape[1])]))


def undamped_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Natural frequencies [rad/s], falling, and mass-normalised mode shapes as columns; rigid bodies have exactly 0.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        Diagonal masses [kg].
    stiffness : ndarray, shape (n, n)
        Symmetric, no negative eigenvalue [N/m].
    """
    root = 1.0 / np.sqrt(mass)
    squared, vectors = np.linalg.eigh(root[:, None] * stiffness * root)
    squared, vectors = squared[::-1], vectors[:, ::-1]
    squared = np.where(squared <= RIGID * squared[0], 0.0, squared)
    return np.sqrt(squared), root[:, None] * vectors
