"""Tooth-spacing errors and the rotational harmonics of the transmission error that they cause (Mark 1.27 to 1.32)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.arrays import Array
    from fegear.contact.transmission_error import PairStiffness


def spacing_spectrum(errors: ArrayLike) -> NDArray[np.complex128]:
    """B(n) = (1/N) sum_j E_j exp(-2 pi i n j / N), n = 0..N-1 (1.27).

    Parameters
    ----------
    errors : array_like, shape (N,)
        E_j, accumulated spacing error of tooth j in the order of meshing, removal positive [m].

    Raises
    ------
    InputError
        If there are none or one is not finite.
    """
    e = np.asarray(errors, dtype=float)
    if e.ndim != 1 or e.size == 0 or not np.isfinite(e).all():
        raise InputError("spacing_errors", errors, "must be one finite length for each tooth")
    return np.asarray(np.fft.fft(e) / e.size)


def mesh_transfer(order: ArrayLike, contact_ratio: float, truncated: bool = True) -> Array:
    """Mesh transfer function for tooth-spacing errors at g = n / N cycles per base pitch (1.29 to 1.31).

    Parameters
    ----------
    order : array_like
        g, rotational harmonic n divided by the number of teeth N.
    contact_ratio : float
        L / A.
    truncated : bool
        Whether to add the correction w_00 of the truncated series for 1/K.

    Returns
    -------
    ndarray
        Share of the spacing error's harmonic that reaches the transmission error, 1 at g = 0.

    Notes
    -----
    The sinc is the transform of a load shared evenly among the pairs over the path L. `transfer_of_stiffness` has the
    same for the real stiffness and the exact reciprocal.
    """
    g = np.asarray(order, dtype=float)
    base = np.sinc(g * contact_ratio)
    if not truncated:
        return np.asarray(base)
    # Even sharing: K_T / mean(K_T) = 1 + sum_n' sinc(n' L/A) cos(...); to first order its reciprocal mixes harmonic
    # g - n' into g. The raised cosine joins the neighbouring n' smoothly over one order on either side (1.30, 1.31).
    correction = np.zeros_like(base)
    nearest = np.round(g)
    for shift in (-1.0, 0.0, 1.0):
        n = nearest + shift
        window = np.where(np.abs(g - n) < 1.0, 0.5 * (1.0 + np.cos(math.pi * (g - n))), 0.0)
        correction += np.where(n == 0.0, 0.0, window * np.sinc(n * contact_ratio) * np.sinc((g - n) * contact_ratio))
    return np.asarray(base - correction)


def transfer_of_stiffness(stiffness: PairStiffness, order: ArrayLike) -> NDArray[np.complex128]:
    """Exact mesh transfer function for tooth-spacing errors, from the pair stiffness itself.

    With all pairs of the path in contact zeta = (W + sum_j K_Sj e_j) / K_T, so a pair's error enters with the weight
    K_Sj / K_T as it travels along the path: S(g) = (1/A) integral of K_S / K_T exp(-2 pi i g x / A) dx over the path.
    The coefficient of rotational harmonic n of a gear with N teeth is B(n) S(n / N) (1.28).

    Parameters
    ----------
    stiffness : PairStiffness
    order : array_like
        g = n / N, cycles per base pitch.

    Returns
    -------
    ndarray
        Complex, since x counts from the pitch point and tooth 0 is that of pair 0 in cycle 0.
    """
    g = np.asarray(order, dtype=float)
    weight = stiffness.pair / stiffness.mesh * stiffness.points.weights / stiffness.points.period
    phase = np.exp(-2j * math.pi * np.multiply.outer(g, stiffness.x) / stiffness.points.period)
    return np.asarray((phase * weight).sum(axis=(-2, -1)))
