"""``gear.NAME.lead``, ``bias`` and ``topography``: what is ground off the flanks over the face."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Length, Part, PositiveLength, refuse, spelt_also
from fegear.case.relief import Shape, several


class LeadEndReliefPart(Part):
    """``end_relief = { amount, length, end, shape }``: of end I (-b/2), end II (+b/2), or both."""

    amount: Length
    length: PositiveLength
    end: Literal["I", "II", "both"] = "both"
    shape: Shape = "linear"


class LeadPart(Part):
    """``lead = { crowning, slope, end_relief, file }``: over the gear's own face, the same at every height.

    ``crowning`` is removed at both ends, ``slope`` at end II; ``file`` has the columns ``z`` and ``removal``.
    """

    crowning: Length = 0.0
    slope: Length = 0.0
    end_relief: Annotated[list[LeadEndReliefPart], several(LeadEndReliefPart)] = Field(default_factory=list)
    file: str | None = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write lead = { crowning = "5 um" }', value="{}")
        return self


class BiasPart(Part):
    """``bias = "10 um"``, or ``{ amount, start_radius, end_radius }``; over the active profile unless given."""

    model_config = spelt_also(lambda table: table["properties"]["amount"])

    amount: Length
    start_radius: PositiveLength | None = None
    end_radius: PositiveLength | None = None

    @model_validator(mode="before")
    @classmethod
    def _amount_alone(cls, value: Any) -> Any:
        return value if isinstance(value, (dict, BiasPart)) else {"amount": value}


class TopographyPart(Part):
    """``topography = { file }``: columns ``roll_angle`` or ``radius``, ``z`` and ``removal`` on a full grid."""

    file: str
