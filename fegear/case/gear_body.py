"""``body`` and ``rim_support`` of ``[gear.NAME]``: rim, web and hub of a gear, and what carries the rim of a ring."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Length, Part, PositiveLength, Table, refuse
from fegear.geometry.gear_body import STEEPEST, GearBody, WebHoles
from fegear.geometry.rim_support import RimSupport


class WebHolesPart(Part):
    """``body.holes = { count, circle_diameter, diameter, angle, tooth }``: round holes in a web, evenly spaced."""

    count: int = Field(description="Number of holes, any: it need not divide the number of teeth.")
    circle_diameter: PositiveLength = Field(description="Diameter of the circle of the holes' middles.")
    diameter: PositiveLength = Field(description="Diameter of each hole.")
    angle: Angle = Field(
        default=0.0,
        description="Of the first hole's middle from the centre line of tooth 0 in the middle of the face, positive "
        "the way that its loaded flank faces; without it a hole lies below the middle of tooth 0.",
    )

    tooth: int | None = Field(
        default=None,
        description="Tooth, counted clockwise from tooth 0, that tables, pairs and sets take for all teeth; without it "
        "they take the mean over all.",
    )

    def build(self) -> WebHoles:
        """Make the holes [m]."""
        return WebHoles(self.count, 0.5 * self.circle_diameter, 0.5 * self.diameter, self.angle, self.tooth)


class GearBodyPart(Part):
    """``body = { rim_thickness, web_thickness, web_offset, web_inclination, hub_radius, hub_width, hub_offset }``.

    And ``holes``.
    """

    rim_thickness: PositiveLength = Field(
        description="Rim s_R below the root circle, as wide as the face; for the ratings too (Y_B, C_R, K_B)."
    )
    web_thickness: PositiveLength = Field(
        description="Thickness b_s of the web between rim and hub, along the axis; for C_R of the ratings too."
    )
    web_offset: Length = Field(
        default=0.0,
        description="How far the middle of the web lies from the middle of the face, toward end II. An idler "
        "has end II at opposite ends in the mesh that drives it and in the one that it drives: both are refused.",
    )
    web_inclination: Angle = Field(
        default=0.0,
        description="Of the web, at most 30 deg either way: a positive one meets the hub nearer to end II than the "
        "rim. web_thickness is along the axis, and web_offset that of its end at the rim.",
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

    holes: Table[WebHolesPart] | None = Field(
        default=None,
        description="Round holes through the web, evenly spaced. Teeth differ then: how far is reported, and tables, "
        "pairs and sets take the mean over all teeth, or one of them.",
    )

    @model_validator(mode="after")
    def _hub(self) -> Self:
        if not abs(self.web_inclination) <= STEEPEST * (1.0 + 1e-9):
            most = f"{math.degrees(STEEPEST):.6g} deg"
            raise refuse(
                f"must lie between -{most} and {most}, for which inclined webs were compared with other programs",
                key="web_inclination", value=f"{math.degrees(self.web_inclination):.6g} deg",
            )  # fmt: skip
        if self.hub_radius is None:
            for key in ("hub_width", "hub_offset"):
                if key in self.given:
                    raise refuse("has a meaning only with hub_radius", 'write hub_radius = "25 mm"', key=key)
        return self

    def build(self, root_radius: float, bore_radius: float, face_width: float) -> GearBody:
        """Make the body of a gear [m]."""

        def part(width: float, offset: float) -> tuple[float, float]:
            return offset - 0.5 * width, offset + 0.5 * width

        web = part(self.web_thickness, self.web_offset)
        rim, lean = root_radius - self.rim_thickness, math.tan(self.web_inclination)
        holes = None if self.holes is None else self.holes.build()
        if self.hub_radius is None:
            down = GearBody(rim, bore_radius, web, web, lean, holes)
            return replace(down, hub=down.foot)
        width = face_width if self.hub_width is None else self.hub_width
        return GearBody(rim, self.hub_radius, web, part(width, self.hub_offset), lean, holes)


class RimSupportPart(Part):
    """``rim_support = { kind, pins, width, angle }`` of a ring gear."""

    kind: Literal["held", "splined", "pins"] = Field(
        description="`held`: the whole outer circle; `splined`: tractions spread evenly over it take force and torque; "
        "`pins`: evenly spaced parts of it are held on average, of a gear with its width at every height of the face, "
        "and along the axis."
    )
    pins: int | None = Field(default=None, description="Number of pins, bolts or lugs, 2 to the number of teeth.")
    width: PositiveLength | None = Field(
        default=None, description="Width of each, along the outer circle: over it the rim moves neither way on average."
    )
    angle: Angle = Field(
        default=0.0,
        description="Of the first pin from the centre line of tooth 0 in the middle of the face, positive the way that "
        "its loaded flank faces.",
    )

    @model_validator(mode="after")
    def _pins(self) -> Self:
        for key in ("pins", "width"):
            if self.kind == "pins" and getattr(self, key) is None:
                raise refuse("is missing for a rim on pins", 'write pins = 6, width = "12 mm"', key=key)
        for key in ("pins", "width", "angle"):
            if self.kind != "pins" and key in self.given:
                raise refuse("has a meaning only for a rim on pins", 'write kind = "pins"', key=key)
        if self.pins is not None and self.pins < 2:
            raise refuse(
                "must be at least 2, for the ring would turn about one", "give the number of pins", key="pins",
                value=self.pins,
            )  # fmt: skip
        return self

    def build(self) -> RimSupport | None:
        """Make the support; None of a held rim."""
        return None if self.kind == "held" else RimSupport(self.pins or 0, self.width or 0.0, self.angle)
