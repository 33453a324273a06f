"""What a catalogue prints of a bearing: what a plan of any case may load, for tables of a case have its keys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from fegear.base.errors import RangeError
from fegear.base.given import given

Kind = Literal["ball", "cylindrical", "tapered", "spherical"]


@dataclass(frozen=True)
class PrintedBearing:
    """Envelope and load ratings of a bearing of one row, or of a spherical roller bearing of two.

    Raises
    ------
    RangeError
        If the dimensions leave no bearing.
    """

    kind: Kind = given(
        meaning="Deep groove or angular contact ball, cylindrical, tapered or spherical roller bearing (of two rows)."
    )
    bore: float = given("length", "Bore d.", above=0.0)
    outside_diameter: float = given("length", "Outside diameter D.", above=0.0)
    width: float = given("length", "Width B (of the inner ring).", above=0.0)
    dynamic_rating: float | None = given("force", "Basic dynamic load rating C.", default=None, above=0.0)
    static_rating: float | None = given("force", "Basic static load rating C_0.", default=None, above=0.0)
    contact_angle: float | None = given(
        "angle",
        "Contact angle, positive if axial load towards +z is supported (by spherical ones either way).",
        default=None,
    )
    clearance: float = given("length", "Diametral clearance in operation; preload if negative.", default=0.0)

    def __post_init__(self) -> None:
        """Refuse what is no envelope."""
        if not 0.0 < self.bore < self.outside_diameter:
            raise RangeError(
                "outside_diameter", f"{self.outside_diameter * 1e3:.6g} mm",
                f"must be larger than the bore of {self.bore * 1e3:.6g} mm", "correct one of them",
            )  # fmt: skip
        if not self.width > 0.0:
            raise RangeError("width", f"{self.width * 1e3:.6g} mm", "must be positive")
