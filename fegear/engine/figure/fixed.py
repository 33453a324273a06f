"""Read-only copies of the numbers that a figure holds."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array


def fixed(values: ArrayLike) -> Array:
    """A read-only copy as floats."""
    made = np.array(values, dtype=float)
    made.setflags(write=False)
    return made
