"""ISO 6336-1, clause 8: transverse load factors K_Halpha and K_Falpha by method B.

Source: ISO 6336-1:2006, 8.3; the edition of 2019 keeps the formulas. How unevenly several tooth pairs share the load
follows from the base pitch deviation that running in leaves, besides what the load deflects; a form deviation of the
profile that is larger stands for it (footnote 12).

ISO 6336-1: what running in takes off misalignment (y_beta) and pitch and profile deviations (y_alpha, y_p, y_f).

Source: ISO 6336-1:2006 with technical corrigendum 1:2008, 7.5.2.1 and 8.3.5.1; limits by pitch line velocity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.formulas.iso6336 import part5_materials as groups

if TYPE_CHECKING:
    from fegear.formulas.iso6336.rated import Strength


@dataclass(frozen=True, slots=True)
class TransverseFactors:
    """K_Halpha, K_Falpha, the value before their limits, and the limits.

    Parameters
    ----------
    unlimited : float
        What the deviations give.
    contact_limit, bending_limit : float
        Largest values: all the load on the one tooth pair in contact.
    K_Halpha, K_Falpha : float
        At least 1.
    """

    unlimited: float
    contact_limit: float
    bending_limit: float
    K_Halpha: float
    K_Falpha: float


def method_b(
    contact_ratio: float,
    overlap_ratio: float,
    stiffness: float,
    deviation: float,
    specific_load: float,
    contact_ratio_factor: float,
) -> TransverseFactors:
    """K_Halpha and K_Falpha (ISO 6336-1:2006, 8.3.2 to 8.3.4, Eqs. 71 to 74).

    Parameters
    ----------
    contact_ratio, overlap_ratio : float
        epsilon_alpha, epsilon_beta.
    stiffness : float
        c_gamma_alpha [Pa].
    deviation : float
        f_pb - y_alpha of the gear with the larger f_pb, or f_falpha - y_alpha where that is larger [m].
    specific_load : float
        F_tH / b = F_t K_A K_gamma K_v K_Hbeta / b [N/m].
    contact_ratio_factor : float
        Z_epsilon, for the limit of K_Halpha.
    """
    if not contact_ratio >= 1.0:
        raise RangeError("contact ratio", f"{contact_ratio:.4g}", "must be at least 1")
    if overlap_ratio < 0.0:
        raise RangeError("overlap ratio", overlap_ratio, "must not be negative")
    for name, value in (("c_gamma_alpha", stiffness), ("F_tH/b", specific_load), ("Z_epsilon", contact_ratio_factor)):
        if not value > 0.0:
            raise RangeError(name, value, "must be positive")
    if deviation < 0.0:
        raise RangeError("deviation minus y_alpha", deviation, "must not be negative")
    total = contact_ratio + overlap_ratio
    relative = stiffness * deviation / specific_load
    if total <= 2.0:
        unlimited = 0.5 * total * (0.9 + 0.4 * relative)
    else:
        unlimited = 0.9 + 0.4 * math.sqrt(2.0 * (total - 1.0) / total) * relative
    contact = total / (contact_ratio * contact_ratio_factor**2)
    bending = total / (0.25 * contact_ratio + 0.75)
    return TransverseFactors(
        unlimited, contact, bending, max(min(unlimited, contact), 1.0), max(min(unlimited, bending), 1.0)
    )


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
