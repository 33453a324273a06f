"""Mark's series for the reciprocal mesh stiffness and the profile part of the transmission error (1.8 to 1.26).

With k = K_T / mean(K_T) the series (1.9) is, pointwise, s_M = [1 - (1 - k)^(M + 1)] / k: a geometric series that
converges where 0 < k < 2. The binomial form of the paper loses all digits beyond M = 40; nested, s <- 1 + (1 - k) s,
it is stable.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import FourierSeries, Panels, fourier_series
from fegear.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array


@dataclass(frozen=True, slots=True)
class MarkSeries:
    """Result of the series after M terms.

    Parameters
    ----------
    series : FourierSeries
        alpha_(1/K)n [m/N].
    smallest, largest : float
        Of k = K_T / mean(K_T) over the base pitch.
    terms : int
        M.
    bound : float
        Largest |1 - k|^(M + 1): relative error of the truncated series where it is worst.
    """

    series: FourierSeries
    smallest: float
    largest: float
    terms: int
    bound: float

    @property
    def converges(self) -> bool:
        """0 < k < 2 everywhere."""
        return self.smallest > 0.0 and self.largest < 2.0


def reciprocal_series(points: Panels, stiffness: ArrayLike, harmonics: int, terms: int) -> MarkSeries:
    """Fourier coefficients of 1/K_T by Mark's series, the products taken pointwise (exact convolutions).

    Parameters
    ----------
    points : Panels
    stiffness : array_like, shape (Q,)
        K_T at the quadrature points [N/m], positive.
    harmonics, terms : int
        N and M.

    Raises
    ------
    InputError
        If the stiffness is not positive everywhere.
    """
    stiff = np.asarray(stiffness, dtype=float)
    if not (stiff > 0.0).all():
        raise InputError("mesh stiffness", float(stiff.min()), "must be positive all over the base pitch")
    mean = float(stiff @ points.weights / points.period)
    k = stiff / mean
    s = np.ones_like(k)
    for _ in range(terms):
        s = 1.0 + (1.0 - k) * s
    bound = float(np.abs(1.0 - k).max() ** (terms + 1))
    return MarkSeries(fourier_series(points, s / mean, harmonics), float(k.min()), float(k.max()), terms, bound)


def reciprocal_by_convolution(stiffness: FourierSeries, terms: int) -> FourierSeries:
    """As the paper computes it: discrete convolutions of the coefficients cut off at the harmonics given (1.9 to 1.13).

    What the cut costs is seen by comparison with `reciprocal_series`.
    """
    alpha = stiffness.two_sided
    mean = float(stiffness.mean)
    n = (alpha.size - 1) // 2
    delta = np.zeros_like(alpha)
    delta[n] = 1.0
    step = delta - alpha / mean
    s = delta.copy()
    for _ in range(terms):
        s = delta + np.convolve(step, s)[n : 3 * n + 1]
    return FourierSeries(s[n:] / mean, stiffness.period)


def profile_part(reciprocal: FourierSeries, weighted_modification: FourierSeries) -> FourierSeries:
    """alpha_m = alpha_(1/K) * alpha'_m, a convolution cut off at the harmonics given (1.22).

    Parameters
    ----------
    reciprocal : FourierSeries
        Of 1/K_T [m/N].
    weighted_modification : FourierSeries
        Of sum_j K_Sj m_j [N]: stiffness times removal, summed over the pairs in contact (1.23, 1.26).
    """
    a, b = reciprocal.two_sided, weighted_modification.two_sided
    n = (a.size - 1) // 2
    return FourierSeries(np.convolve(a, b)[n : 3 * n + 1][n:], reciprocal.period)


def linear_transmission_error(pair_stiffness: ArrayLike, load: float, modification: ArrayLike | None = None) -> Array:
    """Transmission error with every pair of the path in contact, zeta = (W + sum K_Sj m_j) / sum K_Sj [m] (1.3, A.7).

    Parameters
    ----------
    pair_stiffness : array_like, shape (n, Q)
        K_Sj [N/m]; zero where a pair is out of reach.
    load : float
        W [N].
    modification : array_like, shape (n, Q), optional
        m_j, both gears added, removal positive [m].
    """
    k = np.asarray(pair_stiffness, dtype=float)
    force = load + (0.0 if modification is None else (k * np.asarray(modification, dtype=float)).sum(axis=0))
    return np.asarray(force / k.sum(axis=0))
