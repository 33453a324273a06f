"""Root stress of one tooth of a gear on its way through the mesh, its neighbours' loads and its error included."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.error_by_shift import solve_again
from fegear.contact.root_stress_history import root_stress_history, root_stress_kernels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.contact.compliance import RootStressInfluence
    from fegear.contact.engagement import Engagement, Loaded
    from fegear.geometry.pair import Member


@dataclass(frozen=True)
class ToothStress:
    """Largest root stresses of one tooth while its pair passes through the mesh; arrays of shape (P, L).

    Parameters
    ----------
    x : ndarray, shape (P,)
        Position of the tooth's contact [m].
    tension : ndarray
        Largest below the loaded flank [Pa].
    compression : ndarray or None
        Most negative of the other fillet [Pa]; None where the source knows none, as the formulas.
    tension_error : ndarray
        Estimated [Pa]; NaN where the source does not know its own.
    """

    x: Array
    tension: Array
    compression: Array | None
    tension_error: Array


def _states(e: Engagement, x: Array, loads: Sequence[float]) -> list[tuple[int, Loaded]]:
    """Row of each tooth and the loaded state for it: the same state unless teeth differ by their spacing errors."""
    grid = e.grid(x)
    numbers = np.concatenate([[grid.contacts.number[0] - 1], grid.contacts.number, [grid.contacts.number[-1] + 1]])
    if not (e.driver_spacing.size or e.driven_spacing.size):
        state = e.solve(grid, loads)
        return [(row, state) for row in range(numbers.size)]
    # The tooth of interest carries pair number j in base pitch number j.
    return [(row, e.solve(grid, loads, int(number))) for row, number in enumerate(numbers)]


def tooth_stress(
    e: Engagement,
    shifted: Sequence[Engagement],
    loads: Sequence[float],
    x: ArrayLike,
    member: Member,
    source: RootStressInfluence | None = None,
    *,
    estimates: bool = True,
) -> ToothStress:
    """Follow one tooth of a gear from a base pitch before its contact to one after it.

    Parameters
    ----------
    e : Engagement
    shifted : sequence of Engagement
        The same with one compliance each off by its error.
    loads : sequence of float, shape (L,)
        Along the line of action [N].
    x : array_like, shape (P,)
        Roll positions over one base pitch [m].
    member : {"driver", "driven"}
    source : RootStressInfluence, optional
        Where the gear's root stress comes from; by default where its compliance does, which must be finite elements.
    estimates : bool
        Whether the error is estimated; else it is not known.

    Raises
    ------
    InputError
        If the source knows no root stress.
    """
    states = _states(e, np.asarray(x, dtype=float), loads)
    contacts = states[0][1].grid.contacts
    pull = root_stress_kernels(e, contacts, member, "tension", 1, source)
    ends = np.array([e.pair.radius(end, member) for end in (e.pair.x_start, e.pair.x_end)])
    knows_both = (source or e.compliance.source(member)).root_stress(0, ends, "compression") is not None
    press = root_stress_kernels(e, contacts, member, "compression", 1, source) if knows_both else {}
    xs: list[Array] = []
    tension: list[Array] = []
    compression: list[Array] = []
    error: list[Array] = []
    known: dict[int, tuple[Array, Array, Array, Array]] = {}
    for row, state in states:
        if id(state) not in known:
            pulled = root_stress_history(e, state, member, "tension", 1, pull)
            pressed = root_stress_history(e, state, member, "compression", 1, press) if press else pulled
            off = np.zeros_like(pulled.stress)
            for other in shifted:
                again = solve_again(other, state)
                off = off + np.abs(root_stress_history(e, again, member, "tension", 1, pull).stress - pulled.stress)
            off[1:-1] += _own_error(e, member, state, source) if estimates else np.nan
            known[id(state)] = pulled.x, pulled.stress, pressed.stress, off
        for found, values in zip((xs, tension, compression, error), known[id(state)], strict=True):
            found.append(values[row])
    x = np.concatenate(xs)
    order = np.argsort(x)
    pitch = e.pair.base_pitch
    order = order[(x[order] > e.pair.x_start - pitch) & (x[order] < e.pair.x_end + pitch)]
    t, c, off = (np.concatenate(parts)[order] for parts in (tension, compression, error))
    return ToothStress(x[order], t, c if press else None, off)


def _own_error(e: Engagement, member: Member, state: Loaded, source: RootStressInfluence | None) -> Array:
    """What the source leaves in the stress of each tooth's own load, shape (n, P, L) [Pa]."""
    stress = source or e.compliance.source(member)
    contacts = state.grid.contacts
    radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
    few = np.linspace(radius.min(), radius.max(), 9)
    usual = stress.root_stress_error(few)
    per_load = np.interp(radius, few, usual)
    return np.asarray(per_load[:, :, None] * state.loads / e.compliance.face_width)
