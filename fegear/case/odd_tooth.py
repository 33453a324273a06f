"""``[[gear.NAME.odd_tooth]]``: one tooth of a gear that differs: cracked, missing, broken, shorter, pitted, ground.

Or above a hole in the gear body, or a keyway.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Length, LengthOrZero, Part, PositiveLength, PositiveNumber, Table, refuse, several
from fegear.case.relief import ReliefPart, ReliefTablePart

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
        description="Crack depth over the tooth thickness along the crack: length of the crack over the distance in "
        "its direction to the opposite fillet.",
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
    crack_faces: Literal["open", "closing"] = Field(
        default="open",
        description="Contact of the crack faces: open (none, exact where the load opens the crack) or closing "
        "(frictionless contact, needed where the load presses the crack together). Default: open.",
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


class PitPart(Part):
    """``pits = [{ radius | diameter = [from, to], face_share, depth }]``."""

    radius: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="Radii [from, to] of the damage; specify `radius` or `diameter`."
    )
    diameter: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="Diameters [from, to] of the damage."
    )
    face_share: Annotated[PositiveNumber, Field(le=1.0)] = Field(
        default=1.0,
        description="Share of the face width over which the flank is damaged. Below 1 the remaining face carries the "
        "load of the contact (Hertz). Default: 1.",
    )
    face_position: Length = Field(
        default=0.0,
        description="Face position of the middle of the damage, from mid-face (3D pairs). Default: 0 mm.",
    )
    depth: LengthOrZero | None = Field(
        default=None,
        description="Depth normal to the flank, a gap; required with face_share = 1. Below 1 without effect in plane "
        "(2D) pairs; in 3D pairs a damage without a depth carries no load.",
    )

    @property
    def radii(self) -> tuple[float, float]:
        """From and to [m]."""
        low, high = self.radius or [0.5 * diameter for diameter in self.diameter or (0.0, 0.0)]
        return low, high

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        if self.radius is not None and self.diameter is not None:
            raise refuse("contradicts radius", "specify either radius or diameter", key="diameter")
        if self.radius is None and self.diameter is None:
            raise refuse("is required, or radius", 'set diameter = ["50 mm", "51 mm"]', key="diameter")
        low, high = self.radii
        if not low < high:
            key = "radius" if self.radius is not None else "diameter"
            raise refuse("must rise from the first to the second", "exchange them", key=key)
        if self.face_share >= 1.0 and self.depth is None:
            raise refuse("is required with face_share = 1", 'set depth = "0.1 mm"', key="depth")
        return self


class HolePart(Part):
    """``hole = { diameter, position_radius, angle }``."""

    diameter: PositiveLength = Field(description="Diameter of the hole.")
    position_radius: PositiveLength = Field(description="Radius from the gear axis to the centre of the hole.")
    angle: Angle = Field(
        default=0.0,
        description="Angle about the gear axis from the tooth centre line to the centre of the hole, positive towards "
        "the loaded flank. Default: 0 deg.",
    )


class KeywayPart(Part):
    """``keyway = { width, depth, angle }``."""

    width: PositiveLength | None = Field(
        default=None, description="Width of the keyway. Default: DIN 6885-1 for the bore."
    )
    depth: PositiveLength | None = Field(
        default=None,
        description="Depth from the bore to the floor of the keyway, at its middle. Default: t_2 of DIN 6885-1 for the "
        "bore.",
    )
    angle: Angle = Field(
        default=0.0,
        description="Angle about the gear axis from the tooth centre line to the middle of the keyway, positive "
        "towards the loaded flank, at most half a pitch. Default: 0 deg.",
    )


#: What a tooth may be other than cracked, and which of them exclude each other.
OUTLINES = ("missing", "broken_at", "tip_diameter")


class OddToothPart(Part):
    """A tooth that differs from the others."""

    tooth: Annotated[int, Field(ge=0)] = Field(
        default=0,
        description="Number of the tooth in meshing order, 0 for the first value of `spacing_errors`. Default: 0.",
    )
    crack: Table[CrackPart] | None = Field(
        default=None, description="Crack from a root fillet, through the full face width."
    )
    missing: bool = Field(default=False, description="Omit the tooth down to the root circle. Default: false.")
    broken_at: PositiveLength | None = Field(
        default=None,
        description="Diameter at which the tooth is broken off; below the root form circle it is a missing tooth.",
    )
    tip_diameter: PositiveLength | None = Field(
        default=None, description="Tip diameter of this tooth, at most that of the gear."
    )
    hole: Table[HolePart] | None = Field(
        default=None,
        description="Round hole through the gear body over the full face width, within the sector of this tooth (one "
        "pitch).",
    )
    keyway: Table[KeywayPart] | None = Field(
        default=None,
        description="Keyway in the bore below this tooth, over the full face width; {} for one of DIN 6885-1. Its "
        "walls are free, the bore beside it is fixed.",
    )
    pits: Annotated[list[Table[PitPart]], several(PitPart)] = Field(
        default_factory=list, description="Pits or spalls of the loaded flank, a table for each."
    )
    relief: Table[ReliefPart] | None = Field(
        default=None,
        description="Profile modification of the loaded flank of this tooth in place of that of the gear; active with "
        "the effect `relief`.",
    )
    deviation: Annotated[list[Table[ReliefTablePart]], several(ReliefTablePart)] = Field(
        default_factory=list,
        description="Profile deviation of the loaded flank of this tooth, for example measured, in addition to the "
        "modification; active with the effect `relief`.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        outlines = [key for key in OUTLINES if getattr(self, key)]
        if not self.reshaped and not self.pits and not self.profiled:
            raise refuse(
                "is required, or missing, broken_at, tip_diameter, hole, keyway, pits, relief or deviation",
                'set crack = { depth = "0.5 mm" }', key="crack",
            )  # fmt: skip
        if len(outlines) > 1:
            raise refuse(f"contradicts {outlines[0]}", f"specify one of {', '.join(OUTLINES)}", key=outlines[1])
        if self.crack is not None and outlines:
            key, value = outlines[0], "true" if self.missing else None
            raise refuse("is not available for a cracked tooth", "remove it, or remove crack", key=key, value=value)
        if self.hole is not None and (self.crack is not None or outlines):
            other = outlines[0] if outlines else "crack"
            raise refuse(
                f"is not available together with {other}", f"remove it, or remove {other}", key="hole", value="(given)"
            )
        others = [*outlines, *(key for key in ("crack", "hole") if getattr(self, key) is not None)]
        if self.keyway is not None and others:
            raise refuse(
                f"is not available together with {others[0]}", f"remove it, or remove {others[0]}", key="keyway",
                value="(given)",
            )  # fmt: skip
        for key in ("pits", "relief", "deviation"):
            if self.missing and getattr(self, key):
                raise refuse("contradicts missing", "remove it: there is no flank", key=key)
        return self

    @property
    def profiled(self) -> bool:
        """Whether its profile is another one."""
        return self.relief is not None or bool(self.deviation)

    @property
    def reshaped(self) -> bool:
        """Whether its body differs, not only its flank."""
        body = self.crack, self.hole, self.keyway
        return any(one is not None for one in body) or any(getattr(self, key) for key in OUTLINES)
