"""Forced vibration of a planetary set by the transmission errors of its meshes, each with its phase, over speed.

Linear, with mean mesh stiffnesses: all fluctuation of the teeth stands in their static transmission error (Mark).
Forces over the cycle and their extremes come from `steady_modes`, with the jumps of the teeth and without a series.
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
from fegear.dynamics.planetary.cycle_extremes import CycleForces, cycle_extremes
from fegear.dynamics.planetary.planet_set import CENTRALS, Central
from fegear.dynamics.planetary.set_cycle import MeshedSet
from fegear.dynamics.planetary.set_modes import SetModes, set_modes
from fegear.dynamics.planetary.steady_modes import on_common_pieces, steady_modes
from fegear.dynamics.train.periodic import Periodic

#: Harmonics of which errors are known one by one: estimates alone take a series, the answer has all of them.
SHOWN_HARMONICS = 256
#: How closely fluctuations of the teeth are followed, relative to their largest value, and what that and the places of
#: a cycle leave of a force, relative to it and to the force of the fluctuation itself.
_FITTED, _LEFT = 1e-7, 2e-7
#: Times the error of a mode's own frequency beyond which the one of its number is another mode's.
_CROSSED = 1.1
#: Speeds that are solved together.
_SPEEDS = 16


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
    fluctuation : (Periodic, Periodic)
        Static transmission error of each mesh under the mean force less its mean, over the mesh's own phase [m].
    harmonics : int
        Of which the answer gives complex amplitudes; forces over the cycle have all.
    stiffness_error : (float, float)
        Estimated errors of the stiffnesses, as shares of them.
    amplitude_error : ndarray, shape (2, SHOWN_HARMONICS)
        Of the amplitudes of the transmission errors, as shares of them.
    """

    meshed: MeshedSet
    stiffness: tuple[float, float]
    modes: SetModes
    damping_ratio: float
    fluctuation: tuple[Periodic, Periodic]
    harmonics: int = 12
    stiffness_error: tuple[float, float] = (0.0, 0.0)
    amplitude_error: Array = field(default_factory=lambda: np.zeros((2, SHOWN_HARMONICS)))

    @cached_property
    def delays(self) -> Array:
        """Of every mesh's fluctuation behind the cycle [base pitches], shape (2, planets)."""
        return self.meshed.delays - np.array([[one.phase] for one in self.meshed.teeth])

    def series(self, count: int) -> Complex:
        """Harmonics 1 to count of each mesh's fluctuation, with its phase [m], shape (2, planets, count)."""
        order = np.arange(1, count + 1)
        return np.array([
            one.fourier(order) * np.exp(-2j * math.pi * order * late[:, None])
            for one, late in zip(self.fluctuation, self.delays, strict=True)
        ])  # fmt: skip

    @cached_property
    @shows("Hz", "estimated error of the natural frequency, from that of the mesh stiffnesses", name="frequency_error")
    def frequency_error(self) -> Array:
        """By Rayleigh's quotient, half of each mesh's share of the strain energy, shape (modes,) [Hz].

        No less than what softer and stiffer meshes leave of the frequencies in their order: where two modes cross
        within the errors, the one of this number may be the other, which hangs on the meshes by more.
        """
        of_sun, of_ring = self.stiffness_error
        modes = self.modes
        error = 0.5 * modes.frequency * (modes.sun_mesh * of_sun + modes.ring_mesh * of_ring)
        for sign in (-1.0, 1.0) if error.any() else ():
            sun, ring = (
                k * max(1.0 + sign * off, 0.0) for k, off in zip(self.stiffness, self.stiffness_error, strict=True)
            )
            change = np.abs(set_modes(self.meshed.model, sun, ring).frequency - modes.frequency)
            error = np.where(change > _CROSSED * error, change, error)
        return np.asarray(error)

    @cached_property
    def shifted(self) -> tuple[LinearSet, ...]:
        """The same with the stiffness of each mesh off by its error."""
        found = []
        for mesh, off in enumerate(self.stiffness_error):
            sun, ring = (k * (1.0 + off) if mesh == i else k for i, k in enumerate(self.stiffness))
            if off:
                found.append(replace(self, stiffness=(sun, ring), modes=set_modes(self.meshed.model, sun, ring)))
        return tuple(found)


