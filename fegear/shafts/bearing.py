"""Bearings by their stiffness: what a shaft that moves in its seat meets.

A bearing is an energy of the displacement u = (x, y, z, turn about x, turn about y) of its inner ring in its outer
one; the force that the ring takes is its gradient, the stiffness its second derivative. Turning about z is free.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.errors import InputError, RangeError

if TYPE_CHECKING:
    from fegear.base.arrays import Array


class Bearing(Protocol):
    """What the solution of a shaft asks of a bearing."""

    @property
    def rigid(self) -> Array:
        """Directions in which the ring cannot move, shape (5,), bool."""
        ...

    @property
    def usual(self) -> Array:
        """Stiffness once it carries, of the size to start from, shape (5, 5) [N/m, N, N m]."""
        ...

    def reaction(self, u: Array) -> tuple[Array, Array]:
        """Force that the ring takes in the direction of `u`, shape (5,), and its stiffness, shape (5, 5)."""
        ...


@dataclass(frozen=True)
class StiffBearing:
    """A linear bearing: a matrix.

    Parameters
    ----------
    matrix : ndarray, shape (5, 5)
        Stiffness against x, y, z, turns about x and y [N/m, N, N m/rad]; infinite on the diagonal where it is rigid.

    Raises
    ------
    InputError
        If it is not symmetric, or gives off energy.
    """

    matrix: Array

    def __post_init__(self) -> None:
        """Refuse matrices that are no stiffness."""
        m = np.asarray(self.matrix, dtype=float)
        if m.shape != (5, 5):
            raise InputError("matrix", f"{m.shape}", "must have 5 rows of 5 numbers: x, y, z and tilt about x and y")
        off = np.where(np.eye(5) > 0.0, 0.0, m)
        if not (np.isfinite(off).all() and not np.isnan(m).any()):
            raise InputError("matrix", "(not finite)", "must have finite off-diagonal terms")
        if off[self.rigid].any():
            raise InputError(
                "matrix",
                "(infinite)",
                "has coupling terms for a rigid direction",
                "set these off-diagonal terms to zero",
            )
        if np.abs(off - off.T).max() > 1e-9 * max(np.abs(off).max(), 1e-300):
            raise InputError("matrix", "(not symmetric)", "must be symmetric", "average it with its transpose")
        soft = self.usual
        scale = np.sqrt(np.where(np.diag(soft) > 0.0, np.diag(soft), 1.0))
        if np.linalg.eigvalsh(soft / np.outer(scale, scale)).min() < -1e-9:
            raise InputError(
                "matrix",
                "(indefinite)",
                "is not positive semi-definite",
                "specify a positive semi-definite matrix",
            )

    @property
    def rigid(self) -> Array:
        """Where the diagonal is infinite."""
        return np.asarray(np.isinf(np.diag(self.matrix)))

    @property
    def usual(self) -> Array:
        """The matrix, zero where it is rigid."""
        return np.asarray(np.where(np.isinf(self.matrix), 0.0, self.matrix))

    def reaction(self, u: Array) -> tuple[Array, Array]:
        """Linear."""
        return self.usual @ u, self.usual


def stiff(radial: float, axial: float = 0.0, tilting: float = 0.0) -> StiffBearing:
    """A linear bearing that is alike all around [N/m, N/m, N m/rad]; infinity for rigid."""
    return StiffBearing(np.diag([radial, radial, axial, tilting, tilting]))


@dataclass(frozen=True)
class LooseBearing:
    """A bearing that carries once its clearance is used up.

    Parameters
    ----------
    radial, axial, tilting : float
        Stiffness when it carries [N/m, N/m, N m/rad], finite.
    radial_clearance, axial_clearance : float
        How far the ring may move from the middle to either side [m].

    Raises
    ------
    RangeError
        If a value is negative or infinite.
    """

    radial: float
    axial: float = 0.0
    tilting: float = 0.0
    radial_clearance: float = 0.0
    axial_clearance: float = 0.0

    def __post_init__(self) -> None:
        """Refuse values that are no stiffness or clearance."""
        for key in ("radial", "axial", "tilting", "radial_clearance", "axial_clearance"):
            value = getattr(self, key)
            if not 0.0 <= value < np.inf:
                raise RangeError(key, value, "must be finite and not negative")

    @property
    def rigid(self) -> Array:
        """Nowhere."""
        return np.zeros(5, dtype=bool)

    @property
    def usual(self) -> Array:
        """As without clearance."""
        return np.diag([self.radial, self.radial, self.axial, self.tilting, self.tilting])

    def reaction(self, u: Array) -> tuple[Array, Array]:
        """Radial, axial and tilting part, each by itself."""
        force, stiffness = np.zeros(5), np.zeros((5, 5))
        force[3:], stiffness[(3, 4), (3, 4)] = self.tilting * u[3:], self.tilting
        off = float(np.hypot(u[0], u[1]))
        if off > self.radial_clearance or self.radial_clearance == 0.0:
            towards = u[:2] / off if off > 0.0 else np.zeros(2)
            share = 1.0 - self.radial_clearance / off if off > 0.0 else 1.0
            force[:2] = self.radial * share * u[:2]
            along = np.outer(towards, towards)
            stiffness[:2, :2] = self.radial * (share * np.eye(2) + (1.0 - share) * along)
        if abs(u[2]) >= self.axial_clearance:
            force[2] = self.axial * (u[2] - np.copysign(self.axial_clearance, u[2]))
            stiffness[2, 2] = self.axial
        return force, stiffness
