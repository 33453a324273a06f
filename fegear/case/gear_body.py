"""``[gear.NAME.body]``: rim, web and hub of a gear that is solved with its width."""

from __future__ import annotations

from typing import Self

from pydantic import Field, model_validator

from fegear.case.part import Length, Part, PositiveLength, refuse
from fegear.geometry.gear_body import GearBody


class GearBodyPart(Part):
    """``body = { rim_thickness, web_thickness, web_offset, hub_radius, hub_width, hub_offset }``."""

    rim_thickness: PositiveLength = Field(
        description="Rim s_R below the root circle, as wide as the face; for the ratings too (Y_B, C_R, K_B)."
    )
    web_thickness: PositiveLength = Field(
        description="Thickness b_s of the web between rim and hub, along the axis; for C_R of the ratings too."
    )
    web_offset: Length = Field(
        default=0.0, description="How far the middle of the web lies from the middle of the face, toward end II."
    )
    hub_radius: PositiveLength | None = Field(
        default=None, description="Outside of the hub; without it the web goes down to the bore and is held there."
    )
    hub_width: PositiveLength | None = Field(
        default=None, description="Width of the hub, at most that of the face; without it as wide as the face."
    )
    hub_offset: Length = Field(
        default=0.0, description="How far the middle of the hub lies from the middle of the face, toward end II."
    )

    @model_validator(mode="after")
    def _hub(self) -> Self:
        if self.hub_radius is None:
            for key in ("hub_width", "hub_offset"):
                if key in self.model_fields_set:
                    raise refuse("has a meaning only with hub_radius", 'write hub_radius = "25 mm"', key=key)
        return self

    def build(self, root_radius: float, bore_radius: float, face_width: float) -> GearBody:
        """Make the body of a gear [m]."""

        def part(width: float, offset: float) -> tuple[float, float]:
            return offset - 0.5 * width, offset + 0.5 * width

        web = part(self.web_thickness, self.web_offset)
        rim = root_radius - self.rim_thickness
        if self.hub_radius is None:
            return GearBody(rim, bore_radius, web, web)
        width = face_width if self.hub_width is None else self.hub_width
        return GearBody(rim, self.hub_radius, web, part(width, self.hub_offset))
