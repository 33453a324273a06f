"""Service life, damage and transmittable power of a rated pair, for the values of the result ``rating``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.engine.outcome import Value
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.formulas.iso6336.life import Knots
    from fegear.formulas.iso6336.rated import Both
    from fegear.geometry.pair import Member
    from fegear.models.rated_pair import PairToRate
    from fegear.results.rating import RatingData


def power_of(asked: PairToRate) -> float:
    """Nominal power of the pair [W]."""
    duty = asked.conditions.duty
    return duty.tangential * asked.conditions.geometry.pitch_line_velocity(duty.speed)


def transmittable_power(data: RatingData, asked: PairToRate) -> Both:
    """Power [W] at which flanks and roots of the weaker gear reach their required safeties, load factors unchanged."""
    found = data.formula if data.spectrum is None else data.spectrum
    of_flank, of_root = asked.conditions.required
    power = power_of(asked)
    return power * (min(found.contact_safety) / of_flank) ** 2, power * min(found.bending_safety) / of_root


def service_life(data: RatingData, asked: PairToRate, member: Member) -> Both:
    """Life of flank and root at the required safeties [s]; inf where nothing does damage, NaN where it is not known."""
    from fegear.formulas.iso6336.part6_spectrum import damage

    i, required = asked.of(member), asked.conditions.required
    if data.spectrum is not None:
        life = math.nan if asked.life is None else asked.life
        sums = (
            damage([level.contact[i] for level in data.spectrum.levels], required[0]),
            damage([level.bending[i] for level in data.spectrum.levels], required[1]),
        )
        one, other = (life / total if total > 0.0 else math.inf for total in sums)
        return one, other
    rate = _cycles_per_second(asked, i)
    one, other = (
        _borne(curve, stress * least) / rate
        for curve, stress, least in zip(
            (data.curves.contact[i], data.curves.bending[i]),
            (data.formula.contact_stress[i], data.formula.bending_stress[i]), required, strict=True,
        )
    )  # fmt: skip
    return one, other


def nominal_damage(data: RatingData, asked: PairToRate, member: Member) -> Both:
    """n/N of flank and root under the nominal load at a safety of 1."""
    i = asked.of(member)
    cycles = asked.conditions.duty.cycles[i]
    flank = _borne(data.curves.contact[i], data.formula.contact_stress[i])
    root = _borne(data.curves.bending[i], data.formula.bending_stress[i])
    return cycles / flank if flank else math.inf, cycles / root if root else math.inf


def life_values(data: RatingData, asked: PairToRate) -> list[Value]:
    """Transmittable power of the pair, service life and, without a spectrum, damage of both gears."""
    name, (flank, root) = asked.name, transmittable_power(data, asked)
    found = [
        Value(f"{name}.transmittable_power", min(flank, root), "kW", None,
              "at which the required safeties are reached, with the load factors of this load"),
        Value(f"{name}.transmittable_power_H", flank, "kW", None, "the same of the flanks alone"),
        Value(f"{name}.transmittable_power_F", root, "kW", None, "the same of the roots alone"),
    ]  # fmt: skip
    for member in MEMBERS:
        key, (of_flank, of_root) = f"{name}.{member}", service_life(data, asked, member)
        found += [
            Value(f"{key}.life_H", of_flank, "h", None, "service life of the flanks at the required safety"),
            Value(f"{key}.life_F", of_root, "h", None, "service life of the roots at the required safety"),
        ]
        if data.spectrum is None:
            harm_flank, harm_root = nominal_damage(data, asked, member)
            found += [
                Value(f"{key}.damage_H", harm_flank, "", None, "n/N of the flanks at a safety of 1"),
                Value(f"{key}.damage_F", harm_root, "", None, "n/N of the roots at a safety of 1"),
            ]
    return [value for value in found if math.isfinite(value.si)]


def _cycles_per_second(asked: PairToRate, i: int) -> float:
    """Load cycles of a flank of pinion or wheel per second."""
    geometry, duty = asked.conditions.geometry, asked.conditions.duty
    turning = duty.speed * geometry.gears[0].teeth / geometry.gears[i].teeth
    return turning / (2.0 * math.pi) * duty.meshes[i]


def _borne(curve: Knots, stress: float) -> float:
    """Load cycles that a stress is borne."""
    from fegear.formulas.iso6336.part6_spectrum import cycles_to_failure

    return cycles_to_failure(curve, stress)
