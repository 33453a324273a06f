"""Quintic B-splines through curves: what drawings and solid models are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.geometry.curves import Drawn

DEGREE = 5
_FEWEST, _MOST = 9, 4096


class Spline(NamedTuple):
    """Knots (M + 6,) and control points (M, dimension) of a quintic B-spline."""

    knots: Array
    control: Array


def fitted(points: Callable[[Array], Array], start: float, end: float, tolerance: float) -> Spline:
    """The quintic through points (dimension, N) of a curve, at as many places as keep it within `tolerance` between.

    Parameters
    ----------
    points : callable
        Of an ascending or descending parameter.
    start, end : float
        Of the parameter; the spline runs the same way.
    tolerance : float
        In the unit of the points.
    """
    from scipy.interpolate import make_interp_spline

    count, sign = _FEWEST, 1.0 if end > start else -1.0
    while True:
        u = np.linspace(start, end, count)
        spline = make_interp_spline(sign * u, points(u).T, k=DEGREE)
        between = 0.5 * (u[1:] + u[:-1])
        if np.abs(spline(sign * between).T - points(between)).max() <= tolerance or count > _MOST:
            return Spline(np.asarray(spline.t), np.asarray(spline.c))
        count = 2 * count - 1


def spline_of(curve: Drawn, tolerance: float) -> Spline:
    """The spline through a piece of an outline, within `tolerance` [modules] of it."""
    return fitted(curve.points, curve.start, curve.end, tolerance)


def enclosed_area(splines: Iterable[Spline]) -> float:
    """Area between the origin and curves in the plane that run clockwise about it, exactly: half the integral of x dy.

    Parameters
    ----------
    splines : iterable of Spline
        Of two dimensions.
    """
    from scipy.interpolate import BSpline

    nodes, weights = np.polynomial.legendre.leggauss(DEGREE)  # exact to degree 9, that of x y'
    total = 0.0
    for knots, control in splines:
        spline, marks = BSpline(knots, control, DEGREE), np.unique(knots)
        half = 0.5 * np.diff(marks)[:, None]
        u = 0.5 * (marks[1:] + marks[:-1])[:, None] + half * nodes
        (x, y), (dx, dy) = np.moveaxis(spline(u), -1, 0), np.moveaxis(spline(u, 1), -1, 0)
        total += 0.5 * float(((y * dx - x * dy) * weights * half).sum())
    return total
