"""Stage ``tooth-friction``: friction coefficient and friction torques of a tooth pair through its engagement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.train import friction_coefficient
from fegear.engine.citation import Citation
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve, few, ramp
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Need, Stage
from fegear.engine.table import Column, Table
from fegear.results.gear.drawing import roll_marks
from fegear.results.train.gear_train import (
    RPM,
    carries_nothing,
    gear_train,
    meshes,
    needs_plane_teeth,
    needs_speeds,
    needs_train,
)
from fegear.results.train.motion import check_friction

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.dynamics import FrictionPart
    from fegear.case.reading import Scene
    from fegear.dynamics.train.friction import FrictionOverPath
    from fegear.dynamics.train.gear_train import TrainMesh
    from fegear.engine.stage import Upstream, Work

#: Each speed [s].
_SPEED = 0.01


@dataclass(frozen=True)
class FrictionInputs:
    """What the friction of a mesh depends on besides the train.

    Parameters
    ----------
    mesh : str
    law : FrictionPart
    speeds : ndarray
        Of the body that speeds refer to [rad/s].
    stated : float
        The one of them that values are stated at.
    positions : int
        Over the path of contact.
    """

    mesh: str
    law: FrictionPart
    speeds: Array
    stated: float
    positions: int


@dataclass(frozen=True)
class FrictionData:
    """Friction of one mesh at every speed.

    Parameters
    ----------
    mesh : TrainMesh
    speeds : ndarray
        [rad/s].
    speed_of : str
        Body that they refer to.
    found : tuple of FrictionOverPath
        None where the mesh carries no mean force.
    """

    mesh: TrainMesh
    speeds: Array
    speed_of: str
    found: tuple[FrictionOverPath, ...]


def _check(scene: Scene, subject: str) -> None:
    needs_speeds(scene, subject)
    check_friction(scene)
    needs_plane_teeth(scene, subject, "results", '"tooth-friction"')


def _inputs(scene: Scene, name: str) -> FrictionInputs:
    part = scene.case.dynamics
    speeds = np.unique([*part.speed_values, *(() if part.speed is None else (part.speed,))])
    stated = float(speeds[-1]) if part.speed is None else part.speed
    return FrictionInputs(name, part.friction, speeds, stated, part.positions)


def _compute(asked: FrictionInputs, upstream: Upstream, work: Work) -> FrictionData:
    from fegear.dynamics.train.friction import friction_over_path

    data, found = gear_train(upstream), []
    i = data.train.mesh_index(asked.mesh)
    law = friction_coefficient(asked.law, data.meshes[i].pair)
    if carries_nothing(data, i):
        return FrictionData(data.meshes[i], asked.speeds, data.speed_of, ())
    for speed in asked.speeds:
        frequency = float(data.train.mesh_frequencies(float(speed) / data.speed_ratio)[i])
        found.append(friction_over_path(data.meshes[i], frequency, law, asked.positions))
        work.progress(len(found) / asked.speeds.size)
    return FrictionData(data.meshes[i], asked.speeds, data.speed_of, tuple(found))


def _present(data: FrictionData, asked: FrictionInputs) -> Outcome:
    name, found, of = asked.mesh, data.found, f"of {data.speed_of}"
    if not found:
        return Outcome(data, remarks=(f"Mesh {name} carries no mean force, so it has no friction.",))

    def all_speeds(attribute: str) -> Array:
        return np.concatenate([getattr(one, attribute) for one in found])

    rows = [one.x.size for one in found]
    roll = np.concatenate([data.mesh.pair.roll_angle(one.x, "driver") for one in found])
    along = Table(
        f"tooth_friction_{name}",
        (
            Column("speed", np.repeat(data.speeds, rows), "rpm", of),
            Column("x", all_speeds("x"), "mm", "place of the tooth pair on the line of action"),
            Column("roll_angle", roll, "deg", "of the contact point on the driver"),
            Column("load", all_speeds("load"), "N", "static load on the tooth pair"),
            Column("sliding_velocity", all_speeds("sliding"), "m/s", "of the driver's flank on the driven one"),
            Column("rolling_velocity", all_speeds("rolling"), "m/s", "sum of both flanks' speeds"),
            Column("friction_coefficient", all_speeds("coefficient"), "", f"law {asked.law.law}"),
            Column("torque_driver", all_speeds("torque_driver"), "N.m", "of this pair; positive turns the gear on"),
            Column("torque_driven", all_speeds("torque_driven"), "N.m", "of this pair; positive turns the gear on"),
            Column("total_torque_driver", all_speeds("total_driver"), "N.m", "of all pairs in contact then (T_f1)"),
            Column("total_torque_driven", all_speeds("total_driven"), "N.m", "of all pairs in contact then (T_f2)"),
        ),
        f"Tooth friction of mesh {name} over the path of contact",
    )
    loss, power, mean = (np.array([getattr(o, key) for o in found]) for key in ("loss", "power", "mean_coefficient"))
    losses = Table(
        f"friction_loss_{name}",
        (
            Column("speed", data.speeds, "rpm", of),
            Column("power", power, "W", "that the mesh transmits"),
            Column("friction_loss", loss, "W", "mean power that tooth friction takes"),
            Column("mean_coefficient", mean, "", "friction coefficient that would take as much everywhere"),
            Column("efficiency", 1.0 - loss / power, "", "of the mesh, by tooth friction alone"),
            Column(
                "loss_error",
                np.array([one.loss_error for one in found]),
                "W",
                "of the integration and the fitted teeth",
            ),
        ),
        f"Friction loss of mesh {name} over speed",
    )
    top = found[int(np.flatnonzero(data.speeds == asked.stated)[0])]
    at = f"at {asked.stated * RPM:.6g} rpm {of}"
    relative = top.loss_error / top.loss if top.loss else 0.0
    values = (
        Value(f"{name}.friction_loss", top.loss, "W", top.loss_error, at),
        Value(f"{name}.mean_friction_coefficient", top.mean_coefficient, "", relative * top.mean_coefficient, at),
        Value(f"{name}.friction_efficiency", 1.0 - top.loss / top.power, "", top.loss_error / top.power, at),
    )
    return Outcome(data, (along, losses), values, {"law": asked.law.law}, (), (_figure(name, data, asked),))


def _figure(name: str, data: FrictionData, asked: FrictionInputs) -> Figure:
    """Coefficient and torques over the roll angle, one curve for each speed."""
    pair = data.mesh.pair
    chosen = few(len(data.found), (0, len(data.found) - 1))
    looks = list(zip(chosen, ramp(len(chosen)), strict=True))
    roll, marks = Axis("roll angle of the driver", "deg"), roll_marks(pair, "driver")

    def panel(label: str, unit: str, one_pair: str, all_pairs: str = "", *, zero: bool = False) -> Panel:
        curves = []
        for k, role in looks:
            one = data.found[k]
            angle = np.degrees(pair.roll_angle(one.x, "driver"))
            text = f"{data.speeds[k] * RPM:.6g} rpm"
            if all_pairs:
                curves.append(Curve(angle, getattr(one, all_pairs), "", role, dash="dot", width=1.0, markers=False))
            curves.append(Curve(angle, getattr(one, one_pair), text, role, dash="solid", markers=False))
        return Panel(roll, Axis(label, unit, zero=zero), tuple(curves), marks)

    return Figure(
        f"tooth_friction_{name}",
        f"Tooth friction of mesh {name}",
        f"Mesh {name}: friction coefficient by the law {asked.law.law}, and friction torque of one tooth pair on both "
        "gears from first to last contact under the static load (dotted: of all pairs in contact then). Sliding turns "
        "at the pitch point C, where Benedict and Kelley's law is cut at 0.2; a positive torque turns a "
        "gear on.",
        (
            panel("friction coefficient", "", "coefficient", zero=True),
            panel("torque on the driver", "N.m", "torque_driver", "total_driver"),
            panel("torque on the driven", "N.m", "torque_driven", "total_driven"),
        ),
        under=f"{data.mesh.force:.5g} N",
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Every speed alike."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds, "positions": scene.case.dynamics.positions}, _SPEED * speeds)


def _cites(scene: Scene, _name: str) -> Iterator[Citation]:
    number = {"buckingham": "Eq. 17", "benedict-kelley": "Eq. 18"}.get(scene.case.dynamics.friction.law, "")
    yield Citation(
        "lin-huston-coy",
        "friction coefficient and friction torques",
        ", ".join(filter(None, (number, "Figs. 5 and 6"))),
    )


TOOTH_FRICTION = Stage(
    subjects=meshes,
    needs=needs_train,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=("friction",),
    requires=(Need("friction", "it is what this result shows"),),
    cites=_cites,
    forecast=_forecast,
)
