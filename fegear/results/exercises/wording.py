"""A question of an exercise with its answer, and how the numbers of its formulas are written."""

from __future__ import annotations

import math
from typing import NamedTuple

from fegear.base.printed import figures as plain_figures

#: Digits of an answer: what students compare.
DIGITS = 4
#: Radians per second in revolutions per minute.
RPM = 30.0 / math.pi
#: Two numbers that differ by less are one [parts].
_SAME = 5e-4


class Exercise(NamedTuple):
    """A question and its answer.

    Attributes
    ----------
    topic : str
        Under which it is chosen.
    question, answer : str
    number : str
        End of the name of a computed value that the page adds, empty for none.
    words : str
        What it adds, with ``{}`` where the value goes.
    """

    topic: str
    question: str
    answer: str
    number: str = ""
    words: str = ""


def figures(value: float, digits: int) -> str:
    """Rounded, with the minus sign of a formula."""
    return plain_figures(value, digits).replace("-", "−")


def signed(value: float, decimals: int) -> str:
    """With so many decimals, and the minus sign of a formula."""
    return f"{value:.{decimals}f}".replace("-", "−")


def mm(length: float) -> str:
    """A length in millimetres."""
    return f"{figures(length * 1e3, DIGITS)} mm"


def distance(length: float) -> str:
    """A centre distance, to the micrometre."""
    return f"{length * 1e3:.3f}".rstrip("0").rstrip(".") + " mm"


def degrees(angle: float) -> str:
    """An angle in degrees."""
    return f"{figures(math.degrees(angle), DIGITS)}°"


def same(one: float, other: float) -> bool:
    """Whether two numbers are one, as far as an answer is written."""
    return abs(one - other) <= _SAME * max(abs(one), abs(other))
