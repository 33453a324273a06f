"""ISO 6336 of a whole pair: S_H and S_F with every factor on the way, by formulas or with computed values instead.

Parts 1, 2 and 3 in the standard's order: F_t, K_A, stiffness, K_v, K_Hbeta, K_Halpha; the contact stress and what the
flanks bear; the root stress and what the root bears. `Conditions.edition` chooses between 2006 (with its corrigenda)
and 2019 where they differ: f_epsilon and Y_beta of part 3, f_ZCa of part 2.

A pair under a load spectrum: stresses of every level by parts 1 to 3, their damage and safety by part 6.

Source: ISO 6336-6:2019, clause 4: K_v, K_Hbeta and K_Halpha are those of each level's load and speed; the S-N curve of
a level is that of its speed, which Z_v depends on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part2_pitting as part2_permissible
from fegear.formulas.iso6336 import part3_strength
from fegear.formulas.iso6336.conditions import Conditions, FactorTable, PairRating, Replacement
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin, annex_c_line, damage, service_life, spectrum_safety
from fegear.formulas.iso6336.rating import (
    contact_stress,
    load_factors,
    permissible_bending,
    permissible_contact,
    root_stress,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.formulas.iso6336.pair_geometry import PairGeometry
    from fegear.formulas.iso6336.rated import Both, Duty


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
    table.add("F_t", duty.tangential, "ISO 6336-1, 4.2")
    table.add("v", pair.pitch_line_velocity(duty.speed), "ISO 6336-1, 4.2")
    table.add("u", pair.signed_ratio, "ISO 21771, 5.1")
    table.add("alpha_wt", pair.working_pressure_angle, "ISO 21771, 5.3")
    table.add("epsilon_alpha", pair.contact_ratio, "ISO 21771, 5.4")
    table.add("epsilon_beta", pair.overlap_ratio, "ISO 21771, 5.4")
    table.add("epsilon_gamma", pair.total_contact_ratio, "ISO 21771, 5.4")
    table.add("K_A", duty.application_factor, "ISO 6336-1, clause 5, as specified")
    table.add("K_gamma", duty.mesh_load_factor, "ISO 6336-1, 4.2, as specified")
    table.add("N_L", duty.cycles, "ISO 6336-6, as specified")


@dataclass(frozen=True, slots=True)
class Curves:
    """Permissible stress over load cycles for a safety of 1; of pinion and wheel."""

    contact: tuple[Knots, Knots]
    bending: tuple[Knots, Knots]


@dataclass(frozen=True, slots=True)
class LevelRating:
    """One level of a spectrum.

    Parameters
    ----------
    rating : PairRating or None
        None of a level without load.
    contact, bending : (Bin, Bin)
        Stress, load cycles and S-N curve of pinion and wheel.
    """

    rating: PairRating | None
    contact: tuple[Bin, Bin]
    bending: tuple[Bin, Bin]


@dataclass(frozen=True, slots=True)
class SpectrumRating:
    """Safeties of pinion and wheel in stress, Miner sums at a safety of 1, and lives in parts of the required one."""

    levels: tuple[LevelRating, ...]
    contact_safety: Both
    bending_safety: Both
    contact_damage: Both
    bending_damage: Both
    contact_life: Both
    bending_life: Both

    def __post_init__(self) -> None:
        """Refuse safety factors, damage and lives that no pair has."""
        for name in ("contact_safety", "bending_safety", "contact_damage", "bending_damage", "contact_life",
                     "bending_life"):  # fmt: skip
            values = getattr(self, name)
            if not all(value >= 0.0 for value in values):
                raise RangeError(name, values, "must not be negative")


def sn_curves(conditions: Conditions, computed: Replacement | None = None) -> Curves:
    """S-N curves of both gears of a pair, from the permissible stresses at the knots of the life factors."""
    of_flank = [part2_permissible.life_knots(one).cycles for one in conditions.strength]
    of_root = [part3_strength.life_knots(one).cycles for one in conditions.strength]
    known: dict[float, PairRating] = {}

    def at(cycles: float) -> PairRating:
        if cycles not in known:
            duty = replace(conditions.duty, cycles=(cycles, cycles))
            known[cycles] = rate_pair(replace(conditions, duty=duty), computed)
        return known[cycles]

    contact = [Knots(n, tuple(at(one).contact_permissible[i] for one in n)) for i, n in enumerate(of_flank)]
    if conditions.spectrum_line == "annex-c":
        contact = [
            annex_c_line(part2_permissible.life_knots(one), line.values[-2])
            for one, line in zip(conditions.strength, contact, strict=True)
        ]
    bending = [Knots(n, tuple(at(one).bending_permissible[i] for one in n)) for i, n in enumerate(of_root)]
    return Curves((contact[0], contact[1]), (bending[0], bending[1]))


def rate_spectrum(
    conditions: Conditions,
    levels: Sequence[tuple[Duty | None, Both]],
    computed: Replacement | Sequence[Replacement | None] | None = None,
) -> SpectrumRating:
    """Rate a pair under a spectrum.

    Parameters
    ----------
    conditions : Conditions
        Of the nominal load.
    levels : sequence of (Duty or None, (float, float))
        Load and speed of each level (None without load) and its load cycles of pinion and wheel.
    computed : Replacement or sequence of Replacement, optional
        Values used instead of those of the formulas: the same at every level, or those of each.

    Raises
    ------
    RangeError
        If a formula is asked outside its range, or no level has a load.
    """
    each = [computed] * len(levels) if computed is None or isinstance(computed, Replacement) else computed
    nominal = sn_curves(conditions, next((one for one in each if one is not None), None))
    curves = {conditions.duty.speed: nominal}
    found = []
    for (duty, cycles), stands in zip(levels, each, strict=True):
        if duty is None:
            found.append(LevelRating(None, _idle(cycles, nominal.contact), _idle(cycles, nominal.bending)))
            continue
        at = replace(conditions, duty=duty)
        if duty.speed not in curves:
            curves[duty.speed] = sn_curves(at, stands)
        known, rated = curves[duty.speed], rate_pair(at, stands)
        contact = [Bin(rated.contact_stress[i], cycles[i], known.contact[i]) for i in (0, 1)]
        bending = [Bin(rated.bending_stress[i], cycles[i], known.bending[i]) for i in (0, 1)]
        found.append(LevelRating(rated, (contact[0], contact[1]), (bending[0], bending[1])))
    flanks = [[level.contact[i] for level in found] for i in (0, 1)]
    roots = [[level.bending[i] for level in found] for i in (0, 1)]
    return SpectrumRating(
        tuple(found),
        (spectrum_safety(flanks[0]), spectrum_safety(flanks[1])),
        (spectrum_safety(roots[0]), spectrum_safety(roots[1])),
        (damage(flanks[0]), damage(flanks[1])),
        (damage(roots[0]), damage(roots[1])),
        (service_life(flanks[0], 1.0), service_life(flanks[1], 1.0)),
        (service_life(roots[0], 1.0), service_life(roots[1], 1.0)),
    )


def _idle(cycles: Both, curves: tuple[Knots, Knots]) -> tuple[Bin, Bin]:
    return Bin(0.0, cycles[0], curves[0]), Bin(0.0, cycles[1], curves[1])
