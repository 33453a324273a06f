"""A pair under a load spectrum: stresses of every level by parts 1 to 3, their damage and safety by part 6.

Source: ISO 6336-6:2019, clause 4: K_v, K_Hbeta and K_Halpha are those of each level's load and speed; the S-N curve of
a level is that of its speed, which Z_v depends on.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.formulas.iso6336 import part2_permissible, part3_strength
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.pair_rating import Replacement
from fegear.formulas.iso6336.part6_spectrum import Bin, annex_c_line, damage, service_life, spectrum_safety
from fegear.formulas.iso6336.safety import rate_pair

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.formulas.iso6336.pair_rating import PairRating
    from fegear.formulas.iso6336.rated import Both, Duty
    from fegear.formulas.iso6336.safety import Conditions


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
        Values that stand in for those of the formulas: the same at every level, or those of each.

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
