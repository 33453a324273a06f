"""Where dynamic increments have their peaks: maxima of |Q_ij| over frequency, refined between those asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.dynamics.train.increments import dynamic_increments

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Complex
    from fegear.dynamics.train.train import Train

#: Relative accuracy of a peak's frequency.
_FINE = 1e-7
#: Points into which the space about a peak is divided at a time.
_POINTS = 9
#: Steps of the search: each leaves a quarter of the space.
_STEPS = 40


@dataclass(frozen=True, slots=True)
class IncrementPeak:
    """A maximum of |Q_ij|: the meshes i and j, frequency [Hz] and modulus."""

    mesh: int
    source: int
    frequency: float = shown("Hz", "frequency of the maximum modulus", name="resonance")
    modulus: float = shown("", "there")


def increment_peaks(train: Train, omega: Array, increments: Complex) -> tuple[IncrementPeak, ...]:
    """Find the maxima of every |Q_ij| that the frequencies show, to `_FINE`, by frequency.

    Parameters
    ----------
    train : Train
    omega : ndarray, shape (F,)
        Rising angular frequencies [rad/s].
    increments : ndarray, shape (meshes, meshes, F)
        Q_ij there.

    Returns
    -------
    tuple of IncrementPeak
        None without any damping, where the peaks are the natural frequencies and have no height.
    """
    dampings = [
        *(shaft.damping for shaft in train.shafts), *(mesh.damping for mesh in train.meshes),
        *(damper.damping for damper in train.dampers),
    ]  # fmt: skip
    if not any(dampings):
        return ()
    found: list[IncrementPeak] = []
    for i, j in np.ndindex(*increments.shape[:2]):
        size = np.abs(increments[i, j])
        highest = np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:])) + 1
        found += [_refined(train, i, j, float(omega[k - 1]), float(omega[k + 1])) for k in highest]
    return tuple(found)


def _refined(train: Train, i: int, j: int, low: float, high: float) -> IncrementPeak:
    """Narrow the space about a maximum: of evenly spaced points the largest and its neighbours remain."""
    at, modulus = 0.5 * (low + high), 0.0
    for _ in range(_STEPS):
        omega = np.linspace(low, high, _POINTS)
        try:
            size = np.abs(dynamic_increments(train, omega, [j])[i, 0])
        except RangeError:  # a mode that nothing damps has no height
            break
        k = int(np.argmax(size))
        at, modulus = float(omega[k]), float(size[k])
        low, high = float(omega[max(k - 1, 0)]), float(omega[min(k + 1, _POINTS - 1)])
        if high - low <= _FINE * at:
            break
    return IncrementPeak(i, j, at / (2.0 * math.pi), modulus)
