"""Lines of a mesh by Mark's own series: the transmission error of a train's springs from M terms of (1.9).

The mesh is taken as in (1.5) to (1.26): every tooth pair on the path carries, the reciprocal of the mesh stiffness is
the series with M terms, and every product is a convolution of N harmonics. What that misses beside the exact error
depends on M and N; of teeth whose error is nearly nothing it is most of what is left.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import fourier_series, panels
from fegear.contact.plane.mark_series import reciprocal_series

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Complex
    from fegear.dynamics.train.excitation import MeshExcitation


@dataclass(frozen=True)
class SeriesError:
    """A static transmission error by its Fourier coefficients over the base pitch.

    Parameters
    ----------
    coefficients : ndarray of complex, shape (N + 1,)
        From order 0 on [m].
    """

    coefficients: Complex
    pitches: int = 1

    def fourier(self, n: ArrayLike) -> Complex:
        """Coefficients of whole orders up to N."""
        return np.asarray(self.coefficients[np.asarray(n, dtype=int)])


def has_series(excitation: MeshExcitation) -> bool:
    """Whether the series applies: it knows neither coupled teeth nor spacing errors."""
    parts = (*excitation.stiffness, *excitation.separation)
    return excitation.slotted and all(part.pitches == 1 for part in parts)


def series_error(excitation: MeshExcitation, load: float, harmonics: int, terms: int) -> SeriesError:
    """Static transmission error of one mesh by M terms of Mark's series, with products of N harmonics.

    Parameters
    ----------
    excitation : MeshExcitation
        Tooth pairs that stand alone, evenly spaced (`has_series`).
    load : float
        Mean mesh force [N].
    harmonics, terms : int
        N and M.
    """
    parts = (*excitation.stiffness, *excitation.separation)
    points = panels(0.0, 1.0, np.concatenate([part.breaks for part in parts]), waves=harmonics)
    pairs = np.array([spring(points.x) for spring in excitation.stiffness])
    apart = np.array([removal(points.x) for removal in excitation.separation])
    reciprocal = reciprocal_series(points, pairs.sum(axis=0), harmonics, [terms]).convolved[0].coefficients
    weighted = fourier_series(points, (pairs * apart).sum(axis=0), harmonics).coefficients
    one, other = (np.concatenate([half[:0:-1].conj(), half]) for half in (reciprocal, weighted))
    product = np.convolve(one, other)[2 * harmonics : 3 * harmonics + 1]
    return SeriesError(np.asarray(load * reciprocal + product))
