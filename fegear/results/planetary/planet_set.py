"""Stage ``planet-set``: speeds, torques, frequencies and mesh phases of a planetary set, and what phasing cancels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import assuming, failing
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.planetary import planetary_part, ring_checks, set_inputs
from fegear.case.planetary import PHASED_HARMONICS
from fegear.dynamics.planetary.kinematics import axial_forces, passing, sidebands
from fegear.dynamics.planetary.phases import phasing
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.built.planetary import SetInputs
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.kinematics import AxialForces, Passing, Sidebands
    from fegear.dynamics.planetary.phases import Phasing
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.internal_interference import InternalCheck


@dataclass(frozen=True)
class PlanetSetData:
    """What follows from the assembly of a set alone."""

    passing: Passing
    sidebands: Sidebands
    phasing: Phasing


@dataclass(frozen=True)
class PlanetSetInputs:
    """The set, how many harmonics are looked at, what planet and ring may foul each other in, and their module [m]."""

    asked: SetInputs
    harmonics: int
    checks: tuple[InternalCheck, ...]
    module: float


def planetary_sets(scene: Scene) -> tuple[str, ...]:
    """All planetary sets of a case."""
    return tuple(scene.case.planetary)


def _inputs(scene: Scene, name: str) -> PlanetSetInputs:
    part = planetary_part(scene, name)
    return PlanetSetInputs(
        set_inputs(scene, name), part.harmonics or PHASED_HARMONICS, ring_checks(scene, name),
        scene.gears[part.planet].module,
    )  # fmt: skip


def _compute(inputs: PlanetSetInputs, _upstream: Upstream, _work: Work) -> PlanetSetData:
    found, run = inputs.asked.found, inputs.asked.run
    return PlanetSetData(passing(found, run), sidebands(found, run), phasing(found, inputs.harmonics))


@dataclass(frozen=True)
class MemberRow:
    """How one member of a set runs."""

    member: str = shown("", "member of the set")
    speed: float = shown("rpm", "counter-clockwise")
    torque: float = shown("N.m", "external torque, counter-clockwise")
    power: float = shown("W", "power into the set")
    axial_force: float | None = shown("N", "axial force of the planets, towards the observer")


@dataclass(frozen=True)
class CheckRow:
    """What planet and ring may foul each other in."""

    check: str = shown("", "possible interference")
    margin: float = shown("mm", "clearance; negative: interference, blank: not applicable")


@dataclass(frozen=True)
class ShownSet:
    """What is shown of a set: what it was asked for beside what follows, and axial forces of helical teeth."""

    data: PlanetSetData
    asked: SetInputs
    axial: AxialForces | None
    checks: list[CheckRow]

    @property
    def members(self) -> list[MemberRow]:
        """A row each."""
        run, along = self.asked.run, self.axial
        axial = (None, None, None) if along is None else (along.sun, -along.sun, 0.0)
        return [
            MemberRow(name, run.speed[name], run.torque[name], run.torque[name] * run.speed[name], force)
            for name, force in zip(CENTRALS, axial, strict=True)
        ]


def _shown(data: PlanetSetData, inputs: PlanetSetInputs) -> ShownSet:
    asked = inputs.asked
    axial = axial_forces(asked.found, asked.run, asked.base_twist) if asked.base_twist else None
    return ShownSet(data, asked, axial, [CheckRow(one.name, one.margin * inputs.module) for one in inputs.checks])


def _remarks(inputs: PlanetSetInputs) -> tuple[str, ...]:
    asked = inputs.asked
    name, found = asked.name, asked.found
    teeth = found.sun_teeth + found.ring_teeth
    said = [f"Set {name}: assembly is possible at integer multiples of 360/{teeth} deg."]
    if found.count > 1:
        said[0] += f" Clearance between adjacent planets {found.neighbour_clearance * 1e3:.4g} mm."
    if asked.base_twist:
        said.append(assuming(f"Set {name}: bearings are assumed rigid for axial forces of sun and ring and for tilting "
                    "moments of the planets."))  # fmt: skip
    if asked.halves > 1:
        said.append(assuming(f"Set {name}: double helical: both halves carry the same load (sun and planets float "
                    "axially), their axial forces balance; torques, mesh forces and masses are of both."))  # fmt: skip
    said += [failing(f"Set {name}: {one.sentence(inputs.module)}.") for one in inputs.checks if one.margin < 0.0]
    if not asked.at_speed:
        said.append(assuming(f"Set {name}: speed not specified: frequencies require planetary.{name}.speed; member "
                    "speeds are for 1 rad/s input speed."))  # fmt: skip
    return tuple(said)


def _said(seen: Seen) -> Iterator[str]:
    run = seen.data.asked.run
    torques = ", ".join(f"{one} {figures(run.torque[one])} N m" for one in CENTRALS)
    losses = f", efficiency {figures(run.efficiency)}" if run.efficiency < 1.0 else ""
    yield (
        f"Set {seen.name}, {run.fixed} fixed: ratio {run.input} to {run.output} {figures(run.ratio, 4)}{losses}; "
        f"torques {torques}."
    )


def _drawing(seen: Seen) -> tuple[Figure, ...]:
    """Pitch circles of the members, with the phase of each planet."""
    asked: SetInputs = seen.asked.asked
    found, phases = asked.found, asked.phases
    a, round_ = found.centre_distance * 1e3, np.linspace(0.0, 2.0 * math.pi, 181)
    radii = {
        "sun": found.base_radius("sun") / math.cos(found.sun_angle) * 1e3,
        "ring": found.base_radius("ring") / math.cos(found.ring_angle) * 1e3,
        "planets": found.base_radius("planet") / math.cos(found.sun_angle) * 1e3,
    }
    items = [Curve(radii[one] * np.cos(round_), radii[one] * np.sin(round_), one, role, markers=False)
             for one, role in (("sun", "series:0"), ("ring", "series:1"))]  # fmt: skip
    x, y = a * np.cos(found.angles), a * np.sin(found.angles)
    wheel = radii["planets"] * np.cos(round_), radii["planets"] * np.sin(round_)
    items += [
        Curve(across + wheel[0], up + wheel[1], "planets", "series:2", markers=False)
        for across, up in zip(x, y, strict=True)
    ]
    notes = tuple(f"{n + 1}: gamma {s:.4g}" for n, s in enumerate(phases.sun))
    points = Points(x, y, "", "series:2", "circle", notes=notes, written=True)
    plane = Axis("x", "mm"), Axis("y", "mm")
    return (Figure(
        f"planet_set_{asked.name}", f"Planetary set {asked.name}",
        f"Set {asked.name}: working pitch circles, and phase lag gamma_sn of each sun mesh relative to planet 1, in "
        f"base pitches; ring meshes lag by {phases.ring_behind_sun:.4g}.",
        (Panel(*plane, (*items, points), equal=True, height=2.0),),
    ),)  # fmt: skip


_AT_SPEED = "asked.at_speed"
_SHEET = Sheet(
    of=_shown,
    name=lambda inputs: inputs.asked.name,
    tables=(
        Rows(
            "planet_members_{name}", "Speeds and torques of set {name}",
            ("member", "speed", "torque", "power", "axial_force"), of="members",
        ),
        Rows(
            "planet_passing_{name}", "Characteristic frequencies of set {name}", ("what", "frequency"),
            of="data.passing", when=_AT_SPEED,
        ),
        Rows(
            "planet_sidebands_{name}", "Sidebands measured at the ring of set {name}",
            ("harmonic", "order", "frequency", "share"), of="data.sidebands", when=_AT_SPEED,
        ),
        Rows(
            "planet_phases_{name}", "Mesh phases of set {name}", ("planet", "angle", "sun", "ring"), of="asked.phases"
        ),
        Rows(
            "planet_in_ring_{name}", "Interference checks of planet and ring of set {name}", ("check", "margin"),
            of="checks", when="checks",
        ),
        Rows(
            "planet_phasing_{name}", "Planet phasing of set {name}: resultant of each mesh harmonic",
            ("harmonic", "torque", "force", "excites"), of="data.phasing",
        ),
    ),
    values=(
        Number("ratio", of="asked.run"),
        Number("efficiency", of="asked.run"),
        Number("ring_behind_sun", of="asked.phases"),
        Number("sun_angle", of="asked.found"),
        Number("ring_angle", of="asked.found"),
        Number("neighbour_clearance", of="asked.found", when=lambda seen: seen.data.asked.found.count > 1),
        Number("sun", of="axial"),
        Number("tilting", of="axial"),
        Number("mesh_frequency", of="asked.run", when=_AT_SPEED),
        Number("planet_speed", of="asked.run", when=_AT_SPEED),
    ),
    figures=(
        _drawing,
        Chart(
            "planet_phasing_{name}", "Phasing of set {name}",
            "Set {name}: resultant of each mesh harmonic over all planets as torque and as radial force; where both "
            "are zero only planet modes are excited.",
            (
                Over(
                    "harmonic",
                    (
                        Line("torque", "torque", "series:0", kind="bars"),
                        Line("force", "force", "series:1", kind="bars"),
                    ),
                    Axis("resultant / sum of the planets", limits=(0.0, 1.05)), x_options={"whole": True},
                ),
            ),
            of="data.phasing",
        ),
    ),
    answer=Answer(_said, figure="planet_set_{name}"),
    remarks=(lambda seen: _remarks(seen.asked),),
    settings={"mirrored": "asked.run.mirrored"},
)  # fmt: skip


PLANET_SET = Stage(
    subjects=planetary_sets,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(
        Citation("parker", "modes excited by a harmonic with planet phasing"),
        Citation("mcfadden-smith", "sidebands of planets passing a sensor"),
    ),
    forecast=lambda _scene, _name: forecasts.constant(0.005),
)
