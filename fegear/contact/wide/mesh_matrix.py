"""Stiffness of a gear mesh as a matrix: what forces and moments small rigid motions of either gear meet.

Where the flanks touch, a small change of the approach d(z) along the contact lines changes the forces on the stations
by C_t^-1 d, C_t their tangent compliances. Rigid gears can only close d = e + phi g: the approach e along the
transverse line of action at the pitch axis, and the tilt phi in the plane of action with the lever

    g = z - x tan(beta_b),

which is a length along the contact line over cos(beta_b). So three numbers hold all of the matrix at a roll position,

    k_0 = 1.C_t^-1 1,     k_1 = 1.C_t^-1 g,     k_2 = g.C_t^-1 g,

and Blankenship and Singh's parameters (Eq. 6) are K_M = k_0 / cos^2(beta_b), along the normal, kappa =
cos(beta_b) k_1 / (b k_0) and mu = cos^2(beta_b) k_2 / (b^2 k_0), b half the face width.

Their matrix lets both gears tilt about the pitch axis. A gear tilts about its own: the axial force then has the lever
y_0 = r_b tan(alpha_wt) from it, which couples tilt and translation along the axis. `MeshStiffness.matrix` has it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.contact.fourier import Panels
from fegear.contact.wide.lines import ContactLines, base_twist
from fegear.contact.wide.load_sharing import hat_averages, tangent_compliance
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.geometry.pair import GearPair

#: Coordinates of a gear: translations, and rotations about axes through its own in the middle of the common face.
DIRECTIONS = ("x", "y", "z", "theta_x", "theta_y", "theta_z")


@dataclass(frozen=True)
class MeshStiffness(ReadOnlyArrays):
    """Tangent stiffness of a loaded mesh under rigid motions of its gears, at P roll positions under L loads.

    Parameters
    ----------
    pair : GearPair
    points : Panels
        Roll positions over one base pitch and what each stands for [m].
    load : ndarray, shape (L,)
        W, along the transverse line of action [N].
    moments : ndarray, shape (3, P, L)
        k_0 [N/m], k_1 [N] and k_2 [N m], transverse.
    lever : ndarray, shape (P, L)
        sum_i W_i g_i / W: where the force acts [m].
    stations : ndarray, shape (P, M, L)
        C_t^-1 1: what each station adds to k_0 [N/m].
    """

    pair: GearPair
    points: Panels
    load: Array
    moments: Array
    lever: Array
    stations: Array

    @property
    def half_width(self) -> float:
        """b, half the common face width [m]."""
        return 0.5 * self.pair.face_width

    @property
    def mean_moments(self) -> Array:
        """Averages over a base pitch, shape (3, L)."""
        return self.mean(np.moveaxis(self.moments, 1, 0))

    def mean(self, values: Array) -> Array:
        """Mean over a base pitch of values at the roll positions, shape (P, ...)."""
        return np.asarray(np.tensordot(self.points.weights / self.points.period, values, axes=1))

    @property
    def parameters(self) -> Array:
        """K_M [N/m], kappa and mu at every roll position, shape (3, P, L)."""
        return mesh_parameters_of(self.pair, self.moments)

    @cached_property
    def mean_parameters(self) -> Array:
        """The same of the mean matrix, shape (3, L): kappa = <k_1> / <k_0>, not the mean of kappa."""
        return mesh_parameters_of(self.pair, self.mean_moments)

    @property
    def matrix(self) -> Array:
        """Matrix over `DIRECTIONS` of the driver and then of the driven gear, shape (P, L, 12, 12) [N/m, N, N m]."""
        return mesh_matrix(self.pair, self.moments)


def mesh_stiffness(found: LoadedFlanks, points: Panels) -> MeshStiffness:
    """Tangent stiffness of loaded flanks under small rigid motions.

    Parameters
    ----------
    found : LoadedFlanks
    points : Panels
        Of its roll positions: `FlankPair.points`.

    Returns
    -------
    MeshStiffness
    """
    known, force = found.known, found.contact.force
    positions, _, cases = force.shape
    lever = hat_averages(known.lines, tilt_lever(found.pair, known.lines))
    moments, stations = np.zeros((3, positions, cases)), np.zeros(force.shape)
    place = np.arange(positions)
    for case in range(cases):
        active = force[:, :, case] > 0.0
        matrix = tangent_compliance(known, place, force[:, :, case])
        ways = np.stack([active.astype(float), np.where(active, lever, 0.0)], axis=2)
        moved = stiffness_of(matrix, active, ways)
        moments[0, :, case] = np.einsum("pm,pm->p", ways[:, :, 0], moved[:, :, 0])
        moments[1, :, case] = np.einsum("pm,pm->p", ways[:, :, 1], moved[:, :, 0])
        moments[2, :, case] = np.einsum("pm,pm->p", ways[:, :, 1], moved[:, :, 1])
        stations[:, :, case] = moved[:, :, 0]
    arm = np.einsum("pml,pm->pl", force, lever) / found.load
    return MeshStiffness(found.pair, points, found.load, moments, arm, stations)


def tilt_lever(pair: GearPair, lines: ContactLines) -> Array:
    """g = z - x tan(beta_b) at the stations, shape (P, M) [m]; zero where there is none."""
    return np.where(lines.present, lines.z - base_twist(pair) * lines.x, 0.0)


def stiffness_of(matrix: Array, active: Mask, ways: Array) -> Array:
    """Forces C_t^-1 ways on the active stations, shape (P, M, ways); none on the others.

    Parameters
    ----------
    matrix : ndarray, shape (P, M, M)
        Tangent compliances [m/N].
    active : ndarray of bool, shape (P, M)
    ways : ndarray, shape (P, M, ways)
        Displacements, zero off the active stations.
    """
    on = active.astype(float)
    system = matrix * on[:, :, None] * on[:, None, :]
    at = np.arange(on.shape[1])
    system[:, at, at] += 1.0 - on
    root = np.sqrt(np.abs(system[:, at, at]))  # in units of each station's own compliance
    system /= root[:, :, None] * root[:, None, :]
    return np.asarray(np.linalg.solve(system, ways / root[:, :, None]) / root[:, :, None])


def mesh_parameters_of(pair: GearPair, moments: Array) -> Array:
    """K_M [N/m], kappa and mu of moments (3, ...), same shape."""
    c, b = math.cos(pair.driver.base_helix_angle), 0.5 * pair.face_width
    k, k1, k2 = moments
    return np.stack([k / c**2, c * k1 / (b * k), c**2 * k2 / (b**2 * k)])


def even_moments(pair: GearPair, lines: ContactLines) -> Array:
    """Moments over their first of contact lines that are everywhere equally stiff, averaged over all, shape (3,)."""
    weight = lines.weight if lines.weight.size else np.ones(lines.roll.size)
    h, g = weight[:, None] * lines.panel, tilt_lever(pair, lines)
    g0, g1 = g[:, :-1], g[:, 1:]
    total = float(h.sum())
    first, second = float((h * (g0 + g1)).sum()) / 2.0, float((h * (g0**2 + g0 * g1 + g1**2)).sum()) / 3.0
    return np.array([1.0, first / total, second / total])


def rigid_motion_rows(pair: GearPair) -> Array:
    """What e and phi are of the motions `DIRECTIONS` of driver and driven gear, shape (2, 12).

    Axes: x across the plane of action toward the driver's axis, y along the line of action toward the driver's tip, z
    along the driver's axis, right-handed; the driver turns by -theta_z. No motion across the plane of action is felt.
    """
    t, slope = base_twist(pair), math.tan(pair.working_pressure_angle)
    rows = np.zeros((2, 12))
    for first, sign, gear in ((0, 1.0, pair.driver), (6, -1.0, pair.driven)):
        r = gear.base_radius
        # the axis lies at (sign r, -sign r tan(alpha_wt)) as seen from the pitch point's trace on the plane of action
        rows[0, first : first + 6] = sign * np.array([0.0, 1.0, t, sign * t * r * slope, sign * t * r, -sign * r])
        rows[1, first + 3] = -sign
    return rows


def mesh_matrix(pair: GearPair, moments: Array) -> Array:
    """Stiffness over `DIRECTIONS` of both gears of moments of shape (3, ...), shape (..., 12, 12)."""
    k, k1, k2 = moments
    core = np.moveaxis(np.array([[k, k1], [k1, k2]]), (0, 1), (-2, -1))
    rows = rigid_motion_rows(pair)
    return np.asarray(rows.T @ core @ rows)


def over_q(pair: GearPair, matrix: Array) -> Array:
    """A matrix over `DIRECTIONS` of both gears in q = (y, z, b theta_x, r_b theta_y, r_b theta_z), shape (10, 10)."""
    b = 0.5 * pair.face_width
    sizes = [[1.0, 1.0, b, g.base_radius, g.base_radius] for g in (pair.driver, pair.driven)]
    scale = 1.0 / np.concatenate(sizes)
    keep = [1, 2, 3, 4, 5, 7, 8, 9, 10, 11]
    return np.asarray(scale[:, None] * matrix[np.ix_(keep, keep)] * scale)
