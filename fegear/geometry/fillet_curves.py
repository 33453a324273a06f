"""Curves of fillets that no tool generates: splines, ellipses and circular arcs between root circle and flank.

All are right fillets in the tooth's frame, as the pieces of `fegear.geometry.curves`. An ellipse stands on the centre
line of the tooth space; so that both frames are one reflection apart, a point X beside and Y along that line is

    x = Y sin(pi/z) - X cos(pi/z),    y = Y cos(pi/z) + X sin(pi/z).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.geometry.curves import Arc, Curve, smooth_pieces

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

#: Degree of splines: their curvature is smooth, which the stress along a fillet follows.
DEGREE = 5


class _ByDerivatives(ABC):
    """A curve that is known by its point and the derivatives of it."""

    __slots__ = ()

    #: 1 where the material lies on the left of the curve (external teeth), -1 on the right (internal ones).
    side: int

    @abstractmethod
    def derivative(self, parameter: Array, order: int) -> Array:
        """Point (order 0) or derivatives by the parameter, shape (2, ...)."""

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""
        return self.derivative(np.asarray(parameter, dtype=float), 0)

    def normals(self, parameter: ArrayLike) -> Array:
        """Unit normals out of the material, shape (2, N)."""
        dx, dy = self.derivative(np.asarray(parameter, dtype=float), 1)
        return self.side * np.stack([dy, -dx]) / np.hypot(dx, dy)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Curvature [1/modules], shape (N,); negative where the fillet is hollow."""
        u = np.asarray(parameter, dtype=float)
        (dx, dy), (ddx, ddy) = self.derivative(u, 1), self.derivative(u, 2)
        return np.asarray(self.side * (dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3)

    def speed(self, parameter: ArrayLike) -> Array:
        """Arc length per parameter [modules], shape (N,)."""
        return np.asarray(np.hypot(*self.derivative(np.asarray(parameter, dtype=float), 1)))


@dataclass(frozen=True, slots=True)
class SplineFillet(_ByDerivatives):
    """A B-spline.

    Parameters
    ----------
    knots : tuple of float
    control : tuple of (float, float)
        [modules].
    side : {1, -1}
        1 on an external tooth, -1 on an internal one.
    degree : int
    """

    knots: tuple[float, ...]
    control: tuple[tuple[float, float], ...]
    side: int = 1
    degree: int = DEGREE

    @property
    def start(self) -> float:
        """On the root circle."""
        return self.knots[self.degree]

    @property
    def end(self) -> float:
        """Where the flank begins."""
        return self.knots[-self.degree - 1]

    def derivative(self, parameter: Array, order: int) -> Array:
        """Point or derivatives by the parameter."""
        return np.moveaxis(np.asarray(_spline(self, order)(parameter)), -1, 0)


@lru_cache(maxsize=128)
def _spline(curve: SplineFillet, order: int) -> BSpline:
    from scipy.interpolate import BSpline

    whole = BSpline(np.array(curve.knots), np.array(curve.control), curve.degree)
    return whole.derivative(order) if order else whole


@dataclass(frozen=True, slots=True)
class EllipseFillet(_ByDerivatives):
    """An ellipse on the centre line of the tooth space, parameter its eccentric angle from the root circle on [rad].

    Parameters
    ----------
    half_pitch : float
        pi / z [rad].
    root_radius : float
        [modules].
    beside, along : float
        Semi-axes across and along the centre line of the space [modules].
    end : float
        Where the flank begins [rad].
    side : {1, -1}
    """

    half_pitch: float
    root_radius: float
    beside: float
    along: float
    end: float
    side: int = 1

    @property
    def start(self) -> float:
        """Zero, in the middle of the tooth space."""
        return 0.0

    def derivative(self, parameter: Array, order: int) -> Array:
        """Point or derivatives by the eccentric angle."""
        s, c = np.sin(parameter), np.cos(parameter)
        across, up = ((s, 1.0 - c), (c, s), (-s, c))[order]
        x, y = self.beside * across, self.side * self.along * up + (0.0 if order else self.root_radius)
        sa, ca = math.sin(self.half_pitch), math.cos(self.half_pitch)
        return np.stack([y * sa - x * ca, y * ca + x * sa])


@dataclass(frozen=True, slots=True)
class ArcsFillet:
    """Circular arcs that touch each other, parameter the arc length from the root circle on [modules].

    Parameters
    ----------
    arcs : tuple of Arc
        From the root circle to the flank, of negative radius: the material lies outside.
    """

    arcs: tuple[Arc, ...]

    @property
    def start(self) -> float:
        """Zero, on the root circle."""
        return 0.0

    @property
    def end(self) -> float:
        """Length of all."""
        return float(sum(self._lengths))

    @property
    def _lengths(self) -> list[float]:
        return [abs(arc.radius * (arc.end - arc.start)) for arc in self.arcs]

    @property
    def smooth_parts(self) -> tuple[Curve, ...]:
        """The arcs."""
        return self.arcs

    def _of_each(self, name: str, parameter: ArrayLike) -> Array:
        u = np.asarray(parameter, dtype=float)
        ends = np.cumsum(self._lengths)
        number, found = np.minimum(np.searchsorted(ends, u), len(self.arcs) - 1), np.zeros(u.shape)
        for n, arc in enumerate(self.arcs):
            along = u - (ends[n - 1] if n else 0.0)
            value = getattr(arc, name)(arc.start + along / abs(arc.radius) * math.copysign(1.0, arc.end - arc.start))
            found = np.where(number == n, value, found)
        return found

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""
        return self._of_each("points", parameter)

    def normals(self, parameter: ArrayLike) -> Array:
        """Unit normals out of the material, shape (2, N)."""
        return self._of_each("normals", parameter)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Curvature [1/modules]; it jumps from arc to arc."""
        return self._of_each("curvatures", parameter)

    def speed(self, parameter: ArrayLike) -> Array:
        """One."""
        return np.ones(np.shape(parameter))


@dataclass(frozen=True, slots=True)
class TurnedCurve:
    """A curve turned clockwise about the gear's centre, away from the centre line of the tooth.

    Parameters
    ----------
    curve : Curve
    angle : float
        [rad].
    """

    curve: Curve
    angle: float

    @property
    def start(self) -> float:
        """Of the curve."""
        return self.curve.start

    @property
    def end(self) -> float:
        """Of the curve."""
        return self.curve.end

    @property
    def smooth_parts(self) -> tuple[Curve, ...]:
        """Those of the curve, turned."""
        return tuple(turned_curve(part, self.angle) for part in smooth_pieces((self.curve,)))

    def _turned(self, vectors: Array) -> Array:
        s, c = math.sin(self.angle), math.cos(self.angle)
        return np.stack([c * vectors[0] + s * vectors[1], c * vectors[1] - s * vectors[0]])

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""
        return self._turned(self.curve.points(parameter))

    def normals(self, parameter: ArrayLike) -> Array:
        """Unit normals out of the material, shape (2, N)."""
        return self._turned(self.curve.normals(parameter))

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Of the curve [1/modules]."""
        return self.curve.curvatures(parameter)

    def speed(self, parameter: ArrayLike) -> Array:
        """Of the curve [modules]."""
        return self.curve.speed(parameter)


def turned_curve(curve: Curve, angle: float) -> Curve:
    """A curve turned clockwise about the gear's centre by an angle [rad]; an arc stays one."""
    if isinstance(curve, Arc):
        s, c = math.sin(angle), math.cos(angle)
        x, y = curve.centre
        return replace(curve, centre=(c * x + s * y, c * y - s * x), start=curve.start + angle, end=curve.end + angle)
    return TurnedCurve(curve, angle)
