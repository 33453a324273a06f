"""What every root-stress formula returns: the stress and where it sits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from fegear.geometry import Tooth


@dataclass(frozen=True, slots=True)
class RootStress:
    """Largest tensile stress in the fillet on the loaded side, and its place, for a tooth of module 1.

    Parameters
    ----------
    stress : float
        Stress x module / line load, dimensionless: multiply by w/m, with w [N/m] the load normal to the flank per unit
        face width and m [m] the module, to get Pa.
    half_thickness : float
        Distance of the place from the tooth's centre line [modules].
    height : float
        Its height above the gear's centre along the centre line [modules].
    fillet_radius : float
        The fillet radius that the formula used [modules].
    tangent_angle : float
        Angle between the fillet's tangent there and the tooth's centre line [rad].
    remark : str
        What the reader must know about this value; empty when nothing.
    """

    stress: float
    half_thickness: float
    height: float
    fillet_radius: float
    tangent_angle: float
    remark: str = ""

    @property
    def radius(self) -> float:
        """Distance of the place from the gear's centre [modules]."""
        return math.hypot(self.half_thickness, self.height)


class RootStressFormula(Protocol):
    """A root-stress formula applied to a generated tooth."""

    def __call__(self, tooth: Tooth, radius: float) -> RootStress:
        """Root stress under a load normal to the flank at `radius` [modules]; raises `RangeError` out of range."""


@dataclass(frozen=True, slots=True)
class RootStressSource:
    """A root-stress formula with what a comparison must say about it.

    Parameters
    ----------
    name : str
        As tables and pictures write it.
    formula : RootStressFormula
    citation : str
    compared : str
        Which section, which fillet radius, and whether the radial compression is subtracted.
    """

    name: str
    formula: RootStressFormula
    citation: str
    compared: str
