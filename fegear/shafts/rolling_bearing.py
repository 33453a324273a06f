"""Ball and roller bearings from what rolls inside them: elements that press, each by its own law.

Every element carries Q = c delta^n for the approach delta of the rings at its place; its energy is c delta^(n+1)/(n+1),
and forces and stiffness are the derivatives of the sum of them all.

Sources: balls by Hertz's law of point contact, Q ~ delta^(3/2), with the ellipse from complete elliptic integrals
(H. Hertz, Journal fuer die reine und angewandte Mathematik 92 (1881); in the form of T. A. Harris, Rolling Bearing
Analysis, on contact stress and deformation); rollers by the fit for line contacts q = 35948 delta^(10/9) L^(8/9)
[N, mm] of ISO/TS 16281:2008, which goes back to Palmgren's delta ~ Q^0.9 / L^0.8, in slices along the roller.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from fegear.base.arrays import Array

#: Of steel against steel: E/(1 - nu^2) of either side [Pa].
_STEEL = 206e9 / (1.0 - 0.3**2)
#: ISO/TS 16281: Q = 35948 L^(8/9) delta^(10/9) in N and mm, here in SI.
_LINE = 35948.0 * 1e3 ** (10.0 / 9.0 + 8.0 / 9.0)
#: Slices of a roller; ISO/TS 16281 asks for 30 at least.
_SLICES = 30


def point_contact(inverse_radii: tuple[float, float, float, float], plane_modulus: float = _STEEL) -> float:
    """c of Q = c delta^(3/2) for two bodies that touch in a point [N/m^1.5].

    Parameters
    ----------
    inverse_radii : tuple of float
        Principal curvatures [1/m]: of the one body along and across, of the other along and across; negative if hollow.
    plane_modulus : float
        E/(1 - nu^2) of both bodies [Pa].
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipkm1

    along, across = inverse_radii[0] + inverse_radii[2], inverse_radii[1] + inverse_radii[3]
    total = along + across
    if not (along > 0.0 and across > 0.0):
        raise RangeError("groove_ratio", min(along, across), "gives no point contact", "specify a ratio above 0.5")
    difference = abs(along - across) / total
    if difference < 1e-12:
        approach = 1.0
    else:

        def excess(log_ratio: float) -> float:
            minor = math.exp(-2.0 * log_ratio)  # (b/a)^2, the complement of the elliptic parameter
            first, second = float(ellipkm1(minor)), float(ellipe(1.0 - minor))
            return float(((1.0 + minor) * second - 2.0 * minor * first) / ((1.0 - minor) * second) - difference)

        ratio = math.exp(brentq(excess, 1e-7, 12.0, xtol=1e-15, rtol=1e-14))
        first, second = float(ellipkm1(ratio**-2)), float(ellipe(1.0 - ratio**-2))
        approach = 2.0 * first / math.pi * (math.pi / (2.0 * ratio**2 * second)) ** (1.0 / 3.0)
    # delta = approach (3 Q/(2 total) 2/E')^(2/3) total/2
    return float((2.0 / (approach * total)) ** 1.5 * total * plane_modulus / 3.0)


