"""Stress intensity along the front of a crack through the face of a solid spur gear, as functionals of its sector.

The front runs along the face. With u(x, y, z) = sum_k P_k(z) u_k(x, y) the interaction integral over the section at z
is a functional of the u_k (`fegear.fem.plane.odd.stress_intensity`). What changes along the face adds integrals over
the area within the ring (Shih, Moran and Nakamura 1986), F_j the integrand of the ring, q its fall, a the fields of
Williams in plane strain, w the displacement of mode III along the front, l and m Lame's constants:

    K = factor [ int F_j q,j dA + int F_j,j q dA ],
    I, II: F_j,j = -s_i3,3 u^a_i,1 + l e_33 e^a_kk,1,    III: F_j,j = -s_33,3 w,1 + m u_j,3 w,j1,

the factors E' / 2 and m. Second derivatives of the fields, which have no bound, are shifted to the displacement along
the crack, as its faces run. So each K has three rows: with P, P' and P''.

Plane strain holds along the front but at its ends, where the square root of the distance is not what the field is of.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.elasticity import lame
from fegear.fem.plane.odd.stress_intensity import RINGS, ring_fields, williams

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.elements import SectorElements
    from fegear.fem.plane.odd.cracked_sector import CrackedSector

#: Modes I, II and III; rows for functions along the face, their slopes and their curvatures.
MODES, DERIVATIVES = 3, 3


def front_rows(sector: CrackedSector, poisson_ratio: float, elements: SectorElements) -> Array:
    """Functionals of what the section moves by, one for each ring, mode and derivative along the face; E = 1.

    Parameters
    ----------
    sector : CrackedSector
    poisson_ratio : float
    elements : SectorElements
        Of its mesh.

    Returns
    -------
    ndarray, shape (rings, 3 modes, 3 derivatives, N, 3)
        Of components x, y and z of the nodes [1/sqrt(module), and times a module for each derivative].
    """
    return np.stack([_of_ring(sector, poisson_ratio, elements, ring) for ring in RINGS])


def _of_ring(sector: CrackedSector, poisson_ratio: float, elements: SectorElements, ring: tuple[float, float]) -> Array:
    basis, local, at, q, fall = ring_fields(sector, elements, ring)
    lam, mu = lame(poisson_ratio, "strain")
    modulus, kappa = 1.0 / (1.0 - poisson_ratio**2), 3.0 - 4.0 * poisson_ratio
    size = int(elements.dofs.N)
    found = np.zeros((MODES, DERIVATIVES, size, 3))

    def add(mode: int, derivative: int, component: int, value: Array, gradient: Array) -> None:
        """Integrals of each shape function times `value`, and of its gradient, in the crack's axes, times another."""
        weights = np.einsum("ac,amq->cmq", local, gradient)
        of_function = np.stack(
            [((value * one + (weights * one.grad).sum(axis=0)) * basis.dx).sum(axis=1) for (one,) in basis.basis]
        )
        row = np.bincount(basis.element_dofs.ravel(), of_function.ravel(), size)
        axis = np.array([0.0, 0.0, 1.0]) if component == 2 else np.append(local[component], 0.0)
        found[mode, derivative] += row[:, None] * axis

    none, nothing = np.zeros_like(q), np.zeros_like(fall)
    along = np.stack([q, none])
    for mode in (0, 1):
        slope, stress = williams(mode + 1, at, mu, kappa)
        widening = (stress[0, 0] + stress[1, 1]) / (2.0 * (lam + mu))
        factor = 0.5 * modulus
        hooke = slope[:, None] * fall[None]
        for i in (0, 1):
            # s_ij u^a_i,1 q,j + s^a_ij u_i,1 q,j - s^a_ij u_i,j q,1 of component i
            weight = mu * (hooke[i] + hooke[:, i]) - stress[i] * fall[0]
            weight[i] += lam * (hooke[0, 0] + hooke[1, 1])
            weight[0] += np.einsum("jmq,jmq->mq", stress[i], fall)
            add(mode, 0, i, none, factor * weight)
            add(mode, 2, i, -factor * mu * q * slope[i], nothing)
        value = lam * ((slope * fall).sum(axis=0) - widening * fall[0])
        add(mode, 1, 2, factor * value, -factor * (mu * slope * q + lam * widening * along))
    w, t = _antiplane(at, mu)
    weight = mu * w[0] * fall - t * fall[0]
    weight[0] += (t * fall).sum(axis=0)
    add(2, 0, 2, none, mu * weight)
    add(2, 2, 2, -mu * (lam + 2.0 * mu) * w[0] * q, nothing)
    for j in (0, 1):
        value = mu * (w[0] * fall[j] - w[j] * fall[0])
        gradient = -t[j] * along
        gradient[j] -= lam * w[0] * q
        add(2, 1, j, mu * value, mu * gradient)
    return found


def _antiplane(at: Array, mu: float) -> tuple[Array, Array]:
    """Slopes of the displacement along the front with unit K_III, and its stress, shape (2, ...) each."""
    r, theta = np.hypot(*at), np.arctan2(at[1], at[0])
    stress = np.stack([-np.sin(0.5 * theta), np.cos(0.5 * theta)]) / np.sqrt(2.0 * math.pi * r)
    return stress / mu, stress
