"""Traces measured at several torques, told apart by a column of the torque on the driver of their pair."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import percent

if TYPE_CHECKING:
    from fegear.base.arrays import Array


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
    mean, found = _over_pitch(torque, angle, pitch), {}
    nearest = np.argmin(np.abs(mean[:, None] - levels), axis=1)
    near = np.abs(mean - levels[nearest]) <= band * levels[nearest]
    for k in range(levels.size):
        on = np.concatenate([[False], near & (nearest == k), [False]])
        starts, stops = (np.flatnonzero(one) for one in (on[1:] & ~on[:-1], ~on[1:] & on[:-1]))
        if starts.size:
            longest = int(np.argmax(stops - starts))
            found[k] = slice(int(starts[longest]), int(stops[longest]))
    return found


def _over_pitch(torque: Array, angle: Array, pitch: float) -> Array:
    """Mean of the torque over a tooth pitch around each sample, shape (N,)."""
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


def said_of_pair(pair: str, levels: Array) -> str:
    """A pair with its torques [N m]."""
    return f"pair {pair} ({', '.join(f'{level:.5g}' for level in levels)} N m)"


def no_level(
    key: str, file: str, pair: str, torque: Array, levels: Array, ratio: float, part: TorqueColumn
) -> InputError:
    """The refusal of a trace that has no run of samples at one of the torques.

    Parameters
    ----------
    key, file, pair : str
    torque, levels : ndarray
        Of the samples, and those that are wanted [N m].
    ratio : float
        Teeth of the driven gear over those of the driver.
    part : TorqueColumn
    """
    low, high = (float(edge) for edge in np.percentile(torque, [5.0, 95.0]))
    remedy = of_driven(float(np.median(torque)), levels, ratio, part.torque_band)
    if high < 0.0:
        remedy = "specify positive torques"
    return InputError(
        key, f'"{file}"',
        f"has no run of samples within ±{percent(part.torque_band)} of a torque of {said_of_pair(pair, levels)}; its "
        f"column {part.torque_column} has {low:.4g} to {high:.4g} N m",
        remedy or f"add the measured torques to pair.{pair}.torques, or set torque_band",
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
