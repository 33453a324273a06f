"""Undamped natural modes with rigid-body motion kept apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.arrays import Array

#: A squared frequency below this part of the largest one counts as rigid-body motion.
RIGID = 1e-12


def undamped_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Natural frequencies [rad/s], falling, and mass-normalised mode shapes as columns; rigid bodies have exactly 0.

    Parameters
    ----------
    mass : ndarray, shape (n,)
        Diagonal masses [kg].
    stiffness : ndarray, shape (n, n)
        Symmetric, no negative eigenvalue [N/m].
    """
    root = 1.0 / np.sqrt(mass)
    squared, vectors = np.linalg.eigh(root[:, None] * stiffness * root)
    squared, vectors = squared[::-1], vectors[:, ::-1]
    squared = np.where(squared <= RIGID * squared[0], 0.0, squared)
    return np.sqrt(squared), root[:, None] * vectors
