"""Stiffness c' of one tooth pair as a short series fitted to finite elements of whole gears; the fit is fegear's own.

Per unit face width, in contact at the pitch point, of steel spur gears cut by rack A of ISO 53 (20 degrees), bodies
fixed at half their root radius, 300 N/mm along the line of action. Unlike c' of ISO 6336-1, it contains the deflection
of the bodies and no correction by measurements. Made by `benchmarks/million_pairs_study.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array

#: Of `terms` [mm um/N].
COEFFICIENTS = (
    0.0827611, 0.012022, 0.00399279, -0.328894, -0.292205, -0.353421, 8.8718, 1.02286, -56.8614, 0.0022007,
)  # fmt: skip
#: Relative error on pairs that it was not fitted to: root of the mean square, 95 %, largest.
ERROR = (0.0067, 0.0132, 0.0449)
#: Ranges of z and x of the pairs.
TEETH, SHIFT = (12.0, 400.0), (-0.5, 0.7)


def terms(z_1: ArrayLike, z_2: ArrayLike, x_1: ArrayLike, x_2: ArrayLike) -> Array:
    """Terms of the series, shape (10, ...); both gears count alike.

    Besides 1/z and x they contain t = z_i (x_1 + x_2)/(z_1 + z_2) - x_i, the height at which the pitch point lies on
    the tooth [modules].
    """
    z = np.array(np.broadcast_arrays(z_1, z_2), dtype=float)
    x = np.array(np.broadcast_arrays(x_1, x_2), dtype=float)
    u, t = 1.0 / z, z * (x.sum(axis=0) / z.sum(axis=0)) - x
    each = [t * t, x * x * t, u, x * u, x * t * u, u * u, t * u * u, u**3]
    sums = [one.sum(axis=0) for one in each]
    return np.array([np.ones(sums[0].shape), *sums, np.log(u.sum(axis=0))])


def single_stiffness(z_1: float, z_2: float, x_1: float = 0.0, x_2: float = 0.0) -> float:
    """c' of one tooth pair at the pitch point [Pa]; 1e9 Pa is 1 N/(mm um).

    Parameters
    ----------
    z_1, z_2 : float
        Numbers of teeth, 12 to 400.
    x_1, x_2 : float
        Profile shift coefficients, -0.5 to 0.7.

    Raises
    ------
    RangeError
        Outside the range of the fit.
    """
    for name, value, (low, high) in (
        ("z_1", z_1, TEETH), ("z_2", z_2, TEETH), ("x_1", x_1, SHIFT), ("x_2", x_2, SHIFT),
    ):  # fmt: skip
        if not low <= value <= high:
            raise RangeError(name, f"{value:.6g}", f"is outside the range of the fit, {low:g} to {high:g}")
    return float(1e9 / (np.array(COEFFICIENTS) @ terms(z_1, z_2, x_1, x_2)))
