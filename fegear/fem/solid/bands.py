"""Pressed bands on the twisted flank: a semi-elliptic pressure up the flank times a profile along the face.

A half-space under pressed bands that end at the faces: what polynomials along the face do not resolve.

A band of semi-elliptic pressure whose load varies along it as cos(k y) sinks, weighted with its own pressure, by
(1 - nu^2) / (pi E) M(k w) per unit of that load, w its half-width: in the band's cross-section the half-space answers
with 2 K_0(k r), and M is its mean over two points of the pressure (Johnson, Contact Mechanics, 1985, 3.2 and 4.2, for
the kernel 1/r of which K_0 is the transform). At both faces the load is continued as its mirror image, which leaves
cosines along the face by themselves.

What a free end face adds to its mirror under a band that ends at it.

A half-space with a mirrored load has no shear on the plane of the mirror, but keeps the stress along the band there;
an end face is free of it, and stands at an angle to the flank. Under an even load the deflection beside it is larger
by end_slope times ln(a / distance) within about the pressed half-width a: a number that Poisson's ratio and the angle
between flank and face decide. It was found by solid teeth of two modules' width whose pressed bands narrow from .2 to
.1 module (tests/golden/make_end_slopes.py).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.base.errors import RangeError
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.settings import whole

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
        """Whether each band falls to the next ones, as those of `hats`, none at the place of another."""
        step = np.diff(self.zeta)
        falls = (step > 0.0) & (self.after[:-1] == step) & (self.before[1:] == step)
        return self.profile == "hat" and bool(falls.all())

    def part(self, span: slice | Index) -> Bands:
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
            "zeta", f"{at:.6g} modules", f"is the centre of a band extending beyond the end face at {half:.6g} modules"
        )
    if not ((pressed.before >= 0.0) & (pressed.after >= 0.0) & (pressed.before + pressed.after > 0.0)).all():
        raise RangeError("reach", "not positive", "must be positive")
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
            f"must be positive and at most {most:.6g} modules",
        )  # fmt: skip


#: Mean of ln|x - x'| over two points of a semi-elliptic pressure on (-1, 1), with the sign turned.
_MEAN_LOG = 0.25 + np.log(2.0)


#: Below this k w the first two terms are all that there is.
_LONG_WAVE = 1e-4


#: And beyond this one the limit of short waves is.
_TABLE_END = 300.0


def band_spectrum(kw: Array) -> Array:
    """M(k w) for k w > 0, shape of `kw`.

    Long waves give the plane logarithm, M = 2 (ln(4 / k w) - gamma + 1/4); short ones 32 / (3 pi k w).
    """
    from scipy.special import k0

    kw = np.asarray(kw, dtype=float)
    found = 2.0 * (np.log(2.0 / kw) - np.euler_gamma + _MEAN_LOG)
    short = kw > _LONG_WAVE
    distance, weight = _distances()
    found[short] = 2.0 * k0(kw[short][..., None] * distance) @ weight
    return found


def quick_band_spectrum(kw: Array) -> Array:
    """M(k w) from a table, to 1e-7 of itself."""
    found = 2.0 * (np.log(2.0 / kw) - np.euler_gamma + _MEAN_LOG)
    short = kw > _LONG_WAVE
    found[short] = np.exp(_table()(np.log(np.minimum(kw[short], _TABLE_END))))
    return np.asarray(np.where(kw > _TABLE_END, 32.0 / (3.0 * np.pi * kw), found))


@cache
def _table() -> Callable[[Array], Array]:
    from scipy.interpolate import CubicSpline

    at = np.linspace(np.log(_LONG_WAVE), np.log(_TABLE_END), 800)
    return CubicSpline(at, np.log(band_spectrum(np.exp(at))))


@cache
def _distances() -> tuple[Array, Array]:
    """Distances of two points of a semi-elliptic pressure on (-1, 1) and how likely they are: a quadrature."""
    u, w = np.polynomial.legendre.leggauss(120)
    u, w = 0.5 + 0.5 * u, 0.5 * w
    distance, weight = 2.0 * u**4, 8.0 * u**3 * w  # K_0 is singular at none, and sharp there for short waves
    theta = (np.arange(1, 401) - 0.5) * np.pi / 400 - 0.5 * np.pi
    half = 1.0 - 0.5 * distance[:, None]
    x = half * np.sin(theta)  # about the middle of where both pressures are
    shape = half**2 * np.cos(theta) ** 2 * np.sqrt((1.0 + 0.5 * distance[:, None]) ** 2 - x**2)
    likely = 2.0 * (4.0 / np.pi**2) * shape.sum(axis=1) * np.pi / 400
    return distance, weight * likely


def band_cosines(pressed: Bands, width: float, count: int) -> Array:
    """Integrals of the bands' profiles times cos(n pi (z / width + 1/2)), n = 0..count, shape (P, count + 1)."""
    k = np.pi * np.arange(1, count + 1) / width
    at, before, after = (x[:, None] for x in (pressed.zeta + 0.5 * width, pressed.before, pressed.after))
    waves = np.zeros((pressed.count, count + 1))
    waves[:, 0] = 1.0
    if pressed.profile == "even":
        waves[:, 1:] = (np.sin(k * (at + after)) - np.sin(k * (at - before))) / k / (before + after)
        return waves
    if pressed.is_chain and pressed.count > 1:
        # Of stations that stand in a row each one's cosines serve its neighbours, and sines are left at the ends.
        cosines = _cosines(at[:, 0] / width, count)[:, 1:]
        fall = np.diff(cosines, axis=0) / after[:-1]
        waves[0, 1:], waves[-1, 1:] = -k * np.sin(k * at[0]), k * np.sin(k * at[-1])
        waves[:-1, 1:] -= fall
        waves[1:, 1:] += fall
        waves[:, 1:] *= 2.0 / (before + after) / k**2
        return waves
    for reach, sign in ((before, -1.0), (after, 1.0)):
        some = np.where(reach > 0.0, reach, 1.0)
        half = -sign * np.sin(k * at) / k + (np.cos(k * at) - np.cos(k * (at + sign * some))) / (k**2 * some)
        waves[:, 1:] += np.where(reach > 0.0, half, 0.0)
    waves[:, 1:] *= 2.0 / (before + after)
    return waves


