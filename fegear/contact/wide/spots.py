"""Contacts that are spots: crowned flanks that touch over a length of the same order as their width.

A contact's width follows the line load averaged over about that width (`fegear.contact.wide.load_sharing`). What is
taken for it is the width under the mean load of the line; a load that stands on a small part of its line makes a
contact that is several times as wide. Averaged over too little, its line load has no least energy on short panels, and
no set of stations is found. Then averages follow the width that the contact has.

Line loads of long contacts stay a model of spots: against Hertz's ellipse of half-axes a and b their largest pressure
is low by a quarter of (b/a)^2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import ConvergenceError
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.load_sharing import Contact, solve_contact

#: Steps after which contacts are taken for spots.
_PATIENCE = 60
#: Parts of a spot's half-width that its averages follow: the first at which a set of stations is found.
_SHARES = (0.5, 1.0)
#: Part of (b/a)^2, as found, by which Hertz's largest pressure is higher: seen up to circles, which come out longer.
_MISSED = 0.6


def solve_spots(
    known: FlankCompliance, gap: Array, load: Array, progress: Callable[[float], None] | None = None
) -> tuple[FlankCompliance, Contact]:
    """Find forces and approach as `solve_contact` does, of spots with averages over their own width.

    Parameters
    ----------
    known : FlankCompliance
    gap : ndarray, shape (P, M) or (P, M, L)
        [m].
    load : ndarray, shape (L,) or (P, L)
        [N].
    progress : callable, optional
        Receives the fraction of problems solved.

    Returns
    -------
    known : FlankCompliance
        The same unless contacts are spots: those that the forces belong to, under the load of the widest.
    contact : Contact

    Raises
    ------
    ConvergenceError
        If no consistent set of loaded stations is found.
    """
    if known.fixed_half_width is not None or known.line_half_width is None:
        return known, solve_contact(known, gap, load, progress=progress)
    try:
        return known, solve_contact(known, gap, load, _PATIENCE, progress)
    except ConvergenceError:
        pass
    # Each load on its own, so that what it does hangs on no other.
    parts = [
        _own_width(known, gap[..., i] if gap.ndim > 2 else gap, load[..., i : i + 1]) for i in range(load.shape[-1])
    ]
    widest = max((one for one, _ in parts), key=lambda one: 0.0 if one.spot is None else float(one.spot.max()))
    contacts = [one for _, one in parts]

    def together(key: str) -> Array:
        return np.concatenate([getattr(one, key) for one in contacts], axis=-1)

    return widest, Contact(
        together("force"), together("approach"), together("stiffness"), together("residual"),
        max(one.steps for one in contacts),
    )  # fmt: skip


def _own_width(known: FlankCompliance, gap: Array, load: Array) -> tuple[FlankCompliance, Contact]:
    """Contact under one load with averages over the width that it makes."""
    # No wider than the load on a length of four half-widths makes them: b^2 = q W / (4 b), about Hertz's circle.
    widest = np.cbrt(0.25 * known.width_factor.max(axis=1, keepdims=True) * load.max())
    known = replace(known, spot=widest)
    width = _half_width(known, solve_contact(known, gap, load)).max(axis=(1, 2))[:, None]
    for share in _SHARES:
        own = replace(known, spot=share * width)
        try:
            return own, solve_contact(own, gap, load, _PATIENCE)
        except ConvergenceError:
            continue
    return known, solve_contact(known, gap, load)


def missed_of_spots(known: FlankCompliance, found: Contact, values: Array, shortest: float) -> Array:
    """By how much the largest of `values` may be low because contacts are spots, shape (L,): nothing of long contacts.

    Each contact line's own largest value counts with what its own shape misses: an edge that just comes into contact
    touches at a spot, and says nothing about a line that carries all.

    Parameters
    ----------
    known : FlankCompliance
    found : Contact
    values : ndarray, shape (P, M, L)
        Loads or pressures at the stations, zero where none is looked at.
    shortest : float
        Contact lines of less decide no largest value, and are not looked at [m].
    """
    lines, width = known.lines, _half_width(known, found)
    loaded = lines.support[:, :, None] * (found.force > 0.0)
    largest = values.max(axis=(0, 1))
    most = largest.copy()
    for p in range(lines.roll.size):
        for s in lines.at(p):
            if lines.z[p, s][-1] - lines.z[p, s][0] < shortest * (1.0 - 1e-9):
                continue
            half = 0.5 * loaded[p, s].sum(axis=0)
            ratio = np.divide(width[p, s].max(axis=0), half, out=np.zeros_like(half), where=half > 0.0)
            most = np.maximum(most, values[p, s].max(axis=0) * (1.0 + _MISSED * np.minimum(ratio, 1.0) ** 2))
    return np.asarray(most - largest)


def _half_width(known: FlankCompliance, found: Contact) -> Array:
    """Hertzian half-widths of contacts, shape (P, M, L) [m]."""
    support = known.lines.support[:, :, None]
    return known.half_width(np.divide(found.force, support, out=np.zeros_like(found.force), where=support > 0.0))
