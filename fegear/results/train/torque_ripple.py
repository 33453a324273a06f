"""Stage ``torque-ripple``: what torques that fluctuate do to meshes and shafts of the linearised train.

Per unit of torque over frequency, and line by line at the speed of the case.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base import effects
from fegear.case.built.train import TrainInputs, train_inputs
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Mark, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Need, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.train.gear_train import RPM, gear_train, needs_one_speed, needs_train, the_train

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Complex
    from fegear.case.reading import Scene
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.torque_response import RippleSpectrum, TorqueResponse

#: Share of a ripple beyond which what a file's harmonics leave out is noted.
_LEFT_OUT = 0.01
#: Mean torque of a file that is worth a note, over its amplitude.
_SOME_MEAN = 1e-6


@dataclass(frozen=True)
class TorqueRippleInputs:
    """What the response depends on besides the train's teeth.

    Parameters
    ----------
    train : TrainInputs
    frequencies : ndarray
        [Hz].
    speed : float
        Of the body that speeds refer to [rad/s].
    """

    train: TrainInputs
    frequencies: Array
    speed: float


@dataclass(frozen=True)
class TorqueRippleData:
    """Response per unit of torque over frequency, by the body that it acts on, and the lines at the speed, if any."""

    train: GearTrain
    frequencies: Array
    responses: dict[str, TorqueResponse]
    lines: RippleSpectrum | None
    swings: tuple[tuple[float, float], ...]


def _inputs(scene: Scene, _subject: str) -> TorqueRippleInputs:
    part = scene.case.dynamics
    return TorqueRippleInputs(train_inputs(scene), part.frequencies.array, part.one_speed)


def _compute(asked: TorqueRippleInputs, upstream: Upstream, _work: Work) -> TorqueRippleData:
    from fegear.dynamics.train.torque_response import ripple_spectrum, torque_response

    data = gear_train(upstream)
    if not data.ripple:
        return TorqueRippleData(data, asked.frequencies, {}, None, ())
    bodies = dict.fromkeys(one.body for one in data.ripple)
    omega = 2.0 * math.pi * asked.frequencies
    responses = {body: torque_response(data.train, omega, body) for body in bodies}
    lines = ripple_spectrum(data.train, data.ripple, [asked.speed / data.speed_ratio])
    carriers = (*lines.forces[:, :, 0], *lines.shafts[:, :, 0])
    return TorqueRippleData(data, asked.frequencies, responses, lines, tuple(_swing(lines, one) for one in carriers))


def _swing(lines: RippleSpectrum, carried: Complex) -> tuple[float, float]:
    """Smallest and largest that all ripple adds to what a mesh or shaft carries, ripples at their worst phases."""
    whose = np.array(lines.of)
    found = [one.extremes(carried[whose == k]) for k, one in enumerate(lines.ripple)]
    return sum(low for low, _ in found), sum(high for _, high in found)


def _present(made: TorqueRippleData, asked: TorqueRippleInputs) -> Outcome:
    data, lines = made.train, made.lines
    remarks = _file_remarks(asked.train)
    if lines is None:
        return Outcome(made, remarks=(*remarks, "Torque ripple: all amplitudes are zero."))
    values = []
    for name, mean, (low, high) in zip(data.names, data.forces, made.swings, strict=False):
        worst = " with ripples at their worst phases" if len(data.ripple) > 1 else ""
        values.append(Value(f"{name}.force_by_torque_ripple", high, "N", None, f"maximum dynamic increment{worst}"))
        if mean > 0.0:
            values.append(
                Value(f"{name}.share_of_mean_force", high / float(mean), "", None, "this maximum / mean force")
            )
        if 0.0 < mean < -low:
            remarks.append(
                f"Mesh {name}: torque ripple reduces the mean force of {mean:.4g} N by {-low:.4g} N: loss of contact "
                "(not modelled here). Request dynamic-factor with effects.contact_loss = true."
            )
    shafts = data.train.elastic_shafts
    for shaft, (low, high) in zip(shafts, made.swings[len(data.names) :], strict=True):
        largest = max(high, -low)
        values.append(Value(f"{shaft.name}.torque_by_torque_ripple", largest, "N.m", None, "maximum dynamic increment"))
    for one in data.ripple:
        if one.left_out > 0.0:
            meaning = "root mean square torque of the omitted harmonics of the file"
            values.append(Value(f"{one.name}.torque_left_out", one.left_out, "N.m", None, meaning))
    tables = _lines_table(lines, data), *_response_tables(made)
    return Outcome(made, tables, tuple(values), {"speed": asked.speed}, tuple(remarks), _figures(made, asked.speed))


def _file_remarks(asked: TrainInputs) -> list[str]:
    """Mean torques of files that were left out, and harmonics that were where they are more than a little."""
    said = []
    for one in asked.ripple:
        size = math.sqrt(0.5 * sum(a * a for a in one.amplitudes))
        mean = asked.ripple_means.get(one.name, 0.0)
        if abs(mean) > _SOME_MEAN * size:
            said.append(
                f"Torque ripple {one.name}: mean torque of {mean:.5g} N m in its file ignored; constant torques from "
                "train.torque."
            )
        if one.left_out > _LEFT_OUT * size:
            said.append(
                f"Torque ripple {one.name}: harmonics above {len(one.amplitudes)} omitted, {one.left_out:.3g} N m "
                f"(root mean square) of {math.hypot(size, one.left_out):.3g} N m; increase "
                f"train.torque_ripple.{one.name}.harmonics."
            )
    return said


def _lines_table(lines: RippleSpectrum, data: GearTrain) -> Table:
    names = [lines.ripple[k].name for k in lines.of]
    bodies = [lines.ripple[k].body for k in lines.of]
    columns = [
        Column("ripple", np.array(names, dtype=str), "", "name"),
        Column("body", np.array(bodies, dtype=str), "", "body on which it acts"),
        column_of(lines, "harmonics"),
        column_of(lines, "frequencies", lines.frequencies[:, 0]),
        Column("torque", np.abs(lines.torques), "N.m", "0-peak"),
        Column("phase", np.angle(lines.torques), "deg", "phase of the torque (cosine) at time zero"),
    ]
    for m, name in enumerate(data.names):
        columns.append(Column(f"force_{name}", np.abs(lines.forces[m, :, 0]), "N", f"force amplitude in mesh {name}"))
    for s, shaft in enumerate(data.train.elastic_shafts):
        size = np.abs(lines.shafts[s, :, 0])
        columns.append(Column(f"torque_{shaft.name}", size, "N.m", f"torque amplitude in shaft {shaft.name}"))
    return Table("torque_ripple", tuple(columns), "Torque ripple lines and resulting mesh forces and shaft torques")


def _response_tables(made: TorqueRippleData) -> list[Table]:
    tables = []
    for body, found in made.responses.items():
        columns = [Column("frequency", made.frequencies, "Hz", "frequency of the torque")]
        for name, force in zip(made.train.names, found.forces, strict=True):
            columns += _parts(f"force_{name}", force, "N/(N.m)", f"force in mesh {name} per torque at {body}")
        for shaft, torque in zip(made.train.train.elastic_shafts, found.shafts, strict=True):
            meaning = f"torque in shaft {shaft.name}, from {shaft.a} to {shaft.b}, per torque at {body}"
            columns += _parts(f"torque_{shaft.name}", torque, "", meaning)
        title = f"Response of meshes and shafts to torque at body {body}"
        tables.append(Table(f"torque_response_{body}", tuple(columns), title))
    return tables


def _parts(name: str, z: Complex, unit: str, meaning: str) -> list[Column]:
    return [Column(f"{name}_re", z.real, unit, meaning), Column(f"{name}_im", z.imag, unit, meaning)]


def _figures(made: TorqueRippleData, speed: float) -> tuple[Figure, ...]:
    return tuple(_figure(made, body, speed) for body in made.responses)


def _figure(made: TorqueRippleData, body: str, speed: float) -> Figure:
    """Response over frequency to torque at one body, with the lines that act there."""
    data, found, lines = made.train, made.responses[body], made.lines
    frequency = Axis("frequency", "Hz", log=True)
    on_body = [k for k, one in enumerate(data.ripple) if one.body == body]
    marks: list[Mark] = []
    points: list[Points] = []
    if lines is not None:
        low, high = float(made.frequencies[0]), float(made.frequencies[-1])
        for k in on_body:
            own = np.array(lines.of) == k
            at = lines.frequencies[own, 0]
            inside = (at >= low) & (at <= high)
            label = f"torque ripple {data.ripple[k].name}"
            if inside.any():
                marks.append(Mark("x", float(at[inside][0]), label))
            for m in range(len(data.names)):
                per_torque = np.abs(lines.forces[m, own, 0] / lines.torques[own])
                size = np.abs(lines.forces[m, own, 0])[inside]
                notes = tuple(f"{f:.5g} Hz: {w:.4g} N" for f, w in zip(at[inside], size, strict=True))
                if inside.any():
                    points.append(Points(at[inside], per_torque[inside], "", f"series:{m}", notes=notes, size=7))
    curves = [
        Curve(made.frequencies, np.abs(force), f"mesh {name}", f"series:{m}", markers=False)
        for m, (name, force) in enumerate(zip(data.names, found.forces, strict=True))
    ]
    panels = [Panel(frequency, Axis("force per torque", "N/(N.m)", log=True), (*curves, *points), tuple(marks))]
    shafts = data.train.elastic_shafts
    if shafts:
        drawn = tuple(
            Curve(made.frequencies, np.abs(torque), f"shaft {shaft.name}", f"series:{s}", markers=False)
            for s, (shaft, torque) in enumerate(zip(shafts, found.shafts, strict=True))
        )
        panels.append(Panel(frequency, Axis("torque per torque", log=True), drawn, tuple(marks)))
    return Figure(
        f"torque_response_{body}", f"Response to torque at body {body}",
        f"Amplitudes of mesh forces and shaft torques per amplitude of a torque at body {body}, mean mesh stiffness. "
        f"Points: lines of its torque ripple at {speed * RPM:.6g} rpm of {data.speed_of}.",
        tuple(panels), under=f"{speed * RPM:.6g} rpm",
    )  # fmt: skip


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """One small solution for each frequency and body."""
    count = scene.case.dynamics.frequencies.count
    bodies = len({one.body for one in scene.case.train.torque_ripple.values()}) if scene.case.train else 0
    return Forecast({"frequencies": count}, 0.01 + 1e-4 * count * bodies)


TORQUE_RIPPLE = Stage(
    subjects=the_train,
    needs=needs_train,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=needs_one_speed,
    requires=(Need(effects.TORQUE_RIPPLE.name, "the torques of train.torque_ripple are its load"),),
    cites=citing(Citation("mark", "gear train of rotors, shafts and meshes, excited by a torque", "section 2")),
    forecast=_forecast,
)
