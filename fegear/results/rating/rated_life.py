"""Service life, damage and transmittable power of a rated pair."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.part6_spectrum import ServiceLife
    from fegear.formulas.iso6336.rated import Both
    from fegear.geometry.pair import Member
    from fegear.results.rating.rating_data import RatingData


def power_of(asked: PairToRate) -> float:
    """Nominal power of the pair [W], of both halves of a double helical one."""
    duty = asked.conditions.duty
    return asked.halves * duty.tangential * asked.conditions.geometry.pitch_line_velocity(duty.speed)


def transmittable_power(data: RatingData, asked: PairToRate) -> Both:
    """Power [W] at which flanks and roots of the weaker gear reach their required safeties, load factors unchanged."""
    found = data.formula if data.spectrum is None else data.spectrum
    of_flank, of_root = asked.conditions.required
    power = power_of(asked)
    return power * (min(found.contact_safety) / of_flank) ** 2, power * min(found.bending_safety) / of_root


def service_life(data: RatingData, asked: PairToRate, member: Member) -> ServiceLife:
    """Life of flank and root at the required safeties [s]; inf where nothing does damage, NaN where it is not known."""
    from fegear.formulas.iso6336.part6_spectrum import ServiceLife, damage

    i, required = asked.of(member), asked.conditions.required
    if data.spectrum is not None:
        life = math.nan if asked.life is None else asked.life
        sums = (
            damage([level.contact[i] for level in data.spectrum.levels], required[0]),
            damage([level.bending[i] for level in data.spectrum.levels], required[1]),
        )
        return ServiceLife(*(life / total if total > 0.0 else math.inf for total in sums))
    rate = _cycles_per_second(asked, i)
    return ServiceLife(*(
        _borne(curve, stress * least) / rate
        for curve, stress, least in zip(
            (data.curves.contact[i], data.curves.bending[i]),
            (data.formula.contact_stress[i], data.formula.bending_stress[i]), required, strict=True,
        )
    ))  # fmt: skip


def nominal_damage(data: RatingData, asked: PairToRate, member: Member) -> Both:
    """n/N of flank and root under the nominal load at a safety of 1."""
    i = asked.of(member)
    cycles = asked.conditions.duty.cycles[i]
    flank = _borne(data.curves.contact[i], data.formula.contact_stress[i])
    root = _borne(data.curves.bending[i], data.formula.bending_stress[i])
    return cycles / flank if flank else math.inf, cycles / root if root else math.inf


def _cycles_per_second(asked: PairToRate, i: int) -> float:
    """Load cycles of a flank of pinion or wheel per second."""
    duty = asked.conditions.duty
    return duty.speed * asked.conditions.geometry.turns[i] / (2.0 * math.pi) * duty.meshes[i]


def _borne(curve: Knots, stress: float) -> float:
    """Load cycles that a stress is borne."""
    from fegear.formulas.iso6336.part6_spectrum import cycles_to_failure

    return cycles_to_failure(curve, stress)
