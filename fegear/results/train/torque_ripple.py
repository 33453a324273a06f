"""Stage ``torque-ripple``: what torques that fluctuate do to meshes and shafts of the linearised train.

Per unit of torque over frequency, and line by line at the speed of the case.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.shown import shown, shows
from fegear.case.built.train import TrainInputs, train_inputs
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import itself
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.train.gear_train import RPM, gear_train, needs_one_speed, needs_train, the_train
from fegear.results.train.ripple_spectrum import RippleLines

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.torque_response import RippleSpectrum, TorqueResponse
    from fegear.engine.sheet.seen import Seen

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
class MeshSwing:
    """What torque ripple adds to the force in a mesh, ripples at their worst phases."""

    name: str
    mean: float
    low: float
    worst: str
    high: float = shown("N", "maximum dynamic increment", name="force_by_torque_ripple")

    @property
    @shows("", "this maximum / mean force", name="share_of_mean_force")
    def share(self) -> float | None:
        """None without a mean force."""
        return self.high / self.mean if self.mean > 0.0 else None

    @property
    @shows("N", "by which the mean force is reduced")
    def reduction(self) -> float:
        """[N]."""
        return -self.low

    @property
    def lost(self) -> bool:
        """Whether teeth lose contact."""
        return 0.0 < self.mean < -self.low


@dataclass(frozen=True)
class ShaftSwing:
    """What torque ripple adds to the torque in a shaft."""

    name: str
    torque: float = shown("N.m", "maximum dynamic increment", name="torque_by_torque_ripple")


@dataclass(frozen=True)
class Carried:
    """What a mesh (force) or a shaft (torque) carries per torque at a body, complex amplitudes over frequency."""

    name: str
    role: str
    meaning: str
    frequency: Array = shown("Hz", "frequency")
    force: Complex | None = shown("N/(N.m)", "force per torque")
    torque: Complex | None = shown("", "torque per torque")


@dataclass(frozen=True)
class DrawnPoints:
    """Lines of one torque ripple in the response of a mesh."""

    role: str
    notes: tuple[str, ...]
    frequency: Array = shown("Hz", "frequency")
    force: Array = shown("N/(N.m)", "force per torque")


@dataclass(frozen=True)
class BodyResponse:
    """Response over frequency to torque at one body, with the lines that act there."""

    made: TorqueRippleData
    body: str
    found: TorqueResponse

    @property
    @shows("Hz", "frequency of the torque")
    def frequency(self) -> Array:
        """[Hz]."""
        return self.made.frequencies

    @property
    def meshes(self) -> list[Carried]:
        """Forces in the meshes."""
        return [
            Carried(name, f"series:{m}", f"force in mesh {name} per torque at {self.body}", self.frequency, force, None)
            for m, (name, force) in enumerate(zip(self.made.train.names, self.found.forces, strict=True))
        ]

    @property
    def shafts(self) -> list[Carried]:
        """Torques in the shafts."""
        return [
            Carried(
                one.name, f"series:{s}", f"torque in shaft {one.name}, from {one.a} to {one.b}, per torque at "
                f"{self.body}", self.frequency, None, torque,
            )
            for s, (one, torque) in enumerate(zip(self.made.train.train.elastic_shafts, self.found.shafts, strict=True))
        ]  # fmt: skip

    @property
    def _inside(self) -> dict[int, NDArray[np.intp]]:
        """Lines within the frequencies, by the number of the ripple that acts on the body; only where there are any."""
        lines, low, high = self.made.lines, self.frequency[0], self.frequency[-1]
        if lines is None:
            return {}
        at, found = lines.frequencies[:, 0], {}
        for k, one in enumerate(lines.ripple):
            inside = np.flatnonzero((np.array(lines.of) == k) & (at >= low) & (at <= high))
            if one.body == self.body and inside.size:
                found[k] = inside
        return found

    @property
    def marks(self) -> list[Mark]:
        """The first line of each ripple."""
        lines = self.made.lines
        return [] if lines is None else [
            Mark("x", float(lines.frequencies[inside[0], 0]), f"torque ripple {lines.ripple[k].name}")
            for k, inside in self._inside.items()
        ]  # fmt: skip

    @property
    def points(self) -> list[DrawnPoints]:
        """Lines in every mesh, ripple by ripple."""
        lines, drawn = self.made.lines, []
        if lines is None:
            return []
        for inside in self._inside.values():
            at = lines.frequencies[inside, 0]
            for m, force in enumerate(lines.forces[:, inside, 0]):
                notes = tuple(f"{f:.5g} Hz: {w:.4g} N" for f, w in zip(at, np.abs(force), strict=True))
                drawn.append(DrawnPoints(f"series:{m}", notes, at, np.abs(force / lines.torques[inside])))
        return drawn


@dataclass(frozen=True)
class TorqueRippleData:
    """Response per unit of torque over frequency, by the body that it acts on, and the lines at the speed, if any."""

    train: GearTrain
    frequencies: Array
    responses: dict[str, TorqueResponse]
    lines: RippleSpectrum | None
    swings: tuple[tuple[float, float], ...]

    @cached_property
    def of_lines(self) -> RippleLines | None:
        """Its lines in rows."""
        return None if self.lines is None else RippleLines(self.lines, self.train, 0)

    @property
    def forces(self) -> dict[str, Array]:
        """Force amplitudes in the meshes [N]."""
        sizes = () if self.lines is None else np.abs(self.lines.forces[:, :, 0])
        return dict(zip(self.train.names, sizes, strict=False))

    @property
    def torques(self) -> dict[str, Array]:
        """Torque amplitudes in the shafts [N m]."""
        sizes = () if self.lines is None else np.abs(self.lines.shafts[:, :, 0])
        return {shaft.name: size for shaft, size in zip(self.train.train.elastic_shafts, sizes, strict=False)}

    @property
    def mesh_swings(self) -> list[MeshSwing]:
        """Of every mesh."""
        worst = " with ripples at their worst phases" if len(self.train.ripple) > 1 else ""
        return [
            MeshSwing(name, float(mean), low, worst, high)
            for name, mean, (low, high) in zip(self.train.names, self.train.forces, self.swings, strict=False)
        ]

    @property
    def shaft_swings(self) -> list[ShaftSwing]:
        """Of every elastic shaft."""
        swings = self.swings[len(self.train.names) :]
        return [
            ShaftSwing(shaft.name, max(high, -low))
            for shaft, (low, high) in zip(self.train.train.elastic_shafts, swings, strict=False)
        ]

    @property
    def bodies(self) -> dict[str, BodyResponse]:
        """Responses to torque at every body."""
        return {body: BodyResponse(self, body, found) for body, found in self.responses.items()}


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


def _file_remarks(asked: TrainInputs) -> list[str]:
    """Mean torques of files that were left out, and harmonics that were where they are more than a little."""
    said = []
    for one in asked.spec.ripple:
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


def _size(attribute: str) -> Callable[[Seen], Array]:
    """Modulus of a complex amplitude."""
    return lambda seen: np.abs(getattr(seen.one, attribute))


_CURVE = {"markers": False}
_FREQUENCY = Axis("frequency", "Hz", log=True)
_SHEET = Sheet(
    name=lambda _asked: "",
    tables=(
        Rows(
            "torque_ripple", "Torque ripple lines and resulting mesh forces and shaft torques",
            (
                Cell("ripple", meaning="name"), "body", "found.harmonics",
                Cell("found.frequencies", "of_lines.frequency"),
                "torque", "torque_phase",
                Cell(
                    "forces", itself, lambda seen: seen.data.lines, "force_{key}", "force amplitude in mesh {key}",
                    each=lambda seen: seen.data.forces,
                ),
                Cell(
                    "shafts", itself, lambda seen: seen.data.lines, "torque_{key}", "torque amplitude in shaft {key}",
                    each=lambda seen: seen.data.torques,
                ),
            ),
            of="of_lines",
        ),
        Rows(
            "torque_response_{key}", "Response of meshes and shafts to torque at body {key}",
            (
                "frequency",
                Cell("force", name="force_{one.name}", meaning="{one.meaning}", each="meshes", parts=True),
                Cell("torque", name="torque_{one.name}", meaning="{one.meaning}", each="shafts", parts=True),
            ),
            each="bodies",
        ),
    ),
    values=(
        Each(
            "mesh_swings", Number("high", owner="{one.name}", further="{one.worst}"),
            Number("share", owner="{one.name}"),
        ),
        Number("torque", owner="{one.name}", each="shaft_swings"),
        Number("left_out", owner="{one.name}", each="train.ripple", when="left_out"),
    ),
    figures=(
        Chart(
            "torque_response_{key}", "Response to torque at body {key}",
            lambda seen: f"Amplitudes of mesh forces and shaft torques per amplitude of a torque at body {seen.key}, "
            f"mean mesh stiffness. Points: lines of its torque ripple at {seen.asked.speed * RPM:.6g} rpm of "
            f"{seen.data.train.speed_of}.",
            (
                Over(
                    _FREQUENCY,
                    (
                        Line(
                            "force", "mesh {one.name}", x="frequency", si=_size("force"), look=_CURVE,
                            each=Family("meshes", role="{one.role}", most=ALL),
                        ),
                        Line(
                            "force", x="frequency", kind="points",
                            each=Family("points", "", "{one.role}", most=ALL),
                            look=lambda seen: {"notes": seen.one.notes, "size": 7},
                        ),
                    ),
                    Axis("force per torque", "N/(N.m)", log=True), "marks",
                ),
                Over(
                    _FREQUENCY,
                    (
                        Line(
                            "torque", "shaft {one.name}", x="frequency", si=_size("torque"), look=_CURVE,
                            each=Family("shafts", role="{one.role}", most=ALL),
                        ),
                    ),
                    Axis("torque per torque", log=True), "marks", when="shafts",
                ),
            ),
            each="bodies", under=lambda seen: f"{seen.asked.speed * RPM:.6g} rpm",
        ),
    ),
    remarks=(
        lambda seen: _file_remarks(seen.asked.train),
        Remark("Torque ripple: all amplitudes are zero.", when=lambda seen: seen.data.lines is None),
        Remark(
            "Mesh {one.name}: torque ripple reduces the mean force of {one.mean:.4g} N by {one.reduction:.4g}: loss of "
            "contact (not modelled here). Request dynamic-factor with effects.contact_loss = true.",
            each="mesh_swings", when="lost",
        ),
    ),
    settings={"speed": lambda seen: None if seen.data.lines is None else seen.asked.speed},
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
    present=_SHEET.present,
    check=needs_one_speed,
    cites=citing(Citation("mark", "gear train of rotors, shafts and meshes, excited by a torque", "section 2")),
    forecast=_forecast,
)
