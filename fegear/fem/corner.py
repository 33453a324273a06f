"""What a corner of the outline does to a contact near it: the exact wedge, and how its angle follows from the tooth."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.geometry.tooth import Tooth


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


def corner_angles(tooth: Tooth) -> tuple[float, float]:
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
