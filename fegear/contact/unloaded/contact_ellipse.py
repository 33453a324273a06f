"""How flanks part around a contact point, and the contact ellipse under load (Hertz).

Bearing contact: the ellipses that surface contact points spread into under load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.contact.unloaded.separation import Placement

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.unloaded.pair import HelicalPair
    from fegear.contact.unloaded.tooth_contact import PairContact
    from fegear.geometry.rack_cutter import RackFlank


@dataclass(frozen=True, slots=True)
class Parting:
    """Gap around a contact point: (large x^2 + small y^2)/2 with x, y along two directions of the tangent plane.

    Parameters
    ----------
    large, small : ndarray, shape (n,)
        Principal relative curvatures [1/m]; the small one is zero in line contact.
    along : ndarray, shape (3, n)
        Unit vector of the small curvature in the fixed frame: the long axis of the ellipse.
    across : ndarray, shape (3, n)
        Unit vector of the large curvature.
    """

    large: Array
    small: Array
    along: Array
    across: Array


def parting(p: Placement, flank: RackFlank, phi_1: Array, s: Array, z: Array) -> Parting:
    """Relative curvature of both flanks at surface contact points.

    Parameters
    ----------
    p : Placement
    flank : RackFlank
    phi_1, s, z : ndarray, shape (n,)
        Pinion angles [rad] and contact points [m] on the pinion's flank.
    """
    w, dw = flank.profile(s)
    turn = np.exp(1j * phi_1)
    q, qs = p.turned(w * turn, z), p.turned(dw * turn, z)
    rate = p.rate(z)
    qz, qzz = 1j * rate * q, -(rate**2) * q - 2j * p.crown * q
    normal = pinion_normal(p, w * turn, dw * turn, z)
    nc = normal[0] + 1j * normal[1]

    def dot(v: NDArray[np.complex128]) -> Array:
        return (np.conj(nc) * v).real

    # Second fundamental form of the pinion; the profile's own bend is its curvature times the squared speed.
    ss = -(np.abs(qs) ** 2) * flank.profile_curvature(s) * np.hypot(normal[0], normal[1])
    form = np.stack([np.stack([ss, dot(1j * rate * qs)]), np.stack([dot(1j * rate * qs), dot(qzz)])])
    xs = np.stack([qs.real, qs.imag, np.zeros_like(z)])
    xz = np.stack([qz.real, qz.imag, np.ones_like(z)])
    e1 = xs / np.linalg.norm(xs, axis=0)
    e2 = np.cross(normal, e1, axis=0)
    inner = np.stack([np.stack([(e1 * xs).sum(0), (e1 * xz).sum(0)]), np.stack([(e2 * xs).sum(0), (e2 * xz).sum(0)])])
    inverse = np.linalg.inv(np.moveaxis(inner, 2, 0))
    shape_1 = np.einsum("nki,nkl,nlj->nij", inverse, np.moveaxis(form, 2, 0), inverse)

    x2, y2, _ = p.in_gear_frame(q, z)
    A, B, t = p.gradient(x2, y2)
    # Across the gear's generator: the transverse tangent of its involute, freed of its part along the generator.
    across = _to_fixed(p, np.stack([-B, A, np.zeros_like(A)])) * p.base_2
    m = np.stack([(e1 * across).sum(0), (e2 * across).sum(0)])
    m /= np.linalg.norm(m, axis=0)
    bend = math.cos(math.atan(p.twist_2 * p.base_2)) / t
    gap = -shape_1 + np.moveaxis(bend * m[:, None] * m[None, :], 2, 0)
    values, vectors = np.linalg.eigh(0.5 * (gap + np.swapaxes(gap, 1, 2)))
    basis = np.stack([e1, e2])
    direction = np.einsum("iaj,jik->kaj", basis, vectors)
    return Parting(values[:, 1], values[:, 0], direction[0], direction[1])


def _to_fixed(p: Placement, v: Array) -> Array:
    return np.stack([-v[0], -v[1] * p.cos - v[2] * p.sin, v[2] * p.cos - v[1] * p.sin])


def pinion_normal(p: Placement, w: NDArray[np.complex128], dw: NDArray[np.complex128], z: Array) -> Array:
    """Unit normals (3, n) out of the pinion's material in the fixed frame."""
    q, qs = p.turned(w, z), p.turned(dw, z)
    e = 1j * qs / np.abs(qs)
    arm = (np.conj(q) * e).imag
    normal = np.stack([e.real, e.imag, -p.rate(z) * arm])
    return np.asarray(normal / np.linalg.norm(normal, axis=0))


