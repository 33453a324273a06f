"""Mesh stiffness, its lever and its rotary part from a distribution over the face (Blankenship and Singh)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.errors import InputError, RangeError


@dataclass(frozen=True, slots=True)
class MeshParameters:
    """Time-invariant stiffness of a helical gear mesh.

    Parameters
    ----------
    stiffness : float
        K_M [N/m] along the line of action.
    kappa : float
        Axial distance of the centre of the mesh stiffness from the gear's centre of mass, over half the face width.
    mu : float
        Rotary stiffness about the x axis over K_M b^2; at least kappa^2.
    base_helix_angle : float
        psi_b [rad].
    """

    stiffness: float
    kappa: float = 0.0
    mu: float = 1.0 / 3.0
    base_helix_angle: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a mesh that would give energy away."""
        if not (math.isfinite(self.stiffness) and self.stiffness > 0.0):
            raise InputError("mesh.stiffness", self.stiffness, "must be positive and finite")
        if not math.isfinite(self.kappa):
            raise InputError("mesh.kappa", self.kappa, "must be finite")
        if not (math.isfinite(self.mu) and self.mu >= self.kappa**2 * (1.0 - 1e-12)):
            raise RangeError(
                "mesh.mu", self.mu, f"must be finite and at least kappa^2 = {self.kappa**2:.6g}",
                "a lower rotational stiffness would be unstable",
            )  # fmt: skip
        if not abs(self.base_helix_angle) < 0.5 * math.pi:
            angle = f"{math.degrees(self.base_helix_angle):.6g} deg"
            raise RangeError("mesh.base_helix_angle", angle, "must be between -90 and 90 deg")

    def matrix(self) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        """Mesh stiffness over q = (y, z, b theta_x, a theta_y, a theta_z), shape (5, 5) [N/m] (Eq. 6)."""
        c, s = math.cos(self.base_helix_angle), math.sin(self.base_helix_angle)
        normal, bend = np.array([c, s, 0.0, -s, c]), np.array([0.0, 0.0, 1.0, 0.0, 0.0])
        mixed = np.outer(normal, bend)
        return np.asarray(
            self.stiffness
            * (np.outer(normal, normal) + self.kappa * (mixed + mixed.T) + self.mu * np.outer(bend, bend))
        )


#: By how much a contact at the very end of the face may lie beyond it: what a number in a file is rounded by.
_ROUNDED = 1e-9


def partial_face_mu(kappa: float) -> float:
    """Rotary parameter mu = kappa^2 + (1 - abs(kappa))^2/3 of a uniform contact that reaches one end of the face."""
    if not abs(kappa) <= 1.0 + _ROUNDED:
        raise RangeError("kappa", kappa, "must be between -1 and 1 (contact within the face width)")
    return kappa**2 + max(0.0, 1.0 - abs(kappa)) ** 2 / 3.0


def mesh_parameters(
    z: ArrayLike,
    load: ArrayLike,
    deflection: ArrayLike,
    *,
    face_width: float,
    centre_of_mass: float = 0.0,
    base_helix_angle: float = 0.0,
) -> MeshParameters:
    """Mesh parameters from a load distribution over the face, such as contact results give.

    The stiffness per length is load over deflection; it and its moments are integrated as a piecewise linear function.

    Parameters
    ----------
    z : array_like, shape (n,)
        Heights on the face [m], rising.
    load : array_like, shape (n,)
        Load per length along the line of action [N/m], not negative.
    deflection : array_like, shape (n,) or scalar
        Deflection along the line of action [m], positive.
    face_width : float
        2 b [m].
    centre_of_mass : float
        Height of the gear's centre of mass [m].
    base_helix_angle : float
        psi_b [rad].

    Raises
    ------
    InputError
        If the distribution is no distribution or carries nothing.
    """
    z, load = np.asarray(z, dtype=float), np.asarray(load, dtype=float)
    give = np.broadcast_to(np.asarray(deflection, dtype=float), z.shape)
    if z.ndim != 1 or z.size < 2 or load.shape != z.shape or not np.all(np.diff(z) > 0.0):
        raise InputError("z", f"shape {z.shape}", "must be at least two increasing values, one load each")
    if not (np.all(np.isfinite(load)) and np.all(load >= 0.0) and load.max() > 0.0):
        raise InputError("load", "distribution", "must be finite and non-negative, with at least one positive value")
    if not (np.all(np.isfinite(give)) and np.all(give[load > 0.0] > 0.0)):
        raise InputError("deflection", "distribution", "must be positive where the load is positive")
    if not face_width > 0.0:
        raise InputError("face_width", face_width, "must be positive")
    k = np.divide(load, give, out=np.zeros_like(load), where=load > 0.0)
    half, arm = 0.5 * face_width, z - centre_of_mass
    h, k0, k1, a0, a1 = np.diff(z), k[:-1], k[1:], arm[:-1], arm[1:]
    total = float(np.sum(h * (k0 + k1)) / 2.0)
    first = float(np.sum(h * (k0 * (2.0 * a0 + a1) + k1 * (a0 + 2.0 * a1))) / 6.0)
    second = float(
        np.sum(h * (k0 * (3.0 * a0**2 + 2.0 * a0 * a1 + a1**2) + k1 * (a0**2 + 2.0 * a0 * a1 + 3.0 * a1**2))) / 12.0
    )
    return MeshParameters(total, first / (half * total), second / (half**2 * total), base_helix_angle)
