"""Stage ``gauge``: strain under a gauge in a root fillet over the rotation of its gear, and what was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import about
from fegear.base.printed import figures, percent, with_rough_error
from fegear.case.built.gauges import Gauge, check_gauge, gauge_of, seconds_of_bridges, sharper_strain
from fegear.case.built.neglected_effects import including, remark
from fegear.case.effects import EffectsPart
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, EveryLoad, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.pair.followed_gauge import gauge_in_plane, gauge_on_face
from fegear.results.pair.gauge_data import GaugeData
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauge_row import GaugeRow, gauge_rows
from fegear.results.pair.gauges_together import GaugeGain, of_all_gauges
from fegear.results.pair.half_bridge import HalfBridge
from fegear.results.pair.loaded_teeth import check_teeth, kind_of, loaded_teeth, needs_teeth
from fegear.results.pair.over_loads import OVER_LOADS
from fegear.results.pair.placed_gauge import (
    DASHED,
    DOTTED,
    LEFT_OUT,
    MEASURED,
    RESIDUAL,
    TIMES_SCALE,
    behind_low_pass,
    better_described,
    compared,
    comparison_table,
    comparison_values,
)
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.pair.trace_levels import over_torque

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.gauge_strain import GaugeHistory, StrainWith
    from fegear.engine.sheet.seen import Seen
    from fegear.results.pair.gauge_data import GaugePlace

#: Seconds of both fillets over the path.
_SECONDS = 0.4
#: Change of the peak by an effect that is off above which it is said beside it.
_SAID = 0.01
#: Of 3D gears, for each load: both fillets of both solutions.
_SECONDS_WIDE = 0.5


@dataclass(frozen=True)
class GaugeInputs:
    """What this stage reads.

    Parameters
    ----------
    gauge : Gauge
    speed : float or None
        Of its gear [rad/s].
    estimates : bool
        Whether errors are estimated.
    wide : bool
        Whether its gear is 3D.
    sharper : str
        What makes the computed strain more accurate.
    name : str
    finer : str
        Remedy where its estimated error exceeds the tolerance; of 3D gears.
    tolerance : float
    effects : EffectsPart
        All of the case, for remedies.
    halves : int
        2 of a double helical pair, whose teeth are one half.
    neglected : bool
        Whether it is looked at what effects that are off would change.
    in_bridge : bool
        Whether it is the second gauge of a half bridge.
    """

    gauge: Gauge
    speed: float | None
    estimates: bool
    wide: bool
    sharper: str = field(compare=False)
    name: str = field(compare=False)
    finer: str = field(compare=False, default="")
    tolerance: float = 1.0
    effects: EffectsPart = field(compare=False, default_factory=lambda: EffectsPart())
    halves: int = 1
    neglected: bool = False
    in_bridge: bool = False


def _inputs(scene: Scene, name: str) -> GaugeInputs:
    gauge = gauge_of(scene, name)
    speed, pair = scene.case.pair[gauge.pair].speed, scene.pairs[gauge.pair]
    if speed is not None and gauge.member == "driven":
        speed /= pair.ratio
    in_bridge = name in seconds_of_bridges(scene)
    wide, sharper = gauge.pair in scene.wide_pairs, sharper_strain(scene, gauge.pair)
    finer = sharper
    if wide and scene.width_of(gauge.pair) != "slices":
        finer = f"increase load_distribution.positions ({scene.case.load_distribution.positions})"
    return GaugeInputs(
        gauge, speed, scene.estimates, wide, sharper, name, finer, scene.case.accuracy.tolerance, scene.case.effects,
        scene.case.pair[gauge.pair].halves,
        scene.sizes_neglected or (scene.estimates and (gauge.measured is not None or in_bridge)),  # for the verdict
        in_bridge,
    )  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gauge = gauge_of(scene, name)
    second = (Task("gauge", gauge.second),) if gauge.second else ()
    return (*needs_teeth(scene, gauge.pair), *kind_of(scene, gauge.pair).solutions(gauge.gear), *second)


def _compute(asked: GaugeInputs, upstream: Upstream, _work: Work) -> GaugeData:
    gauge, teeth = asked.gauge, loaded_teeth(upstream, asked.gauge.pair)
    followed = (
        gauge_on_face(gauge, upstream, neglected=asked.neglected) if asked.wide else
        gauge_in_plane(gauge, upstream, estimates=asked.estimates, neglected=asked.neglected)
    )  # fmt: skip
    at, bridge = teeth.loads.index(teeth.nominal), None
    if gauge.second:
        other: GaugeData = upstream[Task("gauge", gauge.second)]
        bridge = HalfBridge.of(gauge.second, followed.history, other.history, at, followed.more, other.with_effects)
    history = bridge.history if bridge else followed.history
    strain = history.strain[:, at]
    speed = gauge.trace_speed or asked.speed
    found = compared(gauge, history.angle, strain, speed)
    opposite, pair = None if bridge else history.strain_opposite[:, at], history.pair
    better = better_described(gauge, found, pair, history.angle, strain, opposite)
    neglected, of_trace = (
        {effect: one for effect, one in more.items() if abs(one.change) > asked.tolerance}
        for more in (followed.more, bridge.with_effects if bridge else followed.more)
    )
    levels = over_torque(gauge, found, history, teeth.loads, at)
    torques = {} if levels else _torques(history, teeth.loads, at, asked.halves)  # a measured torque is known
    return GaugeData(
        teeth.loads, at, followed.history, followed.place.place, followed.clearance, followed.place.clipped,
        gauge.load_tolerance, asked.speed, found,
        Otherwise(
            better, gauge.side, pair.gear(gauge.member).teeth, torques, gauge.second,
            0.0 if bridge else _other_fillet(history, at, free=found is not None and "offset" in found.fit),
            behind_low_pass(gauge, found, better, history.angle, strain), speed,
            pair.mate(gauge.member).teeth, gauge.over_time,
        ),
        gauge.measured.reading if gauge.measured else "", asked.estimates, asked.sharper,
        levels, {effect: one.change for effect, one in neglected.items()},
        including(dict.fromkeys([*neglected, *of_trace]), asked.effects), _gains(gauge, found, of_trace), bridge,
        followed.more if asked.in_bridge else {},
    )  # fmt: skip


def _other_fillet(history: GaugeHistory, at: int, *, free: bool) -> float:
    """Strain of an equal gauge in the other fillet over that of the gauge, in size, by least squares over the curve.

    Peaks have another ratio: the strain before and after the contact of the tooth has one sign in both fillets.

    Parameters
    ----------
    history : GaugeHistory
    at : int
        Number of the load.
    free : bool
        Whether an offset is fitted.
    """
    rotation = np.linspace(history.angle[0], history.angle[-1], 2 * history.angle.size)  # samples are uniform in it
    own, other = (np.interp(rotation, history.angle, of[:, at]) for of in (history.strain, history.strain_opposite))
    if free:
        own, other = own - own.mean(), other - other.mean()
    return abs(float(own @ other / (own @ own)))


def _gains(gauge: Gauge, found: FittedCurve | None, more: dict[str, StrainWith]) -> dict[str, float]:
    """Relative change of measured / computed strain with each further effect; empty without a trace."""
    if found is None or not found.gain:
        return {}
    fits = {effect: compared(gauge, one.angle, one.strain) for effect, one in more.items()}
    return {effect: one.gain / found.gain - 1.0 for effect, one in fits.items() if one is not None}


def _torques(history: GaugeHistory, loads: Sequence[float], at: int, halves: int) -> dict[str, float]:
    """Peak under each other load of the pair over that under the nominal one, by its torque on the driver."""
    peaks = [float(history.strain[history.peak_position(i), i]) for i in range(len(loads))]
    lever = history.pair.driver.base_radius * halves
    return {f"{figures(loads[i] * lever, 5)} N m": peak / peaks[at] for i, peak in enumerate(peaks) if i != at}


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


def _subject(seen: Seen) -> str:
    """Whose trace it is."""
    data: GaugeData = seen.data
    return f"Gauge {seen.name} less {data.bridge.second}" if data.bridge else f"Gauge {seen.name}"


def _fact(seen: Seen) -> GaugeGain | PlannedGauge | None:
    """What the gauge adds to the sentence about all of them; None without a verdict."""
    data: GaugeData = seen.data
    return data.beside_others(seen.asked.gauge)


def _by_placement(seen: Seen) -> list[str]:
    """How the peak changes with the place of the grid."""
    data: GaugeData = seen.data
    said = data.planned(seen.name).by_placement
    return [f"Gauge {seen.name}: displaced within its tolerance the peak changes by {said}."] if said else []


def _title_of_all(seen: Seen) -> str:
    """What the table of all gauges has: before there are traces no measured strain."""
    data: GaugeData = seen.data
    return f"{'Computed' if data.compared is None else 'Measured and computed'} strain of all gauges"


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


_SHEET = Sheet(
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
        *comparison_values(),
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
        lambda seen: [f"{_subject(seen)}: {seen.data.judged}."] if seen.data.judged else [],
        lambda seen: [f"{_subject(seen)}: {seen.data.linearity}."] if seen.data.linearity else [],
        _peaks,
        _by_placement,
        figure="gauge_{name}", rank=lambda seen: seen.data.urgency,
        overview=gauge_rows("gauges", _title_of_all, _rows),
        fact=_fact, common=of_all_gauges,
    ),
    remarks=(
        Remark(lambda seen: about(_subject(seen), seen.data.verdict), when="verdict"),
        Remark(lambda seen: about(_subject(seen), seen.data.linearity), when="linearity"),
        Remark(_neglected, each=lambda seen: list(seen.data.neglected.items())),
        Remark(
            lambda seen: f"Gauge {seen.name}: peak strain has an estimated error of {percent(_part(seen))} (tolerance "
            f"{percent(seen.asked.tolerance)}); {seen.asked.finer}.",
            when=lambda seen: seen.asked.wide and _part(seen) > seen.asked.tolerance,
        ),
        Remark("Gauge {name}: {d.over_torque.off_nominal}.", when="over_torque.off_nominal"),
        Remark("Gauge {name}: {d.over_torque.left_out}.", when="over_torque.left_out"),
        Remark("Gauge {name}: {d.drifts}.", when="drifts"),
        Remark("Gauge {name}: {d.runout}.", when="runout"),
        Remark("Gauge {name}: {d.unsteady}.", when="unsteady"),
        Remark("Gauge {name}: {d.hum}.", when="hum"),
        Remark("Gauge {name}: {d.steps}.", when="steps"),
        Remark("Gauge {name}: {d.without}.", when="without"),
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


def _check(scene: Scene, name: str) -> None:
    check_gauge(scene, name)
    check_teeth(scene, gauge_of(scene, name).pair)


def _cites(_scene: Scene, _name: str) -> Iterator[Citation]:
    yield from ROOT_STRESS_CITATIONS["fe"]
    yield Citation("iso-6336-3", "30 degree tangent (internal gears: 60 degree)", "clause 6")


def _forecast(scene: Scene, name: str) -> Forecast:
    """Both fillets over the path, and once more for each error of a compliance."""
    pair = gauge_of(scene, name).pair
    if pair in scene.wide_pairs:
        return forecasts.constant(_SECONDS_WIDE * forecasts.loads(scene, pair))
    return forecasts.constant(_SECONDS * (0.5 + 0.25 * forecasts.engagements(scene, pair)))


GAUGE = Stage(
    subjects=lambda scene: tuple(scene.case.gauge),
    every_load=True,
    answers=("root tension",),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
