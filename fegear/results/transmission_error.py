"""Stage ``transmission-error``: loaded transmission error, mesh stiffness and harmonics over one base pitch."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Figure, Panel, Stems
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.models.pair_checks import check_relief
from fegear.results import forecasts
from fegear.results.error_over_pitch import (
    AMPLITUDE,
    ErrorOverPitch,
    error_figures,
    error_tables,
    error_values,
    mesh_compliance_value,
)
from fegear.results.loaded_pair import EFFECTS, needs_pair, plane_pairs
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
    bridged = e.pair.contact_ratio >= 1.0
    compliance = pair_stiffness(e, pair.nominal, HARMONICS).mean_compliance if bridged else None
    shift = transmission_error_shift(exact[i], pair.shifted)
    by_mark = mark_data(e, exact[i], asked.part.terms) if asked.part.method == "mark-series" else None
    return TransmissionErrorData(
        pair, tuple(exact), curve, secant_stiffness(curve), rotational, shift, compliance, by_mark
    )


def _shown(name: str, data: TransmissionErrorData) -> ErrorOverPitch:
    from fegear.contact.mesh_curve import mean_secant_stiffness

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
