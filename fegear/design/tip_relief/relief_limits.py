"""What a tip relief to be found may be: which gears have one, and the largest amounts and lengths."""

from __future__ import annotations

import math
from dataclasses import dataclass

#: Shortest relief that is tried, over the path of contact.
SHORTEST = 0.02
#: A number is at its limit within this part of it: searches end that close to it.
_AT_LIMIT = 1e-4


@dataclass(frozen=True)
class ReliefLimits:
    """Largest amounts and lengths of the tip reliefs of driver and driven gear.

    Parameters
    ----------
    amounts : tuple of float
        [m]; zero for a gear that has no relief.
    lengths : tuple of float
        Over the path of contact, positive.
    """

    amounts: tuple[float, float] = (math.inf, math.inf)
    lengths: tuple[float, float] = (math.inf, math.inf)

    @property
    def alike(self) -> bool:
        """Whether both gears have the same."""
        return self.amounts[0] == self.amounts[1] and self.lengths[0] == self.lengths[1]

    def active(self, gear: int, amount: float, length: float) -> tuple[bool, bool]:
        """Whether amount [m] and length over the path of a relief are at their limits; none is not.

        Parameters
        ----------
        gear : int
            0: driver, 1: driven gear.
        amount, length : float
        """
        if amount <= 0.0:
            return False, False
        most = 1.0 - _AT_LIMIT
        return amount >= most * self.amounts[gear], length >= most * self.lengths[gear]
