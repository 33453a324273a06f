"""Where an undercut flank begins: the trochoid of a rounded rack tip meets the involute, of one spur gear or of many.

Angles are counted from the end of the rounding, where the trochoid touches the involute's other branch: at the angle e
before it the cut point lies q beside the foot of the normal from the gear's centre, which is p away,

    p / r = cos(alpha + e),     q / r = (D (k - S - S') + s S cos(alpha)) / S',     D = S' - S,

S and S' the sines of alpha and alpha + e, k = rho / r, s the roll angle by which the rack cuts past the base circle.
The angle by which the point lies outside the involute is then, with A(x) = x - atan(x) and t its roll angle,

    A(q / p) + A(t) - (e - sin e) - (2 sin^2(e / 2) (k - S - S') + s S sin e) / cos(alpha + e),

of terms of the third order in s, e being of the second: angles of order one, subtracted, lose all digits of a slight
undercut.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array

#: Roll angle up to which an undercut is as slight as in the limit [rad].
_SLIGHT = 1e-10
#: Up to which angle [rad] differences of the third order are series, and how many terms they have.
_SERIES, _TERMS = 0.25, 15
_STEPS = 200


def undercut_meeting(slight: ArrayLike, rounding: ArrayLike, pressure_angle: float) -> tuple[Array, Array]:
    """Angle e [rad] before the end of the rounding and roll angle [rad] where trochoid and involute meet, shape (N,).

    Parameters
    ----------
    slight : array_like, shape (N,)
        s, minus the roll angle at which the straight flank ends on the line of action [rad], positive.
    rounding : array_like, shape (N,)
        rho over the pitch radius.
    pressure_angle : float
        alpha [rad].

    Notes
    -----
    Where the trochoid comes out nowhere on the flank, its own end: e = 0 and t = s. In the limit of a slight undercut
    t = x s with 2 x^3 + 3 x^2 = 1: half of it.
    """
    s, k = np.broadcast_arrays(np.asarray(slight, dtype=float), np.asarray(rounding, dtype=float))
    sine, cosine = np.sin(pressure_angle), np.cos(pressure_angle)

    def beside(e: Array) -> tuple[Array, Array, Array]:
        """q / r, square of the point's roll length over r, and k - S - S'."""
        now = np.sin(pressure_angle + e)
        grown = 2.0 * np.sin(0.5 * e) * np.cos(pressure_angle + 0.5 * e)
        left = k - sine - now
        q = (grown * left + s * sine * cosine) / now
        return q, q * q - grown * (sine + now), left

    def outside(e: Array) -> Array:
        q, squared, left = beside(e)
        turn = np.cos(pressure_angle + e)
        roll = np.sqrt(np.maximum(squared, 0.0)) / cosine
        with np.errstate(divide="ignore"):  # a right angle at the rounding's lowest point
            second = (2.0 * np.sin(0.5 * e) ** 2 * left + s * sine * np.sin(e)) / turn
        return np.asarray(_less_atan(q / turn) + _less_atan(roll) - _less_sine(e) - second)

    # Below the base circle there is no involute to meet: the radius falls with e.
    whole = np.full(s.shape, 0.5 * np.pi - pressure_angle)
    end = np.where(beside(whole)[1] < 0.0, _between(lambda e: beside(e)[1], whole), whole)
    meets = outside(end) < 0.0
    at = np.where(meets, _between(outside, end), 0.0)
    roll = np.sqrt(np.maximum(beside(at)[1], 0.0)) / cosine
    return np.where(s < _SLIGHT, 0.0, at), np.where(s < _SLIGHT, 0.5 * s, roll)


def _between(function: Callable[[Array], Array], end: Array) -> Array:
    """Where functions that are positive at 0 turn negative before an end, to round-off: false position.

    The value at the end that lags behind is halved, and now and then the middle is taken in logarithms: the place may
    be many orders of magnitude nearer to 0 than the end.
    """
    low, high = np.full(end.shape, 1e-30), end.copy()
    f_low, f_high, last = function(low), function(high), np.zeros(end.shape)
    for step in range(_STEPS):
        with np.errstate(invalid="ignore", divide="ignore"):
            middle = low + f_low / (f_low - f_high) * (high - low)
        far = (high > 4.0 * low) | (step % 8 == 7)
        middle = np.clip(middle, low + 1e-16 * high, high - 1e-16 * high)
        middle = np.where(far, np.sqrt(low * high), middle)
        f = function(middle)
        above = f >= 0.0
        f_high = np.where(above & (last > 0.0), 0.5 * f_high, f_high)
        f_low = np.where(~above & (last < 0.0), 0.5 * f_low, f_low)
        low, f_low = np.where(above, middle, low), np.where(above, f, f_low)
        high, f_high = np.where(above, high, middle), np.where(above, f_high, f)
        last = np.where(above, 1.0, -1.0)
        if ((high - low <= 4e-16 * high) | (f == 0.0)).all():
            break
    return np.asarray(np.where(np.abs(f_low) < np.abs(f_high), low, high))


def _less_atan(x: Array) -> Array:
    """x - atan(x) without cancellation."""
    square = np.minimum(np.abs(x), _SERIES) ** 2
    series = np.zeros(np.shape(x))
    for n in range(_TERMS, 0, -1):
        series = (1.0 / (2 * n + 1) - series) * square
    return np.asarray(np.where(np.abs(x) < _SERIES, x * series, x - np.arctan(x)))


def _less_sine(x: Array) -> Array:
    """x - sin(x) without cancellation."""
    square = np.minimum(np.abs(x), _SERIES) ** 2
    series = np.zeros(np.shape(x))
    for n in range(_TERMS, 0, -1):
        series = (1.0 - series) * square / ((2 * n) * (2 * n + 1))
    return np.asarray(np.where(np.abs(x) < _SERIES, x * series, x - np.sin(x)))
