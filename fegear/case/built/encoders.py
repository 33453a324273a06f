"""Measured transmission errors of a case: which pair, at which loads, and the traces."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.printed import percent
from fegear.case.built.angle_of_time import mesh_turning
from fegear.case.built.trace_levels import no_level, of_driven, said_of_pair, said_of_rest, torque_levels
from fegear.case.csv_file import read_columns

if TYPE_CHECKING:
    from fegear.case.encoders import EncodersPart
    from fegear.case.reading import Scene
    from fegear.contact.fitted_line import Fitted
    from fegear.geometry.pair import GearPair, Member

#: Loads that differ by less, over one of them, are the same.
_SAME_LOAD = 1e-6
#: Torques measured on the driven shaft are those of the driver times the ratio, less losses and what is rounded.
_ABOUT = 0.03
#: Largest transmission error of a pair [m].
_LARGEST = 5e-3
#: Difference of the ratio of two encoders from that of the teeth from which on they are not those of the pair.
_OTHER_RATIO = 0.01
#: Deviation from the rotation at a constant speed from which on it is said, a tooth pitch being a turn [rad].
_WANDERS = 0.02 * 2.0 * np.pi
_RPM = 30.0 / np.pi


@dataclass(frozen=True)
class ErrorTrace:
    """One measured transmission error.

    Parameters
    ----------
    angle, te : ndarray, shape (N,)
        Rotation of the shaft in its sense [rad]; lag of the driven gear along the line of action [m].
    load : float
        [N].
    reading : str
        What had to be understood in the file: decimal commas, lines that were passed over.
    key, file : str
        Where the case names it.
    of_angle : bool
        Whether the transmission error is given as an angle.
    speed : float or None
        Of the shaft of the angle, as far as it is known [rad/s].
    """

    angle: Array
    te: Array
    load: float
    reading: str
    key: str = field(compare=False)
    file: str = field(compare=False)
    of_angle: bool = False
    speed: float | None = None


@dataclass(frozen=True)
class Encoders:
    """Traces of a pair.

    Parameters
    ----------
    pair : str
    member : {"driver", "driven"}
        Whose rotation the angles count.
    fit : tuple of str
    load_tolerance : float
    traces : tuple of ErrorTrace
        By load, ascending.
    estimates : bool
        Whether errors of the computed one are estimated.
    halves : int
        2 of a double helical pair, whose loads are those of one half.
    """

    pair: str
    member: Member
    fit: tuple[Fitted, ...]
    load_tolerance: float
    traces: tuple[ErrorTrace, ...]
    estimates: bool
    name: str = field(compare=False)
    halves: int = 1


def pair_of_encoders(scene: Scene, name: str) -> str:
    """Name of the pair whose transmission error was measured."""
    part, pairs = scene.case.encoders[name], tuple(scene.case.pair)
    if part.pair is not None:
        return part.pair
    if len(pairs) != 1:
        raise InputError(
            f"encoders.{name}.pair", "(not given)", f"is required: the case has {len(pairs)} pairs", "specify one"
        )
    return pairs[0]


def encoders_of(scene: Scene, name: str) -> Encoders:
    """Measured transmission errors of a case.

    Raises
    ------
    InputError
        If a file is no trace, or a torque is none of the pair's.
    """
    part, pair = scene.case.encoders[name], pair_of_encoders(scene, name)
    placed, mesh = scene.pairs[pair], scene.case.pair[pair]
    loads, nominal = mesh.all_loads(placed), mesh.normal_load(placed)
    lever, of_angle = placed.driver.base_radius * mesh.halves, part.te_at != "line-of-action"
    traces: list[ErrorTrace] = []
    said = said_of_pair(pair, np.array(loads) * lever)
    for i, one in enumerate(part.traces):
        key = f"encoders.{name}.traces[{i}]"
        wanted = nominal if one.torque is None else one.torque / lever
        read = _trace(scene, name, placed, one.file, f"{key}.file")
        if one.torque is None and read.torque is not None:
            torques = np.array(loads) * lever
            pitch = 2.0 * np.pi / abs((placed.driver if part.shaft == "driver" else placed.driven).teeth)
            found = torque_levels(read.torque, read.angle, pitch, torques, part.torque_band)
            if not found:
                raise no_level(f"{key}.file", one.file, pair, read.torque, read.angle, torques, placed.ratio, part)
            reading = [read.reading] if read.reading else []
            reading += said_of_rest(read.torque, read.angle, list(found.values()), torques, part.torque_band, pair)
            traces += [
                ErrorTrace(
                    read.angle[run], read.te[run], loads[k], ", ".join(reading), key, one.file, of_angle, read.speed
                )
                for k, run in found.items()
            ]
            continue
        known = [load for load in loads if wanted is not None and abs(load - wanted) <= _SAME_LOAD * load]
        if wanted is not None and not known:
            raise InputError(
                f"{key}.torque", f"{wanted * lever:.6g} N*m", f"is not a torque of {said}",
                of_driven(wanted * lever, np.array(loads) * lever, placed.ratio, _ABOUT)
                or f"add it to pair.{pair}.torques",
            )  # fmt: skip
        load = known[0] if known else 0.0
        traces.append(ErrorTrace(read.angle, read.te, load, read.reading, key, one.file, of_angle, read.speed))
    traces.sort(key=lambda one: one.load)
    same = [two for two in pairwise(traces) if two[0].load == two[1].load]
    if same:
        given = {f"encoders.{name}.traces[{i}]": one.torque for i, one in enumerate(part.traces)}
        again = next((one.key for one in same[0] if given[one.key] is None), same[0][1].key)
        torque = f"{same[0][1].load * lever:.6g} N*m" if given[again] is None else f"{given[again]:.6g} N*m"
        raise InputError(
            f"{again}.torque", torque, "is that of another trace", "specify the torque at which it was measured"
        )
    return Encoders(
        pair, part.shaft, tuple(part.fit), part.load_tolerance, tuple(traces), scene.estimates, name, mesh.halves
    )  # fmt: skip


@dataclass(frozen=True)
class _Columns:
    """Of one file, in the senses of the computed curves; the torque where it has one [N m]."""

    angle: Array
    te: Array
    torque: Array | None
    reading: str
    speed: float | None


def _trace(scene: Scene, name: str, pair: GearPair, file: str, key: str) -> _Columns:
    """Columns of one file."""
    part = scene.case.encoders[name]
    along, angles = part.te_at == "line-of-action", part.mate_column is not None
    measured, word = (part.mate_column, "mate_column") if part.mate_column else (part.te_column, "te_column")
    columns = {
        part.angle_column: "angle", measured: "length" if along and not angles else "angle",
        part.torque_column: "torque", part.time_column: "time",
    }  # fmt: skip
    given = {
        part.angle_column: part.angle, measured: part.angle if angles else part.te, part.torque_column: part.torque,
        part.time_column: part.time,
    }  # fmt: skip
    units = {name: unit for name, unit in given.items() if unit}
    found = read_columns(scene.file(file, key), key, columns, units, gaps=True)
    over_time = not angles and part.angle_column not in found and part.time_column in found
    if over_time:
        found.require(measured, key, file, word)
    else:
        for column, of in (
            (part.angle_column, "angle_column (at a constant speed: time_column and speed)"),
            (measured, word),
        ):
            found.require(column, key, file, of)
    te = found[measured]
    angle, said, speed = (
        _rotation(scene, name, pair, file, key, found[part.time_column], te)
        if over_time
        else (found[part.angle_column], "", _stated_speed(scene, name, pair))
    )
    for what, values in (("angle", angle), ("angle" if angles else "transmission error", te)):
        if float(np.ptp(values)) <= 1e-12 * max(float(np.abs(values).max()), 1e-300):
            raise InputError(key, f'"{file}"', f"has the same {what} in every line", "check the columns")
    if angles:
        angle, te = _of_both_shafts(part, pair, -angle if part.reverse else angle, te, key)
    else:
        if not along:
            te = te * (pair.driver if part.te_at == "driver" else pair.driven).base_radius
        angle, te = -angle if part.reverse else angle, -te if part.positive == "lead" else te
    largest = float(np.ptp(te))
    if largest > _LARGEST:
        raise InputError(
            key, f"range of {largest * 1e3:.4g} mm", f"is above {_LARGEST * 1e3:g} mm",
            "check the unit of the angles" if angles else "check the unit and te_at",
        )  # fmt: skip
    reading = ", ".join(filter(None, (found.reading, said)))
    return _Columns(angle, te, found.get(part.torque_column), reading, speed)


def _stated_speed(scene: Scene, name: str, pair: GearPair) -> float | None:
    """Speed of the shaft of the angle [rad/s]: its own, or that of the pair."""
    part, of_pair = scene.case.encoders[name], scene.case.pair[pair_of_encoders(scene, name)].speed
    if part.speed is not None or of_pair is None:
        return part.speed
    gear = pair.driver if part.shaft == "driver" else pair.driven
    return of_pair * abs(pair.driver.teeth / gear.teeth)


def _rotation(
    scene: Scene, name: str, pair: GearPair, file: str, key: str, time: Array, te: Array
) -> tuple[Array, str, float]:  # fmt: skip
    """Rotation of the shaft at a constant speed from the time of the samples [rad], how that was found, and it."""
    part = scene.case.encoders[name]
    stated = _stated_speed(scene, name, pair)
    if stated is None:
        raise InputError(
            f"encoders.{name}.speed", "(not given)", f'is required: "{file}" has the time in column '
            f"{part.time_column} and no column {part.angle_column}",
            'set speed to the constant speed of shaft during the trace, e.g. "60 rpm", or set angle_column',
        )  # fmt: skip
    if np.any(np.diff(time) <= 0.0):
        raise InputError(
            key, f'"{file}"', f"must have ascending times in column {part.time_column}", "sort the lines"
        )  # fmt: skip
    teeth = abs((pair.driver if part.shaft == "driver" else pair.driven).teeth)
    found = mesh_turning(time, te, stated, teeth)
    at = f"{stated * _RPM:.6g} rpm, the {'stated speed' if part.speed else 'speed of the pair'}"
    if found.found:
        at = f"{found.speed * _RPM:.6g} rpm, the period of the mesh (stated: {stated * _RPM:.6g} rpm)"
    said = f"rotation from the time at {at}"
    if found.wander * teeth > _WANDERS:
        share = percent(found.wander * teeth / (2.0 * np.pi))
        said += f"; the speed was not constant: parts of the trace are up to {share} of a tooth pitch off"
    return found.speed * (time - time[0]), said, found.speed


def _of_both_shafts(
    part: EncodersPart, pair: GearPair, angle: Array, mate: Array, key: str
) -> tuple[Array, Array]:  # fmt: skip
    """Rotation of the shaft along the trace [rad], and the lag of the driven gear along the line of action [m].

    Either angle may restart with every revolution; the sense in which the mate's encoder counts is that in which the
    shafts turn with each other. The zeros of two encoders have nothing in common: the mean of the lag is zero.
    """
    own, other = (np.unwrap(one) for one in (angle, mate))
    turned, mate_turned = (float(one[-1] - one[0]) for one in (own, other))
    gears = [pair.driver, pair.driven] if part.shaft == "driver" else [pair.driven, pair.driver]
    ratio = gears[1].base_radius / gears[0].base_radius
    if abs(turned) > _OTHER_RATIO and abs(abs(mate_turned / turned) * ratio - 1.0) > _OTHER_RATIO:
        raise InputError(
            key, f'column "{part.mate_column}"',
            f'turns {abs(mate_turned / turned):.5g} times as far as "{part.angle_column}"; the teeth require '
            f"{1.0 / ratio:.5g}", "check shaft, both columns and their units",
        )  # fmt: skip
    other = other if mate_turned * turned >= 0.0 else -other
    ahead = own * gears[0].base_radius - other * gears[1].base_radius
    lag = ahead if part.shaft == "driver" else -ahead
    return own, np.asarray(lag - lag.mean())
