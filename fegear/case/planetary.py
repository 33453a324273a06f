"""``[planetary.NAME]``: sun, planets, ring and carrier, what holds and drives them, and where their pins stand.

The meshes of a set are pairs of the case: `NAME_sun`, made here unless the case has one of that name.
"""

from __future__ import annotations

import math
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
    from fegear.case.model import Case
    from fegear.case.operation import OperationPart

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
        default=None, description="Mesh stiffness of planet and ring: one value, or several evenly over the base pitch."
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
    """``body = { carrier = { mass, inertia }, ... }``: what moves; sun and planets are discs where it is not given."""

    sun: SetBodyPart | None = Field(default=None, description="The sun; without it a disc with the gear's bore.")
    ring: SetBodyPart | None = Field(default=None, description="The ring, with what turns with it.")
    carrier: SetBodyPart | None = Field(default=None, description="The carrier with its pins, without planets.")
    planet: SetBodyPart | None = Field(default=None, description="One planet; without it a disc with the gear's bore.")


class PinErrorsPart(Part):
    """``pin_errors = { tangential = ["20 um", "0 um", "0 um"] }``: how far pins stand from their places."""

    tangential: list[Length] | None = Field(
        default=None, description="Displacement of each pin counter-clockwise, one for each planet."
    )
    radial: list[Length] | None = Field(
        default=None, description="Displacement of each pin outward, one for each planet."
    )


class PlanetaryPart(Part):
    """A planetary set: one sun, equal planets, one ring, one carrier."""

    sun: str = Field(description="Name of the gear that is the sun.")
    planet: str = Field(description="Name of the gear that each planet is.")
    ring_teeth: Annotated[int, Field(ge=5, le=2000)] = Field(description="Number of teeth of the ring, positive.")
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
    backlash: PositiveLength | None = Field(
        default=None,
        description="Backlash of every mesh along the line of action, for `planet-motion`; without it back flanks "
        "never touch.",
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
    harmonics: Annotated[int, Field(ge=1, le=200)] = Field(
        default=12, description="Harmonics of the mesh frequency that are counted."
    )

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if (self.planets is None) == (self.angles is None):
            raise refuse(
                "must be given in one way", 'write planets = 3, or angles = ["0 deg", "117 deg", ...]', key="planets",
                value="(not given)" if self.planets is None else f"{self.planets}, with angles",
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

    def sun_torque(self, sun_teeth: int) -> float:
        """Size of the torque on the sun without losses [N m]."""
        share = {"sun": sun_teeth, "ring": self.ring_teeth, "carrier": sun_teeth + self.ring_teeth}
        return self.torque * sun_teeth / share[self.input]

    def sun_drives(self) -> bool:
        """Whether power rolls from the sun over the planets to the ring, in the motion relative to the carrier."""
        return self.input == "sun" or (self.input == "carrier" and self.fixed == "sun")

    def sun_speed(self, sun_teeth: int) -> float | None:
        """Speed of the sun relative to the carrier [rad/s], without its sign; None where none is given."""
        if self.speed is None:
            return None
        teeth = sun_teeth + self.ring_teeth
        share = {
            ("carrier", "sun"): 1.0,
            ("carrier", "ring"): self.ring_teeth / sun_teeth,
            ("ring", "sun"): self.ring_teeth / teeth,
            ("ring", "carrier"): self.ring_teeth / sun_teeth,
            ("sun", "ring"): self.ring_teeth / teeth,
            ("sun", "carrier"): 1.0,
        }
        return self.speed * share[self.fixed, self.input]


def sun_pair(name: str) -> str:
    """Name of the pair of sun and planet of a set."""
    return f"{name}_sun"


def with_set_pairs(case: Case) -> Case:
    """The case with the pairs of its planetary sets, each with the load of equal shares and as it runs in the set.

    Raises
    ------
    InputError
        If a set names gears that the case does not have, or a pair of its name has other gears.
    """
    pairs = dict(case.pair)
    for name, part in case.planetary.items():
        for role in ("sun", "planet"):
            if (gear := getattr(part, role)) not in case.gear:
                raise InputError(f"planetary.{name}.{role}", f'"{gear}"', "is no gear of this case",
                                 nearest(gear, case.gear))  # fmt: skip
        own = sun_pair(name)
        drives = part.sun_drives()
        roles = (part.sun, part.planet) if drives else (part.planet, part.sun)
        teeth = case.gear[part.sun].teeth
        torque = part.sun_torque(teeth) / part.count * (1.0 if drives else case.gear[part.planet].teeth / teeth)
        given = pairs.get(own)
        if given is None:
            given = PairPart(driver=roles[0], driven=roles[1])
        elif (given.driver, given.driven) != roles:
            raise InputError(
                f"pair.{own}.driver", f'"{given.driver}"',
                f"is the mesh of sun and planet of planetary.{name}, in which {roles[0]} drives {roles[1]}",
                "name the gears so, or give the pair another name",
            )  # fmt: skip
        filled: dict[str, Any] = {} if given.load or given.torque else {"torque": torque}
        if given.centre_distance is None and part.centre_distance is not None:
            filled["centre_distance"] = part.centre_distance
        speed = part.sun_speed(teeth)
        if given.speed is None and speed is not None:
            filled["speed"] = speed * (1.0 if drives else teeth / case.gear[part.planet].teeth)
        filled["operation"] = _operation(part, given)
        pairs[own] = given.model_copy(update=filled)
    return case.model_copy(update={"pair": pairs}) if case.planetary else case


def _operation(part: PlanetaryPart, given: PairPart) -> OperationPart:
    """How the mesh of sun and planet runs, where its pair does not say: a sun's flank meets every planet in a turn.

    A planet's teeth are bent to either side, by sun and ring.
    """
    drives, said = part.sun_drives(), given.operation.model_fields_set
    filled: dict[str, Any] = {}
    if "contacts" not in said:
        filled["contacts"] = [part.count, 1] if drives else [1, part.count]
    if not said & {"idler", "reversed_load", "mean_stress_factor"}:
        filled["idler"] = "driven" if drives else "driver"
    return given.operation.model_copy(update=filled)


def set_of_pair(case: Case, pair: str) -> str | None:
    """The planetary set to which a pair belongs; None where it belongs to none."""
    return next((name for name in case.planetary if sun_pair(name) == pair), None)


def set_that_shares(case: Case, pair: str) -> str | None:
    """The set whose load sharing gives the K_gamma of a pair: its own, unless the case gives a K_gamma, or no ring."""
    name = set_of_pair(case, pair)
    if name is None or "mesh_load_factor" in case.pair[pair].operation.model_fields_set:
        return None
    return name if case.planetary[name].stiffness.ring_mesh is not None else None


def angles_of(part: PlanetaryPart) -> list[float]:
    """Angles of the planets [rad]."""
    return part.angles or [2.0 * math.pi * n / part.count for n in range(part.count)]
