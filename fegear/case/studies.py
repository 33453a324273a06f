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

    gear: str | None = Field(default=None, description="Gear whose tooth is varied. Default: the only gear.")
    teeth: Teeth | None = Field(default=None, description="Numbers of teeth. Default: the gear's own.")
    profile_shift: Numbers | None = Field(
        default=None, description="Profile shift coefficients. Default: the gear's own."
    )
    rack_tip_radius: Numbers | None = Field(
        default=None, description="Tip radii of the generating rack in modules. Default: the gear's own."
    )
    rack_dedendum: Positives | None = Field(
        default=None,
        description="With `samples`: dedenda of the generating rack in modules. Default: the gear's own.",
    )
    pressure_angle: Angles | None = Field(
        default=None, description="With `samples`: pressure angles of the rack. Default: the gear's own."
    )
    load_position: Shares = Field(
        default_factory=lambda: [0.1, 0.4, 0.7, 1.0],
        description="Load positions as fractions of roll angle from start (0) to end (1) of the involute; with "
        "`samples` the first and last of eight loads per gear. Default: 0.1, 0.4, 0.7, 1; with `samples` "
        "0 to 1.",
    )
    samples: int | None = Field(
        default=None, ge=2, le=10_000,
        description="Number of random gears between the first and last value of every list (instead of all "
                    "combinations); invalid teeth are resampled.",
    )  # fmt: skip
    seed: int = Field(default=0, ge=0, le=2**31 - 1, description="Seed of the random gears.")

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
                    raise refuse("requires samples", "set samples (number of gears)", key=key)
            return self
        if "load_position" not in self.model_fields_set:
            object.__setattr__(self, "load_position", [0.0, 1.0])
        for key in DRAWN:
            values = getattr(self, key) or [0]
            if len(values) > 2 or values[0] > values[-1]:
                raise refuse("must be one value, or minimum and maximum", "see samples", key=key)
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
        default=None, description="Quantities to study. Default: those of `results`."
    )
    gear: str | None = Field(
        default=None,
        description="Gear for compliance and root stress. Default: that of `[stiffness]`, else the pair's driver.",
    )
    pair: str | None = Field(
        default=None,
        description="Pair for transmission error and forces. Default: that of `[stiffness]`, else the first with a "
        "load.",
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
        description="Amounts of tip relief to evaluate. Default: eight values up to three times the mean "
        "transmission error.",
    )
    lengths: (
        Annotated[list[Annotated[Number, Field(gt=0.0, le=1.0)]], Field(min_length=1), at_most(_MOST_VALUES, "lengths")]
        | None
    ) = Field(
        default=None,
        description="Relief lengths relative to the path of contact. Default: seven values from 0.1 to 0.7.",
    )
    shape: Literal["linear", "parabolic"] = Field(default="linear", description="Shape of the tip reliefs.")
    draws: Annotated[int, Field(ge=20, le=2_000)] = Field(
        default=512,
        description="Number of samples for comparing candidates (results use different samples).",
    )
    percentile: Annotated[Number, Field(ge=50.0, le=99.9)] = Field(
        default=95.0, description="Percentile of the peak-to-peak transmission error to minimise."
    )


class TolerancePart(Part):
    """Which pair is drawn how often, and how its deviations are spread."""

    pair: str | None = Field(default=None, description="Pair whose deviations are sampled. Default: the only pair.")
    draws: Annotated[int, Field(ge=20, le=100_000)] = Field(default=2000, description="Number of samples.")
    seed: Annotated[int, Field(ge=0, le=2_147_483_647)] = Field(
        default=1, description="Seed of the sequence (same seed, same results)."
    )
    sequence: Literal["sobol", "halton", "random"] = Field(
        default="sobol", description="Sampling: scrambled quasi-random sequence, or `random` (Monte Carlo)."
    )
    distribution: Literal["normal", "uniform"] = Field(
        default="normal",
        description="Distribution: `normal` (tolerance = three standard deviations, truncated) or `uniform`.",
    )
    deviations: Annotated[list[Deviation], Field(min_length=1)] | None = Field(
        default=None, description="Deviations to sample. Default: all with a tolerance."
    )
    centre_distance: LengthOrZero = Field(default=0.0, description="Tolerance of the centre distance (plus/minus).")
    reliefs: RobustReliefPart | None = Field(
        default=None,
        description="Search for the tip relief of both gears with the best percentile, compared with the nominal "
        "optimum.",
    )
