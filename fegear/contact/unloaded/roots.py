"""Roots of many scalar functions at once that cannot escape their brackets."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.unloaded.extremes import Parameters

_EPS = 4.0 * np.finfo(float).eps

_LAST_STEP = 1e-8


def falling_root(
    function: Callable[..., tuple[Array, Array]], lo: Array, hi: Array, guess: Array, parameters: Parameters
) -> Array:
    """Where functions fall through zero: Newton's method inside a shrinking bracket, bisection where that stalls.

    Parameters
    ----------
    function : callable
        ``function(x, *parameters) -> value, slope``, elementwise on 1-D arrays.
    lo, hi : ndarray, shape (n,)
        Brackets. Where the function is negative at `lo` already, the answer is `lo`; where positive at `hi`, `hi`.
    guess : ndarray, shape (n,)
        Where to start; put into the bracket if outside.
    parameters : tuple of ndarray, each of shape (n,)
        Further arguments, one element per function.

    Returns
    -------
    ndarray, shape (n,)
        Always inside the bracket and accurate to a few units in the last place.
    """
    answer = np.clip(guess, lo, hi)
    which = np.flatnonzero(hi > lo)
    a, b, x = lo[which], hi[which], answer[which]
    scale = np.maximum(np.abs(a), np.abs(b))
    before, last = b - a, b - a
    tried_a, tried_b = np.zeros(which.size, dtype=bool), np.zeros(which.size, dtype=bool)
    parameters = tuple(p[which] for p in parameters)
    for _ in range(120):
        if which.size == 0:
            break
        value, slope = function(x, *parameters)
        a, b = np.where(value >= 0.0, x, a), np.where(value <= 0.0, x, b)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            newton = np.where(slope < 0.0, x - value / slope, np.where(value > 0.0, b, a))
        # A Newton step must stay in the bracket and at least halve the step before the last. A step past an end that
        # has not been tried goes there, because the sign at the end may already be the answer.
        past_a, past_b = (newton <= a) & ~tried_a, (newton >= b) & ~tried_b
        tried_a, tried_b = tried_a | past_a | (value > 0.0), tried_b | past_b | (value < 0.0)
        newton = np.clip(newton, a, b)
        new = np.where((np.abs(newton - x) <= 0.5 * before) | past_a | past_b, newton, 0.5 * (a + b))
        new = np.where(value == 0.0, x, new)
        # Newton's error after a step is of the order of the step squared, so a small step is the last one needed.
        close = (np.abs(new - x) <= _LAST_STEP * scale) & (new == newton)
        before, last, x = last, np.abs(new - x), new
        done = close | (value == 0.0) | (b - a <= _EPS * scale)
        answer[which] = np.where(
            x - lo[which] <= _EPS * scale, lo[which], np.where(hi[which] - x <= _EPS * scale, hi[which], x)
        )
        if done.any():
            keep = ~done
            which, a, b, x, scale = which[keep], a[keep], b[keep], x[keep], scale[keep]
            before, last, tried_a, tried_b = before[keep], last[keep], tried_a[keep], tried_b[keep]
            parameters = tuple(p[keep] for p in parameters)
    return answer


def falling_bracket(
    function: Callable[..., Array], lo: Array, hi: Array, parameters: Parameters, tolerance: Array, zero: float = 0.0
) -> tuple[Array, Array]:
    """Shrink brackets around the place where functions known by value only fall through zero (Chandrupatla).

    The functions may jump: the bracket then closes on the jump. Where a function has one sign throughout, both ends
    of the answer are the end that belongs to that sign.

    Parameters
    ----------
    function : callable
        ``function(x, *parameters) -> value``, elementwise on 1-D arrays; finite.
    lo, hi : ndarray, shape (n,)
        Brackets.
    parameters : tuple of ndarray, each of shape (n,)
        Further arguments.
    tolerance : ndarray, shape (n,)
        Width of the bracket that is small enough.
    zero : float
        Round-off of the function: a value no larger counts as zero, and the place as found.

    Returns
    -------
    lo, hi : ndarray, shape (n,)
        The function is positive at lo and not positive at hi.
    """
    f_lo, f_hi = function(lo, *parameters), function(hi, *parameters)
    out_lo, out_hi = np.where(f_hi > 0.0, hi, lo), np.where(f_lo <= 0.0, lo, hi)
    found = (np.abs(f_lo) <= zero) | (np.abs(f_hi) <= zero)
    nearer = np.where(np.abs(f_lo) <= np.abs(f_hi), lo, hi)
    out_lo, out_hi = np.where(found, nearer, out_lo), np.where(found, nearer, out_hi)
    which = np.flatnonzero((f_lo > 0.0) & (f_hi <= 0.0) & (hi - lo > tolerance) & ~found)
    # b is the newest point, a the other end of the bracket, c the point before (Chandrupatla 1997).
    a, fa, b, fb = lo[which], f_lo[which], hi[which], f_hi[which]
    tol = tolerance[which]
    parameters = tuple(p[which] for p in parameters)
    fraction = np.full(which.size, 0.5)
    for _ in range(200):
        if which.size == 0:
            break
        x = a + fraction * (b - a)
        fx = function(x, *parameters)
        same = (fx > 0.0) == (fa > 0.0)
        c, fc = np.where(same, a, b), np.where(same, fa, fb)
        b, fb = np.where(same, b, a), np.where(same, fb, fa)
        a, fa = x, fx
        here = np.abs(fa) <= zero
        out_lo[which], out_hi[which] = np.where((fa > 0.0) | here, a, b), np.where((fa > 0.0) & ~here, b, a)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            xi = (a - b) / (c - b)
            phi = (fa - fb) / (fc - fb)
            inverse = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        least = 0.5 * tol / np.maximum(np.abs(b - a), 1e-300)
        smooth = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi) & np.isfinite(inverse)
        fraction = np.clip(np.where(smooth, inverse, 0.5), np.minimum(least, 0.5), np.maximum(1.0 - least, 0.5))
        keep = ~here & (np.abs(b - a) > tol) & (np.spacing(np.abs(a)) < 0.5 * np.abs(b - a))
        if not keep.all():
            which = which[keep]
            a, fa, b, fb, tol, fraction = (v[keep] for v in (a, fa, b, fb, tol, fraction))
            parameters = tuple(p[keep] for p in parameters)
    return out_lo, out_hi
