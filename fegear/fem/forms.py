"""The weak forms of elasticity, in the plane and in the coordinates of a turned prism, as scikit-fem integrates them.

Each equation stands here once, for displacements with several components. On elements whose components have the same
shape functions N_i it is a sum of integrals of products of two slopes, N_i,k N_j,l, which scikit-fem integrates
(`products`) at a fifth of the cost of vector-valued functions; what each of them is multiplied by follows from the
equation itself, evaluated for unit displacement gradients (`coefficients`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from skfem import BilinearForm
from skfem.element import DiscreteField
from skfem.helpers import ddot, div, sym_grad

from fegear.base.arrays import Array


class _Dotted(BilinearForm):  # type: ignore[misc]  # scikit-fem has no types
    """A form whose sum over the quadrature points is one dot product: half the time of scikit-fem's own."""

    def _kernel(self, u: Any, v: Any, w: Any, dx: Array) -> Array:
        return np.vecdot(self.form(*u, *v, w), dx)


@BilinearForm  # type: ignore[untyped-decorator]  # scikit-fem has no types
def plane_elasticity(u: Any, v: Any, w: Any) -> Any:
    """Work of the stresses of u on the strains of v, lambda div u div v + 2 mu eps(u) : eps(v)."""
    return w["lam"] * div(u) * div(v) + 2.0 * w["mu"] * ddot(sym_grad(u), sym_grad(v))


def turned_strains(value: Any, slope: Any, tau: float) -> Array:
    """Strains of a twisted prism in its own coordinates, in which every section is alike.

    The section at height z is the one at z = 0 turned by tau z, X = R(tau z)(xi, eta), and so are the components of
    the displacement, u = R v. D = d/dz + tau (eta d/dxi - xi d/deta) is the derivative along the axis.

    Parameters
    ----------
    value : array, shape (3, ...)
        Components of v in the turned axes.
    slope : array, shape (3, 3, ...)
        Of each component along xi and eta, and its D [1/modules].
    tau : float
        Twist [rad/module], positive for a right hand.

    Returns
    -------
    ndarray, shape (6, ...)
        e_xx, e_yy, e_zz, g_xy, g_xz, g_yz.
    """
    x, y, z = slope
    shear = y[0] + x[1], z[0] + x[2] - tau * value[1], z[1] + y[2] + tau * value[0]
    return np.stack(np.broadcast_arrays(x[0], y[1], z[2], *shear))


def stresses(strain: Array, lam: float, mu: float) -> Array:
    """Isotropic stresses from strains, both in the order of `turned_strains`, shape (6, ...)."""
    pressure = lam * strain[:3].sum(axis=0)
    return np.concatenate([pressure + 2.0 * mu * strain[:3], mu * strain[3:]])


@BilinearForm  # type: ignore[untyped-decorator]  # scikit-fem has no types
def turned_elasticity(u: Any, v: Any, w: Any) -> Any:
    """Work of the stresses of u on the strains of v in a twisted prism; gradients hold D as their third slope."""
    stress = stresses(turned_strains(u, u.grad, w["tau"]), w["lam"], w["mu"])
    return (stress * turned_strains(v, v.grad, w["tau"])).sum(axis=0)


def _in_section(u: Any, w: Any) -> Array:
    """Strains of a function of the section that does not change along the face: B0."""
    x, y = u.grad[:, 0], u.grad[:, 1]
    d = w["tau"] * (w["place"][1] * x - w["place"][0] * y)
    return turned_strains(np.asarray(u), np.stack([x, y, d], axis=1), w["tau"])


def _along_face(u: Any, w: Any) -> Array:
    """Strains that its change along the face adds, per unit of that: B1; in an inclined web it shears the section."""
    value, place = np.asarray(u), np.asarray(w["place"])
    outward = np.asarray(w["lean"]) * place / np.hypot(*place)
    return turned_strains(np.zeros_like(value), np.stack([outward[0] * value, outward[1] * value, value], axis=1), 0.0)


def _work(strain_u: Array, strain_v: Array, w: Any) -> Any:
    return (stresses(strain_u, w["lam"], w["mu"]) * strain_v).sum(axis=0)


@BilinearForm  # type: ignore[untyped-decorator]  # scikit-fem has no types
def turned_section(u: Any, v: Any, w: Any) -> Any:
    """B0' C B0 of a twisted prism, its functions those of the section."""
    return _work(_in_section(u, w), _in_section(v, w), w)


@BilinearForm  # type: ignore[untyped-decorator]  # scikit-fem has no types
def turned_mixed(u: Any, v: Any, w: Any) -> Any:
    """B0' C B1: what changes along the face is the trial function."""
    return _work(_along_face(u, w), _in_section(v, w), w)


@BilinearForm  # type: ignore[untyped-decorator]  # scikit-fem has no types
def turned_along(u: Any, v: Any, w: Any) -> Any:
    """B1' C B1."""
    return _work(_along_face(u, w), _along_face(v, w), w)


