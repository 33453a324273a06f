"""Mark's series for the reciprocal mesh stiffness (1.8 to 1.13).

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
