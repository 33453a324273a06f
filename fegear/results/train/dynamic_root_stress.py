"""Stage ``dynamic-root-stress``: root stress of one tooth of either gear under the forces of the moving train."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from fegear.case.built.members import gear_name
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.case.built.train import train_part
from fegear.case.reading import Scene
from fegear.dynamics.train.single_tooth import ToothRootStress
from fegear.dynamics.train.tooth_force import ToothForce
from fegear.engine.citation import Citation
from fegear.engine.declared import axis_of, column_of, columns_of, drawn
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, Member
from fegear.results import forecasts
from fegear.results.gear.drawing import path_marks
from fegear.results.gear.solved_gear import solution_of
from fegear.results.pair.root_stress_data import ending, told
from fegear.results.pair.root_stress_history import (
    cited_sources,
    formula_remarks,
    needs_sources,
    seconds_of,
    stress_sources,
    table_names,
)
from fegear.results.train.gear_train import RPM, needs_one_speed, needs_plane_teeth, own_meshes
from fegear.results.train.tooth_force import ToothForceData, others_of, over_time, rippled


@dataclass(frozen=True)
class DynamicRootStress:
    """Root stress of one tooth of either gear over the positions of the force, by every source, and their notes."""

    force: ToothForceData
    stress: Mapping[Member, Mapping[str, ToothRootStress]]
    notes: Mapping[Member, Mapping[str, tuple[str, ...]]]


def _check(scene: Scene, name: str) -> None:
    needs_one_speed(scene, name)
    needs_plane_teeth(scene, name, "results", '"dynamic-root-stress"')
    check_formulas(scene, train_part(scene).pair_of(name), tips=False)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (Task("tooth-force", name), *needs_sources(scene, train_part(scene).pair_of(name)))


@dataclass(frozen=True)
class DynamicRootInputs:
    """What the dynamic root stress of a mesh depends on besides forces and influence functions.

    Parameters
    ----------
    speed : float
        Of the body that speeds refer to [rad/s].
    coupled : bool
        Whether the loads of the teeth around count.
    sources : tuple of str
        Of root stress; the first is the result.
    mesh, pair : str
    gears, labels : mapping of str to str
        Names of the gears, and ends of the tables' names, by member.
    """

    speed: float
    coupled: bool
    sources: tuple[str, ...]
    mesh: str
    pair: str
    gears: Mapping[Member, str]
    labels: Mapping[Member, str] = field(compare=False)


def _inputs(scene: Scene, name: str) -> DynamicRootInputs:
    pair = train_part(scene).pair_of(name)
    gears = {member: gear_name(scene, pair, member) for member in MEMBERS}
    labels = {member: label.removeprefix(f"{pair}_") for member, label in table_names(scene, pair).items()}
    coupled, speed = scene.case.effects.neighbour_coupling, scene.case.dynamics.one_speed
    return DynamicRootInputs(speed, coupled, stress_sources(scene, pair), name, pair, gears, labels)


def _compute(asked: DynamicRootInputs, upstream: Upstream, work: Work) -> DynamicRootStress:
    from fegear.dynamics.train.single_tooth import forces_around, tooth_root_stress

    data: ToothForceData = upstream[Task("tooth-force", asked.mesh)]
    mesh = data.train.meshes[data.mesh]
    solved = {} if FINITE_ELEMENTS not in asked.sources else {g: solution_of(upstream, g) for g in asked.gears.values()}
    stress: dict[Member, dict[str, ToothRootStress]] = {member: {} for member in MEMBERS}
    notes: dict[Member, dict[str, tuple[str, ...]]] = {member: {} for member in MEMBERS}
    around: dict[int, dict[int, ToothForce]] = {}
    for member in MEMBERS:
        gear, role = asked.gears[member], mesh.role(member)
        for name in asked.sources:
            source = root_stress_source(name, asked.pair, gear, mesh.pair, role, solved, tips=False)
            reach = source.reach if asked.coupled else 0
            if reach not in around:
                around[reach] = forces_around(
                    data.train, data.mesh, data.force, data.number, asked.speed, data.harmonics, reach
                )
            stress[member][name] = tooth_root_stress(source, mesh.pair, role, around[reach])
            notes[member][name] = source.remarks
        work.progress((1 + MEMBERS.index(member)) / len(MEMBERS))
    return DynamicRootStress(data, stress, notes)


def _present(made: DynamicRootStress, asked: DynamicRootInputs) -> Outcome:
    name, force, tables, values = asked.mesh, made.force.force, [], []
    for member, found in made.stress.items():
        gear = asked.gears[member]
        columns = list(columns_of(force, "time", "x"))
        for k, (source, s) in enumerate(found.items()):
            end, by = ending(asked.sources, k), told(source)
            known = not np.isnan(s.error).any()
            columns += [
                column_of(
                    s,
                    "total",
                    name=f"stress{end}",
                    meaning=f"maximum root stress (tension side) by {by}, excited by all meshes",
                ),
                column_of(s, "own", name=f"stress_own_mesh{end}"),
                column_of(s, "static", name=f"static_stress{end}"),
            ]
            if known:
                left = f"estimated error of {by} in stress_own_mesh{end}"
                columns.append(column_of(s, "error", name=f"stress_error{end}", meaning=left))
            alone = len(made.force.train.exciters) == 1
            others, more = others_of(made.force.train), rippled(made.force.train)
            largest = [("", s.total, "" if alone else f"all meshes{more}, at the phases of the case, ")]
            if not alone:
                largest += [
                    ("_any_phase", s.any_phase, f"upper bound over all phases of {others}, "),
                    ("_own_mesh", s.own, f"without {others}, "),
                ]
            values += [
                Value(f"{name}.{member}.largest_dynamic_root_tension{which}{end}", float(np.fmax.reduce(of)), "MPa",
                      float(s.error[at] * of[at] / s.own[at]) if known else None,
                      f"gear {gear}, {by}, {meaning}contact at x = {force.x[at] * 1e3:.5g} mm")
                for which, of, meaning in largest for at in (int(np.argmax(np.where(np.isnan(of), -np.inf, of))),)
            ]  # fmt: skip
        title = f"Dynamic root stress of gear {gear} as {member}, mesh {name}"
        tables.append(Table(f"root_stress_history_{name}_{asked.labels[member]}", tuple(columns), title))
    notes = {asked.gears[member]: found for member, found in made.notes.items()}
    remarks = formula_remarks(asked.pair, notes, coupled=asked.coupled)
    settings: dict[str, object] = {"root_stress": list(asked.sources)}
    return Outcome(made, tuple(tables), tuple(values), settings, remarks, (_figure(made, asked),))


def _figure(data: DynamicRootStress, asked: DynamicRootInputs) -> Figure:
    force, train = data.force.force, data.force.train
    name, x, panels = asked.mesh, drawn(force, "x"), []
    others = len(train.exciters) > 1
    for member, found in data.stress.items():
        curves = []
        for k, (source, s) in enumerate(found.items()):
            by = f", {told(source)}" if len(found) > 1 else ""
            curves.append(Curve(x, drawn(s, "own"), f"static and own increment{by}", f"series:{k}"))
            if k == 0:
                if others:
                    total = Curve(x, drawn(s, "total"), f"with {others_of(train)}{by}", "with other meshes", width=1.2)
                    curves.append(total)
                curves.append(Curve(x, drawn(s, "static"), f"quasi-static{by}", "static"))
        marks = path_marks(train.meshes[data.force.mesh].pair)
        stress = axis_of(ToothRootStress, "total", zero=True)
        title = f"Gear {asked.gears[member]} as {member}"
        panels.append(Panel(over_time(force), stress, tuple(curves), marks, title))
    return Figure(
        f"dynamic_root_stress_{name}",
        f"Dynamic root stress of mesh {name}",
        f"Mesh {name}: root stress of one tooth of each gear over the engagement, with and without vibration. A to "
        "E: points of the path of contact.",
        tuple(panels),
        under=f"{asked.speed * RPM:.6g} rpm",
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """Root stress from influence functions or formulas, and the neighbours' forces."""
    sources = stress_sources(scene, train_part(scene).pair_of(name))
    return forecasts.constant((0.12 if scene.case.effects.neighbour_coupling else 0.04) + seconds_of(sources))


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield Citation("mark", "root stress of a single tooth in motion", "Eq. 3.37")
    yield from cited_sources(scene, train_part(scene).pair_of(name))


DYNAMIC_ROOT_STRESS = Stage(
    holds=("root-stress-history",),
    subjects=own_meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
