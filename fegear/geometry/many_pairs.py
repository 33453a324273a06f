"""Geometry of any number of external pairs at once: circles, contact ratios and what a pair must not do (ISO 21771).

The numbers of `Tooth`, `Gear` and `GearPair` for teeth cut by a rack with a rounded tip, without thickness allowance,
tip rounding or protuberance. Arrays of gears have the
shape (2, N), pinion and wheel; arrays of pairs (N,). Lengths in metres, angles in radians, shifts and heights of the
rack in normal modules. Nothing is refused: undercut, interference and pointed teeth are numbers here.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays

if TYPE_CHECKING:
    from fegear.base.arrays import Index, Mask


def involute(angle: Array) -> Array:
    """inv(a) = tan(a) - a."""
    return np.asarray(np.tan(angle) - angle)


@dataclass(frozen=True)
class ManyGearPairs(ReadOnlyArrays):
    """External pairs, spur or helical.

    Parameters
    ----------
    teeth, profile_shift : ndarray, shape (2, N)
        z and x of pinion and wheel.
    module, pressure_angle, helix_angle : ndarray, shape (N,)
        m_n, alpha_n, beta.
    addendum, dedendum, rack_tip_radius : ndarray, shape (N,)
        h_aP, h_fP, rho_fP of both basic racks [modules].
    tip_alteration : ndarray, shape (N,)
        k, by which both tips are moved outward, negative where they are shortened [modules].
    centre_distance, face_width : ndarray, shape (N,)
    """

    teeth: Array
    profile_shift: Array
    module: Array
    pressure_angle: Array
    helix_angle: Array
    addendum: Array
    dedendum: Array
    rack_tip_radius: Array
    tip_alteration: Array
    centre_distance: Array
    face_width: Array

    def __len__(self) -> int:
        """Return the number of pairs."""
        return self.module.size

    def at(self, rows: Index | Mask | slice) -> ManyGearPairs:
        """Some of the pairs."""
        return ManyGearPairs(*(getattr(self, field.name)[..., rows] for field in fields(self)))

    @cached_property
    def transverse_pressure_angle(self) -> Array:
        """alpha_t."""
        return np.arctan(np.tan(self.pressure_angle) / np.cos(self.helix_angle))

    @cached_property
    def base_helix_angle(self) -> Array:
        """beta_b."""
        return np.arcsin(np.sin(self.helix_angle) * np.cos(self.pressure_angle))

    @cached_property
    def diameters(self) -> Array:
        """Reference diameters d."""
        return np.asarray(self.teeth * self.module / np.cos(self.helix_angle))

    @cached_property
    def base_diameters(self) -> Array:
        """Base diameters d_b."""
        return np.asarray(self.diameters * np.cos(self.transverse_pressure_angle))

    @cached_property
    def working_pressure_angle(self) -> Array:
        """alpha_wt; NaN where the base circles are farther apart than the axes."""
        with np.errstate(invalid="ignore"):
            return np.arccos(0.5 * self.base_diameters.sum(axis=0) / self.centre_distance)

    @cached_property
    def tip_diameters(self) -> Array:
        """Tip diameters d_a."""
        return np.asarray(
            self.diameters + 2.0 * self.module * (self.addendum + self.profile_shift + self.tip_alteration)
        )

    @cached_property
    def root_diameters(self) -> Array:
        """Root diameters d_f."""
        return np.asarray(self.diameters - 2.0 * self.module * (self.dedendum - self.profile_shift))

    @cached_property
    def _straight_depth(self) -> Array:
        """Depth to which the straight flank of the rack reaches [modules]."""
        return np.asarray(self.dedendum - self.rack_tip_radius * (1.0 - np.sin(self.pressure_angle)))

    @cached_property
    def least_shift(self) -> Array:
        """x_min, from which on no involute is cut away, of pinion and wheel."""
        sine = np.sin(self.transverse_pressure_angle)
        return np.asarray(self._straight_depth - self.teeth * sine**2 / (2.0 * np.cos(self.helix_angle)))

    @cached_property
    def undercut(self) -> Array:
        """x_min - x of pinion and wheel: undercut above 0."""
        return np.asarray(self.least_shift - self.profile_shift)

    @cached_property
    def form_rolls(self) -> Array:
        """Roll lengths at which the involutes of teeth without undercut begin; 0 of undercut ones."""
        sine = np.sin(self.transverse_pressure_angle)
        low = 0.5 * self.diameters * sine - self.module * (self._straight_depth - self.profile_shift) / sine
        return np.maximum(low, 0.0)

    @cached_property
    def form_diameters(self) -> Array:
        """Root form diameters d_Ff of teeth without undercut."""
        return np.sqrt(self.base_diameters**2 + 4.0 * self.form_rolls**2)

    @cached_property
    def tip_rolls(self) -> Array:
        """Roll lengths at the tips."""
        return 0.5 * np.sqrt(np.maximum(self.tip_diameters**2 - self.base_diameters**2, 0.0))

    @cached_property
    def _line(self) -> Array:
        """Length of the line of action between the base circles."""
        return np.asarray(self.centre_distance * np.sin(self.working_pressure_angle))

    @cached_property
    def contact_rolls(self) -> Array:
        """Roll lengths at which the mate's tip touches pinion and wheel."""
        return np.asarray(self._line - self.tip_rolls[::-1])

    @cached_property
    def involute_reserve(self) -> Array:
        """Roll length between the start of the involute and the mate's tip [modules]; interference below 0."""
        return np.asarray((self.contact_rolls - self.form_rolls) / self.module)

    @cached_property
    def base_pitch(self) -> Array:
        """p_bt."""
        return np.asarray(np.pi * self.base_diameters[0] / self.teeth[0])

    @cached_property
    def contact_ratio(self) -> Array:
        """epsilon_alpha of pairs without interference."""
        return np.asarray((self.tip_rolls.sum(axis=0) - self._line) / self.base_pitch)

    @cached_property
    def overlap_ratio(self) -> Array:
        """epsilon_beta."""
        return np.asarray(self.face_width * np.sin(self.helix_angle) / (np.pi * self.module))

    @cached_property
    def tip_thicknesses(self) -> Array:
        """Normal tooth thickness at the tip circles, negative of pointed teeth [modules]."""
        at_tip = np.arccos(np.minimum(self.base_diameters / self.tip_diameters, 1.0))
        half = (np.pi / 2 + 2.0 * self.profile_shift * np.tan(self.pressure_angle)) / self.teeth
        across = self.tip_diameters * (half + involute(self.transverse_pressure_angle) - involute(at_tip))
        lean = np.arctan(np.tan(self.helix_angle) * self.tip_diameters / self.diameters)
        return np.asarray(across * np.cos(lean) / self.module)

    @cached_property
    def tip_clearances(self) -> Array:
        """Room between each tip and the root circle of the mate [modules]."""
        room = self.centre_distance - 0.5 * (self.tip_diameters + self.root_diameters[::-1])
        return np.asarray(room / self.module)

    @cached_property
    def specific_sliding(self) -> Array:
        """Specific sliding where the mate's tip touches pinion and wheel, its lowest value; -inf at the base circle."""
        ratio = self.teeth / self.teeth[::-1]
        with np.errstate(divide="ignore", invalid="ignore"):
            own = np.where(self.contact_rolls > 0.0, self.contact_rolls, 0.0)
            return np.asarray(1.0 - ratio * (self._line - own) / own)

    @cached_property
    def tooth_loss_factor(self) -> Array:
        """H_V, a share of the friction coefficient: of Ohlendorf for spur pairs, of constant contact lines for others.

        As `fegear.formulas.friction`: `ohlendorf` up to a contact ratio of 2 without overlap, else `overlapping`.
        """
        beyond = 0.5 * self.base_diameters * np.tan(self.working_pressure_angle)
        one, other = (self.tip_rolls - beyond) / self.base_pitch
        factor = np.pi * (1.0 / self.teeth).sum(axis=0) / np.cos(self.base_helix_angle)
        squares, ratio = one * one + other * other, one + other
        spur = (self.helix_angle == 0.0) & (ratio <= 2.0)
        return np.asarray(factor * np.where(spur, 1.0 - ratio + squares, squares / ratio))
