"""Measured profile and helix traces by ISO 1328-1:2013: filter, mean line, slope, form and total deviation, crown.

Source: ISO 1328-1:2013, profile and helix deviations, as recalled: Gaussian low-pass filter (ISO 16610-21) with half
its effect at a wavelength of a thirtieth of the evaluation length, at least .025 mm; mean lines by least squares over
the evaluation range; that of a profile from the control diameter over 95 % of the way to the tip, that of a helix
without 5 % of the face, at most a module, at either end.

Deviations are positive where there is more material than the design has.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.formulas.iso1328 import CLASSES, FlankTolerances, tolerances_of
from fegear.geometry.gear import Gear

#: Evaluation length over cut-off wavelength, and the shortest cut-off [m].
_LENGTH_OVER_CUTOFF, _SHORTEST_CUTOFF = 30.0, 25e-6
#: Shares of the active profile and of the face, at most so many modules, that are evaluated or left out.
_PROFILE_SHARE, _FACE_SHARE, _FACE_MODULES = 0.95, 0.05, 1.0
#: Width of the Gaussian weight over the cut-off wavelength, at which it lets half through.
_ALPHA = math.sqrt(math.log(2.0) / math.pi)
#: Weights beyond so many cut-offs are below 1e-13; places that are filtered at once.
_REACH, _AT_ONCE = 1.5, 512


@dataclass(frozen=True, slots=True)
class TraceDeviations:
    """Deviations of one trace over its evaluation range [m].

    Parameters
    ----------
    slope : float
        f_H: rise of the mean line from end to end.
    form : float
        f_f: range of what is left of the trace without its mean line.
    total : float
        F: range of the trace.
    crown : float
        Height of the middle of the mean parabola over its ends.
    """

    slope: float
    form: float
    total: float
    crown: float

    def within(self, tolerances: FlankTolerances, kind: Literal["profile", "helix"]) -> bool:
        """Whether slope, form and total lie inside tolerances."""
        found = abs(self.slope), self.form, self.total
        return all(
            value <= getattr(tolerances, f"{kind}_{name}") * (1.0 + 1e-9)
            for value, name in zip(found, ("slope", "form", "total"), strict=True)
        )


def cutoff(length: float) -> float:
    """Wavelength of which the filter lets half through [m], by the evaluation length [m]."""
    return max(length / _LENGTH_OVER_CUTOFF, _SHORTEST_CUTOFF)


def profile_range(start: float, tip: float) -> tuple[float, float]:
    """Evaluation range of a profile, in lengths of roll from the control diameter to the tip [m]."""
    return start, start + _PROFILE_SHARE * (tip - start)


def helix_range(face_width: float, module: float) -> tuple[float, float]:
    """Evaluation range of a helix, in heights from the middle of the face [m]."""
    left = 0.5 * face_width - min(_FACE_SHARE * face_width, _FACE_MODULES * module)
    return -left, left


def filtered(x: Array, deviation: Array, wavelength: float) -> Array:
    """A trace without its short waves.

    Parameters
    ----------
    x, deviation : ndarray, shape (N,)
        Places, ascending, and deviations [m].
    wavelength : float
        Of which half is let through [m].

    Notes
    -----
    At every place a line is fitted with Gaussian weights, so that a straight trace stays as it is up to its ends;
    inside a trace of even spacing that is the Gaussian filter itself.
    """
    weights, found = _widths(x), np.empty_like(deviation)
    first = np.searchsorted(x, x - _REACH * wavelength)
    last = np.searchsorted(x, x + _REACH * wavelength, side="right")
    for begin in range(0, x.size, _AT_ONCE):
        rows = slice(begin, min(begin + _AT_ONCE, x.size))
        near = slice(first[rows][0], last[rows][-1])
        away = x[near][None, :] - x[rows][:, None]
        w = weights[near] * np.exp(-math.pi * (away / (_ALPHA * wavelength)) ** 2)
        s0, s1, s2 = w.sum(axis=1), (w * away).sum(axis=1), (w * away**2).sum(axis=1)
        y0, y1 = w @ deviation[near], (w * away) @ deviation[near]
        spread = s0 * s2 - s1**2
        alone = spread <= 1e-12 * s0 * s2  # no other place is near
        found[rows] = np.where(alone, y0 / s0, (s2 * y0 - s1 * y1) / np.where(alone, 1.0, spread))
    return found


def _widths(x: Array) -> Array:
    """How much of the length every place stands for."""
    return np.asarray(np.gradient(x)) if x.size > 2 else np.ones(x.size)


def evaluate(x: Array, deviation: Array, start: float, end: float) -> TraceDeviations:
    """Deviations of a filtered trace over its evaluation range [m].

    Raises
    ------
    InputError
        If fewer than five places lie in it.
    """
    inside = (x > start) & (x < end)
    if inside.sum() < 5 or x[0] > start + 1e-9 or x[-1] < end - 1e-9:
        raise InputError(
            "evaluation range", f"{start * 1e3:.6g} to {end * 1e3:.6g} mm",
            f"is not covered by at least five points of the trace, {x[0] * 1e3:.6g} to {x[-1] * 1e3:.6g} mm",
            "extend the measurement, or specify another range",
        )  # fmt: skip
    at = np.concatenate([[start], x[inside], [end]])
    y = np.interp(at, x, deviation)
    s = (2.0 * at - start - end) / (end - start)
    weights = np.zeros_like(s)  # of the trapezoidal rule
    weights[:-1] += 0.5 * np.diff(s)
    weights[1:] += 0.5 * np.diff(s)
    root = np.sqrt(weights)
    line, *_ = np.linalg.lstsq(root[:, None] * np.vander(s, 2), root * y)
    parabola, *_ = np.linalg.lstsq(root[:, None] * np.vander(s, 3), root * y)
    left = y - np.polyval(line, s)
    return TraceDeviations(float(2.0 * line[0]), float(np.ptp(left)), float(np.ptp(y)), float(-parabola[0]))


def tightest_class(found: TraceDeviations, gear: Gear, kind: Literal["profile", "helix"]) -> int | None:
    """The tightest class of ISO 1328-1:2013 whose tolerances hold a trace; None beyond class 11."""
    return next((one for one in CLASSES if found.within(tolerances_of(gear, one).rounded, kind)), None)
