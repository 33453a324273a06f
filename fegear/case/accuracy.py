"""``[accuracy]``: a tolerance that chooses the settings, or the settings themselves."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from fegear.case.part import Number, Part, refuse


def _tolerance(value: float) -> float:
    if not 1e-6 <= value <= 0.5:
        raise refuse("must be a relative error between 1e-6 and 0.5", "1e-3 is the default", value=value)
    return value


#: In modules; the mesher never ends with shorter ones.
EdgeLength = Annotated[Number, Field(ge=1e-5, le=2.0)]


class AccuracyPart(Part):
    """Relative tolerance of the results, or explicit settings with lengths in modules (see `MeshSettings`)."""

    tolerance: Annotated[Number, AfterValidator(_tolerance)] = Field(
        default=1e-3,
        description="Target relative error of compliances and root stresses, 1e-6 to 0.5. The mesh is refined until "
        "the estimated error meets it; otherwise a note is issued.",
    )
    solver: Literal["condensed", "scikit-fem"] = Field(
        default="condensed",
        description="Solver of the tooth sector: `condensed` (nested dissection) or `scikit-fem` (its own asm, "
        "condense and solve). Results agree to round-off; `scikit-fem` takes several times as long.",
    )
    order: Annotated[int, Field(ge=2, le=4)] | None = Field(
        default=None, description="Polynomial order of the elements, 2 to 4. Default: chosen from the tolerance."
    )
    root_edge_length: EdgeLength | None = Field(
        default=None, description="Maximum edge length along the fillet, in modules. Default: from the tolerance."
    )
    root_fraction: Annotated[Number, Field(ge=1e-4, le=2.0)] | None = Field(
        default=None,
        description="Maximum edge length along a fillet relative to its radius of curvature. Default: from the "
        "tolerance.",
    )
    flank_edge_length: EdgeLength | None = Field(
        default=None, description="Edge length along the flank, in modules. Default: from the tolerance."
    )
    tip_edge_length: EdgeLength | None = Field(
        default=None, description="Edge length at the tip, in modules. Default: from the tolerance."
    )
    junction_edge_length: EdgeLength | None = Field(
        default=None,
        description="Edge length at the transition from flank to fillet, in modules. Default: from the tolerance.",
    )
    back_edge_length: EdgeLength | None = Field(
        default=None, description="Edge length on the unloaded flank, in modules. Default: from the tolerance."
    )
    growth: EdgeLength | None = Field(
        default=None, description="Growth rate of edge lengths away from the fillet. Default: from the tolerance."
    )
    tip_growth: EdgeLength | None = Field(
        default=None, description="Growth rate of edge lengths away from the tip corner. Default: from the tolerance."
    )
    side_growth: EdgeLength | None = Field(
        default=None,
        description="Growth rate of edge lengths away from the tooth outline. Default: from the tolerance.",
    )
    body_fraction: Annotated[Number, Field(ge=1e-3, le=10.0)] | None = Field(
        default=None,
        description="Maximum edge length in the body relative to the sector width. Default: from the tolerance.",
    )
    rim_fraction: Annotated[Number, Field(ge=1e-3, le=1.0)] | None = Field(
        default=None,
        description="Maximum edge length in the body relative to the rim thickness. Default: from the tolerance.",
    )
    corner_distance: Annotated[Number, Field(gt=0.0, le=0.5)] | None = Field(
        default=None,
        description="Distance from a flank corner below which c_0 is extrapolated with the wedge solution [modules]. "
        "Default: 0.006.",
    )
    patch_half_width: Annotated[Number, Field(gt=0.0, le=0.5)] | None = Field(
        default=None,
        description="Half-width of the wider of the two pressure patches applied to the mesh, in modules. Default: "
        "from the tolerance.",
    )
