"""``[flank_design]``: relief of loaded flanks that is to be found, in two dimensions."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.design import ZoneCentre, ZoneLength, ZoneRatio
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

    tip_amounts: list[PositiveLength] = Field(default_factory=list, description="Amounts of tip relief.")
    tip_lengths: list[PositiveLength] = Field(
        default_factory=list, description="Lengths of tip relief along the line of action."
    )
    crownings: list[Length] = Field(default_factory=list, description="Amounts of lead crowning C_beta.")
    end_amounts: list[Length] = Field(default_factory=list, description="Amounts of end relief.")
    end_lengths: list[PositiveLength] = Field(default_factory=list, description="Lengths of end relief.")
    slopes: list[Length] = Field(default_factory=list, description="Helix slope modifications over the face width.")
    biases: list[Length] = Field(default_factory=list, description="Amounts of flank twist (bias).")

    @model_validator(mode="after")
    def _complete(self) -> Self:
        for amounts, lengths in (("tip_amounts", "tip_lengths"), ("end_amounts", "end_lengths")):
            if bool(getattr(self, amounts)) != bool(getattr(self, lengths)):
                raise refuse(f"requires {lengths}, and vice versa", "specify both or neither", key=amounts)
        tips = 1 + len(self.tip_amounts) * len(self.tip_lengths)
        ends = 1 + len(self.end_amounts) * len(self.end_lengths)
        others = [1 + len(values) for values in (self.crownings, self.slopes, self.biases)]
        refuse_more(_MOST, "combinations", tips, tips, ends, *others)
        return self


class ScatterPart(Part):
    """``scatter = { over_face, levels }``: standard deviation of the misalignment, and levels that stand for it."""

    over_face: LengthOrZero = Field(description="Standard deviation of the misalignment over the face width.")
    levels: Annotated[int, Field(ge=2, le=9)] = Field(
        default=3, description="Number of Gauss-Hermite points for the scatter."
    )


class FlankMapPart(Part):
    """``map = { over_face, load_factors }``: misalignments and loads over the design load that are mapped."""

    over_face: Annotated[list[Length], Field(min_length=1)] | None = Field(
        default=None,
        description="Misalignments of the map. Default: up to two standard deviations of the scatter, or 10 um.",
    )
    load_factors: Annotated[list[PositiveNumber], Field(min_length=1)] = Field(
        default_factory=lambda: [0.25, 0.5, 0.75, 1.0, 1.25],
        description="Load factors of the map (load over design load).",
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        refuse_more(2_000, "states to map", len(self.over_face or ()), len(self.load_factors))
        return self


class FlankDesignPart(Part):
    """Which pair's flanks are to be relieved, for which load, how teeth are to share it, and what can be ground."""

    pair: str | None = Field(default=None, description="Pair. Default: the only 3D pair.")
    load: PositiveForce | None = Field(default=None, description="Design load. Default: nominal load of the pair.")
    loads: Annotated[list[PositiveForce], Field(min_length=1)] | None = Field(
        default=None,
        description="Loads for choosing the grindable reliefs: the maximum transmission error relative to its load "
        "is minimised. Default: `torques` of the pair, by weight, otherwise the design load.",
    )
    length: ZoneLength = None
    contact_ratio: ZoneRatio = None
    centre: ZoneCentre = None
    slope: Annotated[Number, Field(ge=0.0, le=2.0)] = Field(
        default=0.0, description="Slope s of the load at contact initiation."
    )
    end_length: LengthOrZero = Field(
        default=0.0, description="Length at both face ends over which the design load decreases to zero."
    )
    gear: Literal["driver", "driven", "both"] = Field(
        default="driver", description="Gear that receives the ideal topography, or `both` (one half each)."
    )
    positions: Annotated[int, Field(ge=8, le=256)] = Field(
        default=24, description="Number of mesh positions over one base pitch used in the design."
    )
    families: Annotated[list[Family], Field(min_length=1)] = Field(
        default_factory=_all_families,
        description="Grindable modifications: tip reliefs, crowning and end relief, helix slope, bias.",
    )
    grid: FlankGridPart | None = Field(
        default=None,
        description="Grindable reliefs to evaluate (all combinations). Default: from the depth of the ideal "
        "topography.",
    )
    largest_face_load_factor: Annotated[Number, Field(gt=1.0)] | None = Field(
        default=None,
        description="Maximum K_Hbeta for all loads and misalignments. Default: no limit.",
    )
    scatter: ScatterPart | None = Field(default=None, description="Scatter of the misalignment.")
    map: FlankMapPart = Field(
        default_factory=FlankMapPart, description="Misalignments and loads of the map of the chosen relief."
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "specify either length or contact_ratio", key="contact_ratio")
        return self
