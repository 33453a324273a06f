"""Load over the face averaged over a base pitch: contact lines followed from one roll position to the next.

Contact lines bear more at their ends than in their middle, and the ends wander along the face as the gears turn. At a
fixed place of the face the load therefore comes and goes faster than roll positions follow; along a line it changes
slowly. So each line is carried over to the next position by its own length: its ends move evenly between them, and so
does the load between its ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.wide.lines import ContactLines

if TYPE_CHECKING:
    from fegear.base.arrays import Array


#: Places between two roll positions at which the lines are looked at.
_BETWEEN = 8


def load_below(place: Array, line_load: Array, ends: Array) -> Array:
    """Integral of loads, straight between their stations, up to some places, shape (*ends.shape, L).

    Parameters
    ----------
    place : ndarray, shape (n,)
        Stations, ascending.
    line_load : ndarray, shape (n, L)
        Per length along `place`.
    ends : ndarray
    """
    h = np.diff(place)
    whole = np.zeros_like(line_load)
    np.cumsum(0.5 * h[:, None] * (line_load[1:] + line_load[:-1]), axis=0, out=whole[1:])
    at = np.clip(ends, place[0], place[-1])
    i = np.clip(np.searchsorted(place, at, side="right") - 1, 0, h.size - 1)
    part = ((at - place[i]) / h[i])[..., None]
    return np.asarray(
        whole[i] + h[i][..., None] * part * (line_load[i] + 0.5 * part * (line_load[i + 1] - line_load[i]))
    )


def averaged_along(lines: ContactLines, line_load: Array, window: Array | None) -> Array:
    """Loads averaged along their lines as far to either side as a window is longer than a panel, shape (P, M, L).

    Mirrored at the ends of a line: an even load stays what it is, and so does the sum of any. Where panels are longer
    than the window, loads are what they are.

    Parameters
    ----------
    lines : ContactLines
    line_load : ndarray, shape (P, M, L)
        [N/m].
    window : ndarray, shape (P, M), or None
        The same all along a line [m].
    """
    if window is None:
        return line_load
    found = line_load.copy()
    for p in np.flatnonzero(((lines.panel > 0.0) & (lines.panel < window[:, :-1])).any(axis=1)).tolist():
        for s in lines.at(p):
            z, load = lines.z[p, s], line_load[p, s]
            reach = min(float(window[p, s.start] - np.diff(z).max()), float(z[-1] - z[0]))
            if reach <= 0.0:
                continue
            place = np.concatenate([2.0 * z[0] - z[:0:-1], z, 2.0 * z[-1] - z[-2::-1]])
            mirrored = np.concatenate([load[:0:-1], load, load[-2::-1]])
            above, below = (load_below(place, mirrored, z + side * reach) for side in (1.0, -1.0))
            found[p, s] = (above - below) / (2.0 * reach)
    return found


def swept_mean(lines: ContactLines, line_load: Array, ends: Array, pitch: float) -> Array:
    """Load of all lines together between heights, averaged over a base pitch, shape (n - 1, L) [N].

    Parameters
    ----------
    lines : ContactLines
        At roll positions of one base pitch, ascending.
    line_load : ndarray, shape (P, M, L)
        [N/m].
    ends : ndarray, shape (n,)
        Heights [m].
    pitch : float
        Base pitch [m].
    """
    count = lines.roll.size
    known = [{int(lines.pair[p, s.start]): s for s in lines.at(p)} for p in range(count)]
    total = np.zeros((ends.size, line_load.shape[2]))
    moving: list[tuple[float, tuple[int, slice], tuple[int, slice]]] = []
    for p in range(count):
        q, ahead = (p + 1) % count, (p + 1) // count
        step = float((lines.roll[q] + ahead * pitch - lines.roll[p]) / pitch)
        after = {j - ahead: s for j, s in known[q].items()}  # a base pitch on, every pair is where the one ahead was
        if known[p].keys() != after.keys():
            for where, spans in ((p, known[p]), (q, after)):
                for s in spans.values():
                    total += 0.5 * step * load_below(lines.z[where, s], line_load[where, s], ends)
            continue
        moving += [(step, (p, s), (q, after[j])) for j, s in known[p].items()]
    if moving:
        total += _moved(lines, line_load, ends, moving)
    return np.diff(total, axis=0)


def _moved(
    lines: ContactLines, line_load: Array, ends: Array, moving: list[tuple[float, tuple[int, slice], tuple[int, slice]]]
) -> Array:
    """Load below heights, averaged while lines move from where they are at one roll position to the next, (n, L) [N].

    Each is as far on its way as all others; on its length the load is that of both ends of the way in turn.
    """
    theta = ((np.arange(_BETWEEN) + 0.5) / _BETWEEN)[:, None]
    places: tuple[list[Array], list[Array]] = ([], [])
    loads: tuple[list[Array], list[Array]] = ([], [])
    low: tuple[list[float], list[float]] = ([], [])
    length: tuple[list[float], list[float]] = ([], [])
    for _, *both in moving:
        for end, (p, s) in enumerate(both):
            z = lines.z[p, s]
            low[end].append(z[0])
            length[end].append(z[-1] - z[0])
            places[end].append((z - z[0]) / (z[-1] - z[0]))
            loads[end].append(line_load[p, s] * (z[-1] - z[0]))
    (low_0, low_1), (length_0, length_1) = (np.array(one)[:, :, None, None] for one in (low, length))
    share = (ends - low_0 - theta * (low_1 - low_0)) / (length_0 + theta * (length_1 - length_0))
    before, behind = (_loads_below(place, load, share) for place, load in zip(places, loads, strict=True))
    step = np.array([one for one, *_ in moving])[:, None, None]
    way = theta[:, :, None]
    return np.asarray((step * ((1.0 - way) * before + way * behind).mean(axis=1)).sum(axis=0))


def _loads_below(place: list[Array], line_load: list[Array], ends: Array) -> Array:
    """`load_below` of K lines, each as far as its own places, shape (K, ...), on lines of length 1: (K, ..., L)."""
    sizes = np.array([one.size for one in place])
    first = np.cumsum(sizes) - sizes
    flat, load = np.concatenate(place), np.concatenate(line_load)
    h, two = np.diff(flat, append=np.nan), 0.5 * (load + np.roll(load, -1, axis=0))
    piece = h[:, None] * two
    piece[first + sizes - 1] = 0.0  # from one line to the next
    whole = np.concatenate([np.zeros((1, load.shape[1])), np.cumsum(piece, axis=0)[:-1]])
    which = np.arange(sizes.size).reshape(-1, *[1] * (ends.ndim - 1))
    at = np.clip(ends, 0.0, 1.0)
    # Lines stand one behind the other, two lengths apart; a station missed by rounding changes nothing of the integral.
    i = np.searchsorted(flat + 2.0 * np.repeat(np.arange(sizes.size), sizes), at + 2.0 * which, side="right") - 1
    i = np.clip(i, first[which], (first + sizes - 2)[which])
    part = ((at - flat[i]) / h[i])[..., None]
    below = whole[i] - whole[first[which]]
    return np.asarray(below + h[i][..., None] * part * (load[i] + 0.5 * part * (load[i + 1] - load[i])))
