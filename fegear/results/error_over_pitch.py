"""Tables, values and figures of a loaded transmission error over one base pitch, in the plane and over the face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel, Scale
from fegear.engine.outcome import Column, Table, Value
from fegear.results.loaded_pair import BASE_PITCH, drawn_loads, over_loads, pitch_marks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.arrays import Array
    from fegear.contact import FourierSeries
    from fegear.contact.error_by_shift import TransmissionErrorShift
    from fegear.geometry import GearPair

#: Harmonics in the figure.
_BARS = 16


class OneLoad(Protocol):
    """Transmission error under one load."""

    @property
    def series(self) -> FourierSeries:
        """Over the base pitch [m]."""

    @property
    def mean(self) -> float:
        """[m]."""

    @property
    def peak_to_peak(self) -> float:
        """[m]."""

    @property
    def effective_error(self) -> float:
        """A_e of TM-89901 [m]."""

    @property
    def average_stiffness(self) -> float:
        """Mean of the local mesh stiffness [N/m]."""


@dataclass(frozen=True)
class ErrorOverPitch:
    """A loaded transmission error over one base pitch, ready to be shown.

    Parameters
    ----------
    name : str
        Of the pair.
    pair : GearPair
    loads : tuple of float
        Ascending [N].
    nominal : int
        Number of the nominal one.
    each : tuple of OneLoad
        For every load.
    x : ndarray, shape (P,)
        Roll positions [m].
    values, secant, local : ndarray, shape (P, L)
        Transmission error [m], secant and local mesh stiffness [N/m].
    touching : ndarray, shape (P, L)
        Tooth pairs that carry load.
    mean_secant : float
        At the nominal load [N/m].
    shift : TransmissionErrorShift or None
        Estimated errors at the nominal load.
    integrated : str
        How the harmonics come about, for their figure.
    """

    name: str
    pair: GearPair
    loads: tuple[float, ...]
    nominal: int
    each: Sequence[OneLoad]
    x: Array
    values: Array
    secant: Array
    local: Array
    touching: Array
    mean_secant: float
    shift: TransmissionErrorShift | None
    integrated: str

    @property
    def load(self) -> float:
        """The nominal load [N]."""
        return self.loads[self.nominal]

    @property
    def torques(self) -> Array:
        """Torque on the driver under each load [N m]."""
        return np.array(self.loads) * self.pair.driver.base_radius

    @property
    def under(self) -> str:
        """The load that a figure holds for, where the pair has one only; else its legend names them."""
        return f"{self.load:.5g} N" if len(self.loads) == 1 else ""


def _curve_columns(e: ErrorOverPitch, i: int) -> tuple[Column, ...]:
    return (
        Column("x", e.x, "mm", "roll position: the pair that is last to come into contact"),
        Column("te", e.values[:, i], "um", "loaded transmission error"),
        Column("mesh_stiffness", e.secant[:, i], "N/um", "secant, sum over the pairs in contact"),
        Column("pairs_in_contact", e.touching[:, i], "", "tooth pairs that carry load"),
        Column("local_stiffness", e.local[:, i], "N/um", "slope of load over transmission error"),
    )


def error_tables(e: ErrorOverPitch, more: tuple[Column, ...] = ()) -> list[Table]:
    """The curve, its harmonics, and both over the loads; `more` columns stand behind those of the curve."""
    name, title = e.name, f"Transmission error of {e.name} over one base pitch"
    curve = (*_curve_columns(e, e.nominal), *more)
    tables = [Table(f"transmission_error_{name}", curve, f"{title}, {e.load:.6g} N"), _harmonics_table(e)]
    if len(e.loads) > 1:
        tables.append(_summary_over_loads(e))
        all_loads = over_loads(e.loads, [_curve_columns(e, k) for k in range(len(e.loads))])
        tables.append(Table(f"transmission_error_loads_{name}", all_loads, f"{title}, every load (Harris map)"))
    return tables


def _harmonics_table(e: ErrorOverPitch) -> Table:
    """Cosine, sine and amplitude of harmonics 1.. of the series."""
    series = e.each[e.nominal].series
    n = np.arange(1, series.amplitude.size + 1)
    columns = [
        Column("n", n, "", "harmonic of the tooth-mesh frequency"),
        Column("cosine", series.cosine, "um", "factor of cos(2 pi n x / p_b), 0-peak"),
        Column("sine", series.sine, "um", "factor of sin(2 pi n x / p_b), 0-peak"),
        Column("amplitude", series.amplitude, "um", "0-peak"),
    ]
    if e.shift is not None:
        columns.append(Column("amplitude_error", e.shift.amplitude, "um", "estimated error of amplitude"))
    title = f"Harmonics of the transmission error of {e.name}"
    return Table(f"transmission_error_harmonics_{e.name}", tuple(columns), title)


def _summary_over_loads(e: ErrorOverPitch) -> Table:
    def numbers(attribute: str) -> Array:
        return np.array([getattr(te, attribute) for te in e.each])

    return Table(
        f"transmission_error_summary_{e.name}",
        (
            Column("total_load", np.array(e.loads), "N", "along the line of action"),
            Column("te_mean", numbers("mean"), "um", "mean over the base pitch"),
            Column("te_peak_to_peak", numbers("peak_to_peak"), "um", "largest less smallest"),
            Column("te_effective", numbers("effective_error"), "um", "A_e of NASA TM-89901"),
            Column("local_stiffness", numbers("average_stiffness"), "N/um", "slope of load, mean over the base pitch"),
            Column("driver_torque", e.torques, "N.m", "torque on the driver under that load"),
        ),
        f"Transmission error of {e.name} for every load",
    )


def error_values(e: ErrorOverPitch) -> list[Value]:
    """The single numbers of a transmission error at the nominal load."""
    te, k = e.each[e.nominal], e.mean_secant
    first = float(te.series.amplitude[0]) if te.series.amplitude.size else 0.0
    rows = (
        ("te_mean", te.mean, "um", "mean transmission error over the base pitch"),
        ("te_peak_to_peak", te.peak_to_peak, "um", "largest less smallest"),
        ("te_effective", te.effective_error, "um", "A_e of NASA TM-89901, 0-peak"),
        ("te_first_harmonic", first, "um", "0-peak"),
        ("mesh_stiffness_mean", k, "N/um", "secant stiffness, mean"),
        ("local_stiffness_mean", te.average_stiffness, "N/um", "slope of load, mean"),
    )
    errors: tuple[float | None, ...] = (None,) * len(rows)
    if (s := e.shift) is not None:
        local = s.stiffness / k * te.average_stiffness
        errors = (s.mean, s.peak_to_peak, s.effective, float(s.amplitude[0]) if s.amplitude.size else 0.0, s.stiffness,
                  local)  # fmt: skip
    return [
        Value(f"{e.name}.{key}", value, unit, error, meaning)
        for (key, value, unit, meaning), error in zip(rows, errors, strict=True)
    ]


def mesh_compliance_value(e: ErrorOverPitch, compliance: float) -> Value:
    """Mean of 1/K_T of perfect flanks [m/N]; its error is taken to be that of the mean transmission error."""
    relative = None if e.shift is None else e.shift.mean / e.each[e.nominal].mean
    return Value(
        f"{e.name}.mesh_compliance_mean", compliance, "um/N", None if relative is None else relative * compliance,
        "mean of 1/K_T, perfect flanks with every pair of the path in contact (Mark, A.11)",
    )  # fmt: skip


def error_figures(e: ErrorOverPitch) -> tuple[Figure, ...]:
    """Draw the curve with the mesh stiffness, the harmonics, and both over the loads."""
    several = (_over_load(e),) if len(e.loads) > 1 else ()
    return _over_pitch(e), _harmonics(e), *several


def _over_pitch(e: ErrorOverPitch) -> Figure:
    te, x, marks, i = e.each[e.nominal], e.x * 1e3, pitch_marks(e.pair, e.x), e.nominal
    return Figure(
        f"transmission_error_{e.name}",
        f"Transmission error of pair {e.name}",
        f"Pair {e.name}: loaded transmission error over one base pitch (Harris map of its loads), and the mesh "
        f"stiffness at {e.load:.5g} N: mean {te.average_stiffness * 1e-6:.4g} N/µm by the local slope. Peak to peak "
        f"{te.peak_to_peak * 1e6:.3g} µm, effective error A_e {te.effective_error * 1e6:.3g} µm.",
        (
            Panel(BASE_PITCH, Axis("transmission error", "um"), tuple(
                Curve(x, e.values[:, k] * 1e6, label, role) for k, label, role in drawn_loads(e.loads, e.load)
            ), marks),
            Panel(BASE_PITCH, Axis("mesh stiffness", "N/um", zero=True), (
                Curve(x, e.secant[:, i] * 1e-6, "secant stiffness", "secant"),
                Curve(x, e.local[:, i] * 1e-6, "local slope", "local slope"),
            ), marks),
        ),
        under=e.under,
    )  # fmt: skip


#: Ordinate of harmonics.
AMPLITUDE = Axis("amplitude of the transmission error", "um, 0-peak")


def _harmonics(e: ErrorOverPitch) -> Figure:
    n = np.arange(1, min(_BARS, e.each[e.nominal].series.amplitude.size) + 1)
    errors = None if e.shift is None else e.shift.amplitude[: n.size] * 1e6
    return Figure(
        f"transmission_error_harmonics_{e.name}",
        f"Harmonics of the transmission error of pair {e.name}",
        f"Pair {e.name}: harmonics of the static transmission error, {e.integrated}.",
        (
            Panel(Axis("harmonic of the tooth-mesh frequency", whole=True), AMPLITUDE, tuple(
                Bars(n, e.each[k].series.amplitude[: n.size] * 1e6, label, role, errors if k == e.nominal else None)
                for k, label, role in drawn_loads(e.loads, e.load)
            )),
        ),
        under=e.under,
    )  # fmt: skip


def _over_load(e: ErrorOverPitch) -> Figure:
    """Mean and variation of the transmission error over the load."""
    label, torque = "load along the line of action", Scale("torque on the driver", "N.m", e.loads, e.torques)
    mean, swing = (np.array([getattr(te, key) for te in e.each]) * 1e6 for key in ("mean", "peak_to_peak"))
    panels = (
        Panel(Axis(label, "N", second=torque), Axis("mean", "um"), (Curve(e.loads, mean, "", "blue"),)),
        Panel(Axis(label, "N"), Axis("peak to peak", "um"), (Curve(e.loads, swing, "", "blue"),)),
    )
    return Figure(
        f"transmission_error_summary_{e.name}",
        f"Transmission error of {e.name} over load",
        f"Pair {e.name}: mean and peak to peak of the loaded transmission error over one base pitch, for every load.",
        panels,
    )
