"""Stages ``planet-modes`` and ``planet-vibration``: natural modes of a set by kind, and what its meshes excite."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import neglecting
from fegear.base.shown import shown
from fegear.case.built.planetary import body_masses, check_masses, planetary_part, set_inputs
from fegear.case.planetary import MESHES, set_pair
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.pair.loaded_flanks import loaded_flanks
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.planetary.planet_load_sharing import meshed_set, needs_meshed, needs_teeth
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_modes import SetModes
    from fegear.dynamics.planetary.set_response import ForcedResponse, LinearSet
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Of the largest motion about the axes, and in any case [m]: what moves less across them is drawn as standing still.
#: Where nothing excites the set the motion about the axes is round-off too.
_ROUND_OFF, _NO_MOTION = 1e-9, 1e-15
#: Coordinates of a central body.
_ALONG = ("x", "y", "turn")


@dataclass(frozen=True)
class VibrationInputs:
    """What the vibration of a set depends on besides its teeth.

    Parameters
    ----------
    speeds : ndarray
        Of the driving member [rad/s].
    teeth_per_turn : float
        Mesh cycles per turn of the driving member.
    damping_ratio : float
    driving, name : str
    bodies : tuple of (str, float, float, str)
        Member, mass [kg], inertia [kg m^2] and where they come from.
    """

    speeds: Array
    teeth_per_turn: float
    damping_ratio: float
    driving: str
    name: str
    bodies: tuple[tuple[str, float, float, str], ...] = ()


def _inputs(scene: Scene, name: str) -> VibrationInputs:
    part, run = planetary_part(scene, name), set_inputs(scene, name).run
    speeds = np.zeros(0) if part.speeds is None else part.speeds.array
    per_turn = run.mesh_frequency * 2.0 * math.pi / abs(run.speed[run.input])
    return VibrationInputs(speeds, per_turn, part.damping_ratio, part.input, name, body_masses(scene, name))


def _linear(inputs: VibrationInputs, upstream: Upstream, _work: Work) -> LinearSet:
    from fegear.dynamics.planetary.set_response import SHOWN_HARMONICS, linear_set

    meshed = meshed_set(upstream, inputs.name)
    sun, ring = (
        _exactness(upstream, set_pair(inputs.name, mesh), force, SHOWN_HARMONICS)
        for mesh, force in zip(MESHES, meshed.mean_forces, strict=True)
    )
    return linear_set(meshed, inputs.damping_ratio, exactness=(sun, ring))


def _exactness(upstream: Upstream, name: str, load: float, harmonics: int) -> tuple[float, Array]:
    """Errors of a mesh's mean stiffness and of the amplitudes of its transmission error, as shares of them."""
    from fegear.contact.plane.base_pitch import mean_secant_stiffness
    from fegear.contact.plane.shifted_loads import transmission_error_shift
    from fegear.contact.plane.transmission_error import transmission_error

    none = 0.0, np.zeros(harmonics)
    if Task("loaded-flanks", name) in upstream:
        flanks = loaded_flanks(upstream, name)
        over = flanks.transmission_error(lambda _done: None)
        if over.shift is None or not flanks.estimated:
            return none
        return over.shift.stiffness / over.mesh_stiffness_mean, _shares(
            over.shift.amplitude, over.series[over.at].amplitude, harmonics
        )
    if Task("loaded-pair", name) not in upstream:
        return none
    pair = loaded_pair(upstream, name)
    te = transmission_error(pair.engagement, load, harmonics)
    shift = transmission_error_shift(te, pair.shifted)
    if shift is None:
        return none
    return shift.stiffness / mean_secant_stiffness(te), _shares(shift.amplitude, te.series.amplitude, harmonics)


def _shares(error: Array, amplitude: Array, harmonics: int) -> Array:
    """Errors of amplitudes as shares of them, one at most, and one where roll positions do not show the harmonic."""
    share = np.divide(error, amplitude, out=np.zeros_like(amplitude), where=amplitude > 0.0)[:harmonics]
    return np.pad(np.minimum(share, 1.0), (0, harmonics - share.size), constant_values=1.0)


@dataclass(frozen=True)
class Mode:
    """One mode and the estimated error of its frequency."""

    error: float
    kind: str
    frequency: float = shown("Hz", "undamped natural frequency")


@dataclass(frozen=True)
class Body:
    """A body of the set, and where its mass comes from."""

    member: str
    mass: float = shown("kg", "mass")
    inertia: float = shown("kg.m^2", "moment of inertia about its axis")
    source: str = ""


@dataclass(frozen=True)
class ShownModes:
    """Natural modes and bodies as they are shown."""

    linear: LinearSet
    bodies: tuple[Body, ...]
    mode: NDArray[np.intp] = shown("", "mode number, increasing frequency")
    speed: Array = shown("rpm", "at which the mesh frequency coincides")

    @property
    def single(self) -> dict[str, Mode]:
        """Modes that are not rigid motions, by number."""
        data = self.linear.modes
        every = zip(data.frequency, self.linear.frequency_error, data.kind, strict=True)
        return {str(k): Mode(float(off), kind, float(hz)) for k, (hz, off, kind) in enumerate(every) if hz > 0.0}

    @property
    def drawn(self) -> NDArray[np.intp]:
        """Modes that move, of those of one frequency the first."""
        frequency = self.linear.modes.frequency
        other = np.append(True, np.diff(frequency) > 1e-8 * frequency[-1])
        return np.flatnonzero((frequency > 0.0) & other)


