"""Basic rating life of rolling bearings: ISO 281:2007, Clauses 5 to 7.

L_10 = (C/P)^p million revolutions, p = 3 for balls and 10/3 for rollers, P = X F_r + Y F_a, and P = F_r where the axial
force is no more than e times the radial one (of two rows, see `axial_factors`). The factors are those of a catalogue,
or of what rolls in the bearing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fegear.base.errors import RangeError
from fegear.base.given import given
from fegear.shafts.axial_factors import LEAST_LIMIT, AxialFactors

#: p.
EXPONENT = {"ball": 3.0, "roller": 10.0 / 3.0}


@dataclass(frozen=True)
class LifeRating:
    """What a catalogue says of a bearing's life.

    Parameters
    ----------
    axial : AxialFactors, optional
        What X, Y and e follow from, in place of constants.

    Raises
    ------
    RangeError
        If a value is negative, or the rating is not positive.
    """

    dynamic_rating: float = given("force", "Basic dynamic load rating C.", above=0.0)
    kind: Literal["ball", "roller"] = given(meaning="Life exponent p, 3 or 10/3.", default="ball")
    radial_factor: float = given(meaning="Factor X for F_a/F_r above e.", default=1.0, at_least=0.0)
    axial_factor: float = given(meaning="Factor Y for F_a/F_r above e.", default=0.0, at_least=0.0)
    limit: float = given(meaning="Limit e of F_a/F_r up to which P = F_r.", default=0.0, at_least=0.0)
    axial: AxialFactors | None = None

    def __post_init__(self) -> None:
        """Refuse what is no rating."""
        if not (math.isfinite(self.dynamic_rating) and self.dynamic_rating > 0.0):
            raise RangeError("dynamic_rating", self.dynamic_rating, "must be positive and finite")
        for key in ("radial_factor", "axial_factor", "limit"):
            if not getattr(self, key) >= 0.0:
                raise RangeError(key, getattr(self, key), "must not be negative")

    def equivalent_load(self, radial: float, axial: float) -> float:
        """P [N]."""
        radial, axial = abs(radial), abs(axial)
        if self.axial is not None:
            return self.axial.equivalent_load(radial, axial)
        x, y, e = self.radial_factor, self.axial_factor, self.limit
        return radial if axial <= e * radial else x * radial + y * axial

    def overlooks(self, radial: float, axial: float) -> bool:
        """Whether P lacks an axial force that every ball bearing would feel, for want of factors."""
        known = self.axial.rated if self.axial else bool(self.axial_factor)
        return not known and abs(axial) > LEAST_LIMIT * abs(radial)

    def revolutions(self, radial: float, axial: float) -> float:
        """L_10 in revolutions; infinite without load."""
        load = self.equivalent_load(radial, axial)
        return 1e6 * (self.dynamic_rating / load) ** EXPONENT[self.kind] if load > 0.0 else math.inf
