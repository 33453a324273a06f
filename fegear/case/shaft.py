"""``[shaft.NAME]`` and ``[bearing.NAME]``: shafts in space with their gears, what holds them and what turns them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.errors import GeometryError
from fegear.case.gear import MaterialPart
from fegear.case.part import (
    Angle,
    Force,
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    StiffnessOrZero,
    TorsionalStiffnessOrZero,
    at_most,
    quantity,
    refuse,
)
from fegear.geometry.plausible import refuse_shaft

if TYPE_CHECKING:
    from fegear.shafts.beam import Shaft
    from fegear.shafts.bearing import Bearing
    from fegear.shafts.life import LifeRating

Torque = Annotated[float, quantity("torque")]


class SectionPart(Part):
    """``{ length = "40 mm", outer = "35 mm", inner = "0 mm" }``; a cone where an end has another diameter."""

    length: PositiveLength = Field(description="Length along the axis.")
    outer: PositiveLength = Field(description="Outer diameter at its start.")
    inner: LengthOrZero = Field(default=0.0, description="Diameter of the hole at its start; zero for solid.")
    outer_end: PositiveLength | None = Field(default=None, description="Outer diameter at the end of a cone.")
    inner_end: LengthOrZero | None = Field(default=None, description="Diameter of a conical hole at the end.")


class GearPlacePart(Part):
    """``{ gear = "pinion", at = "60 mm" }``: the middle of a gear's face on the shaft."""

    gear: str = Field(description="Name of a gear of the case.")
    at: LengthOrZero = Field(description="Middle of its face from the shaft's left end.")
    stiffens: bool = Field(
        default=True,
        description="Whether its body sits fast on the shaft, or is one with it, and carries torque and bending over "
        "its `seat`; without, the gear moves with the section of the bare shaft at each height of its face.",
    )
    seat: PositiveLength | None = Field(
        default=None,
        description="Length over which it sits fast, about the middle of its face; without it all of the face, or of "
        "the hub of its body.",
    )

    @model_validator(mode="after")
    def _fast(self) -> Self:
        if self.seat is not None and not self.stiffens:
            raise refuse("contradicts stiffens = false", "leave one of them out", key="seat")
        return self


class BearingPlacePart(Part):
    """``{ bearing = "6208", at = "12 mm" }``: a bearing on the shaft."""

    bearing: str = Field(description="Name of a bearing of the case.")
    at: LengthOrZero = Field(description="Where its force acts, from the shaft's left end.")
    around: str | None = Field(
        default=None,
        description="Name of the shaft around this one in which its outer ring sits; the housing without it. Its name "
        "stands at the inner shaft alone.",
    )
    reversed: bool = Field(
        default=False,
        description="Whether the bearing is mounted the other way round: its contact angle and the coupling of force "
        "and tilt change their sign.",
    )


class LoadPart(Part):
    """``{ at = "0 mm", force = ["0 N", "-800 N", "0 N"] }``: a force from outside, at the axis."""

    at: LengthOrZero = Field(description="Where it acts, from the shaft's left end.")
    force: Annotated[list[Force], Field(min_length=3, max_length=3)] | None = Field(
        default=None, description="Along x, y and the axis z."
    )
    moment: Annotated[list[Torque], Field(min_length=3, max_length=3)] | None = Field(
        default=None, description="About x, y and the axis z."
    )


class ShaftInSpacePart(Part):
    """A shaft parallel to z: sections from its left end on, its gears, bearings, coupling and loads."""

    axis: Annotated[list[Length], Field(min_length=2, max_length=2)] = Field(
        default=[0.0, 0.0], description="Where the axis stands: x and y."
    )
    start: Length = Field(default=0.0, description="z of the left end.")
    sections: Annotated[list[SectionPart], Field(min_length=1), at_most(1000, "sections")] = Field(
        description="Sections one after the other from the left end."
    )
    material: MaterialPart = Field(default_factory=MaterialPart, description="Material of the shaft.")
    rigid: bool = Field(default=False, description="Whether the shaft itself does not bend, to compare.")
    gears: Annotated[list[GearPlacePart], at_most(100, "gears")] = Field(default=[], description="Gears on it.")
    bearings: Annotated[list[BearingPlacePart], at_most(100, "bearings")] = Field(
        default=[], description="Bearings that hold it."
    )
    coupling: LengthOrZero | None = Field(
        default=None, description="Where the torque enters or leaves that the gears do not balance; none without it."
    )
    loads: Annotated[list[LoadPart], at_most(1000, "loads")] = Field(default=[], description="Forces from outside.")
    clockwise: bool = Field(
        default=False, description="Sense in which it turns, seen from +z; shafts driven by others follow from these."
    )

    @model_validator(mode="after")
    def _of_a_gearbox(self) -> Self:
        thickest = max(max(one.outer, one.outer_end or 0.0) for one in self.sections)
        try:
            refuse_shaft(sum(one.length for one in self.sections), thickest)
        except GeometryError as error:
            raise refuse(f"{error.rule} in {error.key}", error.remedy, key="sections", value=error.value) from None
        return self

    def build(self, *, rigid: bool = False) -> Shaft:
        """Make the shaft."""
        from fegear.shafts.beam import Section, Shaft

        made = tuple(Section(one.length, one.outer, one.inner, one.outer_end, one.inner_end) for one in self.sections)
        modulus = math.inf if rigid or self.rigid else self.material.young_modulus
        return Shaft(made, modulus, self.material.poisson_ratio)


