"""``[design]``: profile relief to be found, the charts of candidates, and what it has to endure."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    Angle,
    Length,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveNumber,
    at_most,
    refuse,
    refuse_more,
)

Shape = Literal["linear", "parabolic"]
Positive = Annotated[list[PositiveNumber], Field(min_length=1)]


def _both_shapes() -> list[Shape]:
    return ["linear", "parabolic"]


class ChartPart(Part):
    """``chart = { amounts | amounts_over_delta, lengths, loads, shape }``: equal tip reliefs on both gears."""

    amounts: Annotated[list[PositiveLength], Field(min_length=1)] | None = None
    amounts_over_delta: Positive | None = None
    lengths: Positive | None = None
    loads: Annotated[list[PositiveForce], Field(min_length=1)] | None = None
    shape: Shape = "linear"

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        if self.amounts and self.amounts_over_delta:
            raise refuse("contradicts amounts", "give either", key="amounts_over_delta")
        amounts = self.amounts or self.amounts_over_delta
        counts = [len(values) for values in (amounts, self.lengths, self.loads) if values]
        refuse_more(100_000, "candidates", *counts)
        return self


class RobustnessPart(Part):
    """``robustness = { load_factors, spacing_errors, relief_errors }``: deviations whose combinations are tried."""

    load_factors: Positive = Field(default_factory=lambda: [0.7, 0.85, 1.0, 1.15, 1.3])
    spacing_errors: Annotated[list[Length], Field(min_length=1)] = Field(default_factory=lambda: [0.0])
    relief_errors: Annotated[list[Annotated[Number, Field(gt=-1.0)]], Field(min_length=1)] = Field(
        default_factory=lambda: [-0.2, 0.0, 0.2]
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        lists = (self.load_factors, self.spacing_errors, self.relief_errors)
        refuse_more(100_000, "combinations of deviations", *map(len, lists))
        return self


class DesignPart(Part):
    """Which pair is to be relieved, for which load, and how its teeth are to share it."""

    pair: str | None = None
    load: PositiveForce | None = None
    length: PositiveLength | None = None
    contact_ratio: PositiveNumber | None = None
    centre: Length | None = None
    family: Literal["sinusoidal", "polynomial"] = "sinusoidal"
    slope: Annotated[Number, Field(ge=0.0)] = 1.0
    exponent: int | None = None
    inner_slope: Annotated[Number, Field(ge=0.0)] = 1.0
    peak: PositiveNumber | Literal["least-root-stress"] | None = None
    grind: list[Shape] = Field(default_factory=_both_shapes)
    roll_angles: Annotated[list[Angle], Field(min_length=1), at_most(10_000, "roll angles")] | None = None
    metric: Literal["effective_error", "peak_to_peak"] = "peak_to_peak"
    chart: ChartPart = Field(default_factory=ChartPart)
    robustness: RobustnessPart = Field(default_factory=RobustnessPart)

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "give either length or contact_ratio", key="contact_ratio")
        if self.exponent is not None and self.family != "polynomial":
            raise refuse('has a meaning only with family = "polynomial"', key="exponent")
        return self
