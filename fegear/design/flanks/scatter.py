"""Misalignment that scatters: levels of the gap over the face with weights, and the gap that each of them opens."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.wide.lines import ContactLines


@dataclass(frozen=True)
class Scatter(ReadOnlyArrays):
    """Deviations of the gap over the face from the nominal one, and how often they occur.

    Parameters
    ----------
    over_face : ndarray, shape (S,)
        Gap at the end of the face at +b/2 less that at -b/2 [m].
    weights : ndarray, shape (S,)
        Sum one.
    """

    over_face: Array
    weights: Array

    def gaps(self, lines: ContactLines) -> Array:
        """Gap of each level at the stations, nothing in the middle of the face, shape (S, P, M) [m]."""
        share = (lines.z - 0.5 * (lines.low + lines.high)) / (lines.high - lines.low)
        return np.asarray(np.multiply.outer(self.over_face, np.where(lines.present, share, 0.0)))


#: No deviation.
NOMINAL = Scatter(np.zeros(1), np.ones(1))


def normal_scatter(deviation: float, levels: int) -> Scatter:
    """Levels of a normal distribution by Gauss and Hermite: means of polynomials up to degree 2 levels - 1 are exact.

    Parameters
    ----------
    deviation : float
        Standard deviation of the gap over the face [m]; zero is `NOMINAL`.
    levels : int
    """
    if deviation == 0.0 or levels == 1:
        return NOMINAL
    places, weights = np.polynomial.hermite_e.hermegauss(levels)
    return Scatter(deviation * places, weights / weights.sum())
