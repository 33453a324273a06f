"""Sainsot's foundation: the deflection of a gear body, an elastic ring, under one tooth.

Source: P. Sainsot, P. Velex and O. Duverger, Contribution of Gear Body to Tooth Deflections - A New Bidimensional
Analytical Formula, ASME J. Mech. Design 126 (2004) 748-752, Eqs. 14 and 15, Table 1:

    delta_f = (w cos^2 a / E) { L (u/S)^2 + M (u/S) + P (1 + Q tan^2 a) }

with u from the root circle's section to the line of action on the centre line, S the root thickness (arc), and
L, M, P, Q polynomials of h = r_f / r_bore and theta_f, half the tooth's angle on the root circle. The fit was made
with Young's modulus E alone; it is used here as printed, without a plane-strain factor.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array

#: Table 1: rows L, M, P, Q; columns A to F of A/theta^2 + B h^2 + C h/theta + D/theta + E h + F.
TABLE_1 = np.array(
    [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ]
)
#: Where the fit was made: h = r_f / r_bore and theta_f [rad].
RANGE_H, RANGE_THETA = (1.4, 7.0), (0.01, 0.12)


def coefficients(radius_ratio: float, root_half_angle: float) -> tuple[float, float, float, float]:
    """L*, M*, P*, Q* (Eq. 15).

    Parameters
    ----------
    radius_ratio : float
        h = r_f / r_bore, 1.4 to 7.
    root_half_angle : float
        theta_f [rad], 0.01 to 0.12.

    Raises
    ------
    RangeError
        Outside the range of the fit.
    """
    h, theta = radius_ratio, root_half_angle
    if not RANGE_H[0] <= h <= RANGE_H[1]:
        raise RangeError(
            "root radius / bore radius",
            f"{h:.4g}",
            f"must lie between {RANGE_H[0]} and {RANGE_H[1]}, where Sainsot's polynomials were fitted",
            "use the finite elements for thin rims and solid bodies",
        )
    if not RANGE_THETA[0] <= theta <= RANGE_THETA[1]:
        raise RangeError(
            "half tooth angle at the root",
            f"{theta:.4g} rad",
            f"must lie between {RANGE_THETA[0]} and {RANGE_THETA[1]} rad, where Sainsot's polynomials were fitted",
            "use another compliance source for gears with few teeth",
        )
    big_l, m, p, q = (float(v) for v in TABLE_1 @ np.array([1.0 / theta**2, h * h, h / theta, 1.0 / theta, h, 1.0]))
    return big_l, m, p, q


def foundation_compliance(
    slenderness: ArrayLike, load_angle: ArrayLike, radius_ratio: float, root_half_angle: float
) -> Array:
    """E x deflection per unit line load of the gear body (Eq. 14), dimensionless.

    Parameters
    ----------
    slenderness : array_like
        u_f / S_f.
    load_angle : array_like
        a [rad].
    radius_ratio, root_half_angle : float
        h and theta_f, see `coefficients`.
    """
    big_l, m, p, q = coefficients(radius_ratio, root_half_angle)
    s, a = np.asarray(slenderness, dtype=float), np.asarray(load_angle, dtype=float)
    return np.asarray(np.cos(a) ** 2 * (big_l * s * s + m * s + p * (1.0 + q * np.tan(a) ** 2)))
