"""``rack`` and ``cutter`` of ``[gear.NAME]``: the tool that makes the teeth."""

from __future__ import annotations

import math
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Number, Part, PositiveLength, refuse, spelt_also
from fegear.geometry.internal_tooth import PinionCutter
from fegear.geometry.rack import BasicRack

#: Names of the profiles of ISO 53, as `BasicRack.named` reads them.
_ISO_53 = r"^\s*([Ii][Ss][Oo])?\s*(53)?[ ._-]*[A-Da-d][ ._-]*$"


class RackPart(Part):
    """``rack = { addendum, dedendum, tip_radius, protuberance, ... }`` in modules, or the name of an ISO 53 profile."""

    model_config = spelt_also(
        lambda _table: {"type": "string", "pattern": "^(ISO ?)?(53 ?)?[A-Da-d]$", "examples": ["ISO 53 A"]}
    )

    profile: str | None = Field(
        default=None,
        description="Profile of ISO 53, A to D, from which the keys that are not given are taken; without it C.",
    )
    addendum: Number | None = Field(
        default=None,
        description="Addendum in modules: how far the tooth stands above the pitch circle; without it that of the "
        "profile, 1.0.",
    )
    dedendum: Number | None = Field(
        default=None,
        description="Dedendum in modules: how deep the rack cuts below the pitch circle; without it that of the "
        "profile, 1.25 for C.",
    )
    tip_radius: Number | Literal["full"] | None = Field(
        default=None,
        description="Tip radius of the rack in modules, which makes the fillet, or `full` for a full fillet; without "
        "it that of the profile, 0.25 for C.",
    )
    protuberance: Number = Field(
        default=0.0,
        description="Protuberance pr in modules: with `grinding_allowance` q the root is cut deeper than the "
        "finished flank by pr - q.",
    )
    grinding_allowance: Number = Field(
        default=0.0, description="Grinding allowance q in modules: what grinding still takes off the flank."
    )
    protuberance_angle: Angle = Field(default=math.radians(10.0), description="Angle of the protuberance flank.")

    @model_validator(mode="before")
    @classmethod
    def _name_alone(cls, value: Any) -> Any:
        return {"profile": value} if isinstance(value, str) else value

    def build(self, pressure_angle: float) -> BasicRack:
        """Make the rack; what is not given comes from the named profile, else from ISO 53 C."""
        base = BasicRack.named(self.profile or "C", pressure_angle)
        addendum = base.addendum if self.addendum is None else self.addendum
        dedendum = base.dedendum if self.dedendum is None else self.dedendum
        more = (self.protuberance, self.grinding_allowance, self.protuberance_angle)
        if self.tip_radius == "full":
            return BasicRack.full_fillet(addendum, dedendum, pressure_angle, *more)
        tip_radius = base.tip_radius if self.tip_radius is None else float(self.tip_radius)
        return BasicRack(addendum, dedendum, tip_radius, pressure_angle, *more)


class CutterPart(Part):
    """``cutter = { teeth, profile_shift, addendum, tip_radius }``, lengths in modules."""

    teeth: int | None = Field(
        default=None,
        description="Number of teeth of the cutter, at least three fewer than the gear has. Default: the largest that "
        "trims no tip of the gear, for a ring whose tool is not known.",
    )
    profile_shift: Number = Field(
        default=0.0, description="Profile shift coefficient x_0 of the cutter in its present state of sharpening."
    )
    addendum: Number | None = Field(
        default=None,
        description="Addendum h_a0 of the cutter in modules, above its reference circle shifted by x_0; without it "
        "1.25. Give this or `root_diameter`.",
    )
    root_diameter: PositiveLength | None = Field(
        default=None, description="Root diameter of the gear that the cutter makes; give this or `addendum`."
    )
    tip_radius: Number = Field(
        default=0.2, description="Radius of the rounding of the cutter's tip in modules, which makes the fillet."
    )

    @model_validator(mode="after")
    def _one_height(self) -> Self:
        if self.addendum is not None and self.root_diameter is not None:
            raise refuse("contradicts addendum", "give either addendum or root_diameter", key="root_diameter")
        return self

    def build(self, module: float, teeth: int) -> PinionCutter:
        """Make the cutter of a gear of this module [m] with so many teeth."""
        addendum = 1.25 if self.addendum is None else self.addendum
        root = math.nan if self.root_diameter is None else 0.5 * self.root_diameter / module
        return PinionCutter(teeth, self.profile_shift, addendum, root, self.tip_radius)
