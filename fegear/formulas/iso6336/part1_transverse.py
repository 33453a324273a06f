"""ISO 6336-1, clause 8: transverse load factors K_Halpha and K_Falpha by method B.

Source: ISO 6336-1:2006, 8.3; the edition of 2019 keeps the formulas. How unevenly several tooth pairs share the load
follows from the base pitch deviation that running in leaves, beside what the load deflects; a form deviation of the
profile that is larger stands for it (footnote 12).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from fegear.errors import RangeError


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
    line_load: float,
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
    line_load : float
        F_tH / b = F_t K_A K_gamma K_v K_Hbeta / b [N/m].
    contact_ratio_factor : float
        Z_epsilon, for the limit of K_Halpha.
    """
    if not contact_ratio >= 1.0:
        raise RangeError("contact ratio", f"{contact_ratio:.4g}", "must be at least 1")
    if overlap_ratio < 0.0:
        raise RangeError("overlap ratio", overlap_ratio, "must not be negative")
    for name, value in (("c_gamma_alpha", stiffness), ("F_tH/b", line_load), ("Z_epsilon", contact_ratio_factor)):
        if not value > 0.0:
            raise RangeError(name, value, "must be positive")
    if deviation < 0.0:
        raise RangeError("deviation less y_alpha", deviation, "must not be negative")
    total = contact_ratio + overlap_ratio
    relative = stiffness * deviation / line_load
    if total <= 2.0:
        unlimited = 0.5 * total * (0.9 + 0.4 * relative)
    else:
        unlimited = 0.9 + 0.4 * math.sqrt(2.0 * (total - 1.0) / total) * relative
    contact = total / (contact_ratio * contact_ratio_factor**2)
    bending = total / (0.25 * contact_ratio + 0.75)
    return TransverseFactors(
        unlimited, contact, bending, max(min(unlimited, contact), 1.0), max(min(unlimited, bending), 1.0)
    )
