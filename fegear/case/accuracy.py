"""``[accuracy]``: a tolerance that chooses the settings, or the settings themselves."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from fegear.case.part import Number, Part, refuse


def _tolerance(value: float) -> float:
    if not 1e-6 <= value <= 0.5:
        raise refuse("must lie between 1e-6 and 0.5 (a relative error)", "1e-3 is the default", value=value)
    return value


#: In modules; the mesher never ends with shorter ones.
EdgeLength = Annotated[Number, Field(ge=1e-5, le=2.0)]


class AccuracyPart(Part):
    """Relative tolerance of the results, or explicit settings with lengths in modules (see `MeshSettings`)."""

    tolerance: Annotated[Number, AfterValidator(_tolerance)] = Field(
        default=1e-3,
        description="Relative error, 1e-6 to 0.5, to which compliances and root stresses are solved; finer settings "
        "are tried while the estimate misses it, and remarks say where it still does.",
    )
    solver: Literal["condensed", "scikit-fem"] = Field(
        default="condensed",
        description="What assembles a tooth's sector and eliminates its inner unknowns: `condensed` (nested "
        "dissection) or `scikit-fem` (its own asm, condense and solve). The numbers agree to round-off; `scikit-fem` "
        "takes several times as long.",
    )
    order: Annotated[int, Field(ge=2, le=4)] | None = Field(
        default=None, description="Polynomial order of the elements, 2 to 4; without it by the tolerance."
    )
    root_edge_length: EdgeLength | None = Field(
        default=None, description="Longest edge along the fillet, in modules; without it by the tolerance."
    )
    root_fraction: Annotated[Number, Field(ge=1e-4, le=2.0)] | None = Field(
        default=None,
        description="Longest edge along a fillet as a fraction of its radius of curvature; without it by the "
        "tolerance.",
    )
    flank_edge_length: EdgeLength | None = Field(
        default=None, description="Edges along the flank, in modules; without it by the tolerance."
    )
    tip_edge_length: EdgeLength | None = Field(
        default=None, description="Edges at the tip, in modules; without it by the tolerance."
    )
    junction_edge_length: EdgeLength | None = Field(
        default=None, description="Edges where flank and fillet meet, in modules; without it by the tolerance."
    )
    back_edge_length: EdgeLength | None = Field(
        default=None, description="Edges on the unloaded flank, in modules; without it by the tolerance."
    )
    growth: EdgeLength | None = Field(
        default=None, description="How fast edges grow away from the fillet; without it by the tolerance."
    )
    tip_growth: EdgeLength | None = Field(
        default=None, description="How fast edges grow away from the tip corner; without it by the tolerance."
    )
    side_growth: EdgeLength | None = Field(
        default=None, description="How fast edges grow away from the outline; without it by the tolerance."
    )
    body_fraction: Annotated[Number, Field(ge=1e-3, le=10.0)] | None = Field(
        default=None,
        description="Largest edge in the body as a fraction of the sector's width; without it by the tolerance.",
    )
    rim_fraction: Annotated[Number, Field(ge=1e-3, le=1.0)] | None = Field(
        default=None,
        description="Largest edge in the body as a fraction of the rim's thickness; without it by the tolerance.",
    )
    corner_distance: Annotated[Number, Field(gt=0.0, le=0.5)] | None = Field(
        default=None,
        description="Nearer to a corner of the flank the exact wedge gives c_0, and no pressure on the mesh is "
        "narrower; in modules, without it 0.006.",
    )
    patch_half_width: Annotated[Number, Field(gt=0.0, le=0.5)] | None = Field(
        default=None,
        description="Half-width of the wider of the two pressures that load the mesh, in modules; without it by the "
        "tolerance.",
    )
