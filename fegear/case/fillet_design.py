"""``[fillet_design]``: the fillet with the minimum root stress that is to be found for a gear of a pair."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fegear.case.part import LengthOrZero, Part, PositiveLength, refuse


class FilletDesignPart(Part):
    """Which gear's fillet is to be found, what it is judged by, and the limits that it must keep."""

    pair: str | None = Field(default=None, description="Pair. Default: the only plane (2D) pair.")
    gear: str | None = Field(default=None, description="Gear of the pair. Default: its driver.")
    other_pair: str | None = Field(
        default=None,
        description="Pair that loads the other flanks of the gear (planet between sun and ring gear); of asymmetric "
        "teeth both fillets are then designed. Default: loaded as in `pair`; asymmetric teeth: only the fillet below "
        "the loaded flank.",
    )
    objective: Literal["tension", "alternating"] = Field(
        default="tension",
        description="Stress to be minimised: `tension`, maximum root stress over the mesh; `alternating`, half its "
        "range in teeth loaded on both flanks (idlers, planets).",
    )
    clearance: LengthOrZero | None = Field(
        default=None,
        description="Minimum clearance to the path of the mating tip at the root circle; decreases to zero at the "
        "start of the flank. Default: 0.02 modules.",
    )
    minimum_radius: PositiveLength | None = Field(
        default=None, description="Minimum radius of curvature of the fillet. Default: 0.1 modules."
    )
    generated: bool = Field(
        default=False,
        description="Only fillets that a rack (hob, rack-type cutter) generates; false: any, as for powder metal, "
        "moulded and wire-cut gears.",
    )
    minimum_tool_radius: PositiveLength | None = Field(
        default=None, description="Minimum radius of curvature of that rack's tip. Default: 0.1 modules."
    )
    waves: Annotated[int, Field(ge=1, le=12)] = Field(
        default=7, description="Number of waves by which the fillet may differ from an ellipse."
    )
    searches: Annotated[int, Field(ge=1, le=3)] = Field(
        default=3, description="Number of searches; the second (other start) and third (other curves) verify the first."
    )

    @model_validator(mode="after")
    def _tool(self) -> Self:
        if self.minimum_tool_radius is not None and not self.generated:
            raise refuse("requires a generated fillet", "set generated = true", key="minimum_tool_radius")
        return self
