"""ISO 6336 of a whole pair: S_H and S_F with every factor on the way, by formulas or with computed values instead.

Parts 1, 2 and 3 in the standard's order: F_t, K_A, stiffness, K_v, K_Hbeta, K_Halpha; the contact stress and what the
flanks bear; the root stress and what the root bears. `Conditions.edition` chooses between 2006 (with its corrigenda)
and 2019 where they differ: f_epsilon and Y_beta of part 3, f_ZCa of part 2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.formulas.iso6336.conditions import Conditions, FactorTable
from fegear.formulas.iso6336.pair_rating import PairRating, Replacement
from fegear.formulas.iso6336.rating_flank import contact_stress, permissible_contact
from fegear.formulas.iso6336.rating_loads import load_factors
from fegear.formulas.iso6336.rating_root import permissible_bending, root_stress

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Duty

__all__ = ["Conditions", "rate_pair"]


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
    table, pair, duty = FactorTable(), conditions.geometry, conditions.duty
    _geometry(table, pair, duty)
    loads = load_factors(table, conditions, computed)
    stress_h = contact_stress(table, conditions, loads)
    flanks = permissible_contact(table, conditions)
    stress_f, forms = root_stress(table, conditions, loads, computed)
    roots = permissible_bending(table, conditions, forms)
    bear_h, bear_f = (flanks[0].permissible, flanks[1].permissible), (roots[0].permissible, roots[1].permissible)
    s_h, s_f = (bear_h[0] / stress_h[0], bear_h[1] / stress_h[1]), (bear_f[0] / stress_f[0], bear_f[1] / stress_f[1])
    table.add("S_H", s_h, "ISO 6336-2, 5.1")
    table.add("S_F", s_f, "ISO 6336-3, 5.1")
    for symbol, part, bears, stress in (("S_H", 2, flanks, stress_h), ("S_F", 3, roots, stress_f)):
        static = (bears[0].static / stress[0], bears[1].static / stress[1])
        reference = (bears[0].reference / stress[0], bears[1].reference / stress[1])
        table.add(f"{symbol}_static", static, f"ISO 6336-{part}, 5.3, static strength")
        table.add(f"{symbol}_reference", reference, f"ISO 6336-{part}, 5.3, at the reference number of load cycles")
    return PairRating(tuple(table.rows), pair.members, stress_h, bear_h, s_h, stress_f, bear_f, s_f)


def _geometry(table: FactorTable, pair: PairGeometry, duty: Duty) -> None:
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
