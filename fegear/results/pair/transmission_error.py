"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch.

Mesh stiffness and transmission error evenly spaced over one tooth of the driver, for programs that want them so.

Curves of a transmission error have their rows where they bend and jump. Programs that integrate a train read a table of
even steps and repeat it. What even steps lose is said: their means are compared with those of the curves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.loaded_teeth import HARMONICS, MOST_CYCLES, ErrorOverPitch
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, columns_of, curve_of, drawn, error_column, value_of
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Bars, Stems
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Reads, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import (
    BASE_PITCH,
    check_teeth,
    drawn_loads,
    loaded_teeth,
    over_loads,
    pitch_marks,
    teeth_stage,
    under_load,
)

if TYPE_CHECKING:
    from fegear.case.loading import TransmissionErrorPart
    from fegear.case.reading import Scene
    from fegear.contact.fourier import FourierSeries
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.results.pair.mark_transmission_error import MarkData


#: What is tabulated.
_NAMES = ("te", "mesh_stiffness", "local_stiffness")


def mesh_table(name: str, e: ErrorOverPitch, count: int) -> tuple[Table, list[str]]:
    """The table of a pair at its nominal load, and what is to be said of it.

    Parameters
    ----------
    name : str
        Of the pair.
    e : ErrorOverPitch
    count : int
        Rows over the base pitch; the one that would repeat the first is not among them.
    """
    pitch = e.pair.base_pitch
    part = np.arange(count) / count
    angle = part * pitch / e.pair.driver.base_radius
    even = {key: over_pitch(e.x, getattr(e, key)[:, e.at], pitch, part) for key in _NAMES}
    columns = [Column("driver_angle", angle, "deg", "of the driver, from where the curve of the base pitch begins")]
    columns += [column_of(e, key, even[key]) for key in _NAMES]
    if e.te_error is not None:
        columns.append(column_of(e, "te_error", over_pitch(e.x, e.te_error, pitch, part)))
    slope = float(e.local_stiffness_mean[e.at])
    lost = {
        "transmission error": even["te"].mean() / float(e.te_mean[e.at]) - 1.0,
        "slope stiffness": even["local_stiffness"].mean() / slope - 1.0,
    }
    means = " and ".join(f"that of the {what} by {share:+.1e}" for what, share in lost.items())
    said = (
        f"Pair {name}: the table mesh_table_{name} has {count} even steps over one tooth of the driver, "
        f"{np.degrees(pitch / e.pair.driver.base_radius):.6g} degrees, and repeats from there. Its means differ from "
        f"those of the curves: {means}; more even_positions bring them nearer."
    )
    title = f"Mesh of {name} over one tooth of the driver, {e.load:.6g} N"
    return Table(f"mesh_table_{name}", tuple(columns), title, matlab=True), [said]


def over_pitch(x: Array, values: Array, pitch: float, part: Array) -> Array:
    """A curve straight between its rows and periodic, at parts of the base pitch counted from its first row."""
    inside = x < x[0] + pitch
    at, found = np.append(x[inside], x[0] + pitch), np.append(values[inside], values[0])
    return np.asarray(np.interp(x[0] + part * pitch, at, found))


#: One engagement solved over a base pitch [s], what corners off the path add to it, and a pair with a width.
_ERROR, _ERROR_CORNERS, _WIDE = 0.015, 0.05, 0.1
#: Harmonics in the figure.
_BARS = 16
#: Single numbers.
_VALUES = ("te_mean", "te_peak_to_peak", "te_effective", "te_first_harmonic", "mesh_stiffness_mean",
           "local_stiffness_mean")  # fmt: skip
#: Ordinate of harmonics.
AMPLITUDE = Axis("amplitude of the transmission error", "um, 0-peak")


@dataclass(frozen=True)
class TransmissionErrorData:
    """Transmission error of loaded teeth, and Mark's series at the nominal load where the case asks for it."""

    found: ErrorOverPitch
    by_mark: MarkData | None


def _compute(asked: Reads[TransmissionErrorPart], upstream: Upstream, work: Work) -> TransmissionErrorData:
    teeth = loaded_teeth(upstream, asked.name)
    found, by_mark = teeth.transmission_error(work.progress), None
    if asked.part.method == "mark-series":
        from fegear.results.pair.mark_transmission_error import mark_data

        by_mark = mark_data(cast("LoadedPair", teeth), asked.part.terms)
    return TransmissionErrorData(found, by_mark)


