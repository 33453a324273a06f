"""``[flank_design]``: relief of loaded flanks that is to be found, in two dimensions."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveNumber,
    refuse,
    refuse_more,
)

Family = Literal["profile", "crowning-and-end-relief", "lead", "profile-and-lead", "profile-lead-and-bias"]

#: Combinations that a grid may have.
_MOST = 200_000


def _all_families() -> list[Family]:
    return ["profile", "crowning-and-end-relief", "lead", "profile-and-lead", "profile-lead-and-bias"]


class FlankGridPart(Part):
    """``grid = { tip_amounts, tip_lengths, crownings, end_amounts, end_lengths, slopes, biases }``: what is tried.

    Zero is always among the amounts; a list that is left out stays at nothing.
    """

    tip_amounts: list[PositiveLength] = Field(default_factory=list)
    tip_lengths: list[PositiveLength] = Field(default_factory=list)
    crownings: list[Length] = Field(default_factory=list)
    end_amounts: list[Length] = Field(default_factory=list)
    end_lengths: list[PositiveLength] = Field(default_factory=list)
    slopes: list[Length] = Field(default_factory=list)
    biases: list[Length] = Field(default_factory=list)

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for amounts, lengths in (("tip_amounts", "tip_lengths"), ("end_amounts", "end_lengths")):
            if bool(getattr(self, amounts)) != bool(getattr(self, lengths)):
                raise refuse(f"needs {lengths} beside it, and these need it", "give both or neither", key=amounts)
        tips = 1 + len(self.tip_amounts) * len(self.tip_lengths)
        ends = 1 + len(self.end_amounts) * len(self.end_lengths)
        others = [1 + len(values) for values in (self.crownings, self.slopes, self.biases)]
        refuse_more(_MOST, "combinations", tips, tips, ends, *others)
        return self


class ScatterPart(Part):
    """``scatter = { over_face, levels }``: standard deviation of the misalignment, and levels that stand for it."""

    over_face: LengthOrZero
    levels: Annotated[int, Field(ge=2, le=9)] = 3


class FlankMapPart(Part):
    """``map = { over_face, load_factors }``: misalignments and loads over the design load that are mapped."""

    over_face: Annotated[list[Length], Field(min_length=1)] | None = None
    load_factors: Annotated[list[PositiveNumber], Field(min_length=1)] = Field(
        default_factory=lambda: [0.25, 0.5, 0.75, 1.0, 1.25]
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        refuse_more(2_000, "states to map", len(self.over_face or ()), len(self.load_factors))
        return self


class FlankDesignPart(Part):
    """Which pair's flanks are to be relieved, for which load, how teeth are to share it, and what can be ground."""

    pair: str | None = None
    load: PositiveForce | None = None
    loads: Annotated[list[PositiveForce], Field(min_length=1)] | None = None
    length: PositiveLength | None = None
    contact_ratio: PositiveNumber | None = None
    centre: Length | None = None
    slope: Annotated[Number, Field(ge=0.0, le=2.0)] = 0.0
    end_length: LengthOrZero = 0.0
    gear: Literal["driver", "driven", "both"] = "driver"
    positions: Annotated[int, Field(ge=8, le=256)] = 24
    families: Annotated[list[Family], Field(min_length=1)] = Field(default_factory=_all_families)
    grid: FlankGridPart | None = None
    largest_face_load_factor: Annotated[Number, Field(gt=1.0)] | None = None
    scatter: ScatterPart | None = None
    map: FlankMapPart = Field(default_factory=FlankMapPart)

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "give either length or contact_ratio", key="contact_ratio")
        return self
