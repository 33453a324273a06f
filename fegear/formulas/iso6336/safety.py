"""ISO 6336 of a whole pair: S_H and S_F with every factor on the way, by formulas or with computed values instead.

Parts 1, 2 and 3 in the standard's order: F_t, K_A, stiffness, K_v, K_Hbeta, K_Halpha; the contact stress and what the
flanks bear; the root stress and what the root bears. `Conditions.edition` chooses between 2006 (with its corrigenda)
and 2019 where they differ: f_epsilon and Y_beta of part 3, f_ZCa of part 2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from fegear.formulas.iso6336 import part1_dynamic as dynamic
from fegear.formulas.iso6336 import part1_misalignment as misalignment
from fegear.formulas.iso6336 import part1_running_in as running_in
from fegear.formulas.iso6336 import part1_transverse as transverse
from fegear.formulas.iso6336 import part2_contact as contact
from fegear.formulas.iso6336 import part2_permissible as flank
from fegear.formulas.iso6336 import part3_strength as strength_of_root
from fegear.formulas.iso6336.alignment import Alignment
from fegear.formulas.iso6336.pair_rating import Factor, PairRating, Replacement
from fegear.formulas.iso6336.part1_face_load import root_exponent
from fegear.formulas.iso6336.part1_stiffness import blank_factor, stiffness
from fegear.formulas.iso6336.part3_pair import RatingChoice, RootRating, ToothLoad, rate
from fegear.formulas.iso6336.part3_root_stress import RackTooth, outer_single_contact_diameter, virtual_teeth

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.part1_stiffness import Stiffness
    from fegear.formulas.iso6336.part2_contact import TipRelief
    from fegear.formulas.iso6336.part2_permissible import FlankStrength
    from fegear.formulas.iso6336.part3_strength import RootStrength
    from fegear.formulas.iso6336.rated import Both, Duty, Edition, Quality, Strength


@dataclass(frozen=True, slots=True)
class Conditions:
    """A pair to be rated; pairs of things are those of pinion and wheel.

    Parameters
    ----------
    geometry : PairGeometry
    strength : (Strength, Strength)
    quality : (Quality, Quality)
    duty : Duty
    alignment : Alignment
    edition : {2019, 2006}
    dynamic_method : {"B", "C"}
        Of K_v.
    tip_relief : TipRelief, optional
        For f_ZCa of helical gears; by default "experience" where both tips are relieved by design, else "none".
    """

    geometry: PairGeometry
    strength: tuple[Strength, Strength]
    quality: tuple[Quality, Quality]
    duty: Duty
    alignment: Alignment = field(default_factory=Alignment)
    edition: Edition = 2019
    dynamic_method: Literal["B", "C"] = "B"
    tip_relief: TipRelief | None = None

    @property
    def relieved(self) -> TipRelief:
        """How tips count as relieved."""
        if self.tip_relief is not None:
            return self.tip_relief
        return "experience" if all(q.tip_relief > 0.0 for q in self.quality) else "none"


class _Table:
    """Factors in the order in which they are found."""

    def __init__(self) -> None:
        self.rows: list[Factor] = []

    def add(self, symbol: str, value: float | Both, clause: str, unit: str = "", remark: str = "") -> None:
        values = value if isinstance(value, tuple) else (value, value)
        self.rows.append(Factor(symbol, values, unit, clause, remark))


@dataclass(frozen=True, slots=True)
class _Loads:
    """Load factors of a pair."""

    K_v: float
    K_Hbeta: float
    K_Fbeta: Both
    K_Halpha: float
    K_Falpha: Both


_COMPUTED = "computed in place of the formula"
#: Equations of K_v in the ranges of the resonance ratio.
_EQUATION = {"subcritical": 13, "main resonance": 20, "supercritical": 21, "intermediate": 22}


def rate_pair(conditions: Conditions, computed: Replacement | None = None) -> PairRating:
    """Rate a pair by ISO 6336, parts 1, 2 and 3.

    Parameters
    ----------
    conditions : Conditions
    computed : Replacement, optional
        Load factors and root stresses computed by other means, in place of those of the formulas.

    Raises
    ------
    RangeError
        If a formula is asked outside its range.
    """
    computed = Replacement() if computed is None else computed
    table, pair, duty = _Table(), conditions.geometry, conditions.duty
    _geometry(table, pair, duty)
    loads = _load_factors(table, conditions, computed)
    stress_h = _contact_stress(table, conditions, loads)
    flanks = flank.flank_strength(pair, conditions.strength, conditions.quality, duty)
    _flank_factors(table, conditions, flanks)
    stress_f, forms = _root_stress(table, conditions, loads, computed)
    roots = _root_factors(table, conditions, forms)
    bear_h, bear_f = (flanks[0].permissible, flanks[1].permissible), (roots[0].permissible, roots[1].permissible)
    s_h, s_f = (bear_h[0] / stress_h[0], bear_h[1] / stress_h[1]), (bear_f[0] / stress_f[0], bear_f[1] / stress_f[1])
    table.add("S_H", s_h, "ISO 6336-2, 5.1")
    table.add("S_F", s_f, "ISO 6336-3, 5.1")
    return PairRating(tuple(table.rows), pair.members, stress_h, bear_h, s_h, stress_f, bear_f, s_f)


def _geometry(table: _Table, pair: PairGeometry, duty: Duty) -> None:
    table.add("F_t", duty.tangential, "ISO 6336-1, 4.2", "N")
    table.add("v", pair.pitch_line_velocity(duty.speed), "ISO 6336-1, 4.2", "m/s")
    table.add("u", pair.ratio, "ISO 21771, 5.1")
    table.add("alpha_wt", pair.working_pressure_angle, "ISO 21771, 5.3", "rad")
    table.add("epsilon_alpha", pair.contact_ratio, "ISO 21771, 5.4")
    table.add("epsilon_beta", pair.overlap_ratio, "ISO 21771, 5.4")
    table.add("epsilon_gamma", pair.total_contact_ratio, "ISO 21771, 5.4")
    table.add("K_A", duty.application_factor, "ISO 6336-1, clause 5, as given")
    table.add("K_gamma", duty.mesh_load_factor, "ISO 6336-1, 4.2, as given")
    table.add("N_L", duty.cycles, "ISO 6336-6, as given")


def _stiffness(table: _Table, conditions: Conditions, line_load: float) -> Stiffness:
    pair = conditions.geometry
    one, two = pair.gears
    blanks = [
        blank_factor(g.web_ratio, math.inf if g.rim_thickness is None else g.rim_thickness / pair.module)
        for g in pair.gears
    ]
    found = stiffness(
        (one.teeth, two.teeth),
        pair.contact_ratio,
        helix_angle=pair.helix_angle,
        profile_shift=(one.profile_shift, two.profile_shift),
        dedendum=(one.dedendum, two.dedendum),
        pressure_angle=pair.pressure_angle,
        blank=0.5 * (blanks[0] + blanks[1]),
        specific_load=line_load,
        young_modulus=(one.young_modulus, two.young_modulus),
    )
    table.add("C_R", (blanks[0], blanks[1]), "ISO 6336-1:2006, 9.3.1.3")
    table.add("c'_th", found.theoretical, "ISO 6336-1:2006, 9.3.1.1, Eqs. 82 and 83", "Pa", found.remark)
    table.add("c'", found.single, "ISO 6336-1:2006, 9.3.1", "Pa")
    table.add("c_gamma_alpha", found.mesh_alpha, "ISO 6336-1:2006, 9.3.2", "Pa")
    table.add("c_gamma_beta", found.mesh_beta, "ISO 6336-1:2006, 9.3.2", "Pa")
    return found


def _dynamic(
    table: _Table, conditions: Conditions, computed: Replacement, stiff: Stiffness, line_load: float
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
        table.add("K_v", computed.K_v, "ISO 6336-1, clause 6", remark=f"K_v: {_COMPUTED}")
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


def _load_factors(table: _Table, conditions: Conditions, computed: Replacement) -> _Loads:
    pair, duty = conditions.geometry, conditions.duty
    applied = duty.tangential * duty.application_factor * duty.mesh_load_factor / pair.face_width
    stiff = _stiffness(table, conditions, applied)
    k_v, shared, worn = _dynamic(table, conditions, computed, stiff, applied)
    k_hb = _face_load(table, conditions, computed, applied * k_v, stiff.mesh_beta)
    width = (pair.gears[0].face_width, pair.gears[1].face_width)
    depth = (pair.gears[0].depth, pair.gears[1].depth)
    if computed.K_Fbeta is not None:
        k_fb = computed.K_Fbeta
        table.add("K_Fbeta", k_fb, "ISO 6336-1, clause 7", remark=f"K_Fbeta: {_COMPUTED}")
    else:
        exponent = root_exponent(width, depth)
        k_fb = (k_hb**exponent, k_hb**exponent)
        table.add("N_F", exponent, "ISO 6336-1:2006, 7.6, Eq. 70")
        table.add("K_Fbeta", k_fb, "ISO 6336-1:2006, 7.6, Eq. 69")
    z_e = contact.contact_ratio_factor(pair.contact_ratio, pair.overlap_ratio)
    across = transverse.method_b(
        pair.contact_ratio, pair.overlap_ratio, stiff.mesh_alpha, shared - worn, applied * k_v * k_hb, z_e
    )
    k_ha, k_fa = across.K_Halpha, (across.K_Falpha, across.K_Falpha)
    marks = ["", ""]
    if computed.K_Halpha is not None:
        k_ha, marks[0] = computed.K_Halpha, f"K_Halpha: {_COMPUTED}"
    if computed.K_Falpha is not None:
        k_fa, marks[1] = computed.K_Falpha, f"K_Falpha: {_COMPUTED}"
    table.add("K_Halpha", k_ha, "ISO 6336-1:2006, 8.3.2 and 8.3.3, Eqs. 71 to 73, method B", remark=marks[0])
    table.add("K_Falpha", k_fa, "ISO 6336-1:2006, 8.3.2 and 8.3.4, Eqs. 71, 72, 74, method B", remark=marks[1])
    return _Loads(k_v, k_hb, k_fb, k_ha, k_fa)


def _face_load(
    table: _Table, conditions: Conditions, computed: Replacement, line_load: float, mesh_stiffness: float
) -> float:
    """K_Hbeta: computed, given, or by method C."""
    if computed.K_Hbeta is not None:
        table.add("K_Hbeta", computed.K_Hbeta, "ISO 6336-1, clause 7", remark=f"K_Hbeta: {_COMPUTED}")
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


def _contact_stress(table: _Table, conditions: Conditions, loads: _Loads) -> Both:
    pair, duty, edition = conditions.geometry, conditions.duty, conditions.edition
    part = f"ISO 6336-2:{edition}"
    z_h, z_e = contact.zone_factor(pair), contact.elasticity_factor(pair)
    z_eps = contact.contact_ratio_factor(pair.contact_ratio, pair.overlap_ratio)
    z_beta = contact.helix_factor(pair.helix_angle)
    relief = contact.tip_relief_factor(conditions.relieved, edition) if pair.helix_angle > 0.0 else 1.0
    inner, single = contact.single_pair_factors(pair, relief)
    table.add("Z_H", z_h, f"{part}, clause 6")
    table.add("Z_E", z_e, f"{part}, clause 7", "Pa^0.5")
    table.add("Z_epsilon", z_eps, f"{part}, clause 8")
    table.add("Z_beta", z_beta, f"{part}{'/Cor.1:2008' if edition == 2006 else ''}, clause 9")
    if edition == 2019:
        table.add("f_ZCa", relief, f"{part}, 6.3")
    table.add("M", inner, f"{part}, 6.2")
    table.add("Z_BD", single, f"{part}, 6.2")
    nominal = contact.nominal_contact_stress(pair, duty.tangential, (z_h, z_e, z_eps, z_beta))
    load = duty.application_factor * duty.mesh_load_factor * loads.K_v * loads.K_Hbeta * loads.K_Halpha
    stress = (single[0] * nominal * math.sqrt(load), single[1] * nominal * math.sqrt(load))
    table.add("sigma_H0", nominal, f"{part}, 5.2", "Pa")
    table.add("sigma_H", stress, f"{part}, 5.2", "Pa")
    return stress


def _flank_factors(table: _Table, conditions: Conditions, found: tuple[FlankStrength, FlankStrength]) -> None:
    part = f"ISO 6336-2:{conditions.edition}"
    one, two = found
    table.add("sigma_Hlim", (conditions.strength[0].contact, conditions.strength[1].contact), "ISO 6336-5", "Pa")
    table.add("Z_NT", (one.Z_NT, two.Z_NT), f"{part}, clause 11, table 2")
    table.add("Z_L", (one.Z_L, two.Z_L), f"{part}, clause 12")
    table.add("Z_v", (one.Z_v, two.Z_v), f"{part}, clause 12")
    table.add("Z_R", (one.Z_R, two.Z_R), f"{part}, clause 12")
    table.add("Z_W", (one.Z_W, two.Z_W), f"{part}, clause 13", remark=one.remark)
    table.add("Z_X", (one.Z_X, two.Z_X), f"{part}, clause 14")
    table.add("sigma_HP_static", (one.static, two.static), f"{part}, 5.3", "Pa")
    table.add("sigma_HP_reference", (one.reference, two.reference), f"{part}, 5.3", "Pa")
    table.add("sigma_HP", (one.permissible, two.permissible), f"{part}, 5.3", "Pa")


def _root_width(pair: PairGeometry, i: int) -> float:
    """Face width of a gear's root: its own, but at most one module beyond the common one on either side."""
    return min(pair.gears[i].face_width, pair.face_width + 2.0 * pair.module)


