"""A piece of a shaft, as a drawing gives it: what a plan of any case may load, for tables of a case have its keys."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.base.errors import RangeError
from fegear.base.given import given

#: The largest ratio of diameters over one piece of a cone.
_RATIO = 1.5


@dataclass(frozen=True, slots=True)
class Section:
    """A piece of a shaft: a cylinder, or a cone where its end has other diameters than its start.

    Raises
    ------
    RangeError
        If there is no material.
    """

    length: float = given("length", "Length of the section.", above=0.0)
    outer: float = given("length", "Outer diameter at the start of the section.", above=0.0)
    inner: float = given("length", "Bore diameter at the start of the section; 0: solid.", default=0.0, at_least=0.0)
    outer_end: float | None = given(
        "length", "Outer diameter at the end of the section (conical).", default=None, above=0.0
    )
    inner_end: float | None = given(
        "length", "Bore diameter at the end of the section (conical).", default=None, at_least=0.0
    )

    def __post_init__(self) -> None:
        """Refuse pieces without length or wall."""
        for key, value in (("length", self.length), ("outer", self.outer), ("outer_end", self.ends[0][1])):
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(key, value, "must be positive and finite")
        for key, hole, around in zip(("inner", "inner_end"), self.ends[1], self.ends[0], strict=True):
            if not 0.0 <= hole < around:
                raise RangeError(
                    key, f"{hole * 1e3:.6g} mm", "leaves no wall thickness with the outer diameter of "
                                                 f"{around * 1e3:.6g} mm",
                    "specify a smaller one",
                )  # fmt: skip

    @property
    def ends(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Outer and inner diameters at start and end [m]."""
        outer = self.outer if self.outer_end is None else self.outer_end
        inner = self.inner if self.inner_end is None else self.inner_end
        return (self.outer, outer), (self.inner, inner)

    @property
    def pieces(self) -> int:
        """Pieces in which one Gauss rule is exact to round-off; zero for a prism."""
        (d0, d1), (h0, h1) = self.ends
        if d0 == d1 and h0 == h1:
            return 0
        walls = max(d0, d1) / min(d0, d1), max(d0 - h0, d1 - h1) / min(d0 - h0, d1 - h1)
        return max(1, math.ceil(math.log(max(walls)) / math.log(_RATIO)))
