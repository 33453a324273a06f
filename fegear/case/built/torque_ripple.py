"""Torque ripple of a case's train: harmonics and files as the torques that act on its bodies."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.dynamics.train.torque_ripple import TorqueRipple, ripple_of_curve

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.train import TorqueRipplePart, TrainPart
    from fegear.dynamics.train.train import Train

#: How far the last torque of a file may be from the first, over its range.
_CLOSED = 1e-3
#: Fewest lines of a file: two make one straight line and back.
_FEWEST = 3


def torque_ripples(scene: Scene, part: TrainPart, train: Train) -> tuple[tuple[TorqueRipple, ...], dict[str, float]]:
    """Torques that fluctuate, those without any amplitude left out, and the mean torques of files [N m], by name.

    Parameters
    ----------
    scene : Scene
        Whose effect `torque_ripple` is on.
    part : TrainPart
    train : Train
        With its constant torques.

    Raises
    ------
    InputError
        If the case has no torque ripple, a file is no torque over one period, or an amplitude refers to no torque.
    """
    if not part.torque_ripple:
        raise InputError(
            "effects.torque_ripple", "true", "has no effect: train.torque_ripple is not specified",
            'add [train.torque_ripple] with motor = { body = "motor", order = 2, amplitude = "8 N*m" }',
        )  # fmt: skip
    found: list[TorqueRipple] = []
    means: dict[str, float] = {}
    for name, one in part.torque_ripple.items():
        ratio = abs(train.exact_ratios[train.dof[one.order_of or one.body]])
        if one.file is not None:
            ripple, means[name] = _of_file(scene, name, one, one.file, ratio)
        else:
            ripple = _of_harmonic(name, one, train, ratio)
        if any(ripple.amplitudes):
            found.append(ripple)
    return tuple(found), means


def _of_harmonic(name: str, part: TorqueRipplePart, train: Train, ratio: Fraction) -> TorqueRipple:
    size, phase = part.amplitude, part.phase
    if size is None:
        mean = sum(torque.value for torque in train.torques if torque.body == part.body)
        if mean == 0.0:
            raise InputError(
                f"train.torque_ripple.{name}.amplitude_over_mean", part.amplitude_over_mean,
                f"refers to the constant torque of body {part.body}, which has none", 'set amplitude = "8 N*m"',
            )  # fmt: skip
        size = (part.amplitude_over_mean or 0.0) * abs(mean)
        phase += math.pi if mean < 0.0 else 0.0
    if part.frequency is not None:
        return TorqueRipple(name, part.body, (size,), (phase,), frequency=part.frequency)
    order = Fraction(repr(part.order)) * ratio
    return TorqueRipple(name, part.body, (size,), (phase,), (order.numerator, order.denominator))


def _of_file(scene: Scene, name: str, part: TorqueRipplePart, file: str, ratio: Fraction) -> tuple[TorqueRipple, float]:
    from fegear.case.csv_file import read_columns

    key = f"train.torque_ripple.{name}.file"
    columns = read_columns(scene.file(file, key), key, {"angle": "angle", "time": "time", "torque": "torque"})
    places = [column for column in ("angle", "time") if column in columns]
    if len(places) != 1 or "torque" not in columns:
        raise InputError(
            key, f'"{file}"', "requires the columns angle [deg] or time [s], one of them, and torque [N*m]; it has "
            f"{columns.has}",
        )  # fmt: skip
    place, torque = columns[places[0]], columns["torque"]
    if place.size < _FEWEST or not np.all(np.diff(place) > 0.0):
        rule = f"needs at least {_FEWEST} lines, with {places[0]} strictly increasing"
        raise InputError(key, f'"{file}"', rule)
    _refuse_open(torque, key, file)
    if places[0] == "time":
        if part.order_of is not None:
            raise InputError(
                f"train.torque_ripple.{name}.order_of", f'"{part.order_of}"', "is not used with torques over time",
                "remove it",
            )  # fmt: skip
        return ripple_of_curve(name, part.body, place, torque, part.harmonics)
    return ripple_of_curve(name, part.body, place / (2.0 * math.pi), torque, part.harmonics, ratio)


def _refuse_open(torque: Array, key: str, file: str) -> None:
    """Refuse a torque that ends elsewhere than it began: its period is not all there."""
    if abs(torque[-1] - torque[0]) > _CLOSED * np.ptp(torque):
        raise InputError(
            key, f'"{file}"', f"begins with {torque[0]:.6g} N m and ends with {torque[-1]:.6g} N m: not a full period",
            "add a last line one period after the first with the same torque",
        )  # fmt: skip
