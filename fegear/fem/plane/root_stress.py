"""Root stress from the displacement of the fillet itself.

On the free surface of the fillet the normal and shear stress vanish, so the tangential stress is the plane modulus
times the surface's own strain: sigma = E / (1 - nu^2) * t . du/ds in plane strain, E * t . du/ds in plane stress. The
strain is taken at the Gauss points of each boundary edge, where the derivative of a finite-element solution of order p
converges one order faster than elsewhere (superconvergence), and needs no interior unknowns at all.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.trace import lagrange, lagrange_slope

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from scipy.sparse import csr_array

    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.mesh import SectorMesh


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


#: Each point of the curve along a fillet is smoothed by a polynomial of this degree through so many Gauss points about
#: it: the fillet is analytic, so stress away from the contact is too, and the fit averages out the scatter of edges.
_POINTS, _DEGREE = 10, 5


def search_end(length: float, above: Array, half_width: ArrayLike, clearance: float) -> Array:
    """Arc length up which root stress is looked for below contacts, shape (P,) [modules].

    Root stress is that of the fillet, from the root land up to the start of the flank, but no nearer to the edge of
    the contact than the clearance; a fillet that this would leave less than half of is looked at over its lower half.

    Parameters
    ----------
    length : float
        Of the fillet [modules].
    above : ndarray, shape (P,)
        How far above the fillet the contacts stand [modules].
    half_width : array_like
        Of the contacts [modules].
    clearance : float
        [modules].
    """
    free = np.maximum(length + above - np.asarray(half_width, dtype=float), 0.0)
    return np.minimum(length, np.maximum(free - clearance, 0.5 * free))


def extreme(values: Array, arc: Array, sign: float, end: ArrayLike, clearance: float = math.inf) -> tuple[Array, Array]:
    """Largest (sign +1) or smallest (-1) value along a fillet and its arc length.

    Parameters
    ----------
    values : ndarray, shape (points, P)
    arc : ndarray, shape (points,)
        Ascending, two points at least.
    sign : {1, -1}
    end : array_like
        Arc length at which the search ends, no farther from the points than an edge's end.
    clearance : float
        From there to the contact's edge: what lies beyond half of it does not enter the curve, for a mesh that does
        not resolve the contact is wrong there by many times the stress.

    Returns
    -------
    value, place : ndarray, shape (P,)
        Of the cubic Hermite curve through smoothed values and slopes at the points. The curve is linear in the values
        and has no corner, so its largest value changes steadily with them and with the end.
    """
    ends = np.broadcast_to(np.asarray(end, dtype=float), values.shape[1:])
    if clearance < math.inf:
        values = _without_contact(values, arc, ends, clearance)
    smoothing, slopes = _smoothing(np.ascontiguousarray(arc).tobytes())
    height, step = sign * (smoothing @ values), np.diff(arc)[:, None]
    rise = sign * (slopes @ values)
    a, p, q = height[:-1], rise[:-1] * step, rise[1:] * step
    square, cube = 3.0 * np.diff(height, axis=0) - 2.0 * p - q, p + q - 2.0 * np.diff(height, axis=0)
    low, high = np.zeros_like(step), np.ones_like(step)
    low[0], high[-1] = -arc[0] / step[0], np.inf
    within = (ends - arc[:-1, None]) / step
    high = np.clip(within, low, high)
    # Where the slope p + 2 square t + 3 cube t^2 vanishes, without cancellation; where it does not, any place will do.
    root = -(square + np.copysign(np.sqrt(np.maximum(square**2 - 3.0 * cube * p, 0.0)), square))
    flat = [
        np.divide(over, under, out=np.zeros_like(a), where=np.abs(under) > np.abs(over) * 1e-9)
        for over, under in ((root, 3.0 * cube), (p, root))
    ]
    best = np.full(a.shape, -np.inf)
    at = np.zeros_like(a)
    for t in (low, high, *(np.clip(place, low, high) for place in flat)):
        found = a + t * (p + t * (square + t * cube))
        higher = found > best
        best, at = np.where(higher, found, best), np.where(higher, t, at)
    best[1:][within[1:] < 0.0] = -np.inf
    top, columns = np.argmax(best, axis=0), np.arange(values.shape[1])
    return sign * best[top, columns], arc[top] + at[top, columns] * step[top, 0]


def _without_contact(values: Array, arc: Array, ends: Array, clearance: float) -> Array:
    """Values that fade, between a fifth and a half of the clearance beyond the end, into that at the end."""
    faded = np.clip(((arc[:, None] - ends) / clearance - 0.2) / 0.3, 0.0, 1.0)
    below, columns = np.clip(np.searchsorted(arc, ends) - 1, 0, arc.size - 2), np.arange(ends.size)
    share = np.clip((ends - arc[below]) / (arc[below + 1] - arc[below]), 0.0, 1.0)
    last = (1.0 - share) * values[below, columns] + share * values[below + 1, columns]
    return np.asarray(values + faded * (last - values))


def curves_apart(values: Array, others: Array) -> Array:
    """How far two curves are apart where the first counts: above half its largest value, shape (...).

    The largest values of two solutions may agree by chance; their curves do not.

    Parameters
    ----------
    values, others : ndarray, shape (..., places)
        Stress, positive where it is largest.
    """
    counts = values >= 0.5 * values.max(axis=-1, keepdims=True)
    return np.asarray(np.where(counts, np.abs(others - values), 0.0).max(axis=-1))


@functools.lru_cache(maxsize=16)
def _smoothing(points: bytes) -> tuple[csr_array, csr_array]:
    """Matrices from values at points to a smooth curve's values and slopes there, shape (points, points).

    Sparse, for their products then have the same bits for one column as for many. Those of the last few fillets are
    kept, by the content of their points' arc lengths: a fillet is asked about for loads of every kind.
    """
    from scipy.sparse import csr_array

    arc = np.frombuffer(points)
    chebyshev, count = np.polynomial.chebyshev, min(_POINTS, arc.size)
    first = np.clip(np.arange(arc.size) - count // 2, 0, arc.size - count)
    column = first[:, None] + np.arange(count)
    near = arc[column]
    middle, half = 0.5 * (near[:, 0] + near[:, -1]), 0.5 * (near[:, -1] - near[:, 0])
    degree = min(_DEGREE, count // 2)
    fit = np.linalg.pinv(chebyshev.chebvander((near - middle[:, None]) / half[:, None], degree))
    place = (arc - middle) / half
    values = chebyshev.chebvander(place, degree)
    derived = np.stack([chebyshev.chebval(place, chebyshev.chebder(one)) for one in np.eye(degree + 1)], axis=1)
    row = np.broadcast_to(np.arange(arc.size)[:, None], column.shape)
    weights = (np.einsum("nd,ndk->nk", basis, fit) for basis in (values, derived / half[:, None]))
    one, other = (csr_array((w.ravel(), (row.ravel(), column.ravel())), shape=(arc.size,) * 2) for w in weights)
    return one, other
