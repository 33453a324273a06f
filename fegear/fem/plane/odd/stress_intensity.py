"""Stress intensity factors of a crack by the interaction integral, as linear functionals of its sector's displacement.

Over a ring r_1 < r < r_2 around the tip, with q falling smoothly from one to zero over it and the fields a of Williams'
first terms for K_I = 1 or K_II = 1 (Stern, Becker and Dunham 1976; Moran and Shih 1987),

    K = (E'/2) int [s_ij u^a_i,1 + s^a_ij u_i,1 - s_kl e^a_kl d_1j] q_,j dA,

whose value does not depend on the ring as long as the faces within it are straight and free. K is g' u with the same g
for every load: with that of all teeth it becomes rows like a compliance.

Not by the opening of the tip's elements: natural quarter-point triangles vary too little with the angle, and miss K_I
by 2.6 % with eight rays whatever their size.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.elements import SectorElements
from fegear.fem.plane.odd.cracked_sector import CrackedSector
from fegear.geometry.gear import Plane

#: Inner and outer radius of the ring, and of a second one that shows the error, as shares of the room around the tip.
RINGS = ((0.2, 0.8), (0.15, 0.5))
#: Degree of the quadrature: the auxiliary fields are no polynomials, and q has kinks in its second derivative. With
#: kinks in its first (1 - 3 w^2 + 2 w^3) errors are five times as large.
_DEGREE = 19


def interaction(
    sector: CrackedSector,
    poisson_ratio: float,
    plane: Plane,
    elements: SectorElements,
    ring: tuple[float, float] = RINGS[0],
) -> Array:
    """Functionals g of a cracked sector's displacement u with K_I = g_I' u and K_II = g_II' u; E = 1.

    Parameters
    ----------
    sector : CrackedSector
    poisson_ratio : float
    plane : {"strain", "stress"}
    elements : SectorElements
        That the displacement is of.
    ring : tuple of float
        Inner and outer radius as shares of the room around the tip.

    Returns
    -------
    ndarray, shape (size, 2)
        [1/sqrt(module)]: K is in units of stress times the root of a module, stress in line load per module. K_I opens
        the crack; K_II is positive where its left face, seen from the mouth, moves toward the tip.
    """
    lam, mu = lame(poisson_ratio, plane)
    modulus = 1.0 / (1.0 - poisson_ratio**2) if plane == "strain" else 1.0
    kappa = 3.0 - 4.0 * poisson_ratio if plane == "strain" else (3.0 - poisson_ratio) / (1.0 + poisson_ratio)
    r1, r2 = (share * sector.room for share in ring)
    chosen, tip, local = _around(sector, elements, r2, r1)
    basis = elements.vector_basis(chosen=chosen, degree=_DEGREE)

    at = np.einsum("ac,cmq->amq", local, np.asarray(basis.global_coordinates()) - tip[:, :, None])
    found = []
    for mode in (1, 2):
        weight = np.einsum("ac,bd,abmq->cdmq", local, local, _weights(mode, at, (r1, r2), lam, mu, kappa))
        of_function = np.stack(
            [((weight * one.grad).sum(axis=(0, 1)) * basis.dx).sum(axis=1) for (one,) in basis.basis]
        )
        found.append(np.bincount(basis.element_dofs.ravel(), of_function.ravel(), basis.N))
    return np.asarray(0.5 * modulus * np.stack(found, axis=1), dtype=float)


def _around(
    sector: CrackedSector, elements: SectorElements, outer: float, inner: float = 0.0
) -> tuple[Index, Array, Array]:
    """Elements with a part between two circles around the tip, where it is, and the crack's axes as rows."""
    tip = sector.tip[:, None] - elements.tip[:, 0]
    corners = np.hypot(*(elements.grid.p - tip))[elements.grid.t]
    chosen = np.flatnonzero((corners.min(axis=0) < outer) & (corners.max(axis=0) > inner))
    return chosen, tip, np.array([sector.way, [-sector.way[1], sector.way[0]]])  # along the crack, and to its left


def ring_fields(
    sector: CrackedSector, elements: SectorElements, ring: tuple[float, float]
) -> tuple[Any, Array, Array, Array, Array]:
    """Shape functions of the elements within a ring's outer circle, and where the ring's q is and falls.

    Returns
    -------
    basis : skfem.Basis
        Scalar.
    local : ndarray, shape (2, 2)
        Rows: along the crack, and to its left.
    at : ndarray, shape (2, M, Q)
        Places of the quadrature from the tip, in these axes [modules].
    q : ndarray, shape (M, Q)
    fall : ndarray, shape (2, M, Q)
        Gradient of q.
    """
    r1, r2 = (share * sector.room for share in ring)
    chosen, tip, local = _around(sector, elements, r2)
    basis = elements.basis(chosen, _DEGREE)
    at = np.einsum("ac,cmq->amq", local, np.asarray(basis.global_coordinates()) - tip[:, :, None])
    return basis, local, at, _share(np.hypot(*at), r1, r2), _fall(at, r1, r2)


