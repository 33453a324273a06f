"""Traces of strain gauges: read from their files, divided by the torque where a column has it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.printed import figures, percent
from fegear.case.built.angle_of_time import steady_turning
from fegear.case.built.bridge_output import COLUMN_OF_STRAIN, strain_of_bridge
from fegear.case.built.trace_levels import change_along, no_level, of_driven, said_of_rest, torque_levels
from fegear.case.csv_file import read_columns
from fegear.contact.curve_fit import DRIFT_TURNS, FEWEST
from fegear.contact.trace_outliers import suspected
from fegear.contact.turns import turns_along

if TYPE_CHECKING:
    from fegear.case.gauge import MeasuredStrainPart
    from fegear.case.reading import Scene
    from fegear.contact.fitted_line import Fitted

#: Largest strain that a gauge in steel survives.
_LARGEST_STRAIN = 0.05
#: Part of its turns that a trace may lack.
_SLACK = 1e-3
#: Names of columns that a file need not have.
_TORQUE, _TIME = "torque", "time"
#: Deviation of turns from the rotation at a constant speed from which on it is said [rad].
_WANDERS = math.radians(1.0)
_RPM = 30.0 / math.pi


@dataclass(frozen=True)
class StrainLevel:
    """The samples of a trace at one torque of the pair.

    Parameters
    ----------
    load : float
        The pair's [N].
    level, torque : float
        Torque on the driver under that load, and the mean of the samples [N m].
    angle, strain : ndarray, shape (N,)
    """

    load: float
    level: float
    torque: float
    angle: Array
    strain: Array


@dataclass(frozen=True)
class MeasuredStrain:
    """A trace of a gauge.

    Parameters
    ----------
    angle, strain : ndarray, shape (N,)
        In the sense of the gear's rotation [rad], and as measured; at the nominal load where the file has the torque.
    fit : tuple of str
        What is fitted.
    reading : str
        What had to be understood in the file: decimal commas, lines that were passed over.
    levels : tuple of StrainLevel
        By torque, ascending, the nominal one among them; empty without a column of it.
    file : str
    runout : bool
        Whether what it has once per turn is subtracted.
    speed : float or None
        Of the gear [rad/s], where the angle is that of this constant speed.
    of_mate : bool
        Whether the angle was that of the shaft of the mating gear.
    """

    angle: Array
    strain: Array
    fit: tuple[Fitted, ...]
    reading: str
    levels: tuple[StrainLevel, ...] = ()
    file: str = field(compare=False, default="")
    runout: bool = False
    speed: float | None = None
    of_mate: bool = False


def measured_strain(scene: Scene, name: str, part: MeasuredStrainPart, pair: str, teeth: int) -> MeasuredStrain:
    """The trace of a gauge on a gear of a pair.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the gauge.
    part : MeasuredStrainPart
    pair : str
    teeth : int
        Of its gear.

    Raises
    ------
    InputError
        If the file is no trace, or has none at the nominal torque.
    """
    key = f"gauge.{name}.measured.file"
    columns: dict[str, str | tuple[str, ...]] = {
        part.angle_column: "angle", part.strain_column: COLUMN_OF_STRAIN, part.torque_column: "torque",
        part.time_column: "time",
    }  # fmt: skip
    given = {
        part.angle_column: part.angle, part.strain_column: part.strain, part.torque_column: part.torque,
        part.time_column: part.time,
    }  # fmt: skip
    found = read_columns(
        scene.file(part.file, key), key, columns, {column: unit for column, unit in given.items() if unit}, gaps=True
    )
    found.require(part.strain_column, key, part.file, "strain_column")
    for column, usual, word in (
        (part.torque_column, _TORQUE, "torque_column"),
        (part.time_column, _TIME, "time_column"),
    ):
        if column != usual:
            found.require(column, key, part.file, word)
    reading = [found.reading] if found.reading else []
    strain, said = strain_of_bridge(
        found[part.strain_column], part, *found.units[part.strain_column], f"gauge.{name}.measured"
    )
    reading += [said] if said else []
    speed = None
    if part.time_column in found and (part.angle_column not in found or part.time_column != _TIME):
        angle, said, speed = _rotation(scene, name, part, pair, teeth, found[part.time_column], strain)
        reading.append(said)
    else:
        found.require(part.angle_column, key, part.file, "angle_column (at a constant speed: time_column and speed)")
        if part.speed is not None:
            raise InputError(
                f"gauge.{name}.measured.speed", f"{part.speed * _RPM:.6g} rpm",
                f'has no effect: "{part.file}" has the angle in column {part.angle_column}', "remove it",
            )  # fmt: skip
        angle = found[part.angle_column]
        if part.shaft is not None:  # of which the mate turns several times, or a part of a turn, for one of the gear
            angle = np.unwrap(angle) * _turns_for_one(scene, pair, part.shaft, teeth)
    torque = found.get(part.torque_column)
    angle = -angle if part.reverse else angle
    levels: tuple[StrainLevel, ...] = ()
    if torque is not None and scene.case.pair[pair].all_loads(scene.pairs[pair]):
        levels, more = _levels(scene, part, pair, 2.0 * math.pi / abs(teeth), key, angle, strain, torque)
        reading += more
        nominal = scene.case.pair[pair].normal_load(scene.pairs[pair])
        at_nominal = next(one for one in levels if one.load == nominal)
        angle, strain = at_nominal.angle, at_nominal.strain
    _check(name, key, part, angle, strain)
    fit = tuple(one for one in part.fit if one != "runout")
    of_mate = part.shaft is not None and _turns_for_one(scene, pair, part.shaft, teeth) != 1.0
    return MeasuredStrain(
        angle, strain, fit, ", ".join(reading), levels, part.file, "runout" in part.fit, speed, of_mate
    )  # fmt: skip


def _turns_for_one(scene: Scene, pair: str, shaft: str, teeth: int) -> float:
    """Turns of a gear with these teeth for one of a shaft."""
    return abs((scene.pairs[pair].driver if shaft == "driver" else scene.pairs[pair].driven).teeth / teeth)


def _rotation(
    scene: Scene, name: str, part: MeasuredStrainPart, pair: str, teeth: int, time: Array, strain: Array
) -> tuple[Array, str, float]:  # fmt: skip
    """Rotation of a gear at a constant speed from the time of the samples [rad], how that was found, and it."""
    key, of_pair = f"gauge.{name}.measured", scene.case.pair[pair].speed
    if part.speed is None and of_pair is None:
        raise InputError(
            f"{key}.speed", "(not given)", f'is required: "{part.file}" has the time in column {part.time_column} and '
            f"no column {part.angle_column}", "set speed to the constant speed of the gear of the gauge during the "
            f'trace, e.g. "1000 rpm" (or pair.{pair}.speed to that of the driver), or set angle_column',
        )  # fmt: skip
    if np.any(np.diff(time) <= 0.0):
        raise InputError(
            f"{key}.file", f'"{part.file}"', f"must have ascending times in column {part.time_column}", "sort the lines"
        )
    own = part.speed is not None
    shaft = (part.shaft or "") if own else "driver"
    speed = (part.speed or of_pair or 0.0) * (_turns_for_one(scene, pair, shaft, teeth) if shaft else 1.0)
    found = steady_turning(time, strain, speed)
    stated = f"{speed * _RPM:.6g} rpm, {'the stated speed' if own else f'the speed of pair {pair}'}"
    if found.found:
        stated = f"{found.speed * _RPM:.6g} rpm, the period of the trace (stated: {speed * _RPM:.6g} rpm)"
    said = f"rotation from the time at {stated}"
    if found.wander > _WANDERS:
        said += f"; the speed was not constant: parts of the trace are up to {math.degrees(found.wander):.2g}° off"
    return found.speed * (time - time[0]), said, found.speed


def _levels(
    scene: Scene, part: MeasuredStrainPart, pair: str, pitch: float, key: str, angle: Array, strain: Array,
    torque: Array,
) -> tuple[tuple[StrainLevel, ...], list[str]]:  # fmt: skip
    """Samples at each torque of a pair, and what was left out; ramps through another torque are no level."""
    placed, mesh = scene.pairs[pair], scene.case.pair[pair]
    loads, nominal = mesh.all_loads(placed), mesh.normal_load(placed)
    torques = np.array(loads) * placed.driver.base_radius * mesh.halves
    runs = torque_levels(torque, angle, pitch, torques, part.torque_band)
    if not runs:
        raise no_level(key, part.file, pair, torque, angle, torques, placed.ratio, part)
    levels: list[StrainLevel] = []
    said: list[str] = []
    for k, run in runs.items():
        count, change, at = run.stop - run.start, change_along(torque[run]), f"{figures(torques[k], 5)} N m"
        ramp = f"torque changes by {percent(abs(change))} along them" if abs(change) > part.torque_band else ""
        # a whole turn on a slow ramp has the engagement of the tooth near the torque: better than none at the nominal
        usable = count >= FEWEST + len(part.fit) and not (ramp and (loads[k] != nominal or turns_of(angle[run]) < 1.0))
        if not usable:
            said.append(f"{count} samples at {at} left out ({ramp or 'too few'})")
            continue
        if ramp:
            said.append(f"{count} samples at {at} ({ramp})")
        levels.append(StrainLevel(loads[k], float(torques[k]), float(torque[run].mean()), angle[run], strain[run]))
    if nominal not in [one.load for one in levels]:
        have = ", ".join(figures(one.level, 5) for one in levels)
        level = torques[loads.index(nominal)] if nominal is not None else torques[-1]
        raise InputError(
            key, f'"{part.file}"',
            f"has no run of samples at a steady torque within ±{percent(part.torque_band)} of the nominal torque of "
            f"pair {pair}, {figures(level, 5)} N m" + (f"; it has runs at {have} N m" if have else ""),
            of_driven(float(np.median(torque)), torques, placed.ratio, part.torque_band)
            or f"set pair.{pair}.torque to a measured torque",
        )  # fmt: skip
    return tuple(levels), said_of_rest(torque, angle, list(runs.values()), torques, part.torque_band, pair) + said


def _check(name: str, key: str, part: MeasuredStrainPart, angle: Array, strain: Array) -> None:
    """Refuse what is no trace."""
    if angle.size < FEWEST + len(part.fit):
        raise InputError(
            key, f'"{part.file}"', f"has {angle.size} samples, fewer than {FEWEST + len(part.fit)}",
            "specify a whole engagement",
        )  # fmt: skip
    if "drift" in part.fit and (turns := turns_of(angle)) < DRIFT_TURNS * (1.0 - _SLACK):
        raise InputError(
            f"gauge.{name}.measured.fit", "drift",
            f'requires a trace of {DRIFT_TURNS:g} turns, "{part.file}" has {turns:.3g}: too few to separate a '
            "drift from the shape of the curve", "remove drift",
        )  # fmt: skip
    likely = ~suspected(strain)[0]  # what an amplifier writes for nothing is no strain
    largest = float(np.abs(strain - np.median(strain))[likely].max(initial=0.0))
    if largest > _LARGEST_STRAIN:
        raise InputError(
            key, f"strain of {largest * 1e2:.3g} %", f"is above {_LARGEST_STRAIN * 1e2:g} %",
            "check the unit in the head of the column",
        )  # fmt: skip
    for what, values in (("angle", angle), ("strain", strain)):
        if float(np.ptp(values)) <= 1e-12 * max(float(np.abs(values).max()), 1e-300):
            raise InputError(key, f'"{part.file}"', f"has the same {what} in every line", "check the columns")


def turns_of(angle: Array) -> float:
    """Turns of a trace, with the step after its last sample."""
    return float(np.ptp(turns_along(angle))) * angle.size / (angle.size - 1.0)
