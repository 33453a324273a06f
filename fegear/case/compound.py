"""``[compound.NAME]``: a planetary gear set described as data, by its shafts, planets and meshes.

Sun, ring and carrier are shafts like any other; a shaft may be several of them in one piece. Every gear is one of the
case. Stepped planets are groups with two gears; Ravigneaux, Simpson and Wolfrom sets are lists of meshes.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from fegear.case.part import (
    Angle,
    Number,
    Part,
    PositiveLength,
    PositiveSpeed,
    PositiveStiffness,
    PositiveTorque,
    StiffnessOrZero,
    Table,
    TorsionalStiffnessOrZero,
    at_most,
    refuse,
)
from fegear.case.planetary import SetBodyPart

#: Shafts, groups of planets, and meshes that one set may have.
_MOST = 30


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return [value] if isinstance(value, str) else value


def _range(teeth: list[int]) -> list[int]:
    """Refuse what is no range of numbers of teeth."""
    if len(teeth) != 2 or not 5 <= teeth[0] <= teeth[1] <= 2000:
        raise refuse("must be a range of numbers of teeth [from, to] from 5 to 2000", "e.g. [17, 40]",
                     value=f"{teeth}"[:60])  # fmt: skip
    return teeth


def _two(names: list[str]) -> list[str]:
    """Refuse more or fewer than two members."""
    if len(names) != 2:
        raise refuse(f"must be two members, not {len(names)}", 'set gears = ["sun", "planet"]')
    return names


Names = Annotated[
    list[str],
    BeforeValidator(_several, json_schema_input_type=str | list[str]),
    at_most(_MOST, "names"),
]


class CompoundShaftPart(Part):
    """``[compound.NAME.shaft.SHAFT]``: a body about the axis of the set, with its gears."""

    gears: Names | None = Field(
        default=None,
        description="Gears of the case on this shaft. Default: the gear with the name of the shaft, if there is one; "
        "otherwise none (carrier only).",
    )
    bearing: StiffnessOrZero | None = Field(
        default=None, description='Radial support stiffness; "0 N/m": floating. Default: rigid.'
    )
    turning: TorsionalStiffnessOrZero | None = Field(
        default=None, description="Torsional support stiffness if the shaft is fixed. Default: rigid."
    )
    body: SetBodyPart | None = Field(
        default=None, description="Mass and inertia including parts connected to it. Default: from the gears."
    )


class CompoundPlanetPart(Part):
    """``[compound.NAME.planet.GROUP]``: equal planets on one carrier; one with two gears is a stepped planet."""

    carrier: str = Field(description="Shaft that carries these planets.")
    gears: Names | None = Field(
        default=None,
        description="Gears of the case on each planet, rigidly connected. Default: the gear with the name of the "
        "group.",
    )
    planets: Annotated[int, Field(ge=1, le=100)] | None = Field(
        default=None, description="Number of equally spaced planets; alternatively `angles`."
    )
    angles: Annotated[list[Angle], Field(min_length=1), at_most(100, "planets")] | None = Field(
        default=None, description="Angles of the planets, counter-clockwise; alternatively `planets`."
    )
    first_angle: Angle | None = Field(
        default=None,
        description="Angle of the first of equally spaced planets. Default: 0, or counter-clockwise of the planets "
        "already placed that it meshes with, at zero backlash.",
    )
    centre_distance: PositiveLength | None = Field(
        default=None,
        description="Radius of the circle of planet centres. Default: zero backlash of the first mesh with a shaft.",
    )
    pin: PositiveStiffness | None = Field(
        default=None, description="Radial stiffness of planet pin and bearing. Default: rigid."
    )
    body: SetBodyPart | None = Field(default=None, description="One planet. Default: from the gears.")

    @model_validator(mode="after")
    def _placed_once(self) -> Self:
        if (self.planets is None) == (self.angles is None):
            raise refuse(
                "must be specified in one way", 'set planets = 3, or angles = ["0 deg", "117 deg", ...]', key="planets",
                value="(not given)" if self.planets is None else f"{self.planets}, with angles",
            )  # fmt: skip
        if self.angles is not None and self.first_angle is not None:
            raise refuse("contradicts angles", "remove it", key="first_angle",
                         value=f"{math.degrees(self.first_angle):.6g} deg")  # fmt: skip
        return self


class CompoundMeshPart(Part):
    """``[[compound.NAME.mesh]]``: two members in mesh, at every planet of a group."""

    gears: Annotated[list[str], AfterValidator(_two)] = Field(
        description="Two members in mesh, a planet and a shaft or another planet; MEMBER.GEAR where a member has "
        "several gears."
    )
    efficiency: Annotated[Number, Field(gt=0.0, le=1.0)] = Field(
        default=1.0, description="Efficiency of the mesh, carrier fixed."
    )
    stiffness: PositiveStiffness | None = Field(
        default=None, description="Mean mesh stiffness at one planet, for modes."
    )


class ToothSearchPart(Part):
    """``[compound.NAME.search]``: numbers of teeth that give a wanted ratio."""

    ratio: Number = Field(
        description="Wanted ratio of input to output speed, negative if they rotate in opposite directions."
    )
    tolerance: Annotated[Number, Field(gt=0.0, le=0.5)] = Field(
        default=0.01, description="Largest relative deviation of the ratio."
    )
    teeth: dict[str, Annotated[list[int], AfterValidator(_range)]] = Field(
        default_factory=dict,
        description="Range of the numbers of teeth of gears, by name: [from, to]. Gears that are not named vary by "
        "20 %, at least 12 teeth.",
    )
    coaxial: Annotated[Number, Field(ge=0.0, le=3.0)] = Field(
        default=0.5,
        description="Largest difference of reference centre distances of one planet, in modules; profile shifts "
        "have to balance it.",
    )
    clearance: Annotated[Number, Field(ge=0.0, le=100.0)] = Field(
        default=1.0, description="Minimum distance between tip circles of planets, in modules."
    )
    most: Annotated[int, Field(ge=1, le=1000)] = Field(default=20, description="Number of combinations listed.")

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if self.ratio == 0.0:
            raise refuse("must not be zero", "set ratio = 3.5, or -3.5 for opposite directions", key="ratio", value=0)
        return self


class CompoundPart(Part):
    """A planetary gear set of any shafts, planets and meshes on one axis."""

    shaft: Annotated[dict[str, Table[CompoundShaftPart]], Field(min_length=2)] = Field(
        description="Shafts (suns, rings, carriers) on the axis of the set, by name."
    )
    planet: Annotated[dict[str, Table[CompoundPlanetPart]], Field(min_length=1)] = Field(
        description="Groups of equal planets, by name."
    )
    mesh: Annotated[list[Table[CompoundMeshPart]], Field(min_length=1), at_most(_MOST, "meshes")] = Field(
        description="Members in mesh."
    )
    fixed: Names = Field(default=[], description="Fixed shafts.")
    input: str | None = Field(
        default=None, description="Driving shaft. Default: none; ratios of all combinations only."
    )
    output: str | None = Field(
        default=None,
        description="Loaded shaft; other shafts run idle. Default: the only shaft that is not fixed and not driving.",
    )
    torque: PositiveTorque | None = Field(
        default=None, description="Torque on the driving shaft, positive in its direction of rotation."
    )
    speed: PositiveSpeed | None = Field(default=None, description="Speed of the driving shaft.")
    clockwise: bool = Field(default=False, description="Driving shaft rotates clockwise.")
    harmonics: Annotated[int, Field(ge=1, le=200)] = Field(
        default=12, description="Harmonics of the mesh frequency in the table of phasing."
    )

    search: Table[ToothSearchPart] | None = Field(
        default=None, description="Numbers of teeth wanted for a ratio, for `tooth-numbers`."
    )

    @model_validator(mode="after")
    def _names(self) -> Self:
        for table, what, count in (("shaft", "shafts", len(self.shaft)), ("planet", "groups", len(self.planet))):
            if count > _MOST:
                raise refuse(f"requests {count} {what}, above the limit", f"reduce to at most {_MOST}", key=table,
                             value="(a table)")  # fmt: skip
        both = next((one for one in self.planet if one in self.shaft), None)
        if both is not None:
            raise refuse("is the name of a shaft as well", "rename one of them", key=f"planet.{both}", value=both)
        for key, name in (*(("fixed", one) for one in self.fixed), ("input", self.input), ("output", self.output)):
            if name is not None and name not in self.shaft:
                raise refuse("is not a shaft of this set", f"name one of {', '.join(self.shaft)}", key=key, value=name)
        if len(set(self.fixed)) < len(self.fixed):
            raise refuse("names a shaft twice", "name it once", key="fixed", value=", ".join(self.fixed))
        self._check_drive()
        return self

    def _check_drive(self) -> None:
        if self.input is None:
            given = next((key for key in ("fixed", "output", "torque", "speed") if getattr(self, key)), None)
            if given is not None:
                raise refuse("is not used without input", f'set input = "SHAFT", or remove {given}', key=given,
                             value="(given)")  # fmt: skip
            return
        if self.torque is None:
            raise refuse("is required with input", 'set torque = "100 N*m"', key="torque", value="(not given)")
        if self.input in self.fixed:
            raise refuse("is fixed as well", "choose a different fixed or driving shaft", key="input", value=self.input)
        if self.output in (*self.fixed, self.input):
            raise refuse("must be neither fixed nor driving", "choose a different shaft", key="output",
                         value=self.output)  # fmt: skip
        if self.output is None and len(self.free) != 1:
            raise refuse(
                "is required: " + (f"{', '.join(self.free)} are free" if self.free else "no shaft is free"),
                "set output to the loaded shaft" if self.free else "fix fewer shafts", key="output",
                value="(not given)",
            )  # fmt: skip

    @property
    def free(self) -> list[str]:
        """Shafts that are neither fixed nor driving."""
        return [one for one in self.shaft if one not in self.fixed and one != self.input]

    @property
    def loaded(self) -> str:
        """The loaded shaft, where one drives."""
        return self.output or self.free[0]
