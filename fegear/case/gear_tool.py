"""``rack`` and ``cutter`` of ``[gear.NAME]``: the tool that makes the teeth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.part import Number, Part, PositiveLength, refuse, spelt_also
from fegear.geometry.internal_tooth import PinionCutter
from fegear.geometry.named_racks import named_rack
from fegear.geometry.rack import BasicRack

#: How profiles may be written; `fegear.geometry.named_racks` reads them.
_WRITTEN = r"^((ISO ?)?(53 ?)?[A-Da-d]|DIN 867|JIS B 1701(-1)?|DIN 3972 (I|II)|[0-9.]+ ?/ ?[0-9.]+ ?/ ?[0-9.]+)$"


class _ProfilePart(Part):
    profile: str | None = Field(
        default=None,
        description="Profile for keys not specified: ISO 53 A to D, DIN 867, JIS B 1701, DIN 3972 I or II, or "
        "dedendum/tip radius/addendum as `1.25/0.38/1.0`. Default: C.",
    )


if TYPE_CHECKING:
    from fegear.geometry.asymmetric_rack import AsymmetricRack

    class _RackKeys(_ProfilePart):
        addendum: float | None = None
        dedendum: float | None = None
        protuberance: float = 0.0
        grinding_allowance: float = 0.0
        protuberance_angle: float = 0.0

else:
    _RackKeys = keys_of(
        BasicRack,
        base=_ProfilePart,
        otherwise={"addendum": "that of the profile, 1.0", "dedendum": "that of the profile, 1.25 for C"},
    )


class RackPart(_RackKeys):
    """``rack = { addendum, dedendum, tip_radius, protuberance, ... }`` in modules, or the name of a profile."""

    model_config = spelt_also(
        lambda _table: {"type": "string", "pattern": _WRITTEN, "examples": ["ISO 53 A", "DIN 867", "1.25/0.38/1.0"]}
    )

    tip_radius: Number | Literal["full"] | None = Field(
        default=None,
        description="Tip radius of the basic rack rho_fP* [modules], or `full` for a full fillet radius. Default: "
        "that of the profile, 0.25 for C.",
    )

    coast_tip_radius: Number | None = Field(
        default=None,
        description="Tip radius of the basic rack on the coast side of asymmetric teeth [modules]. Default: "
        "`tip_radius`.",
    )

    @model_validator(mode="before")
    @classmethod
    def _name_alone(cls, value: Any) -> Any:
        return {"profile": value} if isinstance(value, str) else value

    def build(self, pressure_angle: float, module: float = math.nan) -> BasicRack:
        """Make the rack of a module [m]; what is not given comes from the named profile, else from ISO 53 C."""
        base = self._named(pressure_angle, module)
        addendum = base.addendum if self.addendum is None else self.addendum
        dedendum = base.dedendum if self.dedendum is None else self.dedendum
        more = (self.protuberance, self.grinding_allowance, self.protuberance_angle)
        if self.tip_radius == "full":
            return BasicRack.full_fillet(addendum, dedendum, pressure_angle, *more)
        tip_radius = base.tip_radius if self.tip_radius is None else float(self.tip_radius)
        return BasicRack(addendum, dedendum, tip_radius, pressure_angle, *more)

    def _named(self, pressure_angle: float, module: float) -> BasicRack:
        """The named profile, for its numbers: at large pressure angles only the given ones need fit on a tool."""
        usual = min(pressure_angle, math.radians(20.0))
        return named_rack("C" if self.profile is None else self.profile, usual, module)

    def build_asymmetric(self, drive: float, coast: float, module: float = math.nan) -> AsymmetricRack:
        """Make the rack of two pressure angles [rad]; what is not given comes from the named profile, as in `build`."""
        from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank

        base = self._named(min(drive, coast), module)
        addendum = base.addendum if self.addendum is None else self.addendum
        dedendum = base.dedendum if self.dedendum is None else self.dedendum
        if self.tip_radius == "full":
            sharp = AsymmetricRack(RackFlank(drive, 0.0), RackFlank(coast, 0.0), addendum, dedendum)
            one = other = sharp.full_fillet_radius
        else:
            one = base.tip_radius if self.tip_radius is None else float(self.tip_radius)
            other = one if self.coast_tip_radius is None else self.coast_tip_radius
        return AsymmetricRack(RackFlank(drive, one), RackFlank(coast, other), addendum, dedendum)


class CutterPart(Part):
    """``cutter = { teeth, profile_shift, addendum, tip_radius }``, lengths in modules."""

    teeth: int | None = Field(
        default=None,
        description="Number of cutter teeth, at least three fewer than the gear. Default: the maximum that does not "
        "trim the gear tips.",
    )
    profile_shift: Number = Field(
        default=0.0, description="Profile shift coefficient x_0 of the cutter (current resharpening state)."
    )
    addendum: Number | None = Field(
        default=None,
        description="Cutter addendum h_a0* [modules], above the reference circle shifted by x_0; alternatively "
        "`root_diameter`. Default: 1.25.",
    )
    root_diameter: PositiveLength | None = Field(
        default=None, description="Root diameter of the gear generated by the cutter; alternatively `addendum`."
    )
    tip_radius: Number = Field(default=0.2, description="Tip radius of the cutter [modules].")
    coast_tip_radius: Number | None = Field(
        default=None,
        description="Tip radius of the cutter on the coast side of asymmetric teeth [modules]. Default: `tip_radius`.",
    )

    @model_validator(mode="after")
    def _one_height(self) -> Self:
        if self.addendum is not None and self.root_diameter is not None:
            raise refuse("contradicts addendum", "specify either addendum or root_diameter", key="root_diameter")
        return self

    def build(self, module: float, teeth: int) -> PinionCutter:
        """Make the cutter of a gear of this module [m] with so many teeth."""
        addendum = 1.25 if self.addendum is None else self.addendum
        root = math.nan if self.root_diameter is None else 0.5 * self.root_diameter / module
        return PinionCutter(teeth, self.profile_shift, addendum, root, self.tip_radius)
