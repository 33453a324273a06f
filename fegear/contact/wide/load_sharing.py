"""Contact over the flank as a complementarity problem, many roll positions and loads at a time.

The line load f(z) is piecewise linear between the stations of a contact line, W_i the forces of its hats. They obey

    u_i + e_i = zeta   where W_i > 0,      u_i + e_i >= zeta   where W_i = 0,      sum_i W_i = W,
    u_i = sum_j C_ij W_j - 2 s int <phi_i> <f> ln (b / b_0) dz,      b = sqrt(q <f>),

phi_i the hat of unit force, e_i the gap averaged over it, b_0 the half-width that stands for the line in C, and < > an
average along the line over about that width (`fegear.contact.wide.averages`). These are the conditions of a
minimum, strictly convex while C against long waves is more than s (1 + 2 ln b / b_0), so the solution is unique. It is
found by active sets with Newton's method, as in `fegear.contact.plane.load_sharing`; sets that cycle go on by one
station at a time (Murty, Linear Complementarity, 1988, 3.2: the least index).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array, Index, Mask, ReadOnlyArrays
from fegear.base.errors import ConvergenceError, InputError
from fegear.base.tally import note, tallied
from fegear.contact.wide.averages import GAUSS, LocalMatrix

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.contact.wide.compliance import FlankCompliance
    from fegear.contact.wide.lines import ContactLines


#: Steps in which many stations may change, and steps in all.
_MANY_AT_ONCE, _MOST_STEPS = 15, 400


#: Entries of the matrices that are solved at a time: many loads would otherwise fill the memory.
_ENTRIES = 1 << 23


#: Share of the mean line load below which the logarithm is continued by its tangent.
_SMALLEST = 1e-9


#: From a rounded tip the sharp edge is as far away as this [m].
_FAR = 1e3


@dataclass(frozen=True)
class Contact(ReadOnlyArrays):
    """Forces on the stations and the approach that goes with them.

    Parameters
    ----------
    force : ndarray, shape (P, M, L)
        W_i [N], zero where apart.
    approach : ndarray, shape (P, L)
        zeta [m].
    stiffness : ndarray, shape (P, L)
        dW / dzeta with the stations in contact [N/m].
    residual : ndarray, shape (P, L)
        Largest violation of the conditions, over the approach from first touch.
    steps : int
        Of the slowest problem.
    """

    force: Array
    approach: Array
    stiffness: Array
    residual: Array
    steps: int


def hat_averages(lines: ContactLines, values: Array) -> Array:
    """Averages over each station's hat of what is straight between the stations, shape (..., P, M)."""
    h, support = lines.panel, lines.support
    found = np.zeros(values.shape)
    found[..., :-1] += h * (values[..., :-1] / 3.0 + values[..., 1:] / 6.0)
    found[..., 1:] += h * (values[..., 1:] / 3.0 + values[..., :-1] / 6.0)
    return np.asarray(np.divide(found, support, out=np.zeros_like(found), where=support > 0.0))


def averaged_gaps(lines: ContactLines, gap: Array, loads: int) -> Array:
    """`hat_averages` of gaps (P, M), the same under all loads, or (P, M, L), shape (P, M, L)."""
    each = np.moveaxis(gap.reshape(*gap.shape[:2], -1), 2, 0)
    found = np.stack([hat_averages(lines, one) for one in each], axis=2)
    return np.asarray(np.broadcast_to(found, (*found.shape[:2], loads)))


