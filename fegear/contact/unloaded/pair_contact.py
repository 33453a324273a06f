"""Contact of one tooth pair at given pinion angles: where, what bounds it, and how fast the gear runs ahead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.unloaded.earliest import Earliest, earliest_contact
from fegear.contact.unloaded.pair import HelicalPair
from fegear.contact.unloaded.parting import parting, pinion_normal
from fegear.contact.unloaded.placement import Placement
from fegear.contact.unloaded.reach import Bound

#: Gap that counts as touching when the length of an ill-defined contact is reported [m].
TOUCHING = 1e-9

_NAMES = {
    Bound.NONE: "surface",
    Bound.PINION_FACE_LOW: "pinion face end",
    Bound.PINION_FACE_HIGH: "pinion face end",
    Bound.GEAR_FACE_LOW: "gear face end",
    Bound.GEAR_FACE_HIGH: "gear face end",
    Bound.GEAR_TIP: "gear tip",
    Bound.GEAR_FORM: "gear form circle",
    Bound.BASE_TANGENT: "base tangent point",
    Bound.PINION_TIP: "pinion tip",
    Bound.PINION_FORM: "pinion form circle",
}


@dataclass(frozen=True, slots=True)
class PairContact(ReadOnlyArrays):
    """Contact of one tooth pair at given pinion angles, all arrays of shape (n,) and read-only.

    Parameters
    ----------
    phi_1 : ndarray
        Pinion angle [rad] of this tooth pair.
    error : ndarray
        Transmission error phi_2 - (N_1/N_2) phi_1 [rad], positive where the gear runs ahead; -inf where the flanks
        do not face each other.
    slope : ndarray
        Its derivative by phi_1, from the velocities at the contact point.
    bounds : ndarray of int8, shape (2, n)
        What bounds the contact point (`Bound`).
    kind : ndarray of str
        "surface", "pinion tip", "gear tip", "pinion face end", "gear face end", "corner" (two edges), or a flank
        limit ("pinion form circle", "gear form circle", "base tangent point") where contact would leave the involute.
    s : ndarray
        Contact point on the pinion's profile [m] (see `RackFlank`).
    r1, z1, r2, z2 : ndarray
        Radius and height of the contact point in both gears' frames [m].
    point : ndarray, shape (3, n)
        Contact point in the fixed frame [m].
    spread : ndarray
        Length [m] over which the flanks are within a nanometre of each other around a surface contact point (at most
        the face width); zero for edge contact.
    ill_defined : ndarray of bool
        Where `spread` exceeds a quarter of the face width: line contact, or nearly so. The transmission error is
        accurate there, the place of the contact point means little.
    """

    bounds: NDArray[np.int8]
    s: Array
    point: Array
    ill_defined: NDArray[np.bool_]
    phi_1: Array = shown("deg", "pinion angle", name="phi1")
    error: Array = shown("arcsec", "transmission error phi2 - (N1/N2) phi1, positive if the gear leads", name="te")
    slope: Array = shown("", "derivative of the transmission error with respect to phi1")
    kind: NDArray[np.str_] = shown("", "surface or edge in contact", name="contact")
    r1: Array = shown("mm", "radius of the contact point on the pinion")
    z1: Array = shown("mm", "axial position of the contact point on the pinion")
    r2: Array = shown("mm", "radius of the contact point on the gear")
    z2: Array = shown("mm", "axial position of the contact point on the gear")
    spread: Array = shown("mm", "length over which the flank gap is below one nanometre")


def pair_contact(pair: HelicalPair, phi_1: ArrayLike) -> PairContact:
    """Contact of one tooth pair alone at given pinion angles.

    Parameters
    ----------
    pair : HelicalPair
    phi_1 : array_like
        Pinion angles [rad].
    """
    angles = np.atleast_1d(np.asarray(phi_1, dtype=float)).ravel()
    if not np.all(np.isfinite(angles)):
        raise InputError("phi_1", phi_1, "must be finite")
    p = Placement.of(pair)
    return describe(pair, p, angles.copy(), earliest_contact(p, pair.flank, angles))


def slope_of_error(p: Placement, pair: HelicalPair, phi_1: Array, e: Earliest) -> Array:
    """d(phi_2)/d(phi_1) - N_1/N_2 from the velocities along the normal that belongs to the kind of contact."""
    w, dw = pair.flank.profile(e.s)
    turn = np.exp(1j * phi_1)
    q, qs = p.turned(w * turn, e.z), p.turned(dw * turn, e.z)
    qz = 1j * p.rate(e.z) * q
    x2, y2, _ = p.in_gear_frame(q, e.z)
    A, B, _ = p.gradient(x2, y2)

    def to_gear(v: Array) -> Array:
        return np.stack([-v[0], -v[1] * p.cos - v[2] * p.sin, v[2] * p.cos - v[1] * p.sin])

    zero, one = np.zeros_like(e.z), np.ones_like(e.z)
    of_gear = np.stack([A, B, p.twist_2 * one])
    of_pinion = to_gear(pinion_normal(p, w * turn, dw * turn, e.z))
    first, second = e.bounds
    gear_edge = _is_gear(first) | _is_gear(second)
    pinion_edge = _is_pinion(first) | _is_pinion(second)
    tip = (first == Bound.PINION_TIP) | (second == Bound.PINION_TIP)
    edge_1 = to_gear(np.where(tip, np.stack([qz.real, qz.imag, one]), np.stack([qs.real, qs.imag, zero])))
    around = (first == Bound.GEAR_TIP) | (second == Bound.GEAR_TIP)
    edge_2 = np.where(around, np.stack([-p.twist_2 * y2, p.twist_2 * x2, one]), np.stack([-B, A, zero]))
    of_edges = np.cross(edge_1, edge_2, axis=0)
    normal = np.where(gear_edge & pinion_edge, of_edges, np.where(gear_edge, of_pinion, of_gear))
    velocity_1 = to_gear(np.stack([-q.imag, q.real, zero]))
    along_2 = normal[0] * y2 - normal[1] * x2
    # Edges that cross at a vanishing angle have no normal of their own; the gear's is then as good.
    weak = np.abs(along_2) < 1e-6 * np.linalg.norm(normal, axis=0) * np.hypot(x2, y2)
    normal = np.where(weak, of_gear, normal)
    along_2 = normal[0] * y2 - normal[1] * x2
    return (normal * velocity_1).sum(axis=0) / along_2 - p.ratio


def _is_gear(bound: NDArray[np.int8]) -> NDArray[np.bool_]:
    return (bound >= Bound.GEAR_FACE_LOW) & (bound <= Bound.GEAR_FORM)


def _is_pinion(bound: NDArray[np.int8]) -> NDArray[np.bool_]:
    return np.isin(bound, (Bound.PINION_FACE_LOW, Bound.PINION_FACE_HIGH, Bound.PINION_TIP, Bound.PINION_FORM))


def describe(pair: HelicalPair, p: Placement, phi_1: Array, e: Earliest) -> PairContact:
    """Name what touches at each angle, and where."""
    w, _ = pair.flank.profile(e.s)
    q = p.turned(w * np.exp(1j * phi_1), e.z)
    x2, y2, z2 = p.in_gear_frame(q, e.z)
    touching = np.isfinite(e.phi_2)
    names = np.array([_NAMES[Bound(code)] for code in sorted(_NAMES)])
    kind = np.where(e.bounds[0] == Bound.NONE, names[e.bounds[1]], names[e.bounds[0]]).astype("<U18")
    kind[(e.bounds != Bound.NONE).all(axis=0)] = "corner"
    kind[~touching] = "none"
    spread = np.zeros(phi_1.size)
    inside = np.flatnonzero(kind == "surface")
    width = pair.overlap[1] - pair.overlap[0]
    if inside.size:
        small = parting(p, pair.flank, phi_1[inside], e.s[inside], e.z[inside]).small
        # The gap reaches the limit at +-sqrt(2 gap / curvature).
        spread[inside] = np.minimum(np.sqrt(8.0 * TOUCHING / np.maximum(small, 8.0 * TOUCHING / width**2)), width)
    return PairContact(
        phi_1=phi_1,
        error=e.phi_2 - p.ratio * phi_1,
        slope=slope_of_error(p, pair, phi_1, e),
        bounds=e.bounds,
        kind=kind,
        s=e.s,
        r1=np.abs(w),
        z1=e.z,
        r2=np.hypot(x2, y2),
        z2=z2,
        point=np.stack([q.real, q.imag, e.z]),
        spread=spread,
        ill_defined=spread > 0.25 * width,
    )
