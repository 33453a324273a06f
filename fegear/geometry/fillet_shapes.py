"""Fillets as a user gives them: points, control points, an ellipse, circular arcs; each fitted below a flank.

Every shape ends on the involute and joins it, and the root circle, along their tangents within `STEEPEST_JOINT`: what
lies within is turned onto them, so that curvature stays finite. Where the fillet cuts into the involute from below, as
undercut does, the outer corner between both is kept. Lengths are in modules, in the section across the axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.curves import Arc
from fegear.geometry.fillet_curves import DEGREE, ArcsFillet, EllipseFillet, SplineFillet
from fegear.geometry.fitted_points import interpolated, smoothed
from fegear.geometry.flank_above import FlankAbove, Foot

#: Largest angle between fillet and flank, or root circle, that is taken for a tangent [rad].
STEEPEST_JOINT = math.radians(3.0)
#: How far the last point of a fillet may lie off the involute, and the first off the middle of the tooth space
#: [modules], where no scatter is given.
OFF_THE_FLANK = 2e-3
#: Fewest points of a fillet.
FEWEST_POINTS = 4


class FilletShape(Protocol):
    """A fillet before it is fitted."""

    def below(self, flank: FlankAbove) -> Foot:
        """The fillet below a flank."""

    def __hash__(self) -> int:
        """Shapes of the same numbers are one."""


@dataclass(frozen=True, slots=True)
class PointsFillet:
    """A smooth curve through points, from the root circle to the flank.

    Parameters
    ----------
    points : tuple of (float, float)
        x and y in the tooth's frame, or in that of the tooth space (`of_space`), gear centre at the origin and +y along
        the centre line; x of either sign, the points in either order [modules].
    of_space : bool
    form_radius : float, optional
        Points above it belong to the flank and are passed over [modules].
    scatter : float
        How far the curve may pass beside the points [modules]; with 0 it passes through them.
    """

    points: tuple[tuple[float, float], ...]
    of_space: bool = False
    form_radius: float | None = None
    scatter: float = 0.0

    def below(self, flank: FlankAbove) -> Foot:
        """The fillet below a flank.

        Raises
        ------
        GeometryError
            If the points are too few, double back, leave their side of the tooth space, miss the flank, or meet it or
            the root circle in a notch.
        """
        points, roll = self.up_to_the_flank(flank)
        points[:, -1] = flank.point(roll)
        land = _land(points, flank, max(self.scatter, OFF_THE_FLANK))
        free = (
            smoothed(points, (None, None), self.scatter) if self.scatter > 0.0 else interpolated(points, (None, None))
        )
        ends, corner = _directions(points, flank, roll, free.end_directions)
        found = smoothed(points, ends, self.scatter) if self.scatter > 0.0 else interpolated(points, ends)
        curve = SplineFillet(found.knots, found.control, flank.side, found.degree)
        return Foot(curve, roll, float(np.hypot(*points[:, 0])), land, corner)

    def up_to_the_flank(self, flank: FlankAbove) -> tuple[Array, float]:
        """Points in the tooth's frame from the root to the flank, and the roll angle where it begins."""
        given = np.array(self.points, dtype=float).T
        x = given[0]
        reach = max(self.scatter, OFF_THE_FLANK)
        if not (np.all(x > -reach) or np.all(x < reach)):
            raise GeometryError(
                "fillet.points", f"{x.min():.4g} to {x.max():.4g} modules", "must be on one side of the centre line",
                "specify the fillet of one flank (both fillets of a tooth are equal)",
            )  # fmt: skip
        points = np.stack([np.abs(x), given[1]])
        if self.of_space:
            points = flank.in_space(points)
        radius = flank.side * np.hypot(*points)
        if radius[-1] < radius[0]:
            points, radius = points[:, ::-1], radius[::-1]
        if self.form_radius is not None:
            roll = flank.start("fillet.form_diameter", self.form_radius)
            below = radius < flank.side * self.form_radius - 1e-9
            below &= np.cumsum(~below) == 0
            points, radius = points[:, below], radius[below]
            points = np.hstack([points, flank.point(roll)[:, None]])
            radius = np.append(radius, flank.side * self.form_radius)
        else:
            roll = self._last_on_the_flank(points[:, -1], flank)
        if points.shape[1] < FEWEST_POINTS:
            raise GeometryError(
                "fillet.points", f"{points.shape[1]} points", f"must be at least {FEWEST_POINTS} from root to flank",
                "add points",
            )  # fmt: skip
        back = np.diff(radius)
        if back.min() < -reach:
            n = int(np.argmin(back))
            raise GeometryError(
                "fillet.points", f"point {n + 2}",
                f"is {-back[n]:.3g} modules closer to the root than the point before",
                "specify the points in order from root circle to flank",
            )  # fmt: skip
        if np.hypot(*np.diff(points)).min() < 1e-6:
            raise GeometryError(
                "fillet.points", "two equal points", "must differ from each other", "remove one of them"
            )
        return points, roll

    def _last_on_the_flank(self, last: Array, flank: FlankAbove) -> float:
        """Roll angle of the last point, which must lie on the involute."""
        radius = float(np.hypot(*last))
        roll = flank.start("fillet.points", radius)
        angle = math.atan2(*flank.point(roll)) - math.atan2(*last)
        off = radius * angle * math.cos(math.atan(roll))
        limit = max(self.scatter, OFF_THE_FLANK)
        if abs(off) > limit:
            where = "inside the tooth, so the points cross the flank" if off > 0.0 else "outside the tooth"
            raise GeometryError(
                "fillet.points", "the last point", f"is {abs(off):.3g} modules {where} (limit {limit:.3g} modules)",
                "end the points on the involute, or set form_diameter",
            )  # fmt: skip
        return roll


