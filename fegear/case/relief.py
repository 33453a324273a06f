"""``gear.NAME.relief`` and ``gear.NAME.spacing_errors``: what is ground off the teeth, and how unevenly they stand."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.case.part import (
    Angle,
    Length,
    Number,
    Part,
    PositiveLength,
    PositiveNumber,
    refuse,
    spelt_also,
)

Shape = Literal["linear", "parabolic"]

#: The ways to say where an end relief starts.
STARTS = ("start_roll_angle", "start_radius", "length", "normalised_length")


def several(part: type[Part]) -> BeforeValidator:
    """Let one table stand for a list of one."""

    def read(value: Any) -> Any:
        return [value] if isinstance(value, dict) else value

    return BeforeValidator(read, json_schema_input_type=part | list[part])  # type: ignore[valid-type]  # made at run time


class EndReliefPart(Part):
    """Tip or root relief: amount, start and shape."""

    amount: Length | None = None
    amount_over_delta: Number | None = None
    start_roll_angle: Angle | None = None
    start_radius: PositiveLength | None = None
    length: PositiveLength | None = None
    normalised_length: PositiveNumber | None = None
    shape: Shape = "linear"

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.amount is None) == (self.amount_over_delta is None):
            raise refuse(
                "must be given, or amount_over_delta instead",
                "Delta is the deflection at the HPSTC plus twice the spacing error (Welbourn)",
                key="amount",
            )
        given = [key for key in STARTS if getattr(self, key) is not None]
        if len(given) != 1:
            raise refuse(
                f"must be given in exactly one way, not in {len(given)}", f"give one of {', '.join(STARTS)}",
                key="start_radius", value=" and ".join(given) or "(not given)",
            )  # fmt: skip
        return self


class TipReliefPart(EndReliefPart):
    """``tip = { amount, start_roll_angle | start_radius | length | normalised_length, shape, at_radius }``."""

    at_radius: PositiveLength | None = None

    @model_validator(mode="after")
    def _measured_at_the_tip(self) -> Self:
        if self.normalised_length is not None and self.at_radius is not None:
            raise refuse("contradicts normalised_length, which counts from the tip", "leave it out", key="at_radius")
        return self


class RootReliefPart(EndReliefPart):
    """``root = { amount, start_..., shape, end_radius }``; it ends where contact starts unless given otherwise."""

    end_radius: PositiveLength | None = None

    @model_validator(mode="after")
    def _no_tip_measures(self) -> Self:
        if self.normalised_length is not None:
            raise refuse("is a measure of tip relief", "give start_radius or length", key="normalised_length")
        return self


class CrowningPart(Part):
    """``crowning = { amount, start_radius, end_radius }``; over the active profile unless given otherwise."""

    amount: Length
    start_radius: PositiveLength | None = None
    end_radius: PositiveLength | None = None


class ReliefTablePart(Part):
    """``table = { roll_angles | radii, removals }`` or ``{ file }``, and how to interpolate."""

    roll_angles: Annotated[list[Angle], Field(min_length=2)] | None = None
    radii: Annotated[list[PositiveLength], Field(min_length=2)] | None = None
    removals: Annotated[list[Length], Field(min_length=2)] | None = None
    file: str | None = None
    interpolation: Literal["linear", "cubic"] = "linear"

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        inline = [key for key in ("roll_angles", "radii", "removals") if getattr(self, key) is not None]
        if self.file is not None and inline:
            raise refuse(f"contradicts {inline[0]}", "give either the file or the lists", key="file")
        if self.file is None and (self.removals is None or len(inline) != 2):
            raise refuse(
                "is incomplete", "give removals with either roll_angles or radii, or a file", key="removals",
                value=", ".join(inline) or "(not given)",
            )  # fmt: skip
        places = self.roll_angles or self.radii or []
        if self.removals is not None and len(places) != len(self.removals):
            raise refuse(f"has {len(self.removals)} entries for {len(places)} places", key="removals", value="(a list)")
        return self


class ReliefPart(Part):
    """Profile modification of every tooth of a gear; parts of any kind add up."""

    tip: Annotated[list[TipReliefPart], several(TipReliefPart)] = Field(default_factory=list)
    root: Annotated[list[RootReliefPart], several(RootReliefPart)] = Field(default_factory=list)
    crowning: Annotated[list[CrowningPart], several(CrowningPart)] = Field(default_factory=list)
    table: Annotated[list[ReliefTablePart], several(ReliefTablePart)] = Field(default_factory=list)

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not (self.tip or self.root or self.crowning or self.table):
            raise refuse("removes nothing", "give tip, root, crowning or table, or leave relief out", value="{}")
        return self


class SpacingErrorsPart(Part):
    """``spacing_errors = [...]`` or ``{ file = "errors.csv" }``: one error for each tooth in the order of meshing."""

    model_config = spelt_also(lambda table: table["properties"]["values"])

    values: Annotated[list[Length], Field(min_length=1)] | None = None
    file: str | None = None

    @model_validator(mode="before")
    @classmethod
    def _list_alone(cls, value: Any) -> Any:
        return {"values": value} if isinstance(value, list) else value

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.values is None) == (self.file is None):
            raise refuse("must be one error for each tooth, as a list or in a file", key="values")
        return self
