"""Rack-cutter surfaces and the flanks that they generate (NASA TM-107451, Eqs. 19 to 22 and Appendix 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry.gear import Gear


@dataclass(frozen=True)
class RackCutter:
    """Cutter surface of one flank, in the cutter's frame: x out of the gear, y along the pitch line, z along the axis.

    Both cutters of a pair are one rigid tool: they touch along the line u = 0, and a u of one is the same place on the
    other. The paper's gears have no profile shift; with one the cutter stands that much further out, and the lines
    u = 0 of a pair meet only where both shifts add to zero. Everything here is the paper's way step by step;
    `RackFlank` and `InvoluteHelicoid` are the same flanks in closed form.

    Parameters
    ----------
    gear : Gear
        What is cut.
    cuts : {"pinion", "gear"}
        The pinion's x axis runs through the middle of a space, the gear's through that of a tooth.
    parabola : float
        a_c [1/m] by which the normal profile leaves its straight line, a_c u^2; 0 for a plane.
    """

    gear: Gear
    cuts: Literal["pinion", "gear"]
    parabola: float = 0.0

    @property
    def _side(self) -> float:
        return -1.0 if self.cuts == "pinion" else 1.0

    @property
    def _slant(self) -> float:
        """sin(beta) with the sign of the hand, in which teeth run toward y as z grows."""
        size = math.sin(self.gear.helix_angle)
        return -size if self.gear.hand == "left" else size

    @property
    def shift(self) -> float:
        """Distance of the cutter's reference line from the pitch line, outwards [m]: x m_n less the allowance."""
        return self.gear.tooth.generating_shift * self.gear.module

    @property
    def half_width(self) -> float:
        """a_m = pi / (4 P_n) [m]: from the x axis to the profile, on the reference line (A.5.2)."""
        return 0.25 * math.pi * self.gear.module

    def normal_profile(self, u: ArrayLike) -> Array:
        """Points (2, ...) [m] of the normal section about the reference line, at u [m] from it (A.5.1, A.5.6)."""
        u, a, alpha = np.asarray(u, dtype=float), self.parabola, self.gear.normal_pressure_angle
        x = u * math.cos(alpha) + a * u**2 * math.sin(alpha)
        y = self.half_width - u * math.sin(alpha) + a * u**2 * math.cos(alpha)
        return self._side * np.stack([x, y])

    def points(self, u: ArrayLike, l: ArrayLike) -> Array:  # noqa: E741  (the paper's letter)
        """Points (3, ...) [m] at l [m] along the tooth (A.5.3, A.5.8; the sign of element (3, 2) of A.5.9 is plus)."""
        x, y = self.normal_profile(u)
        cosine, l = math.cos(self.gear.helix_angle), np.asarray(l, dtype=float)  # noqa: E741
        return np.stack(np.broadcast_arrays(x + self.shift, y * cosine + l * self._slant, l * cosine - y * self._slant))

    def along(self, u: ArrayLike, z: ArrayLike) -> Array:
        """The l [m] at which the surface has the height z [m]."""
        y = self.normal_profile(u)[1]
        return (np.asarray(z, dtype=float) + y * self._slant) / math.cos(self.gear.helix_angle)

    def normals(self, u: ArrayLike) -> Array:
        """Unit normals (3, ...), into the pinion and out of the gear, of u alone (A.5.4, A.5.11 repaired)."""
        u, alpha, beta = np.asarray(u, dtype=float), self.gear.normal_pressure_angle, self.gear.helix_angle
        bend = 2.0 * self.parabola * u
        across = math.cos(alpha) + bend * math.sin(alpha)
        n = np.stack([math.sin(alpha) - bend * math.cos(alpha), across * math.cos(beta), -across * self._slant])
        return np.asarray(self._side * n / np.sqrt(1.0 + bend**2))

    def roll_angle(self, u: ArrayLike, l: ArrayLike) -> Array:  # noqa: E741
        """Psi [rad] at which the cutter generates at (u, l): the equation of meshing (A.5.14, A.5.15)."""
        u, alpha, beta = np.asarray(u, dtype=float), self.gear.normal_pressure_angle, self.gear.helix_angle
        bend = 2.0 * self.parabola * u
        rise = math.sin(alpha) - bend * math.cos(alpha)
        lead = u * (1.0 + 0.5 * bend**2) / rise
        off = self.shift * (math.cos(alpha) + bend * math.sin(alpha)) / rise  # the normal starts that much further out
        way = self._side * self._slant * np.asarray(l, dtype=float)
        way = way + (self.half_width - lead - self._side * off) * math.cos(beta)
        return np.asarray(way / self.gear.pitch_radius)

    def rolled(self, points: ArrayLike, psi: ArrayLike) -> Array:
        """Points (3, ...) of the cutter in the gear's frame at a roll angle (A.5.16 to A.5.21)."""
        x, y, z = np.asarray(points, dtype=float)
        psi, r = np.asarray(psi, dtype=float), self.gear.pitch_radius
        w = np.exp(1j * self._side * psi) * (r + x + 1j * (y - self._side * r * psi))
        return np.stack(np.broadcast_arrays(w.real, w.imag, z))

    def generated(self, u: ArrayLike, l: ArrayLike) -> Array:  # noqa: E741
        """Points (3, ...) [m] of the generated flank, in the gear's frame."""
        return self.rolled(self.points(u, l), self.roll_angle(u, l))
