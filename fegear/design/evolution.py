"""Differential evolution on many islands at once: small populations that never meet, one for each start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.arrays import Floats


def evolve(
    objective: Callable[[Floats], Floats], population: Floats, low: Floats, high: Floats, generations: int
) -> tuple[Floats, Floats]:
    """Find the least of an objective with kinks near each of B starts (Storn and Price, "current to best").

    Every generation of all islands is evaluated at once. The random numbers are always the same.

    Parameters
    ----------
    objective : callable
        Of points, shape (B, K, d); returns shape (B, K).
    population : ndarray, shape (B, K, d)
        First generation, K of each island.
    low, high : ndarray
        Limits, broadcast to the population; points beyond them are brought back.
    generations : int

    Returns
    -------
    best, values : ndarray, shapes (B, d), (B,)
    """
    islands, size, d = population.shape
    rng = np.random.default_rng(1)
    p = np.clip(population, low, high)
    values = objective(p)
    rows, at = np.arange(islands)[:, None], np.arange(islands)
    for _ in range(generations):
        best = p[at, values.argmin(axis=1)][:, None]
        one, other = (
            p[rows, rng.integers(size, size=(islands, size))],
            p[rows, rng.integers(size, size=(islands, size))],
        )
        far = rng.uniform(0.3, 0.95, (islands, size, 1))
        trial = p + far * (best - p) + far * (one - other)
        trial = np.where(rng.random((islands, size, d)) < 0.9, trial, p)
        trial = np.clip(trial, low, high)
        found = objective(trial)
        better = found < values
        p = np.where(better[:, :, None], trial, p)
        values = np.where(better, found, values)
    pick = values.argmin(axis=1)
    return p[at, pick], values[at, pick]