def linear_set(
    meshed: MeshedSet, damping_ratio: float, harmonics: int = 12,
    exactness: tuple[tuple[float, Array], tuple[float, Array]] | None = None,
) -> LinearSet:  # fmt: skip
    """The set about its mean load.

    Parameters
    ----------
    meshed : MeshedSet
    damping_ratio : float
    harmonics : int
        Of the mesh frequency, of which the answer gives complex amplitudes; its forces over the cycle have all.
    exactness : pair of (float, ndarray of shape (SHOWN_HARMONICS,)), optional
        Estimated errors of the stiffness of each mesh and of the amplitudes of its transmission error, as shares.

    Raises
    ------
    RangeError
        If the damping ratio is negative or one and more.
    """
    if not 0.0 <= damping_ratio < 1.0:
        raise RangeError("damping_ratio", damping_ratio, "must be at least 0 and below 1")
    stiffness, fluctuation = [], []
    for one, force in zip(meshed.teeth, meshed.mean_forces, strict=True):
        compliance, over = one.linearised(force)
        stiffness.append(1.0 / compliance)
        few = over.coarser(_FITTED)
        fluctuation.append(few.plus(-few.mean))
    modes = set_modes(meshed.model, stiffness[0], stiffness[1])
    (sun, ring), (of_sun, of_ring) = stiffness, fluctuation
    found = LinearSet(meshed, (sun, ring), modes, damping_ratio, (of_sun, of_ring), harmonics)
    if exactness is None:
        return found
    (sun, shares_sun), (ring, shares_ring) = exactness
    return replace(found, stiffness_error=(sun, ring), amplitude_error=np.array([shares_sun, shares_ring]))


@dataclass(frozen=True)
class ForcedResponse:
    """Vibration over the mesh frequency: complex amplitudes of harmonics l, of 2 Re(a exp(2 pi i l f t)), and extremes.

    Parameters
    ----------
    coordinate : ndarray, complex, shape (speeds, harmonics, size)
        Of every coordinate of `SetModel` [m].
    dynamic : ndarray, complex, shape (speeds, harmonics, 2, planets)
        Dynamic force in each mesh [N].
    extremes : ndarray, shape (speeds, 2, 2, planets)
        Largest (0) and smallest (1) dynamic force in each mesh over the cycle, with all harmonics [N].
    sizes : ndarray, shape (speeds, size)
        Root of the sum of squares of all harmonics of each coordinate, 0-peak [m].
    mean_force : float
        In every mesh with the sun [N].
    mesh_frequency : ndarray, shape (speeds,)
    others : tuple of ForcedResponse
        The same with the teeth off by one of their errors each, and by what numbers leave.
    ring_lever : float
        Mean force in the sun's meshes over that in the ring's (`PlanetarySet.ring_lever`).
    """

    coordinate: Complex
    dynamic: Complex
    extremes: Array
    sizes: Array
    mean_force: float
    mesh_frequency: Array = shown("Hz", "mesh frequency")
    others: tuple[ForcedResponse, ...] = ()
    ring_lever: float = 1.0

    def shift(self, answer: Callable[[ForcedResponse], Array]) -> Array:
        """Estimated error of an answer: its changes by the errors of the teeth and of the numbers."""
        here = answer(self)
        return np.asarray(sum((np.abs(answer(one) - here) for one in self.others), start=np.zeros_like(here)))

    @cached_property
    def _force(self) -> Array:
        """Largest size of the dynamic force of each mesh over the cycle [N], shape (speeds, 2, planets)."""
        return np.asarray(np.maximum(self.extremes[:, 0], -self.extremes[:, 1]))

    @property
    @shows("N", "maximum dynamic force of a sun mesh (above the mean)", label="dynamic force, sun mesh")
    def sun_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 0].max(axis=1))

    @property
    @shows("N", "maximum dynamic force of a ring mesh (above the mean)", label="dynamic force, ring mesh")
    def ring_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force[:, 1].max(axis=1))

    @property
    @shows("N", "maximum dynamic mesh force (above the mean)")
    def largest_force(self) -> Array:
        """Shape (speeds,)."""
        return np.asarray(self._force.max(axis=(1, 2)))

    @property
    @shows("", "minimum / mean mesh force; negative: loss of contact (not modelled)")
    def least_share(self) -> Array:
        """Shape (speeds,)."""
        smallest = self.extremes[:, 1].min(axis=2) * [1.0, self.ring_lever]
        return np.asarray(1.0 + smallest.min(axis=1) / self.mean_force)

    def amplitude(self, member: Central, axis: int) -> Array:
        """Root of the sum of squares of a coordinate's harmonics [m], 0-peak, shape (speeds,).

        Parameters
        ----------
        member : {"sun", "ring", "carrier"}
        axis : int
            0 for x, 1 for y, 2 for the rotation.
        """
        return np.asarray(self.sizes[:, 3 * CENTRALS.index(member) + axis])


