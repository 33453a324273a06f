"""Helical keys of ``[gear.NAME]`` and ``[pair.NAME]``, and ``[tooth_contact]``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, InverseLength, Length, LengthOrZero, Part, PositiveForce, PositiveLength, refuse

if TYPE_CHECKING:
    from fegear.contact.unloaded.pair import HelicalPair, Misalignment
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair


class ShaftPart(Part):
    """``{ in_plane, out_of_plane, over }``: f_Sigma_delta and f_Sigma_beta of a shaft (ISO/TR 10064-3).

    Measured over the distance of its bearings, or over the face of its gear; positive opens the flanks toward end II.
    """

    in_plane: Length = Field(
        default=0.0,
        description="f_Sigma_delta of ISO/TR 10064-3: deviation in the plane of the axes; positive if the axes "
        "diverge towards end II.",
    )
    out_of_plane: Length = Field(
        default=0.0,
        description="f_Sigma_beta of ISO/TR 10064-3: deviation perpendicular to that plane; positive if the flank "
        "gap opens towards end II.",
    )
    over: PositiveLength | None = Field(
        default=None,
        description="Reference length of the deviations, e.g. bearing span. Default: face width of the gear.",
    )


class MisalignmentPart(Part):
    """``misalignment = { shaft_angle, lead_angle or lead, profile_angle, centre_distance, driver, driven }``.

    ``lead`` is the error of the pinion's lead itself, which the cutting machine leaves: Delta H_1 of TM-107451, Eq. 18.
    ``driver`` and ``driven`` are deviations of their shafts from parallel, which add to ``shaft_angle``.
    """

    shaft_angle: Angle = Field(
        default=0.0,
        description="Rotation of the driven gear's axis about the line of centres (`out_of_plane` as an angle).",
    )
    lead_angle: Angle = Field(default=0.0, description="Lead angle error of the pinion; alternatively `lead`.")
    lead: Length | None = Field(
        default=None,
        description="Lead error of the pinion, Delta H_1 of TM-107451, Eq. 18; alternatively `lead_angle`.",
    )
    profile_angle: Angle = Field(default=0.0, description="Error of the normal profile angle of the pinion cutter.")
    centre_distance: Length = Field(default=0.0, description="Error of the centre distance.")
    driver: ShaftPart | None = Field(
        default=None, description="Parallelism deviation of the driver shaft, added to `shaft_angle`."
    )
    driven: ShaftPart | None = Field(
        default=None, description="Parallelism deviation of the driven shaft, added to `shaft_angle`."
    )

    @model_validator(mode="after")
    def _one_lead(self) -> Self:
        if self.lead is not None and "lead_angle" in self.given:
            raise refuse("contradicts lead_angle", "specify either lead or lead_angle", key="lead")
        return self

    def deviation(self, pair: GearPair) -> tuple[float, float]:
        """Of both shafts together from parallel, in and out of their plane [rad]."""
        inside, across = 0.0, self.shaft_angle
        for part, gear in ((self.driver, pair.driver), (self.driven, pair.driven)):
            if part is not None:
                inside += part.in_plane / (part.over or gear.face_width)
                across += part.out_of_plane / (part.over or gear.face_width)
        return inside, across

    def angle_of_lead(self, pinion: Gear) -> float:
        """Error of the lead angle [rad], as given or as that of the lead."""
        from fegear.contact.unloaded.manufacture import lead_angle_error

        return self.lead_angle if self.lead is None else lead_angle_error(pinion, self.lead)

    def build(self, pair: GearPair) -> Misalignment:
        """Make the errors that rigid tooth contact analysis knows."""
        from fegear.contact.unloaded.pair import Misalignment

        _, across = self.deviation(pair)
        return Misalignment(across, self.angle_of_lead(pair.driver), self.profile_angle, self.centre_distance)


class ModificationPart(Part):
    """``modification = { parabola, crown }``: how the pinion's flank is localised.

    ``parabola`` is the cutter's coefficient a_c; ``crown`` the material removed at each end of the face, along the
    normal; ``absorb = true`` chooses the crown so that its parabolic error absorbs the pair's linear one.
    """

    parabola: InverseLength = Field(default=0.0, description="Parabola coefficient a_c of the pinion cutter.")
    crown: LengthOrZero = Field(
        default=0.0, description="Amount of lead crowning at each face end of the pinion, normal to the flank."
    )
    absorb: bool = Field(
        default=False,
        description="Choose the lead crowning such that its parabolic transmission error absorbs the linear one from "
        "misalignment.",
    )

    def crown_coefficient(self, pinion: Gear) -> float:
        """Crown as a turn of the section per squared height [rad/m^2]."""
        arm = pinion.base_radius * math.cos(pinion.base_helix_angle)
        return self.crown / (arm * (0.5 * pinion.face_width) ** 2)


class ToothContactPart(Part):
    """``[tooth_contact]``: how finely the cycle is looked at, and the load for contact ellipses."""

    positions: Annotated[int, Field(ge=2, le=100_000)] = Field(
        default=400, description="Number of pinion angles per mesh cycle; the extremes do not depend on it."
    )
    load: PositiveForce | None = Field(
        default=None, description="Normal force on a tooth pair, for contact ellipses. Default: no ellipses."
    )


def build_pair(
    design: GearPair,
    errors: MisalignmentPart | None,
    change: ModificationPart | None,
    axial_offset: float,
) -> HelicalPair:
    """The flanks of a pair with their errors and modification; the driver is the pinion."""
    from fegear.contact.unloaded.pair import HelicalPair, Misalignment

    change = change or ModificationPart()
    return HelicalPair(
        design.driver,
        design.driven,
        Misalignment() if errors is None else errors.build(design),
        parabola=change.parabola,
        crown=change.crown_coefficient(design.driver),
        axial_offset=axial_offset,
        design_distance=design.centre_distance,
    )
