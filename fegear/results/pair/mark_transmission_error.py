"""Mark's transmission error compared with the exact one: series, closed forms of spacing errors, what they miss."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.loaded_teeth import HARMONICS
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.contact.fourier import FourierSeries
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.mark_series import StaticErrorSeries

#: Harmonics in the figure.
_BARS = 16
#: Where the ordinate of convergence ends.
_ROUND_OFF = 1e-17


@dataclass(frozen=True)
class SeriesHarmonics:
    """Harmonics 1 to N of the transmission error: exactly and by Mark's series [m]."""

    n: NDArray[np.int64] = shown("", "harmonic of the mesh frequency", table="series")
    exact: Array = shown("um", "amplitude, load sharing and quadrature, uniform pitch", table="series")
    series: Array = shown("um", "amplitude, Mark's series, exact products")
    convolved: Array = shown("um", "amplitude, truncated products")
    limit: Array = shown("um", "limit of the series (no loss of contact), amplitude")
    truncation: Array = shown("um", "difference between series and limit, amplitude")


@dataclass(frozen=True)
class SpacingHarmonics:
    """Rotational harmonics, those of the mesh left out: by (1.28) and by exact load sharing [m]."""

    n: NDArray[np.int64] = shown("")
    mesh_order: Array = shown("", "frequency / mesh frequency")
    exact: Array = shown("um", "amplitude, load sharing")
    closed_form: Array = shown("um", "amplitude (Mark 1.28, 1.29)")


@dataclass(frozen=True)
class MarkData:
    """Mark's series, the exact harmonics of the same evenly spaced teeth, and the spacing errors' closed form.

    Parameters
    ----------
    series : StaticErrorSeries
    exact : FourierSeries
    spacing : FourierSeries or None
        Over `cycles` base pitches.
    cycles : int
    parted : bool
        Whether a pair on the path carries nothing somewhere, which the series does not know.
    corners : bool
        Whether tips touch off the path, which it does not know either.
    contact_ratio : float
        On which the closed form of spacing errors rests.
    """

    series: StaticErrorSeries
    exact: FourierSeries
    spacing: FourierSeries | None
    cycles: int
    parted: bool
    corners: bool
    contact_ratio: float
    rotational: FourierSeries | None = None

    @property
    def harmonics(self) -> SeriesHarmonics:
        """Of the tooth-mesh frequency."""
        s = self.series
        truncation = np.abs(s.pointwise.coefficients - s.linear.coefficients)[1:] * 2.0
        n = np.arange(1, s.linear.amplitude.size + 1)
        return SeriesHarmonics(
            n, self.exact.amplitude, s.pointwise.amplitude, s.convolved.amplitude, s.linear.amplitude, truncation
        )

    @property
    def between(self) -> SpacingHarmonics | None:
        """Rotational harmonics that are none of the mesh, where the pair has spacing errors."""
        if self.spacing is None or self.rotational is None:
            return None
        n = np.arange(1, self.spacing.amplitude.size + 1)
        own = n % self.cycles != 0
        return SpacingHarmonics(
            n[own], n[own] / self.cycles, self.rotational.amplitude[own], self.spacing.amplitude[own]
        )

    @property
    def count(self) -> int:
        """Harmonics of the series."""
        return int(self.series.linear.amplitude.size)

    @property
    def at(self) -> int:
        """Place of the number of terms asked for among those of the convergence."""
        return int(np.flatnonzero(self.series.reciprocal.terms == self.series.terms)[0])

    @property
    @shows("um", "amplitude, Mark's series")
    def te_first_harmonic_series(self) -> float:
        """[m]."""
        return float(self.series.pointwise.amplitude[0])

    @property
    def first_harmonic_error(self) -> float:
        """How far that is from the exact one, as complex numbers [m]."""
        return float(2.0 * abs(self.series.pointwise.coefficients[1] - self.exact.coefficients[1]))

    @property
    def outside_range(self) -> bool:
        """Whether the contact ratio is none for which the closed form of spacing errors holds."""
        from fegear.contact.plane.mark_series import SPACING_RANGE

        return self.spacing is not None and not SPACING_RANGE[0] <= self.contact_ratio <= SPACING_RANGE[1]


def mark_data(pair: LoadedPair, terms: int, rotational: FourierSeries | None) -> MarkData:
    """Compute the series compared with the exact transmission error of plane teeth under their nominal load."""
    from dataclasses import replace

    from fegear.contact.plane.mark_series import spacing_series, static_error_series
    from fegear.contact.plane.transmission_error import transmission_error

    engagement, none = pair.engagement, np.empty(0)
    uneven = bool(engagement.driver_spacing.size or engagement.driven_spacing.size)
    even = replace(engagement, driver_spacing=none, driven_spacing=none)
    same = transmission_error(even, pair.nominal, HARMONICS)
    contacts = same.loaded.grid.contacts
    parted = bool(np.any((same.loaded.loads[:, :, 0] <= 0.0) & contacts.present & (contacts.gap == 0.0)))
    corners = bool(np.any((same.loaded.loads[:, :, 0] > 0.0) & (contacts.gap > 0.0)))
    spacing = spacing_series(engagement, 3 * engagement.cycles) if uneven else None
    series = static_error_series(engagement, pair.nominal, HARMONICS, terms)
    ratio = engagement.pair.contact_ratio
    return MarkData(series, same.series, spacing, engagement.cycles, parted, corners, ratio, rotational)