@dataclass(frozen=True, slots=True)
class ControlFillet:
    """A clamped B-spline with given control points.

    Parameters
    ----------
    control : tuple of (float, float)
        As the points of `PointsFillet`; the first on the root circle, the last on the flank.
    of_space : bool
    """

    control: tuple[tuple[float, float], ...]
    of_space: bool = False

    def below(self, flank: FlankAbove) -> Foot:
        """The fillet below a flank; refusals as of `PointsFillet`."""
        points, roll = PointsFillet(self.control, self.of_space).up_to_the_flank(flank)
        points[:, -1] = flank.point(roll)
        land = _land(points, flank, OFF_THE_FLANK)
        legs = points[:, 1] - points[:, 0], points[:, -1] - points[:, -2]
        (first, last), corner = _directions(points, flank, roll, legs)
        if first is not None:
            points[:, 1] = points[:, 0] + first * math.dist(points[:, 0], points[:, 1])
        if last is not None:
            points[:, -2] = points[:, -1] - last * math.dist(points[:, -2], points[:, -1])
        degree = min(DEGREE, points.shape[1] - 1)
        inner = np.linspace(0.0, 1.0, points.shape[1] - degree + 1)
        knots = np.concatenate([np.zeros(degree), inner, np.ones(degree)])
        control = tuple((float(x), float(y)) for x, y in points.T)
        curve = SplineFillet(tuple(knots.tolist()), control, flank.side, degree)
        return Foot(curve, roll, float(np.hypot(*points[:, 0])), land, corner)


def _land(points: Array, flank: FlankAbove, reach: float) -> float:
    """Angle of the root land before the first point up to the middle of the space, negative beyond it [rad].

    The first point is put where the other fillet of the space ends, if it lies within a reach of it [modules].
    """
    x, y = points[:, 0]
    given, polar = math.hypot(x, y), math.atan2(x, y)
    radius = flank.at_the_bottom(given, "fillet.points", reach)
    left = flank.last - polar
    if left * radius < -reach:
        middle = "the middle of" if flank.beyond == 0.0 else "the other fillet of"
        raise GeometryError(
            "fillet.points", "the first point", f"is {-left * radius:.3g} modules beyond {middle} the tooth space",
            "start the points in the middle of the tooth space, or specify a smaller fillet",
        )  # fmt: skip
    if abs(left) * radius <= reach:
        polar = flank.last
    if polar == flank.last or radius != given:
        points[:, 0] = radius * math.sin(polar), radius * math.cos(polar)
    return flank.half_pitch - polar


def _directions(
    points: Array, flank: FlankAbove, roll: float, given: tuple[Array, Array]
) -> tuple[tuple[Array | None, Array | None], bool]:
    """Directions in which a fillet leaves the root circle and meets the flank, and whether it meets it in a corner.

    None where it ends as it comes: at the corner that undercut leaves.
    """
    first, last = given
    radial = points[:, 0] / np.hypot(*points[:, 0])
    along = np.array([-radial[1], radial[0]])
    turn = _turn(along, first) * flank.side
    if abs(turn) > STEEPEST_JOINT:
        raise GeometryError(
            "fillet.points", "the first point",
            f"meets the root circle at {math.degrees(abs(turn)):.3g} deg (limit {math.degrees(STEEPEST_JOINT):.3g} "
            "deg)", "start tangentially to the root circle, or set scatter",
        )  # fmt: skip
    tangent = flank.tangent(roll)
    turn = _turn(last, tangent) * flank.side
    if turn < -STEEPEST_JOINT:
        raise GeometryError(
            "fillet.points", "the last point",
            f"meets the flank in a notch of {math.degrees(-turn):.3g} deg (limit {math.degrees(STEEPEST_JOINT):.3g} "
            "deg)", "end tangentially to the flank, or set scatter",
        )  # fmt: skip
    corner = turn > STEEPEST_JOINT
    return (along, None if corner else tangent), corner


