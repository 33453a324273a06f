"""Blok's flash temperature of two flanks that slide on each other.

Sources: H. Blok, Theoretical study of temperature rise at surfaces of actual contact under oiliness lubricating
conditions, General Discussion on Lubrication, IMechE 2 (1937) 222-235; ISO/TR 13989-1:2000 (now ISO/TS 6336-20),
Eq. 3 and Annex A: 0.62 w^0.75 (E_r / rho)^0.25 |sqrt v_1 - sqrt v_2| / B_M with equal materials.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.formulas.flank_speeds import FlankSpeeds

#: Constant of the standard. Blok's integral over a semi-elliptical source gives 0.623 (tests hold it).
_BLOK = 0.62


#: Thermal contact coefficient B_M = sqrt(lambda rho c) of steel [N/(m s^0.5 K)], of scuffing and micropitting alike:
#: 13.780 N/(mm s^0.5 K), as a printed report has it for 18CrNiMo7-6 (fegear/verify/data/kisssoft_stage_3.toml). ISO/TR
#: 13989-1, A.3, has 435 N/(mm^0.5 m^0.5 s^0.5 K) for martensitic steels, .2 % less.
STEEL_HEAT = 13780.0


def reduced_modulus(young: tuple[float, float], poisson: tuple[float, float]) -> float:
    """E_r = 2 / ((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2) [Pa] (ISO/TR 13989-1, Eq. A.10)."""
    return 2.0 / sum((1.0 - nu * nu) / e for e, nu in zip(young, poisson, strict=True))


def flash_temperature(
    speeds: FlankSpeeds,
    line_load: ArrayLike,
    friction: ArrayLike,
    modulus: float,
    heat: tuple[float, float] = (STEEL_HEAT, STEEL_HEAT),
) -> Array:
    """Greatest rise of the surfaces above their bulk temperature while they touch [K].

    Zero at the pitch point, where nothing slides, and where a flank bears no load.

    Parameters
    ----------
    speeds : FlankSpeeds
    line_load : array_like
        Force in the plane of action per length of contact line [N/m]: F_bt / b of a whole contact line.
    friction : array_like
        Friction coefficient.
    modulus : float
        E_r [Pa].
    heat : (float, float)
        Thermal contact coefficients of driver and driven gear [N/(m s^0.5 K)].

    Raises
    ------
    RangeError
        If a modulus or coefficient is not positive.
    """
    for name, value in (("E_r", modulus), ("B_M", min(heat))):
        if not value > 0.0:
            raise RangeError(name, value, "must be positive")
    w = np.maximum(np.asarray(line_load, dtype=float), 0.0)
    radius = np.maximum(speeds.relative_radius, np.finfo(float).tiny)
    through = heat[0] * np.sqrt(speeds.rolling_driver) + heat[1] * np.sqrt(speeds.rolling_driven)
    taken = np.abs(speeds.sliding) / np.maximum(through, np.finfo(float).tiny)
    return np.asarray(_BLOK * np.asarray(friction) * w**0.75 * (modulus / radius) ** 0.25 * taken)
