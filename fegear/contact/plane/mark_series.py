"""Mark's static transmission error: a series for the reciprocal mesh stiffness, and modifications weighted by it.

With k = K_T / mean(K_T) the series (1.9) is, pointwise, s_M = [1 - (1 - k)^(M + 1)] / k: a geometric series that
converges where 0 < k < 2. The binomial form of the report loses all digits beyond M = 40; nested, s <- 1 + (1 - k) s,
it is stable. Its products are convolutions of Fourier coefficients (1.11): exact where they are taken point by point,
cut off where only so many harmonics are kept, as in the report's program.

Mark's closed forms for what tooth spacing errors add to the transmission error (1.27 to 1.32).

(1.29) is printed without its sum. It is read as j_0(pi g L/A) less its own values at the harmonics n' of the mesh,
spread by the window w_00: then evenly displaced teeth (g = 0) count in full and errors that are alike in every base
pitch (g = n') add nothing, as exact load sharing has it.

It holds for contact ratios from 1.2 to 1.8: within 0.09 of the errors' own spectrum below the first mesh harmonic, by
load sharing with tooth compliances after Cornell. Above two it is no better than j_0(pi g L/A) alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown, shows
from fegear.contact.fourier import FourierSeries, Panels, fourier_series
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.transmission_error import pair_stiffness

#: Numbers of terms at which convergence is looked at, beside the one asked for.
_TERMS = (0, 1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 30, 40)


@dataclass(frozen=True, slots=True)
class Reciprocal:
    """Coefficients of 1/K_T by the series, for rising numbers of terms.

    Parameters
    ----------
    exact : FourierSeries
        alpha_(1/K)n by quadrature [m/N].
    pointwise, convolved : tuple of FourierSeries
        After each number of terms: products taken point by point; and cut off at the harmonics of `exact`.
    terms : ndarray of int, shape (M,)
    smallest, largest : float
        Of k = K_T / mean(K_T) over the base pitch.
    """

    exact: FourierSeries
    pointwise: tuple[FourierSeries, ...]
    convolved: tuple[FourierSeries, ...]
    terms: NDArray[np.int64] = shown("", "terms of the series", name="M")
    smallest: float = shown("", "of mesh stiffness over its mean")
    largest: float = shown("", "of mesh stiffness over its mean")

    @property
    def converges(self) -> bool:
        """0 < k < 2 everywhere."""
        return self.smallest > 0.0 and self.largest < 2.0

    @property
    @shows("", "largest |1 - K/mean K|^(M + 1)")
    def bound(self) -> Array:
        """Largest |1 - k|^(M + 1), shape (M,): relative error of the series where it is worst."""
        widest = max(abs(1.0 - self.smallest), abs(self.largest - 1.0))
        return np.asarray(widest ** (self.terms + 1.0))

    @property
    @shows("", "largest of 1/K's coefficients over mean", name="error", label="largest error over the mean")
    def pointwise_error(self) -> Array:
        """With exact products, after each number of terms, shape (M,)."""
        return self._error(self.pointwise)

    @property
    @shows("", "with products cut off", name="error_convolved")
    def convolved_error(self) -> Array:
        """With products cut off, after each number of terms, shape (M,)."""
        return self._error(self.convolved)

    def _error(self, series: tuple[FourierSeries, ...]) -> Array:
        """Largest error of any coefficient over the mean compliance, after each number of terms, shape (M,)."""
        exact = self.exact.coefficients
        return np.array([np.abs(one.coefficients - exact).max() for one in series]) / abs(exact[0])


def reciprocal_series(points: Panels, stiffness: ArrayLike, harmonics: int, terms: ArrayLike) -> Reciprocal:
    """Fourier coefficients of 1/K_T by Mark's series (1.9 to 1.13).

    Parameters
    ----------
    points : Panels
    stiffness : array_like, shape (Q,)
        K_T at the quadrature points [N/m], positive.
    harmonics : int
        N.
    terms : array_like of int
        Numbers of terms M.

    Raises
    ------
    InputError
        If the stiffness is not positive everywhere.
    """
    stiff, wanted = np.asarray(stiffness, dtype=float), np.unique(np.asarray(terms, dtype=int))
    if not (stiff > 0.0).all():
        raise InputError("mesh stiffness", float(stiff.min()), "must be positive over the entire base pitch")
    mean = float(stiff @ points.weights / points.period)
    k = stiff / mean
    none = np.zeros(2 * harmonics + 1, dtype=complex)
    none[harmonics] = 1.0
    rest = none - _both_sides(fourier_series(points, k, harmonics))
    s, c = np.ones_like(k), none
    pointwise: list[FourierSeries] = []
    convolved: list[FourierSeries] = []
    for m in range(int(wanted[-1]) + 1):
        if m:
            s = 1.0 + (1.0 - k) * s
            c = none + np.convolve(rest, c)[harmonics : 3 * harmonics + 1]
        if m in wanted:
            pointwise.append(fourier_series(points, s / mean, harmonics))
            convolved.append(FourierSeries(np.asarray(c[harmonics:] / mean, dtype=complex), points.period))
    exact = fourier_series(points, 1.0 / stiff, harmonics)
    return Reciprocal(exact, tuple(pointwise), tuple(convolved), wanted, float(k.min()), float(k.max()))


def _partial_sum(k: Array, terms: int) -> Array:
    """[1 - (1 - k)^(M + 1)] / k without its cancellation where k is small."""
    s = np.ones_like(k)
    for _ in range(terms):
        s = 1.0 + (1.0 - k) * s
    return s


def _both_sides(series: FourierSeries) -> NDArray[np.complex128]:
    """c_-N to c_N."""
    c = series.coefficients
    return np.concatenate([c[:0:-1].conj(), c])


@dataclass(frozen=True, slots=True)
class StaticErrorSeries:
    """Static transmission error of evenly spaced teeth by Mark's formulas, as Fourier series [m].

    Parameters
    ----------
    reciprocal : Reciprocal
    terms : int
        M of `pointwise` and `convolved`.
    linear : FourierSeries
        (1.5) with every pair of the path in contact, by quadrature: what the series converges to.
    pointwise, convolved : FourierSeries
        (1.5) from the series, with exact products and with products cut off at N harmonics.
    """

    reciprocal: Reciprocal
    terms: int
    linear: FourierSeries
    pointwise: FourierSeries
    convolved: FourierSeries


def static_error_series(engagement: Engagement, load: float, harmonics: int, terms: int) -> StaticErrorSeries:
    """Static transmission error from the stiffness of the tooth pairs and their mean modifications (1.5 to 1.26).

    alpha_n = W alpha_(1/K)n (1.8) plus, for both gears, alpha_(1/K) convolved with the transform of the
    stiffness-weighted modification K_S m (1.22 to 1.26). Every pair on the path counts as in contact.

    Parameters
    ----------
    engagement : Engagement
        Its spacing errors do not count.
    load : float
        W [N].
    harmonics, terms : int
        N and M.
    """
    none = np.empty(0)
    even = replace(engagement, driver_spacing=none, driven_spacing=none)
    stiffness = pair_stiffness(even, load, harmonics)
    points = stiffness.points
    reciprocal = reciprocal_series(points, stiffness.mesh, harmonics, [*_TERMS, terms])
    weighted = (stiffness.pair * even.modification(even.grid(points.x).contacts)).sum(axis=0)
    mean = float(stiffness.mesh @ points.weights / points.period)
    partial = _partial_sum(stiffness.mesh / mean, terms) / mean
    at = int(np.flatnonzero(reciprocal.terms == terms)[0])
    modified = fourier_series(points, weighted, harmonics)
    product = np.convolve(_both_sides(reciprocal.convolved[at]), _both_sides(modified))
    cut = load * reciprocal.convolved[at].coefficients + product[2 * harmonics : 3 * harmonics + 1]
    return StaticErrorSeries(
        reciprocal, terms,
        fourier_series(points, (load + weighted) / stiffness.mesh, harmonics),
        fourier_series(points, (load + weighted) * partial, harmonics),
        FourierSeries(np.asarray(cut, dtype=complex), points.period),
    )  # fmt: skip


#: Contact ratios for which the closed form is compared with load sharing.
SPACING_RANGE = (1.2, 1.8)


def spacing_transfer(order: ArrayLike, contact_ratio: float) -> Array:
    """How much of a spacing error of so many waves per base pitch reaches the transmission error (1.29 to 1.31).

    Parameters
    ----------
    order : array_like
        g = n / N, frequency over the tooth-mesh frequency.
    contact_ratio : float
        L / A (1.32); the form holds from 1.2 to 1.8.
    """
    g = np.abs(np.asarray(order, dtype=float))
    below = np.floor(g)
    found = np.sinc(g * contact_ratio)
    for n in (below, below + 1.0):
        window = 0.5 * (1.0 + np.cos(np.pi * (g - n)))
        found = found - np.where(n > 0.0, window * np.sinc(n * contact_ratio), 0.0)
    return np.asarray(found)


def spacing_series(engagement: Engagement, harmonics: int) -> FourierSeries:
    """What the spacing errors of both gears add to the transmission error [m], over all base pitches (1.27, 1.28).

    Parameters
    ----------
    engagement : Engagement
        With spacing errors.
    harmonics : int
        Highest one over the period of `engagement.cycles` base pitches.
    """
    pair, cycles = engagement.pair, engagement.cycles
    n = np.arange(harmonics + 1)
    total = np.zeros(harmonics + 1, dtype=complex)
    for errors in (engagement.driver_spacing, engagement.driven_spacing):
        if errors.size:
            every = cycles // errors.size
            spectrum = np.fft.fft(errors) / errors.size
            total += np.where(n % every == 0, spectrum[(n // every) % errors.size], 0.0)
    order = n / cycles
    middle = 0.5 * (pair.x_start + pair.x_end) / pair.base_pitch
    transfer = spacing_transfer(order, pair.contact_ratio) * np.exp(-2j * np.pi * order * middle)
    return FourierSeries(total * transfer, cycles * pair.base_pitch)
