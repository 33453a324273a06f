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
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.fem.plane.contact_width import POINT, REFERENCE_HALF_WIDTH
from fegear.fem.plane.trace import lagrange, lagrange_slope, toward_tip

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
        Distance from the gear's centre, of a rack height above its reference line [modules]; clockwise angle from the
        tooth's centre line [rad], arc length from the root land [modules], angle between the fillet's tangent and the
        tooth's centre line [rad] (30 deg at the point that ISO 6336-3 looks at).
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


def fillet_strain(mesh: SectorMesh, elasticity: SectorElasticity, name: str, side: int = 1) -> FilletStrain:
    """Strain functionals along one fillet, from the root land up to the flank.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    name : {"fillet", "back_fillet"}
    side : {1, -1}
        Of an external or an internal tooth, whose flank lies inward.

    Returns
    -------
    FilletStrain
    """
    p = elasticity.order
    xi, weights, slopes = _along_edges(p)
    _, dofs = toward_tip(mesh, elasticity.edge_dofs[name], name, side)
    _, places = toward_tip(mesh, elasticity.edge_places[name], name, side)
    curve = places.shape[1] - 1
    position = np.einsum("cin,iq->cnq", places, lagrange(curve, xi))
    tangent = np.einsum("cin,iq->cnq", places, lagrange_slope(curve, xi))
    speed = np.hypot(*tangent)
    n, q = speed.shape
    values = np.einsum("cnq,iq,nq->nqci", tangent, slopes, 1.0 / speed**2)  # t . du/ds
    unknowns, where = np.unique(dofs, return_inverse=True)
    where = where.reshape(dofs.shape)
    strain = np.zeros((n, q, unknowns.size))
    # An edge's unknowns differ from each other: each place is met once.
    strain[np.arange(n)[:, None, None, None], np.arange(q)[:, None, None], where.transpose(2, 0, 1)[:, None]] += values
    length = (speed * weights).sum(axis=1)
    arc = np.concatenate([[0.0], np.cumsum(length)])[:-1, None] + length[:, None] * xi
    flat = position.reshape(2, -1)
    lean = np.arctan2(np.abs(tangent[0]), side * tangent[1]).reshape(-1)
    return FilletStrain(
        dofs=unknowns,
        strain=strain.reshape(n * q, -1),
        radius=mesh.outward(flat),
        angle=np.arctan2(*flat),
        arc=arc.reshape(-1),
        tangent_angle=lean,
        length=float(length.sum()),
    )


@functools.lru_cache
def _along_edges(order: int) -> tuple[Array, Array, Array]:
    """Gauss points of an edge [0, 1], their weights, and slopes of its functions there, shape (order + 1, points)."""
    places, weights = np.polynomial.legendre.leggauss(order)
    xi = 0.5 + 0.5 * places
    return xi, 0.5 * weights, lagrange_slope(order, xi)


#: How far below the edge of a contact root tension begins [modules]: nearer, stress is what the contact itself leaves,
#: and a coarse mesh does not resolve it.
CLEARANCE = 0.05


