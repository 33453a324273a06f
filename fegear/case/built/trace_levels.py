"""Traces measured at several torques, told apart by a column of the torque on the driver of their pair."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import percent

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array

#: Part of the band by which means of half a turn may differ along a plateau.
_STEADY = 0.25


class TorqueColumn(Protocol):
    """What a case says of the column."""

    torque_column: str
    torque_band: float


def torque_levels(torque: Array, angle: Array, pitch: float, levels: Array, band: float) -> dict[int, slice]:
    """The longest run of samples at each torque that was measured, by the number of the level.

    The torque of a sample is the mean over a tooth pitch around it, which sheds what the mesh and noise add.

    Parameters
    ----------
    torque, angle : ndarray, shape (N,)
        [N m], [rad].
    pitch : float
        Of the teeth [rad].
    levels : ndarray, shape (L,)
        [N m].
    band : float
        Relative deviation from a level within which samples belong to it.
    """
    mean, found = over_pitch(torque, angle, pitch), {}
    nearest = np.argmin(np.abs(mean[:, None] - levels), axis=1)
    near = np.abs(mean - levels[nearest]) <= band * levels[nearest]
    for k in range(levels.size):
        on = np.concatenate([[False], near & (nearest == k), [False]])
        starts, stops = (np.flatnonzero(one) for one in (on[1:] & ~on[:-1], ~on[1:] & on[:-1]))
        if starts.size:
            longest = int(np.argmax(stops - starts))
            found[k] = slice(int(starts[longest]), int(stops[longest]))
    return found


def over_pitch(torque: Array, angle: Array, pitch: float) -> Array:
    """Mean of the torque, or of another quantity, over a tooth pitch [rad] around each sample, shape (N,)."""
    step = float(np.median(np.abs(np.diff(angle)))) if angle.size > 1 else 0.0
    window = min(max(int(pitch / step) if step > 0.0 else 1, 1), torque.size)
    total, at = np.concatenate([[0.0], np.cumsum(torque)]), np.arange(torque.size)
    low, high = np.maximum(at - window // 2, 0), np.minimum(at - window // 2 + window, torque.size)
    return np.asarray((total[high] - total[low]) / (high - low))


def change_along(torque: Array) -> float:
    """Change from first to last sample by the line of least squares, over the mean: of a ramp twice its band."""
    along = np.linspace(-0.5, 0.5, torque.size)
    size = float(along @ along)
    return float(along @ torque) / size / float(torque.mean()) if size else 0.0


def plateaus(torque: Array, angle: Array, band: float) -> list[tuple[float, slice]]:
    """Stretches of a turn or more along which the torque is steady, with its mean [N m], in the order of the trace.

    Steady is where the means of half a turn before and after a sample differ by less than a part of the band. Ramps
    that need many turns are no plateaus either, by their change along them.

    Parameters
    ----------
    torque, angle : ndarray, shape (N,)
        [N m], [rad].
    band : float
        Relative.
    """
    step = float(np.median(np.abs(np.diff(angle)))) if angle.size > 1 else 0.0
    turn = round(2.0 * np.pi / step) if step > 0.0 else 0
    half = turn // 2
    if half < 1 or torque.size < turn:
        return []
    total = np.concatenate([[0.0], np.cumsum(torque)])
    at = np.arange(half, torque.size - half + 1)
    change = (total[at + half] - 2.0 * total[at] + total[at - half]) / half
    around = np.abs(total[at + half] - total[at - half]) / (2.0 * half)
    largest = float(np.abs(torque).max())
    steady = np.concatenate([[False], np.abs(change) <= _STEADY * band * around, [False]])
    starts, stops = (np.flatnonzero(one) for one in (steady[1:] & ~steady[:-1], ~steady[1:] & steady[:-1]))
    found = []
    for first, last in zip(at[0] + starts, at[0] + stops - 1, strict=True):
        run = slice(int(first - half), int(last + half))
        mean = float(torque[run].mean())
        if abs(mean) > band * largest and abs(change_along(torque[run])) <= band:
            found.append((mean, run))
    return found


def said_of_rest(
    torque: Array, angle: Array, taken: Sequence[slice], levels: Array, band: float, pair: str
) -> list[str]:  # fmt: skip
    """Samples of a file that no torque of its pair takes, and what to do to compare them; empty for none.

    Parameters
    ----------
    torque, angle : ndarray, shape (N,)
        [N m], [rad].
    taken : sequence of slice
    levels : ndarray, shape (L,)
        Torques of the pair [N m].
    band : float
    pair : str
    """
    rest = torque.size - sum(run.stop - run.start for run in taken)
    if not rest:
        return []
    steady = [one for one in plateaus(torque, angle, band) if not any(_overlap(one[1], run) for run in taken)]
    known = [np.abs(mean / levels - 1.0).min() <= band for mean, _ in steady]
    others = _named([mean for (mean, _), near in zip(steady, known, strict=True) if not near], band)
    again = _named([mean for (mean, _), near in zip(steady, known, strict=True) if near], band)
    more = [f"steady at {', '.join(others)} N m: add to pair.{pair}.torques to compare them"] if others else []
    more += [f"shorter runs at {', '.join(again)} N m"] if again else []
    return [f"{rest} samples at other torques left out" + (f" ({'; '.join(more)})" if more else "")]


def _named(torques: Sequence[float], band: float) -> list[str]:
    """Torques, ascending, those within a band of each other once."""
    found: list[list[float]] = []
    for torque in sorted(torques):
        if found and abs(torque - found[-1][0]) <= band * abs(torque):
            found[-1].append(torque)
        else:
            found.append([torque])
    return [f"{sum(one) / len(one):.3g}" for one in found]


def _overlap(one: slice, other: slice) -> bool:
    return one.start < other.stop and other.start < one.stop


def said_of_pair(pair: str, levels: Array) -> str:
    """A pair with its torques [N m]."""
    return f"pair {pair} ({', '.join(f'{level:.5g}' for level in levels)} N m)"


def no_level(
    key: str, file: str, pair: str, torque: Array, angle: Array, levels: Array, ratio: float, part: TorqueColumn
) -> InputError:
    """The refusal of a trace that has no run of samples at one of the torques.

    Parameters
    ----------
    key, file, pair : str
    torque, angle : ndarray, shape (N,)
        Of the samples [N m], [rad].
    levels : ndarray, shape (L,)
        Torques that are wanted [N m].
    ratio : float
        Teeth of the driven gear over those of the driver.
    part : TorqueColumn
    """
    low, high = (float(edge) for edge in np.percentile(torque, [5.0, 95.0]))
    steady = _named([mean for mean, _ in plateaus(torque, angle, part.torque_band) if mean > 0.0], part.torque_band)
    written = ", ".join(f'"{one} N*m"' for one in steady)
    remedy = of_driven(float(np.median(torque)), levels, ratio, part.torque_band)
    if high < 0.0:
        remedy = "specify positive torques"
    return InputError(
        key, f'"{file}"',
        f"has no run of samples within ±{percent(part.torque_band)} of a torque of {said_of_pair(pair, levels)}; its "
        f"column {part.torque_column} has {low:.4g} to {high:.4g} N m",
        remedy or f"add the measured torques to pair.{pair}.torques{f' ([{written}])' if steady else ''}, or set "
        "torque_band",
    )  # fmt: skip


def of_driven(torque: float, known: Array, ratio: float, band: float) -> str:
    """What to do where a torque [N m] is one of the pair's on the driven shaft; empty where it is none."""
    near = float(known[np.argmin(np.abs(known * ratio - torque))]) if known.size else 0.0
    if not near or abs(torque - near * ratio) > band * near * ratio:
        return ""
    return (
        f"specify torques of the driver: {torque:.5g} N*m on the driven gear is {torque / ratio:.5g} N*m (divided by "
        f"the ratio {ratio:.5g})"
    )
