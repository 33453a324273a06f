"""Stage ``tooth-force``: force on one tooth pair of the linearised train through its engagement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, columns_of, drawn
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Reads, Stage, Upstream, Work
from fegear.engine.table import Table
from fegear.engine.value import Value
from fegear.results.gear.drawing import LINE_OF_ACTION, path_marks
from fegear.results.train.gear_train import (
    RPM,
    from_exciter,
    gear_train,
    needs_one_speed,
    needs_train,
    own_meshes,
    pull_remarks,
    what_excites,
)

if TYPE_CHECKING:
    from fegear.case.dynamics import DynamicsPart
    from fegear.case.reading import Scene
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.single_tooth import MeshForce
    from fegear.dynamics.train.tooth_force import Pull, ToothForce


@dataclass(frozen=True)
class ToothForceData:
    """Force on one tooth pair through its engagement.

    Parameters
    ----------
    train : GearTrain
    mesh : int
        Its number.
    force : ToothForce
    number : int
        Of the tooth pair; 0 is at the pitch point at phase zero.
    harmonics : int
        That it is summed from.
    pull : Pull or None
        How far the mesh force falls below zero.
    together : MeshForce
        What all tooth pairs in contact carry together.
    """

    train: GearTrain
    mesh: int
    force: ToothForce
    number: int
    harmonics: int
    pull: Pull | None
    together: MeshForce


def _compute(asked: Reads[DynamicsPart], upstream: Upstream, _work: Work) -> ToothForceData:
    from fegear.dynamics.train.single_tooth import force_history, heaviest_pair, mesh_force, summed_harmonics
    from fegear.dynamics.train.tooth_force import largest_pull

    data = gear_train(upstream)
    i, part = data.train.mesh_index(asked.name), asked.part
    number, harmonics, speed = heaviest_pair(data, i), summed_harmonics(data, part.harmonics), part.one_speed
    force = force_history(data, i, speed, part.positions, harmonics, number)
    pull = largest_pull(data, i, [speed / data.speed_ratio], part.harmonics)
    together = mesh_force(data, i, speed, part.positions, harmonics, number)
    return ToothForceData(data, i, force, number, harmonics, pull, together)


def _present(made: ToothForceData, asked: Reads[DynamicsPart]) -> Outcome:
    name, data, i, force = asked.name, made.train, made.mesh, made.force
    table = Table(
        f"tooth_force_{name}",
        (
            *columns_of(force, "time", "x", "total", "with_others", "static", "own"),
            *(
                column_of(force, "cross", force.cross[j], name=f"increment_from_{other}")
                for j, other in enumerate(data.exciters)
                if j != i
            ),
        ),
        f"Force on one tooth pair of mesh {name}",
    )
    alone = len(data.exciters) == 1
    others = others_of(data)
    largest = [("", force.with_others, "" if alone else f"all meshes{rippled(data)}, at the phases of the case, ")]
    if not alone:
        largest += [
            ("_any_phase", force.at_worst_phases, f"upper bound over all phases of {others}, "),
            ("_own_mesh", force.total, f"without {others}, "),
        ]
    values = [
        *(
            Value(f"{name}.largest_tooth_force{end}", float(of.max()), "N", None,
                  f"{meaning}at x = {force.x[int(np.argmax(of))] * 1e3:.5g} mm")
            for end, of, meaning in largest
        ),
        Value(f"{name}.largest_static_tooth_force", float(force.static.max()), "N", None, "quasi-static"),
        *(
            Value(f"{name}.largest_increment_from_{other}", float(force.cross_peak[j]), "N", None,
                  "over the engagement and all relative phases")
            for j, other in enumerate(data.exciters) if j != i
        ),
        *_mesh_force_values(name, made.together, data),
    ]  # fmt: skip
    remarks = pull_remarks(made.pull)
    uneven = data.meshes[i].error.pitches
    if uneven > 1:
        sentence = (
            f"Mesh {name}: with pitch deviations; of {uneven} tooth pairs, number {made.number} with the largest "
            "static load is shown (number 0 is at the pitch point at phase zero)."
        )
        remarks = (*remarks, sentence)
    settings: dict[str, object] = {"harmonics": made.harmonics, "speed": asked.part.one_speed}
    figures = _tooth_force_figure(made, asked.part.one_speed), _mesh_force_figure(made, asked.part.one_speed)
    tables = table, _mesh_force_table(name, made.together)
    return Outcome(made, tables, tuple(values), settings, remarks, figures)


def others_of(data: GearTrain) -> str:
    """What excites a mesh besides itself, in words."""
    ripple = "torque ripple" if data.ripple else ""
    return " and ".join(filter(None, ("the other meshes" if len(data.names) > 1 else "", ripple)))


def rippled(data: GearTrain) -> str:
    """What follows "all meshes" where torques fluctuate, too."""
    return " and torque ripple" if data.ripple else ""


def _mesh_force_values(name: str, found: MeshForce, data: GearTrain) -> tuple[Value, ...]:
    about = f"sum of the forces on the tooth pairs in contact, all meshes{rippled(data)}, at the phases of the case"
    return (
        Value(f"{name}.largest_mesh_force_of_teeth", float(found.of_teeth.max()), "N", None, about),
        Value(f"{name}.least_mesh_force_of_teeth", float(found.of_teeth.min()), "N", None, about),
        Value(f"{name}.largest_mesh_force_by_mean_stiffness", float(found.by_mean_stiffness.max()), "N", None,
              "of the linearised train (spectral lines of the mesh force)"),
    )  # fmt: skip


def _mesh_force_table(name: str, found: MeshForce) -> Table:
    return Table(
        f"mesh_force_of_teeth_{name}",
        columns_of(found, "time", "phase", "of_teeth", "by_mean_stiffness", "pairs"),
        f"Force in mesh {name} over one base pitch, by its teeth and by its mean stiffness",
    )


def over_time(force: ToothForce) -> Axis:
    """The line of action as abscissa, with the time on the far side."""
    return replace(
        LINE_OF_ACTION, second=Scale("time from phase zero of the mesh", "ms", drawn(force, "x"), force.time * 1e3)
    )


def _while(data: ToothForceData) -> str:
    """From when to when a tooth pair is followed."""
    if data.train.meshes[data.mesh].pair.driver.helix_angle == 0.0:
        return "from first contact at A to last contact at E"
    return "while its contact line crosses the plane of action (position of the middle of the line)"


def _tooth_force_figure(data: ToothForceData, speed: float) -> Figure:
    force, names = data.force, data.train.exciters
    name, x, marks = names[data.mesh], drawn(force, "x"), path_marks(data.train.meshes[data.mesh].pair)
    top = [Curve(x, force.static, "static", "static"), Curve(x, force.total, "static and own increment", "own force")]
    if len(names) > 1:
        top.append(Curve(x, force.with_others, f"with {others_of(data.train)}", "with other meshes"))
    parts = {j: force.own if j == data.mesh else force.cross[j] for j in range(len(names))}
    below = [Curve(x, part, from_exciter(data.train, j), f"series:{j}") for j, part in parts.items()]
    mean = Mark("y", float(data.train.forces[data.mesh]))
    return Figure(
        f"tooth_force_{name}",
        f"Force on one tooth pair of mesh {name}",
        f"Mesh {name}: force on one tooth pair {_while(data)}; horizontal line: mean mesh force. Below: dynamic "
        f"increment by {what_excites(data.train)}.",
        (
            Panel(over_time(force), axis_of(force, "total", zero=True), tuple(top), (*marks, mean), height=1.2),
            Panel(LINE_OF_ACTION, axis_of(force, "own"), tuple(below), marks, height=0.8),
        ),
        under=f"{speed * RPM:.6g} rpm",
    )


def _mesh_force_figure(data: ToothForceData, speed: float) -> Figure:
    found, name = data.together, data.train.names[data.mesh]
    curves = (
        Curve(found.phase, found.by_mean_stiffness, "by the mean stiffness", "static", dash="dash", markers=False),
        Curve(found.phase, found.of_teeth, "sum of the teeth", "own force", markers=False),
    )
    mean = Mark("y", float(data.train.forces[data.mesh]))
    return Figure(
        f"mesh_force_of_teeth_{name}",
        f"Force in mesh {name} over one base pitch",
        f"Mesh {name}: what the tooth pairs in contact carry together, and the force that the mean stiffness gives. "
        "Both use the same dynamic transmission error; the tooth forces use the instantaneous stiffness, the mesh "
        "force the mean stiffness. Horizontal line: mean force.",
        (Panel(Axis("phase", "base pitches"), axis_of(found, "of_teeth", zero=True), curves, (mean,)),),
        under=f"{speed * RPM:.6g} rpm",
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """At least 256 harmonics at one speed."""
    part = scene.case.dynamics
    harmonics = max(part.harmonics, 256)
    return Forecast({"harmonics": harmonics, "positions": part.positions}, 0.06 * harmonics / 256)


TOOTH_FORCE = Stage(
    subjects=own_meshes,
    needs=needs_train,
    inputs=Reads.of(lambda scene: scene.case.dynamics),
    compute=_compute,
    present=_present,
    check=needs_one_speed,
    cites=citing(Citation("mark", "force on a single tooth pair", "Eqs. 3.23 to 3.36")),
    forecast=_forecast,
)
