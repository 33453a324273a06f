"""``[accuracy]``: a tolerance that chooses the settings, or the settings themselves."""

from __future__ import annotations

from typing import Annotated

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

    tolerance: Annotated[Number, AfterValidator(_tolerance)] = 1e-3
    order: Annotated[int, Field(ge=2, le=4)] | None = None
    root_edge_length: EdgeLength | None = None
    root_fraction: Annotated[Number, Field(ge=1e-4, le=2.0)] | None = None
    flank_edge_length: EdgeLength | None = None
    tip_edge_length: EdgeLength | None = None
    junction_edge_length: EdgeLength | None = None
    back_edge_length: EdgeLength | None = None
    growth: EdgeLength | None = None
    tip_growth: EdgeLength | None = None
    side_growth: EdgeLength | None = None
    body_fraction: Annotated[Number, Field(ge=1e-3, le=10.0)] | None = None
    rim_fraction: Annotated[Number, Field(ge=1e-3, le=1.0)] | None = None
    corner_distance: Annotated[Number, Field(gt=0.0, le=0.5)] | None = None
    patch_half_width: Annotated[Number, Field(gt=0.0, le=0.5)] | None = None
