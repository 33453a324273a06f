"""Stage ``tooth-friction``: friction coefficient and friction torques of a tooth pair through its engagement."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.built.train import motion_spec
from fegear.contact.plane.pair_history import PairHistory
from fegear.engine.citation import Citation
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.gear.path_marks import roll_marks
from fegear.results.train.gear_train import (
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

    from fegear.case.reading import Scene
    from fegear.dynamics.train.friction import FrictionOverPath
    from fegear.dynamics.train.friction_law import FrictionLaw
    from fegear.dynamics.train.gear_train import TrainMesh

#: Each speed [s].
_SECONDS_OF_SPEED = 0.01


@dataclass(frozen=True)
class FrictionInputs:
    """What the friction of a mesh depends on besides the train.

    Parameters
    ----------
    mesh : str
    law : FrictionLaw
    speeds : ndarray
        Of the body that speeds refer to [rad/s].
    stated : float
        The one of them that values are stated at.
    positions : int
        Over the path of contact.
    """

    mesh: str
    law: FrictionLaw
    speeds: Array
    stated: float
    positions: int


@dataclass(frozen=True)
class FrictionAtSpeed:
    """Friction of a mesh at one speed [rad/s] of the body that speeds refer to."""

    mesh: TrainMesh
    over_path: FrictionOverPath
    speed: float = shown("rpm", "")

    @cached_property
    @shows("deg", "roll angle of the driver")
    def driver_roll_angle(self) -> Array:
        """At each place on the path [rad]."""
        return np.asarray(self.mesh.pair.roll_angle(self.over_path.x, "driver"))


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
    stated : float
        The speed that values are stated at [rad/s].
    """

    mesh: TrainMesh
    speed_of: str
    found: tuple[FrictionOverPath, ...]
    speeds: Array = shown("rpm", "", name="speed")
    stated: float = shown("rpm", "")

    @cached_property
    def at_speeds(self) -> tuple[FrictionAtSpeed, ...]:
        """Friction at every speed."""
        return tuple(FrictionAtSpeed(self.mesh, *one) for one in zip(self.found, self.speeds.tolist(), strict=False))

    @property
    def at_stated(self) -> FrictionOverPath | None:
        """Friction at the stated speed."""
        return self.found[int(np.flatnonzero(self.speeds == self.stated)[0])] if self.found else None

    @property
    def mean_coefficient_error(self) -> float:
        """Of the stated mean coefficient, which is off by as much of itself as the loss is."""
        top = self.found[int(np.flatnonzero(self.speeds == self.stated)[0])]
        return (top.loss_error / top.loss if top.loss else 0.0) * top.mean_coefficient

    @property
    def efficiency_error(self) -> float:
        """Of the stated efficiency."""
        top = self.found[int(np.flatnonzero(self.speeds == self.stated)[0])]
        return top.loss_error / top.power


def _check(scene: Scene, subject: str) -> None:
    needs_speeds(scene, subject)
    check_friction(scene)
    needs_plane_teeth(scene, subject, "results", '"tooth-friction"')


def _inputs(scene: Scene, name: str) -> FrictionInputs:
    part = scene.case.dynamics
    speeds = np.unique([*part.speed_values, *(() if part.speed is None else (part.speed,))])
    stated = float(speeds[-1]) if part.speed is None else part.speed
    return FrictionInputs(name, motion_spec(scene).law, speeds, stated, part.positions)


def _compute(asked: FrictionInputs, upstream: Upstream, work: Work) -> FrictionData:
    from fegear.dynamics.train.friction import friction_over_path

    data, found = gear_train(upstream), []
    i = data.train.mesh_index(asked.mesh)
    law = asked.law.of(data.meshes[i].pair)
    if carries_nothing(data, i):
        return FrictionData(data.meshes[i], data.speed_of, (), asked.speeds, asked.stated)
    for speed in asked.speeds:
        frequency = float(data.train.mesh_frequencies(float(speed) / data.speed_ratio)[i])
        found.append(friction_over_path(data.meshes[i], frequency, law, asked.positions))
        work.progress(len(found) / asked.speeds.size)
    return FrictionData(data.meshes[i], data.speed_of, tuple(found), asked.speeds, asked.stated)


_SPEEDS = Family("at_speeds", role="ramp")
_ROLL = "driver_roll_angle"


def _over_roll(quantity: str, all_pairs: str = "", **options: bool) -> Over:
    """A quantity of one tooth pair at every speed, dotted that of all pairs in contact."""
    one = Line(f"over_path.{quantity}", "{one.speed:.6g}", look={"dash": "solid", "markers": False})
    all_of_them = Line(f"over_path.{all_pairs}", look={"dash": "dot", "width": 1.0, "markers": False})
    return Over(
        _ROLL, (Bundle(_SPEEDS, (all_of_them, one) if all_pairs else (one,)),), f"over_path.{quantity}",
        marks=lambda seen: roll_marks(seen.data.mesh.pair, "driver"), options=options,
    )  # fmt: skip


_SPEED = "of {d.speed_of}"
_AT = "at {d.stated:.6g} of {d.speed_of}"
_SHEET = Sheet(
    name=lambda asked: asked.mesh,
    tables=(
        Rows(
            "tooth_friction_{name}", "Tooth friction of mesh {name} over the path of contact",
            (
                Cell("speed", meaning=_SPEED), "over_path.x",
                Cell(_ROLL, _ROLL, lambda _: PairHistory), "over_path.load", "over_path.sliding",
                "over_path.rolling", Cell("over_path.coefficient", meaning="law {asked.law.law}"),
                *(f"over_path.{k}" for k in ("torque_driver", "torque_driven", "total_driver", "total_driven")),
            ),
            stacked="at_speeds", when="found",
        ),
        Rows(
            "friction_loss_{name}", "Power loss of mesh {name} over speed",
            (
                Cell("speed", meaning=_SPEED),
                *(f"over_path.{k}" for k in ("power", "loss", "mean_coefficient", "efficiency", "loss_error")),
            ),
            of="at_speeds", when="found",
        ),
    ),
    values=(
        Number("loss", "at_stated.loss_error", "at_stated", meaning=_AT),
        Number(
            "mean_coefficient", "mean_coefficient_error", "at_stated", name="mean_friction_coefficient", meaning=_AT
        ),
        Number("efficiency", "efficiency_error", "at_stated", name="friction_efficiency", meaning=_AT),
    ),
    figures=(
        Chart(
            "tooth_friction_{name}", "Tooth friction of mesh {name}",
            "Mesh {name}: friction coefficient by the law {asked.law.law}, and friction torque of one tooth pair on "
            "both gears over the path of contact under the static load (dotted: of all pairs in contact then). "
            "Sliding reverses at the pitch point C (Benedict-Kelley coefficient limited to 0.2); positive torque "
            "acts in the direction of rotation.",
            (
                _over_roll("coefficient", zero=True),
                _over_roll("torque_driver", "total_driver"),
                _over_roll("torque_driven", "total_driven"),
            ),
            of=lambda seen: seen.data.at_speeds[0], when="found", under="{d.mesh.force:.5g} N",
        ),
    ),
    remarks=(
        Remark("Mesh {name} has no mean force and therefore no friction.", when=lambda seen: not seen.data.found),
    ),
    settings={"law": lambda seen: seen.asked.law.law if seen.data.found else None},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Every speed alike."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds, "positions": scene.case.dynamics.positions}, _SECONDS_OF_SPEED * speeds)


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
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
