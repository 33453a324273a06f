"""Stage ``dynamic-strain``: strain under a gauge in a root fillet in the vibrating train, and what was measured."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.effects import RootEffects
from fegear.base.errors import InputError
from fegear.base.notes import about
from fegear.base.printed import percent
from fegear.case.built.gauges import check_gauge, gauge_of, seconds_of_bridges, sharper_strain
from fegear.case.built.neglected_effects import including, remark
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.train import train_part
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.solved_gear import needs_solution, solid_solution_of, solution_of
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauge_row import GaugeRow, gauge_rows
from fegear.results.pair.gauge_said import by_placement, subject, title_of_all, trace_remarks
from fegear.results.pair.gauges_together import GaugeGain, of_all_gauges
from fegear.results.pair.loaded_teeth import kind_of, loaded_pair, loaded_teeth, needs_teeth
from fegear.results.pair.placed_gauge import (
    LEFT_OUT,
    MEASURED,
    RESIDUAL,
    TIMES_SCALE,
    behind_low_pass,
    better_described,
    compared,
    comparison_table,
    comparison_values,
    gauges_on,
    placed_gauge,
    placed_on_face,
)
from fegear.results.pair.planned_gauges import PlannedGauge
from fegear.results.train.dynamic_strain_data import DynamicStrain, DynamicStrainInputs
from fegear.results.train.gear_train import ORDINARY_ROOTS, RPM, needs_one_speed, own_meshes

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.gauge_strain import StrainWith
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.dynamics.train.tooth_strain import ToothStrain
    from fegear.engine.sheet.seen import Seen
    from fegear.results.train.tooth_force import ToothForceData

#: Seconds of the forces on a tooth and on those around it.
_SECONDS = 0.3


def _mesh(scene: Scene, name: str) -> str:
    """Mesh of the train that loads a gauge."""
    pair = gauge_of(scene, name).pair
    part = train_part(scene)
    for mesh in own_meshes(scene):
        if part.pair_of(mesh) == pair:
            return mesh
    raise InputError(
        f"gauge.{name}.pair", f'"{pair}"', "is not a mesh of the train with solved teeth",
        "add the mesh to [train] or remove dynamic-strain from results",
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _mesh(scene, name)
    needs_one_speed(scene, name)
    check_gauge(scene, name)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gauge, force = gauge_of(scene, name), Task("tooth-force", _mesh(scene, name))
    second = (Task("dynamic-strain", gauge.second),) if gauge.second else ()
    if gauge.pair in scene.wide_pairs:
        return (force, *second, *needs_teeth(scene, gauge.pair), *kind_of(scene, gauge.pair).solutions(gauge.gear))
    teeth = needs_teeth(scene, gauge.pair) if _judged(scene, name) else ()
    return (force, *second, *teeth, *needs_solution(gauge.gear))


def _judged(scene: Scene, name: str) -> bool:
    """Whether a trace is compared that needs a verdict, and thus what the computation does not have."""
    return scene.estimates and (scene.case.gauge[name].measured is not None or name in seconds_of_bridges(scene))


def _inputs(scene: Scene, name: str) -> DynamicStrainInputs:
    part, gauge = scene.case.dynamics, gauge_of(scene, name)
    return DynamicStrainInputs(
        gauge, _mesh(scene, name), part.one_speed, part.positions,
        scene.case.effects.neighbour_coupling, RootEffects.of(scene.case.effects), gauge.pair in scene.wide_pairs,
        scene.case.pair[gauge.pair].halves, sharper_strain(scene, gauge.pair), name,
        bool(odd_gears_of(scene, gauge.pair)), _judged(scene, name), scene.case.accuracy.tolerance,
        name in seconds_of_bridges(scene), scene.case.effects,
    )  # fmt: skip


def _compute(asked: DynamicStrainInputs, upstream: Upstream, _work: Work) -> DynamicStrain:
    force: ToothForceData = upstream[Task("tooth-force", asked.mesh)]
    gauge = asked.gauge
    found = (_on_face if asked.wide else _in_plane)(asked, upstream, force)
    alone = len(force.train.exciters) == 1
    more = _neglected_of(asked, upstream) if asked.neglected else {}
    seen, displaced, of_trace = None, None, more
    if gauge.second:
        other: DynamicStrain = upstream[Task("dynamic-strain", gauge.second)]
        seen, displaced = found.less(other.found), found.less_displaced(other.found)
        peak = float(np.abs(seen.static).max())
        of_trace = {one: more[one].less(other.with_effects[one], peak) for one in more if one in other.with_effects}
    of = seen or found
    speed = gauge.trace_speed or of.speed
    measured = compared(gauge, of.angle, of.total, speed)
    better = better_described(gauge, measured, of.pair, of.angle, of.total)
    otherwise = Otherwise(
        better, gauge.side, of.pair.gear(of.member).teeth, second=gauge.second,
        low_pass=behind_low_pass(gauge, measured, better, of.angle, of.total), speed=speed,
        mate_teeth=of.pair.mate(of.member).teeth, over_time=gauge.over_time,
    )  # fmt: skip
    neglected, changes = (
        {effect: one.change for effect, one in each.items() if abs(one.change) > asked.tolerance}
        for each in (more, of_trace)
    )
    return DynamicStrain(
        found, alone, gauge.load_tolerance, measured, otherwise, asked.sharper if asked.wide else "", neglected,
        including(dict.fromkeys([*neglected, *changes]), asked.off), seen, displaced,
        more if asked.in_bridge else {}, {effect: 1.0 / (1.0 + change) - 1.0 for effect, change in changes.items()},
        force.train.meshes[force.mesh].force * found.pair.driver.base_radius,
    )  # fmt: skip


def _neglected_of(asked: DynamicStrainInputs, upstream: Upstream) -> Mapping[str, StrainWith]:
    """Quasi-static strain under the nominal load of the pair with each effect that is off."""
    gauge = asked.gauge
    if asked.wide:
        from fegear.contact.wide.gauge_on_face import wide_gauge_neglects

        wide = cast("LoadedWidePair", loaded_teeth(upstream, gauge.pair))
        body = solid_solution_of(upstream, gauge.gear)
        place = placed_on_face(gauge, body, wide.pair.gear(gauge.member))
        return wide_gauge_neglects(wide, gauge.member, gauge.side, gauge.grid, place.middle, gauge.z, body)
    from fegear.contact.plane.gauge_history import gauge_neglects

    teeth, solved = loaded_pair(upstream, gauge.pair), solution_of(upstream, gauge.gear)
    place = placed_gauge(gauge, solved)
    grids, opposite = gauges_on(gauge, place, solved)
    own = grids.only(int(np.argmin(np.abs(place.displacement))))
    return gauge_neglects(teeth.spec, teeth.engagement, gauge.member, own, opposite, gauge.tooth)


def _in_plane(asked: DynamicStrainInputs, upstream: Upstream, force: ToothForceData) -> ToothStrain:
    from fegear.dynamics.train.tooth_strain import tooth_strain

    gauge, mesh = asked.gauge, force.train.meshes[force.mesh]
    solved = solution_of(upstream, gauge.gear)
    place = placed_gauge(gauge, solved)
    gauges = gauges_on(gauge, place, solved)[0]
    number = gauge.tooth if mesh.error.pitches > 1 else 0
    return tooth_strain(
        force.train, force.mesh, mesh.role(gauge.member), gauges, place.displacement, asked.speed,
        asked.positions, force.harmonics, number, coupled=asked.coupled, effects=asked.effects,
    )  # fmt: skip


def _on_face(asked: DynamicStrainInputs, upstream: Upstream, force: ToothForceData) -> ToothStrain:
    from fegear.contact.wide.gauge_on_face import gauge_about_load
    from fegear.dynamics.train.tooth_strain import strain_on_face

    gauge, mesh = asked.gauge, force.train.meshes[force.mesh]
    solved = solid_solution_of(upstream, gauge.gear)
    teeth = cast("LoadedWidePair", loaded_teeth(upstream, gauge.pair))
    place = placed_on_face(gauge, solved, teeth.pair.gear(gauge.member))
    known = gauge_about_load(
        teeth, gauge.member, gauge.side, gauge.grid, place.middle, place.displacement, gauge.z, solved,
        mesh.force / asked.halves or teeth.nominal,
    )  # fmt: skip
    return strain_on_face(
        force.train, force.mesh, mesh.role(gauge.member), known, place.displacement, asked.speed, asked.positions,
        force.harmonics,
    )  # fmt: skip


def _peak(seen: Seen) -> list[str]:
    speed = f"{seen.asked.speed * RPM:.6g} rpm"
    return [
        seen.said(
            f"Gauge {{name}} (gear {seen.asked.gauge.gear}) in motion at {speed}: peak strain "
            "{v[dynamic_peak_strain]}, {v[dynamic_strain_ratio]} times the quasi-static one."
        )
    ]


def _rows(seen: Seen) -> list[GaugeRow]:
    """The gauge beside other gauges."""
    data: DynamicStrain = seen.data
    return [GaugeRow.of(seen.name, data, data.torque, (data.seen or data.found).peak)]


def _of_all(gauges: Sequence[GaugeGain | PlannedGauge | None]) -> str:
    """Sentence about all gauges in motion; empty for none."""
    said = of_all_gauges(gauges)
    return f"In motion: {said[0].lower()}{said[1:]}" if said else ""


def _neglected(seen: Seen) -> str:
    """What an effect that is off would change, and the remedy."""
    effect, change = seen.one
    asked: DynamicStrainInputs = seen.asked
    said = f"the quasi-static peak strain by {percent(change, signed=True)}"
    return remark(f"Gauge {seen.name}, in motion", asked.off, asked.tolerance, effect, [said])


_SHEET = Sheet(
    tables=(
        Rows(
            "dynamic_strain_{name}", "Dynamic strain of gauge {name} over the rotation of the gear",
            (Every("strain"), Off("total", "error", name="strain")), of="found",
        ),
        comparison_table("dynamic_measured_{name}", "Measured and dynamic strain of gauge {name}"),
    ),
    values=(
        Number("peak", "found.peak_error", of="found"),
        Number("peak_angle", of="found"),
        Number("ratio", of="found"),
        Number("change_by_placement", of="found"),
        Number("bridge_peak", when="seen"),
        *comparison_values("dynamic_"),
    ),
    figures=(
        Chart(
            "dynamic_strain_{name}", "Dynamic strain of gauge {name}",
            "Gauge {name}: mean strain under the grid over the rotation of the gear, with and without vibration; its "
            "tooth in contact at the pitch point at zero.{d.drawn_as}",
            (
                Over(
                    "angle",
                    (
                        MEASURED, LEFT_OUT,
                        Line("own", "static and own increment", look={"markers": False}),
                        Line("total", "with other meshes", "with other meshes", look={"width": 1.2}, when="others"),
                        Line("static", "quasi-static", "static"),
                        Line(
                            "total", lambda seen: f"less gauge {seen.asked.gauge.second}", "series:5", of="seen",
                            look={"markers": False}, when="seen",
                        ),
                        *TIMES_SCALE,
                    ),
                    "total",
                    marks=lambda _seen: (Mark("y", 0.0),),
                ),
                RESIDUAL,
            ),
            of="found", under=lambda seen: f"{seen.asked.speed * RPM:.6g} rpm",
        ),
    ),
    answer=Answer(
        lambda seen: [f"{subject(seen)}, in motion: {seen.data.judged}."] if seen.data.judged else [],
        _peak,
        lambda seen: by_placement(seen, "dynamic peak"),
        figure="dynamic_strain_{name}", rank=lambda seen: seen.data.urgency,
        overview=gauge_rows("dynamic_gauges", lambda seen: title_of_all(seen, "dynamic"), _rows),
        fact=lambda seen: seen.data.beside_others(seen.asked.gauge), common=_of_all,
    ),
    remarks=(
        Remark(ORDINARY_ROOTS, when=lambda seen: seen.asked.odd),
        Remark(lambda seen: about(f"{subject(seen)}, in motion", seen.data.verdict), when="verdict"),
        Remark(_neglected, each=lambda seen: list(seen.data.neglected.items())),
        *trace_remarks("Gauge {name}, in motion"),
    ),
    sharper_by="",
)  # fmt: skip


def _cites(_scene: Scene, _name: str) -> Iterator[Citation]:
    yield Citation("mark", "root stress of a single tooth in motion", "Eq. 3.37")
    yield from ROOT_STRESS_CITATIONS["fe"]


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return forecasts.constant(_SECONDS)


DYNAMIC_STRAIN = Stage(
    subjects=lambda scene: tuple(scene.case.gauge),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
