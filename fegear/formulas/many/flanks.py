"""Contact stress and what the flanks of arrays of pairs bear (ISO 6336-2).

Equations and sources stand in `fegear.formulas.iso6336.part2_pitting`; a test compares both on random pairs.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas.iso6336 import part2_pitting as one_pair
from fegear.formulas.iso6336 import part5_materials as groups
from fegear.formulas.iso6336.part1_dynamic import running_in_relief
from fegear.formulas.many.lives import ManyKnots
from fegear.formulas.many.loads import contact_ratio_square

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.formulas.many.loads import ManyLoadFactors
    from fegear.formulas.many.pairs import ManyPairs
    from fegear.formulas.many.shared import ManyConditions


def tip_relief_factor(asked: ManyConditions) -> float:
    """f_ZCa of helical pairs."""
    if asked.edition == 2006:
        return 1.0
    if asked.tip_relief_factor is not None:
        return asked.tip_relief_factor
    relief = asked.tip_relief
    if relief is None:
        worn = running_in_relief((asked.strength[0].contact, asked.strength[1].contact))
        relief = "experience" if all(c_a > worn for c_a in asked.quality.tip_relief) else "none"
    return one_pair.tip_relief_factor(relief, asked.edition)


def single_pair_factors(pairs: ManyPairs, tip_relief: float) -> Array:
    """Z_B and Z_D, shape (2, N); NaN where a single pair contact point lies below a base circle."""
    e = pairs.contact_ratio
    tips = np.sqrt(np.maximum((pairs.active_tip_diameter / pairs.base_diameters) ** 2 - 1.0, 0.0))
    steps = 2.0 * np.pi / pairs.teeth
    part = np.minimum(pairs.overlap_ratio, 1.0)
    angle, helical, found = np.tan(pairs.working_pressure_angle), math.sqrt(tip_relief), []
    for i, k in ((0, 1), (1, 0)):
        product = (tips[i] - steps[i]) * (tips[k] - (e - 1.0) * steps[k])
        m = angle / np.sqrt(np.where(product > 0.0, product, np.nan))
        z = np.where(pairs.helix_angle != 0.0, m - part * (m - helical), m)
        if i == 1:
            z = np.where(pairs.internal & np.isfinite(z), 1.0, z)  # Z_D of a ring gear is 1 always (6.2)
        found.append(np.where(e >= 2.0, 1.0, np.maximum(z, 1.0)))
    return np.array(found)


def contact_stresses(asked: ManyConditions, factors: ManyLoadFactors) -> Array:
    """sigma_H of pinion and wheel [Pa], shape (2, N)."""
    pairs, duty = asked.pairs, asked.duty
    z_h = np.sqrt(
        2.0 * pairs.base_helix_cosine
        / (np.cos(pairs.transverse_pressure_angle) ** 2 * np.tan(pairs.working_pressure_angle))
    )  # fmt: skip
    z_e = np.sqrt(1.0 / (np.pi * ((1.0 - pairs.poisson_ratio**2) / pairs.young_modulus).sum(axis=0)))
    z_eps, z_beta = np.sqrt(np.maximum(contact_ratio_square(pairs), 0.0)), 1.0 / np.sqrt(pairs.helix_cosine)
    u = pairs.ratio
    load = duty.tangential * (u + 1.0) / (pairs.diameters[0] * pairs.face_width * u)
    nominal = z_h * z_e * z_eps * z_beta * np.sqrt(load)
    applied = duty.application_factor * duty.mesh_load_factor * factors.K_v * factors.K_Hbeta * factors.K_Halpha
    return np.asarray(single_pair_factors(pairs, tip_relief_factor(asked)) * nominal * np.sqrt(applied))


def _work_hardening(asked: ManyConditions, velocity: Array) -> tuple[list[Array | float], list[Array | float]]:
    """Z_W of both gears at reference and static."""
    strength, rough = asked.strength, asked.quality.flank_roughness
    hard = [s.group in groups.SURFACE_HARDENED for s in strength]
    reference: list[Array | float] = [1.0, 1.0]
    static: list[Array | float] = [1.0, 1.0]
    if hard[0] != hard[1]:
        soft = 1 if hard[0] else 0
        known = strength[soft].group in groups.NORMALIZED | groups.THROUGH_HARDENED
        if not known or math.isnan(strength[soft].hardness):
            return reference, static
        own, other = rough[1 - soft], rough[soft]
        value = own * (10e-3 / asked.pairs.relative_curvature_radius) ** 0.33 * (own / other) ** 0.66
        value = value / (velocity * asked.duty.viscosity * 1e6 / 1500.0) ** 0.33
        equivalent = np.clip(value, 3e-6, 16e-6)
        part = (min(max(strength[soft].hardness, 130.0), 470.0) - 130.0) / 340.0
        reference[soft] = (1.2 - 0.2 * part) * (3e-6 / equivalent) ** 0.15
        static[soft] = 1.05 - 0.05 * part
    elif all(s.group in groups.THROUGH_HARDENED for s in strength):
        hardness = strength[0].hardness / strength[1].hardness
        if not math.isnan(hardness) and hardness >= 1.2:
            slope = 0.00698 if hardness > 1.7 else 0.00898 * hardness - 0.00829
            grown = np.maximum(1.0 + slope * (np.minimum(np.abs(asked.pairs.ratio), one_pair.LARGEST_RATIO) - 1.0), 1.0)
            reference[1] = static[1] = grown
    return reference, static


def flank_lines(asked: ManyConditions) -> tuple[ManyKnots, ManyKnots]:
    """Permissible contact stress of pinion and wheel over load cycles for a safety of 1."""
    pairs, duty, strength = asked.pairs, asked.duty, asked.strength
    velocity = pairs.pitch_line_velocity(duty.speed)
    softer = min(s.contact for s in strength)
    z_l = one_pair.lubricant_factor(softer, duty.viscosity)
    c_v = one_pair.between(softer, 0.85, 0.93)
    z_v = c_v + 2.0 * (1.0 - c_v) / np.sqrt(0.8 + 32.0 / velocity)
    mean = 0.5 * sum(asked.quality.flank_roughness)
    relative = mean * (10e-3 / pairs.relative_curvature_radius) ** (1.0 / 3.0)
    z_r = (3e-6 / relative) ** one_pair.between(softer, 0.15, 0.08)
    z_w, z_w_static = _work_hardening(asked, velocity)
    lines = []
    for i, material in enumerate(strength):
        knots = one_pair.life_knots(material)
        film = z_l * z_v * z_r * z_w[i]
        reference = len(knots.cycles) - 2
        whole = math.log(knots.cycles[reference] / knots.cycles[0])
        shares = [min(math.log(n / knots.cycles[0]) / whole, 1.0) for n in knots.cycles]
        values = tuple(
            (material.contact * v) * (z_w_static[i] * (film / z_w_static[i]) ** p)
            for v, p in zip(knots.values, shares, strict=True)
        )
        lines.append(ManyKnots(knots.cycles, values).falling)
    return lines[0], lines[1]