def forced_response(linear: LinearSet, mesh_frequency: ArrayLike) -> ForcedResponse:
    """Steady vibration at mesh frequencies [Hz].

    M q'' + C q' + K q = sum over the meshes of their rows times k e, mode by mode; the dynamic force in a mesh is
    k (row q - e), which jumps where e does.

    Raises
    ------
    RangeError
        If a frequency is not positive, or meets a natural frequency of a set without damping.
    """
    frequency = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if not np.all(frequency > 0.0):
        raise RangeError("speed", float(frequency.min()), "must be positive", "use the static result for zero speed")
    own, place = _response(linear, frequency)
    others = [_response(one, frequency)[0] for one in linear.shifted]
    if linear.amplitude_error.any():
        others.append(_amplitudes_off(linear, own, place))
    alone = np.array(linear.stiffness) * [np.abs(one.coefficients).sum(axis=1).max() for one in linear.fluctuation]
    others.append(_off(own, _LEFT * (np.abs(own.extremes) + alone[:, None]), _LEFT * own.sizes))
    return replace(own, others=tuple(others))


def _response(linear: LinearSet, frequency: Array) -> tuple[ForcedResponse, Array]:
    """Without estimates; and where the extremes stand [cycles], of their shape."""
    count, modes = linear.meshed.model.count, linear.modes
    flexible = modes.frequency > 0.0  # free turning of the whole set is not felt
    natural, shapes = 2.0 * math.pi * modes.frequency[flexible], modes.shapes[:, flexible]
    rows = (linear.meshed.model.mesh_rows @ shapes).reshape(2 * count, -1)
    stiffness = np.repeat(linear.stiffness, count)
    error = on_common_pieces([one for one in linear.fluctuation for _ in range(count)], linear.delays.ravel())
    push = np.einsum("f,fj,fsn->jsn", stiffness, rows, error.rows)
    forces = CycleForces(stiffness, rows, error)
    extremes = np.empty((frequency.size, 2, 2 * count))
    place = np.empty_like(extremes)
    sizes = np.empty((frequency.size, shapes.shape[0]))
    for first in range(0, frequency.size, _SPEEDS):
        own = slice(first, first + _SPEEDS)
        for at, one in enumerate(
            steady_modes(natural, linear.damping_ratio, 1.0 / frequency[own], error.widths, push), first
        ):
            found = cycle_extremes(one, natural, forces)
            extremes[at], place[at] = found.force, found.place
            sizes[at] = np.sqrt(2.0 * np.einsum("cj,jk,ck->c", shapes, found.squares, shapes).clip(min=0.0))
    coordinate, dynamic = (part.sum(axis=0) for part in _harmonics(linear, frequency, linear.harmonics))
    shape = (frequency.size, 2, 2, count)
    found_response = ForcedResponse(
        coordinate,
        dynamic,
        extremes.reshape(shape),
        sizes,
        linear.meshed.mean_force,
        frequency,
        ring_lever=linear.meshed.model.found.ring_lever,
    )
    return found_response, place.reshape(shape)


