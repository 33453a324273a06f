"""Stiffness matrix of a loaded mesh as it is shown: over a base pitch, its mean, harmonics, loads and excitation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Complex
    from fegear.contact.fourier import Panels
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.mesh_matrix import MeshStiffness

#: Kappa about both axes that differs by less is one for its user.
_ALIKE = 1e-3


@dataclass(frozen=True)
class MeshOverRoll:
    """Stiffness of a mesh at every roll position under the nominal load, arrays of shape (P,)."""

    stiffness_error: Array
    kappa_error: Array
    mu_error: Array
    half_width: float
    roll: Array = shown("mm", "mesh position")
    stiffness: Array = shown(
        "N/um", "tangent stiffness along the tooth normal, over all pairs", name="K_M", label="K_M"
    )
    kappa: Array = shown("", "lever of the stiffness in the plane of action / half face width", label="kappa")
    mu: Array = shown("", "rotational stiffness / (K_M b^2)", label="mu")
    transverse: Array = shown("N/um", "dW/dzeta along the transverse line of action", name="transverse_stiffness")
    lever: Array = shown("mm", "lever of the normal force in the plane of action", name="force_lever")

    @property
    @shows("", "lever of the force / b")
    def relative_lever(self) -> Array:
        """In halves of the face width."""
        return self.lever / self.half_width

    @property
    @shows("mm", "range of axial shuttling of the normal force", name="force_lever_peak_to_peak")
    def lever_peak_to_peak(self) -> float:
        """[m]."""
        return float(np.ptp(self.lever))


@dataclass(frozen=True)
class MatrixColumn:
    """Forces per motion of one coordinate."""

    name: str
    force: Array = shown(
        "N/um",
        "force on the coordinate of the row per motion of this coordinate; rotations as arcs at b or the base radius",
    )


@dataclass(frozen=True)
class MeanMatrix:
    """Mean stiffness matrix of a mesh, each gear turning about its own axis."""

    matrix: Array = shown("N/um", "stiffness")
    place: Array = shown("", "number of the coordinate")
    coordinate: NDArray[np.str_] = shown("", "right-handed coordinates at the gear axis")

    @property
    def columns(self) -> list[MatrixColumn]:
        """One for each coordinate."""
        return [MatrixColumn(*one) for one in zip(self.coordinate.tolist(), self.matrix.T, strict=True)]

    @property
    def size(self) -> float:
        """Of its largest entry [N/m]."""
        return float(np.abs(self.matrix).max())


@dataclass(frozen=True)
class StiffnessHarmonics:
    """Lines of the mesh stiffness and of the lever of the force, n = 1 to N."""

    n: NDArray[np.int64] = shown("", "harmonic of the mesh frequency", table="harmonics")
    stiffness: Array = shown("N/um", "0-peak", name="K_M", table="harmonics")
    coupling: Array = shown("N/um", "amplitude, coupling of translation and tilt", name="kappa_K_M", table="harmonics")
    rotary: Array = shown("N/um", "amplitude, rotational stiffness / b^2", name="mu_K_M", table="harmonics")
    lever: Array = shown(
        "mm", "amplitude of the axial shuttling of the force at constant load", name="force_lever", table="harmonics"
    )


@dataclass(frozen=True)
class StiffnessOverLoads:
    """Mean stiffness of a mesh under every load, arrays of shape (L,)."""

    load: Array = shown("N", "along the transverse line of action", table="loads")
    stiffness: Array = shown("N/um", "value of the mean matrix", name="K_M", table="loads")
    kappa: Array = shown("", "value of the mean matrix", table="loads")
    mu: Array = shown("", "value of the mean matrix", table="loads")
    lever: Array = shown("mm", "mean over the base pitch", name="force_lever", table="loads")


@dataclass(frozen=True)
class MeanStiffness:
    """Numbers of the mean matrix under the nominal load, and their estimated errors."""

    stiffness_error: float
    kappa_error: float
    mu_error: float
    tilt_error: float
    lever_error: float
    stiffness: float = shown("N/um", "mean mesh stiffness along the tooth normal", name="K_M")
    kappa: float = shown(
        "", "mean lever of the mesh stiffness about the pitch axis / half face width", name="mesh_kappa"
    )
    mu: float = shown("", "mean rotational stiffness / (K_M b^2)", name="mesh_mu")
    mu_even: float = shown("", "mu for uniform stiffness along the contact lines", name="mesh_mu_even")
    kappa_even: float = shown("", "kappa of uniformly stiff contact lines", name="mesh_kappa_even")
    tilt: float = shown("N.m", "moment per radian: K_M mu b^2", name="mesh_tilt_stiffness")
    kappa_driver: float = shown("", "kappa about the driver axis", name="mesh_kappa_driver")
    kappa_driven: float = shown("", "kappa about the driven axis", name="mesh_kappa_driven")
    mu_driver: float = shown("", "mu about the driver axis", name="mesh_mu_driver")
    mu_driven: float = shown("", "mu about the driven axis", name="mesh_mu_driven")
    lever: float = shown("mm", "mean lever of the normal force", name="force_lever")

    @property
    def two_kappas(self) -> bool:
        """Whether both gears, each about its own axis, have a kappa of their own."""
        return abs(self.kappa_driver - self.kappa_driven) > _ALIKE


@dataclass(frozen=True)
class MeshStiffnessData:
    """Stiffness matrix of a mesh under its loads.

    Parameters
    ----------
    flanks : LoadedWidePair
    found, other : MeshStiffness
        And what the coarser solution gives.
    even : ndarray, shape (3,)
        K_M over its own mean, kappa and mu of contact lines that are everywhere equally stiff.
    """

    flanks: LoadedWidePair
    found: MeshStiffness
    other: MeshStiffness
    even: Array

    @property
    def mean(self) -> Array:
        """K_M [N/m], kappa and mu of the mean matrix under the nominal load."""
        return np.asarray(self.found.mean_parameters[:, self.flanks.at])

    @property
    def mean_error(self) -> Array:
        """Their estimated errors: of the coarser solution, and of half as many roll positions."""
        from fegear.contact.wide.mesh_matrix import mesh_parameters_of
        from fegear.contact.wide.transmission_error import from_half

        i, found = self.flanks.at, self.found
        fewer = np.stack([from_half(found.points, moment) for moment in found.moments[:, :, i]], axis=1)
        half = mesh_parameters_of(found.pair, found.mean(fewer))
        return np.asarray(np.abs(self.other.mean_parameters[:, i] - self.mean) + np.abs(half - self.mean))

    @property
    def mean_over_q(self) -> Array:
        """Mean matrix under the nominal load over q of both gears, shape (10, 10) [N/m]; see `over_q`."""
        from fegear.contact.wide.mesh_matrix import over_q

        return over_q(self.found.pair, self.found.mean(self.found.matrix[:, self.flanks.at]))

    @property
    def _slope(self) -> float:
        """From the transverse section to the normal of the teeth."""
        return math.cos(self.found.pair.driver.base_helix_angle)

    @cached_property
    def over_roll(self) -> MeshOverRoll:
        """At every roll position under the nominal load."""
        i, found = self.flanks.at, self.found
        parameters, doubt = found.parameters[:, :, i], np.abs(self.other.parameters - found.parameters)[:, :, i]
        (stiffness, kappa, mu), (stiffness_off, kappa_off, mu_off) = parameters, doubt
        return MeshOverRoll(
            stiffness_off, kappa_off, mu_off, found.half_width, self.flanks.found.lines.roll, stiffness, kappa, mu,
            found.moments[0, :, i], self._slope * found.lever[:, i],
        )  # fmt: skip

    @cached_property
    def mean_matrix(self) -> MeanMatrix:
        """Under the nominal load."""
        names = [f"{coordinate}_{gear}" for gear in ("driver", "driven")
                 for coordinate in ("y", "z", "b_theta_x", "r_theta_y", "r_theta_z")]  # fmt: skip
        return MeanMatrix(self.mean_over_q, np.arange(len(names), dtype=float), np.array(names, dtype=str))

    @property
    def harmonics(self) -> StiffnessHarmonics:
        """Under the nominal load."""
        from fegear.contact.wide.transmission_error import series_over_pitch

        i, found, c, b = self.flanks.at, self.found, self._slope, self.found.half_width
        scale = (1.0 / c**2, 1.0 / (c * b), 1.0 / b**2, c)
        curves = (*found.moments[:, :, i], found.lever[:, i])
        series = [series_over_pitch(found.points, k * curve).amplitude for k, curve in zip(scale, curves, strict=True)]
        return StiffnessHarmonics(np.arange(1, series[0].size + 1), *series)

    @property
    def over_loads(self) -> StiffnessOverLoads:
        """Under every load."""
        lever = self._slope * self.found.mean(self.found.lever)
        stiffness, kappa, mu = self.found.mean_parameters
        return StiffnessOverLoads(self.flanks.found.load, stiffness, kappa, mu, lever)

    @cached_property
    def means(self) -> MeanStiffness:
        """Under the nominal load."""
        (stiffness, kappa, mu), (off, kappa_off, mu_off) = self.mean.tolist(), self.mean_error.tolist()
        (kappa_i, mu_i), (kappa_j, mu_j) = own_axis_parameters(self)
        i, found, b = self.flanks.at, self.found, self.found.half_width
        tilt, tilt_off = stiffness * mu * b**2, b**2 * (mu * off + stiffness * mu_off)
        lever_off = self._slope * float(np.abs(self.other.lever[:, i] - found.lever[:, i]).max())
        lever = float(found.mean(self.over_roll.lever))
        return MeanStiffness(
            off, kappa_off, mu_off, tilt_off, lever_off, stiffness, kappa, mu, float(self.even[2]),
            float(self.even[1]), tilt, kappa_i, kappa_j, mu_i, mu_j, lever,
        )  # fmt: skip


def own_axis_parameters(data: MeshStiffnessData) -> tuple[tuple[float, float], tuple[float, float]]:
    """Kappa and mu of driver and driven gear that tilt about their own axes: the axial force has a lever there."""
    pair, (_, kappa, mu) = data.found.pair, data.mean
    from fegear.contact.wide.lines import base_twist

    s = math.sin(math.atan(base_twist(pair))) * math.tan(pair.working_pressure_angle) / data.found.half_width
    moves = (-s * pair.driver.base_radius, s * pair.driven.base_radius)
    first, second = ((float(kappa + d), float(mu + 2.0 * kappa * d + d * d)) for d in moves)
    return first, second


def loaded_harmonics(data: MeshStiffnessData, count: int, shuttling: bool) -> tuple[Complex, Array]:
    """Harmonics of the static transmission error of loaded flanks over q = (y, z, b theta_x, ...), and their errors.

    Along y it is the transmission error. With `shuttling` the moment of the force about x varies as well: the motion
    that would hold both force and moment level is (y, b theta_x), for the mean stiffness matrix.

    Parameters
    ----------
    data : MeshStiffnessData
    count : int
        At most half as many as roll positions.
    shuttling : bool

    Returns
    -------
    ndarray of complex, shape (N, 5)
        0-peak [m].
    ndarray, shape (N, 5)
        Changes by the coarser solution, and by half as many roll positions as of `no_less_than_shown_by_half`.
    """
    from fegear.contact.error_over_pitch import no_less_than_beside
    from fegear.contact.wide.transmission_error import no_less_than_shown_by_half, of_half

    flanks = data.flanks
    found, other = (_over_q(one, te, flanks.at, shuttling) for one, te in (
        (data.found, flanks.found.transmission_error), (data.other, flanks.error.coarse.transmission_error)
    ))  # fmt: skip
    points = data.found.points
    fewer = np.stack([of_half(points, curve) for curve in found.T], axis=1)
    series, half, coarse = (_series(points, curves) for curves in (found, fewer, other))
    by_positions, by_gears = np.abs(series - half), np.abs(series - coarse)
    each = [
        no_less_than_beside(no_less_than_shown_by_half(one) + two)
        for one, two in zip(by_positions.T, by_gears.T, strict=True)
    ]
    return series[:count], np.stack(each, axis=1)[:count]


def _series(points: Panels, curves: Array) -> Complex:
    """Complex 0-peak amplitudes of curves (P, k) over the base pitch that the roll positions show, shape (N, k)."""
    from fegear.contact.wide.transmission_error import series_over_pitch

    return np.stack([2.0 * series_over_pitch(points, curve).coefficients[1:] for curve in curves.T], axis=1)


def _over_q(one: MeshStiffness, te: Array, case: int, shuttling: bool) -> Array:
    """Static transmission error over q at every roll position, shape (P, 5) [m]."""
    error = np.zeros((te.shape[0], 5))
    error[:, 0] = te[:, case]
    if shuttling:
        k, k1, k2 = one.mean_moments[:, case]
        load = (one.lever[:, case] - one.mean(one.lever[:, case])) * one.load[case]
        tilt = -load / (k2 - k1**2 / k)
        error[:, 0] -= k1 / k * tilt
        error[:, 2] = one.half_width * tilt
    return error
