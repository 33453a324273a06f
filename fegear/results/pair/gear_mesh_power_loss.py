"""Stages of the result ``gear-mesh-power-loss``: friction loss, loss factors and efficiency of a pair and of a train.

Stage ``train-loss`` of the result ``gear-mesh-power-loss``: what the teeth of all meshes of a train take of its power.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.case.built.pair_surface import PairFriction, check_speed, pair_friction, pair_speed
from fegear.case.built.train import build_train, check_train, train_inputs, train_part
from fegear.case.reading import Scene
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.surface import FrictionLaw
from fegear.contact.tooth_loss import ToothLoss
from fegear.engine.citation import Citation
from fegear.engine.declared import column_of, column_over, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import GearPair
from fegear.results.gear.drawing import LINE_OF_ACTION, path_marks
from fegear.results.pair.loaded_teeth import check_teeth, loaded_teeth, teeth_stage
from fegear.results.train.gear_train import the_train

#: Laws by the works that they stand in.
_WORKS = {
    "schlenk": "schlenk", "iso-6336-20": "iso-ts-6336-20", "iso-6336-21": "iso-ts-6336-21",
    "iso-6336-22": "iso-ts-6336-22", "buckingham": "lin-huston-coy", "benedict-kelley": "lin-huston-coy",
}  # fmt: skip


_NEGLECTED = "bearings, churning, windage and seals are neglected"


@dataclass(frozen=True)
class ToothLossInputs:
    """What is read of the case besides the loaded pair.

    Parameters
    ----------
    friction : PairFriction
    speed : float
        Of the driver [rad/s].
    loads : tuple of float
        Of the case, ascending [N].
    nominal : int
        Number of the nominal one.
    given : bool
        Whether the case names the friction law.
    name : str
    """

    friction: PairFriction
    speed: float
    loads: tuple[float, ...]
    nominal: int
    given: bool = field(compare=False)
    name: str = field(compare=False)

    @property
    def load(self) -> float:
        """The nominal load [N]."""
        return self.loads[self.nominal]

    def law(self, pair: GearPair, load: float) -> FrictionLaw:
        """Friction law under a load [N]."""
        return self.friction.of(pair, self.speed, load)


@dataclass(frozen=True)
class ToothLossData:
    """Losses of a pair.

    Parameters
    ----------
    pair : GearPair
    over_loads : tuple of ToothLoss
        By the computed load and the friction law, under every load.
    nominal : int
        Number of the nominal load.
    error : float
        Share by which loss and loss factor may be off, of integration and of the loads over the face.
    ohlendorf, wimmer : float
        H_V of both; NaN outside their ranges.
    """

    pair: GearPair
    over_loads: tuple[ToothLoss, ...]
    nominal: int
    error: float
    ohlendorf: float
    wimmer: float

    @property
    def found(self) -> ToothLoss:
        """Under the nominal load."""
        return self.over_loads[self.nominal]


def _inputs(scene: Scene, name: str) -> ToothLossInputs:
    part = scene.case.pair[name]
    load, loads = part.normal_load(scene.pairs[name]) or math.nan, part.all_loads(scene.pairs[name])
    law, speed = pair_friction(scene, name, "gear-mesh-power-loss"), pair_speed(scene, name)
    return ToothLossInputs(law, speed, loads, loads.index(load), part.friction is not None, name)


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    check_speed(scene, name, "gear-mesh-power-loss")
    pair_friction(scene, name, "gear-mesh-power-loss")


def _compute(inputs: ToothLossInputs, upstream: Upstream, _work: Work) -> ToothLossData:
    teeth = loaded_teeth(upstream, inputs.name)
    losses, coarse = teeth.losses(inputs.speed, lambda load: inputs.law(teeth.pair, load))
    return _data(teeth.pair, losses, inputs.nominal, coarse)


def _data(pair: GearPair, losses: tuple[ToothLoss, ...], nominal: int, coarse: ToothLoss) -> ToothLossData:
    from fegear.formulas.friction import ohlendorf, wimmer

    closed = []
    for formula in (ohlendorf, wimmer):
        try:
            closed.append(formula(pair))
        except RangeError:
            closed.append(math.nan)
    found = losses[nominal]
    error = abs(coarse.loss_factor / found.loss_factor - 1.0)
    if found.loss:
        error = max(error, abs(coarse.loss / found.loss - 1.0))
    return ToothLossData(pair, losses, nominal, error, closed[0], closed[1])


def _present(data: ToothLossData, inputs: ToothLossInputs) -> Outcome:
    name, found, law = inputs.name, data.found, inputs.friction.law
    table = Table(
        f"tooth_loss_{name}",
        (
            column_of(found, "x"),
            Column("roll_angle", np.asarray(data.pair.roll_angle(found.x, "driver")), "deg", "of the driver"),
            column_of(found, "load"),
            column_of(found, "coefficient", meaning=f"law {law}"),
            column_of(found, "power"),
        ),
        f"Friction loss of a tooth pair of {name} along the path of contact",
    )
    error, share = data.error, found.loss / found.transmitted
    values = [
        value_of(found, "loss", name, error * found.loss),
        value_of(found, "transmitted", name, 0.0, meaning="load times speed of the base circle"),
        value_of(found, "efficiency", name, error * share, name="tooth_efficiency", further=f": {_NEGLECTED}"),
        value_of(found, "loss_factor", name, error * found.loss_factor),
        Value(f"{name}.loss_factor_wimmer", data.wimmer, "", 0.0, "H_V of rigid gears, load even along the lines"),
        Value(f"{name}.loss_factor_ohlendorf", data.ohlendorf, "", 0.0, "H_V, two pairs share alike, spur gears"),
        value_of(found, "mean_coefficient", name, meaning=f"coefficient that takes as much, law {law}"),
    ]
    remarks = [
        f"Pair {name}: loss of sliding teeth only; {_NEGLECTED}. Loads are those without friction."
    ]  # fmt: skip
    if not inputs.given:
        remarks.append(f"Pair {name}: no friction law is given, so it is Schlenk's with the lubricant of the case.")
    outside = (found.x < data.pair.x_start) | (found.x > data.pair.x_end)
    if data.pair.driver.helix_angle == 0.0 and (found.load[outside] > 0.0).any():
        most = found.load[outside].max()
        remarks.append(
            f"Pair {name}: tip corners carry up to {most:.4g} N off the path of contact; they slide "
            "as if the line of action went on there."
        )
    if math.isnan(data.ohlendorf):
        remarks.append(f"Pair {name}: Ohlendorf's H_V is for contact ratios between 1 and 2.")
    shown = tuple(value for value in values if not math.isnan(value.si))
    settings = {"friction": law, "local": inputs.friction.local, "speed": inputs.speed}
    tables, figures = [table], [_figure(data, inputs)]
    if len(inputs.loads) > 1:
        tables.append(_loads(data, inputs))
        figures.append(_loads_figure(data, inputs))
    return Outcome(data, tuple(tables), shown, settings, tuple(remarks), tuple(figures))


def _loads(data: ToothLossData, inputs: ToothLossInputs) -> Table:
    shown = ("transmitted", "loss", "loss_factor", "mean_coefficient", "efficiency")
    columns = (
        column_of(ErrorOverPitch, "total_load", inputs.loads, name="load"),
        *(column_over(data.over_loads, key) for key in shown),
    )
    return Table(f"tooth_loss_loads_{inputs.name}", columns, f"Tooth loss of pair {inputs.name} under every load")


def _loads_figure(data: ToothLossData, inputs: ToothLossInputs) -> Figure:
    name, load = inputs.name, np.array(inputs.loads)
    axis = Axis("load along the line of action", "N", zero=True)
    factor = np.array([one.loss_factor for one in data.over_loads])
    rigid = {"Ohlendorf": data.ohlendorf, "Wimmer": data.wimmer}
    if math.isclose(data.ohlendorf, data.wimmer, rel_tol=1e-9):  # spur gears: one says what the other does
        rigid = {"Ohlendorf and Wimmer": data.wimmer}
    flat = [
        Curve(load, np.full(load.size, value), who, role, dash="dash", markers=False)
        for (who, value), role in zip(rigid.items(), ("series:1", "grey"), strict=False)
        if not math.isnan(value)
    ]
    lost = np.array([1.0 - one.efficiency for one in data.over_loads]) * 100.0
    return Figure(
        f"tooth_loss_loads_{name}",
        f"Tooth loss of pair {name} over the load",
        f"Pair {name}: loss factor H_V by the computed load and of rigid gears, and share of the power "
        f"that the teeth lose by the law {inputs.friction.law}. Under little load reliefs stay open, tips unloaded.",
        (
            Panel(axis, Axis("loss factor H_{V}"), (Curve(load, factor, "computed load", "series:0"), *flat)),
            Panel(axis, Axis("power lost", "%", zero=True), (Curve(load, lost, "", "red", dash="solid"),)),
        ),
        under=f"{inputs.speed * 30.0 / math.pi:.5g} rpm",
    )


def _figure(data: ToothLossData, inputs: ToothLossInputs) -> Figure:
    name, found = inputs.name, data.found
    x, marks = found.x * 1e3, path_marks(data.pair)

    def panel(label: str, unit: str, y: np.ndarray[tuple[int, ...], np.dtype[np.float64]], role: str) -> Panel:
        curve = Curve(x, y, "", role, dash="solid", markers=False)
        return Panel(LINE_OF_ACTION, Axis(label, unit, zero=True), (curve,), marks)

    closed = {"Wimmer": data.wimmer, "Ohlendorf": data.ohlendorf}
    beside = ", ".join(f"{who} {value:.4f}" for who, value in closed.items() if not math.isnan(value))
    return Figure(
        f"tooth_loss_{name}",
        f"Friction loss of pair {name}",
        f"Pair {name}: load on a tooth pair, friction coefficient (law {inputs.friction.law}) and the power that this "
        f"pair loses from A to E. Loss factor H_V by the computed load {found.loss_factor:.4f} ({beside}); the teeth "
        f"lose {found.loss:.4g} W of {found.transmitted:.5g} W.",
        (
            panel("load on the pair", "N", found.load, "blue"),
            panel("friction coefficient", "", found.coefficient, "green"),
            panel("power lost", "W", found.power, "red"),
        ),
        under=f"{inputs.load:.5g} N, {inputs.speed * 30.0 / math.pi:.5g} rpm",
    )


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield Citation("ohlendorf", "loss factor H_V of equal sharing")
    yield Citation("wimmer", "loss factor H_V of even load along contact lines")
    part = scene.case.pair[name].friction
    law = "schlenk" if part is None else part.name
    if law in _WORKS:
        yield Citation(_WORKS[law], "friction coefficient")


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return Forecast({}, 0.05)


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
    return tuple(
        Task("gear-mesh-power-loss", pair) for pair in dict.fromkeys(part.loaded_pair_of(mesh) for mesh in part.mesh)
    )


def _train_inputs(scene: Scene, _subject: str) -> TrainLossInputs:
    from fegear.dynamics.train.matrices import static_forces

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


def _compute_train(asked: TrainLossInputs, upstream: Upstream, _work: Work) -> TrainLossData:
    found = [cast("ToothLossData", upstream[Task("gear-mesh-power-loss", pair)]) for pair in asked.pairs]
    power = np.array(asked.power)
    share = np.array([one.found.loss / one.found.transmitted for one in found])
    return TrainLossData(
        power, power * share, np.array([one.found.loss_factor for one in found]),
        np.array([one.found.mean_coefficient for one in found]), asked.driving,
        float((power * share * np.array([one.error for one in found])).sum()),
    )  # fmt: skip


def _present_train(data: TrainLossData, asked: TrainLossInputs) -> Outcome:
    efficiency = np.where(data.power > 0.0, 1.0 - data.loss / np.maximum(data.power, np.finfo(float).tiny), 1.0)
    table = Table(
        "train_loss",
        (
            Column("mesh", np.array(asked.meshes), "", "mesh of the train"),
            Column("power", data.power, "W", "that it transmits"),
            Column("tooth_loss", data.loss, "W", "that its teeth lose"),
            column_of(ToothLoss, "loss_factor", data.factor),
            column_of(ToothLoss, "mean_coefficient", data.friction),
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


def _check_train(scene: Scene, _subject: str) -> None:
    check_train(scene)


GEAR_MESH_POWER_LOSS = teeth_stage(
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)


TRAIN_LOSS = Stage(
    subjects=the_train,
    needs=_needs,
    inputs=_train_inputs,
    compute=_compute_train,
    present=_present_train,
    check=_check_train,
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
    internal=True,
)
