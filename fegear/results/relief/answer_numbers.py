"""Lengths and torques as the answers on reliefs have them: one rounding, whichever sentence states a number."""

from __future__ import annotations

import math

from fegear.base.printed import figures
from fegear.design.ground_digits import amount_step, to_step

#: Digits of a length in µm, and of two that read the same with so many.
_DIGITS, _APART = 2, 3
#: A length below this is none [m].
_NOTHING = 1e-9


def microns(size: float, digits: int = _DIGITS) -> str:
    """A length [m] in µm, without the unit: ``"2.9"``, ``"0"``."""
    return figures(size * 1e6, digits) if abs(size) > _NOTHING else "0"


def ground_microns(size: float) -> str:
    """An amount to grind [m] in µm with the digits of the grinding table, without the unit: ``"17.6"``, ``"0.057"``."""
    return f"{to_step(size, amount_step(size)) * 1e6:.5g}" if abs(size) > _NOTHING else "0"


def told_apart(one: float, other: float) -> tuple[str, str]:
    """Two lengths [m] in µm as sentences beside have them; with three digits where they would read the same."""
    first, second = microns(one), microns(other)
    return (first, second) if first != second else (microns(one, _APART), microns(other, _APART))


def with_limits(amount: float, tolerance: float, least: float = -math.inf) -> str:
    """An amount [m] as a grinder reads it; where the tolerance is as large, by its limits, of which none is below one.

    ``"6.4 ± 3 µm"``, ``"0 to 10 µm (nominal 4.8)"``.
    """
    if tolerance < abs(amount):
        return f"{ground_microns(amount)} ± {ground_microns(tolerance)} µm"
    low, high = max(amount - tolerance, least), amount + tolerance
    return f"{ground_microns(low)} to {ground_microns(high)} µm (nominal {ground_microns(amount)})"


def torque_words(torque: float) -> str:
    """A torque [N m] with its unit."""
    return f"{figures(torque, 4)} N m"
