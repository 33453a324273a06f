"""Stage ``train-loss`` of the result ``gear-mesh-power-loss``: what all teeth of a train take."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.built.pair_surface import pair_speed
from fegear.case.built.train import check_train, train_inputs, train_part
from fegear.case.reading import Scene
from fegear.contact.tooth_loss import ToothLoss
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.pair.gear_mesh_power_loss import ToothLossData
from fegear.results.train.gear_train import the_train

#: Speeds of pair and train may differ by this share without a remark.
_SAME = 1e-3


@dataclass(frozen=True)
class TrainLossInputs:
    """Power flow of a train.

    Parameters
    ----------
    meshes, pairs : tuple of str
        Every mesh, and the pair whose teeth it has.
    power : tuple of float
        That each mesh transmits [W].
    driving : float
        Power that drives the train [W].
    doubtful : tuple of str
        Meshes whose pair gives another speed than the train.
    """

    pairs: tuple[str, ...]
    power: tuple[float, ...]
    driving: float
    doubtful: tuple[str, ...]
    meshes: tuple[str, ...] = shown("", "mesh of the train", name="mesh")


@dataclass(frozen=True)
class TrainLossData:
    """Losses of a train; arrays over its meshes.

    Parameters
    ----------
    power, loss, factor, friction : ndarray
        Power of each mesh [W], what its teeth lose [W], H_V, mean friction coefficient.
    driving : float
        [W].
    error : float
        Of the whole loss [W].
    """

    factor: Array
    friction: Array
    error: float
    power: Array = shown("W", "transmitted power")
    loss: Array = shown("W", "gear mesh power loss", name="tooth_loss", label="gear mesh power loss")
    driving: float = shown("W", "input power of the train", name="power")

    @property
    @shows("", "number of the mesh")
    def place(self) -> Array:
        """From 0."""
        return np.arange(self.loss.size, dtype=float)

    @property
    @shows("", "efficiency of the mesh", name="efficiency")
    def efficiencies(self) -> Array:
        """Of the teeth of every mesh."""
        kept = 1.0 - self.loss / np.maximum(self.power, np.finfo(float).tiny)
        return np.asarray(np.where(self.power > 0.0, kept, 1.0))

    @property
    @shows("W", "sum over all meshes", name="tooth_loss")
    def whole_loss(self) -> float:
        """[W]."""
        return float(self.loss.sum())

    @property
    @shows(
        "",
        "efficiency of the gear meshes only: bearings, churning, windage and seals are neglected",
        name="tooth_efficiency",
    )
    def efficiency(self) -> float:
        """Of the teeth of all meshes together."""
        return 1.0 - self.whole_loss / self.driving


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    part = train_part(scene)
    return tuple(
        Task("gear-mesh-power-loss", pair) for pair in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh)
    )


def _train_inputs(scene: Scene, _subject: str) -> TrainLossInputs:
    from fegear.dynamics.train.matrices import static_forces
    from fegear.dynamics.train.train_spec import build_train, speed_ratio

    part = train_part(scene)
    spec = train_inputs(scene).spec
    train, pairs = build_train(spec), spec.pairs
    forces = np.abs(static_forces(train))
    speed = scene.case.dynamics.one_speed / speed_ratio(spec, train)
    if not speed > 0.0:  # by the first pair that gives one
        for i, mesh in enumerate(part.mesh):
            own = pair_speed(scene, part.pair_of(mesh))
            if own > 0.0:
                speed = own * pairs[mesh].driver.teeth / float(train.mesh_orders[i])
                break
    frequency = train.mesh_frequencies(speed)
    power, doubtful = [], []
    for i, mesh in enumerate(part.mesh):
        pair = pairs[mesh]
        power.append(float(forces[i]) * float(frequency[i]) * pair.base_pitch)
        turns = 2.0 * math.pi * float(frequency[i]) / pair.driver.teeth
        if abs(pair_speed(scene, part.loaded_pair_of(mesh)) / turns - 1.0) > _SAME:
            doubtful.append(mesh)
    shafts = np.asarray(train.torque) * np.asarray(train.ratios) * speed
    return TrainLossInputs(
        tuple(part.loaded_pair_of(mesh) for mesh in part.mesh), tuple(power),
        float(np.abs(shafts[shafts * np.sign(shafts[np.argmax(np.abs(shafts))]) > 0.0]).sum()), tuple(doubtful),
        tuple(part.mesh),
    )  # fmt: skip


def _compute_train(asked: TrainLossInputs, upstream: Upstream, _work: Work) -> TrainLossData:
    found = [cast("ToothLossData", upstream[Task("gear-mesh-power-loss", pair)]) for pair in asked.pairs]
    power = np.array(asked.power)
    share = np.array([one.found.loss / one.found.transmitted for one in found])
    return TrainLossData(
        np.array([one.found.loss_factor for one in found]), np.array([one.found.mean_coefficient for one in found]),
        float((power * share * np.array([one.error for one in found])).sum()), power, power * share, asked.driving,
    )  # fmt: skip


_SHEET = Sheet(
    name=lambda _asked: "",
    tables=(
        Rows(
            "train_loss", "Gear mesh power loss of every mesh of the train",
            (
                Cell("meshes", lambda seen: np.array(seen.asked.meshes), lambda seen: seen.asked), "power", "loss",
                Cell("loss_factor", "factor", lambda _: ToothLoss),
                Cell("mean_coefficient", "friction", lambda _: ToothLoss), "efficiencies",
            ),
        ),
    ),
    values=(
        Number("driving", exact, owner="train"),
        Number("whole_loss", "error", owner="train"),
        Number("efficiency", lambda seen: seen.data.error / seen.data.driving, owner="train"),
    ),
    figures=(
        Chart(
            "train_loss", "Gear mesh power loss of the train",
            "Gear mesh power loss of every mesh at an input power of {d.driving:.5g}: {d.whole_loss:.4g} in total, "
            "efficiency {d.efficiency:.5f}. Bearings, churning, windage and seals are neglected.",
            (
                Over(
                    lambda seen: Axis("mesh", categories=seen.asked.meshes),
                    (Line("loss", role="red", kind="bars", x="place"),), options={"zero": True},
                ),
            ),
        ),
    ),
    remarks=(
        Remark(
            "Efficiency of the train: sliding loss of the teeth only; power of each mesh computed without losses."
        ),
        lambda seen: [
            f"Mesh {mesh}: the speed of its pair differs from that of the train; friction computed at the speed of "
            "the pair."
            for mesh in seen.asked.doubtful
        ],
    ),
)  # fmt: skip


def _check_train(scene: Scene, _subject: str) -> None:
    check_train(scene)


TRAIN_LOSS = Stage(
    subjects=the_train,
    needs=_needs,
    inputs=_train_inputs,
    compute=_compute_train,
    present=_SHEET.present,
    check=_check_train,
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
