"""Where a number that moves will probably be next: its answers are computed while nobody waits, and recalled then."""

from __future__ import annotations

import re
from dataclasses import replace
from decimal import Decimal
from typing import TYPE_CHECKING

from fegear.window.wanted import wanted_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.solution_cache import SolutionCache
    from fegear.window.job_queue import Asked

#: Numbers as a case writes them, without powers of ten.
_NUMBER = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))")


def next_texts(before: str, now: str) -> tuple[str, ...]:
    """Texts in which the one number that has changed goes on: as far again, then a last digit more and less.

    None where more has changed than a number.
    """
    first, last = _NUMBER.split(before), _NUMBER.split(now)
    if len(first) != len(last):
        return ()
    changed = [i for i, (one, other) in enumerate(zip(first, last, strict=True)) if one != other]
    if len(changed) != 1 or changed[0] % 2 == 0:  # words stand between the numbers
        return ()
    (at,) = changed
    value = Decimal(last[at])
    step = value - Decimal(first[at])
    digit = Decimal(1).scaleb(int(step.as_tuple().exponent)).copy_sign(step)
    steps = (one for one in (step, step + digit, step - digit) if one)
    return tuple("".join((*last[:at], str(value + one), *last[at + 1 :])) for one in steps)


def compute_ahead(asked: Asked, cache: SolutionCache, before: frozenset[str], seconds: Mapping[str, float]) -> None:
    """Compute into a cache what is waited for while a value moves; nobody is told.

    Parameters
    ----------
    asked : Asked
    cache : SolutionCache
    before : frozenset of str
        Gears that have previews now.
    seconds : mapping of str to float
        What tasks took before.

    Raises
    ------
    FegearError
        If the case is refused.
    """
    from fegear.engine.run import run_plan

    wanted = wanted_of(asked, cache, before)
    plan, at_once = wanted.in_order(asked, seconds)
    run_plan(wanted.scene, replace(plan, steps=plan.steps[:at_once]), cache=cache)
