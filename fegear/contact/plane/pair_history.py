"""One tooth pair followed over the path of contact: what the load-sharing table shows.

Where curves over a base pitch are largest, found closer than the samples that they were looked at.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.transmission_error import BESIDE


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
    driver_roll_angle: Array = shown("deg", "of the contact point on the driver", name="roll_angle", table="path")
    load: Array = shown("N", "on the pair along the line of action", label="load on the pair", table="path")
    share: Array = shown("", "of the total load", table="path")
    deflection: Array = shown("um", "of both teeth and their contact", table="path")
    hertz_pressure: Array = shown(
        "MPa", "largest pressure of smooth flanks", label="largest Hertzian pressure", table="path"
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
    return pair_history_with(engagement, load, positions, cycle, lambda state: state.loads)[0]


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
    pair, pitch = engagement.pair, engagement.pair.base_pitch
    before, after = 0.0, 0.0
    if engagement.corner_contact:
        before, after = (min(c.reach, pitch) for c in engagement.meshing.corners)
    first, last = pair.x_start - before, pair.x_end + after
    places = [b + k * pitch for b in engagement.breaks for k in range(-2, 6)]
    near = BESIDE * pitch
    beside = [b + side for b in places if first + near < b < last - near for side in (-near, near)]
    x = np.unique(np.concatenate([np.linspace(first, last, positions), beside]))
    number = np.floor((x - pair.x_start) / pitch).astype(int)
    grid = engagement.grid(x - number * pitch)
    index = np.clip(number - grid.contacts.number[0], 0, grid.contacts.number.size - 1)
    here = (index, np.arange(x.size))
    loads = np.atleast_1d(np.asarray(load, dtype=float))
    picked = []
    uneven = engagement.driver_spacing.size or engagement.driven_spacing.size
    for k in np.unique(number) if uneven else (0,):
        # Pair j is on teeth cycle - j: this pair keeps its own teeth while the base pitches pass.
        rows = number == k if uneven else np.ones(x.size, dtype=bool)
        part = engagement.solve(
            grid if rows.all() else engagement.grid((x - number * pitch)[rows]), loads, cycle + int(k)
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
    touched = np.flatnonzero((w > 0.0).any(axis=1))
    keep = slice(max(touched[0] - 1, 0), touched[-1] + 2) if touched.size else slice(0, 0)
    if not engagement.corner_contact:
        keep = slice(0, x.size)
    roll = grid.contacts.roll_driver[here]
    found = PairHistory(x[keep], roll[keep], w[keep], (w / loads)[keep], u[keep], pressure[keep], te[keep])
    return found, further[keep]


#: A local maximum of the samples may lead to the largest value of a stress where it lacks no more than this part of it.
LACKS = 0.05


#: Local maxima of one curve that are followed.
_FOLLOWED = 4


#: Each pass puts so many points on either side of a maximum's largest sample, and narrows its bracket as much and once.
_POINTS = 4


#: Five passes leave 3e-4 of the distance of two samples: at a kink, where a tip corner takes over from a tooth pair,
#: the error of a peak is in proportion to what is left.
_PASSES = 5


def refined_peaks(
    curves: Callable[[Array], Array],
    x: Array,
    lacks: float = LACKS,
    followed: int = _FOLLOWED,
    passes: int = _PASSES,
) -> tuple[Array, Array]:
    """Follow the largest value of each curve between the samples, through smooth maxima, kinks and up to jumps.

    A tooth's stress peaks where another pair begins to bear, at a kink that moves with the load and with every effect:
    samples that are a hundredth of the base pitch apart miss it by up to a percent, and the difference of two such
    maxima is then the samples' and not the effect's.

    Parameters
    ----------
    curves : callable
        Positions, shape (P,), to the values of all curves, shape (C, P).
    x : ndarray, shape (P,)
        Samples, ascending, with both sides of every jump among them.
    lacks : float
        Part of the largest sample by which others may be lower whose neighbourhood is looked at.
    followed : int
        Local maxima of one curve that are followed at most, the highest samples first.
    passes : int
        Each leaves a fifth of the distance between two samples.

    Returns
    -------
    at, largest : ndarray, shape (C,)
        Where each curve is largest, and its value there.
    """
    sampled = curves(x)
    peak = sampled.max(axis=1)
    padded = np.pad(sampled, ((0, 0), (1, 1)), constant_values=-np.inf)
    local = (
        (sampled >= padded[:, :-2]) & (sampled >= padded[:, 2:]) & (sampled >= (peak - lacks * np.abs(peak))[:, None])
    )
    starts: list[tuple[int, int]] = []
    for c, row in enumerate(local):
        several = np.flatnonzero(row)
        starts += [(c, i) for i in several[np.argsort(-sampled[c, several], kind="stable")[:followed]]]
    curve, middle = np.array(starts).T
    low, at, high = x[np.maximum(middle - 1, 0)], x[middle], x[np.minimum(middle + 1, x.size - 1)]
    value, every = sampled[curve, middle], np.arange(curve.size)
    inside = np.arange(1, _POINTS + 1)[:, None] / (_POINTS + 1)
    for _ in range(passes):
        places = np.concatenate([low[None], low + inside * (at - low), at[None], at + inside * (high - at), high[None]])
        new = np.concatenate([places[1 : _POINTS + 1], places[_POINTS + 2 : -1]])
        found = curves(new.ravel())[np.tile(curve, new.shape[0]), np.arange(new.size)].reshape(new.shape)
        ends = np.full((1, curve.size), -np.inf)
        values = np.concatenate([ends, found[:_POINTS], value[None], found[_POINTS:], ends])
        best = values.argmax(axis=0)
        low, at, high, value = (
            places[best - 1, every],
            places[best, every],
            places[best + 1, every],
            values[best, every],
        )
    order = np.lexsort((value, curve))
    last = order[np.append(np.diff(curve[order]) != 0, True)]
    return at[last], value[last]
