"""A half-space under pressed bands that end at the faces: what polynomials along the face do not resolve.

A band of semi-elliptic pressure whose load varies along it as cos(k y) sinks, weighted with its own pressure, by
(1 - nu^2) / (pi E) M(k w) per unit of that load, w its half-width: in the band's cross-section the half-space answers
with 2 K_0(k r), and M is its mean over two points of the pressure (Johnson, Contact Mechanics, 1985, 3.2 and 4.2, for
the kernel 1/r of which K_0 is the transform). At both faces the load is continued as its mirror image, which leaves
cosines along the face by themselves.
"""

from __future__ import annotations

import itertools
import math
from functools import cache, lru_cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Array
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.face import FaceFunctions

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
