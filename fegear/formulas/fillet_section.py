"""Sections through a generated tooth's fillet, found by the inclination of the fillet's tangent.

Every bending formula asks for one section: ISO 6336-3 where the tangent makes 30 degrees with the tooth's centre
line, Cornell's foundation where it makes 75 degrees, AGMA 908 and Dolan and Broghamer where the Lewis parabola touches.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.geometry import Tooth
    from fegear.geometry.curves import Trochoid

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
            "is that of a sharp corner, where no root-stress formula holds",
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
            f"does not occur on the fillet, where it runs from {math.degrees(low):.4g} to {math.degrees(high):.4g} deg",
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
