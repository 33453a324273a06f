"""Pressed bands on the twisted flank: a semi-elliptic pressure up the flank times a profile along the face."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.errors import RangeError
from fegear.fem.solid.settings import whole
from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.trace import LoadedFlank

Profile = Literal["hat", "even"]
#: Ends of a band this near to an end face, as a share of the width, lie on it.
_ON_FACE = 1e-9


@dataclass(frozen=True)
class Bands(ReadOnlyArrays):
    """Bands that carry a unit force each, along the transverse line of action.

    Parameters
    ----------
    radius : ndarray, shape (P,)
        Where the middle of each band lies on the flank [modules].
    zeta : ndarray, shape (P,)
        Where it lies along the face, 0 in the middle of the width [modules].
    before, after : ndarray, shape (P,)
        How far it reaches toward -z and +z [modules]; one of both may be 0.
    half_width : ndarray, shape (P,)
        Half-width of the pressure up the flank, in the transverse section [modules].
    slope : ndarray, shape (P,)
        Arc length up the flank per length along the face at which the band runs: that of the contact line.
    profile : {"hat", "even"}
        Along the face: falling linearly to both ends, or constant.
    """

    radius: Array
    zeta: Array
    before: Array
    after: Array
    half_width: Array
    slope: Array
    profile: Profile = "hat"

    @property
    def count(self) -> int:
        """Number of bands."""
        return int(self.radius.size)

    @cached_property
    def is_chain(self) -> bool:
        """Whether each band falls to the next ones, as those of `hats`."""
        step = np.diff(self.zeta)
        return self.profile == "hat" and bool((self.after[:-1] == step).all() and (self.before[1:] == step).all())

    def part(self, span: slice) -> Bands:
        """Some of the bands."""
        return Bands(
            self.radius[span], self.zeta[span], self.before[span], self.after[span], self.half_width[span],
            self.slope[span], self.profile,
        )  # fmt: skip


def bands(
    radius: ArrayLike,
    zeta: ArrayLike,
    reach: ArrayLike,
    half_width: ArrayLike,
    *,
    after: ArrayLike | None = None,
    slope: ArrayLike = 0.0,
    profile: Profile = "hat",
) -> Bands:
    """Bands from anything that broadcasts together.

    Parameters
    ----------
    radius, zeta : array_like
        [modules].
    reach : array_like
        How far they reach toward -z, and toward +z unless `after` is given [modules].
    half_width : array_like
        [modules].
    after, slope, profile
        See `Bands`.
    """
    parts = (radius, zeta, reach, reach if after is None else after, half_width, slope)
    flat = [np.array(x).ravel() for x in np.broadcast_arrays(*(np.asarray(part, dtype=float) for part in parts))]
    return Bands(flat[0], flat[1], flat[2], flat[3], flat[4], flat[5], profile)


def hats(radius: ArrayLike, stations: ArrayLike, half_width: ArrayLike, *, slope: ArrayLike = 0.0) -> Bands:
    """Hats on a chain of stations along the face, each falling to its neighbours; half hats at both ends.

    Parameters
    ----------
    radius : array_like, shape (P,) or ()
        Of the stations [modules].
    stations : array_like, shape (P,)
        Ascending [modules].
    half_width, slope : array_like, shape (P,) or ()
    """
    z = np.asarray(stations, dtype=float)
    steps = np.diff(z)
    return bands(
        radius, z, np.concatenate([[0.0], steps]), half_width, after=np.concatenate([steps, [0.0]]), slope=slope
    )


def loads_of(pressed: Bands, flank: LoadedFlank, face: FaceFunctions) -> Array:
    """Loads on the flank's ports, shape (nodes * functions, P), node by node; as a left factor the mean deflection.

    Raises
    ------
    RangeError
        If a band reaches over an end face, has no extent or no width, or is wider than the flank.
    """
    _check(pressed, flank, face)
    arc = flank.arc_of_radius(pressed.radius)
    z, weight = _gauss(pressed, face)
    shape = face.values(z.ravel()).reshape(face.count, *z.shape)
    if not pressed.slope.any():
        along = np.einsum("kpq,pq->kp", shape, weight)
        up = flank.normal_patches(arc, pressed.half_width)
        return np.asarray(np.einsum("np,kp->nkp", up, along).reshape(-1, pressed.count))
    a = np.broadcast_to(pressed.half_width[:, None], z.shape)
    place = np.clip(arc[:, None] + pressed.slope[:, None] * (z - pressed.zeta[:, None]), *_room(flank, a))
    up = flank.normal_patches(place.ravel(), a.ravel()).reshape(flank.nodes, *z.shape)
    loads = np.einsum("npq,kpq->nkp", up, shape * weight, optimize=True)
    return np.asarray(loads.reshape(-1, pressed.count))


def profile_moments(pressed: Bands, face: FaceFunctions) -> Array:
    """Integrals of the bands' profiles times the functions along the face, shape (functions, P)."""
    z, weight = _gauss(pressed, face)
    shape = face.values(z.ravel()).reshape(face.count, *z.shape)
    return np.asarray(np.einsum("kpq,pq->kp", shape, weight))


