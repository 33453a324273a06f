"""``[loading]``: tooth loading functions to look at, on a gear pair or on any teeth of a contact ratio.

``[load_distribution]``, and ``line_error`` of a pair: what keeps flanks apart over the face.

``[transmission_error]``: whether a method from the literature is computed in addition to the exact one.
"""

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
    PositiveSpeed,
    quantity,
    refuse,
    refuse_more,
)

#: Most curves of one case: each is a few thousand numbers.
_MOST_CURVES = 200


class LoadingPart(Part):
    """Every combination of the lists is one loading function."""

    pair: str | None = Field(
        default=None,
        description="Pair that defines base pitch and load. Default: lengths in base pitches, loads relative to the "
        "design load.",
    )
    load: PositiveForce | None = Field(
        default=None, description="Design load, with a pair. Default: nominal load of the pair."
    )
    length: PositiveLength | None = Field(
        default=None,
        description="Loaded path on the line of action, with a pair. Default: the pair's path of contact.",
    )
    contact_ratio: PositiveNumber | None = Field(
        default=None, description="Loaded path in base pitches; required without a pair."
    )
    family: Literal["sinusoidal", "polynomial"] = Field(
        default="sinusoidal", description="Family of the loading ramps: sinusoidal (4.12) or polynomial (4.14)."
    )
    slopes: Annotated[list[Annotated[Number, Field(ge=0.0)]], Field(min_length=1)] = Field(
        default_factory=lambda: [0.0, 0.5, 1.0, 2.0],
        description="Slopes s at contact initiation: 0 to 2, polynomial 0 to r.",
    )
    exponents: Annotated[list[int], Field(min_length=1)] | None = Field(
        default=None, description="Odd exponents r of the polynomial family. Default: 7."
    )
    peaks: Annotated[list[PositiveNumber], Field(min_length=1)] | None = Field(
        default=None,
        description="Peak tooth pair load relative to the design load (F), for contact ratios above 2. Default: "
        "middle of the admissible range.",
    )
    inner_slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the inner ramps, for contact ratios above 2."
    )
    highest_order: Annotated[Number, Field(gt=3.0, le=1e4)] = Field(
        default=30.0, description="Upper limit of the spectra, in tooth-mesh frequencies."
    )
    speed: PositiveSpeed | None = Field(default=None, description="Driver speed for the response of single teeth.")
    tooth_frequency: Annotated[float, quantity("frequency", positive=True)] | None = Field(
        default=None,
        description="Lowest tooth natural frequency of both gears. Default: beam on elastic foundation.",
    )
    content_above: Annotated[Number, Field(gt=0.0, le=1e3)] = Field(
        default=20.0, description="Lower limit of the high orders in `loading_trade_off` (upper limit: ten times this)."
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "specify either length or contact_ratio", key="contact_ratio")
        if self.exponents is not None and self.family != "polynomial":
            raise refuse('requires family = "polynomial"', key="exponents")
        for key in ("length", "load", "speed", "tooth_frequency"):
            if getattr(self, key) is not None and self.pair is None:
                raise refuse("requires a pair", 'set pair = "I"', key=key)
        if self.pair is None and self.contact_ratio is None:
            raise refuse(
                "is required without a pair", "set contact_ratio = 1.5", key="contact_ratio",
                value="(not given)",
            )  # fmt: skip
        counts = [len(values) for values in (self.slopes, self.exponents, self.peaks) if values]
        refuse_more(_MOST_CURVES, "loading functions", *counts)
        return self


class LoadDistributionPart(Part):
    """Roll positions over a base pitch, and panels over the face; without ``panels`` one to a quarter of a module.

    ``base_pitch`` says which teeth meet, where they have spacing errors: pair 0 is on the teeth of that number.
    """

    positions: Annotated[int, Field(ge=2, le=256)] = Field(
        default=16, description="Number of mesh positions over one base pitch."
    )
    panels: Annotated[int, Field(ge=2, le=200)] | None = Field(
        default=None,
        description="Number of panels over the common face width. Default: one per quarter module.",
    )
    coat: PositiveLength = Field(default=6e-6, description="Thickness of the marking compound for the contact pattern.")
    base_pitch: Annotated[int, Field(ge=0, le=1_000_000)] = Field(
        default=0,
        description="Number of the tooth pair 0 for pitch deviations (counted cyclically).",
    )


class LineErrorPart(Part):
    """``line_error = { over_face, crowning, file }``: gap along the line of action over the face, removal positive.

    ``over_face`` opens from the end at -b/2 to the end at +b/2 along the driver's axis; ``crowning`` from the middle
    to both ends as a parabola; ``file`` has the columns ``z`` and ``gap``. They add up.
    """

    over_face: Length = Field(
        default=0.0,
        description="Linear gap over the full face width, zero at end I (-b/2), maximum at end II "
        "(+b/2) of the driver.",
    )
    crowning: LengthOrZero = Field(default=0.0, description="Parabolic gap from mid-face (zero) to both face ends.")
    file: str | None = Field(default=None, description="CSV file with `z` and `gap`, for example of deflected shafts.")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'set line_error = { over_face = "10 um" }')
        return self


class TransmissionErrorPart(Part):
    """``method = "mark-series"`` adds Mark's series with so many terms; ``even_positions`` a table of even steps."""

    method: Literal["quadrature", "mark-series"] = Field(
        default="quadrature",
        description="Method: exact quadrature, or additionally Mark's series and closed-form solution with their "
        "error (also in `mesh-force-spectrum`).",
    )
    terms: Annotated[int, Field(ge=0, le=200)] = Field(
        default=3, description="Order M of Mark's series, 0 to 200 (at least 3 recommended by Mark)."
    )
    even_positions: Annotated[int, Field(ge=8, le=100_000)] | None = Field(
        default=None,
        description="Number of rows of a periodic table over one driver tooth for other programs; also written as "
        ".mat.",
    )

    @model_validator(mode="after")
    def _terms_of_a_series(self) -> Self:
        if "terms" in self.given and self.method != "mark-series":
            raise refuse('requires method = "mark-series"', key="terms")
        return self
