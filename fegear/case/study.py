"""``[study]``: gears and load positions over which root-stress formulas are held against finite elements."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from fegear.case.part import Angle, Number, Part, PositiveNumber, refuse, refuse_more

Teeth = Annotated[list[Annotated[int, Field(ge=5, le=1000)]], Field(min_length=1)]
Numbers = Annotated[list[Number], Field(min_length=1)]
Positives = Annotated[list[PositiveNumber], Field(min_length=1)]
Angles = Annotated[list[Angle], Field(min_length=1)]
Shares = Annotated[list[Annotated[Number, Field(ge=0.0, le=1.0)]], Field(min_length=1)]

#: Lists between whose ends gears are drawn.
DRAWN = ("teeth", "profile_shift", "rack_tip_radius", "rack_dedendum", "pressure_angle", "load_position")


class StudyPart(Part):
    """Every combination of the lists is computed; a list that is not given keeps the gear's own value."""

    gear: str | None = Field(default=None, description="The gear whose tooth is varied; without it the only gear.")
    teeth: Teeth | None = Field(default=None, description="Numbers of teeth; without it the gear's own.")
    profile_shift: Numbers | None = Field(
        default=None, description="Profile shift coefficients; without it the gear's own."
    )
    rack_tip_radius: Numbers | None = Field(
        default=None, description="Tip radii of the generating rack in modules; without it the gear's own."
    )
    rack_dedendum: Positives | None = Field(
        default=None,
        description="With `samples`: dedenda of the generating rack in modules; without it the gear's own.",
    )
    pressure_angle: Angles | None = Field(
        default=None, description="With `samples`: pressure angles of the rack; without it the gear's own."
    )
    load_position: Shares = Field(
        default_factory=lambda: [0.1, 0.4, 0.7, 1.0],
        description="Where the load acts, as shares of the roll angle between start (0) and end (1) of the involute; "
        "with `samples` the first and the last, and eight loads a gear between them.",
    )
    samples: int | None = Field(
        default=None, ge=2, le=10_000,
        description="Gears drawn evenly between the first and the last value of every list, in place of every "
        "combination; draws that give no tooth are drawn anew.",
    )  # fmt: skip
    seed: int = Field(default=0, ge=0, le=2**31 - 1, description="The same seed draws the same gears.")

    @property
    def bounds(self) -> dict[str, tuple[float, float]]:
        """Lowest and highest value of what is drawn."""
        drawn = {key: getattr(self, key) for key in DRAWN}
        return {key: (float(values[0]), float(values[-1])) for key, values in drawn.items() if values}

    @model_validator(mode="after")
    def _drawn(self) -> Self:
        if self.samples is None:
            for key in ("rack_dedendum", "pressure_angle"):
                if getattr(self, key):
                    raise refuse("is for gears that are drawn", "give samples, their number", key=key)
            return self
        if "load_position" not in self.model_fields_set:
            object.__setattr__(self, "load_position", [0.0, 1.0])
        for key in DRAWN:
            values = getattr(self, key) or [0]
            if len(values) > 2 or values[0] > values[-1]:
                raise refuse("must be one value, or the lowest and the highest", "see samples", key=key)
        return self

    @model_validator(mode="after")
    def _feasible(self) -> Self:
        gears = [len(values) for values in (self.teeth, self.profile_shift, self.rack_tip_radius) if values]
        refuse_more(10_000, "gears to solve", *gears)
        refuse_more(1000, "load positions", len(self.load_position), key="load_position")
        return self
