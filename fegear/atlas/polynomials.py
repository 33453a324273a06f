"""Polynomials in several coordinates, fitted to values at few places that are chosen for them.

Of the products of Chebyshev polynomials those count whose terms are the largest, a tenth of all in four coordinates,
found step by step from those of lower degrees. More places than products are taken,
each where the fit so far is least certain (the largest determinant), so that the scatter of meshes averages out, and
how far the fit without a place misses what is known there is an estimate of its error.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np

from fegear.base.arrays import Array, Index

#: Of the products' squares, what stands for the places that are not chosen yet.
_NOTHING = 1e-4
#: From one degree to the next a term falls to so much, as long as nothing else is known.
_FALLS = 0.3
#: A place that a fit rests on alone says nothing about its error.
_MOST_LEVERAGE = 0.98


def degrees_within(highest: tuple[int, ...]) -> Index:
    """Degrees of products, (M, coordinates): each over the highest along its coordinate, they add up to 1 at most."""
    every = np.array(list(product(*(range(one + 1) for one in highest))))
    return every[(every / np.maximum(highest, 1)).sum(axis=1) <= 1.0 + 1e-12]


def next_degrees(degrees: Index, sizes: Array, limits: tuple[int, ...], growth: float) -> Index:
    """More products: those next to known ones whose terms are the largest.

    A product is taken only after all of lower degrees, and is thought to be as large as the smallest of those next to
    it, and to fall from there as it fell before.

    Parameters
    ----------
    degrees : ndarray of int, shape (M, coordinates)
    sizes : ndarray, shape (M,)
        Of the terms.
    limits : tuple of int
        Highest degree along each coordinate.
    growth : float
        How many products there shall be for each that is.
    """
    known = {tuple(one): size for one, size in zip(degrees.tolist(), sizes.tolist(), strict=True)}
    count, step = round(growth * len(known)), np.eye(len(limits), dtype=int)
    found = dict(known)
    while len(found) < count:
        beside: dict[tuple[int, ...], float] = {}
        for one in found:
            for axis, limit in enumerate(limits):
                new = tuple((np.array(one) + step[axis]).tolist())
                if new in found or new in beside or new[axis] > limit:
                    continue
                lower = [tuple((np.array(new) - step[a]).tolist()) for a in range(len(limits)) if new[a]]
                if all(low in found for low in lower):
                    beside[new] = _FALLS * min(found[low] for low in lower)
        if not beside:
            break
        ordered = sorted(beside, key=lambda one: (-beside[one], one))
        for one in ordered[: max(1, min(count - len(found), len(ordered) // 3))]:
            found[one] = beside[one]
    return np.array(list(found))


def products(degrees: Index, at: Array) -> Array:
    """Values of the products at places of shape (coordinates, N), shape (N, M)."""
    found = np.ones((at.shape[1], degrees.shape[0]))
    for along, one in zip(degrees.T, at, strict=True):
        found *= np.polynomial.chebyshev.chebvander(one, int(along.max()))[:, along]
    return found


def chosen(known: Array, others: Array, count: int) -> list[int]:
    """Which of other places are taken next, one after the other.

    Parameters
    ----------
    known, others : ndarray, shape (N, M)
        Products at the places that are taken already, and at those that may be.
    count : int
        How many to take.
    """
    r = np.linalg.qr(others, mode="r")  # of even size in all directions
    even = np.linalg.inv(r) * math.sqrt(others.shape[0])
    known, others = known @ even, others @ even
    start = known.T @ known + _NOTHING * np.eye(known.shape[1])
    solved = np.linalg.solve(start, others.T)
    uncertain = np.einsum("nm,mn->n", others, solved)
    found: list[int] = []
    for _ in range(min(count, others.shape[0])):
        best = int(np.argmax(uncertain))
        found.append(best)
        along, size = solved[:, best].copy(), 1.0 + uncertain[best]
        across = others @ along
        solved -= np.outer(along, across) / size
        uncertain = np.maximum(uncertain - across * across / size, 0.0)
        uncertain[found] = -1.0
    return found


def fitted(values: Array, known: Array) -> tuple[Array, Array]:
    """Coefficients by least squares, shape (M, ...), and by how much the fit without each place misses it, (N, ...).

    Parameters
    ----------
    values : ndarray, shape (N, ...)
    known : ndarray, shape (N, M)
        Products at the places; N > M.
    """
    q, r = np.linalg.qr(known)
    coefficients = np.linalg.solve(r, q.T @ values)
    leverage = np.minimum((q * q).sum(axis=1), _MOST_LEVERAGE)
    return coefficients, (values - known @ coefficients) / (1.0 - leverage)[:, None]
