"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch.

Tables, values and figures of a loaded transmission error over one base pitch, in the plane and over the face.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.case.built.loaded_pair import check_relief
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import Axis, Figure, Panel, Scale
from fegear.engine.figure.items import Bars, Curve, Stems
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.pair.loaded_pair import (
    BASE_PITCH,
    EFFECTS,
    drawn_loads,
    needs_pair,
    over_loads,
    pitch_marks,
    plane_pairs,
)
from fegear.results.pair.mark_transmission_error import mark_data, present_mark

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.case.built.loaded_pair import LoadedPair
    from fegear.case.loading import TransmissionErrorPart
    from fegear.case.reading import Scene
    from fegear.contact.fourier import FourierSeries
    from fegear.contact.plane.engagement import Loaded
    from fegear.contact.plane.shifted_compliance import TransmissionErrorShift
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.engine.figure.figure import DeferredFigure
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import GearPair
    from fegear.results.pair.mark_transmission_error import MarkData


#: Harmonics of the series.
HARMONICS = 64


#: Roll positions of the table over the base pitch; those on either side of every jump come in addition.
POSITIONS = 200


#: Largest number of base pitches over which rotational harmonics of spacing errors are computed.
_MOST_CYCLES = 10_000


#: One engagement solved over a base pitch [s], and what corners off the path add to it.
_ERROR, _ERROR_CORNERS = 0.015, 0.1


@dataclass(frozen=True)
class TransmissionErrorData:
    """What the stage hands to pictures and later stages.

    Parameters
    ----------
    pair : LoadedPair
    exact : tuple of TransmissionError
        For every load, by quadrature between the jumps.
    curve : Loaded
        At the table's roll positions, for every load.
    stiffness : ndarray, shape (P, L)
        Sum of the secant stiffnesses of the pairs in contact [N/m].
    rotational : FourierSeries or None
        Over the hunting cycle, with spacing errors.
    shift : TransmissionErrorShift or None
        Estimated errors at the nominal load.
    mesh_compliance : float or None
        Mean of 1/K_T of perfect flanks [m/N]; none below a contact ratio of 1.
    by_mark : MarkData or None
        Mark's series at the nominal load, where the case asks for it.
    """

    pair: LoadedPair
    exact: tuple[TransmissionError, ...]
    curve: Loaded
    stiffness: Array
    rotational: FourierSeries | None
    shift: TransmissionErrorShift | None
    mesh_compliance: float | None
    by_mark: MarkData | None


@dataclass(frozen=True)
class TransmissionErrorInputs:
    """What is read of the case beside the loaded pair."""

    part: TransmissionErrorPart
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> TransmissionErrorInputs:
    return TransmissionErrorInputs(scene.case.transmission_error, name)


def _compute(asked: TransmissionErrorInputs, upstream: Upstream, work: Work) -> TransmissionErrorData:
    from fegear.contact.plane.shifted_compliance import transmission_error_shift
    from fegear.contact.plane.transmission_error import (
        pair_stiffness,
        revolution,
        roll_positions,
        secant_stiffness,
        transmission_error,
    )

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    e, i = pair.engagement, pair.loads.index(pair.nominal)
    exact = []
    for number, load in enumerate(pair.loads):
        exact.append(transmission_error(e, load, HARMONICS))
        work.progress((number + 1) / (len(pair.loads) + 2))
    curve = e.solve(e.grid(roll_positions(e, POSITIONS)), pair.loads)
    uneven = bool(e.driver_spacing.size or e.driven_spacing.size)
    rotational = revolution(e, pair.nominal, e.cycles, 3 * e.cycles) if uneven and e.cycles <= _MOST_CYCLES else None
    bridged = e.pair.contact_ratio >= 1.0
    compliance = pair_stiffness(e, pair.nominal, HARMONICS).mean_compliance if bridged else None
    shift = transmission_error_shift(exact[i], pair.shifted)
    by_mark = mark_data(e, exact[i], asked.part.terms) if asked.part.method == "mark-series" else None
    return TransmissionErrorData(
        pair, tuple(exact), curve, secant_stiffness(curve), rotational, shift, compliance, by_mark
    )


def _shown(name: str, data: TransmissionErrorData) -> ErrorOverPitch:
    from fegear.contact.plane.transmission_error import mean_secant_stiffness

    pair, curve = data.pair, data.curve
    i = pair.loads.index(pair.nominal)
    return ErrorOverPitch(
        name, pair.engagement.pair, pair.loads, i, data.exact, curve.x, curve.transmission_error, data.stiffness,
        curve.local_stiffness, (curve.loads > 0.0).sum(axis=0), mean_secant_stiffness(data.exact[i]), data.shift,
        "integrated exactly between its jumps",
    )  # fmt: skip


