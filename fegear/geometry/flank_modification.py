"""Flank modifications in two dimensions: over the roll angle and over the face (ISO 21771, twist: VDI/VDE 2612).

The removal is measured in the section across the axis along the normal of the involute, as profile and helix charts
show it, in metres; positive removes material. Heights count from the middle of the gear's own face along the axes of
its pair, from end I at -b/2 to end II at +b/2: the end from which the loaded flank is seen as the right one of an
upright tooth, the driver turning clockwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.errors import InputError

FaceEnd = Literal["I", "II", "both"]


class FlankModification(Protocol):
    """Removal of material over a flank."""

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """Heights [m] where the removal's slope along the face jumps; none unless one says so."""
        return ()

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Material removed [m] at roll angles [rad] and heights [m]."""


@dataclass(frozen=True, slots=True)
class LeadCrowning(FlankModification):
    """Lead crowning C_beta: a parabola over the face, zero in the middle and `amount` at both ends.

    Parameters
    ----------
    amount : float
        [m].
    face_width : float
        [m].
    """

    amount: float
    face_width: float

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Amount times the square of the height over half the face."""
        return np.asarray(self.amount * _over_half(self.face_width, roll, z) ** 2)


@dataclass(frozen=True, slots=True)
class HelixSlope(FlankModification):
    """Helix slope modification C_Hbeta: from 0 at end I to `amount` at end II, straight."""

    amount: float
    face_width: float

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Amount times the share of the face below."""
        return np.asarray(0.5 * self.amount * (1.0 + _over_half(self.face_width, roll, z)))


@dataclass(frozen=True, slots=True)
class LeadEndRelief:
    """End relief C_betaI, C_betaII: nothing inside, growing over its length to `amount` at the end of the face.

    Parameters
    ----------
    amount, length : float
        At the end, and along the face [m].
    face_width : float
        [m].
    end : {"I", "II", "both"}
    power : float
        1 for linear, 2 for parabolic relief.

    Raises
    ------
    InputError
        If it is longer than the face.
    """

    amount: float
    length: float
    face_width: float
    end: FaceEnd = "both"
    power: float = 1.0

    def __post_init__(self) -> None:
        """Refuse reliefs that are no part of the face."""
        if not 0.0 < self.length <= self.face_width * (1.0 + 1e-9):
            raise InputError(
                "lead.end_relief.length", f"{self.length * 1e3:.6g} mm",
                f"must be above 0 and at most the face width {self.face_width * 1e3:.6g} mm",
            )  # fmt: skip

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """Where it starts."""
        start = 0.5 * self.face_width - self.length
        return tuple(side * start for side in self._sides)

    @property
    def _sides(self) -> tuple[float, ...]:
        return {"I": (-1.0,), "II": (1.0,), "both": (-1.0, 1.0)}[self.end]

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Amount ((|z| - start)/length)^power beyond the start."""
        at, start = np.broadcast_arrays(z, roll)[0], 0.5 * self.face_width - self.length
        parts = [np.maximum((side * at - start) / self.length, 0.0) ** self.power for side in self._sides]
        return np.asarray(self.amount * np.sum(parts, axis=0))


@dataclass(frozen=True)
class LeadTable(ReadOnlyArrays):
    """A lead modification point by point, straight between; beyond its ends it stays as it is there.

    Parameters
    ----------
    z, values : ndarray, shape (n,)
        Ascending heights and removals [m].
    """

    z: Array
    values: Array

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """The entries."""
        return tuple(self.z.tolist())

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Interpolate over the height."""
        return np.interp(np.broadcast_arrays(z, roll)[0], self.z, self.values)


@dataclass(frozen=True, slots=True)
class Bias(FlankModification):
    """Twist of the flank: the profile slope at end II less that at end I is `amount`, C_Halpha turning with the face.

    Twist S_alpha = S_beta of VDI/VDE 2612: removal = amount (roll coordinate)(face coordinate), both from -1/2 to 1/2
    between `start` and `end` and over the face. Positive takes material from the tip at end II and the root at end I.

    Parameters
    ----------
    amount : float
        [m].
    start, end : float
        Roll angles between which the profile slope is measured [rad].
    face_width : float
        [m].
    """

    amount: float
    start: float
    end: float
    face_width: float

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Product of both coordinates."""
        along = (np.asarray(roll, dtype=float) - 0.5 * (self.start + self.end)) / (self.end - self.start)
        return np.asarray(0.5 * self.amount * along * _over_half(self.face_width, roll, z))


@dataclass(frozen=True)
class Topography(ReadOnlyArrays):
    """A removal on a grid of roll angles and heights, bilinear between; held at its ends beyond them.

    Parameters
    ----------
    roll, z : ndarray, shape (m,), (n,)
        Ascending, two or more of each [rad], [m].
    values : ndarray, shape (m, n)
        [m].

    Raises
    ------
    InputError
        If it is no such grid.
    """

    roll: Array
    z: Array
    values: Array

    def __post_init__(self) -> None:
        """Refuse what is no grid."""
        ReadOnlyArrays.__post_init__(self)
        if min(self.roll.size, self.z.size) < 2 or self.values.shape != (self.roll.size, self.z.size):
            raise InputError("topography", f"{self.values.shape} removals", "must be a grid of at least 2 x 2")
        if not all(np.isfinite(a).all() for a in (self.roll, self.z, self.values)):
            raise InputError("topography", "an entry", "must be finite")
        if (np.diff(self.roll) <= 0.0).any() or (np.diff(self.z) <= 0.0).any():
            raise InputError("topography", "its grid", "must be strictly increasing")

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """The grid's heights."""
        return tuple(self.z.tolist())

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """Interpolate in both directions."""
        (i, s), (k, t) = _place(self.roll, roll), _place(self.z, z)
        v = self.values
        low = v[i, k] + t * (v[i, k + 1] - v[i, k])
        return np.asarray(low + s * (v[i + 1, k] + t * (v[i + 1, k + 1] - v[i + 1, k]) - low))


@dataclass(frozen=True, slots=True)
class MirroredModification(FlankModification):
    """A modification seen in a mirror at the middle of the face: that of the half of the other hand."""

    of: FlankModification

    @property
    def face_kinks(self) -> tuple[float, ...]:
        """On the other side of the middle."""
        return tuple(-kink for kink in reversed(self.of.face_kinks))

    def removal(self, roll: ArrayLike, z: ArrayLike) -> Array:
        """What is removed at the opposite height."""
        return self.of.removal(roll, -np.asarray(z, dtype=float))


def _place(grid: Array, at: ArrayLike) -> tuple[Array, Array]:
    """Number of the piece that a value lies in, and how far along, 0 to 1."""
    inside = np.clip(np.asarray(at, dtype=float), grid[0], grid[-1])
    i = np.clip(np.searchsorted(grid, inside, side="right") - 1, 0, grid.size - 2)
    return i, (inside - grid[i]) / (grid[i + 1] - grid[i])


def _over_half(face_width: float, roll: ArrayLike, z: ArrayLike) -> Array:
    """Height over half the face, of the common shape."""
    if not (math.isfinite(face_width) and face_width > 0.0):
        raise InputError("face_width", face_width, "must be positive and finite")
    return np.asarray(np.broadcast_arrays(z, roll)[0] / (0.5 * face_width))
