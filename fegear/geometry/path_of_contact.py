"""What happens along the path of contact: its points A to E, the diameters that it uses, sliding (ISO 21771, 5.4)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.geometry.pair import GearPair, Member


class PathPoint(NamedTuple):
    """A point on the path of contact: its letter and its place x [m]."""

    letter: str
    x: float


class ActiveProfile(NamedTuple):
    """Radii of one gear between which the mate touches it [m].

    Attributes
    ----------
    start, end : float
        Of the active profile, r_Nf and r_Na.
    lowest_single, highest_single : float
        Lowest and highest point of single tooth contact; NaN unless the contact ratio lies between 1 and 2.
    """

    start: float
    lowest_single: float
    highest_single: float
    end: float


def path_points(pair: GearPair) -> tuple[PathPoint, ...]:
    """Points of the path in the order in which a tooth pair passes them.

    A and E are the first and the last contact and C is the pitch point, where the path holds it. The number of tooth
    pairs in contact changes at B, one base pitch before E, and at D, one base pitch after A. With a contact ratio of
    two or more there are several of each: B_{2} lies two base pitches before E.
    """
    start, end, pitch = pair.x_start, pair.x_end, pair.base_pitch
    count = math.floor(pair.contact_ratio)
    found = [PathPoint("A", start), PathPoint("E", end)]
    if start < 0.0 < end:
        found.append(PathPoint("C", 0.0))
    for k in range(1, count + 1):
        which = "" if count == 1 else f"_{{{k}}}"
        found += [PathPoint(f"B{which}", end - k * pitch), PathPoint(f"D{which}", start + k * pitch)]
    return tuple(sorted(found, key=lambda point: point.x))


def active_profile(pair: GearPair, member: Member) -> ActiveProfile:
    """Where the mate touches a gear, and where it does so alone."""
    inner, outer = (pair.x_start, pair.x_end) if member == "driver" else (pair.x_end, pair.x_start)
    pitch = math.copysign(pair.base_pitch, outer - inner)
    alone = 1.0 <= pair.contact_ratio < 2.0
    low, high = (outer - pitch, inner + pitch) if alone else (math.nan, math.nan)
    return ActiveProfile(*(float(pair.radius(x, member)) for x in (inner, low, high, outer)))


def specific_sliding(pair: GearPair, x: ArrayLike, member: Member) -> Array:
    """Specific sliding zeta of a gear's flank: its sliding velocity over its own rolling velocity.

    With the radii of curvature, zeta_1 = 1 - rho_2 / (u rho_1) and zeta_2 = 1 - u rho_1 / rho_2, u negative in an
    internal pair. Negative below the pitch point of either flank, zero at it, and minus infinity on the base circle.

    Parameters
    ----------
    pair : GearPair
    x : array_like
        Place on the path of contact [m].
    member : {"driver", "driven"}

    Returns
    -------
    ndarray
    """
    mate: Member = "driven" if member == "driver" else "driver"
    ratio = pair.side * pair.gear(member).teeth / pair.gear(mate).teeth
    own, other = pair.flank_curvature_radius(x, member), pair.flank_curvature_radius(x, mate)
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 - ratio * np.asarray(other) / np.asarray(own))
