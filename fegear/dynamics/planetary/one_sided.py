"""Equilibrium of bodies on springs of which some only push: Newton on the energy, for many positions at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import ConvergenceError

if TYPE_CHECKING:
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
    """Coordinates z with linear z + rows' sum of stiffness max(rows z - separation, 0) = load.

    The energy is convex and of pieces of second order. Newton's steps, each shortened to the lowest point on its way
    (exactly, from kink to kink) where it goes too far, end after a finite number of changes of contact whatever lifts
    together.

    Parameters
    ----------
    linear : ndarray, shape (n, n)
        Springs that always bear [N/m].
    rows : ndarray, shape (R, n)
        Approaches on which one-sided springs bear.
    stiffness, separation : ndarray, shape (M, R) or (M, R, L)
        [N/m] (zero where there is none), [m]; at M positions, L springs on one approach.
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
    if stiffness.ndim == 2:
        stiffness, separation = stiffness[..., None], separation[..., None]
    count, n = stiffness.shape[0], linear.shape[0]
    loads = np.broadcast_to(load, (count, n))
    if count > 1 and all((one == one[0]).all() for one in (stiffness, separation, loads)):
        # stiffness that is given does not change over the cycle: each position is the first
        found = equilibrium(linear, rows, stiffness[:1], separation[:1], loads[:1])
        return np.broadcast_to(found, (count, n)).copy()
    size = np.max(np.abs(loads), axis=1)
    guard = guarded(linear, stiffness)
    # from where all springs bear, as far as they carry anything
    start = tangent(linear, rows, stiffness.sum(axis=2)) + guard
    borne = (stiffness * separation).sum(axis=2) @ rows
    z = np.asarray(np.linalg.solve(start, (loads + borne)[..., None])[..., 0], dtype=float)
    own, miss = np.arange(count), np.zeros(count)  # those not done yet
    for _ in range(_STEPS):
        k, m, w = stiffness[own], separation[own], loads[own]
        gradient, bearing = _residual(z[own], linear, rows, k, m, w)
        miss[own] = np.max(np.abs(gradient), axis=1) / size[own]
        left = miss[own] > _CLOSED
        if not left.any():
            return z
        own = own[left]
        k, m, w, gradient, bearing = (one[left] for one in (k, m, w, gradient, bearing))
        step = np.linalg.solve(tangent(linear, rows, bearing) + guard, -gradient[..., None])[..., 0]
        # the whole step where the energy still falls at its end, or rises half as steeply at most
        ahead, _ = _residual(z[own] + step, linear, rows, k, m, w)
        far = (ahead * step).sum(axis=1) > -0.5 * (gradient * step).sum(axis=1)
        length = np.ones(own.size)
        if far.any():
            length[far] = _lowest(z[own[far]], step[far], linear, rows, k[far], m[far], w[far])
        z[own] += length[:, None] * step
    if np.all(miss <= _NEARLY):
        return z
    raise ConvergenceError(
        f"No equilibrium of the planets found: unbalanced load {float(np.max(miss)):.3g}. Support the floating "
        "members, or check torque and pin position errors."
    )


def guarded(linear: Array, stiffness: Array) -> Array:
    """What is added to every coordinate within a step, shape (n, n)."""
    largest = float(np.max(np.abs(linear), initial=0.0)) + float(np.max(stiffness.sum(axis=(1, 2))))
    return np.asarray(_HELD * largest * np.eye(linear.shape[0]))


def tangent(linear: Array, rows: Array, bearing: Array) -> Array:
    """Stiffness with that of the springs that bear on each row, shapes (M, R) -> (M, n, n)."""
    found: Array = linear + np.einsum("mr,ri,rj->mij", bearing, rows, rows, optimize=True)
    return found


def spring_forces(gap: Array, stiffness: Array, separation: Array) -> tuple[Array, Array]:
    """Force of all springs on each approach [N], and stiffness of those that bear [N/m], shapes (M, R)."""
    beyond = gap[..., None] - separation
    bearing = np.where(beyond > 0.0, stiffness, 0.0)
    return (bearing * beyond).sum(axis=2), bearing.sum(axis=2)


def _residual(
    z: Array, linear: Array, rows: Array, stiffness: Array, separation: Array, loads: Array
) -> tuple[Array, Array]:
    force, bearing = spring_forces(z @ rows.T, stiffness, separation)
    return np.asarray(z @ linear + force @ rows - loads), bearing


def _lowest(
    z: Array, step: Array, linear: Array, rows: Array, stiffness: Array, separation: Array, loads: Array
) -> Array:
    """How far along each step the energy falls [its length], at most once the step, shape (M,)."""
    way, here = step @ rows.T, z @ rows.T
    fixed, bent = ((z @ linear - loads) * step).sum(axis=1), ((step @ linear) * step).sum(axis=1)

    def slope(t: Array) -> Array:
        """Derivative of the energy along the step, at shares of it, shape (M,)."""
        force, _ = spring_forces(here + t[:, None] * way, stiffness, separation)
        return np.asarray(fixed + t * bent + (force * way).sum(axis=1))

    with np.errstate(divide="ignore", invalid="ignore"):
        kinks = (separation - here[..., None]) / way[..., None]
    kinks = np.where((way[..., None] != 0.0) & (stiffness > 0.0), kinks, 1.0).reshape(len(z), -1)
    ends = np.sort(np.clip(np.nan_to_num(kinks, nan=1.0), 0.0, 1.0), axis=1)
    ends = np.concatenate([np.zeros((len(z), 1)), ends, np.ones((len(z), 1))], axis=1)
    # the slope rises all the way: the two kinks between which it is zero are found by halves
    own, low, high = np.arange(len(z)), np.zeros(len(z), dtype=int), np.full(len(z), ends.shape[1] - 1)
    while np.any(high - low > 1):
        middle = (low + high) // 2
        rises = slope(ends[own, middle]) > 0.0
        low, high = np.where(rises, low, middle), np.where(rises, middle, high)
    a, b = ends[own, low], ends[own, high]
    fa, fb = slope(a), slope(b)
    with np.errstate(divide="ignore", invalid="ignore"):
        inside = a + (b - a) * np.where(fb > fa, -fa / (fb - fa), 1.0)
    # a slope that rises at the very start is round-off at the bottom: the whole step is as good
    return np.where((fa <= 0.0) & (fb > 0.0), inside, 1.0)
