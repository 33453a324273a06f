"""``[planetary.NAME]``: sun, planets, ring and carrier, what holds and drives them, and where their pins stand.

The meshes of a set are pairs of the case, `NAME_sun` and `NAME_ring` (`set_pairs`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.case.dynamics import SpeedsPart
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
    refuse,
)

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
        description="Sun-planet mesh stiffness: constant, or equally spaced values over one base pitch from the "
        "pitch point. Default: from the teeth of pair NAME_sun.",
    )
    ring_mesh: MeshStiffness | None = Field(
        default=None,
        description="Planet-ring mesh stiffness: constant, or equally spaced values over one base pitch. Default: "
        "from the teeth of pair NAME_ring if the ring is a gear.",
    )
    pin: PositiveStiffness | None = Field(
        default=None,
        description="Radial stiffness of planet pin and bearing. Default: rigid.",
    )
    sun: StiffnessOrZero | None = Field(
        default=None, description="Radial support stiffness of the sun. Default: rigid, or none if floating."
    )
    ring: StiffnessOrZero | None = Field(
        default=None, description="Radial support stiffness of the ring. Default: rigid, or none if floating."
    )
    carrier: StiffnessOrZero | None = Field(
        default=None, description="Radial support stiffness of the carrier. Default: rigid, or none if floating."
    )
    turning: TorsionalStiffnessOrZero | None = Field(
        default=None, description="Torsional support stiffness of the fixed member. Default: rigid."
    )


class SetBodyPart(Part):
    """``{ mass = "0.4 kg", inertia = "2e-4 kg*m^2" }`` of a body of a set."""

    mass: PositiveMass = Field(description="Mass.")
    inertia: PositiveInertia = Field(description="Moment of inertia about its axis.")


class SetBodiesPart(Part):
    """``body = { carrier = { mass, inertia }, ... }``: what moves; gears have their own where it is not given."""

    sun: SetBodyPart | None = Field(default=None, description="Sun. Default: from the gear.")
    ring: SetBodyPart | None = Field(
        default=None, description="Ring including parts connected to it. Default: from the gear."
    )
    carrier: SetBodyPart | None = Field(default=None, description="Carrier with pins, without planets.")
    planet: SetBodyPart | None = Field(default=None, description="One planet. Default: from the gear.")


class PinErrorsPart(Part):
    """``pin_errors = { tangential = ["20 um", "0 um", "0 um"] }``: how far pins stand from their places."""

    tangential: list[Length] | None = Field(
        default=None, description="Tangential position error of each pin, positive counter-clockwise."
    )
    radial: list[Length] | None = Field(
        default=None, description="Radial position error of each pin, positive outward."
    )


#: Harmonics whose phases are listed where the case gives no number.
PHASED_HARMONICS = 12


class PlanetaryPart(Part):
    """A planetary set: one sun, equal planets, one ring, one carrier."""

    sun: str = Field(description="Name of the sun gear.")
    planet: str = Field(description="Name of the planet gear.")
    ring: str | None = Field(
        default=None,
        description="Name of the ring gear (internal gear of the case); alternatively `ring_teeth`.",
    )
    ring_teeth: Annotated[int, Field(ge=5, le=2000)] | None = Field(
        default=None,
        description="Number of teeth (positive) of a ring that is not modelled as a gear; requires a mesh stiffness.",
    )
    planets: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None, description="Number of equally spaced planets; alternatively `angles`."
    )
    angles: Annotated[list[Angle], Field(min_length=1), at_most(100, "planets")] | None = Field(
        default=None, description="Angles of the planets, counter-clockwise; alternatively `planets`."
    )
    centre_distance: PositiveLength | None = Field(
        default=None,
        description="Centre distance sun-planet. Default: zero backlash.",
    )
    fixed: CentralName = Field(default="ring", description="Fixed member.")
    input: CentralName = Field(default="sun", description="Driving member.")
    torque: PositiveTorque = Field(description="Torque on the driving member, positive in its direction of rotation.")
    speed: PositiveSpeed | None = Field(default=None, description="Speed of the driving member.")
    clockwise: bool = Field(default=False, description="Driving member rotates clockwise.")
    speeds: SpeedsPart | None = Field(default=None, description="Speeds of the driving member for vibration.")
    backlash: PositiveLength | Literal["unlimited"] = Field(
        default="unlimited",
        description='Backlash of all meshes along the line of action, for `planet-motion`, or "unlimited" (no '
        "back-side contact).",
    )
    mesh_efficiency: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="Efficiency of sun and ring mesh in series, carrier fixed."
    )
    floating: list[CentralName] = Field(default=["sun"], description="Floating members (no radial bearing).")
    stiffness: SetStiffnessPart = Field(
        default_factory=SetStiffnessPart, description="Stiffness of meshes, pins and bearings."
    )
    pin_errors: PinErrorsPart = Field(default_factory=PinErrorsPart, description="Pin position errors.")
    odd_planet: Annotated[int, Field(ge=1)] = Field(
        default=1,
        description="Number of the planet to which the odd teeth of the planet gear belong "
        "([[gear.NAME.odd_tooth]]); the teeth of all other planets are identical.",
    )
    body: SetBodiesPart = Field(default_factory=SetBodiesPart, description="Masses and inertias, for vibration.")
    double_helical: bool = Field(
        default=False,
        description="Double helical gears: sun, planet and ring gears are the half at end I, that at end II is the "
        "mirror image; both carry the same load (sun and planets float axially). Torques, mesh forces and masses are "
        "of both.",
    )
    damping_ratio: Annotated[Number, Field(ge=0.0, lt=1.0)] = Field(
        default=0.03, description="Damping ratio of every mode, for vibration."
    )
    harmonics: Annotated[int, Field(ge=1, le=200)] | None = Field(
        default=None,
        description="Harmonics of the mesh frequency in tables of phasing and of planets' forces; `planet-vibration` "
        "always includes all. Default: 12.",
    )

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.planets is None) == (self.angles is None):
            raise refuse(
                "must be specified in one way", 'set planets = 3, or angles = ["0 deg", "117 deg", ...]', key="planets",
                value="(not given)" if self.planets is None else f"{self.planets}, with angles",
            )  # fmt: skip
        if (self.ring is None) == (self.ring_teeth is None):
            raise refuse(
                "is required, or ring_teeth" if self.ring is None else "contradicts ring_teeth",
                "specify either the ring gear or its number of teeth", key="ring",
                value="(not given)" if self.ring is None else self.ring,
            )  # fmt: skip
        if self.fixed == self.input:
            raise refuse("is fixed as well", "choose a different fixed or driving member", key="input")
        if self.odd_planet > self.count:
            raise refuse(
                f"must be at most {self.count}, the number of planets", "specify one of the planets", key="odd_planet"
            )
        for key in ("tangential", "radial"):
            given = getattr(self.pin_errors, key)
            if given is not None and len(given) != self.count:
                raise refuse(
                    f"has {len(given)} entries for {self.count} planets",
                        "specify one value for each planet (zero if exact)",
                    key=f"pin_errors.{key}", value="(a list)",
                )  # fmt: skip
        for member in self.floating:
            if getattr(self.stiffness, member):
                raise refuse(
                    f"contradicts the floating {member}", f"remove the {member} from floating, or remove "
                                                                f"stiffness.{member}",
                    key="floating",
                )  # fmt: skip
        return self

    @property
    def count(self) -> int:
        """Number of planets."""
        return len(self.angles) if self.angles is not None else self.planets or 0

    @property
    def halves(self) -> int:
        """How many halves of its gears share the load evenly: 2 of double helical ones."""
        return 2 if self.double_helical else 1

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


Mesh = Literal["sun", "ring"]
MESHES: tuple[Mesh, Mesh] = ("sun", "ring")


def set_pair(name: str, mesh: Mesh) -> str:
    """Name of the pair of a planet with the sun, or with the ring, of a set."""
    return f"{name}_{mesh}"


def angles_of(part: PlanetaryPart) -> list[float]:
    """Angles of the planets [rad]."""
    return part.angles or [2.0 * math.pi * n / part.count for n in range(part.count)]
