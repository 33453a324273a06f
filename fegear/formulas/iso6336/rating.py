"""Load factors of a rating: stiffness, K_v, K_Hbeta, K_Fbeta, K_Halpha, K_Falpha in ISO 6336-1's order, all tabled.

The flanks of a rating: contact stress and what the flanks bear, in ISO 6336-2's order, all factors tabled.

The roots of a rating: root stress and what the roots bear, in ISO 6336-3's order, all factors tabled.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.base.printed import percent
from fegear.formulas.iso6336 import part1_dynamic as dynamic
from fegear.formulas.iso6336 import part1_face_load as misalignment
from fegear.formulas.iso6336 import part1_transverse as running_in
from fegear.formulas.iso6336 import part1_transverse as transverse
from fegear.formulas.iso6336 import part2_pitting as contact
from fegear.formulas.iso6336.conditions import COMPUTED, Conditions, FactorTable, Replacement
from fegear.formulas.iso6336.part1_face_load import root_exponent
from fegear.formulas.iso6336.part1_stiffness import Stiffness, blank_factor, pair_blank_factor, stiffness
from fegear.formulas.iso6336.part2_pitting import FlankStrength, contact_ratio_factor, flank_strength
from fegear.formulas.iso6336.part3_internal import outline_root_form, ring_root_form, ring_tooth
from fegear.formulas.iso6336.part3_pair import RatingChoice, RootRating, ToothLoad, rate, rate_form
from fegear.formulas.iso6336.part3_root_stress import (
    RackTooth,
    outer_single_contact_diameter,
    rim_factor,
    ring_rim_factor,
    virtual_teeth,
)
from fegear.formulas.iso6336.part3_strength import STANDARD_GEAR, RootStrength, root_strength

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Both


#: What takes load off the ends of the face.
LIGHT_ENDS = {"crowned", "crowned for manufacture", "helix corrected and crowned", "end relief"}


#: Equations of K_v in the ranges of the resonance ratio.
_EQUATION = {"subcritical": 13, "main resonance": 20, "supercritical": 21, "intermediate": 22}


@dataclass(frozen=True, slots=True)
class LoadFactors:
    """Load factors of a pair."""

    K_v: float
    K_Hbeta: float
    K_Fbeta: Both
    K_Halpha: float
    K_Falpha: Both


def _stiffness(table: FactorTable, conditions: Conditions, specific_load: float) -> Stiffness:
    pair = conditions.geometry
    one, two = pair.gears
    bodies = [(g.web_ratio, math.inf if g.rim_thickness is None else g.rim_thickness / pair.module) for g in pair.gears]
    found = stiffness(
        (one.signed_teeth, two.signed_teeth),
        pair.contact_ratio,
        helix_angle=pair.helix_angle,
        profile_shift=(one.profile_shift, two.profile_shift),
        dedendum=(one.dedendum, two.dedendum),
        pressure_angle=pair.pressure_angle,
        blank=pair_blank_factor(bodies),
        specific_load=specific_load,
        young_modulus=(one.young_modulus, two.young_modulus),
    )
    table.add("C_R", (blank_factor(*bodies[0]), blank_factor(*bodies[1])), "ISO 6336-1:2006, 9.3.1.3, Eqs. 84 and 85")
    table.add("c'_th", found.theoretical, "ISO 6336-1:2006, 9.3.1.1, Eqs. 81 and 82", found.remark)
    table.add("c'", found.single, "ISO 6336-1:2006, 9.3.1, Eq. 80")
    short = ""
    if pair.contact_ratio < 1.2:
        short = f"c_gamma_alpha: up to 10 % lower for a contact ratio below 1.2 ({pair.contact_ratio:.3g})"
    table.add("c_gamma_alpha", found.mesh_alpha, "ISO 6336-1:2006, 9.3.2, Eq. 91", short)
    table.add("c_gamma_beta", found.mesh_beta, "ISO 6336-1:2006, 9.3.2, Eq. 92")
    return found


def _dynamic(
    table: FactorTable, conditions: Conditions, computed: Replacement, stiff: Stiffness, specific_load: float
) -> tuple[float, float, float]:
    """K_v, the deviation that shares the load among tooth pairs, and y_alpha."""
    pair, quality, duty = conditions.geometry, conditions.quality, conditions.duty
    velocity = pair.pitch_line_velocity(duty.speed)
    pitch = max(q.base_pitch for q in quality)
    profile = max(q.profile_form for q in quality)
    y_p, y_f = (
        running_in.mean(
            (
                running_in.pitch_allowance(conditions.strength[0], deviation, velocity),
                running_in.pitch_allowance(conditions.strength[1], deviation, velocity),
            )
        )
        for deviation in (pitch, profile)
    )
    table.add("f_pb", pitch, "ISO 1328-1, the worse gear")
    table.add("f_falpha", profile, "ISO 1328-1, the worse gear")
    shared = max(pitch, profile)  # footnote 12 of 8.3.2: a larger form deviation stands for f_pb
    table.add("y_alpha", y_p, "ISO 6336-1:2006, 8.3.5.1, Eqs. 75 to 77")
    grade = max(q.grade for q in quality)
    if computed.K_v is not None:
        table.add("K_v", computed.K_v, "ISO 6336-1, clause 6", f"K_v: {COMPUTED}")
        return computed.K_v, shared, y_p
    if conditions.dynamic_method == "C":
        found = dynamic.method_c(pair, specific_load, velocity, grade)
        table.add("K_v", found.K_v, "ISO 6336-1:2006, 6.5, method C", found.remark)
        return found.K_v, shared, y_p
    relief = min(q.tip_relief for q in quality)
    if relief == 0.0:
        relief = dynamic.running_in_relief((conditions.strength[0].contact, conditions.strength[1].contact))
    errors = dynamic.DynamicErrors(pitch, profile, y_p, y_f, relief, coarse=grade >= 6)
    found = dynamic.method_b(pair, (stiff.single, stiff.mesh_alpha), specific_load, duty.speed, errors, duty.meshes)
    table.add("m_red", found.reduced_mass, "ISO 6336-1:2006, 6.4.8, Eq. 30")
    table.add("n_E1", found.resonance_speed, "ISO 6336-1:2006, 6.4.2, Eq. 6")
    table.add("N", found.resonance_ratio, "ISO 6336-1:2006, 6.4.2, Eq. 9")
    table.add("N_S", found.lower_limit, "ISO 6336-1:2006, 6.4.2, Eqs. 11 and 12")
    table.add("y_p", y_p, "ISO 6336-1:2006, 6.4.3, Eq. 18")
    table.add("y_f", y_f, "ISO 6336-1:2006, 6.4.3, Eq. 19")
    table.add("C_a", relief, "ISO 6336-1:2006, 6.4.3 and table 4")
    for name, value, equation in zip(("B_p", "B_f", "B_k"), found.load_parameters, (15, 16, 17), strict=True):
        table.add(name, value, f"ISO 6336-1:2006, 6.4.3, Eq. {equation}")
    for i, value in enumerate(found.coefficients, 1):
        table.add(f"C_v{i}", value, "ISO 6336-1:2006, 6.4.3, table 4")
    table.add(
        "K_v",
        found.K_v,
        f"ISO 6336-1:2006, 6.4, Eq. {_EQUATION[found.range]}, method B, {found.range}",
        remark=found.remark,
    )
    return found.K_v, shared, y_p


def load_factors(table: FactorTable, conditions: Conditions, computed: Replacement) -> LoadFactors:
    """K_v, K_Hbeta, K_Fbeta, K_Halpha and K_Falpha, with what they are made of in the table."""
    pair, duty = conditions.geometry, conditions.duty
    applied = duty.tangential * duty.application_factor * duty.mesh_load_factor / pair.face_width  # F_t K_A K_gamma / b
    stiff = _stiffness(table, conditions, applied)
    k_v, shared, worn = _dynamic(table, conditions, computed, stiff, applied)
    k_hb = _face_load(table, conditions, computed, applied * k_v, stiff.mesh_beta)
    width = (pair.gears[0].face_width, pair.gears[1].face_width)
    depth = (pair.gears[0].depth, pair.gears[1].depth)
    if computed.K_Fbeta is not None:
        k_fb = computed.K_Fbeta
        table.add("K_Fbeta", k_fb, "ISO 6336-1, clause 7", f"K_Fbeta: {COMPUTED}")
    else:
        # lightly loaded ends bend no less than the middle (7.6; IACS UR M56, 1.6.4 b)
        light = conditions.alignment.modification in LIGHT_ENDS and computed.K_Hbeta is None
        exponent = 1.0 if light else root_exponent(width, depth)
        k_fb = (k_hb**exponent, k_hb**exponent)
        table.add("N_F", exponent, "ISO 6336-1:2006, 7.6, Eq. 70")
        table.add("K_Fbeta", k_fb, "ISO 6336-1:2006, 7.6, Eq. 69")
    z_e = contact_ratio_factor(pair.contact_ratio, pair.overlap_ratio)
    across = transverse.method_b(
        pair.contact_ratio, pair.overlap_ratio, stiff.mesh_alpha, shared - worn, applied * k_v * k_hb, z_e
    )
    k_ha, k_fa = across.K_Halpha, (across.K_Falpha, across.K_Falpha)
    marks = ["", ""]
    if computed.K_Halpha is not None:
        k_ha, marks[0] = computed.K_Halpha, f"K_Halpha: {COMPUTED}"
    if computed.K_Falpha is not None:
        k_fa, marks[1] = computed.K_Falpha, f"K_Falpha: {COMPUTED}"
    table.add("K_Halpha", k_ha, "ISO 6336-1:2006, 8.3.2 and 8.3.3, Eqs. 71 to 73, method B", marks[0])
    table.add("K_Falpha", k_fa, "ISO 6336-1:2006, 8.3.2 and 8.3.4, Eqs. 71, 72, 74, method B", marks[1])
    return LoadFactors(k_v, k_hb, k_fb, k_ha, k_fa)


def _face_load(
    table: FactorTable, conditions: Conditions, computed: Replacement, specific_load: float, mesh_stiffness: float
) -> float:
    """K_Hbeta: computed, given, or by method C."""
    if computed.K_Hbeta is not None:
        table.add("K_Hbeta", computed.K_Hbeta, "ISO 6336-1, clause 7", f"K_Hbeta: {COMPUTED}")
        return computed.K_Hbeta
    pair = conditions.geometry
    velocity = pair.pitch_line_velocity(conditions.duty.speed)
    found = misalignment.method_c(
        pair, conditions.alignment, conditions.strength, conditions.quality, specific_load, mesh_stiffness, velocity
    )
    table.add("F_m/b", specific_load, "ISO 6336-1:2006, 7.2")
    if not math.isnan(found.initial):
        table.add("f_sh", found.deformation, "ISO 6336-1:2006, 7.5.2.4, Eq. 57", found.remark)
        table.add("f_ma", found.manufacture, "ISO 6336-1:2006, 7.5.2, Eq. 64")
        table.add("B_1", found.constants[0], "ISO 6336-1:2006, 7.5.2.2, table 8")
        little = found.constants != misalignment.MODIFICATIONS[conditions.alignment.modification]
        counts = f"B_2: lead crowning below {misalignment.FULL_CROWNING:g} f_ma counts in proportion" if little else ""
        table.add("B_2", found.constants[1], "ISO 6336-1:2006, 7.5.2.2, table 8", counts)
        table.add("F_betaxmin", found.least, "ISO 6336-1:2006, 7.5.2, Eqs. 55 and 56")
        table.add("F_betax", found.initial, "ISO 6336-1:2006, 7.5.2.2, Eqs. 52 and 53")
        table.add("y_beta", found.run_in, "ISO 6336-1:2006, 7.5.2.1, Eqs. 44 to 48")
        table.add("F_betay", found.effective, "ISO 6336-1:2006, 7.5.2.1, Eq. 43")
        table.add("K_Hbeta", found.K_Hbeta, "ISO 6336-1:2006, 7.5, Eqs. 39 and 41, method C")
    else:
        table.add("K_Hbeta", found.K_Hbeta, "ISO 6336-1, clause 7", found.remark)
    return found.K_Hbeta


def contact_stress(table: FactorTable, conditions: Conditions, loads: LoadFactors) -> Both:
    """sigma_H of both gears [Pa], with its factors in the table."""
    pair, duty, edition = conditions.geometry, conditions.duty, conditions.edition
    part = f"ISO 6336-2:{edition}"
    z_h, z_e = contact.zone_factor(pair), contact.elasticity_factor(pair)
    z_eps = contact.contact_ratio_factor(pair.contact_ratio, pair.overlap_ratio)
    z_beta = contact.helix_factor(pair.helix_angle)
    relief, recalled = _tip_relief(conditions)
    inner, single = contact.single_pair_factors(pair, relief)
    table.add("Z_H", z_h, f"{part}, clause 6")
    table.add("Z_E", z_e, f"{part}, clause 7")
    table.add("Z_epsilon", z_eps, f"{part}, clause 8")
    table.add("Z_beta", z_beta, f"{part}{'/Cor.1:2008' if edition == 2006 else ''}, clause 9")
    if edition == 2019:
        table.add("f_ZCa", relief, f"{part}, 6.3", recalled)
    table.add("M", inner, f"{part}, 6.2")
    table.add("Z_BD", single, f"{part}, 6.2")
    nominal = contact.nominal_contact_stress(pair, duty.tangential, (z_h, z_e, z_eps, z_beta))
    load = duty.application_factor * duty.mesh_load_factor * loads.K_v * loads.K_Hbeta * loads.K_Halpha
    stress = (single[0] * nominal * math.sqrt(load), single[1] * nominal * math.sqrt(load))
    table.add("sigma_H0", nominal, f"{part}, 5.2")
    table.add("sigma_H", stress, f"{part}, 5.2")
    return stress


def _tip_relief(conditions: Conditions) -> tuple[float, str]:
    """f_ZCa and what is to be said of it."""
    if conditions.geometry.helix_angle == 0.0 or conditions.edition == 2006:
        return 1.0, ""
    if conditions.tip_relief_factor is not None:
        return conditions.tip_relief_factor, "f_ZCa: as specified"
    value = contact.tip_relief_factor(conditions.relieved, conditions.edition)
    tips, least = contact.TIPS[conditions.relieved], min(one.tip_relief for one in conditions.quality)
    if conditions.relieved == "none" and conditions.tip_relief is None and least > 0.0:
        worn = dynamic.running_in_relief((conditions.strength[0].contact, conditions.strength[1].contact))
        tips = f"whose tip relief of {least * 1e6:.3g} um does not exceed that of running in, {worn * 1e6:.2g} um,"
    return value, contact.RECALLED.format(value=value, tips=tips)


def permissible_contact(table: FactorTable, conditions: Conditions) -> tuple[FlankStrength, FlankStrength]:
    """What both flanks bear, with its factors in the table."""
    found = flank_strength(conditions.geometry, conditions.strength, conditions.quality, conditions.duty)
    part = f"ISO 6336-2:{conditions.edition}"
    one, two = found
    table.add("sigma_Hlim", (conditions.strength[0].contact, conditions.strength[1].contact), "ISO 6336-5")
    table.add("Z_NT", (one.Z_NT, two.Z_NT), f"{part}, clause 11, table 2")
    table.add("Z_L", (one.Z_L, two.Z_L), f"{part}, clause 12")
    table.add("Z_v", (one.Z_v, two.Z_v), f"{part}, clause 12")
    table.add("Z_R", (one.Z_R, two.Z_R), f"{part}, clause 12")
    table.add("Z_W", (one.Z_W, two.Z_W), f"{part}, clause 13", one.remark)
    table.add("Z_X", (one.Z_X, two.Z_X), f"{part}, clause 14")
    table.add("sigma_HG_static", (one.static, two.static), f"{part}, 5.3")
    table.add("sigma_HG_reference", (one.reference, two.reference), f"{part}, 5.3")
    bound = ""
    if one.static_rules or two.static_rules:
        bound = (
            "sigma_HG: limited to the static strength of nitrocarburized flanks (Z_NT = 1.1), exceeded otherwise by "
            "Z_L Z_v Z_R Z_W"
        )
    table.add("sigma_HG", (one.permissible, two.permissible), f"{part}, 5.3", bound)
    least = conditions.required[0]
    table.add("S_Hmin", least, f"{part}, 5.1, as specified")
    table.add("sigma_HP", (one.permissible / least, two.permissible / least), f"{part}, 5.3")
    return found


def _root_width(pair: PairGeometry, i: int) -> float:
    """Face width of a gear's root: its own, but at most one module beyond the common one on either side."""
    return min(pair.gears[i].face_width, pair.face_width + 2.0 * pair.module)


