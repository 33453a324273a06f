"""Displacements of a point that moves with a rigid body, from those of another one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array


def carry(lever: ArrayLike) -> Array:
    """B(l): what a force (F, M) is at a section a distance l before it along z, shape (..., 6, 6)."""
    arm = np.asarray(lever, dtype=float)
    found = np.zeros((*arm.shape, 6, 6))
    found[..., range(6), range(6)] = 1.0
    found[..., 3, 1] = -arm
    found[..., 4, 0] = arm
    return found
