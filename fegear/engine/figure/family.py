"""Families of curves: which members are drawn, and the colours of ordered ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

#: More curves of a family than this cannot be distinguished.
MOST_CURVES = 7


def few(count: int, keep: Sequence[int] = (), most: int = MOST_CURVES) -> list[int]:
    """At most so many of a family, evenly chosen, with those to keep."""
    if count <= most:
        return list(range(count))
    return sorted({round(i) for i in np.linspace(0, count - 1, most)} | set(keep))


def ramp(count: int) -> list[str]:
    """Roles of an ordered family, from the lowest to the highest."""
    return [f"ramp:{i / (count - 1):.3f}" if count > 1 else "ramp:0.700" for i in range(count)]
