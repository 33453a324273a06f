"""Lines of contact of an aligned helical pair, and their total length over a cycle (NASA TM-107451, Appendix 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.unloaded.pair import HelicalPair, Misalignment


@dataclass(frozen=True, slots=True)
class LineContact(ReadOnlyArrays):
    """Points of lines of contact and their parameters on both flanks; all arrays have one shape.

    Angles theta are constant along a line; lengths u are infinite for a spur gear, whose line never meets its base
    helix; t = u cos(lambda_b).
    """

    phi_1: Array = shown("deg", "pinion angle of this tooth pair: the first parameter", name="phi1")
    phi_2: Array = shown("deg", "gear angle", name="phi2")
    z: Array = shown("mm", "axial position, on both gears")
    theta_1: Array = shown(
        "deg", "angular position on the pinion base cylinder where the line is tangent to it", name="theta1"
    )
    theta_2: Array = shown(
        "deg", "angular position on the gear base cylinder where the line is tangent to it", name="theta2"
    )
    t_1: Array = shown("mm", "base tangent length of the pinion")
    t_2: Array = shown("mm", "base tangent length of the gear")
    u_1: Array = shown("mm", "distance along the line from the pinion base helix (second parameter)", name="u1")
    u_2: Array = shown("mm", "distance along the line from the gear base helix", name="u2")
    r_1: Array = shown("mm", "radius on the pinion", name="r1")
    r_2: Array = shown("mm", "radius on the gear", name="r2")


@dataclass(frozen=True, slots=True)
class LineLength(ReadOnlyArrays):
    """Total length of all lines of contact at a time, arrays of shape (n,) over a pitch; the rest is exact."""

    phi_1: Array = shown("deg", "pinion angle", name="phi1", table="cycle")
    total: Array = shown("mm", "total length of all lines of contact", name="length", table="cycle")
    lines: NDArray[np.int_] = shown("", "tooth pairs in contact", name="pairs", table="cycle")
    least: float = shown("mm", "minimum over a mesh cycle", name="contact_line_least")
    mean: float = shown("mm", "mean total length of the contact lines", name="contact_line_mean")
    largest: float = shown("mm", "maximum over a mesh cycle", name="contact_line_largest")


def aligned(pair: HelicalPair) -> HelicalPair:
    """The pair with parallel axes and flanks as designed; an error of its centre distance stays, for lines remain."""
    return pair.with_errors(Misalignment(centre_distance=pair.errors.centre_distance)).with_modification(parabola=0.0)


def line_contact(pair: HelicalPair, phi_1: ArrayLike, z: ArrayLike) -> LineContact:
    """Point at a height of the line of contact at a pinion angle, beyond the ends of the flanks too (A.3.6 to A.3.9).

    The paper's second parameter is u_1; the height serves spur gears as well.

    Parameters
    ----------
    pair : HelicalPair
        Aligned and not modified.
    phi_1, z : array_like
        Broadcast against each other [rad], [m].

    Raises
    ------
    InputError
        If the pair is misaligned or modified, so that its flanks do not touch along lines.
    """
    if not pair.errors.aligned or pair.parabola != 0.0 or pair.crown != 0.0:
        raise InputError(
            "pair", "(misaligned or modified)", "has no lines of contact (point or edge contact)",
            "use the aligned pair without modification",
        )  # fmt: skip
    phi, z = np.broadcast_arrays(np.asarray(phi_1, dtype=float), np.asarray(z, dtype=float))
    a, b, alpha = pair.pinion, pair.gear, pair.working_pressure_angle
    theta_1 = alpha + phi - a.half_base_space_angle
    theta_2 = (pair.ratio + 1.0) * math.tan(alpha) - pair.ratio * theta_1
    t_1, t_2 = a.base_radius * (theta_1 + a.twist * z), b.base_radius * (theta_2 + b.twist * z)
    sine = math.sin(a.base_helix_angle)  # cos(lambda_b), the same for both gears
    with np.errstate(divide="ignore"):
        u_1, u_2 = t_1 / sine if sine else t_1 / np.zeros(()), t_2 / sine if sine else t_2 / np.zeros(())
    return LineContact(
        phi, b.half_base_tooth_angle - theta_2 + alpha, z, theta_1, theta_2, t_1, t_2, u_1, u_2,
        np.hypot(a.base_radius, t_1), np.hypot(b.base_radius, t_2),
    )  # fmt: skip


def line_ends(pair: HelicalPair, phi_1: ArrayLike) -> Array:
    """Heights (2, n) [m] between which the line of one tooth pair lies on both flanks; equal where there is none."""
    phi = np.atleast_1d(np.asarray(phi_1, dtype=float))
    low, high = pair.overlap
    at_zero = line_contact(pair, phi, 0.0).t_1
    rise = pair.pinion.base_radius * pair.pinion.twist
    if rise == 0.0:
        inside = (at_zero >= pair.path_start) & (at_zero <= pair.path_end)
        return np.stack([np.full(phi.shape, low), np.where(inside, high, low)])
    ends = (np.array([[pair.path_start], [pair.path_end]]) - at_zero) / rise
    return np.clip(np.sort(ends, axis=0), low, high)


def contact_lines(pair: HelicalPair, lines: int = 13, points: int = 9) -> LineContact:
    """Lines of contact of one tooth pair over its engagement, evenly spaced by pinion angle.

    Parameters
    ----------
    pair : HelicalPair
    lines, points : int
        How many lines, and points on each from end to end.

    Returns
    -------
    LineContact
        Arrays of shape (lines, points).
    """
    lo, hi = pair.engagement
    phi = lo + (np.arange(lines) + 0.5) / lines * (hi - lo)  # at the ends of engagement a line is a point
    ends = line_ends(pair, phi)
    return line_contact(pair, phi[:, None], ends[0][:, None] + np.linspace(0.0, 1.0, points) * np.diff(ends, axis=0).T)


def line_length(pair: HelicalPair, positions: int = 400) -> LineLength:
    """Total length of the lines of contact over a cycle, with its exact extremes and mean.

    Between the angles at which a line begins or ends to pass a corner of the flank the length is linear.

    Parameters
    ----------
    pair : HelicalPair
        Aligned and not modified.
    positions : int
        Pinion angles of the curve.
    """
    pitch, lo = pair.pinion.angular_pitch, pair.engagement[0]
    corners = [pair.pinion_angle(t, z) for t in (pair.path_start, pair.path_end) for z in pair.overlap]
    cuts = np.unique(np.concatenate([[0.0, pitch], np.mod(np.array(corners) - lo, pitch)]))
    cuts = cuts[np.concatenate([[True], np.diff(cuts) > 1e-12 * pitch])]
    widths = np.diff(cuts)
    early, late = (_total(pair, lo + cuts[:-1] + share * widths)[0] for share in (0.25, 0.75))
    ends = np.concatenate([1.5 * early - 0.5 * late, 1.5 * late - 0.5 * early])  # limits from inside each piece
    phi = lo + pitch * np.arange(positions) / positions
    total, lines = _total(pair, phi)
    mean = float((0.5 * (early + late)) @ widths / widths.sum())
    return LineLength(phi, total, lines, max(float(ends.min()), 0.0), mean, float(ends.max()))


def _total(pair: HelicalPair, phi_1: Array) -> tuple[Array, NDArray[np.int_]]:
    """Length of all lines [m], and how many there are."""
    pitch, (lo, hi) = pair.pinion.angular_pitch, pair.engagement
    numbers = np.arange(-1, math.ceil((hi - lo) / pitch) + 2)
    own = (phi_1 - pitch * np.floor((phi_1 - lo) / pitch))[None, :] + numbers[:, None] * pitch
    ends = line_ends(pair, own.ravel())
    length = (ends[1] - ends[0]).reshape(own.shape) / math.cos(pair.pinion.base_helix_angle)
    return length.sum(axis=0), np.count_nonzero(length > 0.0, axis=0)