MARK_TABLES = (
    Rows(
        "transmission_error_series_{name}", "Harmonics of the transmission error of {name} by Mark's series",
        (
            "n", "exact",
            Cell("series", meaning="amplitude, Mark's series, M = {d.by_mark.series.terms}, exact products"),
            Cell("convolved", meaning="amplitude, products truncated at {d.by_mark.count} harmonics"),
            "limit", "truncation",
        ),
        of="by_mark.harmonics",
    ),
    Rows(
        "transmission_error_convergence_{name}", "Convergence of Mark's series for {name}",
        ("terms", "pointwise_error", "convolved_error", "bound"), of="by_mark.series.reciprocal",
    ),
    Rows(
        "transmission_error_rotational_series_{name}",
        "Rotational harmonics of the transmission error of {name} by Mark's closed-form solution",
        (Cell("n", meaning="harmonic of {d.by_mark.cycles} base pitches"), "mesh_order", "exact", "closed_form"),
        of="by_mark.between",
    ),
)  # fmt: skip


_RECIPROCAL = "by_mark.series.reciprocal"
MARK_VALUES = (
    Number(
        "pointwise_error", exact, _RECIPROCAL, name="series_error",
        si=lambda seen: seen.data.by_mark and seen.data.by_mark.series.reciprocal.pointwise_error[seen.data.by_mark.at],
        meaning="error of the coefficients of 1/K after {d.by_mark.series.terms} terms, relative to the mean",
    ),
    Number(
        "convolved_error", exact, _RECIPROCAL, name="series_error_convolved",
        si=lambda seen: seen.data.by_mark and seen.data.by_mark.series.reciprocal.convolved_error[seen.data.by_mark.at],
        meaning="error with truncated products",
    ),
    Number(
        "convolved_error", exact, _RECIPROCAL, name="series_error_convolved_limit",
        si=lambda seen: seen.data.by_mark and seen.data.by_mark.series.reciprocal.convolved_error[-1],
        meaning=lambda seen: f"after {seen.data.by_mark.series.reciprocal.terms[-1]} terms: truncation error",
    ),
    Number("smallest", exact, _RECIPROCAL, name="series_smallest_k"),
    Number("largest", exact, _RECIPROCAL, name="series_largest_k"),
    Number("te_first_harmonic_series", "by_mark.first_harmonic_error", "by_mark"),
)  # fmt: skip


def _where_the_closed_form_holds(seen: Seen) -> str:
    from fegear.contact.plane.mark_series import SPACING_RANGE

    return (
        f"Pair {seen.name}: Mark's closed-form solution for pitch deviations is valid for contact ratios "
        f"{SPACING_RANGE[0]:g} to {SPACING_RANGE[1]:g} (here {seen.data.by_mark.contact_ratio:.4g}); use the exact "
        "method."
    )


MARK_REMARKS = (
    Remark(
        "Pair {name}: Mark's series does not converge: maximum mesh stiffness "
        "{d.by_mark.series.reciprocal.largest:.3g} of its mean (must be below 2); use the exact method.",
        when=lambda seen: seen.data.by_mark and not seen.data.by_mark.series.reciprocal.converges,
    ),
    Remark(
        "Pair {name}: a tooth pair on the path of contact is unloaded at some positions. Mark's series assumes all "
        "pairs on the path in contact; the difference from the exact method does not vanish with more terms.",
        when="by_mark.parted",
    ),
    Remark(
        "Pair {name}: corner contact is not covered by Mark's series, so a difference to the exact method remains "
        "for any number of terms.",
        when="by_mark.corners",
    ),
    Remark(_where_the_closed_form_holds, when="by_mark.outside_range"),
)
_AMPLITUDE = Axis("amplitude of the transmission error", "um (amplitude)", log=True)
MARK_FIGURES = (
    Chart(
        "transmission_error_series_{name}", "Transmission error of pair {name} by Mark's series",
        "Pair {name}: harmonics of the static transmission error, exact and by Mark's series for the reciprocal mesh "
        "stiffness with M = {d.by_mark.series.terms}.",
        (
            Over("n",
                (
                    Line("exact", "exact", "ink", kind="bars", first=_BARS),
                    Line("series", "series, M = {d.by_mark.series.terms}", kind="bars", first=_BARS),
                    Line("convolved", "truncated products", "orange", kind="bars", first=_BARS),
                ),
                _AMPLITUDE, x_options={"whole": True},
            ),
        ),
        of="by_mark.harmonics",
    ),
    Chart(
        "transmission_error_convergence_{name}", "Convergence of Mark's series for pair {name}",
        "Pair {name}: largest error of the coefficients of the reciprocal mesh stiffness, over their mean. The bound "
        "is the geometric series where the stiffness is farthest from its mean; truncated products of Fourier series "
        "leave an error that does not vanish with more terms.",
        (
            Over(
                Axis("terms M of the series", whole=True, zero=True),
                (
                    Line("bound", "bound", "grey", x="terms", look={"dash": "dot"}),
                    Line("pointwise_error", "exact products", x="terms"),
                    Line("convolved_error", "truncated products", "orange", x="terms"),
                ),
                Axis("maximum error / mean", log=True, limits=(_ROUND_OFF, 1.0)),
            ),
        ),
        of=_RECIPROCAL,
    ),
    Chart(
        "transmission_error_rotational_series_{name}", "Pitch deviations of pair {name}, Mark's closed-form solution",
        "Pair {name}: rotational harmonics of the transmission error, by exact load sharing and by (1.28) with the "
        "transfer function (1.29), which depends on the contact ratio only. Mesh harmonics are not drawn.",
        (
            Over(
                "mesh_order",
                (Line("exact", "exact", "ink", kind="points"), Line("closed_form",
                    "closed-form solution", kind="points")),
                _AMPLITUDE,
            ),
        ),
        of="by_mark.between",
    ),
)  # fmt: skip
