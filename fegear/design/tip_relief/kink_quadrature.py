"""Harmonics of a curve with kinks by quadrature that knows nothing of them: what that is off, in closed form.

Quadrature of a function whose slope jumps between its points is off by the jump times what it is off for one ramp that
starts there: of a ramp both the sum over the points and the integral are known. That is a smooth function of the place
but where it passes a point, and there it mends the corner that the sum has: harmonics become smooth functions of what
moves the kink, to the next order of the distance between points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Floats
    from fegear.contact.fourier import Panels


@dataclass(frozen=True)
class KinkQuadrature:
    """Quadrature of cosine and sine parts of N harmonics.

    Parameters
    ----------
    points : Panels
        Points in ascending order over one period.
    kernel : ndarray, shape (P, 2 N)
        Weights that make the parts of values at the points: first those of cosines, then of sines.
    """

    points: Panels
    kernel: Floats

    @cached_property
    def _behind(self) -> tuple[Floats, Floats]:
        """Sums of weights, and of weights times place, over the points from each on, shape (P + 1, 2 N)."""
        end = np.zeros((1, self.kernel.shape[1]))
        from_end = self.points.x[:, None] - self.points.breaks[-1]
        sums = [np.cumsum(part[::-1], axis=0)[::-1] for part in (self.kernel, self.kernel * from_end)]
        return np.concatenate([sums[0], end]), np.concatenate([sums[1], end])

    def errors(self, x: Floats) -> tuple[Floats, Floats]:
        """What the parts of a ramp of slope one, from each place to the end of the period, are too large.

        Parameters
        ----------
        x : ndarray, shape (K,)
            Places of kinks within the period [m].

        Returns
        -------
        error, slope : ndarray, shape (K, 2 N)
            [m], and its derivative by the place.
        """
        period, end = self.points.period, self.points.breaks[-1]
        wave = 2.0 * math.pi / period * np.arange(1, self.kernel.shape[1] // 2 + 1)
        ramp = (end - x)[:, None]
        first, last = np.multiply.outer(x, wave), end * wave
        after = np.searchsorted(self.points.x, x)
        sums, moments = (part[after] for part in self._behind)
        # Integrals over the ramp of (x' - x) and of one, times cosine and sine of the waves.
        cosine = ramp * np.sin(last) / wave + (np.cos(last) - np.cos(first)) / wave**2
        sine = -ramp * np.cos(last) / wave + (np.sin(last) - np.sin(first)) / wave**2
        level = [(np.sin(last) - np.sin(first)) / wave, (np.cos(first) - np.cos(last)) / wave]
        exact, its_slope = (2.0 / period * np.concatenate(parts, axis=1) for parts in ([cosine, sine], level))
        return moments + sums * ramp - exact, its_slope - sums
