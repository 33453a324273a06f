"""Remarks of the result ``rating``: what falls short first, then what is doubtful."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.base.notes import assuming, exceeding, failing, neglecting
from fegear.base.printed import percent
from fegear.engine.sheet.load_words import load_words
from fegear.geometry.pair import MEMBERS
from fegear.results.rating.shared_load import bending_said

if TYPE_CHECKING:
    from fegear.case.built.rated_pair import PairToRate
    from fegear.formulas.iso6336.conditions import Factor
    from fegear.results.rating.rating_data import RatingData

#: What the formulas remark where a value of the case stands in.
_STANDS_IN = "FE value instead of the formula"


#: K_v above which the load is a trifle beside what flank deviations excite: teeth part and meet again.
_SHAKEN = 10.0


#: How near to an axial contact ratio of 1 the jump of AGMA's J is reported, and from which size.
_NEAR_ONE, _WORTH_SAYING = 0.1, 0.05


#: Which S-N line the flanks have under a spectrum.
_SPECTRUM_LINE = {
    "part-2": (
        "Pair {name}: pitting under the load spectrum uses the S-N curve of ISO 6336-2, in which Z_L Z_v Z_R apply "
        "in full only at the reference life; ISO 6336-6 annex C applies them at all load cycles (lower if they are "
        'below 1): operation.spectrum_line = "annex-c".'
    ),
    "annex-c": "Pair {name}: pitting under the load spectrum uses the S-N curve of the example in annex C of ISO "
    "6336-6.",
}


def shortfalls(data: RatingData, asked: PairToRate) -> tuple[str, ...]:
    """What a reader must know before anything else: safeties below the required ones, and a load of no account."""
    found, told = data.spectrum, []
    if found is not None:
        told = [
            failing(
                f"Pair {asked.name}: {what} of gear {gear} exceed the static strength at one level of the spectrum."
            )
            for what, sums in (("flanks", found.contact_damage), ("roots", found.bending_damage))
            for member, gear in zip(MEMBERS, asked.gears, strict=True)
            if math.isinf(sums[asked.of(member)])
        ]
    contact = data.formula.contact_safety if found is None else found.contact_safety
    bending = data.formula.bending_safety if found is None else found.bending_safety
    under = "" if found is None else " under the load spectrum"
    for member, gear in zip(MEMBERS, asked.gears, strict=True):
        for symbol, safety, least in zip(("S_H", "S_F"), (contact, bending), asked.conditions.required, strict=True):
            value = safety[asked.of(member)]
            if value < least:
                told.append(
                    failing(
                        f"Pair {asked.name}: {symbol} = {value:.4g} of gear {gear} ({member}){under} is below the "
                        f"minimum {least:g}.",
                        _load_margin(symbol, value / least),
                    )
                )
    levels = [] if found is None else [one.rating for one in found.levels if one.rating is not None]
    most = max(one["K_v"].value for one in (levels or [data.formula]))
    if most > _SHAKEN and "K_v" not in asked.given:
        told.append(
            exceeding(
                f"Pair {asked.name}: K_v = {most:.4g} of ISO 6336-1 is above {_SHAKEN:g}: dynamic forces from flank "
                "deviations are many times the load (loss of contact), outside the scope of the formula; check the "
                "load or set operation.dynamic_factor."
            )
        )
    return tuple(told)


def _load_margin(symbol: str, ratio: float) -> float:
    """Load at the minimum safety over the present one: contact stress follows the root of the load."""
    return ratio**2 if symbol == "S_H" else ratio


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
            f"Pair {asked.name}: FE root stress (2D) at the outer point of single pair contact replaces Y_F Y_S Y_B; "
            'load factors from the formulas. Set width = "solid" for an FE load distribution.'
        )
        if data.bent is not None and data.by_computed is not None:
            told.append(bending_said(asked.name, data.bent, data.by_computed["Y_M"].values))
    else:
        load, pressure = load_words(data.computed.load), data.computed.pressure * 1e-6
        where = "on the driver" if load.endswith("N m") else "along the line of action"
        told.append(
            f"Pair {asked.name}: load distribution and root stress computed by FE at {load} {where} "
            f"(including K_A, K_gamma, K_v), maximum pressure {pressure:.4g} MPa. The FE root stress replaces "
            "Y_F Y_S Y_beta Y_B Y_DT K_Fbeta K_Falpha."
        )
        told += _aligned(data, asked)
    return tuple(dict.fromkeys(told))


def _recalled(data: RatingData, asked: PairToRate) -> list[str]:
    """Say which numbers of a rating are those of no printed source, beside those that a factor remarks on itself."""
    if asked.mean_stress is not None or not any(asked.stress_ratio):
        return []
    values = ", ".join(f"{value:.3g}" for value in data.formula["Y_M"].values)
    told = assuming(
        f"Pair {asked.name}: Y_M = {values} (pinion, wheel): mean stress ratios M of ISO 6336-3 annex B are not "
        "verified against a printed source, except 0.7 for idlers (operation.mean_stress_factor)."
    )
    return [told]


def _beside_the_jump(asked: PairToRate) -> list[str]:
    """Say where J of AGMA 908 jumps near the pair's axial contact ratio."""
    from fegear.formulas.agma.agma908 import jump_of_bending_factor

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
    sizes = ", ".join(f"{percent(jump, signed=True)} (gear {gear})" for gear, jump in jumps.items())
    told = (
        f"Pair {asked.name}: axial contact ratio {ratio:.3f}: at 1, J of AGMA 908 and S_F change abruptly by {sizes} "
        "with increasing face width (load at the tip with C_h and K_psi above, single tooth contact with C_psi "
        "below)."
    )
    return [told]


def _aligned(data: RatingData, asked: PairToRate) -> list[str]:
    """Say what misalignment the standard counts and the computed flanks do not have."""
    counted = [one.value for one in data.formula.factors if one.symbol == "F_betay"]
    if asked.misaligned or not counted:
        return []
    gap = f"{counted[0] * 1e6:.3g} um"
    told = neglecting(
        f"Pair {asked.name}: the FE load distribution has no misalignment, ISO 6336 uses F_betay = {gap}. For the "
        f'same input set pair.{asked.name}.line_error = {{ over_face = "{gap}" }} and effects.misalignment = true.'
    )
    return [told]


def _shown(one: Factor, asked: PairToRate) -> bool:
    """Whether a factor's remark is the reader's: not that the case gave it."""
    return bool(one.remark) and remark_of(one, asked) == one.remark and "as specified" not in one.remark


def remark_of(one: Factor, asked: PairToRate) -> str:
    """A factor's remark, which says of a given one that it was given."""
    given = one.symbol in asked.given or (one.symbol == "K_Falpha" and "K_Halpha" in asked.given)
    return "as specified in the case" if given and _STANDS_IN in one.remark else one.remark
