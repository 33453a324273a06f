"""A finite-element source shifted by its own estimated error: what is left of the digits further down the chain.

Estimated errors of what follows from load sharing: solved again with each compliance off by its own error.

`shifted` holds engagements whose compliances are off, one source each (`fegear.contact.plane.shifted_compliance`); the
changes that they make add up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.fourier import EFFECTIVE_HARMONICS, FourierSeries, effective_error, fourier_series
from fegear.contact.loaded_teeth import TransmissionErrorShift
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.load_sharing import share_load
from fegear.contact.plane.roll_grids import RollGrid
from fegear.contact.plane.transmission_error import TransmissionError, mean_secant_stiffness

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import Side
    from fegear.contact.plane.fe_compliance import FiniteElementCompliance
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.fem.plane.root_stress import FilletCurve


_POINTS = 25
#: What the pressure's middle, which `edge_law` takes no notice of, changes at a tip corner, as a factor of the distance
#: from it that c_0 is taken at: solved tips of finite elements are softer by up to 1.4 times that.
_TIP = 1.6


@dataclass(frozen=True)
class ShiftedCompliance:
    """A source whose own compliance, or whose neighbours', is off by the estimated error.

    Parameters
    ----------
    base : FiniteElementCompliance
    radii, own_error : ndarray
        Added to c_0 over the radius [m], [m^2/N]; straight between the points.
    neighbour_error : float
        Added to every c_k [m^2/N].
    farther : float
        By which the distance from the tip's corner is larger that c_0 is taken at.
    """

    base: FiniteElementCompliance
    radii: Array
    own_error: Array
    neighbour_error: float = 0.0
    farther: float = 1.0

    @property
    def reach(self) -> int:
        """As the base."""
        return self.base.reach

    @property
    def log_slope(self) -> float:
        """As the base."""
        return self.base.log_slope

    power = 0.0
    kinks = ()
    remarks = ()

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """As the base, shifted."""
        softer, room = self.base.tip_wedge
        return softer, room * self.farther

    def own(self, radius: ArrayLike) -> Array:
        """c_0 and its error [m^2/N]."""
        return np.asarray(
            self.base.own(radius) + np.interp(np.asarray(radius, dtype=float), self.radii, self.own_error)
        )

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """As the base."""
        return self.base.reference_half_width(radius)

    def neighbour(self, k: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k and its error [m^2/N]."""
        return np.asarray(self.base.neighbour(k, radius_p, radius_q) + self.neighbour_error)

    def root_stress(self, k: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """As the base."""
        return self.base.root_stress(k, radius_q, side)

    def fillet_curve(self, side: Side) -> FilletCurve | None:
        """As the base."""
        return self.base.fillet_curve(side)

    def root_stress_error(self, radius_q: ArrayLike, side: Side = "tension", k: int = 0) -> Array:
        """As the base."""
        return self.base.root_stress_error(radius_q, side, k)

    def describe(self) -> str:
        """As the base, shifted."""
        return f"{self.base.describe()}, shifted by its estimated error"


def shifted_by_error(base: FiniteElementCompliance) -> ShiftedCompliance:
    """The source with its loaded tooth softer by the estimated error."""
    known = base.influence
    low, high = _flank(base)
    radii = np.linspace(low, high, _POINTS)
    return ShiftedCompliance(base, radii, known.self_error(radii, base.reference_half_width(radii)), farther=_TIP)


def neighbours_shifted_by_error(base: FiniteElementCompliance) -> ShiftedCompliance:
    """The source with its neighbours softer by their estimated error."""
    few = np.linspace(*_flank(base), 4)
    errors = (float(np.nanmax(base.influence.neighbour_error(k, few, few))) for k in range(1, base.reach + 1))
    return ShiftedCompliance(base, few, np.zeros_like(few), max(errors, default=0.0))


def _flank(base: FiniteElementCompliance) -> tuple[float, float]:
    """Radii between which the flank is in use [m]."""
    known = base.influence
    low, high = known.gear.involute_radii
    return max(known.lowest_radius, low), min(known.highest_radius, high)


def solve_again(other: Engagement, loaded: Loaded) -> Loaded:
    """Solve with another engagement's compliances at the same contacts, loads and separations."""
    grid = loaded.grid
    m = other.compliance.matrices(grid.contacts)
    shared = share_load(m.compliance, loaded.separation, loaded.load, m.log_slope, m.reference_load, m.edges, m.power)
    return Loaded(RollGrid(grid.x, grid.contacts, m), loaded.load, shared, loaded.separation)


def transmission_error_shift(te: TransmissionError, shifted: Sequence[Engagement]) -> TransmissionErrorShift | None:
    """Solve again at the same quadrature points with each compliance off by its error; None where none states one.

    What would cancel where a whole flank is softer alike is added: the same numbers with each error changing its sign
    along the flank, as far as one place's error is its own (`independent_errors`).
    """
    if not shifted:
        return None
    values = te.values
    pair = shifted[0].pair
    uneven = independent_errors(te.loaded, shifted, (pair.x_start, pair.x_end)).transmission_error
    amplitude = np.zeros_like(te.series.amplitude)
    mean = peak_to_peak = effective = stiffness = 0.0
    for engagement, along in zip(shifted, uneven, strict=True):
        other = solve_again(engagement, te.loaded)
        again = replace(te, loaded=other, series=_series(te, other.transmission_error[:, 0]))
        bent = _series(te, values + along[:, 0])
        mean += abs(again.mean - te.mean) + float(abs(bent.mean - te.mean))
        peak_to_peak += abs(again.peak_to_peak - te.peak_to_peak)
        peak_to_peak += abs(float(np.ptp(values + along[:, 0])) - te.peak_to_peak)
        effective += abs(again.effective_error - te.effective_error)
        effective += abs(float(effective_error(bent)) - te.effective_error)
        stiffness += abs(mean_secant_stiffness(again) - mean_secant_stiffness(te))
        # of the complex coefficient: an amplitude's own change passes through zero where its phase changes
        for series in (again.series, bent):
            amplitude += 2.0 * np.abs(series.coefficients - te.series.coefficients)[1:]
    amplitude = _no_less_than_beside(amplitude)
    effective = max(effective, _of_effective(te.series.amplitude, amplitude))
    return TransmissionErrorShift(mean, peak_to_peak, effective, amplitude, stiffness)


def _no_less_than_beside(error: Array) -> Array:
    """Errors of harmonics, shape (N,), none below the root mean square of it and those beside it.

    What a change of the flank's ends adds to one harmonic may cancel, and does not in the next, whose phases differ.
    """
    square = np.pad(error**2, 1, mode="edge")
    return np.maximum(error, np.sqrt((square[:-2] + square[1:-1] + square[2:]) / 3.0))


def _of_effective(amplitude: Array, error: Array) -> float:
    """Error of A_e by those of its amplitudes, as if each had its own: their changes may cancel in it by chance."""
    a, off = amplitude[:EFFECTIVE_HARMONICS], error[:EFFECTIVE_HARMONICS]
    size = float(np.sqrt(np.sum(a**2)))
    slope = a / size if size > 0.0 else np.zeros_like(a)
    slope[:1] += 1.0
    return float(np.sqrt(np.sum((slope * off) ** 2)))


def _series(te: TransmissionError, values: Array) -> FourierSeries:
    return fourier_series(te.points, values, te.series.amplitude.size)


def load_shift(history: PairHistory, other: PairHistory) -> Array:
    """How far the loads of a shifted solution are from the original's, shape of its loads [N]."""
    columns = [
        np.interp(history.x, other.x, other.load[:, i], left=0.0, right=0.0) for i in range(history.load.shape[1])
    ]
    difference = np.abs(np.stack(columns, axis=1) - history.load)
    # A jump of the load at an end of the path is in the same place in both; outside it one of them may have no point.
    inside = (history.x >= other.x[0]) & (history.x <= other.x[-1]) if other.x.size else np.zeros(history.x.size, bool)
    return np.where(inside[:, None], difference, 0.0)
