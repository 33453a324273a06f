"""Nominal root stress and what the roots of arrays of pairs bear (ISO 6336-3, gears cut by racks, rings by cutters).

Equations and sources stand in `fegear.formulas.iso6336`: part3_root_stress, part3_internal, part3_pair,
part3_strength; a test compares
both on random pairs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.formulas.iso6336 import part3_root_stress as one_tooth
from fegear.formulas.iso6336 import part3_strength as strength_of
from fegear.formulas.iso6336 import part5_materials as groups
from fegear.formulas.many.lives import ManyKnots

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask
    from fegear.formulas.iso6336.rated import Edition, Strength
    from fegear.formulas.many.loads import ManyLoadFactors
    from fegear.formulas.many.pairs import ManyPairs
    from fegear.formulas.many.shared import ManyConditions

#: Newton steps of the auxiliary angle, and the step at which it has converged.
_STEPS, _CONVERGED = 50, 1e-14


@dataclass(frozen=True, slots=True)
class ManyForms:
    """Critical sections of pinions and wheels, shape (2, N): Y_F without f_epsilon, Y_S, q_s; False where none is."""

    Y_F: Array
    Y_S: Array
    notch: Array
    exists: Mask
    notch_in_range: Mask


def _auxiliary_angle(g: Array, z: Array, h: Array) -> Array:
    """theta; NaN where the fillet has no such tangent."""
    theta, open_ = np.full(g.shape, math.pi / 6), np.ones(g.shape, dtype=bool)
    for _ in range(_STEPS):
        t = np.tan(theta)
        step = (theta - 2.0 * g / z * t + h) / (1.0 - 2.0 * g / z * (1.0 + t * t))
        theta = np.where(open_, theta - step, theta)
        theta = np.where(np.abs(theta) < math.pi / 2, theta, np.nan)
        open_ &= np.abs(step) >= _CONVERGED
        open_ &= np.isfinite(theta)
        if not open_.any():
            break
    return np.where(open_, np.nan, theta)


def root_forms(pairs: ManyPairs) -> ManyForms:
    """Sections under the outer point of single pair contact of the virtual spur pair (ISO 6336-3, 6.2 and 7.2)."""
    z, a, x = pairs.virtual_teeth, pairs.pressure_angle, pairs.generating_shift
    rho_fp, ratio = pairs.rack_tip_radius, pairs.virtual_contact_ratio
    sine, cosine, tangent = np.sin(a), np.cos(a), np.tan(a)
    e = math.pi / 4 - pairs.dedendum * tangent + pairs.residual_undercut / cosine - (1.0 - sine) * rho_fp / cosine
    g = rho_fp - pairs.dedendum + x
    theta = _auxiliary_angle(g, z, 2.0 / z * (math.pi / 2 - e) - math.pi / 3)
    c = np.cos(theta)
    s = z * np.sin(math.pi / 3 - theta) + math.sqrt(3.0) * (g / c - rho_fp)
    rho = rho_fp + 2.0 * g * g / (c * (z * c * c - 2.0 * g))
    base = z * cosine
    tip = z + (pairs.active_tip_diameter - pairs.diameters) / pairs.module
    reach = 0.5 * np.sqrt(np.maximum(tip**2 - base**2, 0.0)) - math.pi * cosine * (ratio - 1.0)
    load = 2.0 * np.hypot(reach, 0.5 * base)
    alpha_e = np.arccos(np.minimum(base / load, 1.0))
    gamma = (math.pi / 2 + 2.0 * x * tangent) / z + (tangent - a) - (np.tan(alpha_e) - alpha_e)
    alpha_f = alpha_e - gamma
    height = 0.5 * (z * np.cos(math.pi / 3 - theta) + g / c - rho_fp)
    h = 0.5 * (np.cos(gamma) - np.sin(gamma) * np.tan(alpha_f)) * load - height
    exists = (
        (e >= -1e-12) & (theta >= 0.0) & (theta <= math.pi / 2 - a + 1e-9) & (reach >= 0.0) & (gamma > 0.0)
        & (s > 0.0) & (h > 0.0) & (rho > 0.0) & (rho_fp > 0.0)
    )  # fmt: skip
    s, h, rho = (np.where(exists, one, 1.0) for one in (s, h, rho))
    y_f = 6.0 * h * np.cos(alpha_f) / (s * s * cosine)
    length, q = s / h, s / (2.0 * rho)
    y_s = (1.2 + 0.13 * length) * q ** (1.0 / (1.21 + 2.3 / length))
    external = ManyForms(y_f, y_s, q, exists, (q >= 1.0) & (q < 8.0))
    return external if pairs.rings is None else _with_rings(external, pairs)


def _with_rings(external: ManyForms, pairs: ManyPairs) -> ManyForms:
    """The same with the sections of wheels that are ring gears; as `part3_internal.ring_root_form`."""
    assert pairs.rings is not None  # noqa: S101  (for mypy)
    internal, z, a = pairs.internal, pairs.virtual_teeth[1], pairs.pressure_angle
    x, dedendum, rho_fp = pairs.rings.generating_shift, pairs.rings.dedendum, pairs.rings.rack_rounding
    sine, cosine, tangent = np.sin(a), np.cos(a), np.tan(a)
    e = math.pi / 4 - dedendum * tangent - (1.0 - sine) * rho_fp / cosine
    g = rho_fp - dedendum + x
    theta = _auxiliary_angle(g, z, 2.0 / z * (math.pi / 2 - e) - math.pi / 6)
    c = np.cos(theta)
    s = z * np.sin(math.pi / 6 - theta) + g / c - rho_fp
    rho = rho_fp + 2.0 * g * g / (c * (-z * c * c - 2.0 * g))
    base = -z * cosine
    tip = -z + (pairs.active_tip_diameter[1] + pairs.diameters[1]) / pairs.module
    reach = np.sqrt(np.maximum(0.25 * tip**2 - 0.25 * base**2, 0.0))
    load = 2.0 * np.hypot(reach + math.pi * cosine * (pairs.virtual_contact_ratio - 1.0), 0.5 * base)
    alpha_e = np.arccos(np.minimum(base / load, 1.0))
    gamma = (math.pi / 2 + 2.0 * x * tangent) / z + (tangent - a) - (np.tan(alpha_e) - alpha_e)
    alpha_f = alpha_e - gamma
    height = 0.5 * (z * np.cos(math.pi / 6 - theta) + math.sqrt(3.0) * (g / c - rho_fp))
    h = -0.5 * (np.cos(gamma) - np.sin(gamma) * np.tan(alpha_f)) * load - height
    exists = (theta >= 0.0) & (theta <= math.pi / 2 - a + 1e-9) & (s > 0.0) & (h > 0.0) & (rho > 0.0)
    s, h, rho = (np.where(exists, one, 1.0) for one in (s, h, rho))
    length, q = s / h, s / (2.0 * rho)
    forms = ManyForms(
        6.0 * h * np.cos(alpha_f) / (s * s * cosine), (1.2 + 0.13 * length) * q ** (1.0 / (1.21 + 2.3 / length)), q,
        exists, (q >= 1.0) & (q < 8.0),
    )  # fmt: skip

    values, masks = (
        [np.stack([outer[0], np.where(internal, inner, outer[1])]) for outer, inner in of]
        for of in (
            ((external.Y_F, forms.Y_F), (external.Y_S, forms.Y_S), (external.notch, forms.notch)),
            ((external.exists, forms.exists), (external.notch_in_range, forms.notch_in_range)),
        )
    )
    return ManyForms(values[0], values[1], values[2], masks[0], masks[1])


def _load_distribution(ratio: Array, overlap: Array, edition: Edition) -> Array | float:
    if edition == 2006:
        return 1.0
    part = np.minimum(overlap, 1.0)
    helical = np.sqrt((1.0 - part) / np.where(ratio < 2.0, 1.0, 2.0) + part / ratio)
    return np.where(overlap == 0.0, np.where(ratio < 2.0, 1.0, 0.7), helical)


def _rims(pairs: ManyPairs) -> Array:
    """Y_B; NaN below the thinnest rim."""
    backup = pairs.rim_thickness / pairs.depth
    with np.errstate(divide="ignore"):
        thin = 1.6 * np.log(2.242 / np.where(backup > one_tooth.LEAST_RIM, backup, np.nan))
        over = pairs.rim_thickness / pairs.module
        ring = 1.15 * np.log(8.324 / np.where(over > one_tooth.LEAST_RING, over, np.nan))
    external = np.where(backup >= one_tooth.SOLID_RIM, 1.0, thin)
    return np.where(pairs.teeth < 0.0, np.where(over >= one_tooth.SOLID_RING, 1.0, ring), external)


def bending_stresses(asked: ManyConditions, factors: ManyLoadFactors, forms: ManyForms) -> Array:
    """sigma_F of pinion and wheel [Pa], shape (2, N)."""
    pairs, duty = asked.pairs, asked.duty
    width = np.minimum(pairs.face_widths, pairs.face_width + 2.0 * pairs.module)
    ratio, overlap = pairs.virtual_contact_ratio, pairs.overlap_ratio
    beta = np.minimum(pairs.helix_angle, math.radians(30.0))
    helix = 1.0 - np.minimum(overlap, 1.0) * np.degrees(beta) / 120.0
    if asked.edition != 2006:
        helix = helix / np.cos(beta) ** 3
    deep: Array | float = 1.0
    if asked.quality.grade <= 4:
        deep = np.where(ratio <= 2.05, 1.0, np.where(ratio > 2.5, 0.7, -0.666 * ratio + 2.366))
    shared = _load_distribution(ratio, overlap, asked.edition)
    product = forms.Y_F * shared * forms.Y_S * helix * _rims(pairs) * deep
    nominal = duty.tangential / width / pairs.module * product
    applied = duty.application_factor * duty.mesh_load_factor * factors.K_v
    return np.asarray(nominal * applied * factors.K_Fbeta * factors.K_Falpha)


def _size_factor(group: groups.Group, module: Array) -> Array:
    mm = module * 1e3
    if group in groups.SURFACE_HARDENED:
        large = np.maximum(1.05 - 0.010 * mm, 0.80)
    elif group in groups.SOFT_IRON:
        large = np.maximum(1.075 - 0.015 * mm, 0.70)
    else:
        large = np.maximum(1.03 - 0.006 * mm, 0.85)
    return np.where(mm <= 5.0, 1.0, large)


def _mean_stress(strength: Strength, asked: ManyConditions, i: int, y_s: Array, *, static: bool) -> Array | float:
    """Y_M of one gear."""
    if asked.duty.mean_stress is not None:
        return asked.duty.mean_stress[i]
    ratio = asked.duty.stress_ratio[i]
    if not ratio:
        return 1.0
    if strength.group == "Eh" and not static:
        m: Array | float = 0.8 - 0.15 * y_s
    else:
        m = strength_of.mean_stress_ratio(strength.group, 2.0, static=static)
    return 1.0 / (1.0 - ratio * (1.0 - m) / (1.0 + m))


def root_lines(asked: ManyConditions, forms: ManyForms) -> tuple[ManyKnots, ManyKnots]:
    """Permissible root stress of pinion and wheel over load cycles for a safety of 1."""
    lines = []
    for i, strength in enumerate(asked.strength):
        y_s = forms.Y_S[i]
        layer, _ = strength_of.slip_layer(strength)
        reference = 0.2e3 * (1.0 + 2.0 * strength_of.REFERENCE_NOTCH)
        delta = (1.0 + np.sqrt(layer * (0.2e3 * (1.0 + 2.0 * forms.notch[i])))) / (1.0 + math.sqrt(layer * reference))
        surface, _ = strength_of.surface_factor(strength.group, asked.quality.root_roughness[i])
        # linear in Y_S: two values give the line
        at_1, at_2 = (strength_of.static_notch_sensitivity(strength, one) for one in (1.0, 2.0))
        static = at_1 + (at_2 - at_1) * (y_s - 1.0)
        endured = delta * surface * _size_factor(strength.group, asked.pairs.module)
        endured = endured * _mean_stress(strength, asked, i, y_s, static=False)
        static = static * _mean_stress(strength, asked, i, y_s, static=True)
        base, knots = strength.bending * strength_of.STANDARD_GEAR, strength_of.life_knots(strength)
        values = tuple(base * v * f for v, f in zip(knots.values, (static, endured, endured), strict=True))
        lines.append(ManyKnots(knots.cycles, values).falling)
    return lines[0], lines[1]
