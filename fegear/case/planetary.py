"""``[planetary.NAME]``: sun, planets, ring and carrier, what holds and drives them, and where their pins stand.

The meshes of a set are pairs of the case, `NAME_sun` and `NAME_ring`, made here unless the case has them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.base.errors import InputError
from fegear.case.dynamics import SpeedsPart
from fegear.case.pair import PairPart
from fegear.case.part import (
    Angle,
    Length,
    Number,
    Part,
    PositiveInertia,
    PositiveLength,
    PositiveMass,
    PositiveSpeed,
    PositiveStiffness,
    PositiveTorque,
    StiffnessOrZero,
    TorsionalStiffnessOrZero,
    at_most,
    nearest,
    refuse,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.model import Case
    from fegear.case.operation import OperationPart
    from fegear.geometry.gear import Gear

CentralName = Literal["sun", "ring", "carrier"]


def _list(value: Any) -> Any:
    """Let one quantity stand for a list of it."""
    return value if isinstance(value, list) or value is None else [value]


MeshStiffness = Annotated[
    list[PositiveStiffness],
    BeforeValidator(_list, json_schema_input_type=PositiveStiffness | list[PositiveStiffness]),
    Field(min_length=1),
    at_most(10_000, "places"),
]


class SetStiffnessPart(Part):
    """``stiffness = { pin = "200 N/um", ring_mesh = "700 N/um", ... }``: meshes, pins and bearings of a set."""

    sun_mesh: MeshStiffness | None = Field(
        default=None,
        description="Mesh stiffness of sun and planet: one value, or several evenly over the base pitch from the pitch "
        "point on; without it that of the teeth of pair NAME_sun.",
    )
    ring_mesh: MeshStiffness | None = Field(
        default=None,
        description="Mesh stiffness of planet and ring: one value, or several evenly over the base pitch; without it "
        "that of the teeth of pair NAME_ring, where the ring is a gear.",
    )
    pin: PositiveStiffness | None = Field(
        default=None,
        description="Stiffness of a planet's pin and bearing in either direction; without it the pin is rigid.",
    )
    sun: StiffnessOrZero | None = Field(
        default=None, description="Bearing of the sun across the axis; without it rigid, or none where the sun floats."
    )
    ring: StiffnessOrZero | None = Field(
        default=None, description="Support of the ring across the axis; without it rigid, or none where it floats."
    )
    carrier: StiffnessOrZero | None = Field(
        default=None, description="Bearing of the carrier across the axis; without it rigid, or none where it floats."
    )
    turning: TorsionalStiffnessOrZero | None = Field(
        default=None, description="Torsional stiffness that holds the fixed member; without it rigid."
    )


class SetBodyPart(Part):
    """``{ mass = "0.4 kg", inertia = "2e-4 kg*m^2" }`` of a body of a set."""

    mass: PositiveMass = Field(description="Mass.")
    inertia: PositiveInertia = Field(description="Moment of inertia about its axis.")


class SetBodiesPart(Part):
    """``body = { carrier = { mass, inertia }, ... }``: what moves; gears have their own where it is not given."""

    sun: SetBodyPart | None = Field(default=None, description="The sun. Default: that of the gear.")
    ring: SetBodyPart | None = Field(
        default=None, description="The ring, with what turns with it. Default: that of the gear."
    )
    carrier: SetBodyPart | None = Field(default=None, description="The carrier with its pins, without planets.")
    planet: SetBodyPart | None = Field(default=None, description="One planet. Default: that of the gear.")


class PinErrorsPart(Part):
    """``pin_errors = { tangential = ["20 um", "0 um", "0 um"] }``: how far pins stand from their places."""

    tangential: list[Length] | None = Field(
        default=None, description="Displacement of each pin counter-clockwise, one for each planet."
    )
    radial: list[Length] | None = Field(
        default=None, description="Displacement of each pin outward, one for each planet."
    )


#: Harmonics whose phases are listed where the case gives no number.
PHASED_HARMONICS = 12


class PlanetaryPart(Part):
    """A planetary set: one sun, equal planets, one ring, one carrier."""

    sun: str = Field(description="Name of the gear that is the sun.")
    planet: str = Field(description="Name of the gear that each planet is.")
    ring: str | None = Field(
        default=None,
        description="Name of the internal gear that is the ring, whose teeth are then solved in its mesh; give this or "
        "`ring_teeth`.",
    )
    ring_teeth: Annotated[int, Field(ge=5, le=2000)] | None = Field(
        default=None,
        description="Number of teeth of a ring that is no gear of the case, positive; its mesh has a given stiffness.",
    )
    planets: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None, description="Number of evenly spaced planets; give this or `angles`."
    )
    angles: Annotated[list[Angle], Field(min_length=1), at_most(100, "planets")] | None = Field(
        default=None, description="Angles of the planets, counter-clockwise; give this or `planets`."
    )
    centre_distance: PositiveLength | None = Field(
        default=None,
        description="From the axis to the planets; without it the one at which sun and planet mesh without backlash.",
    )
    fixed: CentralName = Field(default="ring", description="Member that does not turn.")
    input: CentralName = Field(default="sun", description="Member that drives.")
    torque: PositiveTorque = Field(description="Torque on the driving member, in the sense of its rotation.")
    speed: PositiveSpeed | None = Field(default=None, description="Speed of the driving member.")
    clockwise: bool = Field(default=False, description="Whether the driving member turns clockwise.")
    speeds: SpeedsPart | None = Field(
        default=None, description="Speeds of the driving member over which vibration is computed."
    )
    backlash: PositiveLength | Literal["unlimited"] = Field(
        default="unlimited",
        description='Backlash of every mesh along the line of action, for `planet-motion`, or "unlimited", with which '
        "back flanks never touch.",
    )
    mesh_efficiency: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="Efficiency of both meshes one after the other with the carrier at rest."
    )
    floating: list[CentralName] = Field(default=["sun"], description="Members without a bearing across the axis.")
    stiffness: SetStiffnessPart = Field(
        default_factory=SetStiffnessPart, description="Stiffness of meshes, pins and bearings."
    )
    pin_errors: PinErrorsPart = Field(
        default_factory=PinErrorsPart, description="How far pins stand from their places on the carrier."
    )
    body: SetBodiesPart = Field(default_factory=SetBodiesPart, description="Masses and inertias, for vibration.")
    damping_ratio: Annotated[Number, Field(ge=0.0, lt=1.0)] = Field(
        default=0.03, description="Damping ratio of every mode, for vibration."
    )
    harmonics: Annotated[int, Field(ge=1, le=200)] | None = Field(
        default=None,
        description="Harmonics of the mesh frequency that are counted. Default: 12; in `planet-vibration` as "
        "many as the tolerance requires, at most 200.",
    )

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.planets is None) == (self.angles is None):
            raise refuse(
                "must be given in one way", 'write planets = 3, or angles = ["0 deg", "117 deg", ...]', key="planets",
                value="(not given)" if self.planets is None else f"{self.planets}, with angles",
            )  # fmt: skip
        if (self.ring is None) == (self.ring_teeth is None):
            raise refuse(
                "must be given, or ring_teeth" if self.ring is None else "contradicts ring_teeth",
                "name the internal gear that is the ring, or give the number of teeth alone", key="ring",
                value="(not given)" if self.ring is None else self.ring,
            )  # fmt: skip
        if self.fixed == self.input:
            raise refuse("is fixed as well", "fix another member, or drive another one", key="input")
        for key in ("tangential", "radial"):
            given = getattr(self.pin_errors, key)
            if given is not None and len(given) != self.count:
                raise refuse(
                    f"has {len(given)} entries for {self.count} planets", "write one for each, zero where it is exact",
                    key=f"pin_errors.{key}", value="(a list)",
                )  # fmt: skip
        for member in self.floating:
            if getattr(self.stiffness, member):
                raise refuse(
                    f"contradicts the bearing of the {member}", f"leave the {member} out, or stiffness.{member}",
                    key="floating",
                )  # fmt: skip
        return self

    @property
    def count(self) -> int:
        """Number of planets."""
        return len(self.angles) if self.angles is not None else self.planets or 0

    def sun_drives(self) -> bool:
        """Whether power rolls from the sun over the planets to the ring, in the motion relative to the carrier."""
        return self.input == "sun" or (self.input == "carrier" and self.fixed == "sun")


@dataclass(frozen=True)
class SetTeeth:
    """Numbers of teeth of a set, and what they make of torque and speed of the driving member."""

    sun: int
    planet: int
    ring: int

    def sun_torque(self, part: PlanetaryPart) -> float:
        """Size of the torque on the sun without losses [N m]."""
        share = {"sun": self.sun, "ring": self.ring, "carrier": self.sun + self.ring}
        return part.torque * self.sun / share[part.input]

    def sun_speed(self, part: PlanetaryPart) -> float | None:
        """Speed of the sun relative to the carrier [rad/s], without its sign; None where none is given."""
        if part.speed is None:
            return None
        of_both, of_ring = self.ring / (self.sun + self.ring), self.ring / self.sun
        share = {
            ("carrier", "sun"): 1.0,
            ("carrier", "ring"): of_ring,
            ("ring", "sun"): of_both,
            ("ring", "carrier"): of_ring,
            ("sun", "ring"): of_both,
            ("sun", "carrier"): 1.0,
        }
        return part.speed * share[part.fixed, part.input]


def set_teeth(case: Case, part: PlanetaryPart) -> SetTeeth:
    """Numbers of teeth of a set whose gears are those of the case."""
    ring = part.ring_teeth if part.ring is None else case.gear[part.ring].teeth
    return SetTeeth(case.gear[part.sun].teeth, case.gear[part.planet].teeth, ring or 0)


Mesh = Literal["sun", "ring"]
MESHES: tuple[Mesh, Mesh] = ("sun", "ring")


def set_pair(name: str, mesh: Mesh) -> str:
    """Name of the pair of a planet with the sun, or with the ring, of a set."""
    return f"{name}_{mesh}"


def with_set_pairs(case: Case, gears: Mapping[str, Gear]) -> Case:
    """The case with the pairs of its planetary sets, each with the load of equal shares and as it runs in the set.

    Raises
    ------
    InputError
        If a set names gears that the case does not have, or a pair of its name has other gears.
    """
    pairs = dict(case.pair)
    for name, part in case.planetary.items():
        for role in ("sun", "planet", "ring"):
            gear = getattr(part, role)
            if gear is None:
                continue
            if gear not in gears:
                raise InputError(f"planetary.{name}.{role}", f'"{gear}"', "is no gear of this case",
                                 nearest(gear, case.gear))  # fmt: skip
            if gears[gear].tooth.internal != (role == "ring"):
                rule = "must be an internal gear" if role == "ring" else "is an internal gear"
                raise InputError(f"planetary.{name}.{role}", f'"{gear}"', rule, "name another gear, or change internal")
        sun = set_pair(name, "sun")
        pairs[sun] = _set_pair(case, name, "sun", part.centre_distance)
        if part.ring is not None:
            distance = pairs[sun].build(dict(gears), f"pair.{sun}").centre_distance
            pairs[set_pair(name, "ring")] = _set_pair(case, name, "ring", distance)
    return case.model_copy(update={"pair": pairs}) if case.planetary else case


def _set_pair(case: Case, name: str, mesh: Mesh, distance: float | None) -> PairPart:
    """The pair of a planet with sun or ring: its own of the case, completed, or a new one."""
    part, teeth = case.planetary[name], set_teeth(case, case.planetary[name])
    planet_drives = part.sun_drives() == (mesh == "ring")
    central: str = getattr(part, mesh)
    roles = (part.planet, central) if planet_drives else (central, part.planet)
    driving = teeth.planet if planet_drives else getattr(teeth, mesh)
    own = set_pair(name, mesh)
    given = case.pair.get(own)
    if given is None:
        given = PairPart(driver=roles[0], driven=roles[1])
    elif (given.driver, given.driven) != roles:
        raise InputError(
            f"pair.{own}.driver", f'"{given.driver}"',
            f"is the mesh of {mesh} and planet of planetary.{name}, in which {roles[0]} drives {roles[1]}",
            "name the gears so, or give the pair another name",
        )  # fmt: skip
    filled: dict[str, Any] = {}
    if not (given.load or given.torque):
        filled["torque"] = teeth.sun_torque(part) / part.count * driving / teeth.sun
    if given.centre_distance is None and distance is not None:
        filled["centre_distance"] = distance
    speed = teeth.sun_speed(part)
    if given.speed is None and speed is not None:
        filled["speed"] = speed * teeth.sun / driving
    filled["operation"] = _operation(part, given, planet_drives)
    return given.model_copy(update=filled)


def _operation(part: PlanetaryPart, given: PairPart, planet_drives: bool) -> OperationPart:
    """How a mesh runs, where its pair does not say: a flank of sun or ring meets every planet in a turn.

    A planet's teeth are bent to either side, by sun and ring.
    """
    said = given.operation.model_fields_set
    filled: dict[str, Any] = {}
    if given.operation.contacts is None:
        filled["contacts"] = [1, part.count] if planet_drives else [part.count, 1]
    if not said & {"idler", "reversed_load", "mean_stress_factor"}:
        filled["idler"] = "driver" if planet_drives else "driven"
    return given.operation.model_copy(update=filled)


def set_of_pair(case: Case, pair: str) -> str | None:
    """The planetary set to which a pair belongs; None where it belongs to none."""
    return next((name for name in case.planetary if pair in (set_pair(name, "sun"), set_pair(name, "ring"))), None)


def set_that_shares(case: Case, pair: str) -> str | None:
    """The set whose load sharing gives the K_gamma of a pair: its own, unless the case gives a K_gamma, or no ring."""
    name = set_of_pair(case, pair)
    if name is None or case.pair[pair].operation.mesh_load_factor is not None:
        return None
    part = case.planetary[name]
    return None if part.ring is None and part.stiffness.ring_mesh is None else name


def angles_of(part: PlanetaryPart) -> list[float]:
    """Angles of the planets [rad]."""
    return part.angles or [2.0 * math.pi * n / part.count for n in range(part.count)]
