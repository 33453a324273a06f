"""Corners of outlines on grids that suit their edges, so that two processors draw the same triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array

#: Each corner of the boundary is drawn on a grid this share of its shorter edge wide: its last bits, which another
#: processor's rounding changes, do not reach gmsh.
GRID = 1e-3


def on_a_grid(polygon: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The polygon with every corner on a grid that suits its shorter edge, and the lengths of its edges then."""
    length = np.hypot(*(np.roll(polygon, -1, axis=1) - polygon))
    drawn = rounded(polygon, GRID * np.minimum(length, np.roll(length, 1)))
    # Products, sums and roots are rounded alike everywhere, which np.hypot is not.
    return drawn, np.sqrt(((np.roll(drawn, -1, axis=1) - drawn) ** 2).sum(axis=0))


def line_on_a_grid(line: Array) -> tuple[Array, Array]:
    """As `on_a_grid`, of an open line without its first vertex."""
    length = np.hypot(*np.diff(line))
    shorter = np.minimum(length, np.append(length[1:], np.inf))
    drawn = rounded(line[:, 1:], GRID * shorter)
    return drawn, np.sqrt((np.diff(np.column_stack([line[:, 0], drawn])) ** 2).sum(axis=0))


def rounded(points: Array, size: Array | float) -> Array:
    """Points on grids whose widths are powers of two, no larger than the sizes given."""
    grid = 2.0 ** np.floor(np.log2(size))
    return np.asarray(np.round(points / grid) * grid)