def _share(r: Array, r1: float, r2: float) -> Array:
    """q = 1 - 10 w^3 + 15 w^4 - 6 w^5 over the ring, one within it and zero beyond."""
    w = np.clip((r - r1) / (r2 - r1), 0.0, 1.0)
    return np.asarray(1.0 - w**3 * (10.0 - 15.0 * w + 6.0 * w**2))


def by_faces(sector: CrackedSector, places: Array, ring: tuple[float, float] = RINGS[0]) -> Array:
    """What pairs of unit forces between the faces add to K_I beside the functionals of `interaction`, shape (2, N).

    The ring of integration takes its faces as free. Of forces t on them - int t_j u^a_j,1 q ds is left out, which is
    q sqrt(2 / (pi r)) for a pair at r from the tip, and nothing for K_II.

    Parameters
    ----------
    sector : CrackedSector
    places : ndarray, shape (2, N)
        Of the pairs, on its faces [modules].
    ring : tuple of float
    """
    r1, r2 = (share * sector.room for share in ring)
    r = np.hypot(*(places - sector.tip[:, None]))
    return np.stack([_share(r, r1, r2) * np.sqrt(2.0 / (math.pi * r)), np.zeros(r.shape)])


def _weights(mode: int, at: Array, ring: tuple[float, float], lam: float, mu: float, kappa: float) -> Array:
    """By what a displacement's gradient du_a/dx_b, along the crack and to its left, enters: shape (2, 2, ...)."""
    fall = _fall(at, *ring)
    slope, stress = williams(mode, at, mu, kappa)
    # s_ij u^a_i,1 q_,j of the strain, by Hooke's law; s^a_ij u_i,1 q_,j; s^a_ij e_ij q_,1.
    product = slope[:, None] * fall[None]
    found = mu * (product + product.transpose(1, 0, 2, 3)) - stress * fall[0]
    found[0, 0] += lam * (product[0, 0] + product[1, 1])
    found[1, 1] += lam * (product[0, 0] + product[1, 1])
    found[:, 0] += np.einsum("ijmq,jmq->imq", stress, fall)
    return np.asarray(found)


def _fall(at: Array, r1: float, r2: float) -> Array:
    """Gradient of q = 1 - 10 w^3 + 15 w^4 - 6 w^5 over the ring, zero off it, shape (2, ...)."""
    r = np.hypot(*at)
    w = np.clip((r - r1) / (r2 - r1), 0.0, 1.0)
    return np.asarray(-30.0 * (w * (1.0 - w)) ** 2 / (r2 - r1) * at / np.maximum(r, 1e-300))


def williams(mode: int, at: Array, mu: float, kappa: float) -> tuple[Array, Array]:
    """Williams' first term with unit stress intensity, in components along the crack and to its left.

    Returns
    -------
    slope : ndarray, shape (2, ...)
        Derivative of the displacement along the crack.
    stress : ndarray, shape (2, 2, ...)
    """
    r, theta = np.hypot(*at), np.arctan2(at[1], at[0])
    c, s = np.cos(0.5 * theta), np.sin(0.5 * theta)
    c3, s3 = np.cos(1.5 * theta), np.sin(1.5 * theta)
    # u = sqrt(r / 2 pi) / (2 mu) g(theta), so that du/dx = (cos(theta) g / 2 - sin(theta) g') / sqrt(2 pi r) / (2 mu)
    if mode == 1:
        stress = np.array([[c * (1.0 - s * s3), s * c * c3], [s * c * c3, c * (1.0 + s * s3)]])
        g = np.array([c, s]) * (kappa - np.cos(theta))
        turn = 0.5 * np.array([-s, c]) * (kappa - np.cos(theta)) + np.array([c, s]) * np.sin(theta)
    else:
        stress = np.array([[-s * (2.0 + c * c3), c * (1.0 - s * s3)], [c * (1.0 - s * s3), s * c * c3]])
        off = np.array([kappa + 2.0 + np.cos(theta), kappa - 2.0 + np.cos(theta)])
        g = np.array([s, -c]) * off
        turn = 0.5 * np.array([c, s]) * off - np.array([s, -c]) * np.sin(theta)
    over = 1.0 / np.sqrt(2.0 * math.pi * r)
    return over / (2.0 * mu) * (0.5 * np.cos(theta) * g - np.sin(theta) * turn), over * stress
