"""What a shaft is made of against yielding: what a plan of any case may load, for a shaft of a case has its keys."""

from __future__ import annotations

from dataclasses import dataclass

from fegear.base.given import given


@dataclass(frozen=True, slots=True)
class ShaftStrength:
    """Yield strength of a shaft and the safety that is asked for.

    The default is that of S355, the steel of EN 10025-2 (Table 7) of 200 to 250 mm: thinner ones have more.
    """

    yield_strength: float = given(
        "pressure", "Yield strength R_e or R_p0.2 of the shaft; the default is that of S355 up to 250 mm (EN 10025-2).",
        default=275e6, above=0.0,
    )  # fmt: skip
    safety_yield: float = given(
        meaning="Minimum safety factor against yielding by nominal stress (without notches) at K_A times the load.",
        default=1.2, above=0.0,
    )  # fmt: skip
