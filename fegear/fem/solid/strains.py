"""Strains of a twisted prism: the helicoid's own coordinates, in which every section is alike.

The section at height z is the one at z = 0 turned by tau z, X = R(tau z)(xi, eta), and so are the components of the
displacement, u = R v. With D = d/dz + tau (eta d/dxi - xi d/deta), the derivative along the axis, the strains in the
turned axes are

    e_xx = v_x,x   e_yy = v_y,y   g_xy = v_x,y + v_y,x
    e_zz = D w   g_xz = w,x + D v_x - tau v_y   g_yz = w,y + D v_y + tau v_x.

No coefficient depends on z: with a function N of the section times a function P along the face, every strain is
B0 P + B1 P', and a stiffness is a short sum of products of section and face integrals.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Array

#: Order of the strains: e_xx, e_yy, e_zz, g_xy, g_xz, g_yz.
STRAINS = 6


def hooke(poisson_ratio: float) -> Array:
    """Isotropic stiffness for E = 1 between strains and stresses in the order of `STRAINS`, shape (6, 6)."""
    nu = poisson_ratio
    mu = 0.5 / (1.0 + nu)
    matrix = np.zeros((STRAINS, STRAINS))
    matrix[:3, :3] = nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    matrix[np.arange(3), np.arange(3)] += 2.0 * mu
    matrix[np.arange(3, 6), np.arange(3, 6)] = mu
    return matrix


def strain_functions(values: Array, gradient: Array, place: Array, tau: float) -> tuple[Array, Array]:
    """B0 and B1 of the functions of a section at its points.

    Parameters
    ----------
    values : ndarray, shape (n, q)
        Shape functions.
    gradient : ndarray, shape (M, n, 2, q)
        [1/modules].
    place : ndarray, shape (2, M, q)
        From the gear's axis [modules].
    tau : float
        Twist [rad/module], positive for a right hand.

    Returns
    -------
    along_section, along_face : ndarray, shape (M, q, 6, n, 3)
        Strains per function and displacement component; times P, and times P'.
    """
    count, n, _, q = gradient.shape
    dx, dy = gradient[:, :, 0].transpose(0, 2, 1), gradient[:, :, 1].transpose(0, 2, 1)
    turning = tau * (place[1][:, :, None] * dx - place[0][:, :, None] * dy)
    shape = values.T[None]
    b0, b1 = np.zeros((2, count, q, STRAINS, n, 3))
    b0[:, :, 0, :, 0] = b0[:, :, 3, :, 1] = b0[:, :, 4, :, 2] = dx
    b0[:, :, 1, :, 1] = b0[:, :, 3, :, 0] = b0[:, :, 5, :, 2] = dy
    b0[:, :, 2, :, 2] = b0[:, :, 4, :, 0] = b0[:, :, 5, :, 1] = turning
    b0[:, :, 4, :, 1] = -tau * shape
    b0[:, :, 5, :, 0] = tau * shape
    b1[:, :, 2, :, 2] = b1[:, :, 4, :, 0] = b1[:, :, 5, :, 1] = shape
    return b0, b1
