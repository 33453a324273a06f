"""Forced vibration of a planetary set by the transmission errors of its meshes, each with its phase, over speed.

Linear, with mean mesh stiffnesses: all fluctuation of the teeth stands in their static transmission error (Mark).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Complex
from fegear.base.errors import RangeError
from fegear.base.shown import shown, shows
from fegear.dynamics.planetary.planet_set import CENTRALS, Central
from fegear.dynamics.planetary.set_cycle import MeshedSet
from fegear.dynamics.planetary.set_modes import SetModes, set_modes

#: Places of the cycle at which harmonics are added up for their largest value.
_SAMPLES = 512


#: Harmonics that count, where their number follows a tolerance: each more than is looked at costs its share of time.
_LADDER = (12, 25, 50, 100, 200)
#: Harmonics that are looked at for them.
_MOST_LOOKED_AT = 256


def looked_at(harmonics: int | None) -> int:
    """Harmonics that tell what those that count leave out: low speeds meet resonances with high ones.

    Parameters
    ----------
    harmonics : int or None
        That count; None where they will follow a tolerance.
    """
    return _MOST_LOOKED_AT if harmonics is None else max(2 * harmonics, min(8 * harmonics, 128))


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
    error : ndarray, complex, shape (2, planets, looked_at)
        Harmonics 1.. of each mesh's static transmission error under the mean force, with its phase [m]: those that
        count, and more that tell what is missing.
    harmonics : int or None
        That count; None where they follow a tolerance (`enough_harmonics`), and all that are looked at count.
    stiffness_error : (float, float)
        Estimated errors of the stiffnesses, as shares of them.
    amplitude_error : ndarray, shape (2, looked_at)
        Of the amplitudes, as shares of them.
    """

    meshed: MeshedSet
    stiffness: tuple[float, float]
    modes: SetModes
    damping_ratio: float
    error: Complex
    harmonics: int | None
    stiffness_error: tuple[float, float] = (0.0, 0.0)
    amplitude_error: Array = field(default_factory=lambda: np.zeros((2, 1)))

    @cached_property
    @shows("Hz", "estimated error of the natural frequency, by that of the mesh stiffnesses", name="frequency_error")
    def frequency_error(self) -> Array:
        """By Rayleigh's quotient: half of each mesh's share of the strain energy, shape (modes,) [Hz]."""
        of_sun, of_ring = self.stiffness_error
        modes = self.modes
        return np.asarray(0.5 * modes.frequency * (modes.sun_mesh * of_sun + modes.ring_mesh * of_ring))

    @cached_property
    def shifted(self) -> tuple[LinearSet, ...]:
        """The same with the stiffness of each mesh, and with the amplitudes of each, off by their error."""
        found = []
        for mesh, off in enumerate(self.stiffness_error):
            sun, ring = (k * (1.0 + off) if mesh == i else k for i, k in enumerate(self.stiffness))
            if off:
                found.append(replace(self, stiffness=(sun, ring), modes=set_modes(self.meshed.model, sun, ring)))
        for mesh, amplitude in enumerate(self.amplitude_error):
            if amplitude.any():
                error = self.error.copy()
                error[mesh] *= 1.0 + amplitude
                found.append(replace(self, error=error))
        return tuple(found)