def _harmonics(linear: LinearSet, frequency: Array, count: int) -> tuple[Complex, Complex]:
    """Complex amplitudes of coordinates and mesh forces, by the teeth of the sun's and of the ring's meshes apart.

    Shapes (2, speeds, count, size) and (2, speeds, count, 2, planets).
    """
    model, modes, error = linear.meshed.model, linear.modes, linear.series(count)
    omega = 2.0 * math.pi * frequency[:, None] * np.arange(1, count + 1)  # (speeds, harmonics)
    flexible = modes.frequency > 0.0
    natural, shapes = 2.0 * math.pi * modes.frequency[flexible], modes.shapes[:, flexible]
    stiffness = np.array(linear.stiffness)
    approach = model.mesh_rows @ shapes  # (2, planets, modes)
    force = np.einsum("a,anl,anj->alj", stiffness, error, approach)
    dynamic_stiffness = natural**2 - omega[..., None] ** 2 + 2j * linear.damping_ratio * natural * omega[..., None]
    modal = force[:, None] / dynamic_stiffness
    by_modes = modal @ approach.reshape(-1, natural.size).T
    relative = by_modes.reshape(*modal.shape[:-1], 2, model.count)
    for mesh in (0, 1):
        relative[mesh, :, :, mesh] -= error[mesh].T
    return modal @ shapes.T, stiffness[:, None] * relative


def _amplitudes_off(linear: LinearSet, own: ForcedResponse, place: Array) -> ForcedResponse:
    """The vibration with the transmission errors off by the errors of their amplitudes.

    Forces change by what these errors make at the places of the extremes, to the first order; and no less than if each
    harmonic's error had a phase of its own.
    """
    share = linear.amplitude_error
    force, size = np.zeros_like(own.extremes), np.zeros_like(own.sizes)
    order = np.arange(1, SHOWN_HARMONICS + 1)
    beyond = _share_of_the_rest(linear)
    for first in range(0, own.mesh_frequency.size, _SPEEDS):
        at = slice(first, first + _SPEEDS)
        coordinate, dynamic = _harmonics(linear, own.mesh_frequency[at], SHOWN_HARMONICS)
        turn = np.exp(2j * math.pi * place[at][..., None] * order)  # (speeds, 2, 2, planets, harmonics)
        shown_there = np.zeros_like(own.extremes[at])
        for mesh in (0, 1):
            there = 2.0 * np.real(np.einsum("wsanl,wlan->wsanl", turn, dynamic[mesh]))
            shown_there += there.sum(axis=-1)
            apart = np.sqrt(((2.0 * share[mesh][:, None, None] * np.abs(dynamic[mesh])) ** 2).sum(axis=1))
            force[at] += np.maximum(np.abs(there @ share[mesh]), apart[:, None])
            size[at] += np.sqrt(((2.0 * share[mesh][:, None] * np.abs(coordinate[mesh])) ** 2).sum(axis=1))
        force[at] += beyond * np.abs(own.extremes[at] - shown_there)
    return _off(own, force, size)


def _share_of_the_rest(linear: LinearSet) -> float:
    """Error of the harmonics that are not known one by one, as a share of them: that of the highest that are."""
    high = slice(SHOWN_HARMONICS // 2, None)
    size = np.abs(linear.series(SHOWN_HARMONICS)[:, 0, high])
    off = np.sqrt(((linear.amplitude_error[:, high] * size) ** 2).sum(axis=1))
    whole = np.sqrt((size**2).sum(axis=1))
    return float(np.divide(off, whole, out=np.zeros_like(off), where=whole > 0.0).max())


def _off(own: ForcedResponse, force: Array, size: Array) -> ForcedResponse:
    """With extremes farther out by so much, and larger sizes."""
    return replace(own, extremes=own.extremes + force * np.array([1.0, -1.0])[:, None, None], sizes=own.sizes + size)
