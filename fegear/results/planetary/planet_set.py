"""Stage ``planet-set``: speeds, torques, frequencies and mesh phases of a planetary set, and what phasing cancels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import declared
from fegear.case.built.planetary import planetary_part, ring_checks, set_inputs
from fegear.case.planetary import PHASED_HARMONICS
from fegear.dynamics.planetary.kinematics import axial_forces, passing, sidebands
from fegear.dynamics.planetary.phases import phasing
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, columns_of, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Bars, Curve, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Stage
from fegear.engine.table import Column, Table
from fegear.results import forecasts

if TYPE_CHECKING:
    from fegear.case.built.planetary import SetInputs
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.kinematics import Passing, Sidebands
    from fegear.dynamics.planetary.phases import Phasing
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


def _members(asked: SetInputs) -> Table:
    run = asked.run
    speed, torque = (np.array([of[name] for name in CENTRALS]) for of in (run.speed, run.torque))
    columns = [
        Column("member", np.array(CENTRALS), "", "member of the set"),
        Column("speed", speed, "rpm", "counter-clockwise"),
        Column("torque", torque, "N.m", "external torque, counter-clockwise"),
        Column("power", torque * speed, "W", "power into the set"),
    ]
    if asked.base_twist:
        axial = axial_forces(asked.found, run, asked.base_twist).sun * np.array([1.0, -1.0, 0.0])
        columns.append(Column("axial_force", axial, "N", "axial force of the planets, towards the observer"))
    return Table(f"planet_members_{asked.name}", tuple(columns), f"Speeds and torques of set {asked.name}")


def _present(data: PlanetSetData, inputs: PlanetSetInputs) -> Outcome:
    asked, rule = inputs.asked, data.phasing
    name, found, run, phases = asked.name, asked.found, asked.run, asked.phases
    tables = [_members(asked)]
    if asked.at_speed:
        tables.append(Table(
            f"planet_passing_{name}",
            (Column("what", np.array(data.passing.what), "", "event"), *columns_of(data.passing, "frequency")),
            f"Characteristic frequencies of set {name}",
        ))  # fmt: skip
        tables.append(Table(
            f"planet_sidebands_{name}", columns_of(data.sidebands, "harmonic", "order", "frequency", "share"),
            f"Sidebands measured at the ring of set {name}",
        ))  # fmt: skip
    tables.append(Table(
        f"planet_phases_{name}",
        (Column("planet", np.arange(1, found.count + 1), "", "counter-clockwise"),
         *columns_of(phases, "angle", "sun", "ring")),
        f"Mesh phases of set {name}",
    ))  # fmt: skip
    if inputs.checks:
        tables.append(_ring_table(inputs))
    excites = declared(type(rule), "excites")
    tables.append(Table(
        f"planet_phasing_{name}",
        (*columns_of(rule, "harmonic", "torque", "force"), Column("excites", np.array(rule.excites), "",
                                                                  excites.meaning)),
        f"Planet phasing of set {name}: resultant of each mesh harmonic",
    ))  # fmt: skip
    values = [
        value_of(run, "ratio", name),
        value_of(run, "efficiency", name),
        value_of(phases, "ring_behind_sun", name),
        value_of(found, "sun_angle", name),
        value_of(found, "ring_angle", name),
    ]
    if found.count > 1:
        values.append(value_of(found, "neighbour_clearance", name))
    if asked.base_twist:
        along = axial_forces(found, run, asked.base_twist)
        values += [value_of(along, "sun", name), value_of(along, "tilting", name)]
    if asked.at_speed:
        values += [value_of(run, "mesh_frequency", name), value_of(run, "planet_speed", name)]
    return Outcome(data, tuple(tables), tuple(values), {"mirrored": run.mirrored}, _remarks(inputs),
                   (_drawing(asked), _phasing_figure(name, rule)))  # fmt: skip


def _ring_table(inputs: PlanetSetInputs) -> Table:
    margins = np.array([one.margin for one in inputs.checks]) * inputs.module
    return Table(
        f"planet_in_ring_{inputs.asked.name}",
        (
            Column("check", np.array([one.name for one in inputs.checks]), "", "possible interference"),
            Column("margin", margins, "mm", "clearance; negative: interference, blank: not applicable"),
        ),
        f"Interference checks of planet and ring of set {inputs.asked.name}",
    )


def _remarks(inputs: PlanetSetInputs) -> tuple[str, ...]:
    asked = inputs.asked
    name, found = asked.name, asked.found
    teeth = found.sun_teeth + found.ring_teeth
    said = [f"Set {name}: assembly is possible at integer multiples of 360/{teeth} deg."]
    if found.count > 1:
        said[0] += f" Clearance between adjacent planets {found.neighbour_clearance * 1e3:.4g} mm."
    if asked.base_twist:
        said.append(f"Set {name}: bearings are assumed rigid for axial forces of sun and ring and for tilting "
                    "moments of the planets.")  # fmt: skip
    said += [f"Set {name}: {one.sentence(inputs.module)}." for one in inputs.checks if one.margin < 0.0]
    if not asked.at_speed:
        said.append(f"Set {name}: speed not specified: frequencies require planetary.{name}.speed; member speeds are "
                    "for 1 rad/s input speed.")  # fmt: skip
    return tuple(said)


def _drawing(asked: SetInputs) -> Figure:
    """Pitch circles of the members, with the phase of each planet."""
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
    return Figure(
        f"planet_set_{asked.name}", f"Planetary set {asked.name}",
        f"Set {asked.name}: working pitch circles, and phase lag gamma_sn of each sun mesh relative to planet 1, in "
        f"base pitches; ring meshes lag by {phases.ring_behind_sun:.4g}.",
        (Panel(*plane, (*items, points), equal=True, height=2.0),),
    )  # fmt: skip


def _phasing_figure(name: str, rule: Phasing) -> Figure:
    return Figure(
        f"planet_phasing_{name}", f"Phasing of set {name}",
        f"Set {name}: resultant of each mesh harmonic over all planets as torque and as radial force; where both are "
        "zero only planet modes are excited.",
        (Panel(axis_of(type(rule), "harmonic", whole=True), Axis("resultant / sum of the "
                                                                 "planets", limits=(0.0, 1.05)), (
            Bars(rule.harmonic, rule.torque, "torque", "series:0"), Bars(rule.harmonic, rule.force, "force",
                                                                         "series:1"),
        )),),
    )  # fmt: skip


PLANET_SET = Stage(
    subjects=planetary_sets,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(
        Citation("parker", "modes excited by a harmonic with planet phasing"),
        Citation("mcfadden-smith", "sidebands of planets passing a sensor"),
    ),
    forecast=lambda _scene, _name: forecasts.constant(0.005),
)