def _root_rating(conditions: Conditions, i: int) -> RootRating:
    """Nominal root stress of one gear under F_t, through its virtual tooth."""
    pair, gear = conditions.geometry, conditions.geometry.gears[i]
    load = ToothLoad(
        conditions.duty.tangential / _root_width(pair, i),
        pair.virtual_contact_ratio,
        pair.overlap_ratio,
        pair.helix_angle,
        deep=True,
    )
    choice = RatingChoice(conditions.edition, max(q.grade for q in conditions.quality))
    if gear.outline is not None:
        rim = 1.0 if gear.rim_thickness is None else ring_rim_factor(gear.rim_thickness / pair.module)
        ring = ring_tooth(gear.outline)
        depth = (gear.active_tip_diameter + pair.signed_diameters[i]) / pair.module
        at = ring.load_diameter(ring.teeth + depth, load.contact_ratio)
        form = ring_root_form(ring, at) if gear.formed is None else outline_root_form(gear.formed, at)
        return rate_form(-ring.teeth, form, at, pair.module, load, choice, rim)
    z_n = virtual_teeth(gear.teeth, pair.helix_angle, pair.pressure_angle)
    tooth = RackTooth(
        z_n, gear.generating_shift, gear.dedendum, gear.tip_radius, pair.pressure_angle, gear.residual_undercut
    )
    tip = z_n + (gear.active_tip_diameter - pair.signed_diameters[i]) / pair.module
    at = outer_single_contact_diameter(tooth, tip, load.contact_ratio)
    backup = math.inf if gear.rim_thickness is None else gear.rim_thickness / gear.depth
    if gear.formed is not None:
        rim = 1.0 if math.isinf(backup) else rim_factor(backup, 1.0)
        return rate_form(z_n, outline_root_form(gear.formed, at), at, pair.module, load, choice, rim)
    return rate(tooth, at, pair.module, load, choice, backup)


