"""Load factors of a rating: stiffness, K_v, K_Hbeta, K_Fbeta, K_Halpha, K_Falpha in ISO 6336-1's order, all tabled."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.formulas.iso6336 import part1_dynamic as dynamic
from fegear.formulas.iso6336 import part1_misalignment as misalignment
from fegear.formulas.iso6336 import part1_running_in as running_in
from fegear.formulas.iso6336 import part1_transverse as transverse
from fegear.formulas.iso6336.conditions import COMPUTED
from fegear.formulas.iso6336.part1_face_load import root_exponent
from fegear.formulas.iso6336.part1_stiffness import blank_factor, pair_blank_factor, stiffness
from fegear.formulas.iso6336.part2_contact import contact_ratio_factor

if TYPE_CHECKING:
    from fegear.formulas.iso6336.conditions import Conditions, FactorTable
    from fegear.formulas.iso6336.pair_rating import Replacement
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.iso6336.rated import Both

#: What takes load off the ends of the face.
_LIGHT_ENDS = {"crowned", "crowned for manufacture", "helix corrected and crowned", "end relief"}
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


def _stiffness(table: FactorTable, conditions: Conditions, line_load: float) -> Stiffness:
    pair = conditions.geometry
    one, two = pair.gears
    bodies = [(g.web_ratio, math.inf if g.rim_thickness is None else g.rim_thickness / pair.module) for g in pair.gears]
    found = stiffness(
        (one.teeth, two.teeth),
        pair.contact_ratio,
        helix_angle=pair.helix_angle,
        profile_shift=(one.profile_shift, two.profile_shift),
        dedendum=(one.dedendum, two.dedendum),
        pressure_angle=pair.pressure_angle,
        blank=pair_blank_factor(bodies),
        specific_load=line_load,
        young_modulus=(one.young_modulus, two.young_modulus),
    )
    table.add("C_R", (blank_factor(*bodies[0]), blank_factor(*bodies[1])), "ISO 6336-1:2006, 9.3.1.3, Eqs. 84 and 85")
    table.add("c'_th", found.theoretical, "ISO 6336-1:2006, 9.3.1.1, Eqs. 81 and 82", "Pa", found.remark)
    table.add("c'", found.single, "ISO 6336-1:2006, 9.3.1, Eq. 80", "Pa")
    short = ""
    if pair.contact_ratio < 1.2:
        short = f"c_gamma_alpha: up to 10 % lower for a contact ratio below 1.2 ({pair.contact_ratio:.3g})"
    table.add("c_gamma_alpha", found.mesh_alpha, "ISO 6336-1:2006, 9.3.2, Eq. 91", "Pa", short)
    table.add("c_gamma_beta", found.mesh_beta, "ISO 6336-1:2006, 9.3.2, Eq. 92", "Pa")
    return found


def _dynamic(
    table: FactorTable, conditions: Conditions, computed: Replacement, stiff: Stiffness, line_load: float
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
    table.add("f_pb", pitch, "ISO 1328-1, the worse gear", "m")
    table.add("f_falpha", profile, "ISO 1328-1, the worse gear", "m")
    shared = max(pitch, profile)  # footnote 12 of 8.3.2: a larger form deviation stands for f_pb
    table.add("y_alpha", y_p, "ISO 6336-1:2006, 8.3.5.1, Eqs. 75 to 77", "m")
    grade = max(q.grade for q in quality)
    if computed.K_v is not None:
        table.add("K_v", computed.K_v, "ISO 6336-1, clause 6", remark=f"K_v: {COMPUTED}")
        return computed.K_v, shared, y_p
    if conditions.dynamic_method == "C":
        found = dynamic.method_c(pair, line_load, velocity, grade)
        table.add("K_v", found.K_v, "ISO 6336-1:2006, 6.5, method C", remark=found.remark)
        return found.K_v, shared, y_p
    relief = min(q.tip_relief for q in quality)
    if relief == 0.0:
        relief = dynamic.running_in_relief((conditions.strength[0].contact, conditions.strength[1].contact))
    errors = dynamic.DynamicErrors(pitch, profile, y_p, y_f, relief, coarse=grade >= 6)
    found = dynamic.method_b(pair, (stiff.single, stiff.mesh_alpha), line_load, duty.speed, errors, duty.meshes)
    table.add("m_red", found.reduced_mass, "ISO 6336-1:2006, 6.4.8, Eq. 30", "kg/m")
    table.add("n_E1", found.resonance_speed, "ISO 6336-1:2006, 6.4.2, Eq. 6", "rad/s")
    table.add("N", found.resonance_ratio, "ISO 6336-1:2006, 6.4.2, Eq. 9")
    table.add("N_S", found.lower_limit, "ISO 6336-1:2006, 6.4.2, Eqs. 11 and 12")
    table.add("y_p", y_p, "ISO 6336-1:2006, 6.4.3, Eq. 18", "m")
    table.add("y_f", y_f, "ISO 6336-1:2006, 6.4.3, Eq. 19", "m")
    table.add("C_a", relief, "ISO 6336-1:2006, 6.4.3 and table 4", "m")
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
    applied = duty.tangential * duty.application_factor * duty.mesh_load_factor / pair.face_width
    stiff = _stiffness(table, conditions, applied)
    k_v, shared, worn = _dynamic(table, conditions, computed, stiff, applied)
    k_hb = _face_load(table, conditions, computed, applied * k_v, stiff.mesh_beta)
    width = (pair.gears[0].face_width, pair.gears[1].face_width)
    depth = (pair.gears[0].depth, pair.gears[1].depth)
    if computed.K_Fbeta is not None:
        k_fb = computed.K_Fbeta
        table.add("K_Fbeta", k_fb, "ISO 6336-1, clause 7", remark=f"K_Fbeta: {COMPUTED}")
    else:
        # lightly loaded ends bend no less than the middle (7.6; IACS UR M56, 1.6.4 b)
        light = conditions.alignment.modification in _LIGHT_ENDS and computed.K_Hbeta is None
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
    table.add("K_Halpha", k_ha, "ISO 6336-1:2006, 8.3.2 and 8.3.3, Eqs. 71 to 73, method B", remark=marks[0])
    table.add("K_Falpha", k_fa, "ISO 6336-1:2006, 8.3.2 and 8.3.4, Eqs. 71, 72, 74, method B", remark=marks[1])
    return LoadFactors(k_v, k_hb, k_fb, k_ha, k_fa)


def _face_load(
    table: FactorTable, conditions: Conditions, computed: Replacement, line_load: float, mesh_stiffness: float
) -> float:
    """K_Hbeta: computed, given, or by method C."""
    if computed.K_Hbeta is not None:
        table.add("K_Hbeta", computed.K_Hbeta, "ISO 6336-1, clause 7", remark=f"K_Hbeta: {COMPUTED}")
        return computed.K_Hbeta
    pair = conditions.geometry
    velocity = pair.pitch_line_velocity(conditions.duty.speed)
    found = misalignment.method_c(
        pair, conditions.alignment, conditions.strength, conditions.quality, line_load, mesh_stiffness, velocity
    )
    table.add("F_m/b", line_load, "ISO 6336-1:2006, 7.2", "N/m")
    if not math.isnan(found.initial):
        table.add("f_sh", found.deformation, "ISO 6336-1:2006, 7.5.2.4, Eq. 57", "m", found.remark)
        table.add("f_ma", found.manufacture, "ISO 6336-1:2006, 7.5.2, Eq. 64", "m")
        table.add("B_1", found.constants[0], "ISO 6336-1:2006, 7.5.2.2, table 8")
        table.add("B_2", found.constants[1], "ISO 6336-1:2006, 7.5.2.2, table 8")
        table.add("F_betaxmin", found.least, "ISO 6336-1:2006, 7.5.2, Eqs. 55 and 56", "m")
        table.add("F_betax", found.initial, "ISO 6336-1:2006, 7.5.2.2, Eqs. 52 and 53", "m")
        table.add("y_beta", found.run_in, "ISO 6336-1:2006, 7.5.2.1, Eqs. 44 to 48", "m")
        table.add("F_betay", found.effective, "ISO 6336-1:2006, 7.5.2.1, Eq. 43", "m")
        table.add("K_Hbeta", found.K_Hbeta, "ISO 6336-1:2006, 7.5, Eqs. 39 and 41, method C")
    else:
        table.add("K_Hbeta", found.K_Hbeta, "ISO 6336-1, clause 7", remark=found.remark)
    return found.K_Hbeta
