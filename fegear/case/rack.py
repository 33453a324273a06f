"""``[rack.NAME]``: a rack, how it is held, and the pinion that rolls on it.

It has a table of its own, for it is no gear: it has no bore, no circles and two ends. What it does not say of its teeth
it has from the pinion.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.gear_material import MaterialPart
from fegear.case.gear_tool import RackPart
from fegear.case.part import (
    Length,
    LengthOrZero,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveTorque,
    Table,
    refuse,
)
from fegear.geometry.rack_relief import RackReliefSpec
from fegear.geometry.toothed_rack import Rack, RackPins

#: Keys of pins.
_OF_PINS = ("pin_every", "first_pin", "pin_width")


class _PinionPart(Part):
    pinion: str = Field(
        description="Pinion: an external gear of this case. The rack has its module and helix angle, and the opposite "
        "hand."
    )


if TYPE_CHECKING:

    class _RackKeys(_PinionPart):
        teeth: int
        reference_height: float

else:
    _RackKeys = keys_of(Rack, base=_PinionPart)


if TYPE_CHECKING:

    class RackTipReliefPart(Part, RackReliefSpec):  # type: ignore[misc]  # frozen by pydantic
        """``tip_relief = { amount, height | length, shape }``."""

else:

    class RackTipReliefPart(keys_of(RackReliefSpec)):
        """``tip_relief = { amount, height | length, shape }``."""


class RackAndPinionPart(_RackKeys):
    """A rack and the pinion on it."""

    face_width: PositiveLength | None = Field(default=None, description="Face width. Default: that of the pinion.")
    width: Literal["plane", "solid"] | None = Field(
        default=None,
        description="Tooth model: `plane` (2D) or `solid` (3D). Default: plane for spur, solid for helical racks.",
    )
    basic_rack: Table[RackPart] | None = Field(
        default=None,
        description="Profile of the rack teeth: addendum, dedendum and root radius, by name or in modules. Default: "
        "that of the pinion.",
    )
    thickness_allowance: LengthOrZero = Field(
        default=0.0, description="Reduction of the tooth thickness on the reference line."
    )
    tip_radius_rounding: LengthOrZero = Field(default=0.0, description="Tip rounding radius; 0: sharp tip edge.")
    tip_chamfer: LengthOrZero = Field(default=0.0, description="Height of the tip chamfer; 0: none.")
    tip_relief: Table[RackTipReliefPart] | None = Field(
        default=None,
        description="Tip relief of all teeth of the rack; active with the effect `relief`, as the `relief` of the "
        "pinion is.",
    )
    material: Table[MaterialPart] | None = Field(default=None, description="Material. Default: that of the pinion.")
    support: Literal["back", "pins"] = Field(
        default="back", description="Fixed over all of its `back`, or on `pins` (bolts, dowels) at its back."
    )
    pin_every: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        default=None, description="Number of teeth from one pin to the next. Default: 10."
    )
    first_pin: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        default=None, description="Number of the tooth above the first pin, from 1. Default: half of `pin_every`."
    )
    pin_width: PositiveLength | None = Field(
        default=None, description="Length of the back that each pin fixes, below one tooth. Default: 2 modules."
    )
    distance: PositiveLength | None = Field(
        default=None,
        description="Distance from the axis of the pinion to the reference line of the rack. Default: from `backlash`.",
    )
    mounting_distance: PositiveLength | None = Field(
        default=None,
        description="Distance from the axis of the pinion to the back of the rack, as catalogues print it: `distance` "
        "plus `reference_height`; alternatively `distance` or `backlash`.",
    )
    backlash: Length | None = Field(
        default=None,
        description="Backlash as travel of the rack, pinion fixed; alternatively `distance` or `mounting_distance`. "
        "Default: 0 (for no distance specified).",
    )
    force: PositiveForce | None = Field(
        default=None, description="Force along the rack; alternatively `torque`. Required for results under load."
    )
    torque: PositiveTorque | None = Field(
        default=None, description="Torque on the pinion, force x reference radius; alternatively `force`."
    )
    positions: Annotated[int, Field(ge=8, le=400)] | None = Field(
        default=None, description="Number of positions per base pitch over the stroke. Default: 32; 24 for 3D racks."
    )

    @model_validator(mode="after")
    def _once(self) -> Self:
        for one, other in (
            ("distance", "backlash"), ("mounting_distance", "distance"), ("mounting_distance", "backlash"),
            ("force", "torque"),
        ):  # fmt: skip
            if getattr(self, one) is not None and getattr(self, other) is not None:
                raise refuse(f"contradicts {one}", f"specify either {one} or {other}", key=other, value="(given)")
        if self.support == "back":
            given = next((key for key in _OF_PINS if getattr(self, key) is not None), None)
            if given is not None:
                raise refuse("is used with pins only", f'set support = "pins", or remove {given}', key=given,
                             value="(given)")  # fmt: skip
        return self

    def pins(self, module: float) -> RackPins | None:
        """The pins of a rack of this module [m]; None where its back is fixed."""
        if self.support == "back":
            return None
        every = 10 if self.pin_every is None else self.pin_every
        first = min(max(every // 2, 1), self.teeth) if self.first_pin is None else self.first_pin
        return RackPins(every, first - 1, 2.0 * module if self.pin_width is None else self.pin_width)
