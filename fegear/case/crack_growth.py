"""``[crack_growth]``: how far the cracks of a case are followed, and how fast they grow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from fegear.case.derived import keys_of
from fegear.case.part import Part, PositiveLength, PositiveNumber, refuse
from fegear.formulas.paris import ParisLaw

if TYPE_CHECKING:

    class _ParisKeys(Part, ParisLaw):  # type: ignore[misc]  # frozen by pydantic
        """Keys of the spec."""

else:
    _NONE = "no cycles are computed"
    _ParisKeys = keys_of(ParisLaw, otherwise={"paris_coefficient": _NONE, "paris_exponent": _NONE})


class CrackGrowthPart(_ParisKeys):  # type: ignore[misc]  # frozen by pydantic
    """Steps of the path, Paris' law, toughness and load spectrum."""

    step: PositiveLength | None = Field(
        default=None, description="Length of one step of the crack. Default: 0.1 modules."
    )
    steps: Annotated[int, Field(ge=1, le=200)] = Field(default=30, description="Maximum number of steps.")
    toughness: PositiveNumber | None = Field(
        default=None, description="Fracture toughness K_Ic in MPa·m^(1/2), at the largest load. Default: not checked."
    )
    load_factors: Annotated[list[PositiveNumber], Field(min_length=1, max_length=1000)] = Field(
        default_factory=lambda: [1.0],
        description="Loads of a spectrum divided by the nominal load; stress intensity is proportional to them. "
        "Default: 1.",
    )
    cycle_shares: Annotated[list[PositiveNumber], Field(min_length=1, max_length=1000)] | None = Field(
        default=None, description="Shares of the load cycles for `load_factors` (sum 1). Default: equal."
    )

    @property
    def shares(self) -> tuple[float, ...]:
        """Of the cycles, one for each load."""
        return tuple(self.cycle_shares or [1.0 / len(self.load_factors)] * len(self.load_factors))

    @property
    def law(self) -> ParisLaw | None:
        """Paris' law; None without its constants."""
        if "paris_coefficient" not in self.given:
            return None
        return ParisLaw(self.paris_coefficient, self.paris_exponent, self.threshold)

    @model_validator(mode="after")
    def _whole(self) -> Self:
        both = [key for key in ("paris_coefficient", "paris_exponent") if key in self.given]
        if len(both) == 1:
            other = "paris_exponent" if both[0] == "paris_coefficient" else "paris_coefficient"
            raise refuse(f"is required together with {both[0]}", "specify both constants of Paris' law", key=other)
        if self.threshold and not both:
            raise refuse("requires Paris' law", "set paris_coefficient and paris_exponent", key="threshold")
        if self.cycle_shares is not None:
            if len(self.cycle_shares) != len(self.load_factors):
                raise refuse(
                    f"must have one value for each of the {len(self.load_factors)} load_factors",
                    "specify one share for each load", key="cycle_shares", value=len(self.cycle_shares),
                )  # fmt: skip
            if abs(sum(self.cycle_shares) - 1.0) > 1e-6:
                raise refuse("must have the sum 1", "specify shares of all cycles", key="cycle_shares",
                             value=f"{sum(self.cycle_shares):.6g}")  # fmt: skip
        return self
