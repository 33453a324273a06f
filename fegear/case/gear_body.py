"""``body`` and ``rim_support`` of ``[gear.NAME]``: rim, web and hub of a gear, and what carries its rim."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Length, Part, PositiveLength, Table, refuse
from fegear.geometry.gear_body import STEEPEST, GearBody, WebHoles
from fegear.geometry.rim_support import RimSupport


class WebHolesPart(Part):
    """``body.holes = { count, circle_diameter, diameter, angle, tooth }``: round holes in a web, evenly spaced."""

    count: int = Field(description="Number of holes; need not divide the number of teeth.")
    circle_diameter: PositiveLength = Field(description="Pitch circle diameter of the holes.")
    diameter: PositiveLength = Field(description="Diameter of each hole.")
    angle: Angle = Field(
        default=0.0,
        description="Angle from the centre line of tooth 0 (mid-face) to the centre of the first hole, positive in "
        "the direction its loaded flank faces. Default: 0.",
    )

    tooth: int | None = Field(
        default=None,
        description="Tooth (clockwise from tooth 0) whose compliance and stress are used for all teeth. Default: "
        "mean of all teeth.",
    )

    def build(self) -> WebHoles:
        """Make the holes [m]."""
        return WebHoles(self.count, 0.5 * self.circle_diameter, 0.5 * self.diameter, self.angle, self.tooth)


class GearBodyPart(Part):
    """``body = { rim_thickness, web_thickness, web_offset, web_inclination, hub_radius, hub_width, hub_offset }``.

    And ``holes``.
    """

    rim_thickness: PositiveLength = Field(
        description="Rim thickness s_R below the root circle, over the full face width; also used in the ratings "
        "(Y_B, C_R, K_B)."
    )
    web_thickness: PositiveLength = Field(
        description="Axial web thickness b_s between rim and hub; also used in the rating (C_R)."
    )
    web_offset: Length = Field(
        default=0.0,
        description="Axial offset of web centre from mid-face, positive towards end II. Not available for idlers "
        "(end II differs between the two meshes).",
    )
    web_inclination: Angle = Field(
        default=0.0,
        description="Web inclination, -30 to 30 deg; positive: the web meets the hub nearer to end II than the rim. "
        "web_thickness is axial; web_offset refers to the rim end.",
    )
    hub_radius: PositiveLength | None = Field(
        default=None, description="Outer radius of the hub. Default: no hub, web fixed at the bore."
    )
    hub_width: PositiveLength | None = Field(
        default=None, description="Axial width of the hub, at most the face width. Default: face width."
    )
    hub_offset: Length = Field(
        default=0.0, description="Axial offset of the hub centre from mid-face, positive towards end II."
    )

    holes: Table[WebHolesPart] | None = Field(
        default=None,
        description="Round, equally spaced web holes. The variation of compliance over the teeth is reported; "
        "tables, pairs and planetary sets use the mean of all teeth or one tooth (`tooth`).",
    )

    @model_validator(mode="after")
    def _hub(self) -> Self:
        if not abs(self.web_inclination) <= STEEPEST * (1.0 + 1e-9):
            most = f"{math.degrees(STEEPEST):.6g} deg"
            raise refuse(
                f"must be between -{most} and {most} (verified range)",
                key="web_inclination", value=f"{math.degrees(self.web_inclination):.6g} deg",
            )  # fmt: skip
        if self.hub_radius is None:
            for key in ("hub_width", "hub_offset"):
                if key in self.given:
                    raise refuse("requires hub_radius", 'set hub_radius = "25 mm"', key=key)
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


#: Keys of `rim_support` by what they belong to: kinds, and what is said of them elsewhere.
_OF_KINDS = {
    ("pins", "width"): (("pins", "bearing"), "a rim on pins", 'set pins = 6, width = "12 mm"'),
    ("angle",): (("pins", "bearing"), "a rim on pins", ""),
    ("teeth",): (("free_arc",), "a bore that is free over an arc", "set teeth = 5"),
    ("web_thickness", "web_radius"): (("web",), "a rim on a web", 'set web_thickness = "6 mm", web_radius = "20 mm"'),
}


class RimSupportPart(Part):
    """``rim_support = { kind, pins, width, angle, teeth, web_thickness, web_radius }``."""

    kind: Literal["held", "splined", "pins", "bearing", "free_arc", "web"] = Field(
        description="`held`: circle fixed; `splined`: force and torque taken by uniform tractions; `pins`: equally "
        "spaced arcs fixed on average (3D: also axially). External: `bearing` (radial pins), `free_arc`, `web`."
    )
    pins: int | None = Field(
        default=None, description="Number of pins, bolts, lugs or rollers, 2 (rollers: 3) to the number of teeth."
    )
    width: PositiveLength | None = Field(
        default=None,
        description="Width of each pin along the outer circle or bore (mean displacement zero over it).",
    )
    angle: Angle = Field(
        default=0.0,
        description="Angle from the centre line of tooth 0 (mid-face) to the first pin, positive in the direction "
        "its loaded flank faces.",
    )
    teeth: int | None = Field(
        default=None,
        description="Number of teeth above the free arc of the bore (odd, loaded tooth in the middle); the bore is "
        "fixed below all other teeth.",
    )
    web_thickness: PositiveLength | None = Field(
        default=None, description="Thickness of the web inside `bore_radius`, at most the face width."
    )
    web_radius: PositiveLength | None = Field(
        default=None, description="Radius at which the web is fixed (outer radius of the hub)."
    )

    @model_validator(mode="after")
    def _pins(self) -> Self:
        for keys, (kinds, rim, remedy) in _OF_KINDS.items():
            for key in keys:
                if remedy and self.kind in kinds and getattr(self, key) is None:
                    raise refuse(f"is required for {rim}", remedy, key=key)
                if self.kind not in kinds and key in self.given:
                    raise refuse(f"applies only to {rim}", f'set kind = "{kinds[0]}"', key=key)
        if self.pins is not None and self.pins < 2:
            raise refuse(
                "must be at least 2 (a ring on one pin could rotate about it)", "specify the number of pins",
                key="pins", value=self.pins,
            )  # fmt: skip
        return self

    def check_external(self, gear: Any) -> None:
        """Refuse the rim of an external gear that is carried in two ways, or without its inside."""
        if self.kind == "held":
            return
        if gear.body is not None:
            raise refuse("contradicts body", "specify either body (3D) or rim_support (2D)", key="rim_support")
        if gear.tooth_mesh is not None:
            raise refuse("requires the generated mesh", "remove tooth_mesh", key="rim_support")
        for key in ("bore_radius", "face_width") if self.kind == "web" else ("bore_radius",):
            if (gear.bore if key == "bore_radius" else gear.face_width) is None:
                raise refuse("is required for a gear with rim_support", f'set {key} = "20 mm"', key=key)

    def build(self, face_width: float) -> RimSupport | None:
        """Make the support of a gear of some face width [m]; None of a held rim."""
        if self.kind == "held":
            return None
        if self.kind == "free_arc":
            return RimSupport(free_teeth=0 if self.teeth is None else self.teeth or -1)
        if self.kind == "web":
            return RimSupport(web=(self.web_thickness or 0.0) / face_width, inner_radius=self.web_radius or 0.0)
        return RimSupport(self.pins or 0, self.width or 0.0, self.angle, self.kind == "bearing")
