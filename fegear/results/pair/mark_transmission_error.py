"""Mark's transmission error compared with the exact one: series, closed forms of spacing errors, what they miss."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.loaded_teeth import HARMONICS
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.table import Column, Table
from fegear.engine.value import Value

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


def mark_data(pair: LoadedPair, terms: int) -> MarkData:
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
    return MarkData(series, same.series, spacing, engagement.cycles, parted, corners, engagement.pair.contact_ratio)


def present_mark(name: str, data: MarkData, rotational: FourierSeries | None) -> Outcome:
    """Tables, values, remarks and figures that the series adds to those of the transmission error."""
    from fegear.contact.plane.mark_series import SPACING_RANGE

    s, reciprocal = data.series, data.series.reciprocal
    n = np.arange(1, s.linear.amplitude.size + 1)
    tables = [
        Table(
            f"transmission_error_series_{name}",
            (
                Column("n", n, "", "harmonic of the tooth-mesh frequency"),
                Column("exact", data.exact.amplitude, "um", "0-peak, load sharing and quadrature, evenly spaced teeth"),
                Column("series", s.pointwise.amplitude, "um", f"0-peak, Mark's series, M = {s.terms}, exact products"),
                Column("convolved", s.convolved.amplitude, "um", f"0-peak, products cut off at {n.size} harmonics"),
                Column("limit", s.linear.amplitude, "um", "0-peak, what the series converges to: pairs never part"),
                Column("truncation", np.abs(s.pointwise.coefficients - s.linear.coefficients)[1:] * 2.0, "um",
                       "size of series less limit, 0-peak"),
            ),
            f"Harmonics of the transmission error of {name} by Mark's series",
        ),
        Table(
            f"transmission_error_convergence_{name}",
            (
                Column("M", reciprocal.terms, "", "terms of the series"),
                Column("error", reciprocal.error(reciprocal.pointwise), "", "largest of 1/K's coefficients over mean"),
                Column("error_convolved", reciprocal.error(reciprocal.convolved), "", "with products cut off"),
                Column("bound", reciprocal.bound, "", "largest |1 - K/mean K|^(M + 1)"),
            ),
            f"Convergence of Mark's series for {name}",
        ),
    ]  # fmt: skip
    at = int(np.flatnonzero(reciprocal.terms == s.terms)[0])
    values = [
        Value(f"{name}.series_error", float(reciprocal.error(reciprocal.pointwise)[at]), "", 0.0,
              f"of 1/K's coefficients after {s.terms} terms, over the mean"),
        Value(f"{name}.series_error_convolved", float(reciprocal.error(reciprocal.convolved)[at]), "", 0.0,
              "the same with products cut off"),
        Value(f"{name}.series_error_convolved_limit", float(reciprocal.error(reciprocal.convolved)[-1]), "", 0.0,
              f"after {reciprocal.terms[-1]} terms: what cutting off leaves"),
        Value(f"{name}.series_smallest_k", reciprocal.smallest, "", 0.0, "of mesh stiffness over its mean"),
        Value(f"{name}.series_largest_k", reciprocal.largest, "", 0.0, "of mesh stiffness over its mean"),
        Value(f"{name}.te_first_harmonic_series", float(s.pointwise.amplitude[0]), "um",
              float(2.0 * abs(s.pointwise.coefficients[1] - data.exact.coefficients[1])), "0-peak, by Mark's series"),
    ]  # fmt: skip
    if data.spacing is not None and rotational is not None:
        tables.append(_spacing_table(name, data, data.spacing, rotational))
    remarks = []
    if not reciprocal.converges:
        remarks.append(
            f"Pair {name}: Mark's series does not converge: the mesh stiffness reaches {reciprocal.largest:.3g} of its "
            "mean, and it has to stay below 2. The exact method holds."
        )
    if data.parted:
        remarks.append(
            f"Pair {name}: a tooth pair on the path of contact carries nothing somewhere. Mark's series takes every "
            "pair on the path as loaded, so it keeps a difference from the exact method whatever its terms."
        )
    if data.corners:
        remarks.append(
            f"Pair {name}: tips touch before or after the path of contact (corner_contact). Mark's series knows the "
            "path alone, so it keeps a difference from the exact method whatever its terms."
        )
    if data.spacing is not None and not SPACING_RANGE[0] <= data.contact_ratio <= SPACING_RANGE[1]:
        remarks.append(
            f"Pair {name}: Mark's closed form of spacing errors holds for contact ratios from {SPACING_RANGE[0]:g} to "
            f"{SPACING_RANGE[1]:g}; here it is {data.contact_ratio:.4g}. The exact method holds."
        )
    settings = {"method": "mark-series", "terms": s.terms}
    return Outcome(data, tuple(tables), tuple(values), settings, tuple(remarks), _figures(name, data, rotational))


def _spacing_table(name: str, data: MarkData, closed: FourierSeries, rotational: FourierSeries) -> Table:
    """Rotational harmonics, those of the mesh left out: by (1.28) and by exact load sharing."""
    n, between, cycles = np.arange(1, closed.amplitude.size + 1), _between(data), data.cycles
    return Table(
        f"transmission_error_rotational_series_{name}",
        (
            Column("n", n[between], "", f"harmonic of {cycles} base pitches"),
            Column("mesh_order", n[between] / cycles, "", "frequency over the tooth-mesh frequency"),
            Column("exact", rotational.amplitude[between], "um", "0-peak, by load sharing"),
            Column("closed_form", closed.amplitude[between], "um", "0-peak (Mark 1.28, 1.29)"),
        ),
        f"Rotational harmonics of the transmission error of {name} by Mark's closed form",
    )


def _figures(name: str, data: MarkData, rotational: FourierSeries | None) -> tuple[Figure, ...]:
    s, r = data.series, data.series.reciprocal
    n = np.arange(1, min(_BARS, s.linear.amplitude.size) + 1)
    rows = (
        ("exact", data.exact, "ink"), (f"series, M = {s.terms}", s.pointwise, "blue"),
        ("products cut off", s.convolved, "orange"),
    )  # fmt: skip
    harmonics = Figure(
        f"transmission_error_series_{name}", f"Transmission error of pair {name} by Mark's series",
        f"Pair {name}: harmonics of the static transmission error, exactly and by Mark's series for the reciprocal "
        f"mesh stiffness with M = {s.terms}.",
        (Panel(
            Axis("harmonic of the tooth-mesh frequency", whole=True),
            Axis("amplitude of the transmission error", "um, 0-peak", log=True),
            tuple(Bars(n, one.amplitude[: n.size] * 1e6, word, role) for word, one, role in rows),
        ),),
    )  # fmt: skip
    convergence = Figure(
        f"transmission_error_convergence_{name}", f"Convergence of Mark's series for pair {name}",
        f"Pair {name}: largest error of the coefficients of the reciprocal mesh stiffness, over their mean. The bound "
        "is the geometric series where the stiffness is farthest from its mean; products of Fourier series that are "
        "cut off leave an error that no term takes away.",
        (Panel(
            Axis("terms M of the series", whole=True, zero=True),
            Axis("largest error over the mean", log=True, limits=(_ROUND_OFF, 1.0)), (
                Curve(r.terms, r.bound, "bound", "grey", dash="dot"),
                Curve(r.terms, r.error(r.pointwise), "exact products", "blue"),
                Curve(r.terms, r.error(r.convolved), "products cut off", "orange"),
            ),
        ),),
    )  # fmt: skip
    if data.spacing is None or rotational is None:
        return harmonics, convergence
    order, between = np.arange(1, data.spacing.amplitude.size + 1) / data.cycles, _between(data)
    points = tuple(
        Points(order[between], one.amplitude[between] * 1e6, word, role)
        for word, one, role in (("exact", rotational, "ink"), ("closed form", data.spacing, "blue"))
    )
    spacing = Figure(
        f"transmission_error_rotational_series_{name}", f"Spacing errors of pair {name} by Mark's closed form",
        f"Pair {name}: rotational harmonics of the transmission error, by exact load sharing and by (1.28) with the "
        "transfer function (1.29), which knows the contact ratio alone. Harmonics of the mesh are not drawn.",
        (Panel(
            Axis("frequency over the tooth-mesh frequency"),
            Axis("amplitude of the transmission error", "um, 0-peak", log=True), points,
        ),),
    )  # fmt: skip
    return harmonics, convergence, spacing


def _between(data: MarkData) -> NDArray[np.bool_]:
    """Rotational harmonics that are none of the mesh."""
    count = 0 if data.spacing is None else data.spacing.amplitude.size
    return np.asarray(np.arange(1, count + 1) % data.cycles != 0)
