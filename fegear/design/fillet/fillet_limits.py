"""What a fillet must keep, whatever its stress."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Limits:
    """What a fillet must keep [modules].

    Parameters
    ----------
    clearance : float
        Room to the path of the mating tip at the root circle, falling to zero at the start of the flank.
    smallest_radius : float
        Of curvature.
    generated : bool
        Whether a rack must be able to generate it.
    smallest_tool_radius : float
        Of curvature of that rack's tip.
    """

    clearance: float = 0.02
    smallest_radius: float = 0.1
    generated: bool = False
    smallest_tool_radius: float = 0.1
