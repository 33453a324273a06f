"""Helical gear pair as ten degrees of freedom on its bearings (Blankenship and Singh, sections 2 and 4).

Each gear moves by q = (y, z, b theta_x, a theta_y, a theta_z): y along the plane of action, z along the axis, a the
base radius, b half the face width. The mesh deflects by q_i + P q_j with P = diag(-1, -1, -1, +1, +1)::

    [ M_i     ] q_i''   [ K_M      K_M P  ] q_i   [ B_i     ] q_i   f_i
    [     M_j ] q_j'' + [ P K_M  P K_M P  ] q_j + [     B_j ] q_j = f_j      and likewise for damping

The lower right block is P K_M P; the paper's printed Eq. 7 has other signs and is indefinite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError, InputError, RangeError
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.train.modes import undamped_modes

#: Signs that carry the motion of gear j into the mesh deflection.
P = np.diag([-1.0, -1.0, -1.0, 1.0, 1.0])

#: Names of the five coordinates of a gear.
COORDINATES = ("y", "z", "theta_x", "theta_y", "theta_z")


def _no_matrix() -> Array:
    return np.zeros((5, 5))


@dataclass(frozen=True, eq=False)
class RigidGear:
    """A rigid gear on its bearings.

    Parameters
    ----------
    mass : float
        m [kg].
    inertia : tuple of float
        I_x, I_y, I_z [kg m^2].
    base_radius : float
        a [m].
    half_face_width : float
        b [m].
    bearing_stiffness, bearing_damping : ndarray, shape (5, 5)
        Over (y, z, theta_x, theta_y, theta_z): N/m, N/rad, N m/rad and times s; symmetric, no negative eigenvalue.
    """

    mass: float
    inertia: tuple[float, float, float]
    base_radius: float
    half_face_width: float
    bearing_stiffness: Array = field(default_factory=_no_matrix)
    bearing_damping: Array = field(default_factory=_no_matrix)

    def __post_init__(self) -> None:
        """Refuse what is no rigid body on passive bearings."""
        positive = {"mass": self.mass, "base_radius": self.base_radius, "half_face_width": self.half_face_width}
        positive |= {f"inertia[{n}]": value for n, value in enumerate(self.inertia)}
        for key, value in positive.items():
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"gear.{key}", value, "must be positive and finite")
        for key in ("bearing_stiffness", "bearing_damping"):
            matrix = np.array(getattr(self, key), dtype=float)
            scaled = self.scale[:, None] * matrix * self.scale
            if matrix.shape != (5, 5) or not np.all(np.isfinite(matrix)):
                raise InputError(f"gear.{key}", f"shape {matrix.shape}", "must be a finite 5 by 5 matrix")
            if np.abs(scaled - scaled.T).max() > 1e-9 * max(np.abs(scaled).max(), 1e-300):
                raise InputError(f"gear.{key}", "matrix", "must be symmetric")
            if np.linalg.eigvalsh(scaled).min() < -1e-9 * np.abs(scaled).max():
                raise RangeError(
                    f"gear.{key}",
                    "matrix",
                    "has a negative eigenvalue",
                    "bearing stiffness must be positive semi-definite",
                )
            matrix.setflags(write=False)
            object.__setattr__(self, key, matrix)

    @property
    def scale(self) -> Array:
        """Diagonal of D^-1 with D = diag(1, 1, b, a, a) (Eq. 2)."""
        a, b = self.base_radius, self.half_face_width
        return np.array([1.0, 1.0, 1.0 / b, 1.0 / a, 1.0 / a])

    @property
    def masses(self) -> Array:
        """Diagonal of D^-1 M D^-1 [kg]."""
        return np.array([self.mass, self.mass, *self.inertia]) * self.scale**2

    def in_q(self, matrix: Array) -> Array:
        """D^-1 matrix D^-1: a bearing matrix over q [N/m or N s/m]."""
        return self.scale[:, None] * matrix * self.scale


@dataclass(frozen=True, eq=False)
class HelicalPairModel:
    """Two rigid gears, their bearings and the mesh between them; all matrices in N/m, N s/m and kg over (q_i, q_j).

    Parameters
    ----------
    driver, driven : RigidGear
        Gears i and j.
    mesh : MeshParameters
    mesh_damping : ndarray, shape (5, 5), or float
        C_M [N s/m] over q, or its ratio to the mesh stiffness matrix [s].
    modal_damping : float
        Uniform damping ratio added to every flexible mode.
    """

    driver: RigidGear
    driven: RigidGear
    mesh: MeshParameters
    mesh_damping: Array | float = 0.0
    modal_damping: float = 0.0

    def __post_init__(self) -> None:
        """Refuse negative damping."""
        if not (math.isfinite(self.modal_damping) and self.modal_damping >= 0.0):
            raise InputError("modal_damping", self.modal_damping, "must be finite and not negative")
        damping = np.asarray(self.mesh_damping, dtype=float)
        matrix = damping * self.mesh.matrix() if damping.ndim == 0 else damping
        if matrix.shape != (5, 5) or not np.all(np.isfinite(matrix)):
            raise InputError("mesh_damping", f"shape {matrix.shape}", "must be one number or a finite 5 by 5 matrix")
        if np.abs(matrix - matrix.T).max() > 1e-9 * max(np.abs(matrix).max(), 1e-300):
            raise InputError("mesh_damping", "matrix", "must be symmetric")
        if np.linalg.eigvalsh(matrix).min() < -1e-9 * np.abs(matrix).max():
            raise RangeError(
                "mesh_damping", "matrix", "has a negative eigenvalue", "mesh damping must be positive semi-definite"
            )

    @cached_property
    def mesh_stiffness_matrix(self) -> Array:
        """K_M over q [N/m], shape (5, 5) (Eq. 6)."""
        return self.mesh.matrix()

    @cached_property
    def mesh_damping_matrix(self) -> Array:
        """C_M over q [N s/m], shape (5, 5)."""
        damping = np.asarray(self.mesh_damping, dtype=float)
        return np.asarray(damping * self.mesh_stiffness_matrix if damping.ndim == 0 else damping)

    @cached_property
    def mass(self) -> Array:
        """Diagonal of the mass matrix [kg], shape (10,)."""
        return np.concatenate([self.driver.masses, self.driven.masses])

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness matrix [N/m], shape (10, 10) (Eq. 4)."""
        i, j = self.driver, self.driven
        return _assemble(self.mesh_stiffness_matrix, i.in_q(i.bearing_stiffness), j.in_q(j.bearing_stiffness))

    @cached_property
    def damping(self) -> Array:
        """Damping matrix [N s/m], shape (10, 10) (Eq. 8), with the uniform modal damping added."""
        i, j = self.driver, self.driven
        matrix = _assemble(self.mesh_damping_matrix, i.in_q(i.bearing_damping), j.in_q(j.bearing_damping))
        if self.modal_damping > 0.0:
            frequency, shape = undamped_modes(self.mass, self.stiffness)
            weighted = self.mass[:, None] * shape
            matrix = matrix + (weighted * (2.0 * self.modal_damping * frequency)) @ weighted.T
        return matrix

    @property
    def equivalent_mass(self) -> float:
        """m_eq [kg] of the torsional pair."""
        i, j = self.driver.masses[4], self.driven.masses[4]
        return float(i * j / (i + j))

    @property
    def natural_frequency(self) -> float:
        """omega = sqrt(K_M/m_eq) [rad/s], the scale of the dimensionless frequency Lambda."""
        return math.sqrt(self.mesh.stiffness / self.equivalent_mass)

    @property
    def symmetric(self) -> bool:
        """Whether both gears are equal and their bearings mirrored, so that `reduced` holds."""
        i, j = self.driver, self.driven
        same = np.allclose(i.masses, j.masses, rtol=1e-12, atol=0.0)
        for key in ("bearing_stiffness", "bearing_damping"):
            mine, other = i.in_q(getattr(i, key)), P @ j.in_q(getattr(j, key)) @ P
            same = same and np.abs(mine - other).max() <= 1e-12 * max(np.abs(mine).max(), 1e-300)
        return bool(same)

    def reduced(self) -> ReducedPairModel:
        """The five degrees of freedom q = q_i + P q_j of a unity-ratio pair (section 4.1).

        Raises
        ------
        GeometryError
            If the gears differ or the bearings are not mirrored.
        """
        if not self.symmetric:
            raise GeometryError(
                "pair", "unequal gears or bearings", "couple the motions of both gears; five coordinates are not "
                                                     "sufficient",
                "use the general model",
            )  # fmt: skip
        i = self.driver
        return ReducedPairModel(
            self.mesh, i.masses, i.in_q(i.bearing_stiffness), self.mesh_damping_matrix, i.in_q(i.bearing_damping),
            self.modal_damping, self.equivalent_mass,
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ReducedPairModel:
    """Unity-ratio pair: m q'' + c q' + (2 K_M + k_B) q = f_i + P f_j with q = q_i + P q_j.

    Parameters
    ----------
    mesh : MeshParameters
    mass : ndarray, shape (5,)
        Diagonal mass [kg] of one gear over q.
    bearing_stiffness : ndarray, shape (5, 5)
        k_B [N/m] of one gear over q.
    mesh_damping_matrix, bearing_damping : ndarray, shape (5, 5)
        C_M and c_B of one gear over q [N s/m].
    modal_damping : float
        Uniform damping ratio added to every flexible mode.
    equivalent_mass : float
        m_eq [kg].
    """

    mesh: MeshParameters
    mass: Array
    bearing_stiffness: Array
    mesh_damping_matrix: Array
    bearing_damping: Array
    modal_damping: float
    equivalent_mass: float

    @classmethod
    def from_ratios(
        cls,
        mesh: MeshParameters,
        *,
        mass: float,
        aspect_ratio: float,
        alpha_y: float,
        alpha_z: float,
        alpha_theta: float,
        modal_damping: float = 0.0,
    ) -> ReducedPairModel:
        """The paper's example from its dimensionless numbers (Tables 1 and 2).

        m/m_eq = diag(2, 2, 1/nu^4, 1, 2), k_B/K_M = diag(alpha_y, alpha_z/2, alpha_theta/(2 nu^4), alpha_theta/2, 0):
        the constants that reproduce the paper's Table 3; nu appears twice on theta_x.

        Parameters
        ----------
        mesh : MeshParameters
        mass : float
            m of one gear [kg].
        aspect_ratio : float
            nu = b/a.
        alpha_y, alpha_z, alpha_theta : float
            Bearing stiffness ratios.
        modal_damping : float
            Uniform damping ratio.
        """
        for key, value in (("mass", mass), ("aspect_ratio", aspect_ratio)):
            if not value > 0.0:
                raise InputError(f"unity_ratio.{key}", value, "must be greater than zero")
        for key, value in (("alpha_y", alpha_y), ("alpha_z", alpha_z), ("alpha_theta", alpha_theta)):
            if not value >= 0.0:
                raise InputError(f"unity_ratio.{key}", value, "must not be negative")
        nu4 = aspect_ratio**4
        masses = 0.5 * mass * np.array([2.0, 2.0, 1.0 / nu4, 1.0, 2.0])
        ratios = np.array([alpha_y, 0.5 * alpha_z, 0.5 * alpha_theta / nu4, 0.5 * alpha_theta, 0.0])
        bearing = np.diag(mesh.stiffness * ratios)
        return cls(mesh, masses, bearing, _no_matrix(), _no_matrix(), modal_damping, 0.5 * mass)

    def both_gears(self, base_radius: float, half_face_width: float) -> HelicalPairModel:
        """The ten degrees of freedom of the two equal gears on mirrored bearings, of which these are the mesh's.

        Parameters
        ----------
        base_radius, half_face_width : float
            a and b [m], by which q counts rotations.
        """
        size = np.array([1.0, 1.0, half_face_width, base_radius, base_radius])
        inertia = self.mass[2:] * size[2:] ** 2

        def gear(sign: Array) -> RigidGear:
            side = sign * size
            stiffness, damping = (side[:, None] * k * side for k in (self.bearing_stiffness, self.bearing_damping))
            mass, three = float(self.mass[0]), (float(inertia[0]), float(inertia[1]), float(inertia[2]))
            return RigidGear(mass, three, base_radius, half_face_width, stiffness, damping)

        return HelicalPairModel(
            gear(np.ones(5)), gear(np.diag(P)), self.mesh, self.mesh_damping_matrix, self.modal_damping
        )

    @cached_property
    def mesh_stiffness_matrix(self) -> Array:
        """K_M over q [N/m], shape (5, 5)."""
        return self.mesh.matrix()

    @cached_property
    def stiffness(self) -> Array:
        """2 K_M + k_B [N/m], shape (5, 5)."""
        return 2.0 * self.mesh_stiffness_matrix + self.bearing_stiffness

    @cached_property
    def damping(self) -> Array:
        """Damping matrix [N s/m], shape (5, 5), with the uniform modal damping added."""
        matrix = 2.0 * self.mesh_damping_matrix + self.bearing_damping
        if self.modal_damping == 0.0:
            return matrix
        frequency, shape = undamped_modes(self.mass, self.stiffness)
        weighted = self.mass[:, None] * shape
        return np.asarray(matrix + (weighted * (2.0 * self.modal_damping * frequency)) @ weighted.T)

    @property
    def natural_frequency(self) -> float:
        """omega = sqrt(K_M/m_eq) [rad/s]; with unity ratio sqrt(2 K_M/m)."""
        return math.sqrt(self.mesh.stiffness / self.equivalent_mass)


def _assemble(mesh: Array, bearing_i: Array, bearing_j: Array) -> Array:
    return np.block([[mesh + bearing_i, mesh @ P], [P @ mesh, P @ mesh @ P + bearing_j]])
