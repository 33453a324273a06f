"""``[dynamics]``: speeds, frequencies, harmonics and how to sweep."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from fegear.case.part import (
    Number,
    Part,
    PositiveNumber,
    PositiveSpeed,
    PositiveViscosity,
    at_most,
    quantity,
    refuse,
    refuse_more,
    spelt_also,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

Frequency = Annotated[float, quantity("frequency", positive=True)]


class SpeedsPart(Part):
    """``speeds = { start, stop, count }``, evenly spaced, or a list."""

    model_config = spelt_also(lambda table: table["properties"]["values"])

    values: Annotated[list[PositiveSpeed], Field(min_length=1), at_most(100_000, "speeds")] | None = None
    start: PositiveSpeed | None = None
    stop: PositiveSpeed | None = None
    count: Annotated[int, Field(ge=2, le=100_000)] | None = None

    @model_validator(mode="before")
    @classmethod
    def _list_alone(cls, value: Any) -> Any:
        return {"values": value} if isinstance(value, list) else value

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        given = [key for key in ("start", "stop", "count") if getattr(self, key) is not None]
        if self.values is not None and given:
            raise refuse("contradicts the list of values", "give either", key=given[0])
        if self.values is None and len(given) < 3:
            raise refuse(
                "is incomplete", 'write { start = "2000 rpm", stop = "16000 rpm", count = 57 }, or a list of speeds',
                value=", ".join(given) or "(not given)",
            )  # fmt: skip
        if self.start is not None and self.stop is not None and self.stop <= self.start:
            raise refuse("must be greater than start", key="stop")
        return self

    @property
    def array(self) -> NDArray[np.float64]:
        """All speeds, increasing [rad/s]."""
        if self.values is not None:
            return np.unique(np.array(self.values))
        return np.linspace(self.start or math.nan, self.stop or math.nan, self.count or 0)


class FrequenciesPart(Part):
    """``frequencies = { start, stop, count, spacing }``."""

    start: Frequency = 10.0
    stop: Frequency = 10_000.0
    count: Annotated[int, Field(ge=2, le=1_000_000)] = 1000
    spacing: Literal["linear", "logarithmic"] = "linear"

    @model_validator(mode="after")
    def _rising(self) -> Self:
        if self.stop <= self.start:
            raise refuse("must be greater than start", key="stop")
        return self

    @property
    def array(self) -> NDArray[np.float64]:
        """All of them [Hz]."""
        space = np.linspace if self.spacing == "linear" else np.geomspace
        return np.asarray(space(self.start, self.stop, self.count))


class FrictionPart(Part):
    """``friction = { law, viscosity }`` or ``{ coefficient }``."""

    law: Literal["buckingham", "benedict-kelley", "constant"] = "buckingham"
    viscosity: PositiveViscosity | None = None
    coefficient: Annotated[Number, Field(ge=0.0, le=0.5)] | None = None

    @model_validator(mode="after")
    def _what_the_law_needs(self) -> Self:
        needed = {"benedict-kelley": "viscosity", "constant": "coefficient"}.get(self.law)
        for key in ("viscosity", "coefficient"):
            given = getattr(self, key) is not None
            if key == needed and not given:
                raise refuse(f'is needed by law = "{self.law}"', f"give {key}", key=key, value="(not given)")
            if key != needed and given:
                raise refuse(f'has no meaning with law = "{self.law}"', "leave it out", key=key)
        return self


class UnequalReliefPart(Part):
    """``{ driver, driven, length }``: amounts of tip relief over Delta on the two gears, and L_n."""

    driver: Annotated[Number, Field(ge=0.0)]
    driven: Annotated[Number, Field(ge=0.0)]
    length: PositiveNumber


class DesignChartPart(Part):
    """``chart = { mesh, amounts, lengths, unequal }``: tip relief on both gears, over Delta and in L_n of TM-89901."""

    mesh: str | None = None
    amounts: Annotated[list[PositiveNumber], Field(min_length=1)]
    lengths: Annotated[list[PositiveNumber], Field(min_length=1)]
    shape: Literal["linear", "parabolic"] = "linear"
    unequal: list[UnequalReliefPart] = Field(default_factory=list, max_length=1000)

    @model_validator(mode="after")
    def _few_enough(self) -> Self:
        refuse_more(100_000, "reliefs", len(self.amounts), len(self.lengths))
        return self


class DynamicsPart(Part):
    """How the train is run; speeds are those of `speed_of`, by default the first body."""

    speed: PositiveSpeed | None = None
    speeds: SpeedsPart | None = None
    speed_of: str | None = None
    harmonics: Annotated[int, Field(ge=1, le=20_000)] = 64
    lines: Annotated[int, Field(ge=1, le=50)] = 3
    frequencies: FrequenciesPart = Field(default_factory=FrequenciesPart)
    positions: Annotated[int, Field(ge=3, le=100_000)] = 201
    direction: Literal["up", "down", "static", "rest"] = "down"
    tolerance: Annotated[Number, Field(gt=1e-12, le=1e-2)] = 5e-4
    friction: FrictionPart = Field(default_factory=FrictionPart)
    loss_taken_by: str | None = None
    chart: DesignChartPart | None = None

    @property
    def speed_values(self) -> NDArray[np.float64]:
        """All speeds of sweeps, increasing [rad/s]; the single speed where no range is given."""
        if self.speeds is not None:
            return self.speeds.array
        return np.array([] if self.speed is None else [self.speed])

    @property
    def one_speed(self) -> float:
        """The speed of histories [rad/s]: `speed`, else the single one of speeds, else nan."""
        if self.speed is not None:
            return self.speed
        values = self.speed_values
        return float(values[0]) if values.size == 1 else math.nan
