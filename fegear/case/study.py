"""``[study]``: gears and load positions over which root-stress formulas are held against finite elements."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Number, Part, refuse_more

Teeth = Annotated[list[Annotated[int, Field(ge=5, le=1000)]], Field(min_length=1)]
Numbers = Annotated[list[Number], Field(min_length=1)]
Shares = Annotated[list[Annotated[Number, Field(ge=0.0, le=1.0)]], Field(min_length=1)]


class StudyPart(Part):
    """Every combination of the lists is computed; a list that is not given keeps the gear's own value."""

    gear: str | None = Field(default=None, description="The gear whose tooth is varied; without it the only gear.")
    teeth: Teeth | None = Field(default=None, description="Numbers of teeth; without it the gear's own.")
    profile_shift: Numbers | None = Field(
        default=None, description="Profile shift coefficients; without it the gear's own."
    )
    rack_tip_radius: Numbers | None = Field(
        default=None, description="Tip radii of the generating rack in modules; without it the gear's own."
    )
    load_position: Shares = Field(
        default_factory=lambda: [0.1, 0.4, 0.7, 1.0],
        description="Where the load acts, as shares of the roll angle between start (0) and end (1) of the involute.",
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        gears = [len(values) for values in (self.teeth, self.profile_shift, self.rack_tip_radius) if values]
        refuse_more(10_000, "gears to solve", *gears)
        refuse_more(1000, "load positions", len(self.load_position), key="load_position")
        return self
