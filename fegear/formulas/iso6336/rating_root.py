"""The roots of a rating: root stress and what the roots bear, in ISO 6336-3's order, all factors tabled."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.formulas.iso6336.conditions import COMPUTED
from fegear.formulas.iso6336.part3_pair import RatingChoice, RootRating, ToothLoad, rate
from fegear.formulas.iso6336.part3_root_stress import RackTooth, outer_single_contact_diameter, virtual_teeth
from fegear.formulas.iso6336.part3_strength import STANDARD_GEAR, root_strength

if TYPE_CHECKING:
    from fegear.formulas.iso6336.conditions import Conditions, FactorTable
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.pair_rating import Replacement
    from fegear.formulas.iso6336.part3_strength import RootStrength
    from fegear.formulas.iso6336.rated import Both
    from fegear.formulas.iso6336.rating_loads import LoadFactors


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
        deep=True,
    )
    at = outer_single_contact_diameter(tooth, tip, load.contact_ratio)
    backup = math.inf if gear.rim_thickness is None else gear.rim_thickness / gear.depth
    grade = max(q.grade for q in conditions.quality)
    return rate(tooth, at, pair.module, load, RatingChoice(conditions.edition, grade), backup)


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
    table.add("d_en", (found[0].load_diameter * pair.module, found[1].load_diameter * pair.module), f"{part}, 6.2", "m")
    table.add("alpha_Fen", of_form("load_angle"), f"{part}, 6.2", "rad")
    table.add("h_Fe", of_form("moment_arm", pair.module), f"{part}, 6.2", "m")
    table.add("s_Fn", of_form("root_chord", pair.module), f"{part}, 6.2", "m")
    table.add("rho_F", of_form("fillet_radius", pair.module), f"{part}, 6.2", "m")
    if conditions.edition == 2019:
        table.add("f_epsilon", both("load_distribution"), f"{part}, 6.2")
    y_f = tuple(r.form.Y_F * r.load_distribution for r in found)
    deep = ""
    if pair.virtual_contact_ratio >= 2.0:
        deep = "Y_F: the virtual contact ratio is 2 or more; the load stands where the formula for one pair says"
    table.add("Y_F", (y_f[0], y_f[1]), f"{part}, clause 6, method B", remark=deep)
    table.add("q_s", (_notch(found[0]), _notch(found[1])), f"{part}, 7.2")
    table.add("Y_S", of_form("Y_S"), f"{part}, clause 7, method B")
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
    table.add("sigma_F0", nominal, f"{part}, 5.2", "Pa", remark)
    table.add("sigma_F", stress, f"{part}, 5.2", "Pa")
    return stress, found


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
    table.add("sigma_Flim", (conditions.strength[0].bending, conditions.strength[1].bending), "ISO 6336-5", "Pa")
    table.add("Y_ST", STANDARD_GEAR, f"{part}, 5.3")
    table.add("Y_NT", (one.Y_NT, two.Y_NT), f"{part}, clause 12, table 1")
    table.add("Y_deltarelT", (one.Y_deltarelT, two.Y_deltarelT), f"{part}, clause 13", remark=remark)
    table.add("Y_RrelT", (one.Y_RrelT, two.Y_RrelT), f"{part}, clause 14")
    table.add("Y_X", (one.Y_X, two.Y_X), f"{part}, clause 15")
    table.add("Y_M", (one.Y_M, two.Y_M), f"{part}, annex B, endurance")
    table.add("Y_M_static", (one.Y_M_static, two.Y_M_static), f"{part}, annex B, static strength")
    table.add("sigma_FG_static", (one.static, two.static), f"{part}, 5.3", "Pa")
    table.add("sigma_FG_reference", (one.reference, two.reference), f"{part}, 5.3", "Pa")
    table.add("sigma_FG", (one.permissible, two.permissible), f"{part}, 5.3", "Pa")
    least = conditions.required[1]
    table.add("S_Fmin", least, f"{part}, 5.1, as given")
    table.add("sigma_FP", (one.permissible / least, two.permissible / least), f"{part}, 5.3", "Pa")
    return one, two