def _turn(a: Array, b: Array) -> float:
    """Angle from one direction to another, positive to the left [rad]."""
    return math.atan2(float(a[0] * b[1] - a[1] * b[0]), float(a @ b))


@dataclass(frozen=True, slots=True)
class EllipseOnSpace:
    """Half an ellipse across the tooth space: it touches root circle and flank, without a root land.

    Parameters
    ----------
    form_radius, root_radius : float, optional
        By default those that the tool makes [modules].
    """

    form_radius: float | None = None
    root_radius: float | None = None

    def below(self, flank: FlankAbove) -> Foot:
        """The fillet below a flank.

        Raises
        ------
        GeometryError
            If no ellipse touches both.
        """
        roll = flank.start("fillet.form_diameter", self.form_radius)
        root = _root(self.root_radius, flank, roll)
        beyond = flank.beyond or 0.0
        if beyond:  # on the line up to which the other fillet leaves room
            flank = replace(flank, half_pitch=flank.last)
        (x, y), (tx, ty) = flank.in_space(flank.point(roll)), flank.in_space(flank.tangent(roll))
        up, rise = flank.side * (float(y) - root), flank.side * float(ty)
        # through (x, up) with the slope rise / tx, level at (0, 0): 1/b from both conditions, then the other axis
        steep = rise / float(tx) if tx else math.inf
        along = up if math.isinf(steep) else up * (up - x * steep) / (2.0 * up - x * steep)
        end = math.acos(max(min(1.0 - up / along, 1.0), -1.0)) if along > 0.0 else math.nan
        beside = x / math.sin(end) if along > 0.0 and math.sin(end) > 0.0 else math.nan
        if not (x > 0.0 and along > 0.0 and up < 2.0 * along and beside > 0.0):
            highest = 0.5 * float(x) * steep
            rule, remedy = "has no ellipse that is tangent to flank and root circle", "choose another form diameter"
            if 0.0 < highest <= up:
                side, limit = "above" if flank.side > 0 else "below", 2.0 * (float(y) - flank.side * highest)
                rule += f" of {2.0 * root:.6g} modules: the root diameter must be {side} {limit:.6g} modules"
                remedy = "reduce the fillet's depth"
            raise GeometryError(
                "fillet.form_diameter", f"{2.0 * math.hypot(x, y):.6g} modules", rule, remedy,
            )  # fmt: skip
        curve = EllipseFillet(flank.half_pitch, root, float(beside), float(along), end, flank.side)
        return Foot(curve, roll, root, 0.0 - beyond)


