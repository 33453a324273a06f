"""ISO 6336-1: what running in takes off misalignment (y_beta) and pitch and profile deviations (y_alpha, y_p, y_f).

Source: ISO 6336-1:2006 with technical corrigendum 1:2008, 7.5.2.1 and 8.3.5.1; limits by pitch line velocity.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.formulas.iso6336 import groups

if TYPE_CHECKING:
    from fegear.formulas.iso6336.rated import Strength


def _share_and_limit(
    strength: Strength,
    velocity: float,
    soft: tuple[float, float],
    iron: tuple[float, float, float],
    hard: tuple[float, float],
) -> tuple[float, float]:
    """Part of a deviation that wears off and the most that does [m]."""
    fast = 2 if velocity > 10.0 else 1 if velocity > 5.0 else 0
    if strength.group in groups.SURFACE_HARDENED:
        return hard
    if strength.group in groups.SOFT_IRON:
        return iron[0], (math.inf, iron[1], iron[2])[fast]
    per_limit, most = soft
    return per_limit / strength.contact, (math.inf, most / strength.contact, 0.5 * most / strength.contact)[fast]


def helix_allowance(strength: Strength, misalignment: float, velocity: float) -> float:
    """y_beta of one material [m] (ISO 6336-1:2006, 7.5.2.1, Eqs. 44 to 48); 1 - y_beta/F_betax is x_beta.

    Parameters
    ----------
    strength : Strength
    misalignment : float
        F_betax [m].
    velocity : float
        v at the reference circle [m/s].
    """
    if not misalignment >= 0.0:
        raise RangeError("F_betax", misalignment, "must not be negative")
    share, most = _share_and_limit(strength, velocity, (320e6, 25600.0), (0.55, 45e-6, 22e-6), (0.15, 6e-6))
    return min(share * misalignment, most, misalignment)


def pitch_allowance(strength: Strength, deviation: float, velocity: float) -> float:
    """y_alpha of one material [m] (ISO 6336-1:2006, 8.3.5.1, Eqs. 75 to 77); y_p is that of f_pb, y_f that of f_falpha.

    Parameters
    ----------
    strength : Strength
    deviation : float
        f_pb, or f_falpha [m].
    velocity : float
        v at the reference circle [m/s].
    """
    if not deviation >= 0.0:
        raise RangeError("deviation", deviation, "must not be negative")
    share, most = _share_and_limit(strength, velocity, (160e6, 12800.0), (0.275, 22e-6, 11e-6), (0.075, 3e-6))
    return min(share * deviation, most, deviation)


def mean(values: tuple[float, float]) -> float:
    """Of two materials: half the sum of both allowances (ISO 6336-1:2006, 7.5.2.1 and 8.3.5.1)."""
    return 0.5 * (values[0] + values[1])
