"""Dolan and Broghamer's stress concentration factor of gear-tooth fillets.

Source: T. J. Dolan and E. L. Broghamer, A Photoelastic Study of Stresses in Gear Tooth Fillets, University of Illinois
Engineering Experiment Station Bulletin 335 (1942): K = 0.22 + (t/r)^0.20 (t/h)^0.40 for 14.5 degrees and
K = 0.18 + (t/r)^0.15 (t/h)^0.45 for 20 degrees, t the thickness of the weakest (Lewis) section, r the smallest fillet
radius, h the height of the load above the section; the nominal stress subtracts the radial compression.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.formulas.outcome import RootStress, RootStressSource
from fegear.formulas.root_section import lewis_section, sharpest_fillet_radius
from fegear.geometry.external_tooth import Tooth

#: Pressure angle [deg]: constant, exponent of t/r, exponent of t/h.
CONSTANTS = {14.5: (0.22, 0.20, 0.40), 20.0: (0.18, 0.15, 0.45)}


def concentration_factor(
    thickness: ArrayLike, fillet_radius: ArrayLike, load_height: ArrayLike, pressure_angle: float
) -> Array:
    """Combined stress concentration factor K of the nominal bending-minus-compression stress.

    Parameters
    ----------
    thickness, fillet_radius, load_height : array_like
        t, r, h; one unit of length.
    pressure_angle : float
        [rad]; 14.5 or 20 deg, the two that were tested.

    Raises
    ------
    RangeError
        For other pressure angles or lengths that are not positive.
    """
    t, r, h = (np.asarray(v, dtype=float) for v in (thickness, fillet_radius, load_height))
    for name, value in (("thickness", t), ("fillet radius", r), ("load height", h)):
        if not np.all(value > 0.0):
            raise RangeError(name, f"{np.min(value):.6g}", "must be positive")
    degrees = math.degrees(pressure_angle)
    for tested, (c, p, q) in CONSTANTS.items():
        if abs(degrees - tested) < 1e-6:
            return np.asarray(c + (t / r) ** p * (t / h) ** q)
    raise RangeError(
        "pressure angle",
        f"{degrees:.6g} deg",
        "was not tested by Dolan and Broghamer (14.5 and 20 deg)",
        "use AGMA 908 (interpolated constants)",
    )


def tooth_root_stress(tooth: Tooth, radius: float) -> RootStress:
    """Dolan and Broghamer's root stress of a generated tooth under a load at `radius` [modules]."""
    p, load = lewis_section(tooth, radius)
    phi, h = float(load.angle[0]), float(load.apex[0]) - p.height
    r = sharpest_fillet_radius(tooth)
    factor = float(concentration_factor(p.thickness, r, h, tooth.rack.pressure_angle))
    nominal = math.cos(phi) * (6.0 * h / p.thickness**2 - math.tan(phi) / p.thickness)
    return RootStress(factor * nominal, p.half_thickness, p.height, r, p.tangent_angle)


SOURCE = RootStressSource(
    "dolan-broghamer",
    tooth_root_stress,
    "Dolan and Broghamer, Univ. of Illinois Bulletin 335 (1942)",
    "Lewis section with the smallest fillet radius; radial compression subtracted",
)