@dataclass(frozen=True)
class FilletCurve:
    """What the largest stress of a fillet needs besides stress at its points, whatever the loads: small, and plain.

    Parameters
    ----------
    side : {"tension", "compression"}
    arc : ndarray, shape (points,)
        Arc length of the points from the root land [modules].
    length : float
        Of the fillet [modules].
    base_radius : float
        [modules].
    flank : tuple of float
        Squares of the involute's roll angles at the ends of the loaded flank, that at the fillet first: the larger one
        of an internal tooth.
    module : float
        In the unit of radii and places.
    """

    side: Literal["tension", "compression"]
    arc: Array
    length: float
    base_radius: float
    flank: tuple[float, float]
    module: float = 1.0

    def largest(
        self, stress: Array, radius: ArrayLike = math.inf, half_width: float = REFERENCE_HALF_WIDTH
    ) -> tuple[Array, Array]:
        """Largest tension or most negative compression, and its arc length from the root land, shape (Q,) each.

        Parameters
        ----------
        stress : ndarray, shape (points, Q)
            By whatever loads.
        radius : array_like, shape (Q,)
            Of contacts on this tooth itself; infinite where nothing touches it.
        half_width : float
            Of those contacts [modules].
        """
        above, width = self._beside(radius, half_width)
        value, place = self.largest_below(stress, above, width)
        return value, place * self.module

    def along(
        self, stress: Array, share: Array, radius: ArrayLike = math.inf, half_width: float = REFERENCE_HALF_WIDTH
    ) -> Array:
        """The smooth curve through stress at the points, at shares of the fillet's length, shape (shares, Q).

        Root tension nearer to a contact on this tooth itself than it is looked for is that at the search's end.

        Parameters
        ----------
        stress, radius, half_width
            As of `largest`.
        share : ndarray, shape (shares,)
            From 0 at the root land to 1 at the flank.
        """
        above, width = self._beside(radius, half_width)
        values = np.ascontiguousarray(stress)
        if self.side == "tension":
            ends = np.broadcast_to(search_end(self.length, above, width, CLEARANCE), values.shape[1:])
            values = without_contact(values, self.arc, ends, CLEARANCE)
        return smooth_at(values, self.arc, (share * self.length)[:, None])

    def at(self, stress: Array, place: Array) -> Array:
        """The smooth curve through stress at the points, (points, Q), at places of its largest, (S,): shape (S, Q)."""
        return smooth_at(np.ascontiguousarray(stress), self.arc, place[:, None] / self.module)

    def _beside(self, radius: ArrayLike, half_width: float) -> tuple[Array, Array]:
        """How far above the fillet contacts stand, infinitely where none touches, and their half-widths [modules]."""
        touched, side = np.asarray(radius, dtype=float), 1.0 if self.flank[1] >= self.flank[0] else -1.0
        roll_squared = (touched / (self.module * self.base_radius)) ** 2 - 1.0
        above, room = (
            0.5 * self.base_radius * side * off for off in (roll_squared - self.flank[0], self.flank[1] - roll_squared)
        )
        above = np.where(np.isinf(touched), np.inf, above)
        return above, contact_width(half_width, above, room)

    def scatter_below(self, stress: Array, place: Array, above: Array, width: Array) -> Array:
        """How far stress at the points scatters about the smooth curve beside places [modules], shape (Q,).

        What edges as a whole bring into it, however good their elements: their own curves, and that they are few.
        """
        if self.side == "compression":
            return _scatter(stress, self.arc, place, np.full(place.shape, self.length))
        end = np.broadcast_to(search_end(self.length, above, width, CLEARANCE), place.shape)
        return _scatter(without_contact(stress, self.arc, end, CLEARANCE), self.arc, place, end)

    def largest_below(self, stress: Array, above: Array, width: Array) -> tuple[Array, Array]:
        """The same below contacts that stand so far above the fillet, of those half-widths [modules].

        Root tension is looked for no nearer to a contact's edge than `CLEARANCE` (`search_end`).
        """
        if self.side == "compression":
            return extreme(stress, self.arc, -1.0, self.length)
        return extreme(stress, self.arc, 1.0, search_end(self.length, above, width, CLEARANCE), CLEARANCE)


