"""How flanks part around a contact point, and the pinion's normal there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.unloaded.placement import Placement

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
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
