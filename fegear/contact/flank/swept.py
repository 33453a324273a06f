"""Load over the face averaged over a base pitch: contact lines followed from one roll position to the next.

Contact lines bear more at their ends than in their middle, and the ends wander along the face as the gears turn. At a
fixed place of the face the load therefore comes and goes faster than roll positions follow; along a line it changes
slowly. So each line is carried over to the next position by its own length: its ends move evenly between them, and so
does the load between its ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact.flank.lines import ContactLines

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
    theta = ((np.arange(_BETWEEN) + 0.5) / _BETWEEN)[:, None]
    for p in range(count):
        q, ahead = (p + 1) % count, (p + 1) // count
        step = (lines.roll[q] + ahead * pitch - lines.roll[p]) / pitch
        after = {j - ahead: s for j, s in known[q].items()}  # a base pitch on, every pair is where the one ahead was
        if known[p].keys() != after.keys():
            for where, spans in ((p, known[p]), (q, after)):
                for s in spans.values():
                    total += 0.5 * step * load_below(lines.z[where, s], line_load[where, s], ends)
            continue
        for j, s in known[p].items():
            (low, length, first), (low_, length_, second) = (
                _along(lines.z[where, span], line_load[where, span]) for where, span in ((p, s), (q, after[j]))
            )
            share = (ends - low - theta * (low_ - low)) / (length + theta * (length_ - length))
            before, behind = load_below(*first, share), load_below(*second, share)
            total += step * ((1.0 - theta)[:, :, None] * before + theta[:, :, None] * behind).mean(axis=0)
    return np.diff(total, axis=0)


def _along(z: Array, line_load: Array) -> tuple[float, float, tuple[Array, Array]]:
    """Lower end and length of a line [m]; its stations as shares of the length, and the load per share [N]."""
    length = float(z[-1] - z[0])
    return float(z[0]), length, ((z - z[0]) / length, line_load * length)
