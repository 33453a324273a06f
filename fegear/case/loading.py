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
        description="The pair whose base pitch and load are taken; without it lengths are in base pitches and loads "
        "in shares of the design load.",
    )
    load: PositiveForce | None = Field(
        default=None, description="Design load, with a pair; without it the pair's nominal load."
    )
    length: PositiveLength | None = Field(
        default=None,
        description="Loaded path on the line of action, with a pair; without it the pair's path of contact.",
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
        default=None, description="Odd exponents r of the polynomial family; without it 7."
    )
    peaks: Annotated[list[PositiveNumber], Field(min_length=1)] | None = Field(
        default=None,
        description="Largest loads of a tooth pair over the design load (F), for contact ratios above 2; without it "
        "the middle of their range.",
    )
    inner_slope: Annotated[Number, Field(ge=0.0)] = Field(
        default=1.0, description="Slope s of the inner ramps, for contact ratios above 2."
    )
    highest_order: Annotated[Number, Field(gt=3.0, le=1e4)] = Field(
        default=30.0, description="Up to which spectra go, in tooth-mesh frequencies."
    )
    speed: PositiveSpeed | None = Field(
        default=None, description="Speed of the pair's driver, at which its teeth answer by themselves."
    )
    tooth_frequency: Annotated[float, quantity("frequency", positive=True)] | None = Field(
        default=None,
        description="Lowest natural frequency of the teeth of both gears; without it that of each as a beam on its "
        "foundation.",
    )
    content_above: Annotated[Number, Field(gt=0.0, le=1e3)] = Field(
        default=20.0, description="Order from which content counts as high in `loading_trade_off`, to ten times that."
    )

    @model_validator(mode="after")
    def _one_choice(self) -> Self:
        if self.length is not None and self.contact_ratio is not None:
            raise refuse("contradicts length", "give either length or contact_ratio", key="contact_ratio")
        if self.exponents is not None and self.family != "polynomial":
            raise refuse('has a meaning only with family = "polynomial"', key="exponents")
        for key in ("length", "load", "speed", "tooth_frequency"):
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


class LoadDistributionPart(Part):
    """Roll positions over a base pitch, and panels over the face; without ``panels`` one to a quarter of a module.

    ``base_pitch`` says which teeth meet, where they have spacing errors: pair 0 is on the teeth of that number.
    """

    positions: Annotated[int, Field(ge=2, le=256)] = Field(
        default=16, description="Roll positions over one base pitch."
    )
    panels: Annotated[int, Field(ge=2, le=200)] | None = Field(
        default=None,
        description="Parts into which the common face is divided; without it one to a quarter of a module.",
    )
    coat: PositiveLength = Field(default=6e-6, description="Thickness of the marking compound in the contact pattern.")
    base_pitch: Annotated[int, Field(ge=0, le=1_000_000)] = Field(
        default=0,
        description="Which teeth meet where they have spacing errors: pair 0 is on the teeth of that number, counted "
        "round and round.",
    )


class LineErrorPart(Part):
    """``line_error = { over_face, crowning, file }``: gap along the line of action over the face, removal positive.

    ``over_face`` opens from the end at -b/2 to the end at +b/2 along the driver's axis; ``crowning`` from the middle
    to both ends as a parabola; ``file`` has the columns ``z`` and ``gap``. They add up.
    """

    over_face: Length = Field(
        default=0.0, description="Gap that opens from the face end at -b/2 to that at +b/2 along the driver's axis."
    )
    crowning: LengthOrZero = Field(
        default=0.0, description="Gap that opens from the middle of the face to both ends, as a parabola."
    )
    file: str | None = Field(default=None, description="CSV file with `z` and `gap`, such as that of deflected shafts.")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write line_error = { over_face = "10 um" }')
        return self


class TransmissionErrorPart(Part):
    """``method = "mark-series"`` adds Mark's series with so many terms; ``even_positions`` a table of even steps."""

    method: Literal["quadrature", "mark-series"] = Field(
        default="quadrature",
        description="The exact quadrature alone, or Mark's series and closed forms as well, with what they miss, and "
        "the lines of `mesh-force-spectrum` by the series.",
    )
    terms: Annotated[int, Field(ge=0, le=200)] = Field(
        default=3, description="M of Mark's series, 0 to 200; the report advises 3 at least."
    )
    even_positions: Annotated[int, Field(ge=8, le=100_000)] | None = Field(
        default=None,
        description="Rows of a table over one tooth of the driver for other programs, evenly spaced and periodic; "
        "written as .mat, too.",
    )

    @model_validator(mode="after")
    def _terms_of_a_series(self) -> Self:
        if "terms" in self.given and self.method != "mark-series":
            raise refuse('has a meaning only with method = "mark-series"', key="terms")
        return self
