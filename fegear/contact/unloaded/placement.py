"""Where the axes of two gears lie to each other."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.tally import note
from fegear.geometry.involute import polar_angle

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Complex
    from fegear.contact.unloaded.pair import HelicalPair

    Codes = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Placement:
    """Numbers of a `HelicalPair` that the contact search needs, taken out once.

    All lengths in m, angles in rad; see `HelicalPair` for the frames.
    """

    distance: float
    cos: float
    sin: float
    twist_1: float
    crown: float
    twist_2: float
    base_1: float
    base_2: float
    tip_2: float
    form_2: float
    offset_2: float
    pressure_angle: float
    ratio: float
    face_1: tuple[float, float]
    face_2: tuple[float, float]

    @classmethod
    def of(cls, pair: HelicalPair) -> Placement:
        """Collect the numbers of a pair."""
        note("misaligned flanks", int(not pair.errors.aligned or pair.errors.centre_distance != 0.0))
        a, b, h = pair.cut_pinion, pair.gear, pair.axial_offset
        return cls(
            distance=pair.centre_distance,
            cos=math.cos(pair.errors.shaft_angle),
            sin=math.sin(pair.errors.shaft_angle),
            twist_1=a.twist,
            crown=pair.crown,
            twist_2=b.twist,
            base_1=a.base_radius,
            base_2=b.base_radius,
            tip_2=b.involute_tip_radius,
            form_2=b.form_radius,
            offset_2=pair.mating_flank.offset,
            pressure_angle=pair.working_pressure_angle,
            ratio=pair.ratio,
            face_1=(-0.5 * a.face_width, 0.5 * a.face_width),
            face_2=(h - 0.5 * b.face_width, h + 0.5 * b.face_width),
        )

    def turned(self, w: Complex, z: Array) -> Complex:
        """x + i y of pinion points in the fixed frame."""
        return w * np.exp(1j * (z * (self.twist_1 - self.crown * z)))

    def rate(self, z: Array) -> Array:
        """Turn of the pinion's section per unit z [rad/m]."""
        return self.twist_1 - 2.0 * self.crown * z

    def in_gear_frame(self, q: Complex, z: Array) -> tuple[Array, Array, Array]:
        """Coordinates x2, y2, z2 of fixed points, in the gear's frame at phi_2 = 0.

        x_f = E - x2, y_f = -y2 cos - z2 sin, z_f = z2 cos - y2 sin (shaft angle error).
        """
        return self.distance - q.real, -q.imag * self.cos - z * self.sin, z * self.cos - q.imag * self.sin

    def gradient(self, x2: Array, y2: Array) -> tuple[Array, Array, Array]:
        """Derivatives of the gear angle by x2 and y2, and the base tangent length there.

        (A, B) points along the transverse normal into the gear's tooth and has length 1/r_b2.
        """
        rr = x2 * x2 + y2 * y2
        t = np.sqrt(np.maximum(rr - self.base_2**2, (1e-9 * self.base_2) ** 2))
        roll = t / self.base_2
        return (y2 - roll * x2) / rr, -(x2 + roll * y2) / rr, t

    def slope_along_helix(self, z: Array, w: Complex) -> tuple[Array, Array]:
        """First and second derivative of the gear angle by z at fixed s."""
        q = self.turned(w, z)
        rate = self.rate(z)
        qz = 1j * rate * q
        qzz = -(rate**2) * q - 2j * self.crown * q
        x2, y2, _ = self.in_gear_frame(q, z)
        A, B, t = self.gradient(x2, y2)
        dx2, dy2 = -qz.real, -qz.imag * self.cos - self.sin
        first = A * dx2 + B * dy2 + self.twist_2 * (self.cos - qz.imag * self.sin)
        # The level lines are involutes, so the only curvature is 1/t along them: tau = r_b2 (-B, A).
        along = self.base_2 * (A * dy2 - B * dx2)
        bend = -A * qzz.real - B * qzz.imag * self.cos - self.twist_2 * qzz.imag * self.sin
        return first, bend - along**2 / (self.base_2 * t)

    def slope_along_profile(self, z: Array, w: Complex, dw: Complex) -> Array:
        """Derivative of the gear angle by s at fixed z."""
        q, qs = self.turned(w, z), self.turned(dw, z)
        x2, y2, _ = self.in_gear_frame(q, z)
        A, B, _ = self.gradient(x2, y2)
        return -A * qs.real - B * qs.imag * self.cos - self.twist_2 * qs.imag * self.sin

    def gear_angle(self, w: Complex, z: Array) -> Array:
        """phi_2 [rad] at which the gear's flank passes through the points."""
        x2, y2, z2 = self.in_gear_frame(self.turned(w, z), z)
        r2 = np.hypot(x2, y2)
        roll = np.sqrt(np.maximum((r2 - self.base_2) * (r2 + self.base_2), 0.0)) / self.base_2
        return self.offset_2 + self.twist_2 * z2 - polar_angle(roll) - np.arctan2(y2, x2)
