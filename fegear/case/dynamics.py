"""``[dynamics]``: speeds, frequencies, harmonics and how to sweep."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from fegear.base.given import all_given
from fegear.case.evenly_spaced import EvenlySpaced
from fegear.case.part import (
    Number,
    Part,
    PositiveNumber,
    PositiveSpeed,
    PositiveViscosity,
    Table,
    at_most,
    quantity,
    refuse,
    refuse_more,
)
from fegear.geometry.relief import Shape
from fegear.geometry.relief_spec import EndReliefSpec

Frequency = Annotated[float, quantity("frequency", positive=True)]


class SpeedsPart(EvenlySpaced):
    """``speeds = { start, stop, count }``, evenly spaced, or a list."""

    example = 'write { start = "2000 rpm", stop = "16000 rpm", count = 57 }, or a list of speeds'

    values: Annotated[list[PositiveSpeed], Field(min_length=1), at_most(100_000, "speeds")] | None = Field(
        default=None, description="Speeds as a list (instead of the table)."
    )
    start: PositiveSpeed | None = Field(default=None, description="Minimum speed.")
    stop: PositiveSpeed | None = Field(default=None, description="Maximum speed.")
    count: Annotated[int, Field(ge=2, le=100_000)] | None = Field(
        default=None, description="Number of equally spaced speeds."
    )


class FrequenciesPart(Part):
    """``frequencies = { start, stop, count, spacing }``."""

    start: Frequency = Field(default=10.0, description="Minimum frequency.")
    stop: Frequency = Field(default=10_000.0, description="Maximum frequency.")
    count: Annotated[int, Field(ge=2, le=1_000_000)] = Field(default=1000, description="Number of frequencies.")
    spacing: Literal["linear", "logarithmic"] = Field(
        default="linear", description="Spacing of the frequencies: linear or logarithmic."
    )

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

    law: Literal["buckingham", "benedict-kelley", "constant"] = Field(
        default="buckingham", description="Friction law of the teeth."
    )
    viscosity: PositiveViscosity | None = Field(
        default=None, description="Viscosity of the oil, for `benedict-kelley`."
    )
    coefficient: Annotated[Number, Field(ge=0.0, le=0.5)] | None = Field(
        default=None, description="Coefficient of friction, for `constant`."
    )

    @model_validator(mode="after")
    def _what_the_law_needs(self) -> Self:
        needed = {"benedict-kelley": "viscosity", "constant": "coefficient"}.get(self.law)
        for key in ("viscosity", "coefficient"):
            given = getattr(self, key) is not None
            if key == needed and not given:
                raise refuse(f'is required by law = "{self.law}"', f"specify {key}", key=key, value="(not given)")
            if key != needed and given:
                raise refuse(f'is not used with law = "{self.law}"', "remove it", key=key)
        return self


class UnequalReliefPart(Part):
    """``{ driver, driven, length }``: amounts of tip relief over Delta on the two gears, and L_n."""

    driver: Annotated[Number, Field(ge=0.0)] = Field(
        description="Amount of tip relief on the driver, in units of Welbourn's Delta."
    )
    driven: Annotated[Number, Field(ge=0.0)] = Field(
        description="Amount of tip relief on the driven gear, in units of Welbourn's Delta."
    )
    length: PositiveNumber = Field(description="Normalised length L_n of both reliefs.")


class DesignChartPart(Part):
    """``chart = { mesh, amounts, lengths, unequal }``: tip relief on both gears, over Delta and in L_n of TM-89901."""

    mesh: str | None = Field(default=None, description="Mesh of the train. Default: the only mesh.")
    amounts: Annotated[list[PositiveNumber], Field(min_length=1)] = Field(
        description="Amounts of tip relief in units of Welbourn's Delta, equal on both gears."
    )
    lengths: Annotated[list[PositiveNumber], Field(min_length=1)] = Field(
        description="Normalised lengths L_n of the reliefs, from 0 (tip) to 1 (HPSTC)."
    )
    shape: Shape = Field(default="linear", description=all_given(EndReliefSpec)["shape"].meaning)
    unequal: list[UnequalReliefPart] = Field(
        default_factory=list, max_length=1000, description="Additional reliefs with a separate amount for each gear."
    )

    @model_validator(mode="after")
    def _few_enough(self) -> Self:
        refuse_more(100_000, "reliefs", len(self.amounts), len(self.lengths))
        return self


class DynamicsPart(Part):
    """How the train is run; speeds are those of `speed_of`, by default the first body."""

    speed: PositiveSpeed | None = Field(
        default=None, description="Speed for time histories and spectra. Default: the only value of `speeds`."
    )
    speeds: Table[SpeedsPart] | None = Field(
        default=None, description="Speeds of sweeps, list or range. Default: `speed`."
    )
    speed_of: str | None = Field(default=None, description="Body to which the speeds refer. Default: the first.")
    harmonics: Annotated[int, Field(ge=1, le=20_000)] = Field(
        default=64, description="Number of harmonics of each mesh; at least 256 for tooth forces."
    )
    lines: Annotated[int, Field(ge=1, le=50)] = Field(
        default=3, description="Number of mesh harmonics in the Campbell diagram."
    )
    measured_frequencies: Annotated[list[Frequency], Field(min_length=1), at_most(1000, "frequencies")] | None = Field(
        default=None,
        description="Measured natural frequencies of the train, to compare with the computed ones (`natural-modes`).",
    )
    frequencies: Table[FrequenciesPart] = Field(
        default_factory=FrequenciesPart, description="Frequencies of the dynamic increments."
    )
    determinants: bool = Field(
        default=False,
        description="Include in `dynamic-increments` the determinants of a four-square rig (Mark 2.45 to 2.59), for "
        "comparison with the elimination.",
    )
    positions: Annotated[int, Field(ge=3, le=100_000)] = Field(
        default=201, description="Number of roll positions of one tooth pair in histories."
    )
    direction: Literal["up", "down", "static", "rest"] = Field(
        default="down",
        description="Initial state at each speed: previous solution (`down`, `up`), static state or rest.",
    )
    tolerance: Annotated[Number, Field(gt=1e-12, le=1e-2)] = Field(
        default=5e-4, description="Relative error of the dynamic factor for periodic motion."
    )
    method: Literal["shooting", "averaging"] = Field(
        default="shooting",
        description="Method for the steady-state motion: Newton's method on the state after one period, or the "
        "iteration of TM-100180 (average of the states at start and end of a period). Default: shooting.",
    )
    friction: Table[FrictionPart] = Field(
        default_factory=FrictionPart, description="Tooth friction; active with the effect `friction`."
    )
    loss_taken_by: str | None = Field(
        default=None,
        description="Body whose torque compensates the friction loss. Default: `balance`, else the last torque.",
    )
    chart: Table[DesignChartPart] | None = Field(
        default=None, description="Tip reliefs to evaluate, for `design-chart`."
    )

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
