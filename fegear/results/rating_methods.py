"""Stresses and safeties of a pair by every method of the result ``rating``, side by side for table and picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.formulas.iso6336.rated import Both
    from fegear.models.rated_pair import PairToRate
    from fegear.results.rating import RatingData

_UNKNOWN = (math.nan, math.nan)


@dataclass(frozen=True, slots=True)
class Method:
    """Of pinion and wheel; stresses [Pa], errors relative; NaN where there is none.

    Parameters
    ----------
    name : str
    contact, bending, s_h, s_f, s_h_error, s_f_error : (float, float)
        sigma_H, sigma_F, S_H, S_F.
    """

    name: str
    contact: Both
    bending: Both
    s_h: Both
    s_f: Both
    s_h_error: Both = _UNKNOWN
    s_f_error: Both = _UNKNOWN


def methods(data: RatingData, asked: PairToRate) -> tuple[Method, ...]:
    """Every method that was asked for, ISO 6336 first."""
    one = data.formula
    found = [
        Method(
            f"ISO 6336:{asked.conditions.edition}", one.contact_stress, one.bending_stress, one.contact_safety,
            one.bending_safety,
        )
    ]  # fmt: skip
    if data.by_computed is not None and data.computed is not None:
        own, off = data.by_computed, data.computed
        wide = off.replacement.K_Hbeta is not None  # of a plane pair nothing of the contact is computed
        found.append(
            Method(
                "computed", own.contact_stress if wide else _UNKNOWN, own.bending_stress,
                own.contact_safety if wide else _UNKNOWN, own.bending_safety,
                (off.contact_error, off.contact_error) if wide else _UNKNOWN, off.bending_error,
            )
        )  # fmt: skip
    if data.agma is not None:
        first, second = (data.agma.members.index(member) for member in asked.conditions.geometry.members)
        contact, bending, s_h, s_f = (
            (values[first], values[second])
            for values in (data.agma.contact, data.agma.bending, data.agma.S_H, data.agma.S_F)
        )
        found.append(Method("AGMA 2101-D04", contact, bending, s_h, s_f))
    for name, under in (("ISO 6336, spectrum", data.spectrum), ("computed, spectrum", data.spectrum_computed)):
        if under is not None:
            flanks = under is data.spectrum or data.computed is None or data.computed.replacement.K_Hbeta is not None
            contact = under.contact_safety if flanks else _UNKNOWN
            found.append(Method(name, _UNKNOWN, _UNKNOWN, contact, under.bending_safety))
    return tuple(found)
