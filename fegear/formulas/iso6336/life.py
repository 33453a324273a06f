"""Permissible stress over load cycles as ISO 6336-2 and -3 draw it: straight between knots, both axes in logarithms."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from fegear.base.errors import RangeError

#: Load cycles at which the tables of both parts end.
LONG = 1e10


@dataclass(frozen=True, slots=True)
class Knots:
    """Load cycles and values of a polyline in logarithms; flat before the first and after the last knot.

    Parameters
    ----------
    cycles, values : tuple of float
        Rising cycles; positive values.
    """

    cycles: tuple[float, ...]
    values: tuple[float, ...]

    def at(self, cycles: float) -> float:
        """Value at a number of load cycles."""
        if not cycles > 0.0:
            raise RangeError("N_L", cycles, "must be positive")
        if cycles <= self.cycles[0]:
            return self.values[0]
        for (n_0, n_1), (y_0, y_1) in zip(
            itertools.pairwise(self.cycles), itertools.pairwise(self.values), strict=True
        ):
            if cycles <= n_1:
                part = math.log(cycles / n_0) / math.log(n_1 / n_0)
                return float(y_0 * (y_1 / y_0) ** part)
        return self.values[-1]

    @property
    def falling(self) -> Knots:
        """The same, no value above an earlier one: what breaks at few load cycles is not borne at more of them."""
        return Knots(self.cycles, tuple(itertools.accumulate(self.values, min)))

    def scaled(self, factors: tuple[float, ...]) -> Knots:
        """The same cycles, each value times its factor."""
        return Knots(self.cycles, tuple(v * f for v, f in zip(self.values, factors, strict=True)))
