"""Surface stress on the fillets of a twisted tooth, from the displacement of the surface itself.

The fillet carries no load, so the stress in its surface follows from the three surface strains. With t the tangent in
the section, J a quarter turn and g = tau J x + k the tangent along the helix through a point, the displacement u = R v
stretches the surface by

    e_ss = t . v_,s    e_zz = g . (v_,z + tau J v)    2 e_sz = g . v_,s + t . (v_,z + tau J v)

in skew coordinates; turned to t and the direction b across it in the surface they give
sigma_tt = (e_tt + nu e_bb) / (1 - nu^2) and so on.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.fem.plane.root_stress import extreme
from fegear.fem.plane.trace import lagrange, lagrange_slope
from fegear.fem.solid.section import Section, upward


@dataclass(frozen=True)
class SolidFillet(ReadOnlyArrays):
    """Points up a fillet, in every section alike.

    Parameters
    ----------
    nodes : ndarray of int, shape (n,)
        Nodes of the section, each once.
    values, slopes : ndarray, shape (points, n)
        Shape functions, and their derivatives along the arc [1/modules].
    tangent, place : ndarray, shape (2, points)
        Up the tooth; [modules] in the section at z = 0.
    arc : ndarray, shape (points,)
        Arc length from the root land [modules].
    tangent_angle : ndarray, shape (points,)
        Angle between tangent and the tooth's centre line [rad].
    length : float
        [modules].
    mouth : float
        Where a crack starts, arc length [modules]; NaN without one.
    """

    nodes: Index
    values: Array
    slopes: Array
    tangent: Array
    place: Array
    arc: Array
    tangent_angle: Array
    length: float
    mouth: float = math.nan

    def largest(self, stress: Array, sign: float, end: Array) -> tuple[Array, Array]:
        """Largest (sign 1) or most negative (-1) value up the fillet, and its arc length [modules], shape (N,) each.

        On either side of the mouth of a crack.

        Parameters
        ----------
        stress : ndarray, shape (points, N)
        sign : {1, -1}
        end : ndarray, shape (N,)
            Arc length up to which it is looked for [modules].
        """
        if math.isnan(self.mouth):
            return extreme(stress, self.arc, sign, end)
        n = int(np.searchsorted(self.arc, self.mouth))
        best, place = np.full(stress.shape[1], -np.inf), np.zeros(stress.shape[1])
        for start, stop, on in ((0.0, self.mouth, slice(0, n)), (self.mouth, self.length, slice(n, None))):
            value, arc = extreme(stress[on], self.arc[on] - start, sign, np.minimum(end, stop) - start)
            better = (sign * value > best) & (end > start)
            best, place = np.where(better, sign * value, best), np.where(better, arc + start, place)
        return sign * best, place


def solid_fillet(section: Section, name: str) -> SolidFillet:
    """Points of a fillet: the Gauss points of its edges, where derivatives converge fastest.

    Parameters
    ----------
    section : Section
    name : {"fillet", "back_fillet"}
    """
    p = section.order
    xi, weight = np.polynomial.legendre.leggauss(p)
    xi, weight = 0.5 + 0.5 * xi, 0.5 * weight
    edges, places = upward(section, name)
    curve = places.shape[1] - 1
    place = np.einsum("cin,iq->cnq", places, lagrange(curve, xi))
    tangent = np.einsum("cin,iq->cnq", places, lagrange_slope(curve, xi))
    speed = np.hypot(*tangent)
    nodes, local = np.unique(edges, return_inverse=True)
    local = local.reshape(edges.shape)
    values, slopes = np.zeros((2, edges.shape[1], p, nodes.size))
    for e in range(edges.shape[1]):
        values[e][:, local[:, e]] = lagrange(p, xi).T
        slopes[e][:, local[:, e]] = (lagrange_slope(p, xi) / speed[e]).T
    lengths = (speed * weight).sum(axis=1)
    # Arc length at the points: exact for a polynomial of the edge's degree along it.
    inside = np.stack([np.polynomial.polynomial.polyval(x, _integral(xi, speed)) for x in xi], axis=1)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])[:-1, None] + inside
    unit = tangent / speed
    return SolidFillet(
        nodes=nodes,
        values=values.reshape(-1, nodes.size),
        slopes=slopes.reshape(-1, nodes.size),
        tangent=unit.reshape(2, -1),
        place=place.reshape(2, -1),
        arc=arc.reshape(-1),
        tangent_angle=np.arctan2(np.abs(unit[0]), section.side * unit[1]).reshape(-1),
        length=float(lengths.sum()),
    )


def _integral(xi: Array, speed: Array) -> Array:
    """Coefficients of the integral from 0 of the polynomial through speeds at xi, one column per edge."""
    coefficients = np.linalg.solve(np.vander(xi, increasing=True), speed.T)
    powers = np.arange(1, xi.size + 1)
    return np.concatenate([np.zeros((1, speed.shape[0])), coefficients / powers[:, None]])


def surface_stress(
    fillet: SolidFillet, tau: float, poisson_ratio: float, displacement: Array, values: Array, slopes: Array,
    slide: float = 0.0,
) -> Array:  # fmt: skip
    """Stress in the surface, E = 1.

    Parameters
    ----------
    fillet : SolidFillet
    tau : float
        [rad/module].
    poisson_ratio : float
    displacement : ndarray, shape (n, 3, functions, P)
        v (x, y, z) at the fillet's nodes, function by function along the face.
    values, slopes : ndarray, shape (functions, Z)
        Of the functions where the stress is wanted.
    slide : float
        Of a rack's section, as of `fegear.fem.solid.section.Straight`.

    Returns
    -------
    ndarray, shape (3, points, Z, P)
        Along the tangent t in the section, across it (b, in the surface, all but along the axis), and the shear
        between both.
    """
    (x, y), (tx, ty) = fillet.place, fillet.tangent
    gx, gy, none = slide - tau * y, tau * x, np.zeros_like(x)
    skew = tx * gx + ty * gy
    across = np.sqrt(1.0 + gx**2 + gy**2 - skew**2)
    # Every strain as a sum over what the three displacements change up the section and along the helix, (2, 3, points).
    e_ss = np.array([[tx, ty, none], [none, none, none]])
    e_zz = np.array([[none, none, none], [gx, gy, none + 1.0]])
    e_sz = 0.5 * np.array([[gx, gy, none + 1.0], [tx, ty, none]])
    e_tb = (e_sz - skew * e_ss) / across
    e_bb = (e_zz - skew**2 * e_ss - 2.0 * skew * across * e_tb) / across**2
    nu = poisson_ratio
    modulus = 1.0 / (1.0 - nu * nu)
    stress = np.stack([modulus * (e_ss + nu * e_bb), modulus * (e_bb + nu * e_ss), e_tb / (1.0 + nu)])
    # The section turns along the helix, and what moves on it with it.
    turned = tau * np.stack([stress[:, 1, 1], -stress[:, 1, 0], np.zeros_like(stress[:, 1, 0])], axis=1)
    moved = np.ascontiguousarray(displacement.transpose(0, 1, 3, 2)).reshape(fillet.nodes.size, -1)
    shape = fillet.arc.size, 3, displacement.shape[3], displacement.shape[2]
    along, here = ((matrix @ moved).reshape(shape) for matrix in (fillet.slopes, fillet.values))
    of_values = np.einsum("scp,pcrk->sprk", stress[:, 0], along) + np.einsum("scp,pcrk->sprk", turned, here)
    of_slopes = np.einsum("scp,pcrk->sprk", stress[:, 1], here)
    return np.asarray((of_values @ values + of_slopes @ slopes).swapaxes(2, 3))
