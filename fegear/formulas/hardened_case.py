"""Hardness and residual stress below the flanks of surface-hardened teeth: measured, or by Lang's curves.

The case depth CHD is that at 550 HV (ISO 18203). Both curves of Lang (O. R. Lang, The dimensioning of complex steel
members in the range of endurance strength and fatigue life, 1988) are recalled: no print of them was at hand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError

#: Hardness at the case depth [HV].
AT_CASE_DEPTH = 550.0
#: HV - HV_core falls as 10^-(0.0381 t + 0.2662 t^2).
_LINEAR, _SQUARE = 0.0381, 0.2662
#: Residual stress: -1.25 MPa per HV above the core up to 300 HV, 2/7 MPa per HV less 460 MPa beyond.
_SLOPE, _KNEE, _FLAT, _OFFSET = 1.25e6, 300.0, 2e6 / 7.0, 460e6
#: Points of a measured profile: depths [m] and values.
Profile = tuple[tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class HardenedCase:
    """The case of a gear's flanks.

    Parameters
    ----------
    surface, core : float
        Hardness of flank and core [HV].
    case_depth : float
        CHD [m]; NaN where a measured profile has no 550 HV.
    measured : Profile or None
        Hardness [HV], in place of Lang's curve through the case depth.
    residual : Profile or None
        Residual stress along profile and face [Pa], in place of Lang's rule.
    """

    surface: float
    core: float
    case_depth: float
    measured: Profile | None = None
    residual: Profile | None = None

    def hardness(self, depth: ArrayLike) -> Array:
        """HV(y); beyond the last measured point that of the point."""
        if self.measured is not None:
            return np.asarray(np.interp(np.asarray(depth, dtype=float), *self.measured))
        return lang_hardness(depth, self.surface, self.core, self.case_depth)

    def residual_stress(self, depth: ArrayLike) -> Array:
        """sigma_RS(y) [Pa]; beyond the last measured point that of the point."""
        if self.residual is not None:
            return np.asarray(np.interp(np.asarray(depth, dtype=float), *self.residual))
        return lang_residual_stress(self.hardness(depth), self.core)


def depth_of(measured: Profile, hardness: float = AT_CASE_DEPTH) -> float:
    """First depth at which a measured profile falls below a hardness [m]; NaN where it does nowhere."""
    depth, value = (np.asarray(one) for one in measured)
    for i in range(len(depth) - 1):
        if value[i] >= hardness > value[i + 1]:
            return float(depth[i] + (depth[i + 1] - depth[i]) * (value[i] - hardness) / (value[i] - value[i + 1]))
    return math.nan


def lang_hardness(depth: ArrayLike, surface: float, core: float, case_depth: float) -> Array:
    """Hardness over depth by Lang's curve [HV], with its depths so scaled that it has 550 HV at the case depth.

    Parameters
    ----------
    depth : array_like
        y [m].
    surface, core : float
        [HV].
    case_depth : float
        CHD at 550 HV [m].

    Raises
    ------
    RangeError
        Unless core < 550 HV < surface: no depth has 550 HV then.
    """
    for name, side, value in (("core hardness", -1.0, core), ("hardness", 1.0, surface)):
        if side * (value - AT_CASE_DEPTH) <= 0.0:
            rule = f"must be {'above' if side > 0.0 else 'below'} the {AT_CASE_DEPTH:g} HV of the case depth"
            raise RangeError(name, f"{value:.4g} HV", rule, "specify hardness_profile instead of case_depth")
    decades = math.log10((surface - core) / (AT_CASE_DEPTH - core))
    # c1 t + c2 t^2 = decades, stable for decades -> 0
    at_case = 2.0 * decades / (_LINEAR + math.sqrt(_LINEAR**2 + 4.0 * _SQUARE * decades))
    t = at_case * np.asarray(depth, dtype=float) / case_depth
    return np.asarray(core + (surface - core) * 10.0 ** -(t * (_LINEAR + _SQUARE * t)))


def lang_residual_stress(hardness: ArrayLike, core: float) -> Array:
    """Residual stress along the surface from the hardness above the core's, by Lang [Pa]; compression is negative."""
    above = np.maximum(np.asarray(hardness, dtype=float) - core, 0.0)
    return np.asarray(np.where(above <= _KNEE, -_SLOPE * above, _FLAT * above - _OFFSET))
