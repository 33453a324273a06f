"""A family of both fillets of asymmetric teeth: the lowest line of the tooth space, where they meet, may move.

Its place beside the middle of what the tool makes is a number of the family, in modules along the root circle, positive
away from the flank that the tooth is seen from: that flank's fillet is the wider, the farther it lies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.geometry.fillet_shapes import PointsFillet

#: A step of a search, and how far that line may move at most [modules].
_STEP, _FARTHEST = 0.2, 0.6
#: How far beside a search begins for each share of the way that its flank begins deeper [modules].
_BESIDE = 0.25


class BothFillets(NamedTuple):
    """Fillets of both sides of an asymmetric tooth.

    Attributes
    ----------
    own, back : PointsFillet
        Below the flank that the tooth is seen from, and below the other one.
    """

    own: PointsFillet
    back: PointsFillet


def with_bottom(side: MovedEllipses, beside: float) -> MovedEllipses:
    """Fillets that begin so far beyond the middle of the tooth space [modules]."""
    flank = side.flank
    return replace(side, flank=replace(flank, half_pitch=flank.half_pitch + beside / flank.root_radius))


@dataclass(frozen=True)
class BothSides:
    """Fillets of both sides, which meet in the lowest line.

    Numbers are those of both `MovedEllipses`, and the place of that line.

    Parameters
    ----------
    own, back : MovedEllipses
        Below the flank that the tooth is seen from, and below the other one.
    """

    own: MovedEllipses
    back: MovedEllipses

    @property
    def spread(self) -> Array:
        """How far each number may reasonably move."""
        return np.concatenate([self.own.spread, self.back.spread, [_STEP]])

    @property
    def lower(self) -> Array:
        """Smallest numbers."""
        return np.concatenate([self.own.lower, self.back.lower, [-_FARTHEST]])

    @property
    def upper(self) -> Array:
        """Largest numbers."""
        return np.concatenate([self.own.upper, self.back.upper, [_FARTHEST]])

    def start(self, share: float, height: float) -> Array:
        """An ellipse on each side that ends in the middle of the tooth space; from another share beside it."""
        return np.concatenate([self.own.start(share, height), self.back.start(share, height), [_BESIDE * share]])

    def shape(self, numbers: Array) -> BothFillets:
        """Of both sides."""
        first, beside = self.own.count + 1, float(numbers[-1])
        return BothFillets(
            with_bottom(self.own, beside).shape(numbers[:first]),
            with_bottom(self.back, -beside).shape(numbers[first:-1]),
        )
