"""Smooth splines through points in the plane, or beside them within their scatter; directions at the ends are kept."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.fillet_curves import DEGREE

#: Points from which on a spline is quintic: of fewer, cubics swing less between them.
_QUINTIC_FROM = 10
#: How often a curve is drawn again over the length along itself, so that its speed is near one.
_ROUNDS = 2
#: Directions at the ends of a curve, None where it ends as it comes.
Ends = tuple[Array | None, Array | None]


class Fitted(NamedTuple):
    """Knots, control points and degree of a B-spline in the plane."""

    knots: tuple[float, ...]
    control: tuple[tuple[float, float], ...]
    degree: int

    @property
    def end_directions(self) -> tuple[Array, Array]:
        """Of its first and its last leg, along which it starts and ends."""
        c = np.array(self.control)
        return c[1] - c[0], c[-1] - c[-2]


def _fitted(spline_knots: Array, control: Array, degree: int) -> Fitted:
    return Fitted(tuple(spline_knots.tolist()), tuple((float(x), float(y)) for x, y in control), degree)


def _along(points: Array) -> Array:
    """Lengths along the chords [modules]."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points)))])


def interpolated(points: Array, ends: Ends) -> Fitted:
    """The spline through points, shape (2, N), over the length along them.

    Parameters
    ----------
    points : ndarray
    ends : pair of ndarray or None
        Directions.
    """
    degree = DEGREE if points.shape[1] >= _QUINTIC_FROM else 3
    at = _along(points)
    made = _through(points, at, ends, degree)
    for _ in range(_ROUNDS):
        at = _lengths(made, at)
        made = _through(points, at, ends, degree)
    return made


def _through(points: Array, at: Array, ends: Ends, degree: int) -> Fitted:
    """The spline through points at places of its parameter."""
    from scipy.interpolate import make_interp_spline

    first, last = (None if end is None else end / np.hypot(*end) for end in ends)
    sites = np.concatenate([[at[0]] * (first is not None), at, [at[-1]] * (last is not None)])
    half = (degree + 1) // 2
    knots = np.concatenate([[at[0]] * (degree + 1), sites[half:-half], [at[-1]] * (degree + 1)])
    conditions = tuple(None if end is None else [(1, end)] for end in (first, last))
    spline = make_interp_spline(at, points.T, k=degree, t=knots, bc_type=conditions)
    return _fitted(np.asarray(spline.t), np.asarray(spline.c), degree)


def _lengths(fitted: Fitted, at: Array) -> Array:
    """Arc lengths of a spline up to places of its parameter."""
    from scipy.interpolate import BSpline

    nodes, weights = np.polynomial.legendre.leggauss(5)
    half = 0.5 * np.diff(at)[:, None]
    u = 0.5 * (at[1:] + at[:-1])[:, None] + half * nodes
    spline = BSpline(np.array(fitted.knots), np.array(fitted.control), fitted.degree)
    speed = np.hypot(*np.moveaxis(np.asarray(spline(u, 1)), -1, 0))
    return np.concatenate([[0.0], np.cumsum((speed * weights * half).sum(axis=1))])


def smoothed(points: Array, ends: Ends, scatter: float) -> Fitted:
    """The spline of the fewest even pieces that passes within `scatter` beside every point, ends kept.

    Parameters
    ----------
    points : ndarray, shape (2, N)
    ends : pair of ndarray or None
        Directions.
    scatter : float
        [modules].
    """
    from scipy.interpolate import BSpline

    at, count = _along(points), points.shape[1]
    degree = min(DEGREE, count - 1)
    for pieces in range(1, max(count - degree, 2)):
        knots = np.concatenate([[0.0] * degree, np.linspace(0.0, at[-1], pieces + 1), [at[-1]] * degree])
        basis = BSpline.design_matrix(np.clip(at, 0.0, np.nextafter(at[-1], 0.0)), knots, degree).toarray()
        control = _least_squares(basis, points, ends)
        beside = _beside(basis @ control - points.T, points)
        if beside.max() <= scatter:
            return _fitted(knots, control, degree)
    raise GeometryError(
        "fillet.scatter", f"{scatter:.3g} modules", "is smaller than the scatter of the points",
        "increase it, or remove it for a curve through all points",
    )  # fmt: skip


def _least_squares(basis: Array, points: Array, ends: Ends) -> Array:
    """Control points, shape (M, 2), that miss the points least; ends are kept, and directions there."""
    size = basis.shape[1]
    rows, right = [], []

    def fix(index: int, axis: int, value: float) -> None:
        row = np.zeros(2 * size)
        row[axis * size + index] = 1.0
        rows.append(row)
        right.append(value)

    for index, column in ((0, 0), (size - 1, -1)):
        for axis in (0, 1):
            fix(index, axis, float(points[axis, column]))
    for index, other, end in ((0, 1, ends[0]), (size - 1, size - 2, ends[1])):
        if end is not None:
            row = np.zeros(2 * size)
            for axis, part in ((0, -end[1]), (1, end[0])):
                row[axis * size + other] += part
                row[axis * size + index] -= part
            rows.append(row)
            right.append(0.0)
    held, normal = np.array(rows), np.kron(np.eye(2), basis.T @ basis)
    n = len(rows)
    whole = np.block([[normal, held.T], [held, np.zeros((n, n))]])
    asked = np.concatenate([basis.T @ points[0], basis.T @ points[1], right])
    found = np.linalg.lstsq(whole, asked, rcond=None)[0][: 2 * size]
    return np.asarray(found.reshape(2, size).T)


def _beside(off: Array, points: Array) -> Array:
    """How far places off the points lie beside the line through them, (N,) [modules]."""
    step = np.gradient(points, axis=1)
    along = step / np.hypot(*step)
    return np.abs(off[:, 0] * along[1] - off[:, 1] * along[0])