def linear_set(
    meshed: MeshedSet, damping_ratio: float, harmonics: int | None,
    exactness: tuple[tuple[float, Array], tuple[float, Array]] | None = None,
) -> LinearSet:  # fmt: skip
    """The set about its mean load.

    Parameters
    ----------
    meshed : MeshedSet
    damping_ratio : float
    harmonics : int or None
        Of the mesh frequency that count; None where they will follow a tolerance.
    exactness : pair of (float, ndarray of shape (looked_at,)), optional
        Estimated errors of the stiffness of each mesh and of the amplitudes of its transmission error, as shares.

    Raises
    ------
    RangeError
        If the damping ratio is negative or one and more.
    """
    if not 0.0 <= damping_ratio < 1.0:
        raise RangeError("damping_ratio", damping_ratio, "must lie in [0, 1)")
    order = np.arange(1, looked_at(harmonics) + 1)
    stiffness, error = [], []
    for one, delay in zip(meshed.teeth, meshed.delays, strict=True):
        compliance, fluctuation = one.linearised(meshed.mean_force)
        stiffness.append(1.0 / compliance)
        error.append(fluctuation.fourier(order) * np.exp(2j * math.pi * order * (one.phase - delay[:, None])))
    modes = set_modes(meshed.model, stiffness[0], stiffness[1])
    found = LinearSet(meshed, (stiffness[0], stiffness[1]), modes, damping_ratio, np.array(error), harmonics)
    if exactness is None:
        return found
    (sun, of_sun), (ring, of_ring) = exactness
    return replace(found, stiffness_error=(sun, ring), amplitude_error=np.array([of_sun, of_ring]))


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
    others : tuple of ForcedResponse
        The same with the teeth off by one of their errors each, and with all harmonics that are looked at.
    """

    coordinate: Complex
    dynamic: Complex
    mean_force: float
    mesh_frequency: Array = shown("Hz", "mesh frequency at which the set runs")
    others: tuple[ForcedResponse, ...] = ()

    def shift(self, answer: Callable[[ForcedResponse], Array]) -> Array:
        """Estimated error of an answer: its changes by the errors of the teeth and by harmonics that are missing."""
        here = answer(self)
        return np.asarray(sum((np.abs(answer(one) - here) for one in self.others), start=np.zeros_like(here)))

    @cached_property
    def _force(self) -> Array:
        """Largest dynamic force of each mesh over the cycle [N], shape (speeds, 2, planets)."""
        orders = np.arange(1, self.dynamic.shape[1] + 1)
        turn = np.exp(2j * math.pi * np.outer(np.arange(_SAMPLES) / _SAMPLES, orders))
        return np.asarray(np.abs(2.0 * np.real(np.einsum("tl,wlan->wtan", turn, self.dynamic))).max(axis=1))

    @property
    @shows("N", "largest dynamic force in a mesh with the sun, above the mean force", label="dynamic force at the sun")
    def sun_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 0].max(axis=1))

    @property
    @shows(
        "N", "largest dynamic force in a mesh with the ring, above the mean force", label="dynamic force at the ring"
    )
    def ring_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 1].max(axis=1))

    @property
    @shows("N", "largest dynamic force in a mesh, above the mean force")
    def largest_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force.max(axis=(1, 2)))

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


def enough_harmonics(linear: LinearSet, mesh_frequency: ArrayLike, tolerance: float) -> LinearSet:
    """The set with as many harmonics as leave the largest dynamic forces at all speeds within a tolerance.

    Parameters
    ----------
    linear : LinearSet
        Whose harmonics are not given.
    mesh_frequency : array_like
        [Hz].
    tolerance : float
        Of the largest force at each speed.
    """
    frequency = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    every = _response(linear, frequency, linear.error.shape[2])
    for count in _LADDER:
        missing = np.abs(_first(every, count).largest_force - every.largest_force)
        if (missing <= tolerance * every.largest_force).all():
            break
    return replace(linear, harmonics=count)


def _first(response: ForcedResponse, count: int) -> ForcedResponse:
    return replace(response, coordinate=response.coordinate[:, :count], dynamic=response.dynamic[:, :count])


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
    count = linear.harmonics or linear.error.shape[2]
    own = _response(linear, frequency, count)
    others = [_response(one, frequency, count) for one in linear.shifted]
    return replace(own, others=(*others, _response(linear, frequency, linear.error.shape[2])))


def _response(linear: LinearSet, frequency: Array, count: int) -> ForcedResponse:
    model, modes, error = linear.meshed.model, linear.modes, linear.error[..., :count]
    harmonics = np.arange(1, count + 1)
    omega = 2.0 * math.pi * frequency[:, None] * harmonics  # (speeds, harmonics)
    natural = 2.0 * math.pi * modes.frequency
    stiffness = np.array(linear.stiffness)
    approach = model.mesh_rows @ modes.shapes  # (2, planets, modes)
    force = np.einsum("a,anl,anj->lj", stiffness, error, approach)
    dynamic_stiffness = natural**2 - omega[..., None] ** 2 + 2j * linear.damping_ratio * natural * omega[..., None]
    if np.any(np.abs(dynamic_stiffness) <= 1e-12 * np.maximum(natural**2, omega[..., None] ** 2)):
        raise RangeError(
            "speed", "a resonance", "meets a natural frequency of a set without damping",
            "give damping_ratio or leave this speed out",
        )  # fmt: skip
    modal = force / dynamic_stiffness
    relative = np.einsum("anj,wlj->wlan", approach, modal) - error.transpose(2, 0, 1)
    dynamic = stiffness[:, None] * relative
    return ForcedResponse(modal @ modes.shapes.T, dynamic, linear.meshed.mean_force, frequency)
