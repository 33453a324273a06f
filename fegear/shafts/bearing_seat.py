"""Where a bearing sits: its shoulder, and the room that other bodies leave for another bearing in its place."""

from __future__ import annotations

import math
from dataclasses import dataclass

#: Diameter of a shoulder behind a bearing over the bore, at least: catalogues ask for some 1.1 to 1.2.
SHOULDER = 1.15
#: Radius from which a neighbour stays away over that of the bearing: a wall of the housing, or a gap.
_WALL = 1.05


@dataclass(frozen=True)
class Obstacle:
    """A body beside a bearing.

    Parameters
    ----------
    start, end : float
        Along the shaft, from its left end [m].
    reach : float
        Distance of the body from the axis of the bearing [m]; zero of bodies on the same shaft.
    """

    start: float
    end: float
    reach: float


@dataclass(frozen=True)
class BearingSeat:
    """The seat of a bearing.

    Parameters
    ----------
    at, length : float
        Middle of the bearing, and length of the cylinder that it sits on [m].
    shoulder : float
        Diameter of the thicker of both neighbouring sections [m]; not above the bore where there is none.
    obstacles : tuple of Obstacle
    """

    at: float = 0.0
    length: float = math.inf
    shoulder: float = 0.0
    obstacles: tuple[Obstacle, ...] = ()

    def takes_bore(self, bore: float, present: float) -> bool:
        """Whether a bore [m] needs no thicker shaft beside the seat: the present one, or one with a shoulder."""
        return bore <= present * (1.0 + 1e-6) or SHOULDER * bore <= self.shoulder * (1.0 + 1e-6)

    def has_room(self, outside_diameter: float, width: float) -> bool:
        """Whether a bearing in this place touches nothing.

        Parameters
        ----------
        outside_diameter, width : float
            [m].
        """
        low, high = self.at - 0.5 * width, self.at + 0.5 * width
        return not any(
            min(high, one.end) - max(low, one.start) > 1e-6 * width and 0.5 * _WALL * outside_diameter > one.reach
            for one in self.obstacles
        )
