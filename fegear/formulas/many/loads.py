"""Load factors of arrays of pairs: stiffness, K_v, K_Hbeta, K_Fbeta, K_Halpha = K_Falpha (ISO 6336-1).

Equations, their sources and their ranges stand in `fegear.formulas.iso6336`: part1_stiffness, part1_dynamic,
part1_face_load, part1_transverse. A test compares both on random pairs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part1_dynamic, part1_face_load, part1_stiffness
from fegear.formulas.iso6336 import part5_materials as groups
from fegear.formulas.iso6336.rating import LIGHT_ENDS

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.formulas.iso6336.part1_face_load import PinionShaft
    from fegear.formulas.iso6336.rated import Strength
    from fegear.formulas.many.pairs import ManyPairs
    from fegear.formulas.many.shared import ManyConditions


@dataclass(frozen=True, slots=True)
class ManyLoadFactors:
    """Load factors of pairs, shape (N,), and what makes a factor differ."""

    K_v: Array
    K_Hbeta: Array
    K_Fbeta: Array
    K_Halpha: Array
    K_Falpha: Array
    single_stiffness: Array
    mesh_stiffness: Array
    resonance_ratio: Array
    on_tooth: Array


def stiffnesses(pairs: ManyPairs, specific_load: Array) -> tuple[Array, Array]:
    """c' and c_gamma_alpha [Pa] for F_t K_A K_gamma / b [N/m] (ISO 6336-1:2006, 9.3)."""
    z_1, z_2 = np.where(pairs.teeth < 0.0, np.inf, pairs.virtual_teeth)
    x_1, x_2 = pairs.profile_shift
    c = part1_stiffness.COEFFICIENTS
    q = (
        c[0] + c[1] * (1.0 / z_1) + c[2] * (1.0 / z_2) + c[3] * x_1 + c[4] * (x_1 / z_1) + c[5] * x_2
        + c[6] * (x_2 / z_2) + c[7] * (x_1 * x_1) + c[8] * (x_2 * x_2)
    )  # fmt: skip
    angle = 1.0 - 0.02 * (20.0 - np.degrees(pairs.pressure_angle))
    rack = 0.5 * ((1.0 + 0.5 * (1.2 - pairs.dedendum)) * angle).sum(axis=0)
    e_1, e_2 = pairs.young_modulus
    material = 2.0 * e_1 * e_2 / (e_1 + e_2) / part1_stiffness.STEEL
    low_load = np.minimum(specific_load / 1e5, 1.0) ** 0.25
    single = part1_stiffness.UNIT / q * 0.8 * _blank(pairs) * rack * pairs.helix_cosine * low_load * material
    return single, single * (0.75 * pairs.contact_ratio + 0.25)


def _blank(pairs: ManyPairs) -> Array | float:
    """C_R, the mean of both gears."""
    if np.isnan(pairs.web_ratio).all():
        return 1.0
    web = np.clip(pairs.web_ratio, 0.2, 1.2)
    factor = 1.0 + np.log(web) / (5.0 * np.exp(np.maximum(pairs.rim_thickness / pairs.module, 1.0) / 5.0))
    return np.asarray(0.5 * np.where(np.isnan(pairs.web_ratio), 1.0, factor).sum(axis=0))


def _running_in(
    strength: Strength,
    deviation: Array,
    velocity: Array,
    soft: tuple[float, float],
    iron: tuple[float, float, float],
    hard: tuple[float, float],
) -> Array:
    """Part of a deviation [m] of one material that wears off."""
    if strength.group in groups.SURFACE_HARDENED:
        share, most = hard[0], np.asarray(hard[1])
    elif strength.group in groups.SOFT_IRON:
        share, most = iron[0], np.where(velocity > 10.0, iron[2], np.where(velocity > 5.0, iron[1], np.inf))
    else:
        share, limit = soft[0] / strength.contact, soft[1] / strength.contact
        most = np.where(velocity > 10.0, 0.5 * limit, np.where(velocity > 5.0, limit, np.inf))
    return np.minimum(np.minimum(share * deviation, most), deviation)


def pitch_allowances(strength: tuple[Strength, Strength], deviation: Array, velocity: Array) -> Array:
    """y_p of f_pb, y_f of f_falpha: the mean of both materials [m] (ISO 6336-1:2006, 8.3.5.1)."""
    one, other = (
        _running_in(s, deviation, velocity, (160e6, 12800.0), (0.275, 22e-6, 11e-6), (0.075, 3e-6)) for s in strength
    )
    return np.asarray(0.5 * (one + other))


def helix_allowances(strength: tuple[Strength, Strength], misalignment: Array, velocity: Array) -> Array:
    """y_beta, the mean of both materials [m] (ISO 6336-1:2006, 7.5.2.1)."""
    one, other = (
        _running_in(s, misalignment, velocity, (320e6, 25600.0), (0.55, 45e-6, 22e-6), (0.15, 6e-6)) for s in strength
    )
    return np.asarray(0.5 * (one + other))


