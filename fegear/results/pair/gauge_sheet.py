"""What a gauge shows: its strain over the rotation, its place, the measured strain beside it, all gauges in a table."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.notes import Note, about
from fegear.base.printed import figures, percent, with_rough_error
from fegear.case.built.neglected_effects import remark
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, EveryLoad, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.pair.gauge_data import GaugeData, GaugeInputs
from fegear.results.pair.gauge_row import GaugeRow, gauge_rows
from fegear.results.pair.gauge_said import by_placement, subject, title_of_all, trace_remarks
from fegear.results.pair.gauges_together import GaugeGain, of_all_gauges
from fegear.results.pair.over_loads import OVER_LOADS
from fegear.results.pair.placed_gauge import (
    DASHED,
    DOTTED,
    LEFT_OUT,
    MEASURED,
    RESIDUAL,
    TIMES_SCALE,
    comparison_table,
    comparison_values,
)
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.pair.shared_cause import of_shared_cause

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen
    from fegear.results.pair.gauge_data import GaugePlace
    from fegear.results.pair.likeliest_flank import LikeliestFlank

#: Change of the peak by an effect that is off above which it is said beside it.
_SAID = 0.01


def _less(seen: Seen) -> list[str]:
    """What explains less of the trace than the likeliest cause."""
    ranked: LikeliestFlank | None = seen.data.otherwise.ranked
    said = "" if ranked is None else ranked.less
    return [f"{subject(seen)}: {said}."] if said else []


def _besides(seen: Seen) -> Note:
    """What explains less than the cause that the verdict names, or most where none explains the trace."""
    ranked: LikeliestFlank | None = seen.data.otherwise.ranked
    said = "" if ranked is None else ranked.less or ranked.said
    return about(subject(seen), Note(said)) if said else Note("")


def _peaks(seen: Seen) -> list[str]:
    """Peak strain and stress, each with its error where that takes digits that its single value has."""
    data: GaugeData = seen.data
    strain, stress = (
        f"{with_rough_error(peak[data.at] * scale, None if error is None else error[data.at] * scale)} {unit}"
        for peak, error, scale, unit in (
            (data.peak_strain, data.peak_error, 1e6, "µm/m"),
            (data.peak_stress, data.peak_stress_error, 1e-6, "MPa"),
        )
    )
    start = seen.said(f"Gauge {{name}} ({_where(seen.asked, data.place)}) at {{load:said}}")
    less = [
        f"{percent(abs(change))} {'less' if change < 0.0 else 'more'} with {effect}"
        for effect, change in data.neglected.items()
        if abs(change) > _SAID
    ]
    return [f"{start}: peak strain {strain}, peak stress {stress}{''.join(f', {one}' for one in less)}."]


def _neglected(seen: Seen) -> str:
    """What an effect that is off would change of the peak strain, and the remedy."""
    effect, change = seen.one
    data: GaugeData = seen.data
    size = f"{figures(change * float(data.peak_strain[data.at]) * 1e6, signed=True)} µm/m"
    asked: GaugeInputs = seen.asked
    said = f"the peak strain by {size} ({percent(abs(change))} of it)"
    return remark(f"Gauge {seen.name}", asked.effects, asked.tolerance, effect, [said])


def _rows(seen: Seen) -> list[GaugeRow]:
    """The gauge at the nominal load beside other gauges; before there is a trace at every load, ascending."""
    data: GaugeData = seen.data
    lever = data.history.pair.driver.base_radius * seen.asked.halves
    if data.compared is None:
        peaks = sorted(zip(data.loads, data.peak_strain.tolist(), strict=True))
        return [GaugeRow.of(seen.name, data, load * lever, peak) for load, peak in peaks]
    torque = data.loads[data.at] * lever
    return [GaugeRow.of(seen.name, data, torque, data.traced_peak)]


def _fact(seen: Seen) -> GaugeGain | PlannedGauge | None:
    """What the gauge adds to the sentence about all of them; None without a verdict."""
    data: GaugeData = seen.data
    return data.beside_others(seen.asked.gauge)


#: Of a history, in the order of its columns.
_CURVES = (
    "x", "angle", "roll_angle", "strain", "strain_opposite", "strain_towards_root", "strain_towards_tip",
)  # fmt: skip
_CIRCLES = {"size": 7.0, "symbol": "circle"}
#: Whether the file of the trace has several torques.
_SEVERAL = "over_torque.several"
_ERROR = Off("strain", "history.strain_error")


def _where(asked: GaugeInputs, place: GaugePlace) -> str:
    """Where a gauge is, as one would look for it on the gear."""
    gauge = asked.gauge
    face = f", {figures(place.z * 1e3)} mm from the middle of the common face" if asked.wide else ""
    return (
        f"gear {gauge.gear}, tooth {gauge.tooth + 1}, {gauge.side} side, tangent at "
        f"{math.degrees(place.tangent_angle):.3g}°, diameter {place.diameter * 1e3:.5g} mm{face}"
    )


def _part(seen: Seen) -> float:
    """Estimated error of the peak strain at the nominal load, relative; zero where it is not known."""
    data: GaugeData = seen.data
    error = data.peak_error
    return 0.0 if error is None else float(error[data.at] / abs(data.peak_strain[data.at]))


GAUGE_SHEET = Sheet(
    loads="loads",
    nominal="at",
    tables=(
        Rows(
            "gauge_{name}", "Strain of gauge {name} over the rotation of the gear, {load:said}",
            (Cell("t", of=lambda seen: seen.data), *_CURVES, "stress", _ERROR), of="history",
        ),
        EveryLoad(
            "gauge_loads_{name}", "Strain of gauge {name} for every load", _CURVES, "history", OVER_LOADS
        ),
        Rows(
            "gauge_places_{name}", "Peak strain of gauge {name} over the position of the grid",
            ("displacement", "peak"), of="places",
        ),
        comparison_table("gauge_measured_{name}", "Measured and computed strain of gauge {name}"),
        Rows(
            "gauge_torques_{name}", "Measured and computed strain of gauge {name} for every measured torque",
            (
                "torque", "mean_torque", "turns", "samples", "computed_peak", "measured_peak", "gain", "gain_scatter",
                "gain_at_mean", "rms", "correlation",
            ),
            of="over_torque.levels",
        ),
    ),
    values=(
        Number("peak_strain", "peak_error"),
        Number("peak_stress", "peak_stress_error"),
        Number("strain_range"),
        Number("peak_angle"),
        Number("peak_x"),
        Number("peak_strain_opposite"),
        Number("fillet_ratio"),
        Number("peak_change_by_placement"),
        Number("bridge_peak", when="bridge"),
        Number("arc", exact, of="place"),
        Number("diameter", exact, of="place"),
        Number("tangent_angle", exact, of="place"),
        Number("centre_angle", exact, of="place"),
        Number("z", exact, of="place", when=lambda seen: seen.asked.wide),
        *comparison_values(fit="described"),
        Number("change", of="over_torque", when=_SEVERAL),
    ),
    figures=(
        Chart(
            "gauge_{name}", "Strain of gauge {name}",
            "Gauge {name}: mean strain under the grid over the rotation of the gear, its tooth in contact at the pitch "
            "point at zero; grey: grid displaced by the placement tolerance, dashed towards the root, dotted towards "
            "the tip.{d.drawn_as}",
            (
                Over(
                    "angle",
                    (
                        MEASURED, LEFT_OUT,
                        Line(
                            "strain", lambda seen: f"gauge {seen.name}" if seen.data.bridge else "computed",
                            error="history.strain_error", look={"markers": False},
                        ),
                        Line(
                            "strain", lambda seen: f"computed, less gauge {seen.data.bridge.second}", "series:5",
                            error="bridge.history.strain_error", of="bridge.history", look={"markers": False},
                            when="bridge",
                        ),
                        *TIMES_SCALE,
                        Line("strain_towards_root", "grid towards the root", "grey", look=DASHED),
                        Line("strain_towards_tip", "grid towards the tip", "grey", look=DOTTED),
                        Line("strain_opposite", "opposite fillet", "series:2", look={"width": 1.2}),
                    ),
                    "strain",
                    marks=lambda _seen: (Mark("y", 0.0),),
                ),
                RESIDUAL,
            ),
            of="history", under="{load:said}",
        ),
        Chart(
            "gauge_places_{name}", "Peak strain over the position of gauge {name}",
            "Gauge {name}: peak strain with the grid displaced along the fillet within the placement tolerance.",
            (Over("displacement", (Line("peak"),), marks=lambda _seen: (Mark("x", 0.0),)),),
            of="places", under="{load:said}",
        ),
        Chart(
            "gauge_torques_{name}", "Strain of gauge {name} over torque",
            "Gauge {name}: peak strain over torque, measured (by the fitted curve) and computed, and their ratio with "
            "two standard errors, the computed strain in proportion to the mean of the measured torque.",
            (
                Over(
                    "torque",
                    (
                        Line("measured_peak", "measured", "series:1", kind="points", look=_CIRCLES),
                        Line("computed_peak", "computed", look={"markers": False}),
                    ),
                ),
                Over(
                    "torque", (Line("gain_at_mean", error="over_torque.bands"),), marks=lambda _seen: (Mark("y", 1.0),),
                ),
            ),
            of="over_torque.levels", when=_SEVERAL,
        ),
    ),
    answer=Answer(
        lambda seen: [f"{subject(seen)}: {seen.data.judged}."] if seen.data.judged else [],
        _less,
        lambda seen: [f"{subject(seen)}: {seen.data.linearity}."] if seen.data.linearity else [],
        _peaks,
        lambda seen: by_placement(seen, "peak"),
        figure="gauge_{name}", rank=lambda seen: seen.data.urgency,
        overview=gauge_rows("gauges", lambda seen: title_of_all(seen, "computed"), _rows),
        fact=_fact, common=of_all_gauges, across=of_shared_cause,
    ),
    remarks=(
        Remark(lambda seen: about(subject(seen), seen.data.verdict), when="verdict"),
        Remark(_besides, when=lambda seen: bool(_besides(seen))),
        Remark(lambda seen: about(subject(seen), seen.data.linearity), when="linearity"),
        Remark(_neglected, each=lambda seen: list(seen.data.neglected.items())),
        Remark(
            lambda seen: f"Gauge {seen.name}: peak strain has an estimated error of {percent(_part(seen))} (tolerance "
            f"{percent(seen.asked.tolerance)}); {seen.asked.finer}.",
            when=lambda seen: seen.asked.wide and _part(seen) > seen.asked.tolerance,
        ),
        Remark("Gauge {name}: {d.over_torque.off_nominal}.", when="over_torque.off_nominal"),
        Remark("Gauge {name}: {d.over_torque.left_out}.", when="over_torque.left_out"),
        *trace_remarks("Gauge {name}"),
        Remark("Gauge {name}: file of the trace read with {d.reading}.", when="reading"),
        Remark(
            lambda seen: f"Gauge {seen.name}: the contact comes within {seen.data.clearance:.2f} modules of the grid; "
            "strain at the lowest contact is not resolved; move the gauge towards the root.",
            when="near_contact",
        ),
        Remark(
            lambda seen: f"Gauge {seen.name}: placement_tolerance reaches beyond the fillet; displacements from "
            f"{seen.data.history.displacement[0] * 1e3:.3g} to {seen.data.history.displacement[-1] * 1e3:.3g} mm only.",
            when="clipped",
        ),
    ),
    sharper_by="",
)  # fmt: skip