@dataclass(frozen=True)
class RollingBearing:
    """A bearing of one row of balls or rollers, inner ring on the shaft; of two rows where it aligns itself.

    Parameters
    ----------
    kind : {"ball", "roller"}
    count : int
        Of the elements of a row.
    element_diameter, pitch_diameter : float
        [m].
    contact_angle : float
        Zero for deep groove and cylindrical bearings [rad]. It is positive where a shaft that moves toward +z presses
        the elements, negative where one that moves toward -z does.
    groove_ratio : tuple of float
        Radius of the grooves of inner and outer ring over the ball's diameter.
    roller_length : float
        Effective [m].
    clearance : float
        Diametral, across the axis [m]; negative for preload. Of bearings with a contact angle, along the normal.
    ribs : bool
        Whether ribs on both rings hold the shaft along the axis, rigidly and without play.
    aligning : bool
        Whether it is a spherical roller bearing: two rows at the contact angle to either side, whose normals meet on
        the axis, so that it takes no moment. Its clearance is across the axis.

    Raises
    ------
    RangeError
        If a value leaves no bearing.
    """

    kind: Literal["ball", "roller"]
    count: int
    element_diameter: float
    pitch_diameter: float
    contact_angle: float = 0.0
    groove_ratio: tuple[float, float] = (0.52, 0.52)
    roller_length: float = 0.0
    clearance: float = 0.0
    ribs: bool = False
    aligning: bool = False

    def __post_init__(self) -> None:
        """Refuse elements that do not fit, and rings without grooves."""
        room = self.pitch_diameter * math.sin(math.pi / max(self.count, 2))
        if not 0.0 < self.element_diameter < room:
            raise RangeError(
                "element_diameter", f"{self.element_diameter * 1e3:.6g} mm",
                f"is too large: {self.count} elements on the pitch diameter have {room * 1e3:.6g} mm each",
                "specify fewer or smaller elements",
            )  # fmt: skip
        if self.count < 3:
            raise RangeError("count", self.count, "rolling elements are too few", "specify at least 3")
        if not abs(self.contact_angle) < 0.5 * math.pi:
            raise RangeError("contact_angle", math.degrees(self.contact_angle), "must be below 90 deg")
        if self.kind == "ball" and min(self.groove_ratio) <= 0.5:
            raise RangeError(
                "groove_ratio", min(self.groove_ratio), "must be above 0.5 (groove radius larger than ball radius)"
            )
        if self.kind == "roller" and not self.roller_length > 0.0:
            raise RangeError("roller_length", self.roller_length, "must be positive")

    @property
    def rows(self) -> int:
        """Rows of elements."""
        return 2 if self.aligning else 1

    @cached_property
    def constant(self) -> float:
        """c of one element between both rings: of Q = c delta^(3/2) or of Q = c delta^(10/9) [N/m^n]."""
        if self.kind == "roller":
            return float(_LINE * self.roller_length ** (8.0 / 9.0))
        d, angle = self.element_diameter, math.cos(self.contact_angle) * self.element_diameter / self.pitch_diameter
        inner, outer = self.groove_ratio
        of_inner = point_contact((2.0 / d, 2.0 / d, 2.0 / d * angle / (1.0 - angle), -1.0 / (inner * d)))
        of_outer = point_contact((2.0 / d, 2.0 / d, -2.0 / d * angle / (1.0 + angle), -1.0 / (outer * d)))
        return float((of_inner ** (-2.0 / 3.0) + of_outer ** (-2.0 / 3.0)) ** -1.5)

    @property
    def exponent(self) -> float:
        """n of the law."""
        return 1.5 if self.kind == "ball" else 10.0 / 9.0

    @property
    def rigid(self) -> Array:
        """Nowhere, but along the axis between ribs."""
        return np.array([False, False, self.ribs, False, False])

    @cached_property
    def usual(self) -> Array:
        """Under an approach of 1/2000 of the element's diameter all around, which is that of a working load.

        Balls without a contact angle lean to either side of the groove under an axial force, by some 11 degrees.
        """
        delta = 5e-4 * self.element_diameter
        slope = self.exponent * self.constant * delta ** (self.exponent - 1.0)
        _, arms, normals, share = self._contacts
        normal = np.einsum("ck,cka->ca", normals, arms)
        found = np.einsum("ca,cb,c->ab", normal, normal, share) * slope
        if self.kind == "ball" and self.contact_angle == 0.0:
            found += 0.2**2 * slope * np.einsum("ca,cb->ab", arms[:, 1], arms[:, 1])
        return np.asarray(found)

    @cached_property
    def _contacts(self) -> tuple[Array, Array, Array, Array]:
        """Distance vector of the groove centres, how the ring's motion changes it, normal and share of each contact.

        Shapes (2,), (contacts, 2, 5), (contacts, 2), (contacts,): radial and axial components.
        """
        if self.aligning:
            return self._of_two_rows
        phi = 2.0 * math.pi * np.arange(self.count) / self.count
        angle = self.contact_angle
        if self.kind == "ball":
            along, share = np.zeros(1), np.ones(1)
        else:
            x, w = np.polynomial.legendre.leggauss(_SLICES)
            along, share = 0.5 * self.roller_length * x, 0.5 * w
        around, slices = (a.ravel() for a in np.meshgrid(phi, np.arange(along.size), indexing="ij"))
        slices = slices.astype(int)
        radius = 0.5 * self.pitch_diameter - along[slices] * math.sin(angle)
        offset = along[slices] * math.cos(angle)
        c, s = np.cos(around), np.sin(around)
        arms = np.zeros((around.size, 2, 5))
        arms[:, 0] = np.stack([c, s, 0.0 * c, -offset * s, offset * c], axis=-1)
        arms[:, 1] = np.stack([0.0 * c, 0.0 * c, 1.0 + 0.0 * c, radius * s, -radius * c], axis=-1)
        normals = np.broadcast_to([math.cos(angle), math.sin(angle)], (around.size, 2))
        apart = (sum(self.groove_ratio) - 1.0) * self.element_diameter
        centres = np.array([apart * math.cos(angle), apart * math.sin(angle)]) - 0.5 * self.clearance * normals[0]
        return centres, arms, np.asarray(normals), share[slices]

    @property
    def _of_two_rows(self) -> tuple[Array, Array, Array, Array]:
        """Contacts of a spherical roller bearing: each roller is one, for no tilt varies the approach along it."""
        phi = np.tile(2.0 * math.pi * np.arange(self.count) / self.count, 2)
        side = np.repeat([1.0, -1.0], self.count)
        arms = np.zeros((phi.size, 2, 5))
        arms[:, 0, 0], arms[:, 0, 1], arms[:, 1, 2] = np.cos(phi), np.sin(phi), 1.0
        normals = np.stack(np.broadcast_arrays(math.cos(self.contact_angle), side * math.sin(self.contact_angle)), -1)
        return np.zeros(2), arms, normals, np.ones(phi.size)

    def loads(self, u: Array) -> Array:
        """Load of every element [N], shape (rows count,)."""
        pressed = self._pressed(u)[0]
        share = self._contacts[3]
        loads = self.constant * pressed**self.exponent * share
        return np.asarray(loads.reshape(self.rows * self.count, -1).sum(axis=1))

    def _pressed(self, u: Array) -> tuple[Array, Array, Array]:
        """Approach, its direction and the distance that turns with it, one for each contact."""
        centres, arms, normals, _ = self._contacts
        moved = arms @ u
        if self.kind == "roller":
            gap = 0.5 * self.clearance * (math.cos(self.contact_angle) if self.aligning else 1.0)
            return (
                np.maximum(np.einsum("ck,ck->c", moved, normals) - gap, 0.0), normals, np.full(len(arms), np.inf)
            )  # fmt: skip
        apart = (sum(self.groove_ratio) - 1.0) * self.element_diameter
        vector = centres + moved
        length = np.hypot(vector[:, 0], vector[:, 1])
        return np.maximum(length - apart, 0.0), vector / length[:, None], length

    def reaction(self, u: Array) -> tuple[Array, Array]:
        """Sum over all elements."""
        _, arms, _, share = self._contacts
        delta, normal, length = self._pressed(u)
        load = self.constant * delta**self.exponent * share
        slope = self.exponent * self.constant * delta ** (self.exponent - 1.0) * share * (delta > 0.0)
        along = np.einsum("ck,cka->ca", normal, arms)
        across = np.einsum("ck,cka->ca", np.stack([-normal[:, 1], normal[:, 0]], axis=-1), arms)
        stiffness = np.einsum("ca,cb,c->ab", along, along, slope)
        stiffness += np.einsum("ca,cb,c->ab", across, across, load / length)
        return load @ along, stiffness
