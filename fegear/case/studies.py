"""``[study]``: gears and load positions over which root-stress formulas are compared with finite elements.

``[cost]``: which results ``fegear cost`` studies; without it, those that ``results`` asks for.

``[robustness]``: deviations inside the tolerances of the drawing, drawn at random.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from fegear.case.part import (
    Angle,
    LengthOrZero,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    at_most,
    refuse,
    refuse_more,
)

#: Each value once, whose gears would be the same.
_ONCE = AfterValidator(lambda values: list(dict.fromkeys(values)))
Teeth = Annotated[list[Annotated[int, Field(ge=5, le=1000)]], Field(min_length=1), _ONCE]
Numbers = Annotated[list[Number], Field(min_length=1), _ONCE]
Positives = Annotated[list[PositiveNumber], Field(min_length=1), _ONCE]
Angles = Annotated[list[Angle], Field(min_length=1), _ONCE]
Shares = Annotated[list[Annotated[Number, Field(ge=0.0, le=1.0)]], Field(min_length=1), _ONCE]


#: Lists between whose ends gears are drawn.
DRAWN = ("teeth", "profile_shift", "rack_tip_radius", "rack_dedendum", "pressure_angle", "load_position")


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
    rack_dedendum: Positives | None = Field(
        default=None,
        description="With `samples`: dedenda of the generating rack in modules; without it the gear's own.",
    )
    pressure_angle: Angles | None = Field(
        default=None, description="With `samples`: pressure angles of the rack; without it the gear's own."
    )
    load_position: Shares = Field(
        default_factory=lambda: [0.1, 0.4, 0.7, 1.0],
        description="Where the load acts, as shares of the roll angle between start (0) and end (1) of the involute; "
        "with `samples` the first and the last, and eight loads a gear between them. Default: 0.1, 0.4, 0.7, 1; with "
        "`samples` 0 to 1.",
    )
    samples: int | None = Field(
        default=None, ge=2, le=10_000,
        description="Gears drawn evenly between the first and the last value of every list, in place of every "
        "combination; draws that give no tooth are drawn anew.",
    )  # fmt: skip
    seed: int = Field(default=0, ge=0, le=2**31 - 1, description="The same seed draws the same gears.")

    @property
    def bounds(self) -> dict[str, tuple[float, float]]:
        """Lowest and highest value of what is drawn."""
        drawn = {key: getattr(self, key) for key in DRAWN}
        return {key: (float(values[0]), float(values[-1])) for key, values in drawn.items() if values}

    @model_validator(mode="after")
    def _drawn(self) -> Self:
        if self.samples is None:
            for key in ("rack_dedendum", "pressure_angle"):
                if getattr(self, key):
                    raise refuse("is for gears that are drawn", "give samples, their number", key=key)
            return self
        if "load_position" not in self.model_fields_set:
            object.__setattr__(self, "load_position", [0.0, 1.0])
        for key in DRAWN:
            values = getattr(self, key) or [0]
            if len(values) > 2 or values[0] > values[-1]:
                raise refuse("must be one value, or the lowest and the highest", "see samples", key=key)
        return self

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        gears = [len(values) for values in (self.teeth, self.profile_shift, self.rack_tip_radius) if values]
        refuse_more(10_000, "gears to solve", *gears)
        refuse_more(1000, "load positions", len(self.load_position), key="load_position")
        return self


QuantityName = Literal[
    "c_0", "c_1", "root-stress", "te-peak-to-peak", "tooth-force", "dynamic-factor", "te-mean", "face-load-factor"
]  # fmt: skip


class CostPart(Part):
    """Which quantities of which gear and pair."""

    quantities: Annotated[list[QuantityName], Field(min_length=1)] | None = Field(
        default=None, description="What is studied; without it what `results` stands for."
    )
    gear: str | None = Field(
        default=None,
        description="The gear whose compliance and root stress are studied; without it that of `[stiffness]`, else "
        "the pair's driver.",
    )
    pair: str | None = Field(
        default=None,
        description="The pair whose transmission error and forces are studied; without it that of `[stiffness]`, "
        "else the first with a load.",
    )

    @property
    def stages(self) -> tuple[str, ...]:
        """Stages whose effects the quantities named here depend on."""
        names = set(self.quantities or ())
        of_pair = ("loaded-pair",) if names & {"te-peak-to-peak", "tooth-force", "dynamic-factor"} else ()
        of_pair = (*of_pair, "loaded-flanks") if names & {"te-mean", "face-load-factor"} else of_pair
        return (*of_pair, "motion") if "dynamic-factor" in names else of_pair


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