def _shown_modes(linear: LinearSet, inputs: VibrationInputs) -> ShownModes:
    data, bodies = linear.modes, tuple(Body(*one) for one in inputs.bodies)
    speed = data.frequency / inputs.teeth_per_turn * 2.0 * math.pi
    return ShownModes(linear, bodies, np.arange(data.frequency.size), speed)


def _kinds(seen: Seen) -> str:
    """How many modes of each kind there are."""
    return ", ".join(f"{count} of type {kind}" for kind, count in Counter(seen.data.linear.modes.kind).items())


def _types(seen: Seen) -> Axis:
    """Frequencies of the modes that are drawn, and a letter for their types."""
    data = seen.data.linear.modes
    labels = (f"{data.frequency[k] * 1e-3:.3g}\n{data.kind[k][0].upper()}" for k in seen.data.drawn)
    return Axis("natural frequency [kHz] and type", categories=tuple(labels))


def _energy(k: int, label: str, share: Callable[[SetModes], Array]) -> Line:
    """Bars of the share of the strain energy that sits in one kind of springs."""
    return Line(
        "linear.modes.sun_mesh", label, f"series:{k}", x="mode", kind="bars",
        si=lambda seen: share(seen.data.linear.modes)[seen.data.drawn],
        x_si=lambda seen: np.arange(seen.data.drawn.size),
    )  # fmt: skip


_MODES = Sheet(
    of=_shown_modes,
    tables=(
        Rows(
            "planet_modes_{name}", "Natural modes of set {name}",
            (
                "mode", "linear.modes.frequency", "linear.frequency_error", "linear.modes.kind",
                Cell("speed", meaning="speed of the {asked.driving} at which the mesh frequency coincides"),
                *(f"linear.modes.{one}" for one in ("turning", "moving", "sun_mesh", "ring_mesh")),
            ),
            printed=True,
        ),
    ),
    values=(
        Number("frequency", "error", each="single", name="natural_frequency_{key}", further=", {one.kind}"),
        Each("bodies", *(
            Number(one, owner="{name}.{one.member}", further=", {one.source}") for one in ("mass", "inertia")
        )),
    ),
    figures=(
        Chart(
            "planet_modes_{name}", "Natural modes of set {name}",
            "Set {name}: strain energy distribution of the modes. R: rotational, T: translational (double), P: planet, "
            "M: mixed mode.",
            (
                Over(
                    _types,
                    (
                        _energy(0, "sun meshes", lambda modes: modes.sun_mesh),
                        _energy(1, "ring meshes", lambda modes: modes.ring_mesh),
                        _energy(2, "pins and bearings", lambda modes: 1.0 - modes.sun_mesh - modes.ring_mesh),
                    ),
                    Axis("strain energy share", limits=(0.0, 1.0)), panel={"stacked": True},
                ),
            ),
        ),
    ),
    answer=Answer(
        "Set {name}: lowest natural frequency {v[natural_frequency_1]}.", figure="planet_modes_{name}",
    ),
    remarks=(
        Remark(
            lambda seen: f"Set {seen.name}: {_kinds(seen)}; gyroscopic forces of the carrier's rotation are neglected."
        ),
    ),
)  # fmt: skip


PLANET_MODES = Stage(
    subjects=planetary_sets,
    needs=lambda scene, name: (*needs_meshed(scene, name), *needs_teeth(scene, name)),
    inputs=_inputs,
    compute=_linear,
    present=_MODES.present,
    check=check_masses,
    cites=citing(Citation("lin-parker", "model of the planetary set and mode types")),
    forecast=lambda _scene, _name: forecasts.constant(0.3),
)


def check_vibration(scene: Scene, name: str) -> None:
    """Refuse vibration without masses or speeds."""
    check_masses(scene, name)
    if planetary_part(scene, name).speeds is None:
        raise InputError(
            f"planetary.{name}.speeds", "(not given)", "is required for this result",
            'set speeds = { start = "200 rpm", stop = "6000 rpm", count = 200 }',
        )  # fmt: skip


def _vibration(inputs: VibrationInputs, upstream: Upstream, _work: Work) -> ForcedResponse:
    from fegear.dynamics.planetary.set_response import forced_response

    linear = cast("LinearSet", upstream[Task("planet-modes", inputs.name)])
    frequency = inputs.speeds * inputs.teeth_per_turn / (2.0 * math.pi)
    return forced_response(linear, frequency)


@dataclass(frozen=True)
class Motion:
    """Amplitude of a motion of one member over speed, and its estimated error where it has one; shape (N,)."""

    speed: Array = shown("rpm", "speed of the driving member")
    amplitude: Array = shown("um", "amplitude: root of the sum of squares of its harmonics")
    error: Array | None = None