def profiles_at(pressed: Bands, zeta: Array) -> Array:
    """Load of the bands per length along the face, shape (P, Z) [1/module]; at a jump the value inside."""
    away = zeta - pressed.zeta[:, None]
    reach = np.where(away < 0.0, pressed.before[:, None], pressed.after[:, None])
    inside = np.abs(away) <= reach
    height = 1.0 / (pressed.before + pressed.after)[:, None]
    if pressed.profile == "even":
        return np.where(inside, height, 0.0)
    fall = np.divide(np.abs(away), reach, out=np.ones_like(away), where=reach > 0.0)
    return np.where(inside, 2.0 * height * (1.0 - fall), 0.0)


def overlap(pressed: Bands) -> Array:
    """Integrals of products of two bands' profiles along the face, shape (P, P) [1/module]."""
    if pressed.is_chain:
        return _overlap_of_chain(pressed)
    ends = np.unique(np.concatenate([pressed.zeta - pressed.before, pressed.zeta, pressed.zeta + pressed.after]))
    half = 0.5 * np.diff(ends)
    z = (0.5 * (ends[1:] + ends[:-1])[:, None] + half[:, None] * np.array([-1.0, 1.0]) / math.sqrt(3.0)).ravel()
    values = profiles_at(pressed, z)
    return np.asarray((values * np.repeat(half, 2)) @ values.T)


def _overlap_of_chain(pressed: Bands) -> Array:
    """The same of hats on a chain of stations: the mass matrix of linear elements."""
    height = 2.0 / (pressed.before + pressed.after)
    found = np.diag(height**2 * (pressed.before + pressed.after) / 3.0)
    beside = height[1:] * height[:-1] * pressed.after[:-1] / 6.0
    at = np.arange(beside.size)
    found[at, at + 1] = found[at + 1, at] = beside
    return found


def _gauss(pressed: Bands, face: FaceFunctions) -> tuple[Array, Array]:
    """Points along the face and shares of each band's load there, shape (P, q) each."""
    low, high = pressed.zeta - pressed.before, pressed.zeta + pressed.after
    cuts = [low, pressed.zeta, high, *(np.clip(x, low, high) for x in face.breaks[1:-1])]
    ends = np.sort(np.stack(cuts), axis=0)
    half = 0.5 * np.diff(ends, axis=0)[:, :, None]
    # A straight profile and, along a sloping line, a pressure that moves up the flank: some points more than for these.
    # On a short part of the face a function is nearly a polynomial of as low a degree as its part of the waves.
    degree = max(face.degrees)
    waves = whole(degree * 2.0 * float(half.max()) / face.width, up=True) if half.size else 0
    x, w = np.polynomial.legendre.leggauss(min(degree // 2 + 4, waves + 5))
    z = (0.5 * (ends[1:] + ends[:-1])[:, :, None] + half * x).transpose(1, 0, 2).reshape(pressed.count, -1)
    weight = (half * w).transpose(1, 0, 2).reshape(pressed.count, -1)
    if pressed.profile == "hat":
        away = z - pressed.zeta[:, None]
        side = np.where(away < 0.0, pressed.before[:, None], pressed.after[:, None])
        weight = weight * (1.0 - np.abs(away) / np.where(side > 0.0, side, 1.0))
    return z, weight / weight.sum(axis=1, keepdims=True)


def _room(flank: LoadedFlank, half_width: Array) -> tuple[Array, Array]:
    """Where a pressure's middle may lie so that it stays on the flank."""
    most = np.minimum(half_width, 0.5 * (flank.flank_end - flank.flank_start))
    return flank.flank_start + most, flank.flank_end - most


def _check(pressed: Bands, flank: LoadedFlank, face: FaceFunctions) -> None:
    half = 0.5 * face.width * (1.0 + _ON_FACE)
    over = (pressed.zeta - pressed.before < -half) | (pressed.zeta + pressed.after > half)
    if over.any() or not np.isfinite(pressed.zeta).all():
        at = pressed.zeta[np.argmax(over)]
        raise RangeError(
            "zeta", f"{at:.6g} modules", f"is the middle of a band that reaches over an end face at {half:.6g} modules"
        )
    if not ((pressed.before >= 0.0) & (pressed.after >= 0.0) & (pressed.before + pressed.after > 0.0)).all():
        raise RangeError("reach", "not positive", "must be positive: a band has an extent along the face")
    if not np.isfinite(pressed.slope).all():
        raise RangeError("slope", "not finite", "must be finite: arc length up the flank per length along the face")
    check_half_width(pressed.half_width, flank)


def check_half_width(half_width: Array, flank: LoadedFlank) -> None:
    """Refuse pressures without a width, or wider than the flank.

    Raises
    ------
    RangeError
    """
    most = 0.5 * (flank.flank_end - flank.flank_start)
    wrong = ~((half_width > 0.0) & (half_width <= most))
    if wrong.any():
        raise RangeError(
            "half_width", f"{half_width[wrong][0]:.6g} modules",
            f"must be positive and at most {most:.6g} modules: a contact has a width and lies on the flank",
        )  # fmt: skip
