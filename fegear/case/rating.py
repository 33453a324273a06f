"""``[rating]``: what stands beside the rating by ISO 6336."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from fegear.case.part import Part

Beside = Literal["computed", "agma-2101"]


def _several(value: Any) -> Any:
    """Let one name stand for a list of it."""
    return (value,) if isinstance(value, str) else tuple(value) if isinstance(value, list) else value


class RatingPart(Part):
    """``[rating]``: ``beside = ["computed", "agma-2101"]``, ``reliability``.

    Formulas take milliseconds; what is computed (finite elements, load distribution) takes seconds to minutes, and is
    done where a case asks for it.
    """

    beside: Annotated[tuple[Beside, ...], BeforeValidator(_several, json_schema_input_type=Beside | list[Beside])] = (
        Field(
            default=("agma-2101",),
            description="What is evaluated in addition to ISO 6336: computed load distribution and root stress, which "
            "take seconds to minutes, and those of ANSI/AGMA 2101-D04.",
        )
    )
    reliability: Annotated[float, Field(ge=0.5, le=0.9999)] = Field(
        default=0.99, description="Reliability that ANSI/AGMA 2101 rates for; ISO 6336's stress numbers are for 0.99."
    )
