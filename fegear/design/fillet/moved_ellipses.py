"""Families of fillets for a search: few numbers become a fillet across the tooth space, smooth up to its curvature.

All are ellipses that touch root circle and flank and are moved along their normals: by sine waves over their whole
length, or by local bumps. Heights and tangents at both ends stay, and with them the root circle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.geometry.fillet_shapes import EllipseOnSpace, PointsFillet
from fegear.geometry.flank_above import FlankAbove

Basis = Literal["waves", "bumps"]
#: Points by which a fillet is drawn.
DRAWN = 41
#: Share of the way to the base circle, and height of a wave or bump [modules], that are a step of a search.
_STEP_DOWN, _STEP = 0.3, 0.08


@dataclass(frozen=True)
class MovedEllipses:
    """Ellipses over the tooth space, moved along their normals.

    Parameters
    ----------
    flank : FlankAbove
        With the root circle.
    highest : float
        Largest roll angle at which the flank may begin [rad].
    basis : {"waves", "bumps"}
    count : int
        Of waves, or bumps.
    """

    flank: FlankAbove
    highest: float
    basis: Basis = "waves"
    count: int = 5

    @property
    def lower(self) -> Array:
        """Smallest numbers."""
        return np.array([0.0, *[-math.inf] * self.count])

    @property
    def upper(self) -> Array:
        """Largest numbers."""
        return np.array([1.0, *[math.inf] * self.count])

    def start(self, share: float, height: float) -> Array:
        """Numbers of an ellipse with a first wave or bump [modules]."""
        return np.array([share, height, *[0.0] * (self.count - 1)])

    @property
    def spread(self) -> Array:
        """How far each number may reasonably move."""
        if self.basis == "bumps":
            return np.array([_STEP_DOWN, *[0.25 * _STEP] * self.count])
        return np.array([_STEP_DOWN, *(_STEP / (1.0 + 0.5 * n) for n in range(self.count))])

    def _heights(self, s: Array, numbers: Array) -> Array:
        """How far the ellipse is moved at shares of it from root circle to flank [modules]."""
        if self.basis == "waves":
            waves = sum(float(height) * np.cos(n * math.pi * s) for n, height in enumerate(numbers))
            return np.asarray(16.0 * s**2 * (1.0 - s) ** 2 * waves)
        from scipy.interpolate import BSpline

        inner = np.linspace(0.0, 1.0, self.count + 2)  # what is not level at an end stays out
        knots = np.concatenate([[0.0] * 3, inner, [1.0] * 3])
        control = np.concatenate([[0.0, 0.0], numbers, [0.0, 0.0]])
        return np.asarray(BSpline(knots, control, 3)(s))

    def shape(self, numbers: Array) -> PointsFillet:
        """By the share of the way from the highest start of the flank to the base circle, and heights [modules]."""
        share, side = min(max(float(numbers[0]), 0.0), 1.0), self.flank.side
        radius = self.flank.base_radius * math.hypot(1.0, self.highest * (1.0 - side * share))
        ellipse = EllipseOnSpace(radius, self.flank.root_radius).below(self.flank).fillet
        s = np.linspace(0.0, 1.0, DRAWN)
        u = ellipse.start + s * (ellipse.end - ellipse.start)
        points = ellipse.points(u) + ellipse.normals(u) * self._heights(s, np.asarray(numbers[1:], dtype=float))
        return PointsFillet(tuple(map(tuple, points.T.tolist())))
