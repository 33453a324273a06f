"""Exact load sharing of tooth pairs: a small complementarity problem with a monotone nonlinearity, many at a time.

At one roll position the pairs in reach carry loads W_j with

    u_j + e_j = zeta   where W_j > 0,      u_j + e_j >= zeta   where W_j = 0,      sum_j W_j = W,
    u_j = sum_j' c_jj' W_j' - (kappa_j / 2) W_j ln(W_j / W_ref,j),

zeta the loaded transmission error, e_j the modifications and spacing errors of pair j (removal positive). The logarithm
is what the Hertzian half-width b ~ sqrt(W) does to the compliance of both bodies; a contact at or near the corner of a
tip is narrower (`edge_law`). The problem is the condition of a
strictly convex minimum, so its solution is unique; it is found by active sets with Newton's method, without relaxation.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Mask
from fegear.base.errors import ConvergenceError, InputError, RangeError
from fegear.base.tally import note, tallied
from fegear.contact.contact_law import LINEAR, SMALLEST_SHARE, ContactLaw

_MOST_STEPS = 40
#: Of a share: the whole load is one.
_ROUND_OFF = 1e-15


@dataclass(frozen=True, slots=True)
class SharedLoad:
    """Loads on the tooth pairs and the transmission error that goes with them.

    Parameters
    ----------
    loads : ndarray, shape (n, P, L)
        W_j on pair j at roll position p under total load l [N]; zero where the pair is out of reach or apart.
    transmission_error : ndarray, shape (P, L)
        zeta [m], positive when the gears approach (material removed).
    steps : int
        Newton steps that the slowest problem took.
    """

    loads: Array
    transmission_error: Array
    steps: int

    @property
    def shares(self) -> Array:
        """W_j / W, shape (n, P, L)."""
        shares: Array = self.loads / self.loads.sum(axis=0)
        return shares

    @property
    def pairs_in_contact(self) -> NDArray[np.int64]:
        """Number of loaded pairs, shape (P, L)."""
        return np.count_nonzero(self.loads > 0.0, axis=0)


@tallied("load sharing")
def share_load(
    compliance: ArrayLike,
    separation: ArrayLike,
    load: ArrayLike,
    law: ContactLaw = LINEAR,
) -> SharedLoad:
    """Share total loads among the tooth pairs at many roll positions.

    Parameters
    ----------
    compliance : array_like, shape (n, n, P)
        c_jj' of the pairs, both gears added [m/N]: deflection of pair j per unit load on pair j'; the diagonal holds
        at the reference load of the law.
    separation : array_like, shape (n, P) or (n, P, L)
        e_j [m], initial distance of pair j along the line of action; infinite where the pair is out of reach.
    load : array_like, shape (L,) or (P, L)
        W [N], positive.
    law : ContactLaw
        Of the n contacts at P positions: what their load changes of the diagonal; proportional by default.

    Returns
    -------
    SharedLoad

    Raises
    ------
    InputError
        If a load is not positive, or no pair is in reach at some position.
    RangeError
        If a pair would stiffen to nothing: the Hertzian contact would be as wide as the tooth.
    """
    c = np.asarray(compliance, dtype=float)
    total = np.atleast_1d(np.asarray(load, dtype=float))
    if not (np.isfinite(total).all() and (total > 0.0).all()):
        raise InputError("load", f"{total[~(np.isfinite(total) & (total > 0.0))][0]} N", "must be positive and finite")
    n, positions, cases = c.shape[0], c.shape[2], total.shape[-1]
    total = np.broadcast_to(total, (positions, cases))
    e = np.asarray(separation, dtype=float)
    e = np.broadcast_to(e[:, :, None] if e.ndim == 2 else e, (n, positions, cases))
    reach = e < np.inf
    somewhere: Mask = np.logical_or.reduce(reach, axis=0)
    if not somewhere.all():
        raise InputError(
            "pair",
            f"({int((~somewhere).sum())} of {positions} roll positions)",
            "no tooth pair in contact there",
            "increase the contact ratio",
        )
    near = reach.any(axis=(1, 2))  # pairs that are nowhere in reach would only cost time
    shared = _share(c[np.ix_(near, near)], e[near], total, law.each(lambda values: values[near]))
    loads = np.zeros((n, positions, cases))
    loads[near] = shared.loads
    return SharedLoad(loads, shared.transmission_error, shared.steps)


def _share(c: Array, e: Array, total: Array, law: ContactLaw) -> SharedLoad:
    """`share_load` of arrays of full shape and of pairs that are in reach somewhere."""
    n, positions, cases = e.shape
    reach = e < np.inf
    # In shares v = W_j / W every load is the same problem: only the diagonal and the separations change with W.
    less, in_shares = law.in_shares(total)
    diagonal = c[np.arange(n), np.arange(n)][:, :, None] - less
    _refuse_wide_contact(np.where(reach, diagonal, np.inf), np.asarray(in_shares.log_slope), total)
    size = positions * cases

    def flat(values: Array) -> Array:
        return np.ascontiguousarray(np.broadcast_to(values, (n, positions, cases)).reshape(n, size))

    # Counted from the pair that is nearest, so that large separations cost no digits of small deflections.
    nearest = np.where(reach, e, np.inf).min(axis=0)
    coupling = c.copy()
    coupling[np.arange(n), np.arange(n)] = 0.0
    problem = _Problem(
        coupling=np.ascontiguousarray(np.repeat(coupling, cases, axis=2)) if coupling.any() else None,
        diagonal=flat(diagonal),
        gap=flat(np.where(reach, e - nearest, 0.0) / total),
        reach=flat(reach.astype(float)) > 0.5,
        law=LINEAR if law.is_linear else in_shares.each(flat),
    )
    v, z, steps = _solve(problem)
    loads = (v / v.sum(axis=0)).reshape(n, positions, cases) * total
    return SharedLoad(loads, nearest + z.reshape(positions, cases) * total, steps)


def pair_tangent(tangent: ArrayLike, active: ArrayLike) -> Array:
    """Slope dW_j/dzeta of each pair's load over the transmission error, the loaded pairs staying the same.

    Differentiating u_j + e_j = zeta of the loaded pairs leaves a linear system, sum_j' (du_j/dW_j') dW_j'/dzeta = 1.

    Parameters
    ----------
    tangent : array_like, shape (n, n, ...)
        du_j/dW_j' at the loads [m/N].
    active : array_like of bool, shape (n, ...)
        Which pairs carry load.

    Returns
    -------
    ndarray, shape (n, ...)
        [N/m], zero for unloaded pairs.
    """
    on = np.asarray(active, dtype=bool)
    identity = np.eye(on.shape[0]).reshape(*(on.shape[0],) * 2, *(1,) * (on.ndim - 1))
    system = np.where(on[:, None] & on[None, :], np.asarray(tangent, dtype=float), identity)
    right = np.moveaxis(on.astype(float), 0, -1)[..., None]
    slopes = np.linalg.solve(np.moveaxis(system, (0, 1), (-2, -1)), right)[..., 0]
    return np.ascontiguousarray(np.moveaxis(slopes, -1, 0))


@dataclass(frozen=True, slots=True)
class _Problem:
    """B complementarity problems in shares; arrays of shape (n, B), coupling (n, n, B) or None when there is none."""

    coupling: Array | None
    diagonal: Array
    gap: Array
    reach: Mask
    law: ContactLaw

    def only(self, index: NDArray[np.int64]) -> _Problem:
        """The problems at `index`."""
        return _Problem(
            None if self.coupling is None else self.coupling[:, :, index],
            self.diagonal[:, index],
            self.gap[:, index],
            self.reach[:, index],
            self.law.at(index),
        )


def _refuse_wide_contact(diagonal: Array, kappa: Array, total: Array) -> None:
    """The approach must grow with load up to the whole load on one pair."""
    margin = diagonal - 0.5 * np.maximum(kappa, 0.0)
    bad = ~(margin > 0.0)
    if bad.any():
        raise RangeError(
            "load",
            f"{np.broadcast_to(total, bad.shape)[bad][0]:.6g} N",
            "is too high: contact width leads to a non-positive tooth pair stiffness",
            "reduce the load, increase the face width, or check the compliances",
        )


def _solve(problem: _Problem) -> tuple[Array, Array, int]:
    """All problems to round-off; those done leave the batch."""
    n, size = problem.diagonal.shape
    shares, approach = np.zeros((n, size)), np.zeros(size)
    index = np.arange(size)
    # What is farther off than the nearest pair gives way under the whole load begins unloaded.
    most = np.where(problem.reach & (problem.gap == 0.0), problem.diagonal, 0.0).max(axis=0)
    active = problem.reach & (problem.gap <= most)
    v = np.where(active, 1.0 / np.maximum(active.sum(axis=0), 1), SMALLEST_SHARE)
    steps, straight = 0, problem.law.is_linear
    while index.size and steps < _MOST_STEPS:
        steps += 1
        new, z = _newton_step(problem, active, v)
        stays = active & (new > 0.0)
        # A pair that only just touches must not flicker in and out of the set for the sake of round-off.
        touching = -1e-15 * (np.abs(z) + np.abs(problem.gap))
        enters = problem.reach & ~active & (_gap(problem, np.where(active, new, 0.0), z) < touching)
        settled = (stays | enters) == active
        # Newton squares the relative error: a last step of 1e-8 leaves nothing but round-off, which is that of the
        # whole load: the share of a pair that just touches keeps moving by it.
        close = (np.abs(new - v) <= 1e-8 * np.abs(new) + _ROUND_OFF).all(axis=0, where=active)
        done = settled.all(axis=0) & (close | straight)
        if done.any():
            shares[:, index[done]], approach[index[done]] = np.where(stays, new, 0.0)[:, done], z[done]
        active = stays | enters
        v = np.where(stays, np.minimum(new, 1.0), SMALLEST_SHARE)
        if done.any():
            left = np.flatnonzero(~done)
            index, problem = index[left], problem.only(left)
            active, v = active[:, left], v[:, left]
    if index.size:
        shares[:, index], approach[index] = _enumerate(problem)
    return shares, approach, steps


def _newton_step(problem: _Problem, active: Mask, v: Array) -> tuple[Array, Array]:
    """Solve the contact conditions of the active pairs, their law linearised about the shares v."""
    if not problem.law.is_linear:
        note("nonlinear steps")
    slope, constant = problem.law.linearised(problem.diagonal, v, problem.gap)
    if problem.coupling is None:
        inverse = np.where(active, 1.0 / np.where(active, slope, 1.0), 0.0)
        z = (1.0 + (inverse * constant).sum(axis=0)) / inverse.sum(axis=0)
        return inverse * (z - constant), z
    ones = active.astype(float)
    y = _solve_spd(problem.coupling, np.where(active, slope, 1.0), active, np.stack([ones, ones * constant]))
    z = (1.0 + y[1].sum(axis=0)) / y[0].sum(axis=0)
    return z * y[0] - y[1], z


def _solve_spd(coupling: Array, diagonal: Array, active: Mask, right: Array) -> Array:
    """Gaussian elimination, batched over the trailing axis; inactive rows and columns are those of the identity.

    The matrices are positive definite, so no pivoting is needed; n is small, so the loops over rows are short and each
    line works on the whole batch.
    """
    n = diagonal.shape[0]
    a = coupling * active[:, None] * active[None, :]
    a[np.arange(n), np.arange(n)] = diagonal
    b = right.copy()
    for i in range(n):
        for k in range(i + 1, n):
            factor = a[k, i] / a[i, i]
            a[k, i + 1 :] -= factor * a[i, i + 1 :]
            b[:, k] -= factor * b[:, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[:, i] -= a[i, k] * b[:, k]
        b[:, i] /= a[i, i]
    return b


def _gap(problem: _Problem, v: Array, z: Array) -> Array:
    """Distance left at unloaded pairs, (n, B), per unit total load; exact, since their own share is zero."""
    if problem.coupling is None:
        return problem.gap - z
    gap: Array = np.einsum("ijb,jb->ib", problem.coupling, v) + problem.gap - z
    return gap


def _enumerate(problem: _Problem) -> tuple[Array, Array]:
    """Try every set of loaded pairs: a safeguard for strongly coupled pairs on which the active sets cycle."""
    n, size = problem.diagonal.shape
    shares, approach, found = np.zeros((n, size)), np.zeros(size), np.zeros(size, dtype=bool)
    for bits in product((True, False), repeat=n):
        chosen = np.array(bits)[:, None] & problem.reach
        valid = ~found & chosen.any(axis=0) & (chosen.sum(axis=0) == sum(bits))
        if not valid.any():
            continue
        index = np.flatnonzero(valid)
        part, active = problem.only(index), chosen[:, index]
        v = np.where(active, SMALLEST_SHARE, 0.0)
        z = np.zeros(index.size)
        new = v
        for _ in range(80):
            v = np.clip(new, SMALLEST_SHARE, 1.0)
            new, z = _newton_step(part, active, v)
        apart = part.reach & ~active
        scale = np.abs(part.diagonal).max(axis=0)
        right = ((new > 0.0) | ~active).all(axis=0) & (np.abs(new - v) <= 1e-13).all(axis=0, where=active)
        right &= (~apart | (_gap(part, np.where(active, new, 0.0), z) >= -1e-13 * scale)).all(axis=0)
        hit = index[right]
        shares[:, hit], approach[hit], found[hit] = np.where(active, new, 0.0)[:, right], z[right], True
    if not found.all():
        raise ConvergenceError(
            f"No consistent load sharing found for {int((~found).sum())} of {size} problems; the compliance matrix "
            "is not positive definite. Check the neighbour compliances."
        )
    return shares, approach