@dataclass(frozen=True, slots=True)
class ContactEllipse:
    """Hertzian contact of two smooth bodies.

    Parameters
    ----------
    long, short : ndarray
        Half axes [m].
    pressure : ndarray
        Largest pressure [Pa].
    approach : ndarray
        Approach of the bodies [m].
    """

    long: Array
    short: Array
    pressure: Array
    approach: Array


def contact_ellipse(large: ArrayLike, small: ArrayLike, load: float, modulus: float) -> ContactEllipse:
    """Half axes, pressure and approach of an elliptical contact (Johnson, Contact Mechanics, 4.2).

    With m1 = (b/a)^2 and Legendre's D = (K - E)/e^2 the ratio of curvatures is (K - D)/(m1 D) and
    a^3 = 3 F D/(pi E* small): no difference cancels between the circle and the long ellipse.

    Parameters
    ----------
    large, small : array_like
        Principal relative curvatures [1/m], large >= small > 0.
    load : float
        F [N].
    modulus : float
        E* [Pa], 1/E* the sum of (1 - nu^2)/E of both bodies.

    Raises
    ------
    InputError
        If load, modulus or curvatures are not positive (line contact has no ellipse).
    """
    from scipy.special import ellipkm1, elliprd

    large, small = np.broadcast_arrays(np.asarray(large, dtype=float), np.asarray(small, dtype=float))
    if not (load > 0.0 and math.isfinite(load)):
        raise InputError("load", load, "must be positive and finite")
    if not (modulus > 0.0 and math.isfinite(modulus)):
        raise InputError("modulus", modulus, "must be positive and finite")
    if not (np.all(small > 0.0) and np.all(large >= small)):
        raise InputError("small", small, "must be positive and no larger than the large curvature")

    def ratio(log_m1: Array) -> tuple[Array, Array]:
        m1 = np.exp(log_m1)
        D = elliprd(0.0, m1, 1.0) / 3.0
        return (ellipkm1(m1) - D) / (m1 * D), D

    lo, hi = np.full(large.shape, -80.0), np.zeros(large.shape)
    for _ in range(64):
        middle = 0.5 * (lo + hi)
        longer = ratio(middle)[0] > large / small
        lo, hi = np.where(longer, middle, lo), np.where(longer, hi, middle)
    log_m1 = 0.5 * (lo + hi)
    D = ratio(log_m1)[1]
    a = np.cbrt(3.0 * load * D / (np.pi * modulus * small))
    b = a * np.exp(0.5 * log_m1)
    return ContactEllipse(
        a, b, 1.5 * load / (np.pi * a * b), 1.5 * load * ellipkm1(np.exp(log_m1)) / (np.pi * modulus * a)
    )


@dataclass(frozen=True, slots=True)
class Bearing:
    """Contact ellipses along a path of contact.

    Parameters
    ----------
    index : ndarray of int, shape (m,)
        Positions of the contact that are surface contact with a defined place.
    ellipse : ContactEllipse
        Half axes, pressure and approach, arrays of shape (m,).
    long_axis, short_axis : ndarray, shape (3, m)
        Unit vectors of the axes in the fixed frame.
    """

    index: NDArray[np.int_]
    ellipse: ContactEllipse
    long_axis: Array
    short_axis: Array


def bearing_contact(pair: HelicalPair, contact: PairContact, load: float, modulus: float) -> Bearing:
    """Contact ellipses of one tooth pair that carries a load.

    Parameters
    ----------
    pair : HelicalPair
    contact : PairContact
        From `pair_contact`, or the ``mesh`` or ``single`` part of `tooth_contact`.
    load : float
        Normal force on the tooth pair [N].
    modulus : float
        E* [Pa], 1/E* the sum of (1 - nu^2)/E of both gears.

    Raises
    ------
    RangeError
        If no position is surface contact with a defined place: edges have no ellipse, lines none that ends.
    """
    index = np.flatnonzero((contact.kind == "surface") & ~contact.ill_defined)
    if index.size == 0:
        raise RangeError(
            "contact", "edges or lines only", "have no contact ellipse", "give the pinion's cutter a parabola"
        )
    p = Placement.of(pair)
    gap = parting(p, pair.flank, contact.phi_1[index], contact.s[index], contact.z1[index])
    return Bearing(index, contact_ellipse(gap.large, gap.small, load, modulus), gap.along, gap.across)
