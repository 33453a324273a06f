"""Palmgren's fit for the approach of a roller and its race, as gear engineers use it per tooth.

Sources: G. Lundberg and A. Palmgren, Dynamic Capacity of Rolling Bearings, Acta Polytechnica, Mech. Eng. Series 1(3)
(1947); in the form of NASA TM-100180 (Lin, Huston and Coy 1987), Eq. 10: q_c = 1.275 / (E^0.9 F^0.8 W^0.1), the
deflection of one tooth per unit load. A fit to steel rollers: it knows neither radius nor Poisson's ratio.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.errors import RangeError

#: Of the load in the deflection.
EXPONENT = 0.9


def approach(line_load: ArrayLike, face_width: float, young_modulus: float) -> NDArray[np.float64]:
    """Contact deflection of one tooth, W q_c = 1.275 (W/E)^0.9 / F^0.8 = 1.275 (w/E)^0.9 F^0.1 [m], w = W/F.

    Parameters
    ----------
    line_load : array_like
        w = W/F >= 0 [N/m].
    face_width : float
        F [m]: the exponents leave F^0.1, so unlike Hertz's the result depends on the face width itself.
    young_modulus : float
        E [Pa].

    Raises
    ------
    RangeError
        If the load is negative or the face width or modulus is not positive.
    """
    w = np.asarray(line_load, dtype=float)
    if not np.all(w >= 0.0):
        raise RangeError("line load", f"{np.min(w):.6g} N/m", "must not be negative (no tension in the contact)")
    for name, value in (("face width", face_width), ("young_modulus", young_modulus)):
        if not (math.isfinite(value) and value > 0.0):
            raise RangeError(name, value, "must be positive and finite")
    return np.asarray(1.275 * (w / young_modulus) ** EXPONENT * face_width**0.1)
