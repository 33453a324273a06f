"""The exact pieces of a generated tooth's outline, each with points, normals and curvatures.

All live in the tooth's own frame: gear centre at the origin, tooth centre line along +y, the right flank at x > 0;
lengths in modules. A piece is described on the right side; the left side is its mirror image. Every piece maps its own
parameter to arrays of shape (2, N) and runs from the tooth space toward the tooth's centre line.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.geometry.involute import polar_angle


class Drawn(Protocol):
    """A smooth piece of an outline, enough of `Curve` to draw it."""

    @property
    def start(self) -> float:
        """Parameter at the end nearer the tooth space."""

    @property
    def end(self) -> float:
        """Parameter at the end nearer the tooth's centre line."""

    def points(self, parameter: ArrayLike) -> Array:
        """Points [modules], shape (2, N)."""


class Curve(Drawn, Protocol):
    """A smooth piece of the outline with parameter running from `start` to `end`."""

    def normals(self, parameter: ArrayLike) -> Array:
        """Unit normals out of the material, shape (2, N)."""

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Curvature [1/modules], shape (N,); positive where the outline is convex, negative in the fillet."""

    def speed(self, parameter: ArrayLike) -> Array:
        """Arc length per parameter [modules], shape (N,)."""

    def __hash__(self) -> int:
        """Curves of the same data are one."""


_P = TypeVar("_P", bound=Drawn)


def smooth_pieces(pieces: Iterable[_P]) -> list[_P]:
    """The same pieces, with those parted whose curvature jumps, at their `smooth_parts`."""
    return [part for piece in pieces for part in getattr(piece, "smooth_parts", (piece,))]


@dataclass(frozen=True, slots=True)
class Involute:
    """Right involute flank, parameter roll angle t [rad] (ISO 21771, 4.3).

    t = tan(alpha) on an external flank and -tan(alpha) on an internal one, the other branch of the same curve: its
    tooth lies on the other side, and grows with the radius.

    Parameters
    ----------
    base_radius : float
        r_b [modules].
    base_half_angle : float
        psi_b, half the tooth's angle on the base circle [rad].
    start, end : float
        Roll angles between which the flank exists [rad].
    """

    base_radius: float
    base_half_angle: float
    start: float
    end: float

    def points(self, parameter: ArrayLike) -> Array:
        """r_b e(phi) + r_b t n(phi), phi = psi_b - t: unwinding the string from the base circle."""
        t = np.asarray(parameter, dtype=float)
        s, c = np.sin(self.base_half_angle - t), np.cos(self.base_half_angle - t)
        return self.base_radius * np.stack([s + t * c, c - t * s])

    def normals(self, parameter: ArrayLike) -> Array:
        """The normal is the line of action: tangent to the base circle."""
        phi = self.base_half_angle - np.asarray(parameter, dtype=float)
        return np.stack([np.cos(phi), -np.sin(phi)])

    def curvatures(self, parameter: ArrayLike) -> Array:
        """1 / (r_b t), infinite on the base circle; negative on an internal flank."""
        t = np.asarray(parameter, dtype=float)
        with np.errstate(divide="ignore"):
            return 1.0 / (self.base_radius * t)

    def speed(self, parameter: ArrayLike) -> Array:
        """ds/dt = r_b t."""
        return self.base_radius * np.abs(np.asarray(parameter, dtype=float))

    def polar(self, radius: ArrayLike) -> Array:
        """Angle from the tooth's centre line [rad] of the flank at `radius` [modules], shape of `radius`."""
        r = np.asarray(radius, dtype=float)
        roll = np.sqrt((r - self.base_radius) * (r + self.base_radius)) / self.base_radius
        return self.base_half_angle - polar_angle(math.copysign(1.0, self.end) * roll)