def _present(data: TransmissionErrorData, inputs: TransmissionErrorInputs) -> Outcome:
    name, pair = inputs.name, data.pair
    e, shown = pair.engagement, _shown(name, data)
    tables = error_tables(shown)
    values, remarks, cycles = error_values(shown), [], e.cycles
    if data.mesh_compliance is None:
        remarks.append(
            f"Pair {name}: {name}.mesh_compliance_mean, Mark's mean of 1/K_T of perfect flanks, is not given: with "
            f"a contact ratio of {e.pair.contact_ratio:.4g} tip corners alone carry where no pair is on the path of "
            "contact."
        )
    else:
        values.append(mesh_compliance_value(shown, data.mesh_compliance))
    if data.rotational is not None:
        tables.append(_rotational_table(name, data.rotational, cycles))
        low = data.rotational.amplitude[: cycles - 1]
        if low.size:
            where = f"0-peak, harmonic {int(low.argmax()) + 1} of {cycles} base pitches"
            values.append(Value(f"{name}.te_largest_rotational", float(low.max()), "um", None, where))
    elif cycles > _MOST_CYCLES:
        remarks.append(
            f"Pair {name}: the teeth meet again only after {cycles} base pitches, more than the {_MOST_CYCLES} "
            "over which rotational harmonics of spacing errors are computed, so these are neglected. Give the "
            "errors of one gear alone to see its harmonics."
        )
    settings: dict[str, object] = {"harmonics": HARMONICS, "positions": POSITIONS}
    figures: tuple[Figure | DeferredFigure, ...] = error_figures(shown)
    if data.rotational is not None:
        figures = (*figures, _rotational_figure(name, data, data.rotational))
    if data.by_mark is not None:
        more = present_mark(name, data.by_mark, data.rotational)
        tables += more.tables
        values += more.values
        remarks += more.remarks
        figures = (*figures, *more.figures)
        settings |= more.settings
    return Outcome(data, tuple(tables), tuple(values), settings, tuple(remarks), figures)


def _rotational_table(name: str, series: FourierSeries, cycles: int) -> Table:
    n = np.arange(1, series.amplitude.size + 1)
    return Table(
        f"transmission_error_rotational_{name}",
        (
            Column("n", n, "", f"harmonic of {cycles} base pitches; n = {cycles} is the tooth-mesh frequency"),
            Column("mesh_order", n / cycles, "", "frequency over the tooth-mesh frequency"),
            Column("cosine", series.cosine, "um", "0-peak"),
            Column("sine", series.sine, "um", "0-peak"),
            Column("amplitude", series.amplitude, "um", "0-peak"),
        ),
        f"Rotational harmonics of the transmission error of {name}",
    )


def _rotational_figure(name: str, data: TransmissionErrorData, series: FourierSeries) -> Figure:
    pair = data.pair
    cycles = pair.engagement.cycles
    order = np.arange(1, series.amplitude.size + 1) / cycles
    return Figure(
        f"transmission_error_rotational_{name}",
        f"Rotational harmonics of the transmission error of pair {name}",
        f"Pair {name}: harmonics over the {cycles} base pitches after which the same teeth meet again, at "
        f"{pair.nominal:.5g} N. Whole numbers are harmonics of the tooth-mesh frequency, the others spacing errors.",
        (
            Panel(Axis("frequency over the tooth-mesh frequency"), AMPLITUDE, (
                Stems(order, series.amplitude * 1e6, "", "blue"),
            )),
        ),
        under=f"{pair.nominal:.5g} N",
    )  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    """One quadrature for each load, and the errors of the nominal one."""
    each = _ERROR + (_ERROR_CORNERS if scene.case.effects.corner_contact else 0.0)
    seconds = each * (forecasts.loads(scene, name) + 0.5)
    if scene.case.effects.spacing_errors:
        seconds += 0.03
    return Forecast({"loads": forecasts.loads(scene, name), "harmonics": 64}, seconds)


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


TRANSMISSION_ERROR = Stage(
    subjects=plane_pairs,
    needs=needs_pair,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_relief,
    effects=EFFECTS,
    cites=citing(
        Citation("mark", "static transmission error, its Fourier series and the mean compliance", "1.1 to 1.32, A.11"),
        Citation("lin-townsend-oswald", "effective error A_e"),
        Citation("harris", "transmission error over the mesh cycle for a family of loads"),
    ),
    forecast=_forecast,
)
