"""One tooth pair followed over the path of contact: what the load-sharing table shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from operator import attrgetter

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.contact.plane.base_pitch import BESIDE
from fegear.contact.plane.engagement import Engagement, Loaded

_LOADS: Callable[[Loaded], Array] = attrgetter("loads")


@dataclass(frozen=True)
class PairHistory:
    """Load and its consequences on one tooth pair over its path.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Position of the pair [m]; before the start and after the end of the path a tip corner touches.
    driver_roll_angle : ndarray, shape (P,)
        Roll angle of the contact on the driver's flank [rad].
    load : ndarray, shape (P, L)
        [N].
    share : ndarray, shape (P, L)
        Of the total load.
    deflection : ndarray, shape (P, L)
        Of both teeth and their contact [m].
    hertz_pressure : ndarray, shape (P, L)
        Largest pressure of a smooth contact [Pa]; at a corner the true pressure is higher.
    transmission_error : ndarray, shape (P, L)
        [m].
    """

    x: Array = shown(
        "mm", "position of the pair on the line of action, from the pitch point", label="line of action", table="path"
    )
    driver_roll_angle: Array = shown(
        "deg", "roll angle of the contact point on the driver", name="roll_angle", table="path"
    )
    load: Array = shown("N", "load on the tooth pair along the line of action", label="load on the pair", table="path")
    share: Array = shown("", "share of the total load", table="path")
    deflection: Array = shown("um", "deflection of both teeth including contact", table="path")
    hertz_pressure: Array = shown(
        "MPa", "maximum Hertzian pressure (smooth flanks)", label="maximum Hertzian pressure", table="path"
    )
    transmission_error: Array = shown("um", "loaded transmission error")


def pair_history(engagement: Engagement, load: ArrayLike, positions: int = 200, cycle: int = 0) -> PairHistory:
    """Follow one tooth pair from its first to its last contact.

    Parameters
    ----------
    engagement : Engagement
    load : array_like, shape (L,)
        [N].
    positions : int
        Positions spread evenly; two more stand on either side of every jump.
    cycle : int
        Which pair, when there are spacing errors: the one that is pair 0 in that base pitch.
    """
    return pair_history_with(engagement, load, positions, cycle, _LOADS)[0]


def pair_history_with(
    engagement: Engagement, load: ArrayLike, positions: int, cycle: int, more: Callable[[Loaded], Array]
) -> tuple[PairHistory, Array]:
    """`pair_history`, and what else is known of the pair's loads, shape (P, L).

    Parameters
    ----------
    engagement, load, positions, cycle
        As for `pair_history`.
    more : callable
        ``more(loaded)`` -> that of all pairs at the roll positions of a state, shape (n, P, L).
    """
    found, further = followed(engagement, load, path_positions(engagement, positions), cycle, more)
    keep = _touched(engagement, found)
    return PairHistory(*(getattr(found, one.name)[keep] for one in fields(found))), further[keep]


def quick_history(engagement: Engagement, loaded: Loaded) -> PairHistory:
    """One tooth pair followed by a state over the base pitch, of gears whose teeth are alike: where each pair stands.

    Parameters
    ----------
    engagement : Engagement
    loaded : Loaded
        At roll positions with both sides of every jump.
    """
    contacts = loaded.grid.contacts
    first, last = _path(engagement)
    here = np.nonzero((contacts.x >= first) & (contacts.x <= last))
    here = tuple(one[np.argsort(contacts.x[here], kind="stable")] for one in here)
    load, deflection = loaded.loads[here], loaded.deflection[here]
    pressure = engagement.compliance.pressure(load, contacts.relative_radius[here][:, None])
    error = loaded.transmission_error[here[1]]
    found = PairHistory(
        contacts.x[here], contacts.roll_driver[here], load, load / loaded.load, deflection, pressure, error
    )
    keep = _touched(engagement, found)
    return PairHistory(*(getattr(found, one.name)[keep] for one in fields(found)))


def _path(engagement: Engagement) -> tuple[float, float]:
    """Ends of the path, and of what tip corners may add to it [m]."""
    pair, pitch = engagement.pair, engagement.pair.base_pitch
    before, after = 0.0, 0.0
    if engagement.corner_contact:
        before, after = (min(c.reach, pitch) for c in engagement.meshing.corners)
    return pair.x_start - before, pair.x_end + after


def _touched(engagement: Engagement, found: PairHistory) -> slice:
    """Positions from the last before a corner touches to the first after it has left; all where none can."""
    if not engagement.corner_contact:
        return slice(0, found.x.size)
    touched = np.flatnonzero((found.load > 0.0).any(axis=1))
    return slice(max(touched[0] - 1, 0), touched[-1] + 2) if touched.size else slice(0, 0)


def path_positions(engagement: Engagement, positions: int) -> Array:
    """Positions of a pair on its path, spread evenly, and two more on either side of every jump, ascending [m].

    Where tip corners may touch they begin before the path and end after it.
    """
    pitch = engagement.pair.base_pitch
    first, last = _path(engagement)
    places = [b + k * pitch for b in engagement.breaks for k in range(-2, 6)]
    near = BESIDE * pitch
    beside = [b + side for b in places if first + near < b < last - near for side in (-near, near)]
    return np.unique(np.concatenate([np.linspace(first, last, positions), beside]))


def followed(
    engagement: Engagement,
    load: ArrayLike,
    x: Array,
    cycle: int = 0,
    more: Callable[[Loaded], Array] = _LOADS,
    *,
    again: bool = True,
) -> tuple[PairHistory, Array]:
    """One tooth pair at positions of its own, shape (P,) [m], and what else is known of its loads, shape (P, L).

    Parameters
    ----------
    engagement, load, cycle, more
        As for `pair_history_with`.
    x : ndarray, shape (P,)
        On the path or where a tip corner may touch [m].
    again : bool
        Whether the same positions may be asked for again.
    """
    pair, pitch = engagement.pair, engagement.pair.base_pitch
    number = np.floor((x - pair.x_start) / pitch).astype(int)
    grid = engagement.grid(x - number * pitch, again=again)
    index = np.clip(number - grid.contacts.number[0], 0, grid.contacts.number.size - 1)
    here = (index, np.arange(x.size))
    loads = np.atleast_1d(np.asarray(load, dtype=float))
    picked = []
    uneven = engagement.uneven
    for k in np.unique(number) if uneven else (0,):
        # Pair j is on teeth cycle - j: this pair keeps its own teeth while the base pitches pass.
        rows = number == k if uneven else np.ones(x.size, dtype=bool)
        part = engagement.solve(
            grid if rows.all() else engagement.grid((x - number * pitch)[rows], again=again), loads, cycle + int(k)
        )
        picked.append((np.flatnonzero(rows), part, index[rows]))
    shape = (x.size, loads.size)
    w, u, te, further = (np.zeros(shape) for _ in range(4))
    for rows, part, which in picked:
        at = np.arange(rows.size)
        w[rows], u[rows] = part.loads[which, at], part.deflection[which, at]
        te[rows] = part.transmission_error
        further[rows] = more(part)[which, at]
    pressure = engagement.compliance.pressure(w, grid.contacts.relative_radius[here][:, None])
    return PairHistory(x, grid.contacts.roll_driver[here], w, w / loads, u, pressure, te), further
