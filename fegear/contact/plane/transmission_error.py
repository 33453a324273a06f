"""Loaded static transmission error over a base pitch, with its Fourier series to quadrature accuracy."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.shown import shows
from fegear.contact.fourier import SIDE, FourierSeries, Panels, effective_error, fourier_series, panels
from fegear.contact.sign_changes import sign_changes
from fegear.fem.alike_teeth import together

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement, Loaded
    from fegear.contact.plane.roll_grids import RollGrid


#: Divisions of a cell in which contact changes.
_PASSES = 4
#: Share of the load below which a pair carries nothing: what is left of one that touches without load.
_NO_SHARE = 1e-9
#: Harmonics that the points are laid for while a value is being moved: some three points to a wave of the 64th.
_QUICK_WAVES = 24


@dataclass(frozen=True)
class TransmissionError:
    """Transmission error of one gear pair under one load, as a Fourier series over the base pitch.

    Parameters
    ----------
    load : float
        [N].
    points : Panels
        Quadrature points between all jumps and kinks.
    loaded : Loaded
        Load sharing at these points.
    series : FourierSeries
        [m].
    """

    load: float
    points: Panels
    loaded: Loaded
    series: FourierSeries

    @property
    def values(self) -> Array:
        """Transmission error at the quadrature points, shape (Q,) [m]."""
        return np.asarray(self.loaded.transmission_error[:, 0])

    @property
    @shows("um", "mean transmission error over the base pitch", name="te_mean")
    def mean(self) -> float:
        """[m]."""
        return float(self.series.mean)

    @property
    @shows("um", "peak-to-peak value", name="te_peak_to_peak")
    def peak_to_peak(self) -> float:
        """Largest less smallest value [m], on either side of every jump and kink and between the points, too."""
        return self.points.highest(self.values) + self.points.highest(-self.values)

    @property
    @shows("um", "effective transmission error A_e (amplitude, NASA TM-89901)", name="te_effective")
    def effective_error(self) -> float:
        """A_e of TM-89901 [m]."""
        return float(effective_error(self.series))

    @property
    def average_stiffness(self) -> float:
        """Mean over the base pitch of the local mesh stiffness dW/dzeta [N/m]."""
        return float(self.loaded.local_stiffness[:, 0] @ self.points.weights / self.points.period)


def contact_changes(engagement: Engagement, load: float, cycle: int = 0, samples: int = 48) -> Array:
    """Roll positions [m] at which a pair comes into or out of contact between the geometric break points.

    Found as events, all of those between two sample points, to 3e-8 of the base pitch: a misplaced kink costs the
    quadrature its square, extremes that stand on it their slope.
    """
    pitch, start = engagement.pair.base_pitch, engagement.pair.x_start
    edges = np.concatenate([[start], [b for b in engagement.breaks if start < b < start + pitch], [start + pitch]])
    aside = SIDE * pitch
    xs, piece = [], []
    for i, (a, b) in enumerate(pairwise(edges)):
        if b - a > 4.0 * aside:
            n = max(4, round(samples * (b - a) / pitch))
            middle = a + aside + (b - a - 2.0 * aside) * (np.arange(n) + 0.5) / n
            xs.append(np.concatenate([[a + aside], middle, [b - aside]]))
            piece.append(np.full(n + 2, i))
    x = np.concatenate(xs)

    def nearness(at: Array) -> Array:
        return _nearness(engagement, engagement.grid(at, again=at is x), load, cycle)

    return sign_changes(nearness, x, np.concatenate(piece), _PASSES)


def _nearness(engagement: Engagement, grid: RollGrid, load: float, cycle: int) -> Array:
    """How firmly each pair is in contact, shape (n, P): its share of the load, or minus its gap over the deflection.

    Minus infinity where it is out of reach. Shares that are round-off are none: flanks that were designed to touch
    without load would part and meet between any two points.
    """
    found = engagement.solve(grid, [load], cycle)
    loads, error = found.loads[:, :, 0], found.transmission_error[:, 0]
    at = found.grid  # with the teeth of this base pitch
    own = np.einsum("jkp,kp->jp", at.matrices.at_load(found.loads)[..., 0], loads)
    gap = np.where(at.contacts.present, own + found.separation - error, np.inf)
    deflection = np.where(loads > 0.0, own, 0.0).max(axis=0)
    return np.where(loads > 0.0, loads / load - _NO_SHARE, -np.maximum(gap, 0.0) / deflection)


def transmission_error(
    engagement: Engagement, load: float, harmonics: int = 64, *, order: int = 16, cycle: int = 0
) -> TransmissionError:
    """Transmission error under one load by piecewise Gauss quadrature.

    Parameters
    ----------
    engagement : Engagement
    load : float
        [N].
    harmonics : int
        N of the series.
    order : int
        Gauss points per subdivision: the setting that trades accuracy for time.
    cycle : int
        Which base pitch, when there are spacing errors.
    """
    pair = engagement.pair
    breaks = [*engagement.breaks, *contact_changes(engagement, load, cycle)]
    points = panels(pair.x_start, pair.base_pitch, breaks, waves=harmonics, order=order, ends=True)
    loaded = engagement.solve(engagement.grid(points.x), [load], cycle)
    return TransmissionError(load, points, loaded, fourier_series(points, loaded.transmission_error[:, 0], harmonics))


def quick_points(engagement: Engagement) -> Panels:
    """Points over the base pitch while a value is being moved: curves, loads and root stress are read there, too."""
    pair = engagement.pair
    return replace(panels(pair.x_start, pair.base_pitch, engagement.breaks, waves=_QUICK_WAVES, ends=True), kinks=True)


def thinned(points: Panels) -> NDArray[np.intp]:
    """Every other point, and those beside break points: root stress is much work at each."""
    beside = points.weights == 0.0
    return np.flatnonzero(beside | (np.cumsum(~beside) % 2 == 1))


def quick_transmission_errors(
    engagement: Engagement, loads: tuple[float, ...], harmonics: int = 64
) -> list[TransmissionError]:
    """Transmission error under every load without looking for changes of contact, while a value is being moved.

    The points are the same ones under every load and amount of relief, so that all are solved at once; a kink within a
    subdivision costs a few 1e-3 of the range of the values.

    Parameters
    ----------
    engagement : Engagement
    loads : tuple of float
        [N].
    harmonics : int
        N of the series.
    """
    points = quick_points(engagement)
    every = engagement.solve(engagement.grid(points.x), loads)
    series = fourier_series(points, every.transmission_error, harmonics)
    return [
        TransmissionError(
            load, points, every.under(number), FourierSeries(series.coefficients[:, number], series.period)
        )
        for number, load in enumerate(loads)
    ]


@dataclass(frozen=True)
class PairStiffness:
    """Mark's effective stiffness of the tooth pairs (App. A, A.8, A.11).

    Parameters
    ----------
    points : Panels
    pair : ndarray, shape (n, Q)
        K_Sj of each pair [N/m]; zero where it is off the path.
    x : ndarray, shape (n, Q)
        Positions of the pairs [m].
    """

    points: Panels
    pair: Array
    x: Array

    @property
    def mesh(self) -> Array:
        """K_T = sum of K_Sj, shape (Q,) [N/m]."""
        return np.asarray(self.pair.sum(axis=0))

    @property
    def mean_compliance(self) -> float:
        """Mean of 1/K_T over the base pitch [m/N]."""
        return float((1.0 / self.mesh) @ self.points.weights / self.points.period)


def pair_stiffness(
    engagement: Engagement, load: float, harmonics: int = 64, points: Panels | None = None
) -> PairStiffness:
    """Effective tooth-pair stiffness K_Sj = sum_j' k_jj', k the inverse of c_jj'.

    By Maxwell's theorem it is the load on pair j, per unit approach, of a pair without modifications or errors (A.11);
    with a load-dependent contact it is the secant stiffness under `load` [N]. `points` are those of the quadrature
    where they have been laid already.

    Raises
    ------
    InputError
        If the contact ratio is below 1: perfect flanks then have positions without any pair on the path, whether tip
        corners touch beyond it or not.
    """
    pair = engagement.pair
    if pair.contact_ratio < 1.0:
        raise InputError(
            "pair", f"contact ratio {pair.contact_ratio:.4f}", "is below 1: Mark's K_T is zero where no tooth pair "
                                                               "is on the path of contact",
            'set transmission_error.method = "quadrature" (includes corner contact)',
        )  # fmt: skip
    points = points or panels(pair.x_start, pair.base_pitch, engagement.breaks, waves=harmonics)
    grid = engagement.grid(points.x)
    e = np.where(grid.contacts.gap == 0.0, 0.0, np.inf)
    shared = engagement.grids.share(grid, e, np.array([load]))
    return PairStiffness(points, shared.loads[:, :, 0] / shared.transmission_error[:, 0], grid.contacts.x)


def _by_teeth(engagement: Engagement, grid: RollGrid, cycles: int) -> list[NDArray[np.int64]]:
    """Numbers of the base pitches, those in which like teeth meet together: all where all teeth are alike."""
    if engagement.compliance.cycles == 1:
        return [np.arange(cycles)]
    return together(engagement.compliance.pattern(grid.contacts.number, cycle) for cycle in range(cycles))


def revolution(engagement: Engagement, load: float, cycles: int, harmonics: int, order: int = 8) -> FourierSeries:
    """Transmission error over many base pitches with spacing errors: its rotational harmonics.

    Parameters
    ----------
    engagement : Engagement
        With spacing errors.
    load : float
        [N].
    cycles : int
        Number of base pitches: the teeth of the gear with errors, or the least common multiple of both.
    harmonics : int
        Highest rotational harmonic; order `cycles` is the tooth-mesh frequency.
    order : int
        Gauss points per subdivision. Contact changes of single pitches are not resolved as break points.

    Returns
    -------
    FourierSeries
        Over the period of `cycles` base pitches.
    """
    if cycles < 1:
        raise InputError("cycles", cycles, "must be at least 1")
    pair = engagement.pair
    per_pitch = max(12, -(-harmonics // cycles))
    points = panels(pair.x_start, pair.base_pitch, engagement.breaks, waves=per_pitch, order=order)
    grid = engagement.grid(points.x)
    e = engagement.separation(grid.contacts)
    finite = np.where(grid.contacts.present, e - engagement.spacing(grid.contacts, 0), np.inf)
    errors = np.concatenate([engagement.spacing(grid.contacts, k) for k in range(cycles)], axis=1)
    error = np.empty((points.x.size, cycles))
    for pitches in _by_teeth(engagement, grid, cycles):
        at = engagement.grids.turned(grid, int(pitches[0]))
        e_j = finite[:, :, None] + errors[:, None, pitches]
        error[:, pitches] = at.matrices.share(e_j, np.full(pitches.size, load)).transmission_error
    # The points of every base pitch lie alike, so that the sum over the base pitches is a fast Fourier transform: a
    # kernel of all points times all harmonics would take gigabytes for hunting tooth numbers.
    over_pitches = np.fft.fft(error, axis=1)
    n, period = np.arange(harmonics + 1), cycles * pair.base_pitch
    within = np.exp(-2j * math.pi / period * np.multiply.outer(n, points.x)) * points.weights / period
    return FourierSeries((within * over_pitches[:, n % cycles].T).sum(axis=1), period)
