"""What an oil is like at a temperature: viscosity, density, pressure-viscosity coefficient, and its factor X_L.

Sources: ASTM D341-93 (Walther's viscosity law); ISO/TR 15144-1:2014 (now ISO/TS 6336-22), Formulae 8 to 11 and 16 to 21
(pressure-viscosity coefficient by kind of oil, density); ISO/TR 13989-1:2000 (now ISO/TS 6336-20), Eq. 27 (X_L). The
ISO formulas are taken from secondary sources, open calculation programs that name the clauses.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.given import given

OilKind = Literal[
    "mineral", "polyalphaolefin", "polyglycol", "water-soluble-polyglycol", "traction-fluid", "phosphate-ester"
]

#: X_L of friction and scuffing by base oil; times viscosity in mPa s to the power -0.05 in ISO/TS 6336-20.
OIL_FACTOR: dict[OilKind, float] = {
    "mineral": 1.0,
    "polyalphaolefin": 0.8,
    "polyglycol": 0.7,
    "water-soluble-polyglycol": 0.6,
    "traction-fluid": 1.5,
    "phosphate-ester": 1.3,
}
#: alpha_38 = first times eta_38^second, eta in Pa s (Formulae 9 to 11); the others count as mineral oils.
_PRESSURE_VISCOSITY: dict[str, tuple[float, float]] = {
    "mineral": (2.657e-8, 0.1348),
    "polyalphaolefin": (1.466e-8, 0.0507),
    "polyglycol": (1.392e-8, 0.1572),
    "water-soluble-polyglycol": (1.392e-8, 0.1572),
}
#: Walther's law is written with this summand from 2 mm^2/s on.
_SUMMAND = 0.7
#: Temperatures at which viscosities are given [degC], and absolute zero as the Walther law and ISO take it.
_WARM, _HOT, _ZERO, _ISO_ZERO = 40.0, 100.0, 273.15, 273.0
#: Thinner than this the law does not hold [mm^2/s].
_THINNEST = 0.2
#: Hotter than this there is no oil [degC], and ISO's straight lines would make its density and alpha negative.
HOTTEST = 350.0


@dataclass(frozen=True)
class Oil:
    """An oil.

    Without a viscosity at 100 degC (NaN) it has that of a mineral oil of viscosity index 95.

    Raises
    ------
    RangeError
        If a viscosity is below 2 mm^2/s, or the oil does not thin as it warms.
    """

    viscosity_40: float = given(
        "kinematic_viscosity", "Kinematic viscosity at 40 degC (ISO viscosity grade).", above=0.0
    )
    viscosity_100: float = given("kinematic_viscosity", "Kinematic viscosity at 100 degC.", default=math.nan, above=0.0)
    density_15: float = given("density", "Density at 15 degC.", default=895.0, above=0.0)
    kind: OilKind = given(meaning="Base oil.", default="mineral")

    def __post_init__(self) -> None:
        """Fill in the viscosity of the hot oil and refuse what is no oil."""
        if math.isnan(self.viscosity_100):
            object.__setattr__(self, "viscosity_100", viscosity_of_index_95(self.viscosity_40))
        for key in ("viscosity_40", "viscosity_100"):
            if not getattr(self, key) >= 2e-6 * (1.0 - 1e-12):
                raise RangeError(key, f"{getattr(self, key) * 1e6:.4g} mm^2/s", "must be at least 2 mm^2/s")
        if not self.viscosity_100 < self.viscosity_40:
            raise RangeError("viscosity_100", f"{self.viscosity_100 * 1e6:.4g} mm^2/s", "must be below viscosity_40")

    @property
    def factor(self) -> float:
        """X_L of the base oil, without viscosity."""
        return OIL_FACTOR[self.kind]

    def kinematic(self, temperature: ArrayLike) -> Array:
        """Kinematic viscosity [m^2/s] at temperatures [degC]: log log (nu + 0.7) is straight over log T."""
        warm, hot = (
            math.log10(math.log10(nu * 1e6 + _SUMMAND)) for nu in (self.viscosity_40, self.viscosity_100)
        )  # fmt: skip
        first, last = math.log10(_WARM + _ZERO), math.log10(_HOT + _ZERO)
        slope = (warm - hot) / (last - first)
        kelvin = np.maximum(_of_oil(temperature) + _ZERO, 1.0)
        nu = 10.0 ** (10.0 ** (warm + slope * (first - np.log10(kelvin)))) - _SUMMAND
        return np.asarray(np.maximum(nu, _THINNEST) * 1e-6)

    def density(self, temperature: ArrayLike) -> Array:
        """Density [kg/m^3] at temperatures [degC] (ISO/TR 15144-1, Formula 20): 0.7 kg/m^3 less for every degree."""
        return np.asarray(self.density_15 - 0.7 * (_of_oil(temperature) + _ISO_ZERO - 289.0))

    def dynamic(self, temperature: ArrayLike) -> Array:
        """Dynamic viscosity [Pa s] at temperatures [degC] (Formula 16)."""
        return np.asarray(self.kinematic(temperature) * self.density(temperature))

    def pressure_viscosity(self, temperature: ArrayLike) -> Array:
        """Pressure-viscosity coefficient alpha [1/Pa] at temperatures [degC] (Formulae 8 to 11)."""
        first, power = _PRESSURE_VISCOSITY.get(self.kind, _PRESSURE_VISCOSITY["mineral"])
        at_38 = first * float(self.dynamic(38.0)) ** power
        kelvin = _of_oil(temperature) + _ISO_ZERO
        return np.asarray(at_38 * (1.0 + 516.0 * (1.0 / kelvin - 1.0 / 311.0)))


def _of_oil(temperature: ArrayLike) -> Array:
    """Temperatures that an oil can have: hotter ones count as the hottest [degC]."""
    return np.minimum(np.asarray(temperature, dtype=float), HOTTEST)


#: A power through kinematic viscosities of mineral gear oils at 100 over those at 40 degC [mm^2/s].
_INDEX_95 = (0.571, 0.6483)


def viscosity_of_index_95(viscosity_40: float) -> float:
    """About the kinematic viscosity at 100 degC of a mineral oil of viscosity index 95 [m^2/s].

    A power through the usual grades: VG 32 has about 5.4, VG 100 11.2, VG 220 19, VG 460 30.5 mm^2/s at 100 degC.

    Parameters
    ----------
    viscosity_40 : float
        At 40 degC [m^2/s].
    """
    return _INDEX_95[0] * (viscosity_40 * 1e6) ** _INDEX_95[1] * 1e-6
