"""``[transmission_error]``: whether a method from the literature is computed beside the exact one."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Part, refuse


class TransmissionErrorPart(Part):
    """``method = "mark-series"`` adds Mark's series with so many terms."""

    method: Literal["quadrature", "mark-series"] = Field(
        default="quadrature",
        description="The exact quadrature alone, or Mark's series and closed forms as well, with what they miss.",
    )
    terms: Annotated[int, Field(ge=0, le=200)] = Field(
        default=3, description="M of Mark's series, 0 to 200; the report advises 3 at least."
    )

    @model_validator(mode="after")
    def _terms_of_a_series(self) -> Self:
        if "terms" in self.model_fields_set and self.method != "mark-series":
            raise refuse('has a meaning only with method = "mark-series"', key="terms")
        return self
