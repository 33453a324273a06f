"""``[cost]``: which results ``fegear cost`` studies; without it, those that ``results`` asks for."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from fegear.case.part import Part

QuantityName = Literal[
    "c_0", "c_1", "root-stress", "te-peak-to-peak", "tooth-force", "dynamic-factor", "te-mean", "face-load-factor"
]  # fmt: skip


class CostPart(Part):
    """Which quantities of which gear and pair."""

    quantities: Annotated[list[QuantityName], Field(min_length=1)] | None = Field(
        default=None, description="What is studied; without it what `results` stands for."
    )
    gear: str | None = Field(
        default=None,
        description="The gear whose compliance and root stress are studied; without it that of `[stiffness]`, else "
        "the pair's driver.",
    )
    pair: str | None = Field(
        default=None,
        description="The pair whose transmission error and forces are studied; without it that of `[stiffness]`, "
        "else the first with a load.",
    )

    @property
    def stages(self) -> tuple[str, ...]:
        """Stages whose effects the quantities named here depend on."""
        names = set(self.quantities or ())
        of_pair = ("loaded-pair",) if names & {"te-peak-to-peak", "tooth-force", "dynamic-factor"} else ()
        of_pair = (*of_pair, "loaded-flanks") if names & {"te-mean", "face-load-factor"} else of_pair
        return (*of_pair, "motion") if "dynamic-factor" in names else of_pair
