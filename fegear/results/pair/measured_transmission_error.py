"""Stage ``measured-transmission-error``: traces of encoders beside the computed transmission error of their pair."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import about, failing
from fegear.base.printed import figures
from fegear.case.built.encoders import Encoders, encoders_of, pair_of_encoders
from fegear.contact.trace_causes import Causes
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import ALL, Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.pair.causes_of_error import causes_of_error
from fegear.results.pair.error_otherwise import OtherwiseError, counted, orders_of_mate
from fegear.results.pair.error_over_torques import one_filter, torque_of_gain
from fegear.results.pair.likeliest_flank import LikeliestFlank
from fegear.results.pair.loaded_teeth import loaded_teeth, needs_teeth
from fegear.results.pair.measured_error_data import MeasuredErrorData, TraceBeside
from fegear.results.pair.placed_gauge import TIMES, comparison_values
from fegear.results.pair.shared_cause import NamedCause, of_shared_cause

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.encoders import ErrorTrace
    from fegear.case.reading import Scene
    from fegear.contact.error_over_pitch import ErrorOverPitch
    from fegear.contact.measured_error import MeasuredError

_DOTS = {"size": 5.0, "symbol": "circle"}


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    pair = pair_of_encoders(scene, name)
    return (Task("transmission-error", pair), *needs_teeth(scene, pair))


def _measured(trace: ErrorTrace, teeth: int, mate_teeth: int) -> MeasuredError:
    from fegear.contact.measured_error import (
        FEWEST_A_TOOTH,
        FEWEST_PITCHES,
        ShortTraceError,
        UnevenTraceError,
        measured_error,
    )

    try:
        return measured_error(trace.angle, trace.te, teeth, mate_teeth)
    except UnevenTraceError as uneven:
        raise InputError(
            f"{trace.key}.file", f'"{trace.file}"', str(uneven), "specify a trace in one direction without gaps"
        ) from None
    except ShortTraceError as short:
        if short.pitches < FEWEST_PITCHES:
            rule = f"covers {short.pitches:.3g} tooth pitches, fewer than {FEWEST_PITCHES}"
            raise InputError(
                f"{trace.key}.file",
                f'"{trace.file}"',
                rule,
                "specify at least one revolution, or check the unit of the angle",
            ) from None
        raise InputError(
            f"{trace.key}.file", f'"{trace.file}"',
            f"has {short.samples:.3g} samples per tooth pitch, fewer than {FEWEST_A_TOOTH}", "sample more often",
        ) from None  # fmt: skip


def _compute(asked: Encoders, upstream: Upstream, _work: Work) -> MeasuredErrorData:
    from fegear.contact.fitted_error import behind_low_pass, beside_computed, better_described

    found: ErrorOverPitch = upstream[Task("transmission-error", asked.pair)].found
    pair, nominal = found.pair, float(found.te_peak_to_peak[found.at])
    relative = None if found.shift is None or not nominal else found.shift.peak_to_peak / nominal
    lever = pair.driver.base_radius * asked.halves
    both = [abs(gear.teeth) for gear in (pair.driver, pair.driven)]
    teeth = both if asked.member == "driver" else both[::-1]
    traces = []
    for trace in asked.traces:
        at = min(range(len(found.loads)), key=lambda i: abs(found.loads[i] - trace.load))
        measured = _measured(trace, *teeth)
        fitted = beside_computed(measured, found.x, found.te[:, at], pair.base_pitch, asked.fit)
        others = {
            "" if i == at else f"{figures(load * lever, 5)} N m": found.te[:, i] for i, load in enumerate(found.loads)
        }
        better = better_described(measured, fitted, found.x, others, pair.base_pitch, asked.fit)
        of_mate = teeth[1] if orders_of_mate(measured, teeth[1]) else 0
        behind = None
        counts = "" if of_mate else counted(measured)
        if not (better or of_mate or counts) and trace.angle[-1] > trace.angle[0]:  # time goes with the angle
            behind = behind_low_pass(measured, fitted, found.x, found.te[:, at], pair.base_pitch, asked.fit)
        otherwise = OtherwiseError(better, of_mate, pair.ratio if trace.of_angle else 0.0, behind, trace.speed, counts)
        order = np.argsort(found.loads)
        gains = [beside_computed(measured, found.x, found.te[:, i], pair.base_pitch, asked.fit).gain for i in order]
        torques = np.array(found.loads)[order] * lever
        amplitude: Array = found.series[at].amplitude[: measured.n.size]
        size = float(found.te_peak_to_peak[at])
        traces.append(
            TraceBeside(
                measured, fitted, amplitude, None if relative is None else relative * size,
                trace.load * lever, trace.load, size, asked.load_tolerance,
                trace.reading, asked.estimates, otherwise, torque_of_gain(torques, np.array(gains), trace.load * lever),
            )
        )  # fmt: skip
    lags = [
        None if filtered is None else filtered.lag / (one.otherwise.speed or 1.0)
        for one in traces for filtered in (one.otherwise.low_pass,)
    ]  # fmt: skip
    if not one_filter(lags):
        traces = [replace(one, otherwise=replace(one.otherwise, low_pass=None)) for one in traces]
    causes = causes_of_error(traces, loaded_teeth(upstream, asked.pair), asked.fit) if asked.estimates else Causes()
    traces = [one.beside_cause(causes.best) for one in traces]
    measured_at = tuple(one.torque for one in traces)
    flank = LikeliestFlank(causes, pair, measured_at, traces[-1].computed_peak_to_peak)
    return MeasuredErrorData(traces, asked.member, flank)


def _mesh_orders(seen: Seen) -> list[Mark]:
    """Multiples of the number of teeth, the first with its word."""
    one: TraceBeside = seen.one
    teeth, last = one.found.teeth, float(one.drawn_order[-1])
    count = int(last // teeth)
    return [Mark("x", float(k * teeth), "mesh" if k == 1 else f"{k}") for k in range(1, count + 1)]


def _runouts(seen: Seen) -> list[str]:
    """What there is once per revolution of either gear at the largest torque."""
    data: MeasuredErrorData = seen.data
    names = ("driver", "driven gear") if data.shaft == "driver" else ("driven gear", "driver")
    said = data.last.runout_said(*names)
    return [f"Encoders {seen.name}: {said}."] if said else []


def _cause(seen: Seen) -> NamedCause | None:
    """What explains the traces, to be said with gauges; None for none."""
    flank: LikeliestFlank = seen.data.flank
    return NamedCause("encoders", seen.name, seen.asked.pair, flank) if flank.as_likely else None


_TORQUE = Cell("torque")
_SHEET = Sheet(
    tables=(
        Rows(
            "measured_te_summary_{name}", "Measured and computed transmission error of {name} for every torque",
            (
                "torque", "load", "measured_peak_to_peak", "computed_peak_to_peak", "ratio", "spread", "pitches",
                "turns", "largest_order", "largest_amplitude", "runout", "runout_angle", "mate_runout",
                "mate_runout_angle", "fitted.offset", "fitted.scale", "fitted.shift",
                "fitted.gain", "fitted.gain_error", "fitted.rms", "fitted.correlation",
            ),
            of="traces",
        ),
        Rows(
            "measured_te_{name}", "Measured and computed transmission error of {name} over one tooth pitch",
            (
                _TORQUE, "fitted.angle", "fitted.measured", "fitted.computed", "fitted.residual",
            ),
            stacked="traces",
        ),
        Rows(
            "measured_te_harmonics_{name}", "Measured and computed mesh harmonics of {name}",
            (_TORQUE, "n", "measured_amplitude", "computed_amplitude"), stacked="traces",
        ),
        Rows(
            "measured_te_orders_{name}", "Order spectrum of the measured transmission error of {name}",
            (_TORQUE, "found.spectrum.order", "found.spectrum.amplitude", "found.spectrum.phase"), stacked="traces",
        ),
    ),
    values=(
        Number("measured_peak_to_peak", of="last", meaning="peak to peak of the measured mesh curve at the largest "
               "torque of the traces"),
        Number("computed_peak_to_peak", "last.computed_error", of="last"),
        Number("ratio", of="last", name="measured_to_computed"),
        Number("spread", of="last", name="spread_between_teeth"),
        Number("largest_order", exact, of="last", name="largest_other_order"),
        Number("largest_amplitude", of="last", name="largest_other_amplitude"),
        *(Number(one, of="last") for one in ("runout", "runout_angle", "mate_runout", "mate_runout_angle")),
        *comparison_values(at="last.fitted", fit="described"),
    ),
    figures=(
        Chart(
            "measured_te_{name}", "Measured transmission error of {name}",
            "{name}: measured transmission error (mean of all teeth, less slow parts and fitted offset, by the fitted "
            "shift) and the computed one over one tooth pitch of the shaft; thin line: the computed one times the "
            "fitted scale; below: what that leaves of the measured one.",
            (
                Over(
                    "fitted.angle",
                    (
                        Line("fitted.as_measured", "measured", "series:1", kind="points", look=_DOTS),
                        Line("fitted.computed", "computed", look={"markers": False}),
                        Line(
                            "fitted.fitted", "computed times the fitted scale {one.fitted.scale:.3f}", "series:3",
                            look=TIMES, when=lambda seen: "scale" in seen.one.fitted.fit,
                        ),
                    ),
                    "fitted.as_measured",
                ),
                Over(
                    "fitted.angle",
                    (Line("fitted.left_by_fit", "measured less fitted", "series:1", kind="points", look=_DOTS),),
                    marks=lambda _seen: (Mark("y", 0.0),),
                ),
            ),
            views="traces", view="{one.torque:.4g}",
        ),
        Chart(
            "measured_te_orders_{name}", "Orders of the measured transmission error of {name}",
            "{name}: order spectrum of the measured transmission error over whole revolutions of the shaft "
            "(amplitudes); dashed: multiples of the mesh order.",
            (
                Over("drawn_order", (Line("drawn_amplitude", kind="stems"),), marks=_mesh_orders),
            ),
            views="traces", view="{one.torque:.4g}",
        ),
        Chart(
            "measured_te_harmonics_{name}", "Mesh harmonics of {name} over torque",
            "{name}: amplitudes of the first mesh harmonics over torque, measured (circles) and computed (lines).",
            (
                Over(
                    Axis("torque on the driver", "N.m"),
                    (
                        Bundle(
                            Family("over_torque", "{one.n}", most=ALL),
                            (
                                Line("computed", "harmonic {one.n}, computed", x="torque", look={"markers": False}),
                                Line("measured", "harmonic {one.n}, measured", x="torque", kind="points",
                                     look={"symbol": "circle", "size": 7.0}),
                            ),
                        ),
                    ),
                ),
            ),
            when="several",
        ),
    ),
    answer=Answer(
        lambda seen: [f"Encoders {seen.name}: {seen.data.flank.agrees}."] if seen.data.flank.agrees else [],
        lambda seen: [f"Encoders {seen.name}: {seen.data.judged}."] if seen.data.judged else [],
        lambda seen: [f"Encoders {seen.name}: {seen.data.flank.less}."] if seen.data.flank.less else [],
        lambda seen: [f"Encoders {seen.name}: {seen.data.common_cause}."] if seen.data.common_cause else [],
        "Encoders {name} at {d.last.torque:.4g}, peak-to-peak values: measured {v[measured_peak_to_peak]} (includes "
        "noise), computed {v[computed_peak_to_peak]}.",
        _runouts,
        lambda seen: [] if seen.data.last.by_runout or seen.data.last.largest_order is None else [seen.said(
            "Encoders {name}: largest order besides the mesh harmonics: {v[largest_other_order]}, amplitude "
            "{v[largest_other_amplitude]}."
        )],
        figure="measured_te_{name}", rank=lambda seen: seen.data.urgency, fact=_cause, across=of_shared_cause,
    ),
    remarks=(
        Remark(lambda seen: about(f"Encoders {seen.name}", seen.data.flank.said), when="flank.said"),
        Remark(
            lambda seen: about(f"Encoders {seen.name}, {seen.one.torque:.5g} N m", seen.one.verdict), each="traces",
            when=lambda seen: bool(seen.one.verdict) and not seen.data.flank.agrees,
        ),
        Remark(lambda seen: failing(f"Encoders {seen.name}: {seen.data.common_cause}."), when="common_cause"),
        Remark(
            lambda seen: f"Encoders {seen.name}{seen.one[0]}: file read with {seen.one[1]}.", each="readings",
        ),
        Remark(
            lambda seen: f"Encoders {seen.name}, {seen.one.torque:.5g} N m: {seen.one.found.spikes} samples are spikes "
            "and left out.",
            each="traces", when=lambda seen: seen.one.found.spikes > 0,
        ),
        Remark(
            lambda seen: f"Encoders {seen.name}, {seen.one.torque:.5g} N m: {seen.one.steps}.",
            each="traces", when=lambda seen: bool(seen.one.steps),
        ),
        Remark(
            lambda seen: f"Encoders {seen.name}, {seen.one.torque:.5g} N m: {seen.one.few_samples}.",
            each="traces", when=lambda seen: bool(seen.one.few_samples),
        ),
    ),
    sharper_by="",
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    encoders_of(scene, name)


MEASURED_TRANSMISSION_ERROR = Stage(
    subjects=lambda scene: tuple(scene.case.encoders),
    every_load=True,
    answers=("transmission error",),
    needs=_needs,
    inputs=encoders_of,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("mark", "static transmission error and its Fourier series", "1.1 to 1.32")),
    forecast=lambda _scene, _name: forecasts.constant(0.02),
)
