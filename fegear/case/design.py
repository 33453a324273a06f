"""``[design]``: profile relief to be found, the charts of candidates, and what it has to endure."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.base.given import all_given
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
from fegear.geometry.relief import Shape
from fegear.geometry.relief_spec import EndReliefSpec

Positive = Annotated[list[PositiveNumber], Field(min_length=1)]


def _both_shapes() -> list[Shape]:
    return ["linear", "parabolic"]


class ChartPart(Part):
    """``chart = { amounts | amounts_over_delta, lengths, loads, shape }``: equal tip reliefs on both gears."""

    amounts: Annotated[list[PositiveLength], Field(min_length=1)] | None = Field(
        default=None, description="Amounts of tip relief; alternatively `amounts_over_delta`."
    )
    amounts_over_delta: Positive | None = Field(
        default=None, description="Amounts of tip relief in units of Welbourn's Delta. Default: up to 1.6 Delta."
    )
    lengths: Positive | None = Field(
        default=None, description="Normalised lengths L_n of TM-89901 (1: from tip to HPSTC). Default: up to 1.3."
    )
    loads: Annotated[list[PositiveForce], Field(min_length=1)] | None = Field(
        default=None, description="Loads. Default: those of the pair."
    )
    shape: Shape = Field(default="linear", description=all_given(EndReliefSpec)["shape"].meaning)

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        if self.amounts and self.amounts_over_delta:
            raise refuse("contradicts amounts", "specify only one", key="amounts_over_delta")
        amounts = self.amounts or self.amounts_over_delta
        counts = [len(values) for values in (amounts, self.lengths, self.loads) if values]
        refuse_more(100_000, "candidates", *counts)
        return self


class RobustnessPart(Part):
    """``robustness = { load_factors, spacing_errors, relief_errors }``: deviations whose combinations are tried."""

    load_factors: Positive = Field(
        default_factory=lambda: [0.7, 0.85, 1.0, 1.15, 1.3], description="Load factors (load over design load)."
    )
    spacing_errors: Annotated[list[Length], Field(min_length=1)] = Field(
        default_factory=lambda: [0.0], description="Pitch deviations (spacing errors)."
    )
    relief_errors: Annotated[list[Annotated[Number, Field(gt=-1.0)]], Field(min_length=1)] = Field(
        default_factory=lambda: [-0.2, 0.0, 0.2], description="Relative errors of the amount of relief."
    )

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        lists = (self.load_factors, self.spacing_errors, self.relief_errors)
        refuse_more(100_000, "combinations of deviations", *map(len, lists))
        return self


class TipTolerancePart(Part):
    """``tolerances = { amount, length, ... }``: by how much what is ground may be off, to either side."""

    amount: LengthOrZero | None = Field(
        default=None,
        description="Tolerance of the amount. Default: profile slope deviation f_Halpha of the gear, by its "
        "`deviations` or its `tolerance_class` (5 without one).",
    )
    length: LengthOrZero | None = Field(
        default=None,
        description="Tolerance of the length along the line of action. Default: a tenth of the length.",
    )
    helix_slope: LengthOrZero | None = Field(
        default=None,
        description="Tolerance of a ground helix slope, for `flank-design`. Default: helix slope deviation f_Hbeta of "
        "the gear, by its `deviations` or its `tolerance_class` (5 without one).",
    )
    crowning: LengthOrZero | None = Field(
        default=None,
        description="Tolerance of crowning and end relief, for `flank-design`. Default: helix form deviation f_fbeta "
        "of the gear's `tolerance_class` (5 without one).",
    )


class LimitsPart(Part):
    """``limits = { amount, length, ... }``: what tip relief to be found may be at most."""

    amount: PositiveLength | None = Field(default=None, description="Maximum amount of tip relief. Default: no limit.")
    length: PositiveLength | None = Field(
        default=None, description="Maximum length along the line of action. Default: the path of contact."
    )
    driver_start_diameter: PositiveLength | None = Field(
        default=None,
        description="Diameter on the driver that tip relief must not pass towards the root. Default: no limit.",
    )
    driven_start_diameter: PositiveLength | None = Field(
        default=None,
        description="Diameter on the driven gear that tip relief must not pass towards the root. Default: no limit.",
    )


class AllowablePart(Part):
    """``allowable = { root_tension, hertz_pressure }``: stresses that `peak = "least-stress"` weighs by."""

    root_tension: PositivePressure = Field(description="Permissible root stress (tension side).")
    hertz_pressure: PositivePressure = Field(description="Permissible Hertzian pressure.")


class FilmPart(Part):
    """``film = { x, thickness }``: the layer of oil between the flanks at the design load."""

    x: Annotated[list[Length], Field(min_length=1)] = Field(
        description="Positions on the line of action from the pitch point, increasing; linear interpolation, "
        "constant beyond the ends."
    )
    thickness: Annotated[list[LengthOrZero], Field(min_length=1)] = Field(
        description="Film thickness at each position, such as `film_thickness` of `flank-surface`."
    )

    @model_validator(mode="after")
    def _matching(self) -> Self:
        if len(self.thickness) != len(self.x):
            raise refuse(f"must have one value for each of the {len(self.x)} values of x", key="thickness")
        if any(b <= a for a, b in pairwise(self.x)):
            raise refuse("must be strictly increasing", "sort the values and remove duplicates", key="x")
        return self


#: The design zone of profile and flank reliefs.
ZoneLength = Annotated[
    PositiveLength | None,
    Field(
        description="Length of the design zone on the line of action. Default: from `contact_ratio`, otherwise the "
        "full path of contact."
    ),
]
ZoneRatio = Annotated[
    PositiveNumber | None, Field(description="Length of the design zone in base pitches; alternatively `length`.")
]
ZoneCentre = Annotated[
    Length | None,
    Field(description="Middle of the design zone, from the pitch point. Default: middle of the path of contact."),
]


class DesignPart(Part):
    """Which pair is to be relieved, for which load, and how its teeth are to share it."""

    pair: str | None = Field(default=None, description="Pair. Default: the only pair.")
    load: PositiveForce | None = Field(default=None, description="Design load. Default: nominal load of the pair.")
    over: Literal["torques", "spectrum", "load"] | None = Field(
        default=None,
        description="What tip relief is designed for: `torques` (all of the pair, with their weights), `spectrum` "
        "(torques of `operation.spectrum`, weighted by time shares) or `load` (design load only). Default: the first "
        "that the pair has.",
    )
    length: ZoneLength = None
    contact_ratio: ZoneRatio = None
    centre: ZoneCentre = None
    family: Literal["sinusoidal", "polynomial"] = Field(
        default="sinusoidal", description="Family of the loading ramps: sinusoidal (4.12) or polynomial (4.14)."
    )
    slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the load at contact initiation; 1: linear ramp."
    )
    exponent: int | None = Field(default=None, description="Odd exponent r of the polynomial family. Default: 7.")
    inner_slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the inner ramps, for contact ratios above 2."
    )
    peak: PositiveNumber | Literal["least-root-stress", "least-stress"] | None = Field(
        default=None,
        description="Peak tooth pair load relative to the design load (F), for contact ratios above 2; or "
        "`least-root-stress`, or `least-stress` (root stress and Hertzian pressure). Default: middle of "
        "the range.",
    )
    allowable: AllowablePart | None = Field(
        default=None,
        description='Permissible stresses for `peak = "least-stress"`: the higher utilisation is minimised.',
    )
    film: FilmPart | None = Field(
        default=None,
        description="Oil film thickness; each gear's relief compensates half of it. Default: none.",
    )
    grind: list[Shape] = Field(
        default_factory=_both_shapes, description="Shapes of grindable tip relief; empty list: none."
    )
    relieve: Literal["both", "driver", "driven"] = Field(
        default="both", description="Gears that have grindable tip relief: both, or one of them only."
    )
    limits: LimitsPart | None = Field(
        default=None, description="Limits of grindable tip relief. Default: none but those of the teeth."
    )
    tolerances: TipTolerancePart | None = Field(
        default=None, description="Tolerances of grindable tip relief, for the grinding table and the profile chart."
    )
    roll_angles: Annotated[list[Angle], Field(min_length=1), at_most(10_000, "roll angles")] | None = Field(
        default=None,
        description="Roll angles on the active profile in the table `relief_points_<pair>_<gear>` (load, deflection, "
        "relief).",
    )
    metric: Literal["effective_error", "peak_to_peak", "peak_to_peak_max"] = Field(
        default="peak_to_peak",
        description="Objective of the search for tip relief: `peak_to_peak` transmission error as drawn, "
        "`peak_to_peak_max` (its maximum within the tolerances of the grinding table), or `effective_error` A_e.",
    )
    chart: ChartPart = Field(
        default_factory=ChartPart,
        description="Equal tip reliefs on both gears to evaluate, for `relief-chart` and `relief-curves`.",
    )
    robustness: RobustnessPart = Field(
        default_factory=RobustnessPart, description="Deviations to combine, for `robustness`."
    )

    @property
    def measure(self) -> Literal["effective_error", "peak_to_peak"]:
        """What is left as drawn that `metric` is about."""
        return "peak_to_peak" if self.metric == "peak_to_peak_max" else self.metric

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "specify either length or contact_ratio", key="contact_ratio")
        if (self.peak == "least-stress") != (self.allowable is not None):
            remedy = (
                'specify peak = "least-stress" and allowable = { root_tension = "430 MPa", hertz_pressure = "1200 '
                'MPa" }'
            )
            raise refuse('requires peak = "least-stress", and vice versa', remedy, key="allowable")
        if self.exponent is not None and self.family != "polynomial":
            raise refuse('requires family = "polynomial"', key="exponent")
        return self
