"""``[robustness]``: deviations inside the tolerances of the drawing, drawn at random."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fegear.case.part import LengthOrZero, Number, Part, PositiveLength, at_most

Deviation = Literal["centre-distance", "profile-slope", "profile-form", "helix-slope", "pitch"]
#: Tip reliefs of one gear: amounts times lengths, so that pairs of them stay countable.
_MOST_VALUES = 40


class RobustReliefPart(Part):
    """``reliefs = { amounts, lengths, shape, draws }``: tip reliefs of both gears to be tried over common draws."""

    amounts: Annotated[list[PositiveLength], Field(min_length=1), at_most(_MOST_VALUES, "amounts")] | None = Field(
        default=None,
        description="Amounts at the tips to be tried; without it eight up to three times the mean transmission error.",
    )
    lengths: (
        Annotated[list[Annotated[Number, Field(gt=0.0, le=1.0)]], Field(min_length=1), at_most(_MOST_VALUES, "lengths")]
        | None
    ) = Field(
        default=None, description="Lengths over the path of contact to be tried; without it seven from 0.1 to 0.7."
    )
    shape: Literal["linear", "parabolic"] = Field(default="linear", description="Shape of the tip reliefs.")
    draws: Annotated[int, Field(ge=20, le=2_000)] = Field(
        default=512,
        description="How many draws candidates are compared over; results are those of others.",
    )
    percentile: Annotated[Number, Field(ge=50.0, le=99.9)] = Field(
        default=95.0, description="Percentile of the peak-to-peak transmission error that is to be least."
    )


class TolerancePart(Part):
    """Which pair is drawn how often, and how its deviations are spread."""

    pair: str | None = Field(default=None, description="Pair whose deviations are drawn; without it the only one.")
    draws: Annotated[int, Field(ge=20, le=100_000)] = Field(default=2000, description="How many engagements are drawn.")
    seed: Annotated[int, Field(ge=0, le=2_147_483_647)] = Field(
        default=1, description="Seed of the sequence; the same one gives the same bits."
    )
    sequence: Literal["sobol", "halton", "random"] = Field(
        default="sobol", description="Scrambled quasi-random sequence, or `random`, plain Monte Carlo."
    )
    distribution: Literal["normal", "uniform"] = Field(
        default="normal",
        description="With `normal` the tolerance is three standard deviations, and the end; `uniform` is even over it.",
    )
    deviations: Annotated[list[Deviation], Field(min_length=1)] | None = Field(
        default=None, description="Kinds of deviations that are drawn; without it all that have a tolerance."
    )
    centre_distance: LengthOrZero = Field(
        default=0.0, description="Largest deviation of the centre distance, to either side."
    )
    reliefs: RobustReliefPart | None = Field(
        default=None,
        description="Tip reliefs of both gears are tried: the best in a percentile is compared with the nominal best.",
    )