def _reduced_mass(pairs: ManyPairs, meshes: tuple[int, int]) -> Array:
    """m_red of discs per face width [kg/m]."""
    middle = 0.5 * (pairs.tip_diameter + pairs.root_diameter)
    hollow = np.abs(1.0 - (pairs.bore_diameter / middle) ** 4)
    of_one = math.pi / 8.0 * pairs.density * hollow * middle**4 / pairs.base_diameters**2
    one, other = of_one[0] / meshes[0], of_one[1] / meshes[1]
    both = one * other / (one + other)
    return np.asarray(both if pairs.rings is None else np.where(pairs.rings.fixed > 0.0, one, both))


def _coefficients(total: Array) -> tuple[Array | float, ...]:
    """C_v1 to C_v7 of epsilon_gamma."""
    low, e = total <= 2.0, np.maximum(total, 2.0)
    last = np.where(total <= 1.5, 0.75, np.where(total <= 2.5, 0.125 * np.sin(np.pi * (total - 2.0)) + 0.875, 1.0))
    return (
        0.32, np.where(low, 0.34, 0.57 / (e - 0.3)), np.where(low, 0.23, 0.096 / (e - 1.56)),
        np.where(low, 0.90, (0.57 - 0.05 * e) / (e - 1.44)), 0.47, np.where(low, 0.47, 0.12 / (e - 1.74)), last,
    )  # fmt: skip


def _dynamic_b(
    asked: ManyConditions,
    stiff: tuple[Array, Array],
    specific: Array,
    errors: tuple[Array, Array, Array, Array],
) -> tuple[Array, Array]:
    """K_v by method B and the resonance ratio N."""
    pairs, duty = asked.pairs, asked.duty
    single, mesh = stiff
    pitch, profile, y_p, y_f = errors
    resonance = np.sqrt(mesh / _reduced_mass(pairs, duty.meshes)) / pairs.teeth[0]
    ratio = duty.speed / resonance
    per_length = single / specific
    b_p, b_f = per_length * (pitch - y_p), per_length * (profile - y_f)
    relief = min(asked.quality.tip_relief)
    if relief == 0.0:
        relief = part1_dynamic.running_in_relief((asked.strength[0].contact, asked.strength[1].contact))
    b_k = 1.0 if asked.quality.grade >= 6 else np.abs(1.0 - per_length * relief)
    c = _coefficients(pairs.total_contact_ratio)
    limit = np.where(specific >= 100e3, 0.85, 0.5 + 0.35 * np.sqrt(specific / 100e3))
    main = 1.0 + c[0] * b_p + c[1] * b_f + c[3] * b_k
    above = c[4] * b_p + c[5] * b_f + c[6]
    end, beyond = part1_dynamic.MAIN_END, part1_dynamic.SUPERCRITICAL
    between = above + (main - above) * (beyond - ratio) / (beyond - end)
    below = 1.0 + ratio * (c[0] * b_p + c[1] * b_f + c[2] * b_k)
    k_v = np.where(ratio >= beyond, above, between)
    k_v = np.where(ratio <= end, main, k_v)
    return np.where(ratio <= limit, below, k_v), ratio


def _dynamic_c(pairs: ManyPairs, specific: Array, velocity: Array, grade: int) -> Array:
    """K_v by method C; NaN beyond its range."""
    if not 3 <= grade <= 8:
        raise RangeError("accuracy grade", grade, "must be 3 to 8 for K_v by method C", "use method B")
    u = np.abs(pairs.ratio)
    x = velocity * pairs.teeth[0] / 100.0 * u / np.sqrt(1.0 + u * u)
    load = np.maximum(specific, 100e3) / 1e3
    k_3 = np.where(x <= 0.2, 2.0, 2.071 - 0.357 * x)
    spur, helical = (
        1.0 + (part1_dynamic.K_1[kind][grade - 3] / load + part1_dynamic.K_2[kind]) * x * k_3
        for kind in ("spur", "helical")
    )
    k_v = spur - np.minimum(pairs.overlap_ratio, 1.0) * (spur - helical)
    return np.where(x <= part1_dynamic.NO_K_3, k_v, np.nan)


def _shaft_deformation(shaft: PinionShaft, specific_load: Array, width: Array, diameter: Array) -> Array:
    """f_sh [m]."""
    stiff, free, _most = part1_face_load.SEAT[shaft.arrangement]
    k = np.where(diameter / shaft.diameter >= part1_face_load.STIFFENING, stiff, free)
    torque = 1.0 + 2.0 * (1.0 - shaft.power_share) / shaft.power_share
    bending = k * shaft.bearing_span * shaft.offset / diameter**2 * (diameter / shaft.diameter) ** 4
    twist = np.abs(torque + bending - 0.3) + 0.3
    return np.asarray(specific_load * part1_face_load.BENDING * twist * (width / diameter) ** 2)


