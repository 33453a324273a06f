"""Tolerances of reliefs as an answer names them: how large they are, by which class, and which one matters most."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.printed import figures, percent
from fegear.design.preferred import CLEARLY
from fegear.design.tip_relief.tip_tolerance import HALVED, OF_LENGTH
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words

#: Numbers of a relief whose tolerance decides, in words.
_NUMBERS = {"profile_slope": "profile slope", "slope": "helix slope", "twist": "flank twist"}

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.design.tip_relief.tip_tolerance import Decisive, TipTolerance
    from fegear.geometry.pair import Member
    from fegear.results.relief.grinding import Grinding


def allowed_words(tolerances: Sequence[TipTolerance], ground: Sequence[Grinding], bare: Sequence[Grinding] = ()) -> str:
    """Tolerances of amount and length: "± 5 µm (f_Hα of class 5, assumed) and ± 10 % of the length".

    Parameters
    ----------
    tolerances : sequence of TipTolerance
        Of driver and driven gear.
    ground : sequence of Grinding
        Reliefs that are ground.
    bare : sequence of Grinding
        Of gears without relief whose profile slope is off by the tolerance of an amount.
    """
    of = dict(zip(("driver", "driven"), tolerances, strict=True))
    amounts: dict[str, list[str]] = {}
    for row in ground:
        one = of[row.member]
        origin = f" ({one.origin})" if one.origin else ""
        amounts.setdefault(f"± {microns(one.amount)} µm{origin}", []).append(row.gear)
    alike = len(amounts) == 1
    amount = ", ".join(words if alike else f"{words} on gear {', '.join(gears)}" for words, gears in amounts.items())
    length = of[ground[0].member].length
    over = f"{percent(OF_LENGTH)} of the length" if length is None else f"{figures(length * 1e3, 2)} mm of length"
    slopes = "".join(f", ± {microns(of[row.member].amount)} µm profile slope on gear {row.gear}" for row in bare)
    return f"{amount} and ± {over}{slopes}"


def decisive_words(
    drawn: float, most: float, torque: float, decisive: Decisive | None, gears: Mapping[Member, str]
) -> str:
    """Which tolerance matters most, and what half of it brings; that none does, where half of the best hardly counts.

    Empty where tolerances as a whole hardly count.

    Parameters
    ----------
    drawn, most : float
        Peak-to-peak transmission error as drawn, and at most within all tolerances [m].
    torque : float
        [N m].
    decisive : Decisive or None
    gears : mapping of member to str
        Names of the gears whose tolerances count.
    """
    if decisive is None or decisive.member not in gears or drawn >= CLEARLY * most:
        return ""
    if decisive.most >= CLEARLY * most:
        return (
            f"no single tolerance decides: half of any one reduces the maximum at {torque_words(torque)} by less than "
            f"{percent(1.0 - CLEARLY, whole=True)}"
        )
    number, half = decisive.number, HALVED * decisive.given
    size = f"{figures(half * 1e3, 2)} mm" if number == "length" else f"{microns(half)} µm"
    more, less = told_apart(most, decisive.most)
    return (
        f"the tolerance of the {_NUMBERS.get(number, number)} on gear {gears[decisive.member]} matters most: halved to "
        f"± {size}, at most {less} instead of {more} µm at {torque_words(torque)}"
    )
