"""From ``[planetary.NAME]`` to the set, how it runs, its bodies and its teeth."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.part import at
from fegear.case.planetary import MESHES, angles_of, set_pair
from fegear.case.set_pairs import set_teeth
from fegear.dynamics.planetary.kinematics import Running, running
from fegear.dynamics.planetary.phases import Phases, mesh_phases
from fegear.dynamics.planetary.planet_set import CENTRALS, PlanetarySet
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.geometry.involute import inv

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.case.planetary import Mesh, PlanetaryPart, SetBodyPart
    from fegear.case.reading import Scene
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.geometry.gear import Gear
    from fegear.geometry.internal_interference import InternalCheck
    from fegear.geometry.pair import GearPair

#: Speed of sets of which nobody gave one [rad/s]: ratios, torques and phases do not depend on it.
_ANY_SPEED = 1.0


@dataclass(frozen=True)
class SetInputs:
    """What a planetary set depends on besides its loaded teeth.

    Parameters
    ----------
    found : PlanetarySet
    run : Running
    phases : Phases
    model : SetModel
        Without masses where these are not known.
    sun_torque : float
        Size of the torque on the sun without losses [N m]; those of the planets' loads.
    given : mapping of str to ndarray or None
        Stiffness of the meshes "sun" and "ring" that the case gives [N/m].
    at_speed : bool
        Whether a speed is given.
    base_twist : float
        tan(beta_b) of the sun, positive for a right hand; zero of spur sets and where two halves balance.
    name : str
    halves : int
        2 of double helical gears, whose teeth are one half under half of the load.
    """

    found: PlanetarySet
    run: Running
    phases: Phases
    model: SetModel
    sun_torque: float
    given: dict[str, tuple[float, ...] | None]
    at_speed: bool
    base_twist: float
    name: str = field(compare=False)
    halves: int = 1


def planetary_part(scene: Scene, name: str) -> PlanetaryPart:
    """The table of a set."""
    return scene.case.planetary[name]


def set_inputs(scene: Scene, name: str) -> SetInputs:
    """Collect what a case says of a set.

    Raises
    ------
    GeometryError
        If it cannot be assembled; the key is the one of the case file.
    """
    part = planetary_part(scene, name)
    sun, planet, pair = scene.gears[part.sun], planet_at(scene, name, "sun"), scene.pairs[set_pair(name, "sun")]
    for one in (set_pair(name, mesh) for mesh in MESHES):
        if sun.helix_angle and scene.pairs.get(one, pair).axial_offset:
            raise InputError(
                f"pair.{one}.axial_offset", "(given)", "shifts the phase of one mesh of a helical planetary set",
                "remove it: gears of a planetary set are centred axially",
            )  # fmt: skip
    teeth = set_teeth(scene.case, part)
    try:
        found = PlanetarySet(
            sun.teeth, planet.teeth, teeth.ring, pair.base_pitch, pair.centre_distance,
            np.array(angles_of(part)), _base_half_angle(planet, pair), planet.tip_radius, *_at_ring(scene, name),
        )  # fmt: skip
    except InputError as error:
        raise at(f"planetary.{name}", error, {"ring": "ring_teeth"} if part.ring is None else {}) from None
    ring = None if part.ring is None else scene.gears[part.ring]
    speed = (part.speed or _ANY_SPEED) * (-1.0 if part.clockwise else 1.0)
    run = running(found, part.fixed, part.input, speed, part.torque, part.mesh_efficiency)
    phases = mesh_phases(found, clockwise=run.sun_turns < 0.0, sun_drives=run.sun_drives)
    model = SetModel(
        found, _central(part, "sun", sun), _central(part, "ring", ring), _central(part, "carrier"),
        PlanetBody(*_mass(part.body.planet, planet, part.halves), pin=part.stiffness.pin or math.inf), run.mirrored,
    )  # fmt: skip
    meshes = {"sun": part.stiffness.sun_mesh, "ring": part.stiffness.ring_mesh}
    given = {mesh: None if one is None else tuple(one) for mesh, one in meshes.items()}
    return SetInputs(
        found, run, phases, model, teeth.sun_torque(part), given, part.speed is not None,
        0.0 if part.double_helical else sun.twist * sun.base_radius, name, part.halves,
    )  # fmt: skip


def planet_at(scene: Scene, name: str, mesh: Mesh) -> Gear:
    """The planet of a set seen from the flank that sun or ring loads; asymmetric teeth have two."""
    part = planetary_part(scene, name)
    pair = scene.case.pair.get(set_pair(name, mesh))
    if pair is None:
        return planet_at(scene, name, "sun").from_the_back
    central = part.sun if mesh == "sun" else part.ring
    gears = [gear for gear in (pair.driver, pair.driven) if scene.written.get(gear, gear) != central]
    return scene.gears[gears[0] if gears else part.planet]


def _base_half_angle(planet: Gear, pair: GearPair) -> float:
    """Angle from the middle of a planet's tooth to its flank on the base circle [rad]."""
    if planet.asymmetric:
        return planet.tooth.base_half_angle
    at_pitch = planet.base_radius / math.cos(pair.working_pressure_angle) / planet.module
    half = float(planet.symmetric_tooth.half_thickness_angle(at_pitch))
    return half + float(inv(pair.working_pressure_angle))


