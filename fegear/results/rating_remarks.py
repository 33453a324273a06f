"""Remarks of the result ``rating``: what falls short first, then what is doubtful."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.geometry.pair import MEMBERS
from fegear.results.rating_tables import remark_of

if TYPE_CHECKING:
    from fegear.formulas.iso6336.pair_rating import Factor
    from fegear.models.rated_pair import PairToRate
    from fegear.results.rating import RatingData

#: K_v above which the load is a trifle beside what flank deviations excite: teeth part and meet again.
_SHAKEN = 10.0
#: How near to an axial contact ratio of 1 the jump of AGMA's J is told, and from which size.
_NEAR_ONE, _WORTH_SAYING = 0.1, 0.05
#: Which S-N line the flanks have under a spectrum.
_SPECTRUM_LINE = {
    "part-2": (
        "Pair {name}: under the spectrum the flanks have the S-N line of ISO 6336-2, whose film factors come in "
        "between static strength and reference; that of annex C of ISO 6336-6 has them at all load "
        "cycles and is the lower one where they are below 1 (operation.spectrum_line)."
    ),
    "annex-c": "Pair {name}: under the spectrum the flanks have the S-N line of the example in annex C of ISO 6336-6.",
}


def shortfalls(data: RatingData, asked: PairToRate) -> tuple[str, ...]:
    """What a reader must know before anything else: safeties below the required ones, and a load of no account."""
    found, told = data.spectrum, []
    if found is not None:
        told = [
            f"Pair {asked.name}: a level of the spectrum has the {what} of gear {gear} above their static strength."
            for what, sums in (("flanks", found.contact_damage), ("roots", found.bending_damage))
            for member, gear in zip(MEMBERS, asked.gears, strict=True)
            if math.isinf(sums[asked.of(member)])
        ]
    contact = data.formula.contact_safety if found is None else found.contact_safety
    bending = data.formula.bending_safety if found is None else found.bending_safety
    under = "" if found is None else " under the spectrum"
    for member, gear in zip(MEMBERS, asked.gears, strict=True):
        for symbol, safety, least in zip(("S_H", "S_F"), (contact, bending), asked.conditions.required, strict=True):
            value = safety[asked.of(member)]
            if value < least:
                told.append(
                    f"Pair {asked.name}: {symbol} = {value:.4g} of gear {gear} ({member}){under} is below the required "
                    f"{least:g}."
                )
    levels = [] if found is None else [one.rating for one in found.levels if one.rating is not None]
    most = max(one["K_v"].value for one in (levels or [data.formula]))
    if most > _SHAKEN and "K_v" not in asked.given:
        told.append(
            f"Pair {asked.name}: K_v = {most:.4g} of ISO 6336-1 is above {_SHAKEN:g}: flank deviations excite forces "
            "many times the load, under which teeth part and for which its formula is not meant; check the load, or "
            "give dynamic_factor (operation)."
        )
    return tuple(told)


def rating_remarks(data: RatingData, asked: PairToRate) -> tuple[str, ...]:
    """What lies outside a range, and what the computed safeties count."""
    told = [f"Pair {asked.name}: {remark_of(one, asked)}." for one in data.formula.factors if _shown(one, asked)]
    told += [f"Pair {asked.name}: {reason}" for reason in data.why_not]
    told += _recalled(data, asked)
    if data.spectrum is not None:
        told.append(_SPECTRUM_LINE[asked.conditions.spectrum_line].format(name=asked.name))
    if data.agma is not None:
        told += _beside_the_jump(asked)
    if data.computed is None:
        return tuple(dict.fromkeys(told))
    if asked.width == "plane":
        told.append(
            f"Pair {asked.name}: computed is the root stress of the plane teeth at the outer point of single pair "
            "contact, in the place of Y_F Y_S Y_B; load factors are those of the formulas. Write width = "
            '"solid" for a computed load distribution.'
        )
    else:
        load, pressure = data.computed.load, data.computed.pressure * 1e-6
        told.append(
            f"Pair {asked.name}: load distribution and root stress were computed at {load:.5g} N along the line of "
            f"action (K_A, K_gamma and K_v included), where the largest pressure is {pressure:.4g} MPa. The computed "
            "root stress holds load sharing, face distribution and helix already: it stands for Y_F Y_S Y_beta Y_B "
            "Y_DT K_Fbeta K_Falpha together."
        )
        told += _aligned(data, asked)
    return tuple(dict.fromkeys(told))


def _recalled(data: RatingData, asked: PairToRate) -> list[str]:
    """Say which numbers of a rating are those of no printed source, beside those that a factor remarks on itself."""
    if asked.mean_stress is not None or not any(asked.stress_ratio):
        return []
    values = ", ".join(f"{value:.3g}" for value in data.formula["Y_M"].values)
    told = (
        f"Pair {asked.name}: Y_M = {values} (pinion, wheel) takes mean stress ratios M of annex B of ISO 6336-3 which "
        "are recalled: no printed source was at hand (operation.mean_stress_factor; .7 of idlers is printed)."
    )
    return [told]


def _beside_the_jump(asked: PairToRate) -> list[str]:
    """Say where J of AGMA 908 jumps near the pair's axial contact ratio."""
    from fegear.formulas.agma908_pair import jump_of_bending_factor

    ratio = asked.pair.overlap_ratio
    if ratio == 0.0 or abs(ratio - 1.0) > _NEAR_ONE:
        return []
    try:
        jumps = {
            gear: jump_of_bending_factor(asked.pair, member) - 1.0
            for member, gear in zip(MEMBERS, asked.gears, strict=True)
        }
    except RangeError:  # a face that narrow or wide is none of its pairs
        return []
    if max(abs(jump) for jump in jumps.values()) < _WORTH_SAYING:
        return []
    sizes = ", ".join(f"{jump:+.0%} (gear {gear})" for gear, jump in jumps.items())
    told = (
        f"Pair {asked.name}: its axial contact ratio is {ratio:.3f}, and at 1 the J of AGMA 908, and S_F with it, "
        f"jumps by {sizes} as the face widens: above it counts the load at the tip with C_h and K_psi, up to it that "
        "of single tooth contact with C_psi."
    )
    return [told]


def _aligned(data: RatingData, asked: PairToRate) -> list[str]:
    """Say what misalignment the standard counts and the computed flanks do not have."""
    counted = [one.value for one in data.formula.factors if one.symbol == "F_betay"]
    if asked.misaligned or not counted:
        return []
    gap = f"{counted[0] * 1e6:.3g} um"
    told = (
        f"Pair {asked.name}: the computed flanks are aligned, while ISO 6336 counts a misalignment of F_betay = {gap} "
        f'after running in. The same for both: pair.{asked.name}.line_error = {{ over_face = "{gap}" }} and '
        "effects.misalignment = true."
    )
    return [told]


def _shown(one: Factor, asked: PairToRate) -> bool:
    """Whether a factor's remark is the reader's: not that the case gave it."""
    return bool(one.remark) and remark_of(one, asked) == one.remark and "as given" not in one.remark
