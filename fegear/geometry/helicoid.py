"""Involute helicoids: points, normals and curvatures (Litvin and others, NASA TM-107451, Appendix 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.geometry.gear import Gear
from fegear.geometry.involute import polar_angle


@dataclass(frozen=True, slots=True)
class InvoluteHelicoid:
    """One flank of a helical tooth in the gear's own frame, z along the axis.

    In every transverse section the flank is the involute at the azimuth ``offset + twist z - inv(alpha)``, with
    the tooth's material on the side of smaller azimuth. Surface parameters are t, the length of the tangent to
    the base cylinder in the transverse plane (u cos(lambda_b) in the paper), and z.

    Parameters
    ----------
    base_radius : float
        r_b [m].
    twist : float
        Turn of the section per unit of z [rad/m], positive for a right hand (+-1/p; 0 for a spur gear).
    offset : float
        Azimuth of the involute's start on the base circle at z = 0 [rad].
    """

    base_radius: float
    twist: float
    offset: float

    @classmethod
    def of(cls, gear: Gear, x_axis: Literal["space", "tooth"]) -> InvoluteHelicoid:
        """Flank of `gear` whose x axis runs through the middle of a space (the pinion) or of a tooth (the gear)."""
        offset = gear.half_base_tooth_angle if x_axis == "tooth" else -gear.half_base_space_angle
        return cls(gear.base_radius, gear.twist, offset)

    @property
    def base_helix_angle(self) -> float:
        """beta_b with the sign of the twist [rad]."""
        return math.atan(self.twist * self.base_radius)

    def tangent_length(self, radius: ArrayLike) -> Array:
        """Base tangent length t [m] of a point at `radius` [m].

        Raises
        ------
        RangeError
            Below the base circle, where there is no involute.
        """
        r = np.asarray(radius, dtype=float)
        if np.any(r < self.base_radius * (1.0 - 1e-15)):
            raise RangeError("radius", float(r.min()), f"is below the base circle of {self.base_radius:.9g} m")
        return np.sqrt(np.maximum((r - self.base_radius) * (r + self.base_radius), 0.0))

    def roll_direction(self, t: ArrayLike, z: ArrayLike) -> Array:
        """Azimuth at which the base tangent through (t, z) touches the base circle [rad]."""
        roll = np.asarray(t, dtype=float) / self.base_radius
        return self.offset + self.twist * np.asarray(z, dtype=float) - roll

    def points(self, t: ArrayLike, z: ArrayLike) -> Array:
        """Points (3, ...) [m] of the surface at base tangent length t [m] and height z [m] (A.1.1, A.1.3)."""
        t, z = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(z, dtype=float))
        direction = self.roll_direction(t, z)
        c, s = np.cos(direction), np.sin(direction)
        return np.stack([self.base_radius * c - t * s, self.base_radius * s + t * c, z])

    def normals(self, t: ArrayLike, z: ArrayLike) -> Array:
        """Unit normals (3, ...) out of the material; they depend on t and z through one angle only (A.1.2, A.1.4)."""
        t, z = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(z, dtype=float))
        direction = self.roll_direction(t, z)
        beta = self.base_helix_angle
        return np.stack([
            -math.cos(beta) * np.sin(direction), math.cos(beta) * np.cos(direction), np.full_like(t, -math.sin(beta)),
        ])  # fmt: skip

    def generators(self, t: ArrayLike, z: ArrayLike) -> Array:
        """Unit vectors (3, ...) along the straight line of the surface, tangent to the base helix: no curvature."""
        t, z = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(z, dtype=float))
        direction = self.roll_direction(t, z)
        beta = self.base_helix_angle
        return np.stack([
            -math.sin(beta) * np.sin(direction), math.sin(beta) * np.cos(direction), np.full_like(t, math.cos(beta)),
        ])  # fmt: skip

    def curvature(self, t: ArrayLike) -> Array:
        """Principal curvature across the generator [1/m], positive for the convex flank: cos(beta_b) / t.

        The other principal curvature is zero: the surface is developable. On the base helix it is infinite.
        """
        with np.errstate(divide="ignore"):
            return math.cos(self.base_helix_angle) / np.asarray(t, dtype=float)

    def separation_angle(self, points: ArrayLike) -> Array:
        """Angle [rad] by which points (3, ...) lie outside the flank, measured about the axis; negative inside.

        Its gradient has the constant length sqrt(1/r_b^2 + twist^2): times r_b cos(beta_b) it is the distance to
        the surface along the normal. This is what turns contact with a helicoid into an explicit formula.
        """
        x, y, z = np.asarray(points, dtype=float)
        roll = self.tangent_length(np.hypot(x, y)) / self.base_radius
        return np.arctan2(y, x) - (self.offset + self.twist * z - polar_angle(roll))
