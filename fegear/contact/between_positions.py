"""Where extreme values of a pair over its base pitches may stand between roll positions.

Transmission errors have kinks where tip edges come into contact (`likely_peaks`); secant stiffness jumps
there, at a place that only the loads know.
"""

from __future__ import annotations

import numpy as np

from fegear.base.arrays import Array

#: Places in each round for one curve's largest value.
_PLACES = 2
#: Positions nearer to each other than this share of a base pitch stand on both sides of a jump.
JUMP = 1e-5
#: Positions that peaks are looked for at stand this share of a base pitch from others, at least.
_APART = 1e-4
#: Positions of a round, at most about: those of many curves stand close together.
_MOST_PLACES = 64
#: What a curve changes between positions on both sides of a place, as a share of its range, where it does not jump.
_STEADY = 1e-3
#: Places in different base pitches that are the same, as a share of a base pitch.
_SAME = 1e-4
#: How much steeper than the curve on its higher side an interval is that may hide a jump.
_STEEPER = 3.0


def likely_peaks(x: Array, te: Array, period: float, jump_below: float | None = None) -> tuple[Array, Array]:
    """Where largest values may stand between positions, and by how much above all that are known.

    From either side of an interval the curve is taken to go on as straight as it came there. Where both meet stands a
    kink of straight pieces; but where a tip edge comes into contact the curve is the steeper the nearer, and the kink
    stands farther on its way to that end. Half of the way from the flatter side counts as possible.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Ascending within a period [m].
    te : ndarray, shape (P, L)
        [m].
    period : float
        [m].
    jump_below : float, optional
        Positions nearer to each other stand on both sides of a jump [m]. Default: `JUMP` of the period.

    Returns
    -------
    places : ndarray, shape (P, L, 2)
        Where to look, within the interval that begins at each position [m].
    height : ndarray, shape (P, L)
        [m]; negative where nothing is expected.
    """
    step = np.diff(x, append=x[0] + period)[:, None]
    rise = (np.roll(te, -1, axis=0) - te) / step
    ahead, behind = np.roll(rise, 1, axis=0), np.roll(rise, -1, axis=0)
    # Slopes across a jump tell nothing, and nothing stands within one.
    jump = step < (JUMP * period if jump_below is None else jump_below)
    known = ~(jump | np.roll(jump, 1, axis=0) | np.roll(jump, -1, axis=0))
    peaked = known & (ahead > rise) & (behind < rise)
    way = np.where(peaked, (rise - behind) * step / np.where(peaked, ahead - behind, 1.0), 0.0)
    half = 0.5 * step * np.where(ahead < -behind, ahead, -behind) + np.where(ahead < -behind, te, te + rise * step)
    height = np.where(peaked, np.maximum(te + ahead * way, half), -np.inf) - te.max(axis=0)
    farther = 0.5 * (way + np.where(ahead < -behind, step, 0.0))
    return x[:, None, None] + np.stack([way, farther], axis=2), height


def worth_a_look(x: Array, peaks: list[tuple[Array, Array]], period: float) -> Array:
    """Roll positions at which the likeliest peaks are looked for, ascending [m]."""
    wanted: list[float] = []
    for places, height in peaks:
        for case in range(height.shape[1]):
            likeliest = np.argsort(-height[:, case], kind="stable")[:_PLACES]
            wanted += places[likeliest, case][height[likeliest, case] > 0.0].ravel().tolist()
    # Peaks of many loads stand close together; what is left between places is stated.
    apart = _APART if len(wanted) <= _MOST_PLACES else 1.0 / _MOST_PLACES
    new: list[float] = []
    for one in sorted(wanted):
        known, found = (
            np.abs(np.mod(np.array(others) - one + 0.5 * period, period) - 0.5 * period).min(initial=period)
            for others in (x, new)
        )
        if known > _APART * period and found > apart * period:
            new.append(one)
    return np.array(new)


def between_positions(x: Array, values: Array, period: float, pitch: float) -> tuple[Array, Array]:
    """Where the largest of a curve may stand between positions, and by how much above all that are known.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Ascending within a period.
    values : ndarray, shape (P,)
    period : float
    pitch : float
        Base pitch.

    Returns
    -------
    places : ndarray, shape (Q, 1, 2)
        Where to look.
    height : ndarray, shape (Q, 1)
        Negative where nothing is expected.
    """
    same = np.abs(np.diff(values)) < _STEADY * np.ptp(values)
    kept = np.append(True, ~(same & (np.diff(x) < JUMP * pitch)))
    x, values = x[kept], values[kept]
    places, height = likely_peaks(x, values[:, None], period, JUMP * pitch)
    step = np.diff(x, append=x[0] + period)
    rise = (np.roll(values, -1) - values) / step
    jump = step < JUMP * pitch
    ahead = np.where(np.roll(jump, 1), 0.0, np.roll(rise, 1))
    behind = np.where(np.roll(jump, -1), 0.0, np.roll(rise, -1))
    # An interval that is much steeper than the curve on its higher side may hide a jump, up to which that side goes on:
    # no steeper than over its last two intervals, of which one may hide a jump itself.
    falls, rises = -rise > _STEEPER * np.abs(ahead), rise > _STEEPER * np.abs(behind)
    before, after = np.roll(ahead, 1), np.roll(behind, -1)
    up, down = np.maximum(np.minimum(ahead, before), 0.0), np.maximum(np.minimum(-behind, -after), 0.0)
    higher = np.where(falls, values + up * step, -np.inf)
    higher = np.where(rises, np.roll(values, -1) + down * step, higher) - values.max()
    higher = np.where(jump, -np.inf, higher)[:, None]
    halfway = (x + 0.5 * step)[:, None, None]
    return np.where((higher > height)[..., None], halfway, places), np.maximum(height, higher)


def folded(places: Array, height: Array, start: float, pitch: float) -> tuple[Array, Array]:
    """The same of all base pitches within one from `start` on: where they look at the same place, the highest only."""
    at = np.mod(places - start, pitch)
    order = np.argsort(-height[:, 0], kind="stable")
    _, first = np.unique(np.round(at[order, 0, 0] / (_SAME * pitch)), return_index=True)
    kept = order[first]
    return at[kept] + start, height[kept]
