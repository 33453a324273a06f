"""Positions over a flank at which two solutions are compared, and what they usually differ by there; dimensionless."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.influence import Influence

#: A difference between two solutions may vanish by chance at one position: the estimate is no smaller than so many
#: times what the difference usually is over the flank.
USUAL = 1.5
#: Positions over the flank, evenly in roll angle, at which usual errors are looked for; for the largest, twice as many
#: and these distances from its ends [modules].
SAMPLES = 17
_BESIDE_ENDS = (0.005, 0.01, 0.02, 0.035, 0.05, 0.075, 0.1)


def flank_samples(known: Influence) -> Array:
    """Radii at which errors are looked for: `SAMPLES` evenly in roll angle, those between, and near the ends."""
    flank, tooth = known.flank, known.tooth
    least, most = tooth.involute_radii
    low, high = max(flank.lowest_radius, least), min(flank.highest_radius, most)
    first, last = tooth.roll(np.array([max(low, tooth.base_radius), high])).tolist()
    evenly = np.clip(tooth.radius_of_roll(np.linspace(first, last, SAMPLES)), low, high)
    between = np.sqrt(0.5 * (evenly[1:] ** 2 + evenly[:-1] ** 2))
    # On an involute the squared radius grows by twice the base radius times the arc length.
    near = 2.0 * tooth.base_radius * np.array(_BESIDE_ENDS)
    ends = np.sqrt(np.concatenate([low**2 + near, high**2 - near]))
    return np.concatenate([evenly, between, ends[(ends > low) & (ends < high)]])


def root_mean_square(values: Array) -> float:
    """Of values at all positions together."""
    return float(np.sqrt(np.mean(values**2)))
