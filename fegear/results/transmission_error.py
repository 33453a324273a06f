"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Bars, Curve, Figure, Panel, Stems
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Stage
from fegear.models.pair_checks import check_relief
from fegear.results import forecasts
from fegear.results.loaded_pair import (
    BASE_PITCH,
    EFFECTS,
    change_by_shifts,
    drawn_loads,
    loaded_pair,
    needs_pair,
    spur_pairs,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.contact import FourierSeries, Loaded, TransmissionError
    from fegear.engine.stage import Done, Progress
    from fegear.models.loaded_pair import LoadedPair

    Array = NDArray[np.float64]

HARMONICS = 64
#: Roll positions of the table over the base pitch; those on either side of every jump come in addition.
_POSITIONS = 200
#: Harmonics in the figure.
_BARS = 16
#: Largest number of base pitches over which rotational harmonics of spacing errors are computed.
_MOST_CYCLES = 10_000


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
    """

    pair: LoadedPair
    exact: tuple[TransmissionError, ...]
    curve: Loaded
    stiffness: Array
    rotational: FourierSeries | None


def secant_stiffness(loaded: Loaded) -> Array:
    """K_T = sum of K_Sj over the pairs in contact, with the secant compliances of their loads, shape (P, L) [N/m].

    It is W / transmission error of the same pairs without modifications and errors (Mark, A.11).
    """
    secant = loaded.grid.matrices.at_load(loaded.loads)
    active = loaded.loads > 0.0
    n = active.shape[0]
    c = np.where(active[:, None] & active[None, :], secant, np.eye(n)[:, :, None, None])
    right = np.moveaxis(active.astype(float), 0, -1)[..., None]
    return np.asarray(np.linalg.solve(np.moveaxis(c, (0, 1), (-2, -1)), right)[..., 0].sum(axis=-1))


def roll_positions(pair: LoadedPair) -> Array:
    """Evenly over one base pitch from the start of contact, and on either side of every jump [m]."""
    e = pair.engagement
    start, pitch = e.pair.x_start, e.pair.base_pitch
    beside = np.array([b + side * 1e-7 * pitch for b in e.breaks for side in (-1.0, 1.0)])
    x = np.concatenate([np.linspace(start, start + pitch, _POSITIONS + 1), beside])
    inside = (x > start + 0.5e-7 * pitch) & (x < start + (1.0 - 0.5e-7) * pitch)
    ends = np.array([start + 1e-7 * pitch, start + (1.0 - 1e-7) * pitch])
    return np.unique(np.concatenate([x[inside], ends]))


def _curve_table(name: str, title: str, curve: Loaded, stiffness: Array, i: int) -> Table:
    te = np.asarray(curve.transmission_error[:, i])
    return Table(
        name,
        (
            Column("x", curve.x, "mm", "roll position: the pair that is last to come into contact"),
            Column("te", te, "um", "loaded transmission error"),
            Column("mesh_stiffness", stiffness[:, i], "N/um", "secant, sum over the pairs in contact"),
            Column("pairs_in_contact", (curve.loads[:, :, i] > 0.0).sum(axis=0), "", "tooth pairs that carry load"),
            Column("local_stiffness", curve.local_stiffness[:, i], "N/um", "slope of load over transmission error"),
        ),
        title,
    )


def harmonics_table(name: str, title: str, series: FourierSeries, errors: Array | None, step: int = 1) -> Table:
    """Cosine, sine and amplitude of harmonics 1.. of a series."""
    n = np.arange(1, series.amplitude.size + 1)
    columns = [
        Column("n", n, "", "harmonic of the tooth-mesh frequency" if step == 1 else "harmonic of one base pitch cycle"),
        Column("cosine", series.cosine, "um", "factor of cos(2 pi n x / p_b), 0-peak"),
        Column("sine", series.sine, "um", "factor of sin(2 pi n x / p_b), 0-peak"),
        Column("amplitude", series.amplitude, "um", "0-peak"),
    ]
    if errors is not None:
        columns.append(Column("amplitude_error", errors, "um", "estimated error of amplitude"))
    return Table(name, tuple(columns), title)


@dataclass(frozen=True)
class Shifts:
    """Estimated errors of a transmission error's numbers, each the sum of the changes by the shifted compliances."""

    mean: float
    peak_to_peak: float
    effective: float
    amplitude: Array
    stiffness: float


def error_estimate(pair: LoadedPair, te: TransmissionError) -> Shifts | None:
    """Solve again at the same quadrature points with each compliance off by its error."""
    from fegear.contact.fourier import fourier_series

    if not pair.shifted:
        return None
    found = []
    for other in change_by_shifts(pair, te.loaded.grid, te.loaded):
        values = other.transmission_error[:, 0]
        again = replace(te, loaded=other, series=fourier_series(te.points, values, te.series.amplitude.size))
        found.append(
            (
                abs(again.mean - te.mean),
                abs(again.peak_to_peak - te.peak_to_peak),
                abs(again.effective_error - te.effective_error),
                np.abs(again.series.amplitude - te.series.amplitude),
                abs(_mean_stiffness(again) - _mean_stiffness(te)),
            )
        )
    return Shifts(
        sum(f[0] for f in found), sum(f[1] for f in found), sum(f[2] for f in found),
        np.sum([f[3] for f in found], axis=0), sum(f[4] for f in found),
    )  # fmt: skip


def _mean_stiffness(te: TransmissionError) -> float:
    return float(secant_stiffness(te.loaded)[:, 0] @ te.points.weights / te.points.period)


def te_values(prefix: str, te: TransmissionError, shifts: Shifts | None) -> tuple[Value, ...]:
    """The single numbers of a transmission error."""
    k, first = _mean_stiffness(te), float(te.series.amplitude[0])
    told = (
        ("te_mean", te.mean, "um", "mean transmission error over the base pitch"),
        ("te_peak_to_peak", te.peak_to_peak, "um", "largest less smallest"),
        ("te_effective", te.effective_error, "um", "A_e of NASA TM-89901, 0-peak"),
        ("te_first_harmonic", first, "um", "0-peak"),
        ("mesh_stiffness_mean", k, "N/um", "secant stiffness, mean"),
        ("local_stiffness_mean", te.average_stiffness, "N/um", "slope of load, mean"),
    )
    errors: tuple[float | None, ...] = (None,) * len(told)
    if shifts is not None:
        s = shifts
        local = s.stiffness / k * te.average_stiffness
        errors = (s.mean, s.peak_to_peak, s.effective, float(s.amplitude[0]), s.stiffness, local)
    return tuple(
        Value(f"{prefix}.{key}", value, unit, error, meaning)
        for (key, value, unit, meaning), error in zip(told, errors, strict=True)
    )


def _run(_scene: Scene, name: str, done: Done, progress: Progress) -> Outcome:
    from fegear.contact import revolution, transmission_error
    from fegear.contact.transmission_error import pair_stiffness

    pair = loaded_pair(done, name)
    e = pair.engagement
    exact = []
    for number, load in enumerate(pair.loads):
        exact.append(transmission_error(e, load, HARMONICS))
        progress((number + 1) / (len(pair.loads) + 2))
    curve = e.solve(e.grid(roll_positions(pair)), pair.loads)
    stiffness = secant_stiffness(curve)
    i = pair.loads.index(pair.nominal)
    te, shifts = exact[i], error_estimate(pair, exact[i])
    title = f"Transmission error of {name} over one base pitch"
    tables = [
        _curve_table(f"transmission_error_{name}", f"{title}, {pair.nominal:.6g} N", curve, stiffness, i),
        harmonics_table(
            f"transmission_error_harmonics_{name}",
            f"Harmonics of the transmission error of {name}",
            te.series,
            None if shifts is None else shifts.amplitude,
        ),
    ]
    if len(pair.loads) > 1:
        tables.append(_summary_over_loads(name, pair, exact))
        parts = [_curve_table("", "", curve, stiffness, k) for k in range(len(pair.loads))]
        joined = (
            Column(c.name, np.concatenate([np.asarray(p.columns[k].values) for p in parts]), c.unit, c.meaning)
            for k, c in enumerate(parts[0].columns)
        )
        total = Column("total_load", np.repeat(pair.loads, curve.x.size), "N", "along the line of action")
        tables.append(Table(f"transmission_error_loads_{name}", (total, *joined), f"{title}, every load (Harris map)"))
    values = [*te_values(name, te, shifts)]
    mean_compliance = pair_stiffness(e, pair.nominal, HARMONICS).mean_compliance
    relative = None if shifts is None else shifts.mean / te.mean
    values.append(
        Value(
            f"{name}.mesh_compliance_mean",
            mean_compliance,
            "um/N",
            None if relative is None else relative * mean_compliance,
            "mean of 1/K_T, perfect flanks with every pair of the path in contact (Mark, A.11)",
        )
    )
    remarks, rotational = [], None
    if e.driver_spacing.size or e.driven_spacing.size:
        cycles = e.cycles
        if cycles > _MOST_CYCLES:
            remarks.append(
                f"Pair {name}: the teeth meet again only after {cycles} base pitches, more than the {_MOST_CYCLES} "
                "over which rotational harmonics of spacing errors are computed, so these are left out. Give the "
                "errors of one gear alone to see its harmonics."
            )
        else:
            rotational = revolution(e, pair.nominal, cycles, 3 * cycles)
            tables.append(_rotational_table(name, rotational, cycles))
            low = rotational.amplitude[: cycles - 1]
            if low.size:
                values.append(
                    Value(
                        f"{name}.te_largest_rotational",
                        float(low.max()),
                        "um",
                        None,
                        f"0-peak, harmonic {int(low.argmax()) + 1} of {cycles} base pitches",
                    )
                )
    data = TransmissionErrorData(pair, tuple(exact), curve, stiffness, rotational)
    settings = {"harmonics": HARMONICS, "positions": _POSITIONS}
    figures = _figures(name, data, None if shifts is None else shifts.amplitude)
    return Outcome(data, tuple(tables), tuple(values), settings, tuple(remarks), figures)


def _summary_over_loads(name: str, pair: LoadedPair, exact: list[TransmissionError]) -> Table:
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
        ),
        f"Transmission error of {name} for every load",
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
    te, x = data.exact[i], curve.x * 1e3
    over_pitch = Figure(
        f"transmission_error_{name}",
        f"Transmission error of {name}",
        f"Pair {name}: loaded transmission error over one base pitch (Harris map of its loads), and the mesh stiffness "
        f"at {pair.nominal:.5g} N: mean {te.average_stiffness * 1e-6:.4g} N/µm by the local slope. Peak to peak "
        f"{te.peak_to_peak * 1e6:.3g} µm, effective error A_e {te.effective_error * 1e6:.3g} µm.",
        (
            Panel(BASE_PITCH, Axis("transmission error", "um"), tuple(
                Curve(x, curve.transmission_error[:, k] * 1e6, label, role) for k, label, role in drawn
            )),
            Panel(BASE_PITCH, Axis("mesh stiffness", "N/um", zero=True), (
                Curve(x, data.stiffness[:, i] * 1e-6, "secant stiffness", "secant"),
                Curve(x, curve.local_stiffness[:, i] * 1e-6, "local slope", "local slope"),
            )),
        ),
    )  # fmt: skip
    n = np.arange(1, _BARS + 1)
    amplitude = Axis("amplitude of the transmission error", "um, 0-peak")
    harmonics = Figure(
        f"transmission_error_harmonics_{name}",
        f"Harmonics of the transmission error of {name}",
        f"Pair {name}: harmonics of the static transmission error, integrated exactly between its jumps.",
        (
            Panel(Axis("harmonic of the tooth-mesh frequency", whole=True), amplitude, tuple(
                Bars(n, data.exact[k].series.amplitude[:_BARS] * 1e6, label, role,
                     None if errors is None or k != i else errors[:_BARS] * 1e6)
                for k, label, role in drawn
            )),
        ),
    )  # fmt: skip
    if data.rotational is None:
        return over_pitch, harmonics
    cycles = pair.engagement.cycles
    order = np.arange(1, data.rotational.amplitude.size + 1) / cycles
    rotational = Figure(
        f"transmission_error_rotational_{name}",
        f"Rotational harmonics of the transmission error of {name}",
        f"Pair {name}: harmonics over the {cycles} base pitches after which the same teeth meet again, at "
        f"{pair.nominal:.5g} N. Whole numbers are harmonics of the tooth-mesh frequency, the others spacing errors.",
        (
            Panel(Axis("frequency over the tooth-mesh frequency"), amplitude, (
                Stems(order, data.rotational.amplitude * 1e6, "", "blue"),
            )),
        ),
    )  # fmt: skip
    return over_pitch, harmonics, rotational


TRANSMISSION_ERROR = Stage(
    name="transmission-error",
    title="Transmission error",
    results=("transmission-error",),
    subjects=spur_pairs,
    run=_run,
    needs=needs_pair,
    check=check_relief,
    effects=EFFECTS,
    forecast=forecasts.transmission_error,
)
