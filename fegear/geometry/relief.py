"""Profile modifications as exact functions of the roll angle: tip and root relief, crowning, tables.

The removal is measured along the normal of the involute, which is the line of action, in metres; positive removes
material. The roll angle of a flank point is its roll length over the base radius, tan(alpha) at its radius.

The profile chart (K-chart) of a relieved flank: few points, and straight lines between them that stay close.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.base.tally import note
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair, Member

Shape = Literal["linear", "parabolic"]


Interpolation = Literal["linear", "cubic"]


class Relief(Protocol):
    """Removal of material along a flank."""

    @property
    def kinks(self) -> tuple[float, ...]:
        """Roll angles [rad] where the removal or its slope jumps."""

    def removal(self, roll: ArrayLike) -> Array:
        """Material removed along the normal [m] at roll angles [rad]."""


@dataclass(frozen=True, slots=True)
class EndRelief:
    """Tip or root relief: nothing up to `start`, `amount` at `end`, growing with the given power of the roll angle.

    With end > start it is a tip relief, with end < start a root relief; the curve goes on beyond `end`. `power` is 1
    for linear, 2 for parabolic relief.
    """

    amount: float = shown("um", "amount at the end of the relief")
    start: float = shown("deg", "roll angle at which the relief starts", name="start_roll_angle")
    end: float = shown("deg", "roll angle at which the relief ends", name="end_roll_angle")
    power: float = 1.0

    def __post_init__(self) -> None:
        """Refuse reliefs without length."""
        if not (math.isfinite(self.amount) and math.isfinite(self.start) and math.isfinite(self.end)):
            raise InputError("relief", f"amount {self.amount}, from {self.start} to {self.end}", "must be finite")
        if abs(self.end - self.start) < 1e-12:
            raise InputError("relief.start", self.start, "coincides with the end of the relief", "specify a length")
        if not self.power >= 1.0:
            raise InputError("relief.shape", self.power, "must be a power of at least 1", "1 is linear, 2 parabolic")

    @property
    def kinks(self) -> tuple[float, ...]:
        """The start."""
        return (self.start,)

    def removal(self, roll: ArrayLike) -> Array:
        """amount ((roll - start)/(end - start))^power beyond the start."""
        s = (np.asarray(roll, dtype=float) - self.start) / (self.end - self.start)
        return np.asarray(self.amount * np.maximum(s, 0.0) ** self.power)


@dataclass(frozen=True, slots=True)
class Crowning:
    """Profile crowning: a parabola in the roll angle, zero in the middle and `amount` at both ends.

    Parameters
    ----------
    amount : float
        [m].
    start, end : float
        Roll angles of the ends [rad].
    """

    amount: float
    start: float
    end: float

    @property
    def kinks(self) -> tuple[float, ...]:
        """None."""
        return ()

    def removal(self, roll: ArrayLike) -> Array:
        """Amount times the square of the distance from the middle over half the length."""
        middle, half = 0.5 * (self.start + self.end), 0.5 * (self.end - self.start)
        return np.asarray(self.amount * ((np.asarray(roll, dtype=float) - middle) / half) ** 2)


@dataclass(frozen=True)
class TabulatedRelief:
    """A modification given point by point; beyond its ends it stays as it is there.

    Parameters
    ----------
    roll : ndarray, shape (N,)
        Ascending roll angles [rad].
    values : ndarray, shape (N,)
        Removal [m].
    interpolation : {"linear", "cubic"}
        Straight pieces, or the shape-preserving cubic of Fritsch and Carlson (no overshoot between the entries).
    """

    roll: Array
    values: Array
    interpolation: Interpolation = "linear"

    def __post_init__(self) -> None:
        """Refuse tables that are no function."""
        roll, values = np.array(self.roll, dtype=float), np.array(self.values, dtype=float)
        if roll.ndim != 1 or roll.shape != values.shape or roll.size < 2:
            raise InputError("relief.table", f"{roll.size} entries", "must have two or more roll angles and removals")
        if not (np.isfinite(roll).all() and np.isfinite(values).all()):
            raise InputError("relief.table", "an entry", "must be finite")
        if (np.diff(roll) <= 0.0).any():
            raise InputError("relief.table", "roll angles", "must be strictly increasing")
        if self.interpolation not in ("linear", "cubic"):
            raise InputError("relief.interpolation", f'"{self.interpolation}"', 'must be "linear" or "cubic"')
        roll.setflags(write=False)
        values.setflags(write=False)
        object.__setattr__(self, "roll", roll)
        object.__setattr__(self, "values", values)

    @property
    def kinks(self) -> tuple[float, ...]:
        """The entries, at which the slope (linear) or the curvature (cubic) jumps."""
        return tuple(float(t) for t in self.roll)

    def removal(self, roll: ArrayLike) -> Array:
        """Interpolate; hold the first and the last entry beyond them."""
        at = np.clip(np.asarray(roll, dtype=float), self.roll[0], self.roll[-1])
        if self.interpolation == "cubic" and self.roll.size > 2:
            from scipy.interpolate import PchipInterpolator

            return np.asarray(PchipInterpolator(self.roll, self.values)(at))
        return np.interp(at, self.roll, self.values)


@dataclass(frozen=True, slots=True)
class CombinedRelief:
    """The sum of several modifications of one flank; the empty sum leaves the involute as it is."""

    parts: tuple[Relief, ...] = ()

    @property
    def kinks(self) -> tuple[float, ...]:
        """Those of all parts."""
        return tuple(sorted({k for part in self.parts for k in part.kinks}))

    def removal(self, roll: ArrayLike) -> Array:
        """Add the parts."""
        note("reliefs", len(self.parts))
        total = np.zeros(np.shape(roll))
        for part in self.parts:
            total = total + part.removal(roll)
        return total


#: The involute as generated.
UNMODIFIED = CombinedRelief()


def roll_of_radius(gear: Gear, radius: ArrayLike) -> Array:
    """Roll angle [rad] of the flank point at `radius` [m]."""
    return gear.tooth.roll(np.asarray(radius, dtype=float) / gear.module)


def roll_in_drawing(gear: Gear, roll: ArrayLike) -> Array:
    """Roll angle or length as drawings, grinders and inspection sheets have it: positive on an internal gear, too."""
    return np.asarray(gear.tooth.side * np.asarray(roll, dtype=float))


def roll_as_given(gear: Gear, roll: ArrayLike) -> Array:
    """Roll angle or length as equations have it: negative on an internal gear, where it is given with either sign."""
    given = np.asarray(roll, dtype=float)
    return -np.abs(given) if gear.tooth.internal else given


def tip_relief(
    gear: Gear,
    amount: float,
    *,
    start_roll: float | None = None,
    start_radius: float | None = None,
    length: float | None = None,
    shape: Shape = "linear",
    at_radius: float | None = None,
) -> EndRelief:
    """Tip relief of a gear; exactly one of the three ways to say where it starts.

    Parameters
    ----------
    gear : Gear
    amount : float
        Removal at `at_radius` [m].
    start_roll : float, optional
        Roll angle where the relief starts [rad]; of an internal gear with either sign.
    start_radius : float, optional
        Radius where it starts [m].
    length : float, optional
        Length of the relief along the line of action [m], from `at_radius` inward.
    shape : {"linear", "parabolic"}
    at_radius : float, optional
        Where the amount is measured [m], by default the end of the involute.

    Raises
    ------
    InputError
        If the start is given twice or not at all, or lies off the flank.
    """
    end = _roll(gear, gear.involute_tip_radius if at_radius is None else at_radius, "tip.at_radius")
    start = _start(gear, end, -1.0, start_roll, start_radius, length, "tip")
    if not start < end:
        raise InputError("relief.start", f"roll angle {start:.6g} rad", f"must be below the tip, {end:.6g} rad")
    return EndRelief(amount, start, end, _power(shape))


def root_relief(
    gear: Gear,
    amount: float,
    *,
    end_radius: float,
    start_roll: float | None = None,
    start_radius: float | None = None,
    length: float | None = None,
    shape: Shape = "linear",
) -> EndRelief:
    """Root relief of a gear, as `tip_relief`; `end_radius` [m] is the inner end where the amount is measured."""
    end = _roll(gear, end_radius, "root.end_radius")
    start = _start(gear, end, 1.0, start_roll, start_radius, length, "root")
    if not start > end:
        raise InputError("relief.start", f"roll angle {start:.6g} rad", f"must be above its end at {end:.6g} rad")
    return EndRelief(amount, start, end, _power(shape))


def _power(shape: Shape) -> float:
    if shape not in ("linear", "parabolic"):
        raise InputError("relief.shape", f'"{shape}"', 'must be "linear" or "parabolic"')
    return 1.0 if shape == "linear" else 2.0


def _start(
    gear: Gear,
    end: float,
    sign: float,
    start_roll: float | None,
    start_radius: float | None,
    length: float | None,
    where: str,
) -> float:
    given = [value for value in (start_roll, start_radius, length) if value is not None]
    if len(given) != 1:
        raise InputError(
            f"relief.{where}", "its start", "must be given exactly once", "as roll angle, as radius or as length"
        )
    if start_roll is not None:
        return float(roll_as_given(gear, start_roll))
    if start_radius is not None:
        return _roll(gear, start_radius, f"{where}.start_radius")
    return end + sign * given[0] / gear.base_radius


def _roll(gear: Gear, radius: float, key: str) -> float:
    """Roll angle of a radius that was given [rad]."""
    if radius < gear.base_radius:
        rule = f"lies inside the base circle of {gear.base_radius * 1e3:.6g} mm, where there is no involute"
        raise InputError(f"relief.{key}", f"{radius * 1e3:.6g} mm", rule)
    return float(roll_of_radius(gear, radius))


def crowning(gear: Gear, amount: float, start_radius: float, end_radius: float) -> Crowning:
    """Profile crowning between two radii [m], that toward the root first."""
    a, b = _roll(gear, start_radius, "crowning.start_radius"), _roll(gear, end_radius, "crowning.end_radius")
    if not b > a:
        raise InputError("relief.crowning", f"{start_radius:.6g} to {end_radius:.6g} m", "must have a length")
    return Crowning(amount, a, b)


def normalised_tip_relief(
    pair: GearPair, member: Member, amount: float, normalised_length: float, shape: Shape = "linear"
) -> EndRelief:
    """Tip relief of `Lin, Townsend, Oswald`: L_n = 1 runs from the tip to the HPSTC in roll angle (TM-89901, Fig. 2).

    Parameters
    ----------
    pair : GearPair
        Its contact ratio lies between 1 and 2.
    member : {"driver", "driven"}
    amount : float
        At the tip [m]; Delta in the source is the combined tooth deflection at the HPSTC plus twice the largest
        spacing error (Welbourn).
    normalised_length : float
        L_n, positive.
    """
    if not normalised_length > 0.0:
        raise InputError("relief.length", normalised_length, "must be positive", "remove the relief instead")
    if not 1.0 <= pair.contact_ratio < 2.0:
        raise InputError(
            "relief.length",
            normalised_length,
            f"refers to the length from tip to HPSTC, which does not exist for contact ratio {pair.contact_ratio:.4f}",
            "specify the start as a roll angle or radius",
        )
    gear = pair.gear(member)
    highest = pair.x_hpstc if member == "driver" else pair.x_lpstc
    end = float(roll_of_radius(gear, gear.involute_tip_radius))
    hpstc = float(pair.roll_angle(highest, member))
    return EndRelief(amount, end - normalised_length * (end - hpstc), end, _power(shape))


def modified_flank(gear: Gear, relief: Relief, roll: ArrayLike) -> Array:
    """Points of the modified right flank [m], shape (2, N): the involute less the removal along its normal."""
    involute = gear.tooth.involute
    t = np.asarray(roll, dtype=float)
    return np.asarray(involute.points(t) * gear.module - involute.normals(t) * relief.removal(t))


#: Even places among which points are sought, and those between two kinks.
_PLACES, _BETWEEN = 2001, 401


def chart_points(relief: Relief, low: float, high: float, within: float, keep: Sequence[float] = ()) -> Array:
    """Roll angles of the points of a profile chart.

    Parameters
    ----------
    relief : Relief
    low, high : float
        Ends of the profile [rad]: the first and the last point.
    within : float
        How far the relief may lie from the straight lines between the points [m].
    keep : sequence of float
        Roll angles that are points in any case [rad], where they lie between the ends.

    Returns
    -------
    ndarray, shape (N,)
        [rad], rising.

    Notes
    -----
    Where a line misses the relief by more than `within`, a point is put to where it misses it most (Ramer, Douglas and
    Peucker), kinks of the relief among the places that are tried.
    """
    inside = [float(one) for one in (*relief.kinks, *keep) if low < one < high]
    corners = sorted({low, *inside, high})
    between = [np.linspace(*ends, _BETWEEN) for ends in pairwise(corners)]
    roll = np.unique(np.concatenate([np.linspace(low, high, _PLACES), *between]))
    removal = relief.removal(roll)
    fixed = np.searchsorted(roll, [low, high, *(one for one in keep if low < one < high)])
    points = sorted({int(one) for one in fixed})
    waiting = list(pairwise(points))
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        part = slice(first, last + 1)
        line = np.interp(roll[part], roll[[first, last]], removal[[first, last]])
        worst = first + int(np.argmax(np.abs(removal[part] - line)))
        if abs(removal[worst] - line[worst - first]) > within:
            points.append(worst)
            waiting += [(first, worst), (worst, last)]
    return np.asarray(roll[sorted(points)])
