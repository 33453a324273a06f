"""Pairs as arrays: what `PairGeometry` of ISO 6336 is for one pair, for any number of them at once.

Arrays of gears have the shape (2, N), pinion and wheel; arrays of pairs (N,). Lengths are in metres, angles in radians.
Wheels may be ring gears: their teeth are negative, and with them ratio, reference and base diameters, as in the
equations of involutes. Nothing is refused here: `fegear.formulas.many.ratings` masks what ISO 6336 does not cover.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part3_internal import ring_tooth

if TYPE_CHECKING:
    from fegear.base.arrays import Index, Mask
    from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry


@dataclass(frozen=True)
class ManyRings(ReadOnlyArrays):
    """Teeth of ring gears and the cutters that have made them, shape (N,); NaN of pairs whose wheel is external.

    Parameters
    ----------
    generating_shift, dedendum : ndarray
        x_E; from the reference circle shifted by x_E outward to the root [modules].
    cutter_teeth, cutter_shift, cutter_rounding : ndarray
        z_0, x_0, rho_a0 [modules].
    fixed : ndarray
        1 where the ring stands still with the casing: its mass counts as infinite.
    """

    generating_shift: Array
    dedendum: Array
    cutter_teeth: Array
    cutter_shift: Array
    cutter_rounding: Array
    fixed: Array

    def at(self, rows: Index | Mask | slice) -> ManyRings:
        """Those of some of the pairs."""
        return ManyRings(*(getattr(self, field.name)[rows] for field in fields(self)))

    @property
    def rack_rounding(self) -> Array:
        """rho_fPv of the racks that stand for the cutters, as `RingTooth.rounding`."""
        reach = self.cutter_shift + self.dedendum - self.cutter_rounding
        reach = np.where(reach > 0.0, reach, np.nan)
        return np.asarray(self.cutter_rounding + reach**1.95 / (3.156 * 1.036**self.cutter_teeth))


@dataclass(frozen=True)
class ManyPairs(ReadOnlyArrays):
    """Pairs on parallel axes, spur and helical, as ISO 6336 sees them.

    Parameters
    ----------
    teeth, profile_shift, generating_shift : ndarray, shape (2, N)
        z, negative of a ring gear; x nominal and thinned for backlash.
    tip_diameter, active_tip_diameter, root_diameter, bore_diameter, face_widths : ndarray, shape (2, N)
    dedendum, rack_tip_radius, residual_undercut : ndarray, shape (2, N)
        h_fP, rho_fP and s_pr of the basic rack [modules].
    rim_thickness, web_ratio : ndarray, shape (2, N)
        s_R, inf of a solid gear; b_s/b, NaN of a solid disc.
    young_modulus, poisson_ratio, density : ndarray, shape (2, N)
    module, pressure_angle, helix_angle, centre_distance, contact_ratio, face_width : ndarray, shape (N,)
        m_n, alpha_n, beta, a, epsilon_alpha, b.
    rings : ManyRings, optional
        Where some wheels are ring gears.
    """

    teeth: Array
    profile_shift: Array
    generating_shift: Array
    tip_diameter: Array
    active_tip_diameter: Array
    root_diameter: Array
    bore_diameter: Array
    face_widths: Array
    dedendum: Array
    rack_tip_radius: Array
    residual_undercut: Array
    rim_thickness: Array
    web_ratio: Array
    young_modulus: Array
    poisson_ratio: Array
    density: Array
    module: Array
    pressure_angle: Array
    helix_angle: Array
    centre_distance: Array
    contact_ratio: Array
    face_width: Array
    rings: ManyRings | None = None

    def __len__(self) -> int:
        """Return the number of pairs."""
        return self.module.size

    def at(self, rows: Index | Mask | slice) -> ManyPairs:
        """Some of the pairs."""
        arrays = {field.name: getattr(self, field.name)[..., rows] for field in fields(self) if field.name != "rings"}
        return ManyPairs(**arrays, rings=None if self.rings is None else self.rings.at(rows))

    @cached_property
    def internal(self) -> Mask:
        """Which wheels are ring gears, shape (N,)."""
        return np.asarray(self.teeth[1] < 0.0)

    @cached_property
    def ratio(self) -> Array:
        """Gear ratio u = z_2 / z_1, negative of internal pairs."""
        return np.asarray(self.teeth[1] / self.teeth[0])

    @cached_property
    def helix_cosine(self) -> Array:
        """Cosine of the helix angle beta."""
        return np.cos(self.helix_angle)

    @cached_property
    def transverse_pressure_angle(self) -> Array:
        """alpha_t."""
        return np.arctan(np.tan(self.pressure_angle) / self.helix_cosine)

    @cached_property
    def base_helix_cosine(self) -> Array:
        """Cosine of beta_b: sin(beta_b) = sin(beta) cos(alpha_n)."""
        return np.cos(np.arcsin(np.sin(self.helix_angle) * np.cos(self.pressure_angle)))

    @cached_property
    def diameters(self) -> Array:
        """Reference diameters d_1, d_2, negative of ring gears."""
        return np.asarray(self.teeth * self.module / self.helix_cosine)

    @cached_property
    def base_diameters(self) -> Array:
        """Base diameters d_b1, d_b2, negative of ring gears."""
        return np.asarray(self.diameters * np.cos(self.transverse_pressure_angle))

    @cached_property
    def working_pressure_angle(self) -> Array:
        """alpha_wt."""
        return np.arccos(0.5 * np.abs(self.base_diameters.sum(axis=0)) / self.centre_distance)

    @cached_property
    def overlap_ratio(self) -> Array:
        """epsilon_beta."""
        return np.asarray(self.face_width * np.sin(self.helix_angle) / (np.pi * self.module))

    @cached_property
    def total_contact_ratio(self) -> Array:
        """epsilon_gamma."""
        return np.asarray(self.contact_ratio + self.overlap_ratio)

    @cached_property
    def virtual_contact_ratio(self) -> Array:
        """epsilon_alpha_n = epsilon_alpha / cos^2(beta_b)."""
        return np.asarray(self.contact_ratio / self.base_helix_cosine**2)

    @cached_property
    def virtual_teeth(self) -> Array:
        """z_n of pinion and wheel, negative of ring gears."""
        return np.asarray(self.teeth / (self.base_helix_cosine**2 * self.helix_cosine))

    @cached_property
    def relative_curvature_radius(self) -> Array:
        """rho_red at the pitch point, in the transverse section."""
        one, other = 0.5 * self.base_diameters * np.tan(self.working_pressure_angle)
        return np.asarray(one * other / (one + other))

    @cached_property
    def depth(self) -> Array:
        """h, tooth depths from tip to root."""
        return np.asarray(0.5 * np.abs(self.tip_diameter - self.root_diameter))

    def pitch_line_velocity(self, speed: Array | float) -> Array:
        """v at the reference circle [m/s] for a speed of the pinion [rad/s]."""
        return np.asarray(0.5 * self.diameters[0] * speed)


def many_pairs(pairs: Sequence[PairGeometry]) -> ManyPairs:
    """Arrays of pairs that are given one by one.

    Raises
    ------
    RangeError
        If one of them has gears with fillets of their own.
    """
    if any(gear.formed is not None for one in pairs for gear in one.gears):
        raise RangeError("fillet", "(given)", "is not covered by arrays of pairs (fillets made by tools only)")

    def gears(name: str, missing: float = np.nan) -> Array:
        def of(shape: GearShape) -> float:
            value = getattr(shape, name)
            return missing if value is None else float(value)

        return np.array([[of(pair.gears[i]) for pair in pairs] for i in (0, 1)])

    def each(name: str) -> Array:
        return np.array([float(getattr(pair, name)) for pair in pairs])

    own_names = {"teeth": "signed_teeth", "face_widths": "face_width", "rack_tip_radius": "tip_radius"}
    of_pairs = ("module", "pressure_angle", "helix_angle", "centre_distance", "contact_ratio", "face_width")
    missing = {"rim_thickness": np.inf}
    return ManyPairs(
        **{
            one.name: each(one.name)
            if one.name in of_pairs
            else gears(own_names.get(one.name, one.name), missing.get(one.name, np.nan))
            for one in fields(ManyPairs)
            if one.name != "rings"
        },
        rings=_rings(pairs),
    )


def _rings(pairs: Sequence[PairGeometry]) -> ManyRings | None:
    wheels = [one.gears[1] for one in pairs]
    rings = [None if wheel.outline is None else ring_tooth(wheel.outline) for wheel in wheels]
    if not any(rings):
        return None

    def each(name: str) -> Array:
        return np.array([np.nan if ring is None else float(getattr(ring, name)) for ring in rings])

    return ManyRings(
        each("profile_shift"), each("dedendum"), each("cutter_teeth"), each("cutter_shift"), each("cutter_rounding"),
        np.array([float(wheel.fixed) for wheel in wheels]),
    )  # fmt: skip
