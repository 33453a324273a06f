"""``[load_distribution]``, and ``line_error`` of a pair: what keeps flanks apart over the face."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Length, LengthOrZero, Part, PositiveLength, refuse


class LoadDistributionPart(Part):
    """Roll positions over a base pitch, and panels over the face; without ``panels`` one to a quarter of a module.

    ``base_pitch`` says which teeth meet, where they have spacing errors: pair 0 is on the teeth of that number.
    """

    positions: Annotated[int, Field(ge=2, le=256)] = 16
    panels: Annotated[int, Field(ge=2, le=200)] | None = None
    coat: PositiveLength = 6e-6
    base_pitch: Annotated[int, Field(ge=0, le=1_000_000)] = 0


class LineErrorPart(Part):
    """``line_error = { over_face, crowning, file }``: gap along the line of action over the face, removal positive.

    ``over_face`` opens from the end at -b/2 to the end at +b/2 along the driver's axis; ``crowning`` from the middle
    to both ends as a parabola; ``file`` has the columns ``z`` and ``gap``. They add up.
    """

    over_face: Length = 0.0
    crowning: LengthOrZero = 0.0
    file: str | None = None

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write line_error = { over_face = "10 um" }')
        return self
