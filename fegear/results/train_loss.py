"""Stage ``train-loss`` of the result ``tooth-loss``: what the teeth of all meshes of a train take of its power."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Bars, Figure, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.models.pair_surface import pair_speed
from fegear.models.train import build_train, check_train, train_inputs, train_part
from fegear.results.gear_train import the_train
from fegear.results.tooth_loss import loss_of, loss_task

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work

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

    meshes: tuple[str, ...]
    pairs: tuple[str, ...]
    power: tuple[float, ...]
    driving: float
    doubtful: tuple[str, ...]


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

    power: Array
    loss: Array
    factor: Array
    friction: Array
    driving: float
    error: float

    @property
    def efficiency(self) -> float:
        """Of the teeth of all meshes together."""
        return 1.0 - float(self.loss.sum()) / self.driving


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    part = train_part(scene)
    return tuple(loss_task(scene, pair) for pair in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh))


def _inputs(scene: Scene, _subject: str) -> TrainLossInputs:
    from fegear.dynamics.matrices import static_forces

    part = train_part(scene)
    asked = train_inputs(scene)
    train = build_train(asked)
    forces = np.abs(static_forces(train))
    speed = scene.case.dynamics.one_speed / abs(float(train.ratios[train.dof[asked.speed_of]]))
    if not speed > 0.0:  # by the first pair that gives one
        for i, mesh in enumerate(part.mesh):
            own = pair_speed(scene, part.pair_of(mesh))
            if own > 0.0:
                speed = own * asked.pairs[mesh].driver.teeth / float(train.mesh_orders[i])
                break
    frequency = train.mesh_frequencies(speed)
    power, doubtful = [], []
    for i, mesh in enumerate(part.mesh):
        pair = asked.pairs[mesh]
        power.append(float(forces[i]) * float(frequency[i]) * pair.base_pitch)
        turns = 2.0 * math.pi * float(frequency[i]) / pair.driver.teeth
        if abs(pair_speed(scene, part.loaded_pair_of(mesh)) / turns - 1.0) > _SAME:
            doubtful.append(mesh)
    shafts = np.asarray(train.torque) * np.asarray(train.ratios) * speed
    return TrainLossInputs(
        tuple(part.mesh), tuple(part.loaded_pair_of(mesh) for mesh in part.mesh), tuple(power),
        float(np.abs(shafts[shafts * np.sign(shafts[np.argmax(np.abs(shafts))]) > 0.0]).sum()), tuple(doubtful),
    )  # fmt: skip


def _compute(asked: TrainLossInputs, upstream: Upstream, _work: Work) -> TrainLossData:
    found = [loss_of(upstream, pair) for pair in asked.pairs]
    power = np.array(asked.power)
    share = np.array([one.found.loss / one.found.transmitted for one in found])
    return TrainLossData(
        power, power * share, np.array([one.found.loss_factor for one in found]),
        np.array([one.found.mean_coefficient for one in found]), asked.driving,
        float((power * share * np.array([one.error for one in found])).sum()),
    )  # fmt: skip


def _present(data: TrainLossData, asked: TrainLossInputs) -> Outcome:
    efficiency = np.where(data.power > 0.0, 1.0 - data.loss / np.maximum(data.power, np.finfo(float).tiny), 1.0)
    table = Table(
        "train_loss",
        (
            Column("mesh", np.array(asked.meshes), "", "mesh of the train"),
            Column("power", data.power, "W", "that it transmits"),
            Column("tooth_loss", data.loss, "W", "that its teeth lose"),
            Column("loss_factor", data.factor, "", "H_V by the computed load"),
            Column("mean_friction", data.friction, "", "coefficient that takes as much everywhere"),
            Column("efficiency", efficiency, "", "of its teeth"),
        ),
        "Tooth loss of every mesh of the train",
    )
    total = float(data.loss.sum())
    values = (
        Value("train.power", data.driving, "W", 0.0, "that drives the train"),
        Value("train.tooth_loss", total, "W", data.error, "sum over all meshes"),
        Value("train.tooth_efficiency", data.efficiency, "", data.error / data.driving,
              "of the teeth alone: bearings, churning, windage and seals are neglected"),
    )  # fmt: skip
    remarks = [
        "The train's efficiency is that of sliding teeth alone; each mesh transmits the power that it has without loss."
    ]
    remarks += [
        f"Mesh {mesh}: its pair gives another speed than the train; its friction is that at its own speed."
        for mesh in asked.doubtful
    ]
    places = np.arange(len(asked.meshes), dtype=float)
    figure = Figure(
        "train_loss",
        "Tooth loss of the train",
        f"What the teeth of every mesh lose of the {data.driving:.5g} W that drive the train: {total:.4g} W together, "
        f"an efficiency of {data.efficiency:.5f}. Bearings, churning, windage and seals are neglected.",
        (
            Panel(
                Axis("mesh", categories=asked.meshes), Axis("tooth loss", "W", zero=True),
                (Bars(places, data.loss, "", "red"),),
            ),
        ),
    )  # fmt: skip
    return Outcome(data, (table,), values, {}, tuple(remarks), (figure,))


def _check(scene: Scene, _subject: str) -> None:
    check_train(scene)


TRAIN_LOSS = Stage(
    subjects=the_train,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
)