class RollingElementsPart(Part):
    """``elements = { kind = "ball", count = 9, diameter = "12.7 mm", pitch_diameter = "65 mm" }``."""

    kind: Literal["ball", "roller"] = Field(description="Balls press by Hertz's law, rollers by that of ISO/TS 16281.")
    count: Annotated[int, Field(ge=3, le=500)] = Field(description="Number of balls or rollers.")
    diameter: PositiveLength = Field(description="Of a ball, or of a roller in its middle.")
    pitch_diameter: PositiveLength = Field(description="Of the circle of their centres.")
    contact_angle: Angle = Field(
        default=0.0, description="Zero for deep groove and cylindrical; positive where a shaft moving to +z is held."
    )
    groove_ratio: Annotated[list[Number], Field(min_length=2, max_length=2)] = Field(
        default=[0.52, 0.52], description="Groove radius over ball diameter of inner and outer ring."
    )
    roller_length: PositiveLength | None = Field(default=None, description="Effective length of a roller.")
    clearance: Length = Field(default=0.0, description="Diametral clearance as mounted; negative for preload.")


class BearingLifePart(Part):
    """``life = { dynamic_rating = "32.5 kN", axial_factor = 1.6, ... }`` of the catalogue, for ISO 281."""

    dynamic_rating: PositiveForce = Field(description="Basic dynamic load rating C.")
    kind: Literal["ball", "roller"] = Field(default="ball", description="Exponent 3 or 10/3.")
    radial_factor: Annotated[Number, Field(ge=0.0)] = Field(default=1.0, description="X beyond the limit e.")
    axial_factor: Annotated[Number, Field(ge=0.0)] = Field(default=0.0, description="Y beyond the limit e.")
    limit: Annotated[Number, Field(ge=0.0)] = Field(default=0.0, description="e: F_a/F_r up to which P = F_r.")

    def build(self) -> LifeRating:
        """Make the rating."""
        from fegear.shafts.life import LifeRating

        return LifeRating(self.dynamic_rating, self.kind, self.radial_factor, self.axial_factor, self.limit)


class BearingPart(Part):
    """A bearing: stiffness with or without clearance, or its elements; rigid radially where nothing is said."""

    radial: StiffnessOrZero | None = Field(default=None, description="Radial stiffness; rigid without it.")
    axial: StiffnessOrZero | None = Field(default=None, description="Axial stiffness; none without it, unless `fixed`.")
    tilting: TorsionalStiffnessOrZero = Field(default=0.0, description="Stiffness against tilt.")
    fixed: bool = Field(default=False, description="Whether it is rigid along the axis.")
    radial_clearance: LengthOrZero = Field(default=0.0, description="How far the ring moves to a side freely.")
    axial_clearance: LengthOrZero = Field(default=0.0, description="How far the ring moves along the axis freely.")
    matrix: Annotated[list[list[Number]], Field(min_length=5, max_length=5)] | None = Field(
        default=None, description="5 x 5 stiffness in N, m, rad against x, y, z and turns about x and y."
    )
    elements: RollingElementsPart | None = Field(default=None, description="What rolls in it, for nonlinear stiffness.")
    housing_radial: StiffnessOrZero | None = Field(
        default=None, description="Radial stiffness of the seat in the housing; rigid without it."
    )
    housing_axial: StiffnessOrZero | None = Field(
        default=None, description="Axial stiffness of the seat in the housing; rigid without it."
    )
    life: BearingLifePart | None = Field(default=None, description="Ratings of the catalogue, for lives by ISO 281.")

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        stiffness = {"radial", "axial", "tilting", "fixed", "radial_clearance", "axial_clearance"}
        ways = [key for key in ("matrix", "elements") if getattr(self, key) is not None]
        if len(ways) + bool(stiffness & self.given) > 1:
            raise refuse("contradicts other keys", "give stiffness, a matrix, or elements", key=ways[0])
        if self.matrix is not None and any(len(row) != 5 for row in self.matrix):
            raise refuse("has rows of other lengths than 5", "write five numbers a row", key="matrix", value="(rows)")
        if (self.radial_clearance or self.axial_clearance) and (self.radial is None or self.fixed):
            raise refuse("needs a stiffness behind the clearance", "give radial and axial", key="radial_clearance")
        for key in ("housing_radial", "housing_axial"):
            if getattr(self, key) == 0.0:
                raise refuse("leaves no seat", "give a stiffness above zero, or leave it out", key=key)
        if self.elements is not None and self.elements.kind == "roller" and self.elements.roller_length is None:
            raise refuse("is needed for rollers", 'write roller_length = "12 mm"', key="elements.roller_length")
        return self

    def build(self, *, mirrored: bool = False) -> Bearing:
        """Make the bearing."""
        import numpy as np

        from fegear.shafts.bearing import LooseBearing, StiffBearing, stiff
        from fegear.shafts.rolling_bearing import RollingBearing

        if self.matrix is not None:
            sign = np.array([1.0, 1.0, -1.0, -1.0, -1.0] if mirrored else [1.0] * 5)
            return StiffBearing(np.array(self.matrix) * np.outer(sign, sign))
        if self.elements is not None:
            e = self.elements
            return RollingBearing(
                e.kind, e.count, e.diameter, e.pitch_diameter, -e.contact_angle if mirrored else e.contact_angle,
                (e.groove_ratio[0], e.groove_ratio[1]), e.roller_length or 0.0, e.clearance,
            )  # fmt: skip
        if self.radial_clearance or self.axial_clearance:
            return LooseBearing(
                self.radial or 0.0, self.axial or 0.0, self.tilting, self.radial_clearance, self.axial_clearance
            )
        return stiff(
            math.inf if self.radial is None else self.radial,
            math.inf if self.fixed else self.axial or 0.0, self.tilting,
        )  # fmt: skip
