"""``[loading]``: tooth loading functions to look at, on a gear pair or on any teeth of a contact ratio."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import Number, Part, PositiveForce, PositiveLength, PositiveNumber, refuse, refuse_more

#: Most curves of one case: each is a few thousand numbers.
_MOST_CURVES = 200


class LoadingPart(Part):
    """Every combination of the lists is one loading function."""

    pair: str | None = None
    load: PositiveForce | None = None
    length: PositiveLength | None = None
    contact_ratio: PositiveNumber | None = None
    family: Literal["sinusoidal", "polynomial"] = "sinusoidal"
    slopes: Annotated[list[Annotated[Number, Field(ge=0.0)]], Field(min_length=1)] = Field(
        default_factory=lambda: [0.0, 0.5, 1.0, 2.0]
    )
    exponents: Annotated[list[int], Field(min_length=1)] | None = None
    peaks: Annotated[list[PositiveNumber], Field(min_length=1)] | None = None
    inner_slope: Annotated[Number, Field(ge=0.0)] = 1.0
    highest_order: Annotated[Number, Field(gt=3.0, le=1e4)] = 30.0
    content_above: Annotated[Number, Field(gt=0.0, le=1e3)] = 20.0

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "give either length or contact_ratio", key="contact_ratio")
        if self.exponents is not None and self.family != "polynomial":
            raise refuse('has a meaning only with family = "polynomial"', key="exponents")
        for key in ("length", "load"):
            if getattr(self, key) is not None and self.pair is None:
                raise refuse("has a meaning only with a pair", 'name it: pair = "I"', key=key)
        if self.pair is None and self.contact_ratio is None:
            raise refuse(
                "is missing where no pair is named", "write contact_ratio = 1.5", key="contact_ratio",
                value="(not given)",
            )  # fmt: skip
        counts = [len(values) for values in (self.slopes, self.exponents, self.peaks) if values]
        refuse_more(_MOST_CURVES, "loading functions", *counts)
        return self
