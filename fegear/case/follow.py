"""``[transmissibility.NAME.follow]``: parameters over which the modes of a helical pair are followed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from fegear.case.part import Angle, Number, Part, PositiveStiffness, at_most, refuse

if TYPE_CHECKING:
    from numpy.typing import NDArray

_Count = Annotated[int, Field(ge=2, le=10_000)]
_MOST = at_most(24, "responses")


class _Range(Part):
    """What all ranges share."""

    count: _Count = 61
    spacing: Literal["linear", "logarithmic"] = "linear"

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

    start: Number
    stop: Number
    responses: Annotated[list[Number], _MOST] = Field(default_factory=list)


class AnglesPart(_Range):
    """The same of an angle."""

    start: Angle
    stop: Angle
    responses: Annotated[list[Angle], _MOST] = Field(default_factory=list)


class StiffnessesPart(_Range):
    """The same of a stiffness."""

    start: PositiveStiffness
    stop: PositiveStiffness
    responses: Annotated[list[PositiveStiffness], _MOST] = Field(default_factory=list)


class FactorsPart(_Range):
    """The same of a factor, which is not negative."""

    start: Annotated[Number, Field(ge=0.0)]
    stop: Number
    responses: Annotated[list[Annotated[Number, Field(ge=0.0)]], _MOST] = Field(default_factory=list)


class FollowPart(Part):
    """Ranges by parameter; `bearing_stiffness` is a factor of all bearing stiffnesses of the case."""

    alpha_y: NumbersPart | None = None
    alpha_z: NumbersPart | None = None
    alpha_theta: NumbersPart | None = None
    aspect_ratio: NumbersPart | None = None
    bearing_stiffness: FactorsPart | None = None
    base_helix_angle: AnglesPart | None = None
    kappa: NumbersPart | None = None
    mu: NumbersPart | None = None
    mesh_stiffness: StiffnessesPart | None = None

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
