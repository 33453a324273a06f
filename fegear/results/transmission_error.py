"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel, Scale, Stems
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.models.pair_checks import check_relief
from fegear.results import forecasts
from fegear.results.loaded_pair import (
    BASE_PITCH,
    EFFECTS,
    drawn_loads,
    needs_pair,
    over_loads,
    pitch_marks,
    plane_pairs,
    under,
)
from fegear.results.mark_transmission_error import mark_data, present_mark

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.transmission_error import TransmissionErrorPart
    from fegear.contact import FourierSeries, Loaded, TransmissionError
    from fegear.contact.error_by_shift import TransmissionErrorShift
    from fegear.engine.figure import DeferredFigure
    from fegear.engine.stage import Upstream, Work
    from fegear.models.loaded_pair import LoadedPair
    from fegear.results.mark_transmission_error import MarkData

#: Harmonics of the series.
HARMONICS = 64
#: Roll positions of the table over the base pitch; those on either side of every jump come in addition.
POSITIONS = 200
#: Harmonics in the figure.
_BARS = 16
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
    mesh_compliance : float
        Mean of 1/K_T of perfect flanks [m/N].
    by_mark : MarkData or None
        Mark's series at the nominal load, where the case asks for it.
    """

    pair: LoadedPair
    exact: tuple[TransmissionError, ...]
    curve: Loaded
    stiffness: Array
    rotational: FourierSeries | None
    shift: TransmissionErrorShift | None
    mesh_compliance: float
    by_mark: MarkData | None


@dataclass(frozen=True)
class TransmissionErrorInputs:
    """What is read of the case beside the loaded pair."""

    part: TransmissionErrorPart
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> TransmissionErrorInputs:
    return TransmissionErrorInputs(scene.case.transmission_error, name)


def _curve_columns(curve: Loaded, stiffness: Array, i: int) -> tuple[Column, ...]:
    return (
        Column("x", curve.x, "mm", "roll position: the pair that is last to come into contact"),
        Column("te", curve.transmission_error[:, i], "um", "loaded transmission error"),
        Column("mesh_stiffness", stiffness[:, i], "N/um", "secant, sum over the pairs in contact"),
        Column("pairs_in_contact", (curve.loads[:, :, i] > 0.0).sum(axis=0), "", "tooth pairs that carry load"),
        Column("local_stiffness", curve.local_stiffness[:, i], "N/um", "slope of load over transmission error"),
    )


def _harmonics_table(name: str, title: str, series: FourierSeries, errors: Array | None) -> Table:
    """Cosine, sine and amplitude of harmonics 1.. of a series."""
    n = np.arange(1, series.amplitude.size + 1)
    columns = [
        Column("n", n, "", "harmonic of the tooth-mesh frequency"),
        Column("cosine", series.cosine, "um", "factor of cos(2 pi n x / p_b), 0-peak"),
        Column("sine", series.sine, "um", "factor of sin(2 pi n x / p_b), 0-peak"),
        Column("amplitude", series.amplitude, "um", "0-peak"),
    ]
    if errors is not None:
        columns.append(Column("amplitude_error", errors, "um", "estimated error of amplitude"))
    return Table(name, tuple(columns), title)


def _te_values(prefix: str, te: TransmissionError, shifts: TransmissionErrorShift | None) -> tuple[Value, ...]:
    """The single numbers of a transmission error."""
    from fegear.contact.mesh_curve import mean_secant_stiffness

    k, first = mean_secant_stiffness(te), float(te.series.amplitude[0])
    rows = (
        ("te_mean", te.mean, "um", "mean transmission error over the base pitch"),
        ("te_peak_to_peak", te.peak_to_peak, "um", "largest less smallest"),
        ("te_effective", te.effective_error, "um", "A_e of NASA TM-89901, 0-peak"),
        ("te_first_harmonic", first, "um", "0-peak"),
        ("mesh_stiffness_mean", k, "N/um", "secant stiffness, mean"),
        ("local_stiffness_mean", te.average_stiffness, "N/um", "slope of load, mean"),
    )
    errors: tuple[float | None, ...] = (None,) * len(rows)
    if shifts is not None:
        s = shifts
        local = s.stiffness / k * te.average_stiffness
        errors = (s.mean, s.peak_to_peak, s.effective, float(s.amplitude[0]), s.stiffness, local)
    return tuple(
        Value(f"{prefix}.{key}", value, unit, error, meaning)
        for (key, value, unit, meaning), error in zip(rows, errors, strict=True)
    )


def _compute(asked: TransmissionErrorInputs, upstream: Upstream, work: Work) -> TransmissionErrorData:
    from fegear.contact import revolution, transmission_error
    from fegear.contact.error_by_shift import transmission_error_shift
    from fegear.contact.mesh_curve import roll_positions, secant_stiffness
    from fegear.contact.transmission_error import pair_stiffness

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
    compliance = pair_stiffness(e, pair.nominal, HARMONICS).mean_compliance
    shift = transmission_error_shift(exact[i], pair.shifted)
    by_mark = mark_data(e, exact[i], asked.part.terms) if asked.part.method == "mark-series" else None
    return TransmissionErrorData(
        pair, tuple(exact), curve, secant_stiffness(curve), rotational, shift, compliance, by_mark
    )


def _present(data: TransmissionErrorData, inputs: TransmissionErrorInputs) -> Outcome:
    name, pair, curve, stiffness, shifts = inputs.name, data.pair, data.curve, data.stiffness, data.shift
    e, i = pair.engagement, pair.loads.index(pair.nominal)
    te = data.exact[i]
    title = f"Transmission error of {name} over one base pitch"
    tables = [
        Table(f"transmission_error_{name}", _curve_columns(curve, stiffness, i), f"{title}, {pair.nominal:.6g} N"),
        _harmonics_table(
            f"transmission_error_harmonics_{name}",
            f"Harmonics of the transmission error of {name}",
            te.series,
            None if shifts is None else shifts.amplitude,
        ),
    ]
    if len(pair.loads) > 1:
        tables.append(_summary_over_loads(name, pair, data.exact))
        parts = [_curve_columns(curve, stiffness, k) for k in range(len(pair.loads))]
        all_loads = over_loads(pair.loads, parts)
        tables.append(Table(f"transmission_error_loads_{name}", all_loads, f"{title}, every load (Harris map)"))
    values = [*_te_values(name, te, shifts)]
    relative = None if shifts is None else shifts.mean / te.mean
    values.append(
        Value(
            f"{name}.mesh_compliance_mean",
            data.mesh_compliance,
            "um/N",
            None if relative is None else relative * data.mesh_compliance,
            "mean of 1/K_T, perfect flanks with every pair of the path in contact (Mark, A.11)",
        )
    )
    remarks, cycles = [], e.cycles
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
    figures: tuple[Figure | DeferredFigure, ...] = _figures(name, data, None if shifts is None else shifts.amplitude)
    if data.by_mark is not None:
        more = present_mark(name, data.by_mark, data.rotational)
        tables += more.tables
        values += more.values
        remarks += more.remarks
        figures = (*figures, *more.figures)
        settings |= more.settings
    return Outcome(data, tuple(tables), tuple(values), settings, tuple(remarks), figures)


def _summary_over_loads(name: str, pair: LoadedPair, exact: tuple[TransmissionError, ...]) -> Table:
    def numbers(attribute: str) -> Array:
        return np.array([getattr(te, attribute) for te in exact])

    return Table(
        f"transmission_error_summary_{name}",
        (
            Column("total_load", np.array(pair.loads), "N", "along the line of action"),
            Column("te_mean", numbers("mean"), "um", "mean over the base pitch"),
            Column("te_peak_to_peak", numbers("peak_to_peak"), "um", "largest less smallest"),
            Column("te_effective", numbers("effective_error"), "um", "A_e of NASA TM-89901"),
            Column("local_stiffness", numbers("average_stiffness"), "N/um", "slope of load, mean over the base pitch"),
            Column("driver_torque", _torques(pair), "N.m", "torque on the driver under that load"),
        ),
        f"Transmission error of {name} for every load",
    )


def _torques(pair: LoadedPair) -> Array:
    """Torque on the driver under each load [N m]."""
    return np.array(pair.loads) * pair.engagement.pair.driver.base_radius


def _over_load(name: str, pair: LoadedPair, exact: tuple[TransmissionError, ...]) -> Figure:
    """Mean and variation of the transmission error over the load."""
    label, torque = "load along the line of action", Scale("torque on the driver", "N.m", pair.loads, _torques(pair))
    mean, swing = (np.array([getattr(te, key) for te in exact]) * 1e6 for key in ("mean", "peak_to_peak"))
    panels = (
        Panel(Axis(label, "N", second=torque), Axis("mean", "um"), (Curve(pair.loads, mean, "", "blue"),)),
        Panel(Axis(label, "N"), Axis("peak to peak", "um"), (Curve(pair.loads, swing, "", "blue"),)),
    )
    return Figure(
        f"transmission_error_summary_{name}",
        f"Transmission error of {name} over load",
        f"Pair {name}: mean and peak to peak of the loaded transmission error over one base pitch, for every load.",
        panels,
    )


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


def _figures(name: str, data: TransmissionErrorData, errors: Array | None) -> tuple[Figure, ...]:
    pair, curve = data.pair, data.curve
    drawn, i = drawn_loads(pair.loads, pair.nominal), pair.loads.index(pair.nominal)
    te, x, marks = data.exact[i], curve.x * 1e3, pitch_marks(pair, curve.x)
    over_pitch = Figure(
        f"transmission_error_{name}",
        f"Transmission error of pair {name}",
        f"Pair {name}: loaded transmission error over one base pitch (Harris map of its loads), and the mesh stiffness "
        f"at {pair.nominal:.5g} N: mean {te.average_stiffness * 1e-6:.4g} N/µm by the local slope. Peak to peak "
        f"{te.peak_to_peak * 1e6:.3g} µm, effective error A_e {te.effective_error * 1e6:.3g} µm.",
        (
            Panel(BASE_PITCH, Axis("transmission error", "um"), tuple(
                Curve(x, curve.transmission_error[:, k] * 1e6, label, role) for k, label, role in drawn
            ), marks),
            Panel(BASE_PITCH, Axis("mesh stiffness", "N/um", zero=True), (
                Curve(x, data.stiffness[:, i] * 1e-6, "secant stiffness", "secant"),
                Curve(x, curve.local_stiffness[:, i] * 1e-6, "local slope", "local slope"),
            ), marks),
        ),
        under=under(pair),
    )  # fmt: skip
    n = np.arange(1, _BARS + 1)
    amplitude = Axis("amplitude of the transmission error", "um, 0-peak")
    harmonics = Figure(
        f"transmission_error_harmonics_{name}",
        f"Harmonics of the transmission error of pair {name}",
        f"Pair {name}: harmonics of the static transmission error, integrated exactly between its jumps.",
        (
            Panel(Axis("harmonic of the tooth-mesh frequency", whole=True), amplitude, tuple(
                Bars(n, data.exact[k].series.amplitude[:_BARS] * 1e6, label, role,
                     None if errors is None or k != i else errors[:_BARS] * 1e6)
                for k, label, role in drawn
            )),
        ),
        under=under(pair),
    )  # fmt: skip
    several = (_over_load(name, pair, data.exact),) if len(pair.loads) > 1 else ()
    if data.rotational is None:
        return over_pitch, harmonics, *several
    cycles = pair.engagement.cycles
    order = np.arange(1, data.rotational.amplitude.size + 1) / cycles
    rotational = Figure(
        f"transmission_error_rotational_{name}",
        f"Rotational harmonics of the transmission error of pair {name}",
        f"Pair {name}: harmonics over the {cycles} base pitches after which the same teeth meet again, at "
        f"{pair.nominal:.5g} N. Whole numbers are harmonics of the tooth-mesh frequency, the others spacing errors.",
        (
            Panel(Axis("frequency over the tooth-mesh frequency"), amplitude, (
                Stems(order, data.rotational.amplitude * 1e6, "", "blue"),
            )),
        ),
        under=f"{pair.nominal:.5g} N",
    )  # fmt: skip
    return over_pitch, harmonics, *several, rotational


def _forecast(scene: Scene, name: str) -> Forecast:
    """One quadrature for each load, and the errors of the nominal one."""
    each = _ERROR + (_ERROR_CORNERS if scene.case.effects.corner_contact else 0.0)
    seconds = each * (forecasts.loads(scene, name) + 0.5)
    if scene.case.effects.spacing_errors:
        seconds += 0.03
    return Forecast({"loads": forecasts.loads(scene, name), "harmonics": 64}, seconds)


TRANSMISSION_ERROR = Stage(
    name="transmission-error",
    title="Transmission error",
    results=("transmission-error",),
    about="loaded transmission error, mesh stiffness, their harmonics, and both over load",
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
