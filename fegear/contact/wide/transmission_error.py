"""Transmission error and mesh stiffness of loaded flanks over a base pitch, with their Fourier series."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.contact.error_over_pitch import TransmissionErrorShift, no_less_than_beside
from fegear.contact.fourier import FourierSeries, Panels, effective_error, fourier_series, panels
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.load_sharing import secant_compliance
from fegear.contact.wide.loaded import LoadedFlanks
from fegear.contact.wide.mesh_matrix import stiffness_of
from fegear.contact.wide.over_pitch import every_second

#: Roll positions to a wave of the highest harmonic.
_TO_A_WAVE = 2
#: Outermost positions of a piece this near to its ends stand on them, as a share of a base pitch.
_ON_END = 1e-5
#: Harmonics in the effective error of TM-89901, where so many are known.
_IN_EFFECTIVE_ERROR = 12


@dataclass(frozen=True)
class FlankTransmissionError(ReadOnlyArrays):
    """Transmission error of a pair with a width under one load.

    Parameters
    ----------
    load : float
        Along the transverse line of action [N].
    points : Panels
        Roll positions over one base pitch and what each stands for [m].
    values : ndarray, shape (P,)
        Transmission error along the transverse line of action [m].
    local : ndarray, shape (P,)
        dW / dzeta, with the stations that touch [N/m].
    secant : ndarray, shape (P,)
        W / zeta of the stations that touch, without modifications and errors (Mark, A.11) [N/m].
    series : FourierSeries
        Of the transmission error, as far as the roll positions show it.
    peak_to_peak : float
        Largest less smallest value [m]; it may stand between the roll positions.
    """

    load: float
    points: Panels
    values: Array
    local: Array
    secant: Array
    series: FourierSeries
    peak_to_peak: float

    @property
    def mean(self) -> float:
        """[m]."""
        return float(self.values @ self.points.weights / self.points.period)

    @property
    def effective_error(self) -> float:
        """A_e of TM-89901 [m], of twelve harmonics or as many as are known."""
        known = self.series.amplitude.size
        return float(effective_error(self.series, min(known, _IN_EFFECTIVE_ERROR))) if known else 0.0

    @property
    def average_stiffness(self) -> float:
        """Mean over the base pitch of the local mesh stiffness [N/m]."""
        return float(self.local @ self.points.weights / self.points.period)

    @property
    def mean_secant(self) -> float:
        """Mean over the base pitch of the secant mesh stiffness [N/m]."""
        return float(self.secant @ self.points.weights / self.points.period)


def flank_transmission_errors(found: LoadedFlanks, points: Panels) -> tuple[FlankTransmissionError, ...]:
    """Transmission error under every load of loaded flanks.

    Parameters
    ----------
    found : LoadedFlanks
    points : Panels
        Of its roll positions: `FlankPair.points`.
    """
    secant = secant_stiffness(found.known, found.contact.force)
    return tuple(
        _error(float(load), points, found.transmission_error[:, i], found.contact.stiffness[:, i], secant[:, i])
        for i, load in enumerate(found.load)
    )


def _error(load: float, points: Panels, values: Array, local: Array, secant: Array) -> FlankTransmissionError:
    series = series_over_pitch(points, values)
    return FlankTransmissionError(load, points, values, local, secant, series, float(np.ptp(values)))


def series_over_pitch(points: Panels, values: Array) -> FourierSeries:
    """Fourier series of what is known at the roll positions, shape (P,), as far as they show it."""
    count = points.x.size // _TO_A_WAVE
    between = panels(float(points.breaks[0]), points.period, points.breaks[1:-1], waves=max(count, 1))
    return fourier_series(between, curve_through(points, values, between.x), count)


def secant_stiffness(known: FlankCompliance, force: Array) -> Array:
    """W / zeta of the stations that touch with the widths of their loads, without gaps, shape (P, L) [N/m].

    Parameters
    ----------
    known : FlankCompliance
    force : ndarray, shape (P, M, L)
        [N], zero where apart.
    """
    place = np.arange(force.shape[0])
    return np.stack([_secant(known, place, force[:, :, i]) for i in range(force.shape[2])], axis=1)


def _secant(known: FlankCompliance, place: Index, force: Array) -> Array:
    matrix, active = secant_compliance(known, place, force), force > 0.0
    on = active[:, :, None].astype(float)
    return np.asarray(stiffness_of(matrix, active, on)[:, :, 0].sum(axis=1))


def flank_transmission_error_shift(
    te: FlankTransmissionError,
    fine: FlankTransmissionError,
    longer: FlankTransmissionError,
    coarse: FlankTransmissionError,
    of_gears: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> TransmissionErrorShift:
    """Estimated errors: the changes by coarser solutions, independent of each other, and that by half of the positions.

    Parameters
    ----------
    te : FlankTransmissionError
        What is stated.
    fine, longer, coarse : FlankTransmissionError
        At the same roll positions, these or others: as solved, on longer panels, and of coarser gears on these.
    of_gears : (float, float, float)
        Of what coarser gears change, so much is error: of means, of the curve's shape, of its harmonics.
    """
    # read between the positions as `series_over_pitch` reads what is stated
    fewer = _error(te.load, te.points, *(of_half(te.points, one) for one in (te.values, te.local, te.secant)))
    of_mean, of_shape, of_harmonics = of_gears

    def changed(key: str, part: float) -> float:
        by_positions, by_panels, by_gears = (
            abs(float(getattr(one, key)) - float(getattr(two, key)))
            for one, two in ((te, fewer), (fine, longer), (longer, coarse))
        )
        return by_positions + math.hypot(by_panels, part * by_gears)

    known = te.series.amplitude.size
    by_panels, by_gears = _changed(fine, longer, known), _changed(longer, coarse, known)
    by_positions = no_less_than_shown_by_half(_changed(te, fewer, known))
    # each has a phase of its own: nothing of the three is known of the others
    amplitude = np.sqrt(by_positions**2 + by_panels**2 + (of_harmonics * by_gears) ** 2)
    return TransmissionErrorShift(
        changed("mean", of_mean), changed("peak_to_peak", of_shape), changed("effective_error", of_shape),
        no_less_than_beside(amplitude), changed("mean_secant", of_mean),
    )  # fmt: skip


def _changed(one: FlankTransmissionError, two: FlankTransmissionError, known: int) -> Array:
    """Amplitudes of one curve less another, shape (known,); their own change vanishes where a phase changes."""
    change = 2.0 * np.abs(one.series.coefficients - two.series.coefficients)[1:]
    return np.pad(change, (0, known))[:known]


def no_less_than_shown_by_half(change: Array) -> Array:
    """What half of the roll positions change of harmonics, shape (N,), as an error of all of them.

    Half of the positions show half of the harmonics. Of the others neither they nor all positions show much where the
    curve turns between positions: both are too small, and differ by less than the error. A curve without jumps turns at
    worst at a kink, whose harmonics n fall like 1/n^2: so the largest change in the upper half of those that half of
    the positions show is continued.
    """
    n, half = np.arange(1, change.size + 1), change.size // 2
    if not half:
        return change
    least = change[half // 2 : half].max() * (half / n) ** 2
    return np.where(n > half, np.maximum(change, least), change)


def curve_through(points: Panels, values: Array, x: Array) -> Array:
    """What a curve known at the roll positions is between them, shape (Q,).

    The polynomial through the positions on each piece of the base pitch where they reach its ends; straight from each
    to the next where they are too few for that.

    Parameters
    ----------
    points : Panels
    values : ndarray, shape (P,)
    x : ndarray, shape (Q,)
        Within the base pitch from the first break on [m].
    """
    own, wanted = np.searchsorted(points.breaks, points.x), np.searchsorted(points.breaks, x)
    found = np.interp(x, points.x, values, period=points.period)
    for piece in np.unique(own):
        if _reaches_ends(points, piece, own):
            found[wanted == piece] = _polynomial(points.x[own == piece], values[own == piece])(x[wanted == piece])
    return np.asarray(found)


def _reaches_ends(points: Panels, piece: int, own: Index) -> bool:
    """Whether the positions on a piece of the base pitch reach its ends; `own` is the piece of each, shape (P,)."""
    at = points.x[own == piece]
    ends = points.breaks[max(piece - 1, 0)], points.breaks[min(piece, points.breaks.size - 1)]
    return bool(max(at[0] - ends[0], ends[1] - at[-1]) < _ON_END * points.period)


def of_half(points: Panels, values: Array) -> Array:
    """What half of the roll positions say at all of them, read as by `curve_through`, shape (P,)."""
    own, kept = np.searchsorted(points.breaks, points.x), every_second(points)
    found = np.interp(points.x, points.x[kept], values[kept], period=points.period)
    smooth = from_half(points, values)
    for piece in np.unique(own):
        if _reaches_ends(points, piece, own):
            found[own == piece] = smooth[own == piece]
    return np.asarray(found)


def from_half(points: Panels, values: Array) -> Array:
    """What half of the roll positions on each piece of the base pitch say at all of them, shape (P,).

    Every second position of a piece and its last one, and the polynomial through them.
    """
    found, piece = values.copy(), np.searchsorted(points.breaks, points.x)
    for one in np.unique(piece):
        x, own = points.x[piece == one], values[piece == one]
        kept = (np.arange(x.size) % 2 == 0) | (np.arange(x.size) == x.size - 1)
        if not kept.all():
            found[piece == one] = _polynomial(x[kept], own[kept])(x)
    return found


def _polynomial(x: Array, values: Array) -> BarycentricInterpolator:
    """Through values at ascending places; weights are made here, for scipy makes them in another order each time."""
    apart = (x[:, None] - x) * (4.0 / (x[-1] - x[0]) if x.size > 1 else 1.0)
    np.fill_diagonal(apart, 1.0)
    return BarycentricInterpolator(x, values, wi=1.0 / apart.prod(axis=1))
