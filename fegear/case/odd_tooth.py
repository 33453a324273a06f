"""``[[gear.NAME.odd_tooth]]``: one tooth of a gear that differs from the others: a crack from a root fillet."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Length, LengthOrZero, Part, PositiveLength, PositiveNumber, Table, refuse

#: Keys that say where a crack starts, and that say where it ends.
STARTS = ("tangent_angle", "arc", "radius", "diameter")
ENDS = ("depth", "depth_ratio", "path")


class CrackPart(Part):
    """``crack = { tangent_angle | arc | radius | diameter, depth | depth_ratio | path, angle, fillet }``."""

    fillet: Literal["tension", "compression"] = Field(
        default="tension",
        description="Fillet in which the crack starts: of the loaded flank (tension) or the opposite one "
        "(compression).",
    )
    tangent_angle: Angle | None = Field(
        default=None,
        description="Start of the crack by the angle between fillet tangent and tooth centre line. Default: 30 deg.",
    )
    arc: LengthOrZero | None = Field(
        default=None, description="Start by the arc length along the fillet, from the root land towards the tip."
    )
    radius: PositiveLength | None = Field(default=None, description="Start by the radius.")
    diameter: PositiveLength | None = Field(default=None, description="Start by the diameter.")
    depth: PositiveLength | None = Field(
        default=None, description="Length of the crack; specify exactly one of `depth`, `depth_ratio` and `path`."
    )
    depth_ratio: Annotated[PositiveNumber, Field(lt=1.0)] | None = Field(
        default=None,
        description="Length of the crack as a share of the way through the tooth in its direction, to the opposite "
        "fillet.",
    )
    path: Annotated[list[Annotated[list[Length], Field(min_length=2, max_length=2)]], Field(min_length=1)] | None = (
        Field(
            default=None,
            description="Crack of several straight pieces: [x, y] of each corner after the start, crack tip last. Gear "
            "centre at the origin, tooth centre line along +y, loaded flank at x > 0.",
        )
    )
    angle: Angle = Field(
        default=math.radians(70.0),
        description="Angle between crack and tooth centre line: 0 runs into the gear body, 90 deg across the tooth. "
        "Default: 70 deg.",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        starts = [key for key in STARTS if getattr(self, key) is not None]
        if len(starts) > 1:
            raise refuse(f"contradicts {starts[0]}", f"specify one of {', '.join(STARTS)}", key=starts[1])
        ends = [key for key in ENDS if getattr(self, key) is not None]
        if not ends:
            raise refuse("is required, or depth_ratio or path", 'set depth = "0.5 mm"', key="depth")
        if len(ends) > 1:
            raise refuse(f"contradicts {ends[0]}", f"specify one of {', '.join(ENDS)}", key=ends[1])
        if self.path is not None and "angle" in self.given:
            raise refuse("contradicts path", "remove it: the path has its own directions", key="angle")
        if not 0.0 <= self.angle <= math.radians(135.0):
            raise refuse(
                "must be between 0 and 135 deg", 'set angle = "70 deg"', key="angle",
                value=f"{math.degrees(self.angle):.6g} deg",
            )  # fmt: skip
        return self


class OddToothPart(Part):
    """A tooth that differs from the others."""

    tooth: Annotated[int, Field(ge=0)] = Field(
        default=0,
        description="Number of the tooth in meshing order, 0 for the first value of `spacing_errors`. Default: 0.",
    )
    crack: Table[CrackPart] = Field(description="Crack from a root fillet, through the full face width.")