def revolved_strains(value: Any, slope: Any, radius: Any, waves: int) -> Array:
    """Strains of a body of revolution in its n-th wave round the axis; its displacements are U, V and W.

    u_r = U cos(n theta), u_theta = V sin(n theta), u_z = W cos(n theta); with n = 0 the torsion V stands alone.
    Strains carry the cosine (the first four) or the sine (the last two).

    Parameters
    ----------
    value : array, shape (3, ...)
        U, V, W.
    slope : array, shape (3, 2, ...)
        Of each along r and z.
    radius : array
        r.
    waves : int
        n.

    Returns
    -------
    ndarray, shape (6, ...)
        e_rr, e_tt, e_zz, g_rz, g_rt, g_tz.
    """
    u, v, w = slope
    across, round_it, along = value[0] / radius, value[1] / radius, value[2] / radius
    shear = u[1] + w[0], v[0] - round_it - waves * across, v[1] - waves * along
    return np.stack(np.broadcast_arrays(u[0], across + waves * round_it, w[1], *shear))


def coefficients(form: BilinearForm, components: int, slopes: int, **constants: float) -> Array:
    """By what a form multiplies the values and slopes of the components of u and v.

    Parameters
    ----------
    form : BilinearForm
        With coefficients that are the same everywhere.
    components, slopes : int
        Of a displacement; of each component.
    **constants : float
        Parameters of the form.

    Returns
    -------
    ndarray, shape (components, 1 + slopes, components, 1 + slopes)
        Of component a and b of u and v and their values (0) or slopes (1, 2, ..), indexed [a, k, b, l].
    """
    shape = (components, 1 + slopes)
    unit = np.eye(components * (1 + slopes)).reshape(*shape, -1)
    u, v = (DiscreteField(part[:, 0], grad=part[:, 1:]) for part in (unit[..., None], unit[..., None, :]))
    return np.asarray(form.form(u, v, constants)).reshape(shape + shape)


def products(basis: Any, slots: tuple[int, ...]) -> Array:
    """Integrals of N_i,k N_j,l over every element.

    Parameters
    ----------
    basis : skfem.Basis
        Of scalar shape functions.
    slots : tuple of int
        Which k and l: 0 for a function itself, 1, 2, .. for its slopes.

    Returns
    -------
    ndarray, shape (slots, slots, M, n, n)
        Indexed [k, l, element, i, j].
    """
    count, n = len(slots), basis.Nbfun
    found = np.empty((count, count, basis.nelems, n, n))
    for row, k in enumerate(slots):
        for column, other in enumerate(slots[: row + 1]):
            form = _Dotted(lambda u, v, _, k=k, m=other: _slot(u, k) * _slot(v, m))
            # the first index of an element's matrix is the trial function's
            found[row, column] = form.elemental(basis).tolocal()
            found[column, row] = found[row, column].transpose(0, 2, 1)
    return found


def _slot(field: Any, k: int) -> Any:
    return field.grad[k - 1] if k else np.asarray(field)


def turn(basis: Any, place: Array, tau: float, slide: float = 0.0) -> None:
    """Give the functions of a section's basis as third slope their D where nothing changes along the face.

    Parameters
    ----------
    basis : skfem.Basis
    place : ndarray, shape (2, M, q)
        Of its quadrature points from the axis [modules].
    tau : float
        [rad/module].
    slide : float
        Way of the section along x per length along the axis, of a prism that is sheared, not twisted.
    """
    for (field,) in basis.basis:
        x, y = field.grad
        field.grad = np.stack([x, y, tau * (place[1] * x - place[0] * y) - slide * x])


def shear(basis: Any, place: Array, lean: Array) -> None:
    """Give the functions as fourth and fifth slope what their slopes in the section gain from changes along the face.

    Parameters
    ----------
    basis : skfem.Basis
    place : ndarray, shape (2, M, q)
        Of its quadrature points from the axis [modules].
    lean : ndarray, shape (M,)
        By how much an element's functions rise along the axis over the way toward it.
    """
    outward = lean[:, None] * place / np.hypot(*place)
    for (field,) in basis.basis:
        field.grad = np.concatenate([field.grad, outward * np.asarray(field)])


def element_matrices(weights: Array, integrals: Array) -> Array:
    """Matrices of elements, shape (M, c n, c n), whose unknown c i + a is component a of function i.

    Parameters
    ----------
    weights : ndarray, shape (c, K, c, L)
        Of `coefficients`.
    integrals : ndarray, shape (K, L, M, n, n)
        Of `products`.
    """
    c, (m, n) = weights.shape[0], integrals.shape[2:4]
    pairs = np.tensordot(weights.transpose(0, 2, 1, 3), integrals, 2)
    return np.asarray(pairs.transpose(2, 3, 0, 4, 1).reshape(m, c * n, c * n))