def _present(data: TransmissionErrorData, inputs: Reads[TransmissionErrorPart]) -> Outcome:
    name, e = inputs.name, data.found
    tables, values, remarks = _tables(name, e), _values(name, e), _remarks(name, e)
    settings: dict[str, object] = {"harmonics": e.series[e.at].amplitude.size, "positions": e.positions}
    figures: tuple[Figure | DeferredFigure, ...] = (_over_pitch(name, e), _harmonics(name, e))
    if len(e.loads) > 1:
        figures = (*figures, _over_load(name, e))
    if e.rotational is not None:
        tables.append(_rotational_table(name, e.rotational, e.cycles))
        low = e.rotational.amplitude[: e.cycles - 1]
        if low.size:
            where = f"0-peak, harmonic {int(low.argmax()) + 1} of {e.cycles} base pitches"
            values.append(Value(f"{name}.te_largest_rotational", float(low.max()), "um", None, where))
        figures = (*figures, _rotational_figure(name, e, e.rotational))
    if (count := inputs.part.even_positions) is not None:
        table, said = mesh_table(name, e, count)
        tables.append(table)
        remarks += said
    if data.by_mark is not None:
        from fegear.results.pair.mark_transmission_error import present_mark

        more = present_mark(name, data.by_mark, e.rotational)
        tables += more.tables
        values += more.values
        remarks += more.remarks
        figures = (*figures, *more.figures)
        settings |= more.settings
    return Outcome(data, tuple(tables), tuple(values), settings, tuple(remarks), figures)


def _tables(name: str, e: ErrorOverPitch) -> list[Table]:
    """The curve, its harmonics, and both over the loads."""
    title = f"Transmission error of {name} over one base pitch"
    curve = columns_of(e, table="pitch", load=e.at)
    if e.te_error is not None:
        curve = (*curve, column_of(e, "te_error"))
    tables = [Table(f"transmission_error_{name}", curve, f"{title}, {e.load:.6g} N"), _harmonics_table(name, e)]
    if len(e.loads) > 1:
        summary = [replace(one, name="local_stiffness") if one.name == "local_stiffness_mean" else one
                   for one in columns_of(e, "total_load", table="loads")]  # fmt: skip
        tables.append(
            Table(f"transmission_error_summary_{name}", tuple(summary), f"Transmission error of {name} for every load")
        )
        every = over_loads(e.loads, [columns_of(e, table="pitch", load=k) for k in range(len(e.loads))])
        tables.append(Table(f"transmission_error_loads_{name}", every, f"{title}, every load (Harris map)"))
    return tables


def _harmonics_table(name: str, e: ErrorOverPitch) -> Table:
    """Cosine, sine and amplitude of harmonics 1.. of the series."""
    series = e.series[e.at]
    n = np.arange(1, series.amplitude.size + 1)
    columns = [
        Column("n", n, "", "harmonic of the tooth-mesh frequency"),
        Column("cosine", series.cosine, "um", "factor of cos(2 pi n x / p_b), 0-peak"),
        Column("sine", series.sine, "um", "factor of sin(2 pi n x / p_b), 0-peak"),
        Column("amplitude", series.amplitude, "um", "0-peak"),
    ]
    if e.shift is not None:
        columns.append(error_column(columns[-1], e.shift.amplitude))
    return Table(
        f"transmission_error_harmonics_{name}", tuple(columns), f"Harmonics of the transmission error of {name}"
    )


def _values(name: str, e: ErrorOverPitch) -> list[Value]:
    """The single numbers of a transmission error at the nominal load."""
    errors: dict[str, float | None] = {}
    if (s := e.shift) is not None:
        errors = {
            "te_mean": s.mean, "te_peak_to_peak": s.peak_to_peak, "te_effective": s.effective,
            "te_first_harmonic": float(s.amplitude[0]) if s.amplitude.size else 0.0,
            "mesh_stiffness_mean": s.stiffness,
            "local_stiffness_mean": s.stiffness / e.mesh_stiffness_mean * float(e.local_stiffness_mean[e.at]),
        }  # fmt: skip
        if e.mesh_compliance_mean is not None:  # taken to be that of the mean transmission error
            errors["mesh_compliance_mean"] = s.mean / float(e.te_mean[e.at]) * e.mesh_compliance_mean
    names = _VALUES if e.mesh_compliance_mean is None else (*_VALUES, "mesh_compliance_mean")
    return [value_of(e, key, name, errors.get(key), load=e.at) for key in names]


def _remarks(name: str, e: ErrorOverPitch) -> list[str]:
    """What is not given of the numbers, and why."""
    remarks = []
    if e.mesh_compliance_mean is None:
        remarks.append(
            f"Pair {name}: {name}.mesh_compliance_mean, Mark's mean of 1/K_T of perfect flanks, is not given: with "
            f"a contact ratio of {e.pair.contact_ratio:.4g} tip corners alone carry where no pair is on the path of "
            "contact."
        )
    if e.rotational is None and e.cycles > MOST_CYCLES:
        remarks.append(
            f"Pair {name}: the teeth meet again only after {e.cycles} base pitches, more than the {MOST_CYCLES} "
            "over which rotational harmonics of spacing errors are computed, so these are neglected. Give the "
            "errors of one gear alone to see its harmonics."
        )
    if e.only is not None:
        remarks.append(
            f"Pair {name}: with spacing errors every base pitch has a transmission error of its own; this is "
            f"that of base pitch {e.only}, its harmonics are those of a pair that repeats it, and "
            "rotational harmonics are not computed over the face."
        )
    return remarks