def _root_rating(conditions: Conditions, i: int) -> RootRating:
    """Nominal root stress of one gear under F_t, through its virtual tooth."""
    pair, gear = conditions.geometry, conditions.geometry.gears[i]
    z_n = virtual_teeth(gear.teeth, pair.helix_angle, pair.pressure_angle)
    tooth = RackTooth(
        z_n, gear.generating_shift, gear.dedendum, gear.tip_radius, pair.pressure_angle, gear.residual_undercut
    )
    tip = z_n + (gear.active_tip_diameter - pair.diameters[i]) / pair.module
    load = ToothLoad(
        conditions.duty.tangential / _root_width(pair, i),
        pair.virtual_contact_ratio,
        pair.overlap_ratio,
        pair.helix_angle,
    )
    at = outer_single_contact_diameter(tooth, tip, load.contact_ratio)
    backup = math.inf if gear.rim_thickness is None else gear.rim_thickness / gear.depth
    grade = max(q.grade for q in conditions.quality)
    return rate(tooth, at, pair.module, load, RatingChoice(conditions.edition, grade), backup)


def _root_stress(
    table: _Table, conditions: Conditions, loads: _Loads, computed: Replacement
) -> tuple[Both, tuple[RootRating, RootRating]]:
    pair, duty = conditions.geometry, conditions.duty
    part = f"ISO 6336-3:{conditions.edition}"
    found = (_root_rating(conditions, 0), _root_rating(conditions, 1))

    def both(name: str) -> Both:
        return getattr(found[0], name), getattr(found[1], name)

    def of_form(name: str, scale: float = 1.0) -> Both:
        return getattr(found[0].form, name) * scale, getattr(found[1].form, name) * scale

    table.add("z_n", both("teeth"), f"{part}, 6.2")
    table.add("epsilon_alpha_n", pair.virtual_contact_ratio, f"{part}, 6.2")
    table.add("d_en", (found[0].load_diameter * pair.module, found[1].load_diameter * pair.module), f"{part}, 6.2", "m")
    table.add("alpha_Fen", of_form("load_angle"), f"{part}, 6.2", "rad")
    table.add("h_Fe", of_form("moment_arm", pair.module), f"{part}, 6.2", "m")
    table.add("s_Fn", of_form("root_chord", pair.module), f"{part}, 6.2", "m")
    table.add("rho_F", of_form("fillet_radius", pair.module), f"{part}, 6.2", "m")
    if conditions.edition == 2019:
        table.add("f_epsilon", both("load_distribution"), f"{part}, 6.2")
    y_f = tuple(r.form.Y_F * r.load_distribution for r in found)
    table.add("Y_F", (y_f[0], y_f[1]), f"{part}, clause 6, method B")
    table.add("q_s", (_notch(found[0]), _notch(found[1])), f"{part}, 7.2")
    table.add("Y_S", of_form("Y_S"), f"{part}, clause 7, method B")
    table.add("Y_beta", both("helix"), f"{part}, clause 8")
    table.add("Y_B", both("rim"), f"{part}, clause 9")
    table.add("Y_DT", both("deep_tooth"), f"{part}, clause 10")
    nominal, remark = both("stress"), ""
    if computed.root_factor is not None:
        remark = f"sigma_F0: Y_F Y_S Y_beta Y_B Y_DT {_COMPUTED}"
        loads_0 = [duty.tangential / (_root_width(pair, i) * pair.module) for i in (0, 1)]
        nominal = (loads_0[0] * computed.root_factor[0], loads_0[1] * computed.root_factor[1])
    applied = duty.application_factor * duty.mesh_load_factor * loads.K_v
    stress = (
        nominal[0] * applied * loads.K_Fbeta[0] * loads.K_Falpha[0],
        nominal[1] * applied * loads.K_Fbeta[1] * loads.K_Falpha[1],
    )
    table.add("sigma_F0", nominal, f"{part}, 5.2", "Pa", remark)
    table.add("sigma_F", stress, f"{part}, 5.2", "Pa")
    return stress, found