@dataclass(frozen=True, slots=True)
class ArcFillet:
    """One or two circular arcs that touch flank, root circle and each other.

    Parameters
    ----------
    radii : tuple of float
        From the flank to the root circle [modules]. None: one arc, of the radius that the form circle leaves. One: the
        flank begins where the arc touches it.
    form_radius, root_radius : float, optional
        [modules].
    """

    radii: tuple[float, ...] = ()
    form_radius: float | None = None
    root_radius: float | None = None

    def below(self, flank: FlankAbove) -> Foot:
        """The fillet below a flank.

        Raises
        ------
        GeometryError
            If the arcs have no room in the tooth space, or touch the involute nowhere.
        """
        if len(self.radii) == 2:
            return self._two(flank)
        root = _root_circle(self.root_radius, flank)
        if not self.radii:
            roll = flank.start("fillet.form_diameter", self.form_radius)
            root = _root(self.root_radius, flank, roll)
            p, n = flank.point(roll), flank.normal(roll)
            radius = (float(p @ p) - root**2) / (2.0 * (flank.side * root - float(p @ n)))
            if not radius > 0.0:
                raise GeometryError(
                    "fillet.form_diameter", f"{2.0 * math.hypot(*p):.6g} modules",
                    "has no circular arc that is tangent to flank and root circle", "choose another form diameter",
                )  # fmt: skip
        else:
            radius = self.radii[0]
            roll = self._touched(flank, root, radius)
        return _of_arcs(flank, root, roll, [flank.point(roll) + radius * flank.normal(roll)], [radius])

    def _touched(self, flank: FlankAbove, root: float, radius: float) -> float:
        """Roll angle where an arc that touches the root circle touches the involute."""
        reach = (root + flank.side * radius) ** 2 - flank.base_radius**2
        length = flank.side * math.sqrt(max(reach, 0.0)) - radius
        if reach < 0.0 or flank.side * length < 0.0:
            raise GeometryError(
                "fillet.radii", f"{radius:.4g} modules", "touches the flank below its base circle",
                "specify form_diameter, or another radius",
            )  # fmt: skip
        return length / flank.base_radius

    def _two(self, flank: FlankAbove) -> Foot:
        upper, lower = self.radii
        roll = flank.start("fillet.form_diameter", self.form_radius)
        root = _root(self.root_radius, flank, roll)
        one = flank.point(roll) + upper * flank.normal(roll)
        far, step, asked = float(np.hypot(*one)), upper - lower, root + flank.side * lower
        if abs(step) < 1e-9:
            return ArcFillet((), self.form_radius, self.root_radius).below(flank)
        cosine = (asked**2 - far**2 - step**2) / (2.0 * far * step)
        if not abs(cosine) <= 1.0:
            raise GeometryError(
                "fillet.radii", f"{upper:.4g} and {lower:.4g} modules",
                "do not reach from the flank to the root circle as tangent arcs",
                "set form_diameter and one radius only, or change a radius",
            )  # fmt: skip
        outward = math.atan2(one[0], one[1])
        for angle in (outward + math.acos(cosine), outward - math.acos(cosine)):
            joint = np.array([math.sin(angle), math.cos(angle)])
            other = one + step * joint
            try:
                return _of_arcs(flank, root, roll, [other, one], [lower, upper])
            except GeometryError as error:
                found = error
        raise found


def _root_circle(given: float | None, flank: FlankAbove) -> float:
    """Root radius: as given, else that of the other fillet or of the tool."""
    usual = flank.root_radius if flank.bottom is None else flank.bottom
    return flank.at_the_bottom(usual if given is None else given, "fillet.root_diameter", OFF_THE_FLANK)


def _root(given: float | None, flank: FlankAbove, roll: float) -> float:
    """Root radius, which must lie below the form circle."""
    root, form = _root_circle(given, flank), float(np.hypot(*flank.point(roll)))
    if not (flank.side * (form - root) > 1e-3 and root > 0.0):
        below = "below" if flank.side > 0 else "above"
        raise GeometryError(
            "fillet.root_diameter", f"{2.0 * root:.6g} modules",
            f"must be {below} the root form diameter of {2.0 * form:.6g} modules", "reduce the fillet's depth",
        )  # fmt: skip
    return root


def _of_arcs(flank: FlankAbove, root: float, roll: float, centres: list[Array], radii: list[float]) -> Foot:
    """The fillet of arcs about centres from the root circle to the flank."""
    x, y = centres[0]
    land = flank.half_pitch - math.atan2(x, y)
    left = flank.last - math.atan2(x, y)
    if left * root < -1e-9:
        middle = "the middle of" if flank.beyond == 0.0 else "the other fillet of"
        raise GeometryError(
            "fillet.radii", " and ".join(f"{radius:.4g}" for radius in radii[::-1]) + " modules",
            f"extend {-left * root:.3g} modules beyond {middle} the tooth space",
            "choose smaller radii, or another form_diameter",
        )  # fmt: skip
    directions = [np.array([-x, -y]) * flank.side]
    directions += [(a - b) / (r - q) for a, b, q, r in zip(centres, centres[1:], radii, radii[1:], strict=False)]
    directions.append(-flank.normal(roll))
    angles = np.unwrap([math.atan2(d[0], d[1]) for d in directions])
    turns = flank.side * np.diff(angles)
    if turns.min() < 0.0 or turns.max() > math.pi:
        raise GeometryError(
            "fillet.radii", " and ".join(f"{radius:.4g}" for radius in radii[::-1]) + " modules",
            "do not join flank and root circle smoothly", "change a radius or form_diameter",
        )  # fmt: skip
    arcs = tuple(
        Arc((float(c[0]), float(c[1])), -radius, float(a), float(b))
        for c, radius, a, b in zip(centres, radii, angles, angles[1:], strict=False)
    )
    return Foot(ArcsFillet(arcs), roll, root, land if left * root > 1e-6 else flank.half_pitch - flank.last)
