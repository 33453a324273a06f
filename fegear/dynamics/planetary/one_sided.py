"""Equilibrium of bodies on springs of which some only push: Newton on the energy, for many positions at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import ConvergenceError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array

#: Stiffness added to every coordinate within a step, as a share of the largest: a body that nothing holds in some
#: direction, as the sun between two opposite planets that both lift, stays where it is. The answer does not have it.
_HELD = 1e-10
#: What equilibrium may miss by, as a share of the loads.
_CLOSED = 1e-13
#: The same where round-off of stiff supports leaves no more.
_NEARLY = 1e-9
_STEPS = 60


def equilibrium(linear: Array, rows: Array, stiffness: Array, separation: Array, load: Array) -> Array:
    """Coordinates z with linear z + rows' stiffness max(rows z - separation, 0) = load.

    The energy is convex and of pieces of second order: Newton's steps, each followed to the lowest point on its way
    (exactly, from kink to kink), end after a finite number of changes of contact whatever lifts together.

    Parameters
    ----------
    linear : ndarray, shape (n, n)
        Springs that always bear [N/m].
    rows : ndarray, shape (S, n)
        Approach of the one-sided springs.
    stiffness, separation : ndarray, shape (M, S)
        [N/m] (zero where there is none), [m]; at M positions.
    load : ndarray, shape (n,) or (M, n)
        [N]

    Returns
    -------
    ndarray, shape (M, n)
        [m]; where some direction is free, the nearest to where all springs bear.

    Raises
    ------
    ConvergenceError
        If no equilibrium is found: the loads have nothing to bear on.
    """
    count, n = stiffness.shape[0], linear.shape[0]
    loads = np.broadcast_to(load, (count, n))
    size = np.max(np.abs(loads), axis=1)
    guard = _HELD * (float(np.max(np.abs(linear), initial=0.0)) + float(np.max(stiffness.sum(axis=1)))) * np.eye(n)

    def residual(z: Array) -> tuple[Array, NDArray[np.bool_]]:
        gap = z @ rows.T - separation
        bears = (gap > 0.0) & (stiffness > 0.0)
        return np.asarray(z @ linear + np.where(bears, stiffness * gap, 0.0) @ rows - loads, dtype=float), bears

    # from where all springs bear, as far as they carry anything
    start = _hessian(linear, rows, stiffness) + guard
    z = np.asarray(np.linalg.solve(start, (loads + (stiffness * separation) @ rows)[..., None])[..., 0], dtype=float)
    for _ in range(_STEPS):
        gradient, bears = residual(z)
        miss = np.max(np.abs(gradient), axis=1) / size
        if np.all(miss <= _CLOSED):
            return z
        hessian = _hessian(linear, rows, np.where(bears, stiffness, 0.0)) + guard
        step = np.asarray(-np.linalg.solve(hessian, gradient[..., None])[..., 0], dtype=float)
        z += _lowest(z, step, linear, rows, stiffness, separation, loads)[:, None] * step
    gradient, _ = residual(z)
    miss = np.max(np.abs(gradient), axis=1) / size
    if np.all(miss <= _NEARLY):
        return z
    raise ConvergenceError(
        f"The planets find no equilibrium: {float(np.max(miss)):.3g} of the load is left. Support the members that "
        "float, or check torque and pin errors."
    )


def _hessian(linear: Array, rows: Array, stiffness: Array) -> Array:
    found: Array = linear + np.einsum("ms,si,sj->mij", stiffness, rows, rows, optimize=True)
    return found


def _lowest(
    z: Array, step: Array, linear: Array, rows: Array, stiffness: Array, separation: Array, loads: Array
) -> Array:
    """How far along each step the energy falls [its length], at most once the step, shape (M,)."""
    gap, way = z @ rows.T - separation, step @ rows.T

    def slope(t: Array) -> Array:
        """Derivative of the energy along the step, at shares of it, shapes (M, T) -> (M, T)."""
        there = gap[:, None] + t[..., None] * way[:, None]
        push = (np.maximum(there, 0.0) * stiffness[:, None] * way[:, None]).sum(axis=-1)
        fixed = ((z @ linear - loads) * step).sum(axis=1)
        return fixed[:, None] + t * ((step @ linear) * step).sum(axis=1)[:, None] + push

    with np.errstate(divide="ignore", invalid="ignore"):
        kinks = np.where((way != 0.0) & (stiffness > 0.0), -gap / way, 1.0)
    ends = np.sort(np.clip(np.nan_to_num(kinks, nan=1.0), 0.0, 1.0), axis=1)
    ends = np.concatenate([np.zeros((len(z), 1)), ends, np.ones((len(z), 1))], axis=1)
    slopes = slope(ends)
    rises = slopes > 0.0
    after = np.where(rises.any(axis=1), np.argmax(rises, axis=1), ends.shape[1])
    own = np.arange(len(z))
    low, high = np.clip(after - 1, 0, None), np.clip(after, 0, ends.shape[1] - 1)
    a, b, fa, fb = ends[own, low], ends[own, high], slopes[own, low], slopes[own, high]
    with np.errstate(divide="ignore", invalid="ignore"):
        inside = a + (b - a) * np.where(fb > fa, -fa / (fb - fa), 1.0)
    # a slope that rises at the very start is round-off at the bottom: the whole step is as good
    return np.where(rises.any(axis=1) & (after > 0), inside, 1.0)
