"""Stage ``dynamic-root-stress``: root stress of one tooth of either gear under the forces of the moving train."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_inputs import gear_name
from fegear.models.train import train_part
from fegear.results import forecasts
from fegear.results.drawn_pair import LINE_OF_ACTION, path_marks
from fegear.results.gear_solution import needs_solution, solution_of
from fegear.results.root_stress_history import table_names
from fegear.results.train_parts import RPM, needs_one_speed, own_meshes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.dynamics.root_stress import ToothRootStress
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import Member
    from fegear.results.tooth_force import ToothForceData


@dataclass(frozen=True)
class DynamicRootStress:
    """Root stress of one tooth of either gear over the positions of the force."""

    force: ToothForceData
    stress: Mapping[Member, ToothRootStress]


def _check(scene: Scene, name: str) -> None:
    needs_one_speed(scene, name)
    if "root-stress-history" in scene.case.results:
        raise InputError(
            "results", '"root-stress-history"', "and dynamic-root-stress would write the same tables",
            "ask for dynamic-root-stress alone: it holds the quasi-static stress too",
        )  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    pair = scene.case.pair[train_part(scene).pair_of(name)]
    return (Task("tooth-force", name), *needs_solution(pair.driver, pair.driven))


@dataclass(frozen=True)
class DynamicRootInputs:
    """What the dynamic root stress of a mesh depends on besides forces and influence functions.

    Parameters
    ----------
    speed : float
        Of the body that speeds refer to [rad/s].
    coupled : bool
        Whether the loads of the teeth around count.
    mesh : str
    gears, labels : mapping of str to str
        Names of the gears, and ends of the tables' names, by member.
    """

    speed: float
    coupled: bool
    mesh: str
    gears: Mapping[Member, str]
    labels: Mapping[Member, str] = field(compare=False)


def _inputs(scene: Scene, name: str) -> DynamicRootInputs:
    pair = train_part(scene).pair_of(name)
    gears = {member: gear_name(scene, pair, member) for member in MEMBERS}
    labels = {member: label.removeprefix(f"{pair}_") for member, label in table_names(scene, pair).items()}
    coupled = scene.case.effects.neighbour_coupling
    return DynamicRootInputs(scene.case.dynamics.one_speed, coupled, name, gears, labels)


def _compute(asked: DynamicRootInputs, upstream: Upstream, work: Work) -> DynamicRootStress:
    from fegear.contact import finite_element_compliance
    from fegear.dynamics.root_stress import forces_around, tooth_root_stress

    data: ToothForceData = upstream[Task("tooth-force", asked.mesh)]
    mesh, stress = data.train.meshes[data.mesh], {}
    for member in MEMBERS:
        source = finite_element_compliance(solution_of(upstream, asked.gears[member]))
        reach = source.reach if asked.coupled else 0
        around = forces_around(data.train, data.mesh, data.force, data.number, asked.speed, data.harmonics, reach)
        stress[member] = tooth_root_stress(source, mesh.pair, mesh.role(member), around)
        work.progress(len(stress) / len(MEMBERS))
    return DynamicRootStress(data, stress)


def _present(made: DynamicRootStress, asked: DynamicRootInputs) -> Outcome:
    name, force, tables, values = asked.mesh, made.force.force, [], []
    for member, s in made.stress.items():
        gear = asked.gears[member]
        tables.append(
            Table(
                f"root_stress_history_{name}_{asked.labels[member]}",
                (
                    Column("t", force.time, "s", "from the mesh's phase zero"),
                    Column("x", force.x, "mm", "place of the tooth's contact on the line of action"),
                    Column("stress", s.total, "MPa", "largest root tension of the loaded tooth, all meshes' shares"),
                    Column("stress_own_mesh", s.own, "MPa", "without the other meshes' share"),
                    Column("static_stress", s.static, "MPa", "quasi-static"),
                    Column("stress_error", s.error, "MPa", "what the finite elements leave in stress_own_mesh"),
                ),
                f"Dynamic root stress of gear {gear} as {member}, mesh {name}",
            )
        )
        worst = int(np.argmax(s.own))
        values.append(
            Value(f"{name}.{member}.largest_dynamic_root_tension", float(s.own[worst]), "MPa", float(s.error[worst]),
                  f"gear {gear}, without the other meshes, contact at x = {force.x[worst] * 1e3:.5g} mm")
        )  # fmt: skip
    return Outcome(made, tuple(tables), tuple(values), figures=(_figure(made, asked.speed),))


def _figure(data: DynamicRootStress, speed: float) -> Figure:
    name, x, curves = data.force.train.names[data.force.mesh], data.force.force.x * 1e3, []
    for member, stress in data.stress.items():
        curves.append(Curve(x, stress.total * 1e-6, f"{member}, dynamic", member, dash="solid"))
        curves.append(Curve(x, stress.static * 1e-6, f"{member}, quasi-static", member, dash="dash", width=1.2))
    marks = path_marks(data.force.train.meshes[data.force.mesh].pair)
    return Figure(
        f"dynamic_root_stress_{name}",
        f"Dynamic root stress of mesh {name}",
        f"Mesh {name}: root stress of one tooth of either gear through its engagement, with and without vibration.",
        (Panel(LINE_OF_ACTION, Axis("largest root tension", "MPa", zero=True), tuple(curves), marks),),
        under=f"{speed * RPM:.6g} rpm",
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Root stress from the influence functions, whatever the compliances come from, and the neighbours' forces."""
    return forecasts.constant(0.12 if scene.case.effects.neighbour_coupling else 0.04)


DYNAMIC_ROOT_STRESS = Stage(
    name="dynamic-root-stress",
    title="Dynamic root stress",
    results=("dynamic-root-stress",),
    about="root stress of one tooth in motion",
    subjects=own_meshes,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=("neighbour_coupling",),
    cites=citing(Citation("mark", "root stress of a single tooth in motion", "section 3")),
    forecast=_forecast,
)
