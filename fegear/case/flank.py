"""``gear.NAME.lead``, ``bias`` and ``topography``: what is ground off the flanks over the face."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Length, Part, PositiveLength, refuse, spelt_also
from fegear.case.relief import Shape, several


class LeadEndReliefPart(Part):
    """``end_relief = { amount, length, end, shape }``: of end I (-b/2), end II (+b/2), or both."""

    amount: Length = Field(description="Material removed at the end of the face.")
    length: PositiveLength = Field(description="Length of the relief along the face.")
    end: Literal["I", "II", "both"] = Field(
        default="both", description="Which end is relieved: I at -b/2, II at +b/2, or both."
    )
    shape: Shape = Field(
        default="linear", description="How the removal grows toward the end: straight, or as a parabola."
    )


class LeadPart(Part):
    """``lead = { crowning, slope, end_relief, file }``: over the gear's own face, the same at every height.

    ``crowning`` is removed at both ends, ``slope`` at end II; ``file`` has the columns ``z`` and ``removal``.
    """

    crowning: Length = Field(default=0.0, description="C_beta: a parabola over the face, removed at both ends.")
    slope: Length = Field(
        default=0.0, description="C_Hbeta, helix correction: nothing at end I, all of it removed at end II."
    )
    end_relief: Annotated[list[LeadEndReliefPart], several(LeadEndReliefPart)] = Field(
        default_factory=list, description="Relief at the ends of the face: a table, or a list of several that add up."
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `z [mm]` from the middle of the face and `removal [um]`, straight between its "
        "entries, held beyond them.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write lead = { crowning = "5 um" }', value="{}")
        return self


class BiasPart(Part):
    """``bias = "10 um"``, or ``{ amount, start_radius, end_radius }``; over the active profile unless given."""

    model_config = spelt_also(lambda table: table["properties"]["amount"])

    amount: Length = Field(
        description="Twist S_alpha; positive takes material from the tip at end II and from the root at end I, a "
        "quarter at each corner."
    )
    start_radius: PositiveLength | None = Field(
        default=None, description="Lower end of the twisted profile; without it that of the active profile."
    )
    end_radius: PositiveLength | None = Field(
        default=None, description="Upper end of the twisted profile; without it that of the active profile."
    )

    @model_validator(mode="before")
    @classmethod
    def _amount_alone(cls, value: Any) -> Any:
        return value if isinstance(value, (dict, BiasPart)) else {"amount": value}


class TopographyPart(Part):
    """``topography = { file }``: columns ``roll_angle`` or ``radius``, ``z`` and ``removal`` on a full grid."""

    file: str = Field(
        description="CSV file with `roll_angle [deg]` or `radius [mm]`, `z [mm]` and `removal [um]`, every roll "
        "angle at every height once; bilinear between them, held beyond them."
    )