def _cosines(place: Array, count: int) -> Array:
    """cos(n pi place), n = 0..count, shape (P, count + 1): sums of two angles, for few cosines are costly."""
    few = max(1, math.isqrt(count))
    steps = np.pi * np.arange(count // few + 1) * few
    near, far = np.pi * np.multiply.outer(place, np.arange(few)), np.multiply.outer(place, steps)
    both = np.cos(far)[:, :, None] * np.cos(near)[:, None] - np.sin(far)[:, :, None] * np.sin(near)[:, None]
    return np.asarray(both.reshape(place.size, -1)[:, : count + 1])


@lru_cache(maxsize=16)
def function_cosines(face: FaceFunctions, count: int) -> tuple[Array, Array]:
    """Integrals of the functions along the face times those cosines, and times 1, shape (functions, count) and (.,)."""
    nodes, weights = np.polynomial.legendre.leggauss(count + max(face.degrees) + 8)
    total = np.zeros((face.count, count))
    mean = np.zeros(face.count)
    k = np.pi * np.arange(1, count + 1) / face.width
    for low, high in itertools.pairwise(face.breaks):
        z, w = 0.5 * (low + high) + 0.5 * (high - low) * nodes, 0.5 * (high - low) * weights
        values = face.values(z) * w
        total += values @ np.cos(np.multiply.outer(z - face.breaks[0], k))
        mean += values.sum(axis=1)
    return total, mean


@lru_cache(maxsize=256)
def galerkin_compliance(face: FaceFunctions, normal_length: float, count: int, half_width: float) -> Array:
    """Answer of a half-space to bands whose profiles and deflections are functions along the face, (functions, ...).

    Galerkin's method: the inverse of the stiffness of cosines, 1 / M, between those functions. Of profiles without
    their mean, which has no answer of its own.
    """
    cosines, plain = function_cosines(face, count)
    k = np.asarray(np.pi * np.arange(1, count + 1) / face.width / normal_length, dtype=float)
    stiffness = 2.0 / face.width * (cosines / band_spectrum(k * half_width)) @ cosines.T
    found = np.linalg.inv(stiffness + np.multiply.outer(plain, plain))
    return np.asarray(0.5 * (found + found.T))


#: Acute ends are positive: base helix angle [deg], and the values there for each of Poisson's ratios.
_ANGLES = (-40.0, -32.0, -24.0, -16.0, -8.0, 0.0, 8.0, 16.0, 24.0, 32.0, 40.0)


_RATIOS = (0.0, 0.15, 0.3, 0.45)


_VALUES = (
    (-0.1686, -0.1450, -0.1241, -0.0990, -0.0613, 0.0000, 0.1006, 0.2637, 0.5262, 0.9499, 1.6474),
    (-0.1982, -0.1707, -0.1439, -0.1098, -0.0588, 0.0217, 0.1493, 0.3504, 0.6659, 1.1657, 1.9767),
    (-0.2148, -0.1795, -0.1424, -0.0948, -0.0260, 0.0779, 0.2362, 0.4776, 0.8474, 1.4227, 2.3445),
    (-0.2162, -0.1693, -0.1177, -0.0522, 0.0386, 0.1696, 0.3615, 0.6453, 1.0703, 1.7202, 2.7487),
)


@lru_cache(maxsize=256)
def end_slope(angle: float, poisson_ratio: float) -> float:
    """The number at an end face whose angle to the flank is 90 degrees less `angle` [rad], E = 1.

    Times 1 / cos(beta_b) it is the transverse approach per transverse force and length. Angles beyond 40 degrees take
    the value there; Poisson's ratios are interpolated by a cubic.
    """
    step, ratios = _ANGLES[1] - _ANGLES[0], np.array(_RATIOS)
    place = (float(np.clip(np.degrees(angle), _ANGLES[0], _ANGLES[-1])) - _ANGLES[0]) / step
    i = min(int(place), len(_ANGLES) - 2)
    known, bent, x = np.array(_VALUES), _second_derivatives(), place - i
    y = 1.0 - x
    values = y * known[:, i] + x * known[:, i + 1] + ((y**3 - y) * bent[:, i] + (x**3 - x) * bent[:, i + 1]) / 6.0
    return float(np.polynomial.polynomial.polyfit(ratios, values, 3) @ float(poisson_ratio) ** np.arange(4))


@cache
def _second_derivatives() -> Array:
    """Of the cubic spline over the angles, in steps of these, shape (ratios, angles); its ends have no knot.

    By hand: the library's spline takes longer to load than all else of a recalled pair.
    """
    count = len(_ANGLES)
    system, right = 4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1), np.zeros((count, len(_RATIOS)))
    right[1:-1] = 6.0 * np.diff(np.array(_VALUES).T, 2, axis=0)
    system[0, :3], system[-1, -3:] = (1.0, -2.0, 1.0), (1.0, -2.0, 1.0)
    return np.asarray(np.linalg.solve(system, right).T)
