"""``[stiffness]``: the compliance and root-stress table of one gear."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Part, PositiveLength, PositiveLineLoad, at_most, refuse


class StiffnessPart(Part):
    """Which gear, at which radii, under how wide a contact."""

    gear: str | None = None
    radii: Annotated[list[PositiveLength], Field(min_length=1), at_most(100_000, "load positions")] | None = None
    positions: Annotated[int, Field(ge=2, le=100_000)] = 100
    contact_half_width: PositiveLength | None = None
    load: PositiveLineLoad | None = None
    pair: str | None = None

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.radii is not None and "positions" in self.model_fields_set:
            raise refuse("contradicts radii", "give either radii or positions", key="positions")
        if self.contact_half_width is not None and self.load is not None:
            raise refuse("contradicts contact_half_width", "give either of them", key="load")
        return self
