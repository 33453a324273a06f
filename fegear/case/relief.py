"""``gear.NAME.relief`` and ``gear.NAME.spacing_errors``: what is ground off the teeth, and how unevenly they stand.

``gear.NAME.lead``, ``bias`` and ``topography``: what is ground off the flanks over the face.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from fegear.case.part import Angle, Length, Number, Part, PositiveLength, PositiveNumber, refuse, spelt_also

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

    amount: Length | None = Field(
        default=None, description="Material removed at the end of the relief; give this or `amount_over_delta`."
    )
    amount_over_delta: Number | None = Field(
        default=None,
        description="The amount in units of Welbourn's Delta: deflection at the driver's HPSTC plus twice the largest "
        "spacing error.",
    )
    start_roll_angle: Angle | None = Field(
        default=None, description="Where the relief starts, as a roll angle of the gear; give one of the four starts."
    )
    start_radius: PositiveLength | None = Field(
        default=None, description="Where the relief starts, as a radius of the gear; give one of the four starts."
    )
    length: PositiveLength | None = Field(
        default=None, description="Length of the relief along the line of action; give one of the four starts."
    )
    normalised_length: PositiveNumber | None = Field(
        default=None, description="Length of a tip relief in L_n of TM-89901: 1 reaches from the tip to the HPSTC."
    )
    shape: Shape = Field(
        default="linear", description="How the removal grows from the start: straight, or as a parabola."
    )

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

    at_radius: PositiveLength | None = Field(
        default=None, description="Radius at which the amount is measured; without it where the involute ends."
    )

    @model_validator(mode="after")
    def _measured_at_the_tip(self) -> Self:
        if self.normalised_length is not None and self.at_radius is not None:
            raise refuse("contradicts normalised_length, which counts from the tip", "leave it out", key="at_radius")
        return self


class RootReliefPart(EndReliefPart):
    """``root = { amount, start_..., shape, end_radius }``; it ends where contact starts unless given otherwise."""

    end_radius: PositiveLength | None = Field(
        default=None, description="Radius at which the amount is measured; without it where contact starts."
    )

    @model_validator(mode="after")
    def _no_tip_measures(self) -> Self:
        if self.normalised_length is not None:
            raise refuse("is a measure of tip relief", "give start_radius or length", key="normalised_length")
        return self


class CrowningPart(Part):
    """``crowning = { amount, start_radius, end_radius }``; over the active profile unless given otherwise."""

    amount: Length = Field(description="Material removed at both ends of the crowned profile.")
    start_radius: PositiveLength | None = Field(
        default=None, description="Lower end of the crowned profile; without it that of the active profile."
    )
    end_radius: PositiveLength | None = Field(
        default=None, description="Upper end of the crowned profile; without it that of the active profile."
    )


class ReliefTablePart(Part):
    """``table = { roll_angles | radii, removals }`` or ``{ file }``, and how to interpolate."""

    roll_angles: Annotated[list[Angle], Field(min_length=2)] | None = Field(
        default=None, description="Roll angles of the table, rising; give these or `radii`, with `removals`."
    )
    radii: Annotated[list[PositiveLength], Field(min_length=2)] | None = Field(
        default=None, description="Radii of the table, rising; give these or `roll_angles`, with `removals`."
    )
    removals: Annotated[list[Length], Field(min_length=2)] | None = Field(
        default=None,
        description="Material removed at each place of the table; held at its first and last value beyond them.",
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `roll_angle [deg]` or `radius [mm]` and `relief [um]`, such as a table "
        "`relief_<pair>_<gear>` of an earlier run.",
    )
    interpolation: Literal["linear", "cubic"] = Field(
        default="linear", description="What lies between the entries: straight lines, or a cubic spline."
    )

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

    tip: Annotated[list[TipReliefPart], several(TipReliefPart)] = Field(
        default_factory=list, description="Tip relief: a table, or a list of several that add up."
    )
    root: Annotated[list[RootReliefPart], several(RootReliefPart)] = Field(
        default_factory=list, description="Root relief: a table, or a list of several that add up."
    )
    crowning: Annotated[list[CrowningPart], several(CrowningPart)] = Field(
        default_factory=list, description="Profile crowning: a table, or a list of several that add up."
    )
    table: Annotated[list[ReliefTablePart], several(ReliefTablePart)] = Field(
        default_factory=list,
        description="Removal by a table over roll angle or radius, or a list of several that add up.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not (self.tip or self.root or self.crowning or self.table):
            raise refuse("removes nothing", "give tip, root, crowning or table, or leave relief out", value="{}")
        return self


class SpacingErrorsPart(Part):
    """``spacing_errors = [...]`` or ``{ file = "errors.csv" }``: one error for each tooth in the order of meshing."""

    model_config = spelt_also(lambda table: table["properties"]["values"])

    values: Annotated[list[Length], Field(min_length=1)] | None = Field(
        default=None, description="One error for each tooth, in the order of meshing."
    )
    file: str | None = Field(
        default=None, description="CSV file with a column `spacing_error [um]`, one line for each tooth."
    )

    @model_validator(mode="before")
    @classmethod
    def _list_alone(cls, value: Any) -> Any:
        return {"values": value} if isinstance(value, list) else value

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.values is None) == (self.file is None):
            raise refuse("must be one error for each tooth, as a list or in a file", key="values")
        return self


class LeadEndReliefPart(Part):
    """``end_relief = { amount, length, end, shape }``: of end I (-b/2), end II (+b/2), or both."""

    amount: Length = Field(description="Material removed at the end of the face.")
    length: PositiveLength = Field(description="Length of the relief along the face.")
    end: Literal["I", "II", "both"] = Field(
        default="both", description="Which end is relieved: I at -b/2, II at +b/2, or both."
    )
    shape: Shape = Field(
        default="linear", description="How the removal grows toward the end: straight, or as a parabola."
    )


class LeadPart(Part):
    """``lead = { crowning, slope, end_relief, file }``: over the gear's own face, the same at every height.

    ``crowning`` is removed at both ends, ``slope`` at end II; ``file`` has the columns ``z`` and ``removal``.
    """

    crowning: Length = Field(default=0.0, description="C_beta: a parabola over the face, removed at both ends.")
    slope: Length = Field(
        default=0.0, description="C_Hbeta, helix correction: nothing at end I, all of it removed at end II."
    )
    end_relief: Annotated[list[LeadEndReliefPart], several(LeadEndReliefPart)] = Field(
        default_factory=list, description="Relief at the ends of the face: a table, or a list of several that add up."
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `z [mm]` from the middle of the face and `removal [um]`, straight between its "
        "entries, held beyond them.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'write lead = { crowning = "5 um" }', value="{}")
        return self


class BiasPart(Part):
    """``bias = "10 um"``, or ``{ amount, start_radius, end_radius }``; over the active profile unless given."""

    model_config = spelt_also(lambda table: table["properties"]["amount"])

    amount: Length = Field(
        description="Twist S_alpha; positive takes material from the tip at end II and from the root at end I, a "
        "quarter at each corner."
    )
    start_radius: PositiveLength | None = Field(
        default=None, description="Lower end of the twisted profile; without it that of the active profile."
    )
    end_radius: PositiveLength | None = Field(
        default=None, description="Upper end of the twisted profile; without it that of the active profile."
    )

    @model_validator(mode="before")
    @classmethod
    def _amount_alone(cls, value: Any) -> Any:
        return value if isinstance(value, (dict, BiasPart)) else {"amount": value}


class TopographyPart(Part):
    """``topography = { file }``: columns ``roll_angle`` or ``radius``, ``z`` and ``removal`` on a full grid."""

    file: str = Field(
        description="CSV file with `roll_angle [deg]` or `radius [mm]`, `z [mm]` and `removal [um]`, every roll "
        "angle at every height once; bilinear between them, held beyond them."
    )


class MeasuredPart(Part):
    """``measured = { profile, lead }`` or ``{ topography }``: flanks as measured, in the place of the drawn ones.

    What is drawn (`relief`, `lead`) remains the design that the deviations are counted from.
    """

    profile: str | None = Field(
        default=None,
        description="CSV file of profile traces: `radius [mm]`, `roll_angle [deg]` or `roll_length [mm]`, "
        "`deviation [um]`, positive for more material than the involute, and `tooth` where there are several.",
    )
    lead: str | None = Field(
        default=None,
        description="CSV file of helix traces: `z [mm]` from the middle of the face, toward end II, `deviation [um]`, "
        "and `tooth`.",
    )
    topography: str | None = Field(
        default=None,
        description="CSV file of whole flanks: a profile's column, `z [mm]`, `deviation [um]`, and `tooth`, on a full "
        "grid; it stands for profile and lead.",
    )
    filter: bool = Field(
        default=True,
        description="Whether the Gaussian filter of ISO 1328-1 takes out what is shorter than a thirtieth of the "
        "evaluation length.",
    )
    profile_range: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = Field(
        default=None,
        description="Radii between which profiles are evaluated; without it 95 % of the way from where contact starts "
        "to where the involute ends.",
    )
    lead_range: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = Field(
        default=None,
        description="Heights between which helices are evaluated; without it the face without 5 %, at most a module, "
        "at either end.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if self.topography is not None and (self.profile or self.lead):
            raise refuse("contradicts profile and lead", "give the whole flank or traces", key="topography")
        if not (self.topography or self.profile or self.lead):
            raise refuse("names no file", 'write measured = { profile = "profile.csv" }', value="{}")
        for key in ("profile_range", "lead_range"):
            ends = getattr(self, key)
            if ends is not None and not ends[0] < ends[1]:
                raise refuse("must rise from its first to its last place", key=key, value="(a list)")
        return self
