"""``[load_distribution]``, and ``line_error`` of a pair: what keeps flanks apart over the face."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Length, LengthOrZero, Part, PositiveLength, refuse


class LoadDistributionPart(Part):
    """Roll positions over a base pitch, and panels over the face; without ``panels`` one to a quarter of a module.

    ``base_pitch`` says which teeth meet, where they have spacing errors: pair 0 is on the teeth of that number.
    """

    positions: Annotated[int, Field(ge=2, le=256)] = Field(
        default=16, description="Roll positions over one base pitch."
    )
    panels: Annotated[int, Field(ge=2, le=200)] | None = Field(
        default=None,
        description="Parts into which the common face is divided; without it one to a quarter of a module.",
    )
    coat: PositiveLength = Field(default=6e-6, description="Thickness of the marking compound in the contact pattern.")
    base_pitch: Annotated[int, Field(ge=0, le=1_000_000)] = Field(
        default=0,
        description="Which teeth meet where they have spacing errors: pair 0 is on the teeth of that number, counted "
        "round and round.",
    )


class LineErrorPart(Part):
    """``line_error = { over_face, crowning, file }``: gap along the line of action over the face, removal positive.

    ``over_face`` opens from the end at -b/2 to the end at +b/2 along the driver's axis; ``crowning`` from the middle
    to both ends as a parabola; ``file`` has the columns ``z`` and ``gap``. They add up.
    """

    over_face: Length = Field(
        default=0.0, description="Gap that opens from the face end at -b/2 to that at +b/2 along the driver's axis."
    )
    crowning: LengthOrZero = Field(
        default=0.0, description="Gap that opens from the middle of the face to both ends, as a parabola."
    )
    file: str | None = Field(default=None, description="CSV file with `z` and `gap`, such as that of deflected shafts.")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write line_error = { over_face = "10 um" }')
        return self
