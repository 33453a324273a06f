"""Mesh-force spectra of a train in the frequency domain (Mark, Eqs. 3.1 to 3.11), over a range of speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.dynamics.train.increments import dynamic_increments
from fegear.dynamics.train.train import Train


class LineSource(Protocol):
    """A static transmission error by its Fourier coefficients: `Periodic`, or those of a series."""

    @property
    def pitches(self) -> int:
        """Base pitches in one period."""

    def fourier(self, n: ArrayLike) -> Complex:
        """Complex coefficients of orders of the period [m]."""


@dataclass(frozen=True)
class MeshForceSpectrum:
    """Line spectra of the mesh forces; the bearings react to the same forces.

    Shapes: speeds (speeds,), orders (harmonics,), frequencies (meshes, harmonics, speeds), static (meshes,); present
    (meshes, harmonics) is of the exciting mesh j; coefficients (meshes, meshes, harmonics, speeds) are those of the
    force in mesh i that the static transmission error of mesh j excites, in time from the moment that the phases hold
    for. With spacing errors some orders are fractions, the rotational harmonics.
    """

    speeds: Array = shown("rpm", "speed of the first body", name="speed")
    orders: Array = shown("", "harmonic of the mesh frequency of from_pair", name="n")
    present: NDArray[np.bool_] = shown("", "1: the transmission error of the exciting mesh contains this harmonic")
    frequencies: Array = shown("Hz", "n times the mesh frequency", name="frequency", label="frequency")
    coefficients: Complex = shown("N", "complex Fourier coefficient; its amplitude is twice the modulus")
    static: Array = shown("N", "mean mesh force")

    @property
    @shows("N", "0-peak", name="force", label="mesh force amplitude")
    def amplitudes(self) -> Array:
        """Amplitudes (0-peak) [N], shape (meshes, meshes, harmonics, speeds)."""
        return 2.0 * np.abs(self.coefficients)

    @property
    @shows("N^2", "one-sided power of the spectral line", name="power", label="power of the spectral line")
    def power_lines(self) -> Array:
        """One-sided power of each line [N^2], 2 |alpha|^2 (3.11)."""
        return 2.0 * np.abs(self.coefficients) ** 2


def mesh_force_spectrum(
    train: Train,
    errors: Sequence[LineSource],
    speeds: ArrayLike,
    harmonics: int = 64,
    static: ArrayLike | None = None,
    *,
    rotational: bool = False,
    phases: ArrayLike = 0.0,
) -> MeshForceSpectrum:
    """Forces in every mesh from the static transmission error of every mesh, at every speed.

    Parameters
    ----------
    train : Train
        Meshes with their mean stiffness.
    errors : sequence of Periodic or SeriesError, one per mesh
        Static transmission error [m] under the mean load over the base pitch, or as many as its spacing errors take to
        repeat; its mean has no meaning here.
    speeds : array_like
        Speeds of the first body [rad/s].
    harmonics : int
        Harmonics of the mesh frequency.
    static : array_like, optional
        Mean mesh forces [N]; by default those of the train's torques.
    rotational : bool
        Whether to add the harmonics between those of the mesh frequency, which spacing errors cause.
    phases : array_like, shape () or (meshes,)
        Phase of each mesh at time zero [its base pitches].
    """
    from fegear.dynamics.train.matrices import static_forces

    if len(errors) != len(train.meshes):
        raise InputError("errors", len(errors), f"must be one function for each of the {len(train.meshes)} gear pairs")
    speed = np.atleast_1d(np.array(speeds, dtype=float))
    count = len(train.meshes)
    step = math.lcm(*(error.pitches for error in errors)) if rotational else 1
    n = np.arange(1, harmonics * step + 1)
    mesh = train.mesh_frequencies(speed)
    ahead = np.broadcast_to(np.asarray(phases, dtype=float), (count,))
    present = np.array([n * error.pitches % step == 0 for error in errors])
    frequencies = np.empty((count, n.size, speed.size))
    coefficients = np.zeros((count, count, n.size, speed.size), dtype=complex)
    stiffness = np.array([m.stiffness for m in train.meshes])[:, None, None]
    for j, error in enumerate(errors):
        frequencies[j] = n[:, None] * mesh[j][None, :] / step
        own = present[j]
        q = dynamic_increments(train, 2.0 * math.pi * frequencies[j, own], [j])
        alpha = error.fourier(n[own] * error.pitches // step) * np.exp(2j * math.pi * n[own] * ahead[j] / step)
        coefficients[:, j, own] = stiffness * q[:, 0] * alpha[:, None]
    mean = static_forces(train) if static is None else np.array(static, dtype=float)
    orders = n / step
    for array in (speed, orders, present, frequencies, coefficients, mean):
        array.flags.writeable = False
    return MeshForceSpectrum(speed, orders, present, frequencies, coefficients, mean)
