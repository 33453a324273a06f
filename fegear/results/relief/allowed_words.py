"""Tolerances of tip reliefs as an answer names them: how large they are, and by which class."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.printed import figures, percent
from fegear.design.tip_relief.tip_tolerance import OF_LENGTH

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.design.tip_relief.tip_tolerance import TipTolerance
    from fegear.results.relief.grinding import Grinding


def allowed_words(tolerances: Sequence[TipTolerance], ground: Sequence[Grinding]) -> str:
    """Tolerances of amount and length: "± 5 µm (f_Hα of class 5, assumed) and ± 10 % of the length".

    Parameters
    ----------
    tolerances : sequence of TipTolerance
        Of driver and driven gear.
    ground : sequence of Grinding
        Reliefs that are ground; a gear without one needs no tolerance.
    """
    of = dict(zip(("driver", "driven"), tolerances, strict=True))
    amounts: dict[str, list[str]] = {}
    for row in ground:
        one = of[row.member]
        origin = f" ({one.origin})" if one.origin else ""
        amounts.setdefault(f"± {figures(one.amount * 1e6, 2)} µm{origin}", []).append(row.gear)
    alike = len(amounts) == 1
    amount = ", ".join(words if alike else f"{words} on gear {', '.join(gears)}" for words, gears in amounts.items())
    length = of[ground[0].member].length
    over = f"{percent(OF_LENGTH)} of the length" if length is None else f"{figures(length * 1e3, 2)} mm of length"
    return f"{amount} and ± {over}"
