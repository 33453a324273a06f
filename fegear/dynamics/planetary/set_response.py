"""Forced vibration of a planetary set by the transmission errors of its meshes, each with its phase, over speed.

Linear, with mean mesh stiffnesses: all fluctuation of the teeth stands in their static transmission error (Mark).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.shown import shown, shows
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_modes import set_modes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Complex
    from fegear.dynamics.planetary.planet_loads import MeshedSet
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_modes import SetModes

#: Places of the cycle at which harmonics are added up for their largest value.
_SAMPLES = 256


@dataclass(frozen=True)
class LinearSet:
    """A set linear about its mean load.

    Parameters
    ----------
    meshed : MeshedSet
    stiffness : (float, float)
        Mean mesh stiffness of sun and ring [N/m]: one over the mean compliance.
    modes : SetModes
    damping_ratio : float
        Of every mode.
    error : ndarray, complex, shape (2, planets, harmonics)
        Harmonics 1.. of each mesh's static transmission error under the mean force, with its phase [m].
    """

    meshed: MeshedSet
    stiffness: tuple[float, float]
    modes: SetModes
    damping_ratio: float
    error: Complex


def linear_set(meshed: MeshedSet, damping_ratio: float, harmonics: int) -> LinearSet:
    """The set about its mean load.

    Raises
    ------
    RangeError
        If the damping ratio is negative or one and more.
    """
    if not 0.0 <= damping_ratio < 1.0:
        raise RangeError("damping_ratio", damping_ratio, "must lie in [0, 1)")
    order = np.arange(1, harmonics + 1)
    stiffness, error = [], []
    for one, delay in zip(meshed.teeth, meshed.delays, strict=True):
        compliance, fluctuation = one.linearised(meshed.mean_force)
        stiffness.append(1.0 / compliance)
        error.append(fluctuation.fourier(order) * np.exp(2j * math.pi * order * (one.phase - delay[:, None])))
    modes = set_modes(meshed.model, stiffness[0], stiffness[1])
    return LinearSet(meshed, (stiffness[0], stiffness[1]), modes, damping_ratio, np.array(error))


@dataclass(frozen=True)
class ForcedResponse:
    """Vibration over the mesh frequency: complex amplitudes of harmonics l, of 2 Re(a exp(2 pi i l f t)).

    Parameters
    ----------
    coordinate : ndarray, complex, shape (speeds, harmonics, size)
        Of every coordinate of `SetModel` [m].
    dynamic : ndarray, complex, shape (speeds, harmonics, 2, planets)
        Dynamic force in each mesh [N].
    mean_force : float
        In every mesh [N].
    mesh_frequency : ndarray, shape (speeds,)
    """

    coordinate: Complex
    dynamic: Complex
    mean_force: float
    mesh_frequency: Array = shown("Hz", "mesh frequency at which the set runs")

    @cached_property
    def _force(self) -> Array:
        """Largest dynamic force of each mesh over the cycle [N], shape (speeds, 2, planets)."""
        orders = np.arange(1, self.dynamic.shape[1] + 1)
        turn = np.exp(2j * math.pi * np.outer(np.arange(_SAMPLES) / _SAMPLES, orders))
        return np.asarray(np.abs(2.0 * np.real(np.einsum("tl,wlan->wtan", turn, self.dynamic))).max(axis=1))

    @property
    @shows("N", "largest dynamic force in a mesh with the sun, over the mean force", label="dynamic force at the sun")
    def sun_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 0].max(axis=1))

    @property
    @shows("N", "largest dynamic force in a mesh with the ring, over the mean force", label="dynamic force at the ring")
    def ring_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 1].max(axis=1))

    @property
    @shows("", "smallest force in any mesh over the mean force; below zero teeth part, which is neglected")
    def least_share(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(1.0 - self._force.max(axis=(1, 2)) / self.mean_force)

    def amplitude(self, member: Central, axis: int) -> Array:
        """Root of the sum of squares of a coordinate's harmonics [m], 0-peak, shape (speeds,).

        Parameters
        ----------
        member : {"sun", "ring", "carrier"}
        axis : int
            0 for x, 1 for y, 2 for the rotation.
        """
        own = self.coordinate[:, :, 3 * CENTRALS.index(member) + axis]
        return np.asarray(2.0 * np.sqrt((np.abs(own) ** 2).sum(axis=1)))


def forced_response(linear: LinearSet, mesh_frequency: ArrayLike) -> ForcedResponse:
    """Steady vibration at mesh frequencies [Hz].

    M q'' + C q' + K q = sum over the meshes of their rows times k e, mode by mode; the dynamic force in a mesh is
    k (row q - e).

    Raises
    ------
    RangeError
        If a frequency is not positive, or meets a natural frequency of a set without damping.
    """
    frequency = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if not np.all(frequency > 0.0):
        raise RangeError("speed", float(frequency.min()), "must be positive", "at standstill the static answer holds")
    model, modes = linear.meshed.model, linear.modes
    harmonics = np.arange(1, linear.error.shape[2] + 1)
    omega = 2.0 * math.pi * frequency[:, None] * harmonics  # (speeds, harmonics)
    natural = 2.0 * math.pi * modes.frequency
    stiffness = np.array(linear.stiffness)
    approach = model.mesh_rows @ modes.shapes  # (2, planets, modes)
    force = np.einsum("a,anl,anj->lj", stiffness, linear.error, approach)
    dynamic_stiffness = natural**2 - omega[..., None] ** 2 + 2j * linear.damping_ratio * natural * omega[..., None]
    if np.any(np.abs(dynamic_stiffness) <= 1e-12 * np.maximum(natural**2, omega[..., None] ** 2)):
        raise RangeError(
            "speed", "a resonance", "meets a natural frequency of a set without damping",
            "give damping_ratio or leave this speed out",
        )  # fmt: skip
    modal = force / dynamic_stiffness
    relative = np.einsum("anj,wlj->wlan", approach, modal) - linear.error.transpose(2, 0, 1)
    dynamic = stiffness[:, None] * relative
    return ForcedResponse(modal @ modes.shapes.T, dynamic, linear.meshed.mean_force, frequency)
