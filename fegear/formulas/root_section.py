"""Sections through a generated tooth's fillet, found by the inclination of the fillet's tangent.

Every bending formula asks for one section: ISO 6336-3 where the tangent makes 30 degrees with the tooth's centre
line, Cornell's foundation where it makes 75 degrees, AGMA 908 and Dolan and Broghamer where the Lewis parabola touches.

Where a load on the involute points: the line of action against the tooth's centre line.

The tooth stands upright: gear centre at the origin, centre line along +y, the loaded flank at x > 0; lengths in
modules. A load normal to the flank at roll angle t makes the load angle phi = t - psi_b with the x axis (Cornell's
epsilon - beta; psi_b is half the tooth's angle on the base circle) and pushes the tooth toward -x and, for phi > 0,
toward the gear's centre.

The Lewis parabola: the section at which a beam of uniform strength, hung from the load, touches the fillet.

Source: W. Lewis, Investigation of the Strength of Gear Teeth, Proc. Engineers' Club of Philadelphia (1892); with the
apex where the line of action crosses the tooth's centre line, as in AGMA 908-B89, section 5.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.geometry.curves import Trochoid
from fegear.geometry.external_tooth import Tooth

#: A fillet sharper than this [modules] is a corner.
SHARPEST = 1e-6


class Filleted(Protocol):
    """What has a fillet: a tooth, or a virtual one whose number is not whole."""

    @property
    def trochoid(self) -> Trochoid:
        """What the rounding of the rack's tip cuts."""


@dataclass(frozen=True, slots=True)
class FilletPoint:
    """A point of the fillet and the section through it, lengths in modules.

    Parameters
    ----------
    half_thickness : float
        Distance x of the point from the tooth's centre line.
    height : float
        Its height y above the gear's centre, along the centre line.
    fillet_radius : float
        Radius of curvature of the fillet there.
    tangent_angle : float
        Angle between the fillet's tangent and the tooth's centre line [rad].
    """

    half_thickness: float
    height: float
    fillet_radius: float
    tangent_angle: float

    @property
    def radius(self) -> float:
        """Distance from the gear's centre [modules]."""
        return math.hypot(self.half_thickness, self.height)

    @property
    def thickness(self) -> float:
        """Chordal thickness of the section [modules]."""
        return 2.0 * self.half_thickness


def fillet_point(tooth: Filleted, parameter: float) -> FilletPoint:
    """Point of the fillet at a parameter of `Tooth.fillet` [rad]."""
    f = tooth.trochoid
    x, y = f.points(parameter)
    nx, ny = f.normals(parameter)
    return FilletPoint(float(x), float(y), float(fillet_radii(tooth, parameter)), math.atan2(float(ny), float(nx)))


def fillet_radii(tooth: Filleted, parameter: ArrayLike) -> NDArray[np.float64]:
    """Radii of curvature [modules] of the fillet at parameters of `Tooth.fillet` [rad].

    Raises
    ------
    RangeError
        If the fillet is a sharp corner: a rack without tip radius whose corner runs on the pitch line.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        radii = -1.0 / tooth.trochoid.curvatures(np.asarray(parameter, dtype=float))
    if not np.all(radii > SHARPEST):
        raise RangeError(
            "fillet radius",
            f"{np.min(radii):.3g} modules",
            "is a sharp corner: no root-stress formula is valid",
            "give the rack a tip radius",
        )
    return np.asarray(radii)


def tangent_range(tooth: Filleted) -> tuple[float, float]:
    """Smallest and largest tangent angle on the fillet [rad]: at the involute and at the root circle."""
    f = tooth.trochoid
    angles = [math.atan2(float(n[1]), float(n[0])) for n in (f.normals(f.end), f.normals(f.start))]
    return angles[0], angles[1]


def fillet_parameter(tooth: Filleted, tangent_angle: float) -> float:
    """Parameter of `Tooth.fillet` [rad] where the tangent makes `tangent_angle` [rad] with the centre line.

    On a trochoid cut by a rack the tangent turns monotonically, by pi/2 - beta - phi(beta) - pi/z, so there is at
    most one such point.

    Raises
    ------
    RangeError
        If the fillet has no such tangent.
    """
    low, high = tangent_range(tooth)
    if not low - 1e-12 <= tangent_angle <= high + 1e-12:
        raise RangeError(
            "tangent angle",
            f"{math.degrees(tangent_angle):.6g} deg",
            f"does not occur on the fillet, {math.degrees(low):.4g} to {math.degrees(high):.4g} deg",
        )
    f = tooth.trochoid

    def excess(beta: float) -> float:
        return 0.5 * math.pi - beta - float(f.rolling(beta)) - f.space_half_angle - tangent_angle

    # Newton from the middle, kept inside the bracket: the function falls monotonically
    lower, upper = f.start, f.end
    if excess(lower) <= 0.0:
        return lower
    if excess(upper) >= 0.0:
        return upper
    beta = 0.5 * (lower + upper)
    for _ in range(100):
        value = excess(beta)
        lower, upper = (beta, upper) if value > 0.0 else (lower, beta)
        slope = -1.0 + f.centre_height / (f.pitch_radius * math.cos(beta) ** 2)
        step = beta - value / slope
        new = step if lower < step < upper else 0.5 * (lower + upper)
        if abs(new - beta) < 1e-15:
            return new
        beta = new
    return beta


def section_at_tangent(tooth: Tooth, tangent_angle: float) -> FilletPoint:
    """Section of `tooth` where the fillet's tangent makes `tangent_angle` [rad] with the centre line."""
    return fillet_point(tooth, fillet_parameter(tooth, tangent_angle))


