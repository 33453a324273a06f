"""Stage ``tooth-friction``: friction coefficient and friction torques of a tooth pair through its engagement."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.train import friction_coefficient
from fegear.contact.plane.pair_history import PairHistory
from fegear.engine.citation import Citation
from fegear.engine.declared import axis_of, column_of, column_over, columns_of, stacked, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, few, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Need, Stage, Upstream, Work
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

    def over_path(one: FrictionOverPath) -> tuple[Column, ...]:
        return (
            column_of(one, "x"),
            column_of(PairHistory, "driver_roll_angle", data.mesh.pair.roll_angle(one.x, "driver")),
            *columns_of(one, "load", "sliding", "rolling"),
            column_of(one, "coefficient", meaning=f"law {asked.law.law}"),
            *columns_of(one, "torque_driver", "torque_driven", "total_driver", "total_driven"),
        )

    along = Table(
        f"tooth_friction_{name}",
        (
            Column("speed", np.repeat(data.speeds, [one.x.size for one in found]), "rpm", of),
            *stacked([over_path(one) for one in found]),
        ),
        f"Tooth friction of mesh {name} over the path of contact",
    )
    losses = Table(
        f"friction_loss_{name}",
        (
            Column("speed", data.speeds, "rpm", of),
            *(column_over(found, key) for key in ("power", "loss", "mean_coefficient", "efficiency", "loss_error")),
        ),
        f"Friction loss of mesh {name} over speed",
    )
    top = found[int(np.flatnonzero(data.speeds == asked.stated)[0])]
    at = f"at {asked.stated * RPM:.6g} rpm {of}"
    relative = top.loss_error / top.loss if top.loss else 0.0
    values = (
        value_of(top, "loss", name, top.loss_error, meaning=at),
        value_of(
            top, "mean_coefficient", name, relative * top.mean_coefficient, name="mean_friction_coefficient", meaning=at
        ),
        value_of(top, "efficiency", name, top.loss_error / top.power, name="friction_efficiency", meaning=at),
    )
    return Outcome(data, (along, losses), values, {"law": asked.law.law}, (), (_figure(name, data, asked),))


def _figure(name: str, data: FrictionData, asked: FrictionInputs) -> Figure:
    """Coefficient and torques over the roll angle, one curve for each speed."""
    pair = data.mesh.pair
    chosen = few(len(data.found), (0, len(data.found) - 1))
    looks = list(zip(chosen, ramp(len(chosen)), strict=True))
    roll, marks = Axis("roll angle of the driver", "deg"), roll_marks(pair, "driver")

    def panel(one_pair: str, all_pairs: str = "", *, zero: bool = False) -> Panel:
        curves = []
        for k, role in looks:
            one = data.found[k]
            angle = np.degrees(pair.roll_angle(one.x, "driver"))
            text = f"{data.speeds[k] * RPM:.6g} rpm"
            if all_pairs:
                curves.append(Curve(angle, getattr(one, all_pairs), "", role, dash="dot", width=1.0, markers=False))
            curves.append(Curve(angle, getattr(one, one_pair), text, role, dash="solid", markers=False))
        return Panel(roll, axis_of(data.found[0], one_pair, zero=zero), tuple(curves), marks)

    return Figure(
        f"tooth_friction_{name}",
        f"Tooth friction of mesh {name}",
        f"Mesh {name}: friction coefficient by the law {asked.law.law}, and friction torque of one tooth pair on both "
        "gears over the path of contact under the static load (dotted: of all pairs in contact then). Sliding turns "
        "at the pitch point C, where Benedict and Kelley's law is cut at 0.2; a positive torque turns a "
        "gear on.",
        (
            panel("coefficient", zero=True),
            panel("torque_driver", "total_driver"),
            panel("torque_driven", "total_driven"),
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
    requires=(Need("friction", "it is what this result shows"),),
    cites=_cites,
    forecast=_forecast,
    internal=True,
)
