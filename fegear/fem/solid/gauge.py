"""A strain gauge glued into the root fillet of a 3D gear: where its grid lies, and the mean strain under it.

The surface is free of load, but strained in both directions: with the stresses of the surface along the profile, across
it and between both, Hooke's law of a plane state of stress gives the strain in any direction. A grid is a rectangle in
the surface; its mean is a Gauss integral over it. A step across the profile follows the helix and leans by its
component along the profile's tangent, as in `fegear.fem.solid.fillet`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.gauge import FilletProfile, Grid, grid_weights

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.solid.fillet import SolidFillet
    from fegear.fem.solid.rooted_tooth import RootedTooth
    from fegear.geometry.gear import Gear, Material

#: Gauss points along and across the direction of a grid.
_ALONG, _ACROSS = 12, 6


def profile_of_solid(fillet: SolidFillet, gear: Gear) -> FilletProfile:
    """The line along which gauges are placed: the fillet in the transverse section."""
    radius, angle = np.hypot(*fillet.place), np.arctan2(*fillet.place)
    return FilletProfile.through(fillet.arc, fillet.length, radius, angle, fillet.tangent_angle, gear)


@dataclass(frozen=True)
class GridOnFace:
    """Gauss points of a grid on the fillet of a solved 3D gear, Q of them, and of others displaced along the fillet.

    Parameters
    ----------
    solution : RootedTooth
    direction : float
        Of measurement, from up the profile towards end II [rad].
    zeta : ndarray, shape (Z,)
        Places along the face of the points, each once, from the middle of the common face [modules].
    at : ndarray of int, shape (Q,)
        Which of them.
    weights : ndarray, shape (G, Q, points)
        Share of the stress at the points up the fillet in the mean, by displacement.
    """

    solution: RootedTooth
    direction: float
    zeta: Array
    at: Index
    weights: Array

    def means(self, surface: Array, material: Material, *, plane_strain: bool) -> tuple[Array, Array]:
        """Mean strain, and mean stress along the profile, of grids at every displacement, shape (G, T) each.

        Parameters
        ----------
        surface : ndarray, shape (3, points, Z, T)
            Stresses of the surface: along the profile, across it, and between both [Pa].
        material : Material
        plane_strain : bool
            Whether nothing strains across the profile, as in slices.
        """
        along, across, shear = surface
        e, nu = material.young_modulus, material.poisson_ratio
        c, s = math.cos(self.direction), math.sin(self.direction)
        if plane_strain:
            strain = c * c * (1.0 - nu * nu) / e * along
        else:
            strain = (
                c * c * (along - nu * across) + s * s * (across - nu * along) + 2.0 * s * c * (1.0 + nu) * shear
            ) / e  # fmt: skip
        return self._mean(strain), self._mean(along)

    def _mean(self, values: Array) -> Array:
        """Of values at the points up the fillet and places along the face, shape (points, Z, T)."""
        return np.asarray(np.einsum("gqp,pqt->gt", self.weights, values[:, self.at], optimize=True))


def half_up_fillet(grid: Grid, lean: float) -> float:
    """How far a grid reaches up the fillet to either side of its middle [m].

    Parameters
    ----------
    grid : Grid
    lean : float
        Step along the profile per step across it, of one that follows the helix.
    """
    c, s = math.cos(grid.direction), math.sin(grid.direction)
    return 0.5 * (abs(c - lean * s) * grid.length + abs(s + lean * c) * grid.width)


def lean_at(fillet: SolidFillet, tau: float, arc: float) -> tuple[float, float]:
    """Lean and length of a step along the helix at an arc length [modules], per modules along the face.

    Returns
    -------
    skew, across : float
        Component of that step along the profile's tangent, and the one across it.
    """
    x, y, tx, ty = (float(np.interp(arc, fillet.arc, one)) for one in (*fillet.place, *fillet.tangent))
    skew = tau * (ty * x - tx * y)
    return skew, math.sqrt(1.0 + tau**2 * (x * x + y * y) - skew**2)


def grid_on_face(solution: RootedTooth, side: str, grid: Grid, arc: Array, z: float, module: float) -> GridOnFace:
    """Gauss points of a grid at a place on the face.

    Parameters
    ----------
    solution : RootedTooth
    side : {"tension", "compression"}
    grid : Grid
    arc : ndarray, shape (G,)
        Middles of the grids up the fillet [m].
    z : float
        Their place along the face, from the middle of the common one [m].
    module : float
        Transverse [m].
    """
    fillet = solution.fillets[side]  # type: ignore[index]  # one of the two words
    u, of_u = _gauss(grid.length / module, _ALONG)
    v, of_v = _gauss(grid.width / module, _ACROSS)
    u, v = (one.ravel() for one in np.meshgrid(u, v, indexing="ij"))
    share = np.outer(of_u, of_v).ravel()
    c, s = math.cos(grid.direction), math.sin(grid.direction)
    up, over = c * u - s * v, s * u + c * v
    middle = arc / module
    skew, across = lean_at(fillet, solution.tau, float(np.mean(middle)))
    zeta, at = np.unique(z / module + over / across, return_inverse=True)
    places = middle[:, None] + up - skew / across * over
    weights = grid_weights(fillet.arc, places.ravel(), (0.0, 0.0)).reshape(*places.shape, -1)
    return GridOnFace(solution, grid.direction, zeta, at.ravel(), share[:, None] * weights)


def _gauss(length: float, count: int) -> tuple[Array, Array]:
    """Points over a length about zero, and their shares; a single one of none."""
    if length == 0.0:
        return np.zeros(1), np.ones(1)
    node, weight = np.polynomial.legendre.leggauss(count)
    return 0.5 * length * node, 0.5 * weight
