"""ISO 6336-1: face load factors K_Hbeta from a misalignment of the flanks, and K_Fbeta from it.

Source: ISO 6336-1:2006, Calculation of load capacity of spur and helical gears - Part 1, clause 7: the mesh is a row of
equal springs c_gamma_beta that a straight gap keeps apart, so the load over the face is a straight line; what the gap
is after running in, F_betay, is an input.
"""

from __future__ import annotations

import math

from fegear.errors import RangeError

#: b/h counts as at least this in the exponent of K_Fbeta.
_LEAST_WIDTH = 3.0


def face_load_factor(misalignment: float, mesh_stiffness: float, line_load: float) -> float:
    """K_Hbeta = 1 + F_betay c / (2 F_m / b), or sqrt(2 F_betay c / (F_m / b)) where the face bears on a part only.

    Parameters
    ----------
    misalignment : float
        F_betay, from end to end of the face [m]; its sign does not matter.
    mesh_stiffness : float
        c_gamma_beta per face width [Pa].
    line_load : float
        F_m / b, mean tangential load per face width [N/m].

    Raises
    ------
    RangeError
        If the stiffness or the load is not positive.
    """
    for name, value in (("c_gamma_beta", mesh_stiffness), ("F_m/b", line_load)):
        if not value > 0.0:
            raise RangeError(name, f"{value:.4g}", "must be positive")
    relative = abs(misalignment) * mesh_stiffness / (2.0 * line_load)
    return 1.0 + relative if relative <= 1.0 else 2.0 * math.sqrt(relative)


def root_exponent(width: tuple[float, float], depth: tuple[float, float]) -> float:
    """N_F of K_Fbeta = K_Hbeta^N_F, 1 / (1 + h/b + (h/b)^2), with the smaller b/h of both gears and at least 3.

    Parameters
    ----------
    width : (float, float)
        b, face widths of both gears [m].
    depth : (float, float)
        h, tooth depths from tip to root [m].

    Raises
    ------
    RangeError
        If a width or a depth is not positive.
    """
    for b, h in zip(width, depth, strict=True):
        if not (b > 0.0 and h > 0.0):
            raise RangeError("b/h", f"{b:.4g}/{h:.4g}", "must be positive")
    flat = 1.0 / max(min(b / h for b, h in zip(width, depth, strict=True)), _LEAST_WIDTH)
    return 1.0 / (1.0 + flat + flat * flat)
