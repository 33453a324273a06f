"""Which contact half-widths a flank can hold.

How deflections go with them: the half-plane's logarithm, the surface's curvature, and what a corner of the outline
does to a contact near it: the exact wedge, and how its angle follows from the tooth.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.geometry.gear import Plane
from fegear.geometry.tooth_side import ToothSide

#: A contact's usual half-width [modules], at which what depends on it is reported.
REFERENCE_HALF_WIDTH = 0.02


#: Half-width of a load that is as good as concentrated [modules].
POINT = 1e-4


#: Wider contacts than this [modules] are refused: the flank is too short to hold them.
LARGEST_HALF_WIDTH = 0.5


#: A contact that reaches past an end of the flank by no more than this [modules] is reported; by more it is refused.
FARTHEST_PAST_END = 0.1


def log_slope(poisson_ratio: float, plane: Plane) -> float:
    """Change of a body's approach with the logarithm of the contact's half-width, per unit line load, E = 1.

    Two semi-elliptic pressures of the same load on a half-plane differ at their centre by exactly
    2 (1 - nu^2) / (pi E) ln(a / b) (plane strain; without the nu in plane stress); Johnson, Contact Mechanics, 4.2.
    """
    return 2.0 * (1.0 - poisson_ratio**2 if plane == "strain" else 1.0) / np.pi


def curvature_slope(poisson_ratio: float, plane: Plane) -> float:
    """How the deflection near a line load on a surface of curvature 1/rho departs from the half-plane's, E = 1.

    At a distance s it is larger by curvature_slope * s / rho, or smaller on a hollow surface, whose rho is negative.
    The exact disc under pressure of n waves round its rim deflects (1/(n - 1) + (3 - 4 nu)/(n + 1)) (1 + nu)/2 (from
    Michell's stress function; Barber, Elasticity, table 9.1). Its 1/n is the half-plane's logarithm; its 1/n^2, which
    vanishes with 1 - 2 nu, is this.
    """
    nu = poisson_ratio
    return 0.5 * (1.0 - 2.0 * nu) * (1.0 + nu) if plane == "strain" else 0.5 * (1.0 - nu)


def check_half_widths(
    half_width: ArrayLike, room: ArrayLike, *, unit: str = "modules", scale: float = 1.0, key: str = "half_width"
) -> None:
    """Refuse contacts that no flank holds.

    Parameters
    ----------
    half_width : array_like
        [modules].
    room : array_like
        Length of the flank from the contact's centre to the nearer end [modules], broadcast against `half_width`.
    unit, scale, key : str, float, str
        Unit of the refusal, modules times `scale`, and what it is about.

    Raises
    ------
    RangeError
        If a half-width is not positive, exceeds half a module, or reaches past the flank's end by more than a tenth
        of one.
    """
    b, room = np.broadcast_arrays(np.asarray(half_width, dtype=float), np.asarray(room, dtype=float))
    wrong = ~(np.isfinite(b) & (b > 0.0))
    if wrong.any():
        raise RangeError(key, f"{b[wrong][0] * scale:.6g} {unit}", "must be positive and finite")
    usual = f"{REFERENCE_HALF_WIDTH * scale:.6g} {unit} is usual"
    wide = b > LARGEST_HALF_WIDTH * (1.0 + 1e-9)
    if wide.any():
        raise RangeError(
            key,
            f"{b[wide][0] * scale:.6g} {unit}",
            f"exceeds half a module, {LARGEST_HALF_WIDTH * scale:.6g} {unit}",
            usual,
        )
    past = b > np.maximum(room, 0.0) + FARTHEST_PAST_END * (1.0 + 1e-9)
    if past.any():
        raise RangeError(
            key,
            f"{b[past][0] * scale:.6g} {unit}",
            f"extends more than a tenth of a module beyond the end of the flank ({room[past][0] * scale:.6g} {unit} "
            "from the contact centre)",
            usual + ", or choose radii farther from the ends of the flank",
        )


def flank_holds(half_width: Array, room: Array) -> NDArray[np.bool_]:
    """Whether `check_half_widths` takes each contact [modules]."""
    most = np.minimum(LARGEST_HALF_WIDTH, np.maximum(room, 0.0) + FARTHEST_PAST_END)
    return np.asarray((half_width > 0.0) & (half_width <= most))


def wedge_slope(angle: float) -> float:
    """How fast a load on one face of a wedge sinks as it nears the apex, per unit line load and plane compliance.

    The load's own place moves against the far body by wedge_slope * ln(far / near): beyond a few times the load's
    distance from the apex the stress is the one under a force at the apex itself (Michell; Timoshenko and Goodier,
    Theory of Elasticity, art. 38), whose radial displacement along the bisector and across it goes with
    2 ln r / (angle + sin angle) and 2 ln r / (angle - sin angle). The half-plane (pi) gives 2/pi.

    Parameters
    ----------
    angle : float
        Angle between the faces, inside the material [rad].

    Returns
    -------
    float
        Times (1 - nu^2)/E in plane strain, 1/E in plane stress.
    """
    along, across = math.sin(0.5 * angle) ** 2, math.cos(0.5 * angle) ** 2
    return 2.0 * (along / (angle + math.sin(angle)) + across / (angle - math.sin(angle)))


def corner_angles(tooth: ToothSide) -> tuple[float, float]:
    """Angles inside the material where the flank starts and where it ends [rad]; pi where the outline goes on smoothly.

    A tip rounding counts as the corner that it rounds off.
    """
    pieces = tooth.outline
    flank = tooth.involute
    start, end = (flank.normals(np.array([at]))[:, 0] for at in (flank.start, flank.end))
    below = tooth.fillet.normals(np.array([tooth.fillet.end]))[:, 0]
    above = pieces["tip_land"] if tooth.tip_rounding > 0.0 or "tip_edge" not in pieces else pieces["tip_edge"]
    beyond = above.normals(np.array([above.start]))[:, 0]
    return _inside(below, start) if tooth.undercut else math.pi, _inside(end, beyond)


def _inside(before: np.ndarray, after: np.ndarray) -> float:
    return math.pi - math.acos(float(np.clip(before @ after, -1.0, 1.0)))
