"""The flanks of a rating: contact stress and what the flanks bear, in ISO 6336-2's order, all factors tabled."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.formulas.iso6336 import part2_contact as contact
from fegear.formulas.iso6336.part2_permissible import flank_strength

if TYPE_CHECKING:
    from fegear.formulas.iso6336.conditions import Conditions, FactorTable
    from fegear.formulas.iso6336.part2_permissible import FlankStrength
    from fegear.formulas.iso6336.rated import Both
    from fegear.formulas.iso6336.rating_loads import LoadFactors


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
    table.add("Z_E", z_e, f"{part}, clause 7", "Pa^0.5")
    table.add("Z_epsilon", z_eps, f"{part}, clause 8")
    table.add("Z_beta", z_beta, f"{part}{'/Cor.1:2008' if edition == 2006 else ''}, clause 9")
    if edition == 2019:
        table.add("f_ZCa", relief, f"{part}, 6.3", remark=recalled)
    table.add("M", inner, f"{part}, 6.2")
    table.add("Z_BD", single, f"{part}, 6.2")
    nominal = contact.nominal_contact_stress(pair, duty.tangential, (z_h, z_e, z_eps, z_beta))
    load = duty.application_factor * duty.mesh_load_factor * loads.K_v * loads.K_Hbeta * loads.K_Halpha
    stress = (single[0] * nominal * math.sqrt(load), single[1] * nominal * math.sqrt(load))
    table.add("sigma_H0", nominal, f"{part}, 5.2", "Pa")
    table.add("sigma_H", stress, f"{part}, 5.2", "Pa")
    return stress


def _tip_relief(conditions: Conditions) -> tuple[float, str]:
    """f_ZCa and what is to be said of it."""
    if conditions.geometry.helix_angle == 0.0 or conditions.edition == 2006:
        return 1.0, ""
    if conditions.tip_relief_factor is not None:
        return conditions.tip_relief_factor, "f_ZCa: as given"
    value = contact.tip_relief_factor(conditions.relieved, conditions.edition)
    return value, contact.RECALLED.format(value=value, tips=contact.TIPS[conditions.relieved])


def permissible_contact(table: FactorTable, conditions: Conditions) -> tuple[FlankStrength, FlankStrength]:
    """What both flanks bear, with its factors in the table."""
    found = flank_strength(conditions.geometry, conditions.strength, conditions.quality, conditions.duty)
    part = f"ISO 6336-2:{conditions.edition}"
    one, two = found
    table.add("sigma_Hlim", (conditions.strength[0].contact, conditions.strength[1].contact), "ISO 6336-5", "Pa")
    table.add("Z_NT", (one.Z_NT, two.Z_NT), f"{part}, clause 11, table 2")
    table.add("Z_L", (one.Z_L, two.Z_L), f"{part}, clause 12")
    table.add("Z_v", (one.Z_v, two.Z_v), f"{part}, clause 12")
    table.add("Z_R", (one.Z_R, two.Z_R), f"{part}, clause 12")
    table.add("Z_W", (one.Z_W, two.Z_W), f"{part}, clause 13", remark=one.remark)
    table.add("Z_X", (one.Z_X, two.Z_X), f"{part}, clause 14")
    table.add("sigma_HG_static", (one.static, two.static), f"{part}, 5.3", "Pa")
    table.add("sigma_HG_reference", (one.reference, two.reference), f"{part}, 5.3", "Pa")
    bound = ""
    if one.static_rules or two.static_rules:
        bound = (
            "sigma_HG: Z_L Z_v Z_R Z_W would lift it above the static strength of nitrocarburized flanks (Z_NT = 1.1), "
            "which holds for all load cycles then"
        )
    table.add("sigma_HG", (one.permissible, two.permissible), f"{part}, 5.3", "Pa", bound)
    least = conditions.required[0]
    table.add("S_Hmin", least, f"{part}, 5.1, as given")
    table.add("sigma_HP", (one.permissible / least, two.permissible / least), f"{part}, 5.3", "Pa")
    return found
