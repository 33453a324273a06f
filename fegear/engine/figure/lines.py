"""Lines of drawings and members of families."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure.items import Curve

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from fegear.arrays import Array

#: More curves of a family than this cannot be distinguished.
MOST_CURVES = 7


def polylines(lines: Iterable[Array]) -> Array:
    """Several lines, each of shape (2, N), as one with gaps."""
    gap = np.full((2, 1), np.nan)
    return np.hstack([part for line in lines for part in (line, gap)])


def edges(points: Array, chains: NDArray[np.int64]) -> Array:
    """Lines through chains of points (2, N), one for each column of the chains (k, M), as one with gaps."""
    gap = np.full((2, 1, chains.shape[1]), np.nan)
    return np.concatenate([points[:, chains], gap], axis=1).transpose(0, 2, 1).reshape(2, -1)


def outline(points: Array, name: str = "", role: str = "outline", width: float = 1.8, dash: str = "") -> Curve:
    """A line of a drawing, shape (2, N), without marked points."""
    return Curve(points[0], points[1], name, role, dash=dash, width=width, markers=False)


def few(count: int, keep: Sequence[int] = (), most: int = MOST_CURVES) -> list[int]:
    """At most so many of a family, evenly chosen, with those to keep."""
    if count <= most:
        return list(range(count))
    return sorted({round(i) for i in np.linspace(0, count - 1, most)} | set(keep))


def ramp(count: int) -> list[str]:
    """Roles of an ordered family, from the lowest to the highest."""
    return [f"ramp:{i / (count - 1):.3f}" if count > 1 else "ramp:0.700" for i in range(count)]