@dataclass(frozen=True, slots=True)
class Trochoid:
    """Right fillet, cut by the rack's tip rounding; parameter b [rad] is the angle from the rounding's lowest point.

    The rounding's centre lies u_c beside the rack tooth's centre line and v_c above the gear's pitch line (negative:
    below). In the section across the axis the rounding is (u_c + (rho / c) sin b, v_c - rho cos b), c the cosine of the
    helix angle: a circle for a spur gear, else an ellipse, stretched along the rack as all of its normal section is.
    The point at b is cut when the common normal passes through the pitch point: its direction is (c sin b, -cos b), so
    the centre then lies w(b) = -c v_c tan b + (c - 1/c) rho sin b beside the pitch point, and the gear has rolled by
    phi(b) = (w(b) - u_c) / r.

    Parameters
    ----------
    pitch_radius, rounding, centre_offset, centre_height : float
        r, rho_fP, u_c, v_c [modules]; all but rho_fP in the section across the axis.
    space_half_angle : float
        pi/z, angle between tooth and space centre lines [rad].
    start, end : float
        Range of b [rad]: 0 on the root circle, pi/2 - alpha_n where the rack's straight flank begins.
    cos_helix : float
        c, cosine of the helix angle on the reference cylinder.
    """

    pitch_radius: float
    rounding: float
    centre_offset: float
    centre_height: float
    space_half_angle: float
    start: float
    end: float
    cos_helix: float = 1.0

    @property
    def _bulge(self) -> float:
        """c - 1/c: zero, and every term with it, for a spur gear."""
        return self.cos_helix - 1.0 / self.cos_helix

    def _centre_beside(self, b: Array) -> Array:
        """w(b), the centre's distance beside the pitch point when b is cut [modules]."""
        bulge = self._bulge * self.rounding * np.sin(b)
        return np.asarray(bulge - self.cos_helix * self.centre_height * np.tan(b))

    def rolling(self, parameter: ArrayLike) -> Array:
        """Angle by which the gear has rolled when b is cut [rad]."""
        b = np.asarray(parameter, dtype=float)
        return (self._centre_beside(b) - self.centre_offset) / self.pitch_radius

    def points(self, parameter: ArrayLike) -> Array:
        """Envelope of the rounding in the gear's frame."""
        b = np.asarray(parameter, dtype=float)
        x = self._centre_beside(b) + self.rounding / self.cos_helix * np.sin(b)
        y = self.pitch_radius + self.centre_height - self.rounding * np.cos(b)
        return _mirror_turn(x, y, self.rolling(b), self.space_half_angle)

    def centres(self, parameter: ArrayLike) -> Array:
        """Centre of the rounding in the gear's frame when b is cut, shape (2, N); the fillet runs beside it."""
        b = np.asarray(parameter, dtype=float)
        y = np.broadcast_to(self.pitch_radius + self.centre_height, b.shape)
        return _mirror_turn(self._centre_beside(b), y, self.rolling(b), self.space_half_angle)

    def _stretch(self, b: Array) -> Array:
        """n = sqrt(cos^2 b + c^2 sin^2 b), one to the last bit for a spur gear."""
        return np.sqrt(1.0 - (1.0 - self.cos_helix**2) * np.sin(b) ** 2)

    def normals(self, parameter: ArrayLike) -> Array:
        """Outward normals: from the material into the rounding."""
        b = np.asarray(parameter, dtype=float)
        n = self._stretch(b)
        return _mirror_turn(-self.cos_helix * np.sin(b) / n, np.cos(b) / n, self.rolling(b), self.space_half_angle)

    def _turn_and_speed(self, parameter: ArrayLike) -> tuple[Array, Array]:
        """Turn of the tangent d(theta)/db, and ds/db [modules]."""
        b, v, r = np.asarray(parameter, dtype=float), self.cos_helix * self.centre_height, self.pitch_radius
        c, n = np.cos(b), self._stretch(b)
        bulge = self._bulge * self.rounding / r
        rolled = bulge * c - v / (r * c * c)  # d(phi)/db
        sliding = v * self.centre_height / (r * c**3) - bulge * self.centre_height
        return self.cos_helix / n**2 + rolled, n * (self.rounding * (1.0 / self.cos_helix + rolled) + sliding)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Turn of the tangent over the arc length, (c / n^2 + phi') / (ds/db); negative, for the fillet is hollow.

        For a spur gear minus one over the radius rho + v^2 / (cos b (r cos^2 b - v)) of Euler and Savary.
        """
        turn, speed = self._turn_and_speed(parameter)
        return -turn / speed

    def speed(self, parameter: ArrayLike) -> Array:
        """ds/db = n (rho / c + (rho - v / cos b) phi'): what rolls off the rounding, and the sliding about the pole."""
        return self._turn_and_speed(parameter)[1]


@dataclass(frozen=True, slots=True)
class PinionTipFillet:
    """Right fillet of an internal tooth, swept by the tip rounding of a pinion-type cutter.

    Parameter b [rad] is the angle of the rounding's normal n = (sin b, cos b) from the centre line of the cutter's
    tooth; the centre of the rounding, C, stands at the angle `centre_angle` from it. A point of the rounding cuts when
    its normal passes through the pitch point, at P = C + s n on the cutter's rolling circle; the cutter has then turned
    by phi = arg(P / i), and with it the gear by phi z0 / z. Differentiated, with g = n . P:

        d(phi)/db = -s / g,    ds'/db = rho + (1 - z0/z) s (s - rho) / g,

    s' the arc length of the fillet; no second derivative of the envelope is needed.

    Parameters
    ----------
    rolling_radius : float
        r_w0 of the cutter, in generation [modules].
    centre_distance : float
        a0, between gear and cutter [modules].
    centre_radius, centre_angle : float
        Of the rounding's centre in the cutter [modules, rad].
    rounding : float
        rho [modules].
    ratio : float
        z0 / z.
    space_half_angle : float
        pi / z, angle between tooth and space centre lines [rad].
    start, end : float
        Range of b [rad]: that of the centre on the root circle, that of the cutter's flank where the rounding ends.
    """

    rolling_radius: float
    centre_distance: float
    centre_radius: float
    centre_angle: float
    rounding: float
    ratio: float
    space_half_angle: float
    start: float
    end: float

    def _pole(self, parameter: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """b, distance s from the rounding's centre to the pole, its foot's distance g, and the cutter's turn phi."""
        b = np.asarray(parameter, dtype=float)
        across = self.centre_radius * np.sin(b - self.centre_angle)
        foot = np.sqrt((self.rolling_radius - across) * (self.rolling_radius + across))
        distance = foot - self.centre_radius * np.cos(b - self.centre_angle)
        x = self.centre_radius * math.sin(self.centre_angle) + distance * np.sin(b)
        y = self.centre_radius * math.cos(self.centre_angle) + distance * np.cos(b)
        return b, distance, foot, -np.arctan2(x, y)

    def points(self, parameter: ArrayLike) -> Array:
        """Envelope of the rounding in the gear's frame."""
        b, _, _, phi = self._pole(parameter)
        x = self.centre_radius * math.sin(self.centre_angle) + self.rounding * np.sin(b)
        y = self.centre_radius * math.cos(self.centre_angle) + self.rounding * np.cos(b)
        s, c = np.sin(phi), np.cos(phi)
        # turned back by phi, moved out to the cutter's place, and turned on with the gear
        return _mirror_turn(
            c * x + s * y, c * y - s * x + self.centre_distance, self.ratio * phi, self.space_half_angle
        )

    def normals(self, parameter: ArrayLike) -> Array:
        """Outward normals: from the material into the rounding."""
        b, _, _, phi = self._pole(parameter)
        turn = b + phi
        return _mirror_turn(-np.sin(turn), -np.cos(turn), self.ratio * phi, self.space_half_angle)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Turn of the tangent over the arc length; negative, for the fillet is hollow."""
        b, s, g, _ = self._pole(parameter)
        return -(1.0 - (1.0 - self.ratio) * s / g) / self.speed(b)

    def speed(self, parameter: ArrayLike) -> Array:
        """ds'/db: what rolls off the rounding, and the sliding about the pole [modules]."""
        _, s, g, _ = self._pole(parameter)
        return np.asarray(self.rounding + (1.0 - self.ratio) * s * (s - self.rounding) / g)


def _mirror_turn(x: Array, y: Array, phi: Array, space_half_angle: float) -> Array:
    """Bring (x, y), cut after rolling by phi beside the space's centre line, to the tooth on the space's left.

    Rolling back turns the point counterclockwise by phi; mirroring about the space's centre line puts it on the
    left tooth's right flank; turning clockwise by pi/z makes that tooth's centre line the y axis.
    """
    s, c = np.sin(phi), np.cos(phi)
    mirrored_x, turned_y = -(c * x - s * y), s * x + c * y
    sa, ca = math.sin(space_half_angle), math.cos(space_half_angle)
    return np.stack([ca * mirrored_x + sa * turned_y, ca * turned_y - sa * mirrored_x])


@dataclass(frozen=True, slots=True)
class Arc:
    """Circular arc; parameter is the angle of the radius from +y, clockwise [rad].

    Parameters
    ----------
    centre : (float, float)
        [modules].
    radius : float
        [modules]; negative where the material lies outside the arc.
    start, end : float
        Angles [rad] from which and to which the arc runs.
    """

    centre: tuple[float, float]
    radius: float
    start: float
    end: float

    def points(self, parameter: ArrayLike) -> Array:
        """Points at the angles given."""
        return np.array(self.centre).reshape(2, *[1] * np.ndim(parameter)) + self.radius * self.normals(parameter)

    def normals(self, parameter: ArrayLike) -> Array:
        """Radial directions, out of the material."""
        a = np.asarray(parameter, dtype=float)
        return math.copysign(1.0, self.radius) * np.stack([np.sin(a), np.cos(a)])

    def curvatures(self, parameter: ArrayLike) -> Array:
        """One over the radius; zero for a vanishing arc would be infinite, so such arcs are never made."""
        return np.full(np.shape(parameter), 1.0 / self.radius)

    def speed(self, parameter: ArrayLike) -> Array:
        """The radius."""
        return np.full(np.shape(parameter), abs(self.radius))


@dataclass(frozen=True, slots=True)
class Line:
    """Straight piece from `a` to `b` (a tip chamfer); parameter is the length from `a` [modules].

    The material lies on its left, or on its right if `side` is -1.
    """

    a: tuple[float, float]
    b: tuple[float, float]
    side: int = 1

    @property
    def start(self) -> float:
        """Zero."""
        return 0.0

    @property
    def end(self) -> float:
        """The length."""
        return math.dist(self.a, self.b)

    def _direction(self) -> Array:
        return (np.array(self.b) - np.array(self.a)) / self.end

    def points(self, parameter: ArrayLike) -> Array:
        """Points at the lengths given."""
        s = np.asarray(parameter, dtype=float)
        return np.multiply.outer(self._direction(), s) + np.array(self.a).reshape(2, *[1] * s.ndim)

    def normals(self, parameter: ArrayLike) -> Array:
        """The direction turned out of the material."""
        d = self._direction()
        return np.multiply.outer(self.side * np.array([d[1], -d[0]]), np.ones(np.shape(parameter)))

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Zero."""
        return np.zeros(np.shape(parameter))

    def speed(self, parameter: ArrayLike) -> Array:
        """One."""
        return np.ones(np.shape(parameter))


@dataclass(frozen=True, slots=True)
class Stretched:
    """An arc of a normal section as the transverse section shows it: part of an ellipse; parameter that of the arc.

    Parameters
    ----------
    arc : Arc
        Of the normal section.
    factor : float
        By which distances from the tooth's centre line are longer: 1 / cos(beta) of a rack.
    """

    arc: Arc
    factor: float

    @property
    def start(self) -> float:
        """Of the arc."""
        return self.arc.start

    @property
    def end(self) -> float:
        """Of the arc."""
        return self.arc.end

    @property
    def centre(self) -> tuple[float, float]:
        """Centre of the ellipse [modules]."""
        return self.factor * self.arc.centre[0], self.arc.centre[1]

    def moved(self, x: float) -> Stretched:
        """The same, farther from the tooth's centre line by a length [modules]."""
        (beside, height), arc = self.arc.centre, self.arc
        return Stretched(Arc((beside + x / self.factor, height), arc.radius, arc.start, arc.end), self.factor)

    def points(self, parameter: ArrayLike) -> Array:
        """Those of the arc, farther from the centre line."""
        x, y = self.arc.points(parameter)
        return np.stack([self.factor * x, y])

    def normals(self, parameter: ArrayLike) -> Array:
        """Out of the material."""
        x, y = self.arc.normals(parameter)
        found = np.stack([x, self.factor * y])
        return np.asarray(found / np.hypot(*found))

    def _longer(self, parameter: ArrayLike) -> Array:
        """Length along the ellipse per length along the arc."""
        x, y = self.arc.normals(parameter)
        return np.hypot(self.factor * y, x)

    def curvatures(self, parameter: ArrayLike) -> Array:
        """Of the ellipse."""
        return np.asarray(self.arc.curvatures(parameter) * self.factor / self._longer(parameter) ** 3)

    def speed(self, parameter: ArrayLike) -> Array:
        """The arc's, times by how much the ellipse is longer there."""
        return np.asarray(self.arc.speed(parameter) * self._longer(parameter))


@lru_cache(maxsize=64)
def arc_length(curve: Curve, intervals: int = 400) -> tuple[Array, Array]:
    """Parameters and arc lengths from the start of a curve, by composite Gauss quadrature of its speed.

    Found once for each curve: a mesh asks for those of its tooth some twenty times.

    Returns
    -------
    parameter, length : ndarray, shape (intervals + 1,)
        Monotone tables for interpolation, read-only; lengths in modules.
    """
    nodes, weights = np.polynomial.legendre.leggauss(4)
    u = np.linspace(curve.start, curve.end, intervals + 1)
    half = 0.5 * np.diff(u)
    mid = 0.5 * (u[1:] + u[:-1])
    pieces = (curve.speed(mid[:, None] + half[:, None] * nodes) * weights).sum(axis=1) * np.abs(half)
    length = np.concatenate([[0.0], np.cumsum(pieces)])
    u.flags.writeable = length.flags.writeable = False
    return u, length
