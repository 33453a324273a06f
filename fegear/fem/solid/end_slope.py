"""What a free end face adds to its mirror under a band that ends at it.

A half-space with a mirrored load has no shear on the plane of the mirror, but keeps the stress along the band there;
an end face is free of it, and stands at an angle to the flank. Under an even load the deflection beside it is larger
by end_slope times ln(a / distance) within about the pressed half-width a: a number that Poisson's ratio and the angle
between flank and face decide. It was found by solid teeth of two modules' width whose pressed bands narrow from .2 to
.1 module (tests/golden/make_end_slopes.py).
"""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Array

#: Acute ends are positive: base helix angle [deg], and the values there for each of Poisson's ratios.
_ANGLES = (-40.0, -32.0, -24.0, -16.0, -8.0, 0.0, 8.0, 16.0, 24.0, 32.0, 40.0)
_RATIOS = (0.0, 0.15, 0.3, 0.45)
_VALUES = (
    (-0.1686, -0.1450, -0.1241, -0.0990, -0.0613, 0.0000, 0.1006, 0.2637, 0.5262, 0.9499, 1.6474),
    (-0.1982, -0.1707, -0.1439, -0.1098, -0.0588, 0.0217, 0.1493, 0.3504, 0.6659, 1.1657, 1.9767),
    (-0.2148, -0.1795, -0.1424, -0.0948, -0.0260, 0.0779, 0.2362, 0.4776, 0.8474, 1.4227, 2.3445),
    (-0.2162, -0.1693, -0.1177, -0.0522, 0.0386, 0.1696, 0.3615, 0.6453, 1.0703, 1.7202, 2.7487),
)


@lru_cache(maxsize=256)
def end_slope(angle: float, poisson_ratio: float) -> float:
    """The number at an end face whose angle to the flank is 90 degrees less `angle` [rad], E = 1.

    Times 1 / cos(beta_b) it is the transverse approach per transverse force and length. Angles beyond 40 degrees take
    the value there; Poisson's ratios are interpolated by a cubic.
    """
    step, ratios = _ANGLES[1] - _ANGLES[0], np.array(_RATIOS)
    place = (float(np.clip(np.degrees(angle), _ANGLES[0], _ANGLES[-1])) - _ANGLES[0]) / step
    i = min(int(place), len(_ANGLES) - 2)
    known, bent, x = np.array(_VALUES), _second_derivatives(), place - i
    y = 1.0 - x
    values = y * known[:, i] + x * known[:, i + 1] + ((y**3 - y) * bent[:, i] + (x**3 - x) * bent[:, i + 1]) / 6.0
    return float(np.polynomial.polynomial.polyfit(ratios, values, 3) @ float(poisson_ratio) ** np.arange(4))


@cache
def _second_derivatives() -> Array:
    """Of the cubic spline over the angles, in steps of these, shape (ratios, angles); its ends have no knot.

    By hand: the library's spline takes longer to load than all else of a recalled pair.
    """
    count = len(_ANGLES)
    system, right = 4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1), np.zeros((count, len(_RATIOS)))
    right[1:-1] = 6.0 * np.diff(np.array(_VALUES).T, 2, axis=0)
    system[0, :3], system[-1, -3:] = (1.0, -2.0, 1.0), (1.0, -2.0, 1.0)
    return np.asarray(np.linalg.solve(system, right).T)
