"""Root stress from the displacement of the fillet itself.

On the free surface of the fillet the normal and shear stress vanish, so the tangential stress is the plane modulus
times the surface's own strain: sigma = E / (1 - nu^2) * t . du/ds in plane strain, E * t . du/ds in plane stress. The
strain is taken at the Gauss points of each boundary edge, where the derivative of a finite-element solution of order p
converges one order faster than elsewhere (superconvergence), and needs no interior unknowns at all.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.trace import lagrange, lagrange_slope

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array, Index
    from fegear.fem.elasticity import SectorElasticity
    from fegear.fem.mesh import SectorMesh


@dataclass(frozen=True)
class FilletStrain:
    """Points of one fillet and the strain there as a function of the fillet's unknowns.

    Parameters
    ----------
    dofs : ndarray of int, shape (n,)
    strain : ndarray, shape (points, n)
        Tangential strain per displacement [1/modules].
    radius, angle, arc, tangent_angle : ndarray, shape (points,)
        Distance from the gear's centre [modules], clockwise angle from the tooth's centre line [rad], arc length from
        the root land [modules], angle between the fillet's tangent and the tooth's centre line [rad] (30 deg at the
        point that ISO 6336-3 looks at).
    length : float
        Of the whole fillet [modules].
    """

    dofs: Index
    strain: Array
    radius: Array
    angle: Array
    arc: Array
    tangent_angle: Array
    length: float


def fillet_strain(mesh: SectorMesh, elasticity: SectorElasticity, name: str) -> FilletStrain:
    """Strain functionals along one fillet, from the root land up to the flank.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    name : {"fillet", "back_fillet"}

    Returns
    -------
    FilletStrain
    """
    p = elasticity.order
    xi = 0.5 + 0.5 * np.polynomial.legendre.leggauss(p)[0]
    edges, dofs = mesh.edges[name], elasticity.edge_dofs[name]
    upward = np.hypot(*mesh.points[:, edges[0]]) < np.hypot(*mesh.points[:, edges[1]])
    # The middle node decides for edges whose ends lie on the root circle alike.
    order = np.argsort(np.hypot(*mesh.points[:, edges[2]]))
    edges = np.where(upward, edges, edges[[1, 0, 2]])[:, order]
    dofs = np.where(upward, dofs, dofs[:, ::-1])[:, :, order]
    places = elasticity.edge_places[name]
    places = np.where(upward, places, places[:, ::-1])[:, :, order]
    curve = places.shape[1] - 1
    position = np.einsum("cin,iq->cnq", places, lagrange(curve, xi))
    tangent = np.einsum("cin,iq->cnq", places, lagrange_slope(curve, xi))
    speed = np.hypot(*tangent)
    slopes = lagrange_slope(p, xi)  # (p + 1, q)
    n, q = speed.shape
    values = np.einsum("cnq,iq,nq->nqci", tangent, slopes, 1.0 / speed**2)  # t . du/ds
    unknowns, where = np.unique(dofs, return_inverse=True)
    where = where.reshape(dofs.shape)
    strain = np.zeros((n, q, unknowns.size))
    for e in range(n):
        strain[e][:, where[:, :, e]] += values[e]
    weights = 0.5 * np.polynomial.legendre.leggauss(p)[1]
    length = (speed * weights).sum(axis=1)
    arc = np.concatenate([[0.0], np.cumsum(length)])[:-1, None] + length[:, None] * xi
    flat = position.reshape(2, -1)
    lean = np.arctan2(np.abs(tangent[0]), tangent[1]).reshape(-1)
    return FilletStrain(
        dofs=unknowns,
        strain=strain.reshape(n * q, -1),
        radius=np.hypot(*flat),
        angle=np.arctan2(*flat),
        arc=arc.reshape(-1),
        tangent_angle=lean,
        length=float(length.sum()),
    )


#: The stress round its largest value is smoothed by a polynomial through this many points of this degree: the trochoid
#: is analytic, so the stress away from the contact is too, and the fit averages out the scatter of single edges.
_FITS = ((20, 8), (12, 4))
#: Where a fit leaves more than this share of the largest stress, the contact is too near for a smooth curve.
_MISFIT = 0.01
_GRID = np.linspace(-1.0, 1.0, 201)


def extreme(values: Array, arc: Array, sign: float, end: ArrayLike) -> tuple[Array, Array]:
    """Largest (sign +1) or smallest (-1) value along a fillet and its arc length.

    Parameters
    ----------
    values : ndarray, shape (points, P)
    arc : ndarray, shape (points,)
    sign : {1, -1}
    end : array_like
        Arc length at which the search ends.

    Returns
    -------
    value, place : ndarray, shape (P,)
        From a least-squares polynomial round the largest of the points, or straight from that point where the load
        stands so near that no smooth curve follows them.
    """
    columns = np.arange(values.shape[1])
    ends = np.broadcast_to(np.asarray(end, dtype=float), columns.shape)
    counts = np.maximum(np.searchsorted(arc, ends, side="right"), 1)
    beyond = np.arange(arc.size)[:, None] >= counts
    top = np.argmax(np.where(beyond, -np.inf, sign * values), axis=0)
    value, place = values[top, columns].copy(), arc[top].copy()
    left = np.ones(columns.size, dtype=bool)
    for points, degree in _FITS:
        for at, count in np.unique(np.stack([top, counts])[:, left], axis=1).T:
            chosen = np.flatnonzero(left & (top == at) & (counts == count))
            first = int(np.clip(at - points // 2, 0, max(count - points, 0)))
            window = slice(first, min(first + points, int(count)))
            low = 0.0 if first == 0 else float(arc[first])
            high = ends[chosen] if window.stop == count else np.full(chosen.size, arc[window.stop - 1])
            found, where, misfit = _smoothed(sign * values[window, chosen], arc[window], degree, low, high)
            good = misfit <= _MISFIT * np.abs(values[:count, chosen]).max(axis=0)
            value[chosen[good]], place[chosen[good]] = sign * found[good], where[good]
            left[chosen[good]] = False
    return value, place


def _smoothed(values: Array, arc: Array, degree: int, low: float, high: Array) -> tuple[Array, Array, Array]:
    """Largest value between two arc lengths of a polynomial through points, its place and the largest misfit."""
    chebyshev = np.polynomial.chebyshev
    middle, half = 0.5 * (arc[0] + arc[-1]), max(0.5 * (arc[-1] - arc[0]), 1e-300)
    basis = chebyshev.chebvander((arc - middle) / half, max(0, min(degree, arc.size // 2)))
    coefficients = np.linalg.lstsq(basis, values, rcond=None)[0]
    columns = np.arange(values.shape[1])
    places = 0.5 * (low + high) + 0.5 * (high - low) * _GRID[:, None]
    curve = np.einsum("gpi,ip->gp", chebyshev.chebvander((places - middle) / half, basis.shape[1] - 1), coefficients)
    best = np.argmax(curve, axis=0)
    # A parabola through the best of the grid and its neighbours takes the grid's step out.
    inner = np.clip(best, 1, _GRID.size - 2)
    before, here, after = (curve[inner + step, columns] for step in (-1, 0, 1))
    bend = before - 2.0 * here + after
    shift = np.divide(0.5 * (before - after), bend, out=np.zeros_like(bend), where=bend < 0.0)
    shift = np.where(best == inner, np.clip(shift, -1.0, 1.0), best - inner)
    peak = here + 0.5 * shift * (after - before) + 0.5 * shift**2 * bend
    misfit = np.abs(basis @ coefficients - values).max(axis=0)
    return peak, places[inner, columns] + shift * 0.5 * (high - low) * (_GRID[1] - _GRID[0]), misfit
