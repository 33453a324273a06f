"""Places along the face in a gear body whose web is inclined: those of the rim, carried inward along the web."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array

#: How far apart the lengths of rim and hub beside a web's end may be for one to stand for the other.
_ALIKE = 4.0


@dataclass(frozen=True, slots=True)
class BodyAlong:
    """Web and hub in places that follow the web inward: those of the rim, whatever the inclination.

    A point of the web has the place at which the inclined line through it meets the rim, and a point of the hub under
    the web likewise. Beside the web, hub and rim share their polynomials, so that the hub's places there are its own
    ones drawn together or apart.

    Parameters
    ----------
    web, hub : (float, float)
        From where to where they are material.
    shift : float
        How far the web's end at the hub lies from that at the rim along the face.
    stretch : (float, float)
        Length of the hub over that of its places, before the web and behind it.
    """

    web: tuple[float, float]
    hub: tuple[float, float]
    shift: float = 0.0
    stretch: tuple[float, float] = (1.0, 1.0)

    @property
    def spans(self) -> tuple[tuple[float, float], ...]:
        """What rim (all of the face), web and hub fill."""
        return (-math.inf, math.inf), self.web, self.hub

    @property
    def ends(self) -> tuple[float, ...]:
        """Where web and hub end."""
        return *self.web, *self.hub

    @property
    def inclined(self) -> bool:
        """Whether places of the hub differ from those along the face."""
        return self.shift != 0.0

    def stretched(self, place: Array) -> Array:
        """Length of the hub over that of its places, shape of `place`; that behind a place where it changes."""
        return np.select([place < self.web[0], place >= self.web[1]], self.stretch, 1.0)

    def in_hub(self, place: Array) -> Array:
        """Where along the face places of the hub are, shape of `place`."""
        low, high = self.web
        beside = self.stretch[0] * np.minimum(place - low, 0.0) + self.stretch[1] * np.maximum(place - high, 0.0)
        return np.asarray(np.clip(place, low, high) + beside + self.shift)

    def of_hub(self, height: Array) -> Array:
        """The other way round: places of the hub at heights along the face."""
        (low, high), place = self.web, height - self.shift
        before, behind = np.minimum(place - low, 0.0), np.maximum(place - high, 0.0)
        return np.asarray(np.clip(place, low, high) + before / self.stretch[0] + behind / self.stretch[1])


def body_along(web: tuple[float, float], hub: tuple[float, float], shift: float, width: float) -> BodyAlong:
    """Where web and hub lie in places that follow the web inward.

    Parameters
    ----------
    web, hub : (float, float)
        The parts of the face that they fill, the web where it meets the rim.
    shift : float
        How far its end at the hub lies from there; without one all places are those along the face.
    width : float
        Of the face.
    """
    if not shift:
        return BodyAlong(web, hub)
    (low, high), (begin, stop), half = web, hub, 0.5 * width
    real = low + shift - begin, stop - high - shift
    own = _beside(low - begin, real[0], low + half), _beside(stop - high, real[1], half - high)
    before, behind = (length / place if place > 0.0 else 1.0 for length, place in zip(real, own, strict=True))
    return BodyAlong(web, (low - own[0], high + own[1]), shift, (before, behind))


def _beside(own: float, real: float, room: float) -> float:
    """How long the hub's places are beside a web's end: as those of a straight web unless they differ much.

    `own` is how far the hub reaches beyond the web's end at the rim, `real` beyond that at the hub, `room` the face.
    """
    if real <= 0.0:
        return 0.0
    return min(own if real <= _ALIKE * own <= _ALIKE**2 * real else real, room)