def _face_load(asked: ManyConditions, specific: Array, stiffness: Array, velocity: Array) -> Array:
    """K_Hbeta: as given, or by method C; `specific` is F_m/b."""
    alignment, pairs, slopes = asked.alignment, asked.pairs, asked.quality.helix_slope
    if alignment.face_load_factor is not None:
        return np.full(len(pairs), alignment.face_load_factor)
    if alignment.deformation is not None:
        deformation = np.asarray(alignment.deformation)
    elif alignment.computed is not None:
        deformation = np.asarray(alignment.computed * specific)
    elif alignment.shaft is not None:
        deformation = _shaft_deformation(alignment.shaft, specific, pairs.face_width, pairs.diameters[0])
    else:
        raise RangeError("alignment", "no shaft", "K_Hbeta by method C requires the pinion shaft or f_sh")
    manufacture = np.hypot(*slopes) if alignment.manufacture is None else np.asarray(alignment.manufacture)
    least = np.maximum(part1_face_load.LEAST * specific, 0.5 * slopes.max(axis=0))
    b_1, b_2 = part1_face_load.MODIFICATIONS[alignment.modification]
    if alignment.contact_pattern == "verified":
        initial = least
    elif alignment.contact_pattern == "favourable":
        initial = np.maximum(np.abs(1.33 * b_1 * deformation - asked.quality.helix_slope_5), least)
    else:
        initial = np.maximum(1.33 * b_1 * deformation + b_2 * manufacture, least)
    effective = initial - helix_allowances(asked.strength, initial, velocity)
    relative = effective * stiffness / (2.0 * specific)
    return np.where(relative <= 1.0, 1.0 + relative, 2.0 * np.sqrt(relative))


def load_factors(asked: ManyConditions) -> ManyLoadFactors:
    """K_v, K_Hbeta, K_Fbeta, K_Halpha and K_Falpha of every pair."""
    pairs, quality, duty, own = asked.pairs, asked.quality, asked.duty, asked.computed
    applied = duty.applied / pairs.face_width
    single, mesh = stiffnesses(pairs, applied)
    velocity = pairs.pitch_line_velocity(duty.speed)
    pitch, profile = quality.base_pitch.max(axis=0), quality.profile_form.max(axis=0)
    y_p, y_f = (pitch_allowances(asked.strength, one, velocity) for one in (pitch, profile))
    resonance = np.full(len(pairs), np.nan)
    if own.K_v is not None:
        k_v = np.full(len(pairs), own.K_v)
    elif asked.dynamic_method == "C":
        k_v = _dynamic_c(pairs, applied, velocity, quality.grade)
    else:
        k_v, resonance = _dynamic_b(asked, (single, mesh), applied, (pitch, profile, y_p, y_f))
    k_hb = _face_load(asked, applied * k_v, 0.85 * mesh, velocity)
    if asked.alignment.modification in LIGHT_ENDS:
        exponent = np.ones(len(pairs))
    else:
        flat = 1.0 / np.maximum((pairs.face_widths / pairs.depth).min(axis=0), 3.0)
        exponent = 1.0 / (1.0 + flat + flat * flat)
    square = contact_ratio_square(pairs)
    total = pairs.total_contact_ratio
    relative = mesh * (np.maximum(pitch, profile) - y_p) / (applied * k_v * k_hb)
    unlimited = np.where(
        total <= 2.0,
        0.5 * total * (0.9 + 0.4 * relative),
        0.9 + 0.4 * np.sqrt(2.0 * np.maximum(total - 1.0, 0.0) / total) * relative,
    )
    k_ha = np.maximum(np.minimum(unlimited, total / (pairs.contact_ratio * square)), 1.0)
    k_fa = np.maximum(np.minimum(unlimited, total / (0.25 * pairs.contact_ratio + 0.75)), 1.0)
    if own.K_Halpha is not None:
        k_ha = np.full(len(pairs), own.K_Halpha)
    if own.K_Falpha is not None:
        k_fa = np.full(len(pairs), own.K_Falpha[0])
    return ManyLoadFactors(k_v, k_hb, k_hb**exponent, k_ha, k_fa, single, mesh, resonance, applied)


def contact_ratio_square(pairs: ManyPairs) -> Array:
    """Z_epsilon squared (ISO 6336-2, clause 8)."""
    part = np.minimum(pairs.overlap_ratio, 1.0)
    return np.asarray((4.0 - pairs.contact_ratio) / 3.0 * (1.0 - part) + part / pairs.contact_ratio)