def root_stress(
    table: FactorTable, conditions: Conditions, loads: LoadFactors, computed: Replacement
) -> tuple[Both, tuple[RootRating, RootRating]]:
    """sigma_F of both gears [Pa] and their nominal root stresses, with their factors in the table."""
    pair, duty = conditions.geometry, conditions.duty
    part = f"ISO 6336-3:{conditions.edition}"
    found = (_root_rating(conditions, 0), _root_rating(conditions, 1))

    def both(name: str) -> Both:
        return getattr(found[0], name), getattr(found[1], name)

    def of_form(name: str, scale: float = 1.0) -> Both:
        return getattr(found[0].form, name) * scale, getattr(found[1].form, name) * scale

    table.add("z_n", both("teeth"), f"{part}, 6.2")
    table.add("epsilon_alpha_n", pair.virtual_contact_ratio, f"{part}, 6.2")
    table.add("d_en", (found[0].load_diameter * pair.module, found[1].load_diameter * pair.module), f"{part}, 6.2")
    table.add("alpha_Fen", of_form("load_angle"), f"{part}, 6.2")
    table.add("h_Fe", of_form("moment_arm", pair.module), f"{part}, 6.2")
    table.add("s_Fn", of_form("root_chord", pair.module), f"{part}, 6.2")
    table.add("rho_F", of_form("fillet_radius", pair.module), f"{part}, 6.2")
    if conditions.edition == 2019:
        table.add("f_epsilon", both("load_distribution"), f"{part}, 6.2")
    y_f = tuple(r.form.Y_F * r.load_distribution for r in found)
    deep = ""
    if pair.virtual_contact_ratio >= 2.0:
        deep = "Y_F: virtual contact ratio is 2 or more; load position from the formula for single pair contact"
    table.add("Y_F", (y_f[0], y_f[1]), f"{part}, clause 6, method B", deep)
    table.add("q_s", (_notch(found[0]), _notch(found[1])), f"{part}, 7.2")
    table.add("Y_S", of_form("Y_S"), f"{part}, clause 7, method B", _by_outline(conditions, found[1]))
    table.add("Y_beta", both("helix"), f"{part}, clause 8")
    table.add("Y_B", both("rim"), f"{part}, clause 9")
    table.add("Y_DT", both("deep_tooth"), f"{part}, clause 10")
    nominal, remark = both("stress"), ""
    if computed.root_factor is not None:
        remark = f"sigma_F0: Y_F Y_S Y_beta Y_B Y_DT {COMPUTED}"
        loads_0 = [duty.tangential / (_root_width(pair, i) * pair.module) for i in (0, 1)]
        nominal = (loads_0[0] * computed.root_factor[0], loads_0[1] * computed.root_factor[1])
    applied = duty.application_factor * duty.mesh_load_factor * loads.K_v
    stress = (
        nominal[0] * applied * loads.K_Fbeta[0] * loads.K_Falpha[0],
        nominal[1] * applied * loads.K_Fbeta[1] * loads.K_Falpha[1],
    )
    table.add("sigma_F0", nominal, f"{part}, 5.2", remark)
    table.add("sigma_F", stress, f"{part}, 5.2")
    return stress, found


