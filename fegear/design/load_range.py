"""Loads that a relief is designed for together; light, for the plan of a case has it too."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LoadRange:
    """Loads that a relief is designed for together.

    Parameters
    ----------
    loads : tuple of float
        [N], ascending.
    weights : tuple of float, optional
        What each counts, over the largest; all the same by default.
    """

    loads: tuple[float, ...]
    weights: tuple[float, ...] | None = None