def sharpest_fillet_radius(tooth: Tooth) -> float:
    """Smallest radius of curvature of the fillet [modules], on the root circle (rho_F of AGMA 908-B89).

    rho + v^2 / (cos b (r cos^2 b - v)) grows with the trochoid's parameter b, which is zero on the root circle.
    """
    return fillet_point(tooth, tooth.trochoid.start).fillet_radius


@dataclass(frozen=True, slots=True)
class LoadLine:
    """Loads normal to the flank of a tooth; arrays of one shape (N,) each, lengths in modules.

    Parameters
    ----------
    radius : ndarray
        Radius of the load points.
    roll : ndarray
        Roll angles t [rad].
    angle : ndarray
        Load angle phi = t - psi_b [rad]: of the load against the perpendicular to the tooth's centre line.
    x, y : ndarray
        Load point: half the tooth's thickness there and its height above the gear's centre.
    apex : ndarray
        Height above the gear's centre at which the line of action crosses the tooth's centre line.
    """

    radius: Array
    roll: Array
    angle: Array
    x: Array
    y: Array
    apex: Array

    @property
    def depth(self) -> Array:
        """Distance along the line of action from the load point to the tooth's centre line [modules]."""
        return self.x / np.cos(self.angle)


def refuse_helix(tooth: Tooth) -> None:
    """Refuse a helical tooth, which no formula for plane teeth knows.

    Raises
    ------
    RangeError
    """
    if tooth.helix_angle != 0.0:
        angle = f"{math.degrees(tooth.helix_angle):.6g} deg"
        raise RangeError(
            "helix angle", angle, "must be zero (formula for spur gears; the rating to ISO 6336 covers helical gears)"
        )


def load_line(tooth: Tooth, radius: ArrayLike) -> LoadLine:
    """Geometry of loads at `radius` [modules] on the involute of a spur tooth.

    Raises
    ------
    RangeError
        If a radius lies off the involute (below the form circle or above its end at the tip), or the tooth is helical.
    """
    refuse_helix(tooth)
    r = np.atleast_1d(np.asarray(radius, dtype=float))
    low, high = tooth.form_radius, tooth.involute_tip_radius
    slack = 1e-9 * high  # radii often come from a path of contact, computed with other round-off
    bad = ~((r >= low - slack) & (r <= high + slack))
    if bad.any():
        raise RangeError(
            "load radius",
            f"{r[bad].flat[0]:.6g} modules",
            f"is outside the involute, {low:.6g} to {high:.6g} modules",
        )
    roll = tooth.roll(np.clip(r, max(low, tooth.base_radius), high))
    angle = roll - tooth.base_half_angle
    half = tooth.half_thickness_angle(np.clip(r, max(low, tooth.base_radius), high))
    # the line of action touches the base circle, so it crosses the centre line at r_b / cos(phi)
    return LoadLine(r, roll, angle, r * np.sin(half), r * np.cos(half), tooth.base_radius / np.cos(angle))


def lewis_section(tooth: Tooth, radius: float) -> tuple[FilletPoint, LoadLine]:
    """Section where the parabola through the load apex touches the fillet, for a load at `radius` [modules].

    On a parabola with its apex h above the section the tangent makes atan(x / (2 h)) with the axis. Many teeth loaded
    near the tip are so like a wedge that the parabola touches above the fillet; as in AGMA 908-B89, whose iteration
    knows no end of the trochoid, it then touches the trochoid continued beyond the start of the involute.

    Raises
    ------
    RangeError
        If the parabola touches neither the fillet nor its continuation.
    """
    load = load_line(tooth, radius)
    section = touching_section(tooth, float(load.apex[0]))
    if section is not None:
        return section, load
    raise RangeError(
        "load radius",
        f"{radius:.6g} modules",
        "gives a Lewis parabola that does not touch the fillet",
        "the formula has no critical section here",
    )


def touching_section(tooth: Filleted, apex: float) -> FilletPoint | None:
    """Section where the parabola with its apex at a height [modules] touches the trochoid; None if nowhere."""
    from scipy.optimize import brentq

    def excess(gamma: float) -> float:
        p = fillet_point(tooth, fillet_parameter(tooth, gamma))
        return math.tan(gamma) * 2.0 * (apex - p.height) - p.half_thickness

    low, high = tangent_range(tooth)
    high = min(high, 0.5 * math.pi - 1e-9)
    if excess(low) > 0.0:
        return _above_the_fillet(tooth, apex)
    if excess(high) >= 0.0:
        gamma = brentq(excess, low, high, xtol=1e-13)
        return fillet_point(tooth, fillet_parameter(tooth, gamma))
    return None


def _above_the_fillet(tooth: Filleted, apex: float) -> FilletPoint | None:
    """Section at which the parabola touches the trochoid beyond its junction with the involute; None if nowhere."""
    from scipy.optimize import brentq

    def excess(beta: float) -> float:
        p = fillet_point(tooth, beta)
        return math.tan(p.tangent_angle) * 2.0 * (apex - p.height) - p.half_thickness

    end, steps = tooth.trochoid.end, 200
    last = 0.5 * math.pi - 1e-6
    for i in range(1, steps):
        beta = end + (last - end) * i / steps
        if excess(beta) <= 0.0:
            return fillet_point(tooth, brentq(excess, end, beta, xtol=1e-14))
    return None
