"""Stage ``dynamic-root-stress``: root stress of one tooth of either gear under the forces of the moving train."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.errors import InputError
from fegear.models.pair_inputs import MEMBERS, gear_name
from fegear.models.train import train_part
from fegear.results import forecasts
from fegear.results.gear_solution import needs_solution
from fegear.results.mesh_forces import force_at, needs_one_speed, own_meshes, summed_harmonics
from fegear.results.root_stress_history import table_names

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.contact.fe_compliance import FiniteElementCompliance
    from fegear.dynamics.tooth_force import ToothForce
    from fegear.engine.stage import Done, Progress
    from fegear.fem import GearInfluence
    from fegear.geometry.pair import GearPair, Member
    from fegear.results.mesh_forces import ToothForceData

    Array = NDArray[np.float64]

#: Positions over the flank at which the finite elements' own error is asked for.
_FEW = 9


@dataclass(frozen=True)
class DynamicRootStress:
    """Root stress of one tooth of either gear; arrays over the positions of the force [Pa]."""

    force: ToothForceData
    static: dict[Member, Array]
    stress: dict[Member, Array]


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


def _neighbours(scene: Scene, data: ToothForceData, source: FiniteElementCompliance) -> dict[int, ToothForce]:
    """Forces on this tooth pair and, where teeth are coupled, on those around it at the same moment."""
    train, force = data.train, data.force
    around = {0: force}
    if not scene.case.effects.neighbour_coupling:
        return around
    part = scene.case.dynamics
    for k in range(-source.reach, source.reach + 1):
        if k:
            # k base pitches ahead at the same moment: it was at the pitch point that much earlier
            ahead = force.x + k * train.meshes[data.mesh].pair.base_pitch
            harmonics = summed_harmonics(scene, train)
            around[k] = force_at(train, data.mesh, part.one_speed, ahead, harmonics, data.number - k, other_phases=1)
    return around


def _kernels(
    source: FiniteElementCompliance, pair: GearPair, member: Member, around: dict[int, ToothForce]
) -> dict[int, Array]:
    """Stress along the fillet of the tooth looked at per unit force on each tooth around it, (points, n) [Pa/N]."""
    width = min(pair.driver.face_width, pair.driven.face_width)
    ahead = 1 if member == "driver" else -1  # tooth +1 is ahead of a driving tooth and behind a driven one
    found = {}
    for k, force in around.items():
        on_path = np.clip(force.x, pair.x_start, pair.x_end)
        found[k] = np.asarray(source.root_stress(-ahead * k, pair.radius(on_path, member), "tension")) / width
    return found


def _own_error(source: FiniteElementCompliance, pair: GearPair, member: Member, force: ToothForce) -> Array:
    """What the finite elements leave in the stress of the tooth's own load [Pa]."""
    x = np.linspace(pair.x_start, pair.x_end, _FEW)
    width = min(pair.driver.face_width, pair.driven.face_width)
    usual = source.influence.root_stress_error(0, "tension", pair.radius(x, member)) / width
    return np.asarray(np.interp(force.x, x, usual) * np.abs(force.total))


def _run(scene: Scene, name: str, done: Done, progress: Progress) -> Outcome:
    from fegear.contact import finite_element_compliance
    from fegear.dynamics.tooth_force import root_stress

    data = cast("ToothForceData", done[Task("tooth-force", name)].data)
    pair_name = train_part(scene).pair_of(name)
    mesh, force = data.train.meshes[data.mesh], data.force
    static: dict[Member, Array] = {}
    stress: dict[Member, Array] = {}
    tables, values, prefix = [], [], f"{pair_name}_"
    labels = table_names(scene, pair_name)
    for number, member in enumerate(MEMBERS):
        gear = gear_name(scene, pair_name, member)
        source = finite_element_compliance(cast("GearInfluence", done[Task("gear-solution", gear)].data))
        around = _neighbours(scene, data, source)
        kernels = _kernels(source, mesh.pair, mesh.role(member), around)
        stress[member] = root_stress({k: f.total + f.cross.sum(axis=0) for k, f in around.items()}, kernels)
        static[member] = root_stress({k: f.static for k, f in around.items()}, kernels)
        alone = root_stress({k: f.total for k, f in around.items()}, kernels)
        error = _own_error(source, mesh.pair, mesh.role(member), force)
        tables.append(
            Table(
                f"root_stress_history_{name}_{labels[member].removeprefix(prefix)}",
                (
                    Column("t", force.time, "s", "from the mesh's phase zero"),
                    Column("x", force.x, "mm", "place of the tooth's contact on the line of action"),
                    Column(
                        "stress", stress[member], "MPa", "largest root tension of the loaded tooth, all meshes' shares"
                    ),
                    Column("stress_own_mesh", alone, "MPa", "without the other meshes' share"),
                    Column("static_stress", static[member], "MPa", "quasi-static"),
                    Column("stress_error", error, "MPa", "what the finite elements leave in stress_own_mesh"),
                ),
                f"Dynamic root stress of gear {gear} as {member}, mesh {name}",
            )
        )
        worst = int(np.argmax(alone))
        values.append(
            Value(f"{name}.{member}.largest_dynamic_root_tension", float(alone[worst]), "MPa", float(error[worst]),
                  f"gear {gear}, without the other meshes, contact at x = {force.x[worst] * 1e3:.5g} mm")
        )  # fmt: skip
        progress((number + 1) / 2)
    made = DynamicRootStress(data, static, stress)
    return Outcome(made, tuple(tables), tuple(values), figures=(_figure(made),))


def _figure(data: DynamicRootStress) -> Figure:
    name, x, curves = data.force.train.names[data.force.mesh], data.force.force.x * 1e3, []
    for member, stress in data.stress.items():
        curves.append(Curve(x, stress * 1e-6, f"{member}, dynamic", member, dash="solid"))
        curves.append(Curve(x, data.static[member] * 1e-6, f"{member}, quasi-static", member, dash="dash", width=1.2))
    axes = (
        Axis("place of the tooth pair on the line of action", "mm"), Axis("largest root tension", "MPa", zero=True)
    )  # fmt: skip
    return Figure(
        f"dynamic_root_stress_{name}",
        f"Dynamic root stress of mesh {name}",
        f"Mesh {name}: root stress of one tooth of either gear through its engagement, with and without vibration.",
        (Panel(*axes, tuple(curves)),),
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Root stress from the influence functions, whatever the compliances come from, and the neighbours' forces."""
    return forecasts.constant(0.12 if scene.case.effects.neighbour_coupling else 0.04)


DYNAMIC_ROOT_STRESS = Stage(
    name="dynamic-root-stress",
    title="Dynamic root stress",
    results=("dynamic-root-stress",),
    subjects=own_meshes,
    run=_run,
    needs=_needs,
    check=_check,
    effects=("neighbour_coupling",),
    cites=citing(Citation("mark", "root stress of a single tooth in motion", "section 3")),
    forecast=_forecast,
)
