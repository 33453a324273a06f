"""Traces of encoders over torque: which torque, or one scale, explains their size; whether one filter their shape."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures, in_words, percents

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array

#: Logarithm of a torque over the last of those computed up to which a line through the last two goes on.
_BEYOND = 0.25
#: Ratios of measured to computed, or of torques, that differ by less than this are one.
_ONE = 0.02
#: Times by which time constants of one filter, found at several torques, differ at most.
_ONE_FILTER = 1.6


def torque_of_gain(torques: Array, gains: Array, near: float) -> float | None:
    """The torque at which a measured transmission error is the computed one; None for none about those computed.

    Parameters
    ----------
    torques : ndarray, shape (L,)
        Of the computed ones [N m], ascending.
    gains : ndarray, shape (L,)
        Measured / computed at each of them.
    near : float
        Torque of the trace: of several the nearest to it.
    """
    if torques.size < 2 or not (gains > 0.0).all():
        return None
    off, place = np.log(gains), np.log(torques)  # of unmodified teeth the gain is about one over the torque
    for end, beside in ((0, 1), (-1, -2)):
        slope = (off[end] - off[beside]) / (place[end] - place[beside])
        step = -_BEYOND if end == 0 else _BEYOND
        at = 0 if end == 0 else place.size
        place, off = np.insert(place, at, place[end] + step), np.insert(off, at, off[end] + slope * step)
    crossed = np.flatnonzero((off[:-1] * off[1:] <= 0.0) & (off[:-1] != off[1:]))
    found = [place[k] - off[k] * (place[k + 1] - place[k]) / (off[k + 1] - off[k]) for k in crossed]
    return float(np.exp(min(found, key=lambda one: abs(one - np.log(near))))) if found else None


def common_cause(torques: Array, gains: Array, needed: Sequence[float | None]) -> str:
    """One cause of differences of size at all of several torques, a clause; empty for none.

    Parameters
    ----------
    torques, gains : ndarray, shape (L,)
        Of the traces [N m], and measured / computed.
    needed : sequence of float or None
        Torques at which the computed transmission error is the measured one [N m].
    """
    ratios = np.array([torque / own for own, torque in zip(torques, needed, strict=True) if torque])
    all_torques = "both torques" if torques.size == 2 else f"all {in_words(torques.size)} torques"
    said = []
    if np.ptp(gains) <= _ONE * gains.mean():
        said.append(
            f"measured / computed is the same at {all_torques}, {figures(float(gains.mean()))}, as of the scale of the "
            "trace (radius by which an angle was converted) or of the stiffness (face width, material)"
        )
    if ratios.size == gains.size and np.ptp(ratios) <= _ONE * ratios.mean():
        off = ratios.mean() - 1.0
        said.append(
            f"a torque {percents(abs(float(off)), abs(float(off)))} {'higher' if off > 0.0 else 'lower'} would explain "
            f"{'it as well' if said else all_torques}"
        )
    return "; ".join(said)


def one_filter(lags: Sequence[float | None]) -> bool:
    """Whether traces of one rig, which has one filter, are behind it.

    Parameters
    ----------
    lags : sequence of float or None
        Time constants that each seems to have, at equal speed; None for none.
    """
    found = [lag for lag in lags if lag is not None]
    return 2 * len(found) >= len(lags) > 0 and max(found) <= _ONE_FILTER * min(found)