@tallied("load sharing")
def solve_contact(
    known: FlankCompliance,
    gap: Array,
    load: Array,
    most_steps: int = _MOST_STEPS,
    progress: Callable[[float], None] | None = None,
    near: Array | None = None,
) -> Contact:
    """Find forces and approach at all roll positions under all loads.

    Parameters
    ----------
    known : FlankCompliance
    gap : ndarray, shape (P, M) or (P, M, L)
        Distance of the unloaded flanks at the stations along the line of action [m], removal positive; the last of
        them one for each load. Infinite where a flank is missing.
    load : ndarray, shape (L,) or (P, L)
        Total loads along the transverse line of action [N], positive: the same at all roll positions, or each its own.
    most_steps : int
        After which it gives up.
    progress : callable, optional
        Receives the fraction of problems solved.
    near : ndarray, shape (P, M, L), optional
        Forces with about the same gaps, from which Newton's method needs a third of the steps [N].

    Returns
    -------
    Contact

    Raises
    ------
    InputError
        If no flank is left at some roll position.
    ConvergenceError
        If the compliances are not positive definite.
    """
    lines = known.lines
    positions, most = lines.x.shape
    cases = load.shape[-1]
    there = lines.present & np.isfinite(gap if gap.ndim == 2 else gap[..., 0])
    if not there.any(axis=1).all():
        raise InputError(
            "odd_tooth", "(given)", "leaves no tooth pair in contact at some roll positions",
            "set effects.corner_contact = true",
        )  # fmt: skip
    gap = gap if there.sum() == lines.present.sum() else _as_beside(there, lines.present, gap)
    averaged = np.moveaxis(averaged_gaps(lines, gap, cases), 2, 1).reshape(-1, most)
    place = np.repeat(np.arange(positions), cases)
    total = np.broadcast_to(load, (positions, cases)).ravel()
    nearest = np.where(there[place], averaged, np.inf).min(axis=1)
    found = _Found(
        np.zeros((place.size, most)), np.zeros(place.size), np.zeros(place.size), np.zeros(place.size)
    )  # fmt: skip
    begun = None if near is None else np.moveaxis(near, 2, 1).reshape(-1, most)
    at_a_time, steps = max(1, _ENTRIES // most**2), 0
    for start in range(0, place.size, at_a_time):
        part = slice(start, start + at_a_time)
        apart = np.where(there[place[part]], averaged[part] - nearest[part, None], 0.0)
        own = _Found(*(one[part] for one in found))
        first = _first_guess(known, there, place[part], total[part], None if begun is None else begun[part])
        steps = max(steps, _solve(known, there, place[part], apart, total[part], first, own, most_steps))
        own.approach[:] += nearest[part]
        if progress is not None:
            progress(min(1.0, (start + at_a_time) / place.size))
    shape = (positions, cases)
    forces = np.ascontiguousarray(np.moveaxis(found.force.reshape(*shape, most), 2, 1))
    return Contact(
        forces, found.approach.reshape(shape), found.stiffness.reshape(shape), found.residual.reshape(shape), steps
    )


def _as_beside(there: Mask, present: Mask, gap: Array) -> Array:
    """Gaps where flanks are missing as at the stations beside them, whose averages stay what they are."""
    found = gap.copy()
    for p in np.flatnonzero((present & ~there).any(axis=1)):
        own, at = np.flatnonzero(there[p]), np.flatnonzero(present[p] & ~there[p])
        found[p, at] = gap[p, own[np.abs(at[:, None] - own).argmin(axis=1)]]
    return found


class _Found(NamedTuple):
    """What is found of problems in a row, filled in as they are solved."""

    force: Array
    approach: Array
    stiffness: Array
    residual: Array


def _first_guess(
    known: FlankCompliance, there: Mask, place: Index, total: Array, near: Array | None
) -> tuple[Mask, Array]:  # fmt: skip
    """Stations in contact and forces from which problems are solved: those nearby, or the load spread evenly."""
    lines = known.lines
    if near is not None and (near.sum(axis=1) > 0.0).all():
        return there[place] & (near > 0.0), near
    return there[place], lines.support[place] / lines.length[place][:, None] * total[:, None]


def _solve(
    known: FlankCompliance, there: Mask, place: Index, apart: Array, total: Array, first: tuple[Mask, Array],
    found: _Found, most_steps: int,
) -> int:  # fmt: skip
    """Solve problems at once: place, gaps beyond the nearest and load of each; returns the steps of the slowest.

    `there` says where flanks are, shape (P, M); `first` what `_first_guess` found.
    """
    index = np.arange(place.size)
    active, v = first
    steps = 0
    while index.size:
        steps += 1
        if steps > most_steps:
            raise ConvergenceError(
                f"No consistent load distribution found for {index.size} of {place.size} problems: panels are too "
                "short relative to the contact width. Reduce load_distribution.panels and check load and face_width."
            )
        here, w = place[index], total[index]
        matrix, constant = _tangent(known, here, v)
        new, z, rate = _bordered(matrix, apart[index] + constant, active, w)
        kept = np.where(active, np.maximum(new, 0.0), 0.0)
        distance = np.einsum("bij,bj->bi", matrix, np.where(active, new, 0.0)) + constant + apart[index] - z[:, None]
        leaves = active & (new <= 0.0)
        scale = np.abs(z)[:, None] + apart[index]
        enters = there[here] & ~active & (distance < -1e-13 * scale)
        close = (np.abs(kept - v) <= 1e-9 * np.abs(v) + 1e-12 * w[:, None]).all(axis=1)
        changes = leaves | enters
        done = ~changes.any(axis=1) & (close | (known.fixed_half_width is not None))
        at = index[done]
        found.force[at], found.approach[at], found.stiffness[at] = kept[done], z[done], rate[done]
        wrong = np.where(active, np.abs(distance), np.maximum(-distance, 0.0)) * there[here]
        found.residual[at] = (wrong.max(axis=1) / np.abs(z))[done]
        if steps > _MANY_AT_ONCE:
            least = np.argmax(changes, axis=1)
            only = np.zeros_like(changes)
            only[np.arange(least.size), least] = True
            changes &= only
        active = (active ^ changes)[~done]
        v, index = kept[~done], index[~done]
    return steps


def tangent_compliance(known: FlankCompliance, place: Index, force: Array) -> Array:
    """What forces (B, M) at roll positions `place` leave of the compliances: their slopes, shape (B, M, M) [m/N]."""
    return _tangent(known, place, force)[0]


def secant_compliance(known: FlankCompliance, place: Index, force: Array) -> Array:
    """Approach per force under forces (B, M) at roll positions `place`, shape (B, M, M) [m/N]."""
    return _tangent(known, place, force, secant=True)[0]


def deflection(known: FlankCompliance, force: Array) -> Array:
    """Approach of all stations under forces of shape (P, M), widths that follow the load included, shape (P, M) [m]."""
    matrix, constant = _tangent(known, np.arange(force.shape[0]), force)
    return np.asarray(np.einsum("pij,pj->pi", matrix, force) + constant)


def growth_by_gaps(known: FlankCompliance, force: Array, gaps: Array) -> tuple[Array, Array]:
    """Growth of approach and forces with growing averaged gaps, solved forces of shape (P, M) given.

    Parameters
    ----------
    known : FlankCompliance
    force : ndarray, shape (P, M)
        Solved forces; where they vanish, flanks stay apart [N].
    gaps : ndarray, shape (K, P, M)
        K ways in which the gaps grow [m].

    Returns
    -------
    approach : ndarray, shape (K, P)
        Of an even gap its own growth.
    force : ndarray, shape (K, P, M)
        Nothing in sum at every roll position [N].
    """
    on = (force > 0.0).astype(float)
    matrix = tangent_compliance(known, np.arange(force.shape[0]), force)
    y = np.moveaxis(_solved(matrix, on, np.moveaxis(np.concatenate([on[None], on * gaps]), 0, 2)), 2, 0)
    approach = y[1:].sum(axis=2) / y[0].sum(axis=1)
    return approach, approach[:, :, None] * y[0] - y[1:]


def _tangent(known: FlankCompliance, place: Index, force: Array, *, secant: bool = False) -> tuple[Array, Array]:
    """Tangent compliances at forces of shape (B, M), and what the tangent leaves at zero force.

    Or those of a secant, without what a load changes of its own contact's width.
    """
    lines, s = known.lines, known.log_slope
    matrix = known.matrix[place]
    h, support = lines.panel[place], lines.support[place]
    density = np.divide(1.0, support, out=np.zeros_like(support), where=support > 0.0)
    f = force * density
    least = _SMALLEST * force.sum(axis=1, keepdims=True) / lines.length[place][:, None]
    unit = np.ones_like(f) if known.line_half_width is None else known.line_half_width[place]
    local = LocalMatrix(force.shape, known.averages.reach)
    follows = known.fixed_half_width is None
    if follows:
        note("nonlinear steps")
    for x, weight, rows in zip(*GAUSS, known.averages.rows, strict=True):
        b, a = x, 1.0 - x
        near = rows[place]
        part = weight * h
        if known.fixed_half_width is None:
            load = np.maximum(local.read(near, f), least)
            law, none = known.law(place, (a, b), _tilt(known, place, (a, b))), np.zeros(1)
            slope, left = (law.secant(none, load), none) if secant else law.linearised(none, load, none)
            local.add(near, part * slope, part * left)
        else:
            width = known.fixed_half_width[place]
            relative = (a * width[:, :-1] + b * width[:, 1:]) / unit[:, :-1]
            local.add(near, -2.0 * s * part * np.log(relative), np.zeros_like(part))
    local.into(matrix, density)
    return matrix, local.constant[:, local.inside] * density


def _tilt(known: FlankCompliance, place: Index, share: tuple[float, float]) -> Array | None:
    """Tilt of the flanks at sharp tip edges beside and beyond the ends of the path, (B, M - 1) [m]; None: no edges."""
    edges = known.lines.edges
    if edges is None:
        return None
    tilt = np.maximum(edges.tilt[place], -_FAR)
    return np.asarray(share[0] * tilt[:, :-1] + share[1] * tilt[:, 1:])


def _bordered(matrix: Array, gap: Array, active: Mask, total: Array) -> tuple[Array, Array, Array]:
    """Forces on the active stations, approach and dW/dzeta, the tangent compliances given."""
    on = active.astype(float)
    y = _solved(matrix, on, np.stack([on, on * gap], axis=2))
    rate = y[:, :, 0].sum(axis=1)
    z = (total + y[:, :, 1].sum(axis=1)) / rate
    return z[:, None] * y[:, :, 0] - y[:, :, 1], z, rate


def _solved(matrix: Array, on: Array, right: Array) -> Array:
    """Forces that deflect the active stations as said, both of shape (B, M, K)."""
    system = matrix * on[:, :, None] * on[:, None, :]
    at = np.arange(on.shape[1])
    system[:, at, at] += 1.0 - on
    # In units of each station's own compliance, so that inactive rows weigh no more than others.
    root = np.sqrt(np.abs(system[:, at, at]))
    system /= root[:, :, None] * root[:, None, :]
    return np.asarray(np.linalg.solve(system, right / root[:, :, None]) / root[:, :, None])
