"""``double_helical`` of a pair: two halves of opposite hand, the gap between them, and axial bearings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.part import Force, Part, PositiveLength, refuse
from fegear.geometry.placed_halves import PlacedHalves

if TYPE_CHECKING:
    from fegear.geometry.pair import GearPair

    class _PlacedKeys(Part, PlacedHalves):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _PlacedKeys = keys_of(PlacedHalves)

End = Literal["I", "II"]


class DoubleHelicalPart(_PlacedKeys):  # type: ignore[misc]  # frozen by pydantic
    """``double_helical = { gap, apex_offset, floating, axial_play, ... }`` of a pair.

    The pair's gears are the half at end I, with its face width; that at end II is its mirror image. Torque, load and
    power of the pair are those of both halves.
    """

    floating: Literal["driver", "driven", "none"] | None = Field(
        default=None,
        description="Member without axial bearing; `none`: both located. Default: the gear with fewer teeth.",
    )
    axial_play: PositiveLength | None = Field(
        default=None,
        description="Total axial play of the floating member, half to each side of the mounted position. "
        "Default: unlimited.",
    )
    axial_force: Force = Field(
        default=0.0,
        description="External axial force on the floating member towards end II, for example from its coupling.",
    )
    torque_in: End | None = Field(
        default=None,
        description="End at which the driver is driven, for the torsion of its shaft between the halves. Default: no "
        "torsion.",
    )
    torque_out: End | None = Field(
        default=None, description="End at which the driven gear delivers its torque. Default: no torsion."
    )
    second_driver: str | None = Field(
        default=None,
        description="Gear of the driver at end II, for different flank modifications. Default: mirror image of "
        "`driver`.",
    )
    second_driven: str | None = Field(
        default=None,
        description="Gear of the driven member at end II, for different flank modifications. Default: mirror image "
        "of `driven`.",
    )

    @model_validator(mode="after")
    def _held_only(self) -> Self:
        if self.floating == "none":
            for key in ("axial_play", "axial_force"):
                if key in self.given:
                    raise refuse("requires a floating member", 'set floating = "driver" or "driven"', key=key)
        return self

    @property
    def others(self) -> dict[str, str | None]:
        """Gears at end II by the role of those at end I, None for mirror images."""
        return {"driver": self.second_driver, "driven": self.second_driven}

    def floats(self, pair: GearPair) -> Literal["driver", "driven"] | None:
        """The floating member; the pinion where the case does not say."""
        if self.floating is None:
            return "driver" if pair.driver.teeth <= pair.driven.teeth else "driven"
        return None if self.floating == "none" else self.floating

    @property
    def even(self) -> bool:
        """Whether the halves share the load evenly whatever it is: a member that floats freely."""
        return self.floating != "none" and self.axial_play is None and self.axial_force == 0.0
