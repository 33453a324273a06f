"""Mean friction coefficients of gear teeth from load, speed, curvature, oil and roughness.

Sources: L. Schlenk, Untersuchungen zur Fresstragfähigkeit von Großzahnrädern, thesis, TU München 1994, as ISO/TR
14179-2:2001 carries it; ISO/TR 13989-1:2000, Eqs. 25 to 28 (now ISO/TS 6336-20); ISO/TR 13989-2:2000, Eqs. 1 to 7 (now
ISO/TS 6336-21); ISO/TR 15144-1:2014, Formulae 86 and 87 (now ISO/TS 6336-22). All are of one form,

    mu = c (w / (v_Sigma rho))^0.2 eta^-0.05 X_L X_R,  w in N/mm, v in m/s, rho in mm, eta in mPa s, R_a in um,

and known here from secondary sources. Of X_R in Eq. 28 these carry the square root and the fourth root of R_a; the
square root is taken, which a printed report of another program has.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.formulas.lubricant import Oil

MeanLaw = Literal["schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22"]
MEAN_LAWS: tuple[MeanLaw, ...] = ("schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22")

#: Parts -20 and -21 take no higher pitch line speed [m/s], and -21 no smaller load [N/m].
FASTEST, LEAST_LOAD = 50.0, 150e3
#: No law is held to hold beyond this coefficient: dry steel.
LARGEST = 0.5


@dataclass(frozen=True)
class Surface:
    """What a friction law asks of oil and flanks.

    Parameters
    ----------
    oil : Oil
    temperature : float
        Of the oil [degC].
    roughness : float
        R_a, arithmetic mean of both flanks [m].
    """

    oil: Oil
    temperature: float
    roughness: float

    def __post_init__(self) -> None:
        """Refuse flanks without roughness, for which the formulas give no friction at all."""
        if not self.roughness > 0.0:
            raise RangeError("roughness", f"{self.roughness:.4g} m", "must be positive")

    @property
    def thickness(self) -> float:
        """eta_oil^-0.05 with the dynamic viscosity in mPa s."""
        return float(self.oil.dynamic(self.temperature) * 1e3) ** -0.05


def helical_load_factor(total_contact_ratio: float) -> float:
    """K_Bgamma by the total contact ratio: 1 up to 2, 1.3 from 3.5 on (ISO/TR 13989-2, Eq. 5)."""
    if total_contact_ratio <= 2.0:
        return 1.0
    if total_contact_ratio >= 3.5:
        return 1.3
    return 1.0 + 0.2 * float(np.sqrt((total_contact_ratio - 2.0) * (5.0 - total_contact_ratio)))


def mean_friction(law: MeanLaw, surface: Surface, line_load: ArrayLike, rolling: ArrayLike, radius: ArrayLike) -> Array:
    """Friction coefficient by one of the mean laws; with local arguments it is taken at every point.

    Parameters
    ----------
    law : {"schlenk", "iso-6336-20", "iso-6336-21", "iso-6336-22"}
    surface : Surface
    line_load : array_like
        Load per face width with all the factors that the law asks for [N/m]: F_bt / b for Schlenk and -22,
        w_Bt = K_A K_v K_Bbeta K_Balpha F_t / b for -20 and the same times K_Bgamma for -21 and -22; none, no friction.
    rolling : array_like
        v_Sigma, sum of both flanks' tangential speeds [m/s].
    radius : array_like
        rho_n, relative radius of curvature in the normal section [m]; of the transverse section for -20.

    Returns
    -------
    ndarray
        At most 0.5, that of dry steel: where radius or speed go to zero the laws have no bound.
    """
    tiny = np.finfo(float).tiny
    w = np.maximum(np.asarray(line_load, dtype=float), 0.0) * 1e-3
    if law == "iso-6336-21":
        w = np.where(w > 0.0, np.maximum(w, LEAST_LOAD * 1e-3), 0.0)
    v, rho = np.asarray(rolling, dtype=float), np.asarray(radius, dtype=float) * 1e3
    ra = surface.roughness * 1e6
    x_l: Array = np.asarray(surface.oil.factor)
    if law == "schlenk":
        factor, x_r = 0.048, np.asarray(ra**0.25)
        if surface.oil.kind in ("polyglycol", "water-soluble-polyglycol"):
            x_l = 0.75 * (6.0 / np.maximum(v, tiny)) ** 0.2
    elif law == "iso-6336-20":
        factor, x_r = 0.060, np.asarray(ra**0.5)
    else:
        factor, x_r = 0.045, 2.2 * (ra / np.maximum(rho, tiny)) ** 0.25
    with np.errstate(over="ignore", divide="ignore"):
        mu = factor * (w / np.maximum(v * rho, tiny)) ** 0.2 * surface.thickness * x_l * x_r
    return np.asarray(np.minimum(np.where(w > 0.0, mu, 0.0), LARGEST))
