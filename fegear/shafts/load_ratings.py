"""Load ratings of radial bearings from what rolls in them: C_0 of ISO 76:2006 and C of ISO 281:2007.

Balls: C_0 = f_0 Z D_w^2 cos(alpha), C = b_m f_c cos(alpha)^0.7 Z^(2/3) D_w^1.8. Rollers: C_0 = 44 (1 - gamma) Z L D_w
cos(alpha), C = b_m f_c (L cos(alpha))^(7/9) Z^(3/4) D_w^(29/27), all in N and mm, with gamma = D_w cos(alpha)/D_pw. The
factors are tabulated over gamma; between the rows they are interpolated. Of spherical roller bearings, whose two rows
are one bearing, L counts twice. Every number of the tables, b_m and the limit
of 25.4 mm were checked against the text of GOST 18855-2013 (identical to ISO 281:2007) and of GOST 18854-2013 (ISO 76).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.shafts.rolling_bearing import RollingBearing

#: b_m of ISO 281 for deep groove and angular contact ball bearings, and for cylindrical and tapered roller bearings.
RATING_FACTOR = {"ball": 1.3, "roller": 1.1}
#: The same for spherical roller bearings.
_SPHERICAL = 1.15
#: f_0 of ISO 76 for gamma = 0, 0.01, ..., 0.4.
_F_0 = (
    14.7, 14.9, 15.1, 15.3, 15.5, 15.7, 15.9, 16.1, 16.3, 16.5, 16.4, 16.1, 15.9, 15.6, 15.4, 15.2, 14.9, 14.7, 14.4,
    14.2, 14.0, 13.7, 13.5, 13.2, 13.0, 12.8, 12.5, 12.3, 12.1, 11.8, 11.6, 11.4, 11.2, 10.9, 10.7, 10.5, 10.3, 10.0,
    9.8, 9.6, 9.4,
)  # fmt: skip
#: f_c of ISO 281 of balls for gamma = 0.01, 0.02, ..., 0.4.
_F_C_BALL = (
    29.1, 35.8, 40.3, 43.8, 46.7, 49.1, 51.1, 52.8, 54.3, 55.5, 56.6, 57.5, 58.2, 58.8, 59.3, 59.6, 59.8, 59.9, 60.0,
    59.9, 59.8, 59.6, 59.3, 59.0, 58.6, 58.2, 57.7, 57.1, 56.6, 56.0, 55.3, 54.6, 53.9, 53.2, 52.4, 51.7, 50.9, 50.0,
    49.2, 48.4,
)  # fmt: skip
#: f_c of ISO 281 of rollers for gamma = 0.01, 0.02, ..., 0.3.
_F_C_ROLLER = (
    52.1, 60.8, 66.5, 70.7, 74.1, 76.9, 79.2, 81.2, 82.8, 84.2, 85.4, 86.4, 87.1, 87.7, 88.2, 88.5, 88.7, 88.8, 88.8,
    88.7, 88.5, 88.2, 87.9, 87.5, 87.0, 86.4, 85.8, 85.2, 84.5, 83.8,
)  # fmt: skip
#: Diameter above which balls are rated by another power [mm].
_LARGE = 25.4


def _factor(table: tuple[float, ...], gamma: float, first: float) -> float:
    return float(np.interp(gamma, first + 0.01 * np.arange(len(table)), table))


def rating_factor(bearing: RollingBearing) -> float:
    """b_m of ISO 281 for a bearing."""
    return _SPHERICAL if bearing.aligning else RATING_FACTOR[bearing.kind]


def static_rating(bearing: RollingBearing) -> float:
    """C_0 of a bearing [N]."""
    d, cosine = bearing.element_diameter * 1e3, math.cos(bearing.contact_angle)
    gamma = d * cosine / (bearing.pitch_diameter * 1e3)
    if bearing.kind == "ball":
        return _factor(_F_0, gamma, 0.0) * bearing.count * d**2 * cosine
    return 44.0 * (1.0 - gamma) * bearing.rows * bearing.count * bearing.roller_length * 1e3 * d * cosine


def dynamic_rating(bearing: RollingBearing, factor: float | None = None) -> float:
    """C of a bearing [N].

    Parameters
    ----------
    bearing : RollingBearing
    factor : float, optional
        b_m; that of ISO 281 without it.
    """
    d, cosine = bearing.element_diameter * 1e3, math.cos(bearing.contact_angle)
    gamma = d * cosine / (bearing.pitch_diameter * 1e3)
    b_m = rating_factor(bearing) if factor is None else factor
    if bearing.kind == "ball":
        size = d**1.8 if d <= _LARGE else 3.647 * d**1.4
        return b_m * _factor(_F_C_BALL, gamma, 0.01) * cosine**0.7 * bearing.count ** (2.0 / 3.0) * size
    length = (bearing.rows * bearing.roller_length * 1e3 * cosine) ** (7.0 / 9.0)
    return b_m * _factor(_F_C_ROLLER, gamma, 0.01) * length * bearing.count**0.75 * d ** (29.0 / 27.0)
