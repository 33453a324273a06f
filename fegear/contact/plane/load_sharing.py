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
from fegear.contact.plane.edge_law import EdgeContacts

#: Share below which the logarithm is continued by its tangent: W ln W has an infinite slope at zero. Its effect on any
#: share is below its own size.
_SMALLEST_SHARE = 1e-20
_MOST_STEPS = 40
#: Of a share: the whole load is one.
_ROUND_OFF = 1e-15
#: Exponent of the load in Palmgren's contact deflection.
_PALMGREN = 0.9


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
    log_slope: ArrayLike = 0.0,
    reference_load: ArrayLike = 1.0,
    edges: EdgeContacts | None = None,
    power: ArrayLike = 0.0,
) -> SharedLoad:
    """Share total loads among the tooth pairs at many roll positions.

    Parameters
    ----------
    compliance : array_like, shape (n, n, P)
        c_jj' of the pairs, both gears added [m/N]: deflection of pair j per unit load on pair j'; the diagonal holds
        at the reference load.
    separation : array_like, shape (n, P) or (n, P, L)
        e_j [m], initial distance of pair j along the line of action; infinite where the pair is out of reach.
    load : array_like, shape (L,) or (P, L)
        W [N], positive.
    log_slope : array_like, shape () or (n, P)
        kappa_j, change of both bodies' approach per unit load with ln(1 / half-width) [m/N]; 0 for a linear contact.
    reference_load : array_like, shape () or (n, P)
        W_ref [N], the load at which the diagonal of `compliance` holds.
    edges : EdgeContacts, optional
        Contacts near tip corners at the reference load, shape (n, P); see `edge_law`.
    power : array_like, shape () or (n, P)
        q_j of a further deflection q_j W_j^0.9 [m/N^0.9]: Palmgren's contact.

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
            "has no tooth pair in reach of the line of action there",
            "increase the contact ratio",
        )
    near = reach.any(axis=(1, 2))  # pairs that are nowhere in reach would only cost time
    slope, reference, bent = (
        np.broadcast_to(np.asarray(one, dtype=float), (n, positions))[near]
        for one in (log_slope, reference_load, power)
    )
    narrow = None if edges is None else EdgeContacts(edges.tilt[near], edges.wedge[near], edges.room[near])
    shared = _share(c[np.ix_(near, near)], e[near], total, slope, reference, bent, narrow)
    loads = np.zeros((n, positions, cases))
    loads[near] = shared.loads
    return SharedLoad(loads, shared.transmission_error, shared.steps)


def _share(
    c: Array, e: Array, total: Array, log_slope: Array, reference_load: Array, power: Array, edges: EdgeContacts | None
) -> SharedLoad:
    """`share_load` of arrays of full shape and of pairs that are in reach somewhere."""
    n, positions, cases = e.shape
    reach = e < np.inf
    kappa, at, bent = (one[:, :, None] for one in (log_slope, reference_load, power))
    # In shares v = W_j / W every load is the same problem: only the diagonal and the separations change with W.
    diagonal = c[np.arange(n), np.arange(n)][:, :, None] - 0.5 * kappa * np.log(total / at)
    _refuse_wide_contact(np.where(reach, diagonal, np.inf), kappa, total)
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
        half_slope=flat(0.5 * kappa) if kappa.any() else None,
        gap=flat(np.where(reach, e - nearest, 0.0) / total),
        reach=flat(reach.astype(float)) > 0.5,
        edges=None
        if edges is None
        else EdgeContacts(
            flat(edges.tilt[:, :, None] * np.sqrt(at / total)),
            flat(edges.wedge[:, :, None]),
            flat(edges.room[:, :, None] * np.sqrt(at / total)),
        ),
        power=flat(bent * total ** (_PALMGREN - 1.0)) if bent.any() else None,
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
    half_slope: Array | None
    gap: Array
    reach: Mask
    edges: EdgeContacts | None
    power: Array | None

    def only(self, index: NDArray[np.int64]) -> _Problem:
        """The problems at `index`."""
        return _Problem(
            None if self.coupling is None else self.coupling[:, :, index],
            self.diagonal[:, index],
            None if self.half_slope is None else self.half_slope[:, index],
            self.gap[:, index],
            self.reach[:, index],
            None if self.edges is None else self.edges.only(index),
            None if self.power is None else self.power[:, index],
        )


def _refuse_wide_contact(diagonal: Array, kappa: Array, total: Array) -> None:
    """The approach must grow with load up to the whole load on one pair."""
    margin = diagonal - 0.5 * np.maximum(kappa, 0.0)
    bad = ~(margin > 0.0)
    if bad.any():
        raise RangeError(
            "load",
            f"{np.broadcast_to(total, bad.shape)[bad][0]:.6g} N",
            "makes the Hertzian contact so wide that a tooth pair has no positive stiffness left",
            "lower the load, widen the face, or check the compliances given",
        )


def _solve(problem: _Problem) -> tuple[Array, Array, int]:
    """All problems to round-off; those done leave the batch."""
    n, size = problem.diagonal.shape
    shares, approach = np.zeros((n, size)), np.zeros(size)
    index = np.arange(size)
    # What is farther off than the nearest pair gives way under the whole load begins unloaded.
    most = np.where(problem.reach & (problem.gap == 0.0), problem.diagonal, 0.0).max(axis=0)
    active = problem.reach & (problem.gap <= most)
    v = np.where(active, 1.0 / np.maximum(active.sum(axis=0), 1), _SMALLEST_SHARE)
    steps = 0
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
        straight = problem.half_slope is None and problem.power is None
        done = settled.all(axis=0) & (close | straight)
        if done.any():
            shares[:, index[done]], approach[index[done]] = np.where(stays, new, 0.0)[:, done], z[done]
        active = stays | enters
        v = np.where(stays, np.minimum(new, 1.0), _SMALLEST_SHARE)
        if done.any():
            left = np.flatnonzero(~done)
            index, problem = index[left], problem.only(left)
            active, v = active[:, left], v[:, left]
    if index.size:
        shares[:, index], approach[index] = _enumerate(problem)
    return shares, approach, steps


def _newton_step(problem: _Problem, active: Mask, v: Array) -> tuple[Array, Array]:
    """Solve the contact conditions of the active pairs, linearised about the shares v.

    The tangent of -(kappa/2) v ln v at v is -(kappa/2)(1 + ln v) times the new share, plus (kappa/2) v. The function is
    concave, so from below the iteration stays below and converges monotonically.
    """
    w = np.maximum(v, _SMALLEST_SHARE)
    slope, constant = problem.diagonal, problem.gap
    if problem.half_slope is not None or problem.power is not None:
        note("nonlinear steps")
    if problem.half_slope is not None:
        slope = slope - problem.half_slope * (1.0 + np.log(w))
        constant = constant + problem.half_slope * w
    if problem.edges is not None and problem.half_slope is not None:
        psi, t_slope = problem.edges.law(np.sqrt(w))
        slope = slope + problem.half_slope * (2.0 * psi - t_slope)
        constant = constant + problem.half_slope * w * t_slope
    if problem.power is not None:
        approach = problem.power * w**_PALMGREN
        slope = slope + _PALMGREN * approach / w
        constant = constant + (1.0 - _PALMGREN) * approach
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
        v = np.where(active, _SMALLEST_SHARE, 0.0)
        z = np.zeros(index.size)
        new = v
        for _ in range(80):
            v = np.clip(new, _SMALLEST_SHARE, 1.0)
            new, z = _newton_step(part, active, v)
        apart = part.reach & ~active
        scale = np.abs(part.diagonal).max(axis=0)
        right = ((new > 0.0) | ~active).all(axis=0) & (np.abs(new - v) <= 1e-13).all(axis=0, where=active)
        right &= (~apart | (_gap(part, np.where(active, new, 0.0), z) >= -1e-13 * scale)).all(axis=0)
        hit = index[right]
        shares[:, hit], approach[hit], found[hit] = np.where(active, new, 0.0)[:, right], z[right], True
    if not found.all():
        raise ConvergenceError(
            f"Load sharing found no consistent set of loaded pairs for {int((~found).sum())} of {size} problems; "
            "the compliance matrix given is not positive definite. Check the neighbour compliances."
        )
    return shares, approach
