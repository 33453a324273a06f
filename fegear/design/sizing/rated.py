"""Ratings of variants: what a requirement says of load, life, material and quality, applied to arrays of pairs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.formulas.iso6336.conditions import Replacement
from fegear.formulas.many.pairs import ManyPairs
from fegear.formulas.many.ratings import ManyLevels, rate_many, rate_many_spectra
from fegear.formulas.many.shared import ManyConditions, ManyDuties, qualities_of_class

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask
    from fegear.formulas.iso6336.part1_face_load import Alignment
    from fegear.formulas.iso6336.rated import Both, Edition, Strength
    from fegear.geometry.gear import Material
    from fegear.geometry.many_pairs import ManyGearPairs


@dataclass(frozen=True, slots=True)
class DutyLevel:
    """One level of a spectrum: torque over the nominal one, speed over that of the pinion, load cycles of the pinion.

    Parameters
    ----------
    torque, speed : float
    cycles : float
        Of the pinion; those of the wheel are fewer by the ratio.
    """

    torque: float
    speed: float
    cycles: float


@dataclass(frozen=True)
class SizingDuty:
    """What every variant is rated for.

    Parameters
    ----------
    pinion_torque : float
        On the pinion, nominal [N m].
    pinion_speed : float
        Of the pinion [rad/s].
    cycles : float
        N_L of the pinion.
    unlimited : bool
        Whether the wheel has as many: no life is asked for.
    strength : (Strength, Strength)
    material : Material
    grade : int
    flank_roughness, root_roughness : (float, float)
        Rz [m].
    viscosity, application_factor, mesh_load_factor : float
    meshes : (int, int)
    stress_ratio : (float, float)
    mean_stress : (float, float) or None
    alignment : Alignment
    edition, dynamic_method, tip_relief_factor, computed
        As those of `ManyConditions`.
    required : (float, float)
        S_Hmin and S_Fmin.
    levels : tuple of DutyLevel
        Of a spectrum; empty without one.
    annex_c : bool
    """

    pinion_torque: float
    pinion_speed: float
    cycles: float
    unlimited: bool
    strength: tuple[Strength, Strength]
    material: Material
    grade: int
    flank_roughness: Both
    root_roughness: Both
    viscosity: float
    application_factor: float
    mesh_load_factor: float
    meshes: tuple[int, int]
    stress_ratio: Both
    mean_stress: Both | None
    alignment: Alignment
    edition: Edition
    dynamic_method: Literal["B", "C"]
    tip_relief_factor: float | None
    computed: Replacement
    required: Both
    levels: tuple[DutyLevel, ...] = ()
    annex_c: bool = False


@dataclass(frozen=True)
class Safeties:
    """Safety factors of variants, shape (2, N), and why some have none."""

    contact: Array
    bending: Array
    refused: tuple[tuple[str, Mask], ...]

    def margin(self, required: Both) -> Array:
        """Load over the nominal one at which the first safety factor falls to its minimum, shape (N,)."""
        by_flank = (self.contact.min(axis=0) / required[0]) ** 2
        return np.minimum(by_flank, self.bending.min(axis=0) / required[1])


def as_rated(pairs: ManyGearPairs, material: Material) -> ManyPairs:
    """Pairs as ISO 6336 sees them: solid discs bored to half the root diameter."""
    shape = pairs.teeth.shape

    def both(values: Array | float) -> Array:
        return np.broadcast_to(np.asarray(values, dtype=float), shape)

    tip, root = pairs.tip_diameters, pairs.root_diameters
    return ManyPairs(
        pairs.teeth, pairs.profile_shift, pairs.profile_shift, tip, tip, root, 0.5 * root, both(pairs.face_width),
        both(pairs.dedendum), both(pairs.rack_tip_radius), both(0.0), both(np.inf), both(np.nan),
        both(material.young_modulus), both(material.poisson_ratio), both(material.density), pairs.module,
        pairs.pressure_angle, pairs.helix_angle, pairs.centre_distance, pairs.contact_ratio, pairs.face_width,
    )  # fmt: skip


def safeties(pairs: ManyGearPairs, duty: SizingDuty) -> Safeties:
    """S_H and S_F of every pair."""
    rated = as_rated(pairs, duty.material)
    quality = qualities_of_class(duty.grade, rated, duty.flank_roughness, duty.root_roughness)
    tangential = 2.0 * duty.pinion_torque / rated.diameters[0]

    def cycles(of_pinion: float) -> Array:
        turns = np.ones(len(rated)) if duty.unlimited else duty.meshes[1] / duty.meshes[0] / rated.ratio
        return of_pinion * np.array([np.ones(len(rated)), turns])

    speed = np.full(len(rated), duty.pinion_speed)
    loaded = ManyDuties(
        tangential, speed, cycles(duty.cycles), duty.viscosity, duty.application_factor, duty.mesh_load_factor,
        duty.meshes, duty.stress_ratio, duty.mean_stress,
    )  # fmt: skip
    asked = ManyConditions(
        rated, duty.strength, quality, loaded, duty.alignment, duty.edition, duty.dynamic_method, None,
        duty.tip_relief_factor, duty.computed, duty.annex_c,
    )  # fmt: skip
    if not duty.levels:
        found = rate_many(asked)
        return Safeties(found.contact_safety, found.bending_safety, found.refused)
    levels = [ManyLevels(tangential * one.torque, speed * one.speed, cycles(one.cycles)) for one in duty.levels]
    spectrum = rate_many_spectra(asked, levels)
    return Safeties(spectrum.contact_safety, spectrum.bending_safety, spectrum.refused)