@dataclass(frozen=True)
class CutFillet:
    """The same of a fillet in which a crack starts: it is looked at on either side of the mouth.

    Parameters
    ----------
    pieces : tuple of (float, FilletCurve, slice)
        Where each piece starts [modules], its curve, and its points among those of the fillet.
    """

    pieces: tuple[tuple[float, FilletCurve, slice], ...]

    def largest(
        self, stress: Array, radius: ArrayLike = math.inf, half_width: float = REFERENCE_HALF_WIDTH
    ) -> tuple[Array, Array]:
        """As `FilletCurve.largest`."""
        sign = 1.0 if self.pieces[0][1].side == "tension" else -1.0
        best, place = np.full(stress.shape[1], -np.inf), np.zeros(stress.shape[1])
        for start, curve, points in self.pieces:
            value, at = curve.largest(stress[points], radius, half_width)
            better = sign * value > best
            best = np.where(better, sign * value, best)
            place = np.where(better, at + start * curve.module, place)
        return sign * best, place

    def at(self, stress: Array, place: Array) -> Array:
        """As `FilletCurve.at`."""
        found = np.empty((place.size, stress.shape[1]))
        for start, curve, points in self.pieces:  # from the root land up
            on = ~(place < start * curve.module)
            found[on] = curve.at(stress[points], place[on] - start * curve.module)
        return found


#: A semi-elliptic pressure as three forces: places over its half-width, and parts of the load. What the forces do is
#: what the pressure does to fifth order in the half-width (Gauss and Chebyshev, second kind).
FORCES_OF_PRESSURE = ((-math.sqrt(0.5), 0.25), (0.0, 0.5), (math.sqrt(0.5), 0.25))


def contact_width(half_width: ArrayLike, below: Array, above: Array) -> Array:
    """Half-widths of contacts with so much flank on either side, narrowed where they would reach past its end."""
    return np.minimum(half_width, np.maximum(np.minimum(below, above), POINT))


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
    values = np.ascontiguousarray(values)  # once: each product with a sparse matrix would copy it
    ends = np.broadcast_to(np.asarray(end, dtype=float), values.shape[1:])
    if clearance < math.inf:
        values = without_contact(values, arc, ends, clearance)
    smoothing, slopes = smooth_curve(arc)
    height, rise, step = smoothing @ values, slopes @ values, np.diff(arc)
    if sign < 0.0:
        np.negative(height, out=height)
        np.negative(rise, out=rise)
    begins = arc[:, None] <= ends
    reached = np.where(begins, height, -np.inf).max(axis=0)
    # A cubic lies no higher than its ends by more than 4/27 of each slope: few pieces can have the largest value.
    steep = np.abs(rise)
    above = steep[:-1] + steep[1:]
    above *= (4.0 / 27.0) * step[:, None]
    above += np.maximum(height[:-1], height[1:])
    may = above >= reached
    may[1:] &= begins[1:-1]
    may[[0, -1]] |= begins[[0, -2]]  # beyond the outer points a cubic goes on
    may[0] = True
    piece, column = np.nonzero(may)
    a, b = height[piece, column], height[piece + 1, column]
    p, q = rise[piece, column] * step[piece], rise[piece + 1, column] * step[piece]
    within = (ends[column] - arc[piece]) / step[piece]
    square, cube = 3.0 * (b - a) - 2.0 * p - q, p + q - 2.0 * (b - a)
    low = np.where(piece == 0, -arc[0] / step[0], 0.0)
    high = np.clip(within, low, np.where(piece == step.size - 1, np.inf, 1.0))
    # Where the slope p + 2 square t + 3 cube t^2 vanishes, without cancellation; where it does not, any place will do.
    root = -(square + np.copysign(np.sqrt(np.maximum(square**2 - 3.0 * cube * p, 0.0)), square))
    flat = [
        np.divide(over, under, out=np.zeros_like(a), where=np.abs(under) > np.abs(over) * 1e-9)
        for over, under in ((root, 3.0 * cube), (p, root))
    ]
    at = np.stack([low, high, *(np.clip(place, low, high) for place in flat)])
    found = a + at * (p + at * (square + at * cube))
    which = found.argmax(axis=0)
    best, at = (np.take_along_axis(of, which[None], axis=0)[0] for of in (found, at))
    order = np.lexsort((-piece, best, column))
    last = order[np.append(np.diff(column[order]) > 0, True)]
    return sign * best[last], arc[piece[last]] + at[last] * step[piece[last]]


