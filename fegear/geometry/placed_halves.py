"""How the two halves of a double helical pair are placed: inputs that a case has as keys, too."""

from __future__ import annotations

from dataclasses import dataclass

from fegear.base.given import given


@dataclass(frozen=True, kw_only=True)
class PlacedHalves:
    """Fields of `fegear.contact.double_helical.double_spec.DoubleHelicalSpec` that stand in a drawing."""

    gap: float = given("length", "Axial gap between the two halves.", default=0.0, at_least=0.0)
    apex_offset: float = given(
        "length", "Axial distance of the driver's apex from the driven gear's apex as mounted, towards end II.",
        default=0.0,
    )  # fmt: skip
    stagger: float = given(
        meaning="Lead of the teeth at end II over those at end I as a fraction of the pitch, 0 to below 1.",
        default=0.0, at_least=0.0,
    )  # fmt: skip
