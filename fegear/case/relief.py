"""``gear.NAME.relief`` and ``gear.NAME.spacing_errors``: what is ground off the teeth, and how unevenly they stand.

``gear.NAME.lead``, ``bias`` and ``topography``: what is ground off the flanks over the face.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.part import Angle, Length, Part, PositiveLength, refuse, several, spelt_also
from fegear.geometry.relief import Shape
from fegear.geometry.relief_spec import BiasSpec, CrowningSpec, EndReliefSpec, RootReliefSpec, TipReliefSpec

#: The ways to say where an end relief starts.
STARTS = ("start_roll_angle", "start_radius", "length", "normalised_length")


if TYPE_CHECKING:

    class _EndReliefKeys(Part, EndReliefSpec):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

    class _CrowningKeys(Part, CrowningSpec):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

    class _BiasKeys(Part, BiasSpec):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _EndReliefKeys, _CrowningKeys, _BiasKeys = keys_of(EndReliefSpec), keys_of(CrowningSpec), keys_of(BiasSpec)


class EndReliefPart(_EndReliefKeys):  # type: ignore[misc]  # frozen by pydantic
    """Tip or root relief: amount, start and shape."""

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.amount is None) == (self.amount_over_delta is None):
            raise refuse(
                "is required, or amount_over_delta",
                "Delta is the deflection at the HPSTC plus twice the spacing error (Welbourn)",
                key="amount",
            )
        given = [key for key in STARTS if getattr(self, key) is not None]
        if len(given) != 1:
            raise refuse(
                f"must be specified in exactly one way, not in {len(given)}", f"specify one of {', '.join(STARTS)}",
                key="start_radius", value=" and ".join(given) or "(not given)",
            )  # fmt: skip
        return self


if TYPE_CHECKING:

    class _TipReliefKeys(EndReliefPart, TipReliefSpec):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

    class _RootReliefKeys(EndReliefPart, RootReliefSpec):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _TipReliefKeys = keys_of(TipReliefSpec, base=EndReliefPart)
    _RootReliefKeys = keys_of(RootReliefSpec, base=EndReliefPart)


class TipReliefPart(_TipReliefKeys):  # type: ignore[misc]  # frozen by pydantic
    """``tip = { amount, start_roll_angle | start_radius | length | normalised_length, shape, at_radius }``."""

    @model_validator(mode="after")
    def _measured_at_the_tip(self) -> Self:
        if self.normalised_length is not None and self.at_radius is not None:
            raise refuse("contradicts normalised_length (measured from the tip)", "remove it", key="at_radius")
        return self


class RootReliefPart(_RootReliefKeys):  # type: ignore[misc]  # frozen by pydantic
    """``root = { amount, start_..., shape, end_radius }``; it ends where contact starts unless given otherwise."""

    @model_validator(mode="after")
    def _no_tip_measures(self) -> Self:
        if self.normalised_length is not None:
            raise refuse("applies to tip relief only", "specify start_radius or length", key="normalised_length")
        return self


class CrowningPart(_CrowningKeys):  # type: ignore[misc]  # frozen by pydantic
    """``crowning = { amount, start_radius, end_radius }``; over the active profile unless given otherwise."""


class ReliefTablePart(Part):
    """``table = { roll_angles | radii, removals }`` or ``{ file }``, and how to interpolate."""

    roll_angles: Annotated[list[Angle], Field(min_length=2)] | None = Field(
        default=None, description="Roll angles of the table, increasing; alternatively `radii`."
    )
    radii: Annotated[list[PositiveLength], Field(min_length=2)] | None = Field(
        default=None, description="Radii of the table, increasing; alternatively `roll_angles`."
    )
    removals: Annotated[list[Length], Field(min_length=2)] | None = Field(
        default=None,
        description="Amount of modification at each point of the table; constant beyond its ends.",
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `roll_angle [deg]` or `radius [mm]` and `relief [um]`, such as a table "
        "`relief_<pair>_<gear>` of an earlier run.",
    )
    interpolation: Literal["linear", "cubic"] = Field(
        default="linear", description="Interpolation: linear or cubic spline."
    )

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        inline = [key for key in ("roll_angles", "radii", "removals") if getattr(self, key) is not None]
        if self.file is not None and inline:
            raise refuse(f"contradicts {inline[0]}", "specify either the file or the lists", key="file")
        if self.file is None and (self.removals is None or len(inline) != 2):
            raise refuse(
                "is incomplete", "specify removals with either roll_angles or radii, or a file", key="removals",
                value=", ".join(inline) or "(not given)",
            )  # fmt: skip
        places = self.roll_angles or self.radii or []
        if self.removals is not None and len(places) != len(self.removals):
            raise refuse(f"has {len(self.removals)} entries for {len(places)} places", key="removals", value="(a list)")
        return self


class ReliefPart(Part):
    """Profile modification of every tooth of a gear; parts of any kind add up."""

    tip: Annotated[list[TipReliefPart], several(TipReliefPart)] = Field(
        default_factory=list, description="Tip relief: a table, or a list of tables (summed)."
    )
    root: Annotated[list[RootReliefPart], several(RootReliefPart)] = Field(
        default_factory=list, description="Root relief: a table, or a list of tables (summed)."
    )
    crowning: Annotated[list[CrowningPart], several(CrowningPart)] = Field(
        default_factory=list, description="Profile crowning: a table, or a list of tables (summed)."
    )
    table: Annotated[list[ReliefTablePart], several(ReliefTablePart)] = Field(
        default_factory=list,
        description="Modification as a table over roll angle or radius, or a list of tables (summed).",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not (self.tip or self.root or self.crowning or self.table):
            raise refuse("is empty", "specify tip, root, crowning or table, or remove relief", value="{}")
        return self


class SpacingErrorsPart(Part):
    """``spacing_errors = [...]`` or ``{ file = "errors.csv" }``: one error for each tooth in the order of meshing."""

    model_config = spelt_also(lambda table: table["properties"]["values"])

    values: Annotated[list[Length], Field(min_length=1)] | None = Field(
        default=None, description="Cumulative pitch deviation of each tooth, in meshing order."
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
            raise refuse("must be one value for each tooth, as a list or in a file", key="values")
        return self


class LeadEndReliefPart(Part):
    """``end_relief = { amount, length, end, shape }``: of end I (-b/2), end II (+b/2), or both."""

    amount: Length = Field(description="Amount of end relief.")
    length: PositiveLength = Field(description="Length of the end relief along the face width.")
    end: Literal["I", "II", "both"] = Field(default="both", description="Relieved end: I (-b/2), II (+b/2) or both.")
    shape: Shape = Field(default="linear", description="Shape of the end relief: linear or parabolic.")


class LeadPart(Part):
    """``lead = { crowning, slope, end_relief, file }``: over the gear's own face, the same at every height.

    ``crowning`` is removed at both ends, ``slope`` at end II; ``file`` has the columns ``z`` and ``removal``.
    """

    crowning: Length = Field(default=0.0, description="Lead crowning C_beta (parabolic).")
    slope: Length = Field(
        default=0.0, description="Helix slope modification C_Hbeta: zero at end I, full amount at end II."
    )
    end_relief: Annotated[list[LeadEndReliefPart], several(LeadEndReliefPart)] = Field(
        default_factory=list, description="End relief: a table, or a list of tables (summed)."
    )
    file: str | None = Field(
        default=None,
        description="CSV file with `z [mm]` from mid-face and `removal [um]`; linear interpolation, constant beyond "
        "its ends.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.model_fields_set:
            raise refuse("is empty", 'set lead = { crowning = "5 um" }', value="{}")
        return self


class BiasPart(_BiasKeys):  # type: ignore[misc]  # frozen by pydantic
    """``bias = "10 um"``, or ``{ amount, start_radius, end_radius }``; over the active profile unless given."""

    model_config = spelt_also(lambda table: table["properties"]["amount"])

    @model_validator(mode="before")
    @classmethod
    def _amount_alone(cls, value: Any) -> Any:
        return value if isinstance(value, (dict, BiasPart)) else {"amount": value}


class TopographyPart(Part):
    """``topography = { file }``: columns ``roll_angle`` or ``radius``, ``z`` and ``removal`` on a full grid."""

    file: str = Field(
        description="CSV file with `roll_angle [deg]` or `radius [mm]`, `z [mm]` and `removal [um]` on a full grid; "
        "bilinear interpolation, constant beyond its ends."
    )


class MeasuredPart(Part):
    """``measured = { profile, lead }`` or ``{ topography }``: flanks as measured, in the place of the drawn ones.

    What is drawn (`relief`, `lead`) remains the design that the deviations are counted from.
    """

    profile: str | None = Field(
        default=None,
        description="CSV file of profile traces: `radius [mm]`, `roll_angle [deg]` or `roll_length [mm]`, `deviation "
        "[um]`, positive for more material than the involute, and `tooth` for several teeth.",
    )
    lead: str | None = Field(
        default=None,
        description="CSV file of helix traces: `z [mm]` from mid-face towards end II, `deviation [um]`, and `tooth`.",
    )
    topography: str | None = Field(
        default=None,
        description="CSV file of complete flanks on a full grid: a profile column, `z [mm]`, `deviation [um]` and "
        "`tooth`; replaces profile and lead.",
    )
    filter: bool = Field(
        default=True,
        description="Apply the Gaussian low-pass filter of ISO 1328-1 (cut-off 1/30 of the evaluation length).",
    )
    profile_range: Annotated[list[PositiveLength], Field(min_length=2, max_length=2)] | None = Field(
        default=None,
        description="Profile evaluation range (radii). Default: 95 % of the range from start of active profile to "
        "tip form circle.",
    )
    lead_range: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = Field(
        default=None,
        description="Helix evaluation range (z). Default: face width less 5 % (at most one module) at each end.",
    )

    @model_validator(mode="after")
    def _something(self) -> Self:
        if self.topography is not None and (self.profile or self.lead):
            raise refuse("contradicts profile and lead", "specify either flanks or traces", key="topography")
        if not (self.topography or self.profile or self.lead):
            raise refuse("must have a file", 'set measured = { profile = "profile.csv" }', value="{}")
        for key in ("profile_range", "lead_range"):
            ends = getattr(self, key)
            if ends is not None and not ends[0] < ends[1]:
                shown_ends = f"{ends[0] * 1e3:g} to {ends[1] * 1e3:g} mm"
                raise refuse(
                    "must be strictly increasing", "specify its start, then its end", key=key, value=shown_ends
                )
        return self