def _scatter(values: Array, arc: Array, place: Array, end: Array) -> Array:
    """Largest distance of values from the smooth curve among the points that it is fitted to beside a place."""
    values = np.ascontiguousarray(values)
    count = min(_POINTS, arc.size)
    first = np.clip(np.searchsorted(arc, place) - count // 2, 0, arc.size - count)
    beside, column = first + np.arange(count)[:, None], np.arange(place.size)
    off = np.abs(values - _smoothing(np.ascontiguousarray(arc).tobytes())[0] @ values)[beside, column]
    return np.asarray(np.where(arc[beside] <= end, off, 0.0).max(axis=0))


def without_contact(values: Array, arc: Array, ends: Array, clearance: float) -> Array:
    """Values that fade, between a fifth and a half of the clearance beyond the end, into that at the end."""
    faded = np.clip(((arc[:, None] - ends) / clearance - 0.2) / 0.3, 0.0, 1.0)
    below, columns = np.clip(np.searchsorted(arc, ends) - 1, 0, arc.size - 2), np.arange(ends.size)
    share = np.clip((ends - arc[below]) / (arc[below + 1] - arc[below]), 0.0, 1.0)
    last = (1.0 - share) * values[below, columns] + share * values[below + 1, columns]
    return np.asarray(values + faded * (last - values))


def curves_apart(values: Array, others: Array, part: float = 0.5) -> Array:
    """How far two curves are apart where the first counts, shape (...).

    The largest values of two solutions may agree by chance; their curves do not.

    Parameters
    ----------
    values, others : ndarray, shape (..., places)
        Stress, positive where it is largest.
    part : float
        Of its largest value, above which the first counts.
    """
    counts = values >= part * values.max(axis=-1, keepdims=True)
    return np.asarray(np.where(counts, np.abs(others - values), 0.0).max(axis=-1))


def usually_apart(values: Array, others: Array, part: float) -> Array:
    """Root mean square of how far two curves are apart where the first counts, shape (...): see `curves_apart`."""
    counts = values >= part * values.max(axis=-1, keepdims=True)
    return np.asarray(np.sqrt(np.where(counts, (others - values) ** 2, 0.0).sum(axis=-1) / counts.sum(axis=-1)))


def smooth_curve(arc: Array) -> tuple[csr_array, csr_array]:
    """Matrices from values at a fillet's points to the heights and slopes of the smooth curve through them.

    The curve is a cubic between two points, shape (points, points) each.
    """
    return _smoothing(np.ascontiguousarray(arc).tobytes())


def smooth_at(values: Array, arc: Array, at: Array) -> Array:
    """The smooth curve through values at a fillet's points, shape (points, Q), at arc lengths, shape (S, 1) or (S, Q).

    Returns
    -------
    ndarray, shape (S, Q)
    """
    smoothing, slopes = smooth_curve(arc)
    height, rise = smoothing @ values, slopes @ values
    piece = np.clip(np.searchsorted(arc, at) - 1, 0, arc.size - 2)
    step = arc[piece + 1] - arc[piece]
    t = (at - arc[piece]) / step
    column = np.arange(values.shape[1])
    a, b, p, q = (of[end, column] for of in (height, rise) for end in (piece, piece + 1))
    p, q = p * step, q * step
    return np.asarray(a + t * (p + t * (3.0 * (b - a) - 2.0 * p - q + t * (p + q - 2.0 * (b - a)))))


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
    # By rows as they are, in whole numbers that need no look at their size: made anew for each gear that is moved.
    columns, rows = column.ravel().astype(np.int32), np.arange(arc.size + 1, dtype=np.int32) * np.int32(count)
    weights = (np.einsum("nd,ndk->nk", basis, fit) for basis in (values, derived / half[:, None]))
    one, other = (csr_array((w.ravel(), columns, rows), shape=(arc.size,) * 2) for w in weights)
    return one, other