def _at_ring(scene: Scene, name: str) -> tuple[float, float]:
    """Base pitch [m] and base half angle of asymmetric teeth of a planet at the ring [rad]; nan of equal flanks."""
    planet = planet_at(scene, name, "ring")
    return (planet.base_pitch, planet.tooth.base_half_angle) if planet.asymmetric else (math.nan, math.nan)


def _mass(body: SetBodyPart | None, gear: Gear | None, halves: int) -> tuple[float, float]:
    """Mass and inertia [kg, kg m^2]: as given, or of the gear's body, both halves; nan where neither is known."""
    if body is not None:
        return body.mass, body.inertia
    if gear is None:
        return math.nan, math.nan
    return halves * gear.mass_properties.mass, halves * gear.mass_properties.inertia


def body_masses(scene: Scene, name: str) -> tuple[tuple[str, float, float, str], ...]:
    """Member, mass, inertia [kg, kg m^2] and where they come from, of the bodies of a set that are known."""
    part, found = planetary_part(scene, name), []
    for member in ("sun", "planet", "ring", "carrier"):
        given, gear = getattr(part.body, member), getattr(part, member, None)
        if given is None and gear is None:
            continue
        both = " (both halves)" if part.double_helical else ""
        source = f"from body.{member}" if given is not None else f"from teeth and body of gear {gear}{both}"
        found.append((member, *_mass(given, None if gear is None else scene.gears[gear], part.halves), source))
    return tuple(found)


def ring_checks(scene: Scene, name: str) -> tuple[InternalCheck, ...]:
    """What planet and ring may foul each other in; nothing where the ring is no gear of the case."""
    pair = scene.pairs.get(set_pair(name, "ring"))
    return () if pair is None else pair.internal_checks


def _central(part: PlanetaryPart, member: Central, gear: Gear | None = None) -> CentralBody:
    bearing = getattr(part.stiffness, member)
    if bearing is None:
        bearing = 0.0 if member in part.floating else math.inf
    turning = 0.0
    if member == part.fixed:
        turning = math.inf if part.stiffness.turning is None else part.stiffness.turning
    return CentralBody(*_mass(getattr(part.body, member), gear, part.halves), bearing, turning)


def check_masses(scene: Scene, name: str) -> None:
    """Refuse vibration of bodies that can move and whose mass nobody knows."""
    inputs = set_inputs(scene, name)
    for member in CENTRALS:
        body = inputs.model.central(member)
        moves = math.isfinite(body.bearing) or math.isfinite(body.turning)
        if moves and math.isnan(body.mass):
            raise InputError(
                f"planetary.{name}.body.{member}", "(not given)", f"is required for vibration ({member} is free to "
                                                                  "move)",
                f"set body = {{ {member} = {{ mass = \"2 kg\", inertia = \"0.01 kg*m^2\" }} }}",
            )  # fmt: skip


def pin_errors(part: PlanetaryPart) -> Array:
    """Displacement of the pins, radial (0) and counter-clockwise (1) [m], shape (2, planets)."""
    none = [0.0] * part.count
    return np.array([part.pin_errors.radial or none, part.pin_errors.tangential or none])


def given_teeth(stiffness: Sequence[float]) -> MeshExcitation:
    """Teeth of a mesh by their stiffness [N/m] at places evenly over the base pitch, straight lines between."""
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.periodic import Periodic

    values = np.append(stiffness, stiffness[0])
    if len(stiffness) == 1:
        return MeshExcitation.from_mesh(Periodic.constant(values[0]))
    return MeshExcitation.from_mesh(Periodic.through_points(np.linspace(0.0, 1.0, values.size), values))
