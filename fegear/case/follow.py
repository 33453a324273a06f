"""``[transmissibility.NAME.follow]``: parameters over which the modes of a helical pair are followed."""

from __future__ import annotations

from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from fegear.case.part import Angle, Number, Part, PositiveStiffness, at_most, refuse

_Count = Annotated[int, Field(ge=2, le=10_000)]
_MOST = at_most(24, "responses")


class _Range(Part):
    """What all ranges share."""

    count: _Count = Field(default=61, description="Values in the range.")
    spacing: Literal["linear", "logarithmic"] = Field(default="linear", description="How the values are spaced.")

    @property
    def ends(self) -> tuple[float, float]:
        """Start and stop in SI."""
        return getattr(self, "start"), getattr(self, "stop")  # noqa: B009  (fields of what derives from this)

    @model_validator(mode="after")
    def _rising(self) -> Self:
        start, stop = self.ends
        if stop <= start:
            raise refuse("must be greater than start", key="stop")
        if self.spacing == "logarithmic" and start <= 0.0:
            raise refuse("must be greater than zero on a logarithmic scale", key="start")
        return self

    @property
    def array(self) -> NDArray[np.float64]:
        """All values, rising."""
        space = np.linspace if self.spacing == "linear" else np.geomspace
        return np.asarray(space(*self.ends, self.count))


class NumbersPart(_Range):
    """``{ start, stop, count, spacing, responses }`` of a plain number."""

    start: Number = Field(description="First value.")
    stop: Number = Field(description="Last value.")
    responses: Annotated[list[Number], _MOST] = Field(
        default_factory=list, description="Values at which the frequency response is drawn."
    )


class AnglesPart(_Range):
    """The same of an angle."""

    start: Angle = Field(description="First angle.")
    stop: Angle = Field(description="Last angle.")
    responses: Annotated[list[Angle], _MOST] = Field(
        default_factory=list, description="Angles at which the frequency response is drawn."
    )


class StiffnessesPart(_Range):
    """The same of a stiffness."""

    start: PositiveStiffness = Field(description="First stiffness.")
    stop: PositiveStiffness = Field(description="Last stiffness.")
    responses: Annotated[list[PositiveStiffness], _MOST] = Field(
        default_factory=list, description="Stiffnesses at which the frequency response is drawn."
    )


class FactorsPart(_Range):
    """The same of a factor, which is not negative."""

    start: Annotated[Number, Field(ge=0.0)] = Field(description="First factor.")
    stop: Number = Field(description="Last factor.")
    responses: Annotated[list[Annotated[Number, Field(ge=0.0)]], _MOST] = Field(
        default_factory=list, description="Factors at which the frequency response is drawn."
    )


class FollowPart(Part):
    """Ranges by parameter; `bearing_stiffness` is a factor of all bearing stiffnesses of the case."""

    alpha_y: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_y`.")
    alpha_z: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_z`.")
    alpha_theta: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.alpha_theta`.")
    aspect_ratio: NumbersPart | None = Field(default=None, description="Range of `unity_ratio.aspect_ratio`.")
    bearing_stiffness: FactorsPart | None = Field(
        default=None, description="Range of a factor of all bearing stiffnesses."
    )
    base_helix_angle: AnglesPart | None = Field(default=None, description="Range of the base helix angle.")
    kappa: NumbersPart | None = Field(
        default=None, description="Range of kappa; it takes mu along where the case leaves mu out."
    )
    mu: NumbersPart | None = Field(default=None, description="Range of mu.")
    mesh_stiffness: StiffnessesPart | None = Field(default=None, description="Range of the mesh stiffness K_M.")

    @model_validator(mode="after")
    def _something(self) -> Self:
        if not self.ranges:
            raise refuse(
                "names no parameter", 'write base_helix_angle = { start = "0 deg", stop = "40 deg" }', value="(empty)"
            )
        return self

    @property
    def ranges(self) -> dict[str, NumbersPart | FactorsPart | AnglesPart | StiffnessesPart]:
        """What is given, by parameter."""
        return {key: getattr(self, key) for key in type(self).model_fields if getattr(self, key) is not None}
