"""What excludes a variant, in the order in which a designer asks: the first that applies is counted.

No variant is dropped in silence: those that live and the counts of all reasons add up to what was enumerated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.given import given

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Mask
    from fegear.geometry.many_pairs import ManyGearPairs

#: Slack of limits that a value meets but for rounding.
_SLACK = 1e-9


@dataclass(frozen=True)
class SizingLimits:
    """Limits of the geometry; heights and thicknesses in modules, lengths in metres, masses in kg.

    Parameters
    ----------
    tip_thickness, contact_ratio, overlap_ratio, tip_clearance, specific_sliding : float
        Minima.
    width_ratio, tip_diameter, mass : float
        Maxima; None for none.
    shift_sum : (float, float)
    distances : (float, float) or None
        Minimum and maximum centre distance.
    density : float
    """

    tip_thickness: float = given(meaning="Minimum normal tooth thickness at the tips, in modules.", default=0.4)
    contact_ratio: float = given(meaning="Minimum transverse contact ratio epsilon_alpha.", default=1.15, above=0.0)
    overlap_ratio: float = given(meaning="Minimum overlap ratio epsilon_beta.", default=0.0, at_least=0.0)
    tip_clearance: float = given(meaning="Minimum clearance between tip and mating root, in modules.", default=0.12)
    specific_sliding: float = given(
        meaning="Minimum specific sliding zeta of both gears (negative).", default=-3.0, at_most=0.0
    )
    width_ratio: float = given(meaning="Maximum b/d_1.", default=1.5, above=0.0)
    tip_diameter: float | None = given("length", "Maximum tip diameter of the wheel.", default=None, above=0.0)
    mass: float | None = given("mass", "Maximum mass of both gears.", default=None, above=0.0)
    shift_sum: tuple[float, float] = (-1.0, 1.5)
    distances: tuple[float, float] | None = None
    density: float = 7850.0


def masses(pairs: ManyGearPairs, density: float) -> Array:
    """Mass of both gears [kg]: discs of the mean of tip and root diameter, bored to half the root diameter."""
    mean = 0.5 * (pairs.tip_diameters + pairs.root_diameters)
    area = 0.25 * np.pi * (mean**2 - (0.5 * pairs.root_diameters) ** 2)
    return np.asarray(density * pairs.face_width * area.sum(axis=0))


def broken(pairs: ManyGearPairs, limits: SizingLimits) -> tuple[tuple[str, Mask], ...]:
    """Every limit, in order, and which pairs break it."""
    total, distance = pairs.profile_shift.sum(axis=0), pairs.centre_distance
    low, high = limits.shift_sum
    reach = ~np.isfinite(pairs.working_pressure_angle) | ~np.isfinite(distance)
    outside = np.zeros(len(pairs), dtype=bool)
    if limits.distances is not None:
        near, far = limits.distances
        outside = (distance < near * (1.0 - _SLACK)) | (distance > far * (1.0 + _SLACK))
    room = 0.25 * np.pi - pairs.dedendum * np.tan(pairs.pressure_angle)
    room = room - pairs.rack_tip_radius * (1.0 - np.sin(pairs.pressure_angle)) / np.cos(pairs.pressure_angle)
    with np.errstate(invalid="ignore"):
        found = (
            ("centre distance not reached (no working pressure angle)", reach),
            ("centre distance outside its range", outside),
            ("sum of profile shifts", (total < low - _SLACK) | (total > high + _SLACK)),
            ("tip rounding of the basic rack does not fit", room < -_SLACK),
            ("undercut", (pairs.undercut > _SLACK).any(axis=0)),
            ("interference (mating tip below the involute)", (pairs.involute_reserve < -_SLACK).any(axis=0)),
            ("tip thickness", (pairs.tip_thicknesses < limits.tip_thickness - _SLACK).any(axis=0)),
            ("contact ratio", ~(pairs.contact_ratio >= limits.contact_ratio - _SLACK)),
            ("tip clearance", (pairs.tip_clearances < limits.tip_clearance - _SLACK).any(axis=0)),
            ("specific sliding", (pairs.specific_sliding < limits.specific_sliding - _SLACK).any(axis=0)),
            ("overlap ratio", pairs.overlap_ratio < limits.overlap_ratio - _SLACK),
            ("b/d_1", pairs.face_width > limits.width_ratio * pairs.diameters[0] * (1.0 + _SLACK)),
            ("tip diameter", pairs.tip_diameters.max(axis=0) > (limits.tip_diameter or np.inf) * (1.0 + _SLACK)),
            ("mass", masses(pairs, limits.density) > (limits.mass or np.inf) * (1.0 + _SLACK)),
        )
    return tuple((words, np.asarray(mask)) for words, mask in found)