@dataclass(frozen=True)
class ShownVibration:
    """Vibration of a set over the speeds of its driving member, shape (N,)."""

    found: ForcedResponse
    speed: Array = shown("rpm", "speed of the driving member")

    @property
    def top(self) -> int:
        """Where the dynamic force is largest."""
        return int(np.argmax(self.found.largest_force))

    @property
    def low(self) -> int:
        """Where a mesh force is smallest."""
        return int(np.argmin(self.found.least_share))

    def error(self, quantity: str) -> Array:
        """Estimated one of a force."""
        return self.found.shift(lambda one: getattr(one, quantity))

    @property
    def motions(self) -> dict[str, Motion]:
        """Of every coordinate of the central members."""

        def motion(member: Central, axis: int) -> Motion:
            error = self.found.shift(lambda one: one.amplitude(member, axis))
            return Motion(self.speed, self.found.amplitude(member, axis), error)

        return {f"{member}_{word}": motion(member, k) for member in CENTRALS for k, word in enumerate(_ALONG)}

    @property
    def across(self) -> dict[str, Motion]:
        """Radial ones of the central members; what moves less than round-off stands still."""
        size = self.found.amplitude
        still = max(_ROUND_OFF * max(float(size(member, 2).max()) for member in CENTRALS), _NO_MOTION)
        sizes = {member: np.hypot(size(member, 0), size(member, 1)) for member in CENTRALS}
        return {member: Motion(self.speed, np.where(one < still, 0.0, one)) for member, one in sizes.items()}


def _speed_axis(seen: Seen) -> Axis:
    return Axis(f"speed of the {seen.asked.driving}", "rpm")


def _force(quantity: str) -> Cell:
    return Cell(f"found.{quantity}", error=lambda seen: seen.data.error(quantity))


def _at_circle(seen: Seen) -> str:
    return "; at the base circle or the pins" if seen.key.endswith("turn") else ""


_PLAIN = {"markers": False}
_VIBRATION = Sheet(
    of=lambda data, inputs: ShownVibration(data, inputs.speeds),
    tables=(
        Rows(
            "planet_vibration_{name}", "Vibration of set {name} over speed",
            (
                Cell("speed", meaning="speed of the {asked.driving}"), "found.mesh_frequency",
                *map(_force, ("sun_force", "ring_force", "least_share")),
                Cell("amplitude", each="motions", name="{key}", further=_at_circle, error="error"),
            ),
        ),
    ),
    values=(
        Number(
            "found.largest_force", lambda seen: seen.data.error("largest_force")[seen.data.top],
            si=lambda seen: seen.data.found.largest_force[seen.data.top], name="dynamic_force",
            meaning="maximum dynamic mesh force over all speeds",
        ),
        Number(
            "speed", si=lambda seen: seen.data.speed[seen.data.top], name="dynamic_force_speed",
            meaning="speed at which the maximum occurs",
        ),
    ),
    figures=(
        Chart(
            "planet_vibration_{name}", "Vibration of set {name} over speed",
            "Set {name}: maximum dynamic mesh force above the mean of {d.found.mean_force:.5g} N, and radial motion "
            "amplitude of sun, ring and carrier, excited by the transmission errors of the meshes with their phases.",
            (
                Over(
                    _speed_axis,
                    tuple(
                        Line(f"found.{mesh}_force", f"{mesh} mesh", f"series:{k}", x="speed", look=_PLAIN)
                        for k, mesh in enumerate(MESHES)
                    ),
                    Axis("dynamic mesh force", "N", zero=True),
                ),
                Over(
                    _speed_axis, (Line("amplitude", x="speed", each=Family("across"), look=_PLAIN),),
                    Axis("radial motion", "um", zero=True),
                ),
            ),
        ),
    ),
    answer=Answer(
        "Set {name}: maximum dynamic mesh force {v[dynamic_force]} at {v[dynamic_force_speed]}.",
        figure="planet_vibration_{name}",
    ),
    remarks=(
        Remark("Set {name}: linearised at the mean load, damping ratio of all modes {asked.damping_ratio:.3g}."),
        Remark(
            lambda seen: neglecting(f"Set {seen.name}: linear mesh force falls to "
            f"{seen.data.found.least_share[seen.data.low]:.3g} of its mean at "
            f"{seen.data.speed[seen.data.low] * 30.0 / math.pi:.5g} rpm (loss of contact, not modelled here); use "
            "planet-motion."),
            when=lambda seen: seen.data.found.least_share.min() < 0.0,
        ),
    ),
)  # fmt: skip


PLANET_VIBRATION = Stage(
    subjects=planetary_sets,
    needs=lambda _scene, name: (Task("planet-modes", name),),
    inputs=_inputs,
    compute=_vibration,
    present=_VIBRATION.present,
    check=check_vibration,
    cites=citing(
        Citation("lin-parker", "model of the planetary set"),
        Citation("mark", "linear train with transmission errors", "2.9b"),
    ),
    forecast=lambda _scene, _name: forecasts.constant(3.0),
)