def _by_outline(conditions: Conditions, found: RootRating) -> str:
    """What the exact outline of a spur ring makes of Y_F Y_S, where it has such a section."""
    if formed := [gear.formed for gear in conditions.geometry.gears if gear.formed is not None]:
        return f"Y_F, Y_S: critical section and radius of the given fillet ({len(formed)} of 2 gears), not of a tool"
    tooth = conditions.geometry.gears[1].outline
    if tooth is None or conditions.geometry.helix_angle:
        return ""
    try:
        form = outline_root_form(tooth, found.load_diameter)
    except RangeError:
        return ""
    product, own = found.form.Y_F * found.form.Y_S, form.Y_F * form.Y_S
    return (
        f"Y_F Y_S: value for the outline generated by the ring cutter is {own:.4g}, "
        f"{percent(own / product - 1.0, signed=True)}"
    )


def _notch(found: RootRating) -> float:
    return found.form.root_chord / (2.0 * found.form.fillet_radius)


def permissible_bending(
    table: FactorTable, conditions: Conditions, forms: tuple[RootRating, RootRating]
) -> tuple[RootStrength, RootStrength]:
    """What both roots bear, with its factors in the table."""
    part = f"ISO 6336-3:{conditions.edition}"
    duty = conditions.duty
    at_rest = duty.mean_stress if duty.mean_stress_static is None else duty.mean_stress_static
    one, two = (
        root_strength(
            conditions.strength[i],
            conditions.geometry.module,
            conditions.quality[i].root_roughness,
            (_notch(form), form.form.Y_S),
            duty.cycles[i],
            (at_rest[i], duty.mean_stress[i]),
        )
        for i, form in enumerate(forms)
    )
    remark = "; ".join(dict.fromkeys(r for r in (one.remark, two.remark) if r))
    table.add("sigma_Flim", (conditions.strength[0].bending, conditions.strength[1].bending), "ISO 6336-5")
    table.add("Y_ST", STANDARD_GEAR, f"{part}, 5.3")
    table.add("Y_NT", (one.Y_NT, two.Y_NT), f"{part}, clause 12, table 1")
    table.add("Y_deltarelT", (one.Y_deltarelT, two.Y_deltarelT), f"{part}, clause 13", remark)
    table.add("Y_RrelT", (one.Y_RrelT, two.Y_RrelT), f"{part}, clause 14")
    table.add("Y_X", (one.Y_X, two.Y_X), f"{part}, clause 15")
    table.add("Y_M", (one.Y_M, two.Y_M), f"{part}, annex B, endurance")
    table.add("Y_M_static", (one.Y_M_static, two.Y_M_static), f"{part}, annex B, static strength")
    table.add("sigma_FG_static", (one.static, two.static), f"{part}, 5.3")
    table.add("sigma_FG_reference", (one.reference, two.reference), f"{part}, 5.3")
    table.add("sigma_FG", (one.permissible, two.permissible), f"{part}, 5.3")
    least = conditions.required[1]
    table.add("S_Fmin", least, f"{part}, 5.1, as specified")
    table.add("sigma_FP", (one.permissible / least, two.permissible / least), f"{part}, 5.3")
    return one, two
