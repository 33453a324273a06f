"""``[design]``: profile relief to be found, the charts of candidates, and what it has to endure."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import (
    Angle,
    Length,
    LengthOrZero,
    Number,
    Part,
    PositiveForce,
    PositiveLength,
    PositiveNumber,
    PositivePressure,
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

    amounts: Annotated[list[PositiveLength], Field(min_length=1)] | None = Field(
        default=None, description="Amounts of tip relief; give these or `amounts_over_delta`."
    )
    amounts_over_delta: Positive | None = Field(
        default=None, description="Amounts of tip relief in units of Welbourn's Delta; without both up to 1.6 Delta."
    )
    lengths: Positive | None = Field(
        default=None, description="Lengths in L_n of TM-89901, 1 from tip to HPSTC; without it up to 1.3."
    )
    loads: Annotated[list[PositiveForce], Field(min_length=1)] | None = Field(
        default=None, description="Loads; without it those of the pair."
    )
    shape: Shape = Field(
        default="linear", description="How the removal grows from the start: straight, or as a parabola."
    )

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

    load_factors: Positive = Field(
        default_factory=lambda: [0.7, 0.85, 1.0, 1.15, 1.3], description="Loads over the design load."
    )
    spacing_errors: Annotated[list[Length], Field(min_length=1)] = Field(
        default_factory=lambda: [0.0], description="Spacing errors."
    )
    relief_errors: Annotated[list[Annotated[Number, Field(gt=-1.0)]], Field(min_length=1)] = Field(
        default_factory=lambda: [-0.2, 0.0, 0.2], description="Relative errors of the amount of relief."
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        lists = (self.load_factors, self.spacing_errors, self.relief_errors)
        refuse_more(100_000, "combinations of deviations", *map(len, lists))
        return self


class AllowablePart(Part):
    """``allowable = { root_tension, hertz_pressure }``: stresses that `peak = "least-stress"` weighs by."""

    root_tension: PositivePressure = Field(description="Root tension that may not be exceeded.")
    hertz_pressure: PositivePressure = Field(description="Hertzian pressure that may not be exceeded.")


class FilmPart(Part):
    """``film = { x, thickness }``: the layer of oil between the flanks at the design load."""

    x: Annotated[list[Length], Field(min_length=1)] = Field(
        description="Places on the line of action from the pitch point, rising; straight between them, level beyond."
    )
    thickness: Annotated[list[LengthOrZero], Field(min_length=1)] = Field(
        description="Thickness of the film at each place, such as the `film_thickness` of `flank-surface`."
    )

    @model_validator(mode="after")
    def _matching(self) -> Self:
        if len(self.thickness) != len(self.x):
            raise refuse(f"must have one value for each of the {len(self.x)} places of x", key="thickness")
        if any(b <= a for a, b in pairwise(self.x)):
            raise refuse("must rise from place to place", "sort the places, each of them once", key="x")
        return self


#: The design zone of profile and flank reliefs.
ZoneLength = Annotated[
    PositiveLength | None,
    Field(
        description="Length of the design zone on the line of action; without it and `contact_ratio` the whole path of "
        "contact."
    ),
]
ZoneRatio = Annotated[
    PositiveNumber | None, Field(description="Length of the design zone in base pitches; give this or `length`.")
]
ZoneCentre = Annotated[
    Length | None,
    Field(description="Middle of the design zone, from the pitch point; without it the middle of the path."),
]


class DesignPart(Part):
    """Which pair is to be relieved, for which load, and how its teeth are to share it."""

    pair: str | None = Field(default=None, description="Which pair; without it the only one.")
    load: PositiveForce | None = Field(default=None, description="Design load; without it the pair's nominal load.")
    length: ZoneLength = None
    contact_ratio: ZoneRatio = None
    centre: ZoneCentre = None
    family: Literal["sinusoidal", "polynomial"] = Field(
        default="sinusoidal", description="Family of the loading ramps: sinusoidal (4.12) or polynomial (4.14)."
    )
    slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the load at contact initiation; 1 is a straight line."
    )
    exponent: int | None = Field(default=None, description="Odd exponent r of the polynomial family; without it 7.")
    inner_slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the inner ramps, for contact ratios above 2."
    )
    peak: PositiveNumber | Literal["least-root-stress", "least-stress"] | None = Field(
        default=None,
        description="Largest load of a tooth pair over the design load (F), for contact ratios above 2, or "
        "`least-root-stress`, or `least-stress` for root tension and Hertzian pressure together; without it the middle "
        "of its range.",
    )
    allowable: AllowablePart | None = Field(
        default=None,
        description='With `peak = "least-stress"`: the larger share of these stresses is made least.',
    )
    film: FilmPart | None = Field(
        default=None,
        description="Layer of oil between the flanks, half of which each relief makes up for; without it none.",
    )
    grind: list[Shape] = Field(
        default_factory=_both_shapes, description="Shapes of tip relief that a shop can grind; an empty list for none."
    )
    roll_angles: Annotated[list[Angle], Field(min_length=1), at_most(10_000, "roll angles")] | None = Field(
        default=None,
        description="Roll angles on the active profile at which `relief_points_<pair>_<gear>` gives load, deflection "
        "and relief.",
    )
    metric: Literal["effective_error", "peak_to_peak"] = Field(
        default="peak_to_peak", description="What the chart is judged by: peak to peak, or the effective error A_e."
    )
    chart: ChartPart = Field(
        default_factory=ChartPart,
        description="Equal tip reliefs on both gears that are tried, for `relief-chart` and `relief-curves`.",
    )
    robustness: RobustnessPart = Field(
        default_factory=RobustnessPart, description="Deviations whose combinations are tried, for `robustness`."
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "give either length or contact_ratio", key="contact_ratio")
        if (self.peak == "least-stress") != (self.allowable is not None):
            remedy = (
                'give peak = "least-stress" and allowable = { root_tension = "430 MPa", hertz_pressure = "1200 MPa" }'
            )
            raise refuse('goes with peak = "least-stress", and that with it', remedy, key="allowable")
        if self.exponent is not None and self.family != "polynomial":
            raise refuse('has a meaning only with family = "polynomial"', key="exponent")
        return self