def _over_pitch(name: str, e: ErrorOverPitch) -> Figure:
    i, of, marks = e.at, type(e), pitch_marks(e.pair, e.x)
    return Figure(
        f"transmission_error_{name}",
        f"Transmission error of pair {name}",
        f"Pair {name}: loaded transmission error over one base pitch (Harris map of its loads), and the mesh "
        f"stiffness at {e.load:.5g} N: mean {e.local_stiffness_mean[i] * 1e-6:.4g} N/µm by the local slope. Peak to "
        f"peak {e.te_peak_to_peak[i] * 1e6:.3g} µm, effective error A_e {e.te_effective[i] * 1e6:.3g} µm.",
        (
            Panel(BASE_PITCH, axis_of(of, "te"), tuple(
                curve_of(e, "x", "te", label, role, load=k) for k, label, role in drawn_loads(e.loads, e.load)
            ), marks),
            Panel(BASE_PITCH, axis_of(of, "mesh_stiffness", zero=True), (
                curve_of(e, "x", "mesh_stiffness", "secant stiffness", "secant", load=i),
                curve_of(e, "x", "local_stiffness", "local slope", "local slope", load=i),
            ), marks),
        ),
        under=under_load(e.loads),
    )  # fmt: skip


def _harmonics(name: str, e: ErrorOverPitch) -> Figure:
    n = np.arange(1, min(_BARS, e.series[e.at].amplitude.size) + 1)
    errors = None if e.shift is None else e.shift.amplitude[: n.size] * 1e6
    return Figure(
        f"transmission_error_harmonics_{name}",
        f"Harmonics of the transmission error of pair {name}",
        f"Pair {name}: harmonics of the static transmission error, {e.integrated}.",
        (
            Panel(Axis("harmonic of the tooth-mesh frequency", whole=True), AMPLITUDE, tuple(
                Bars(n, e.series[k].amplitude[: n.size] * 1e6, label, role, errors if k == e.at else None)
                for k, label, role in drawn_loads(e.loads, e.load)
            )),
        ),
        under=under_load(e.loads),
    )  # fmt: skip


def _over_load(name: str, e: ErrorOverPitch) -> Figure:
    """Mean and variation of the transmission error over the load."""
    of, torque = type(e), axis_of(type(e), "driver_torque")
    second = Scale(torque.label, torque.unit, e.loads, drawn(e, "driver_torque"))
    return Figure(
        f"transmission_error_summary_{name}",
        f"Transmission error of {name} over load",
        f"Pair {name}: mean and peak to peak of the loaded transmission error over one base pitch, for every load.",
        tuple(
            Panel(axis_of(of, "total_load", second=scale), axis_of(of, key), (curve_of(e, "total_load", key),))
            for key, scale in (("te_mean", second), ("te_peak_to_peak", None))
        ),
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


def _rotational_figure(name: str, e: ErrorOverPitch, series: FourierSeries) -> Figure:
    order = np.arange(1, series.amplitude.size + 1) / e.cycles
    return Figure(
        f"transmission_error_rotational_{name}",
        f"Rotational harmonics of the transmission error of pair {name}",
        f"Pair {name}: harmonics over the {e.cycles} base pitches after which the same teeth meet again, at "
        f"{e.load:.5g} N. Whole numbers are harmonics of the tooth-mesh frequency, the others spacing errors.",
        (
            Panel(Axis("frequency over the tooth-mesh frequency"), AMPLITUDE, (
                Stems(order, series.amplitude * 1e6, "", "blue"),
            )),
        ),
        under=f"{e.load:.5g} N",
    )  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    """One quadrature for each load of plane teeth, and the errors of the nominal one."""
    if name in scene.wide_pairs:
        return forecasts.constant(_WIDE)
    each = _ERROR + (_ERROR_CORNERS if scene.case.effects.corner_contact else 0.0)
    seconds = each * (forecasts.loads(scene, name) + 0.5)
    if scene.case.effects.spacing_errors:
        seconds += 0.03
    return Forecast({"loads": forecasts.loads(scene, name), "harmonics": HARMONICS}, seconds)


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    if name in scene.wide_pairs and scene.case.transmission_error.method == "mark-series":
        raise InputError(
            "transmission_error.method", '"mark-series"',
            f"is Mark's series of plane teeth, and pair {name} is loaded with its width", "remove it",
        )  # fmt: skip


TRANSMISSION_ERROR = teeth_stage(
    answers=("transmission error",),
    every_load=True,
    inputs=Reads.of(lambda scene: scene.case.transmission_error),
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(
        Citation("mark", "static transmission error, its Fourier series and the mean compliance", "1.1 to 1.32, A.11"),
        Citation("lin-townsend-oswald", "effective error A_e"),
        Citation("harris", "transmission error over the mesh cycle for a family of loads"),
    ),
    forecast=_forecast,
)
