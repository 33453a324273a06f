"""What dynamic increments tend to at low and at high frequency, for any gear train (Mark, 2.62 to 2.66).

Slowly a train turns as a rigid body, and what is left of Q_ij is its first power of s = i w: dampers give s, inertia
alone s^2, a locked power loop a constant. Fast, springs no longer hold the bodies: each turns as a free inertia under
the force of the teeth that press on it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.increments import dynamic_increments
from fegear.dynamics.modes import modes
from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array, Complex
    from fegear.dynamics.train import Train

#: How near to a whole power of the frequency an increment has to be where its first term is taken.
_WHOLE = 1e-6
#: Share of the lowest natural frequency where the search begins, by how much it goes down, and how often.
_FIRST, _DOWN, _STEPS = 1e-3, 1e-2, 12


def high_frequency_increments(train: Train, omega: ArrayLike) -> Complex:
    """Increments of a train whose bodies turn as free inertias (2.64, 2.66, for any train).

    Parameters
    ----------
    train : Train
    omega : array_like, shape (...)
        Angular frequency [rad/s], not zero.

    Returns
    -------
    ndarray, shape (meshes, meshes, ...)
        -1 for i = j, plus (1 + s c_i/k_i) k_j G_ij / s^2 with G_ij the approach of mesh i per second squared and unit
        force in mesh j; zero where two meshes share no body.
    """
    s = 1j * np.asarray(omega, dtype=float)
    k = np.array([mesh.stiffness for mesh in train.meshes])
    lag = np.array([mesh.damping for mesh in train.meshes]) / k
    share = (train.approach / train.inertia) @ train.approach.T * k
    wave = (1.0 + np.multiply.outer(lag, s))[:, None] / s**2
    own = np.eye(k.size).reshape(k.size, k.size, *(1,) * s.ndim)
    return np.asarray(share.reshape(*share.shape, *(1,) * s.ndim) * wave - own)


def low_frequency_terms(train: Train) -> tuple[Array, Array]:
    """First terms c s^p of every increment, s = i w.

    Each is read off where the increment follows a whole power of the frequency to `_WHOLE`; it has all its digits
    there, for increments are computed free of cancellation.

    Returns
    -------
    c : ndarray, shape (meshes, meshes)
        [s^p]; zero where mesh j does nothing to mesh i.
    p : ndarray of int, shape (meshes, meshes)

    Raises
    ------
    RangeError
        If some increment follows no power at any frequency that was tried.
    """
    lowest = modes(train).frequencies[1:]
    w = 2.0 * math.pi * (float(lowest.min()) if lowest.size else 1.0) * _FIRST
    for _ in range(_STEPS):
        q = dynamic_increments(train, np.array([w, 2.0 * w]))
        size = np.abs(q)
        coupled = size[..., 0] > 0.0
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.where(coupled, np.log2(size[..., 1] / size[..., 0]), 0.0)
        power = np.rint(slope)
        if np.all(np.abs(slope - power) < _WHOLE):
            c = np.where(coupled, (q[..., 0] / (1j * w) ** power).real, 0.0)
            return c, power.astype(int)
        w *= _DOWN
    raise RangeError(
        "frequency", f"{w / _DOWN / (2.0 * math.pi):.3g} Hz", "is not low enough for a low-frequency asymptote",
        "leave damping out that is next to nothing",
    )  # fmt: skip


def low_frequency_increments(train: Train, omega: ArrayLike) -> Complex:
    """First terms of every increment at angular frequencies [rad/s], shape (meshes, meshes, ...) (2.62, 2.65)."""
    s = 1j * np.asarray(omega, dtype=float)
    c, p = (part.reshape(*part.shape, *(1,) * s.ndim) for part in low_frequency_terms(train))
    return np.asarray(c * s**p)