def _notch(found: RootRating) -> float:
    return found.form.root_chord / (2.0 * found.form.fillet_radius)


def _root_factors(
    table: _Table, conditions: Conditions, forms: tuple[RootRating, RootRating]
) -> tuple[RootStrength, RootStrength]:
    part = f"ISO 6336-3:{conditions.edition}"
    one, two = (
        strength_of_root.root_strength(
            conditions.strength[i],
            conditions.geometry.module,
            conditions.quality[i].root_roughness,
            (_notch(form), form.form.Y_S),
            conditions.duty.cycles[i],
            conditions.duty.mean_stress[i],
        )
        for i, form in enumerate(forms)
    )
    remark = "; ".join(dict.fromkeys(r for r in (one.remark, two.remark) if r))
    table.add("sigma_Flim", (conditions.strength[0].bending, conditions.strength[1].bending), "ISO 6336-5", "Pa")
    table.add("Y_ST", strength_of_root.STANDARD_GEAR, f"{part}, 5.3")
    table.add("Y_NT", (one.Y_NT, two.Y_NT), f"{part}, clause 12, table 1")
    table.add("Y_deltarelT", (one.Y_deltarelT, two.Y_deltarelT), f"{part}, clause 13", remark=remark)
    table.add("Y_RrelT", (one.Y_RrelT, two.Y_RrelT), f"{part}, clause 14")
    table.add("Y_X", (one.Y_X, two.Y_X), f"{part}, clause 15")
    table.add("Y_M", (one.Y_M, two.Y_M), f"{part}, annex B")
    table.add("sigma_FP_static", (one.static, two.static), f"{part}, 5.3", "Pa")
    table.add("sigma_FP_reference", (one.reference, two.reference), f"{part}, 5.3", "Pa")
    table.add("sigma_FP", (one.permissible, two.permissible), f"{part}, 5.3", "Pa")
    return one, two
