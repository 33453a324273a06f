"""All variants of a pair that a requirement allows: every combination of what may vary, numbered, in chunks.

A variant has a number that does not depend on how many are looked at at once or by whom: its row (module, pressure
angle, helix angle, addendum, face width, numbers of teeth) and, within the row, the shifts.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import InputError
from fegear.geometry.involute import pressure_angle_of_inv
from fegear.geometry.many_pairs import ManyGearPairs, involute

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index

#: Variants that are looked at at once: their arrays stay in the processor's cache.
_CHUNK = 8000
#: Variants beyond which a requirement is refused: minutes.
MOST = 30_000_000
#: Face widths by b/d_1 are rounded up to this [m].
_WHOLE = 1e-3
#: Slack of whole numbers that come out of products.
_ROUND = 1e-9


@dataclass(frozen=True)
class SizingSpace:
    """What may vary; lengths in metres, angles in radians, heights and shifts in modules.

    Parameters
    ----------
    modules, alphas, betas, heights : tuple of float
    widths, relative_widths : tuple of float
        Face widths, or b/d_1 where there are none.
    pinion_teeth : (int, int)
        Minimum and maximum.
    ratio, tolerance : float
    hunting : bool
        Whether z_1 and z_2 have no common divisor.
    shifts, sums : tuple of float
        x_1; x_1 + x_2 where the centre distance does not give it.
    distances : (float, float) or None
        Minimum and maximum centre distance; equal ones give x_1 + x_2.
    shift_sum_limits : (float, float)
    root_clearance, rack_tip_radius : float
    shortened : bool
    """

    modules: tuple[float, ...]
    alphas: tuple[float, ...]
    betas: tuple[float, ...]
    heights: tuple[float, ...]
    widths: tuple[float, ...]
    relative_widths: tuple[float, ...]
    pinion_teeth: tuple[int, int]
    ratio: float
    tolerance: float
    hunting: bool
    shifts: tuple[float, ...]
    sums: tuple[float, ...]
    distances: tuple[float, float] | None
    shift_sum_limits: tuple[float, float]
    root_clearance: float = 0.25
    rack_tip_radius: float = 0.38
    shortened: bool = True

    @property
    def fixed(self) -> bool:
        """Whether the centre distance gives the sum of the shifts."""
        return self.distances is not None and self.distances[0] == self.distances[1]

    @cached_property
    def pairs_of_teeth(self) -> tuple[tuple[int, int], ...]:
        """z_1 and z_2 within the tolerance of the ratio."""
        found = []
        for z_1 in range(self.pinion_teeth[0], self.pinion_teeth[1] + 1):
            low = math.ceil(z_1 * self.ratio * (1.0 - self.tolerance) - _ROUND)
            high = math.floor(z_1 * self.ratio * (1.0 + self.tolerance) + _ROUND)
            wheels = range(max(low, z_1), high + 1)
            found += [(z_1, z_2) for z_2 in wheels if not self.hunting or math.gcd(z_1, z_2) == 1]
        return tuple(found)

    @cached_property
    def _rows(self) -> Array:
        """A row for each combination but the shifts: m_n, alpha_n, beta, h_aP, b or b/d_1, z_1, z_2."""
        widths = self.widths or self.relative_widths
        sizes = itertools.product(self.modules, self.alphas, self.betas, self.heights, widths)
        return np.array([(*size, *teeth) for size in sizes for teeth in self.pairs_of_teeth]).reshape(-1, 7)

    @property
    def per_row(self) -> int:
        """Variants of one row."""
        return len(self.shifts) * (1 if self.fixed else len(self.sums))

    @property
    def count(self) -> int:
        """All variants."""
        return len(self._rows) * self.per_row

    def refuse_none_or_too_many(self) -> None:
        """Refuse requirements without a variant, or with more than can be looked at.

        Raises
        ------
        InputError
        """
        if not self.pairs_of_teeth:
            raise InputError(
                "sizing.ratio", f"{self.ratio:g}", "is not met by any numbers of teeth within the tolerance",
                "increase ratio_tolerance, or widen pinion_teeth",
            )  # fmt: skip
        sizes = (self.modules, self.alphas, self.betas, self.heights, self.widths or self.relative_widths)
        count = math.prod(len(one) for one in sizes) * len(self.pairs_of_teeth) * self.per_row
        if count > MOST:
            raise InputError(
                "sizing", f"{count:,} variants", f"exceeds the limit of {MOST:,}",
                "reduce the number of values (pinion_shifts, helix_angles, pinion_teeth ...)",
            )  # fmt: skip

    def chunks(self) -> Iterator[tuple[Index, ManyGearPairs]]:
        """Numbers of variants and their pairs; NaN where the teeth cannot reach the centre distance."""
        rows = max(_CHUNK // self.per_row, 1)
        for first in range(0, len(self._rows), rows):
            numbers = np.arange(first * self.per_row, min(first + rows, len(self._rows)) * self.per_row)
            yield numbers, self.pairs(numbers)

    def pairs(self, numbers: Index) -> ManyGearPairs:
        """The pairs of some variants."""
        row, within = np.divmod(numbers, self.per_row)
        module, alpha, beta, addendum, width, z_1, z_2 = self._rows[row].T
        x_1 = np.array(self.shifts)[within % len(self.shifts)]
        teeth, lean = np.array([z_1, z_2]), np.cos(beta)
        transverse = np.arctan(np.tan(alpha) / lean)
        pitch = 0.5 * module * (z_1 + z_2) / lean
        with np.errstate(invalid="ignore"):
            if self.fixed and self.distances is not None:
                distance = np.full(numbers.size, self.distances[0])
                working = np.arccos(pitch * np.cos(transverse) / distance)
                total = (z_1 + z_2) * (involute(working) - involute(transverse)) / (2.0 * np.tan(alpha))
            else:
                total = np.array(self.sums)[within // len(self.shifts)]
                value = involute(transverse) + 2.0 * total * np.tan(alpha) / (z_1 + z_2)
                working = np.where(value > 0.0, pressure_angle_of_inv(np.maximum(value, 1e-12)), np.nan)
                distance = pitch * np.cos(transverse) / np.cos(working)
            shift = np.array([x_1, total - x_1])
            moved = np.minimum((distance - pitch) / module - total, 0.0) if self.shortened else np.zeros(numbers.size)
        if not self.widths:
            width = np.ceil(width * z_1 * module / lean / _WHOLE - _ROUND) * _WHOLE
        tip = np.full(numbers.size, self.rack_tip_radius)
        return ManyGearPairs(
            teeth, shift, module, alpha, beta, addendum, addendum + self.root_clearance, tip, moved, distance, width
        )

    def on_bounds(self, number: int) -> tuple[str, ...]:
        """What of a variant lies at the end of what may vary, in words of the case; nothing that has one value."""
        row, within = divmod(number, self.per_row)
        values = self._rows[row]
        names = ("normal_modules", "pressure_angles", "helix_angles", "addenda", "width")
        widths = self.widths or self.relative_widths
        lists = (self.modules, self.alphas, self.betas, self.heights, widths)
        found = []
        for name, value, given in zip(names, values, lists, strict=False):
            key = name if name != "width" else "face_width" if self.widths else "width_ratios"
            found += _ends(key, float(value), min(given), max(given))
        found += _ends("pinion_teeth", float(values[5]), *map(float, self.pinion_teeth))
        found += _ends("pinion_shifts", self.shifts[within % len(self.shifts)], self.shifts[0], self.shifts[-1])
        if not self.fixed:
            sums = self.sums
            found += _ends("shift_sums", sums[within // len(self.shifts)], sums[0], sums[-1])
        return tuple(found)


def _ends(key: str, value: float, low: float, high: float) -> list[str]:
    """Whether a value is the first or the last of several."""
    if low == high or value not in (low, high):
        return []
    return [f"{key} ({'minimum' if value == low else 'maximum'})"]


class VariantRelief(NamedTuple):
    """Linear tip relief of both gears: the same amount [m], lengths along the line of action of each [m]."""

    amount: float
    lengths: tuple[float, float]


class Variant(NamedTuple):
    """One pair: numbers of pinion and wheel; lengths [m], angles [rad], shifts and heights of the rack [modules]."""

    teeth: tuple[int, int]
    profile_shift: tuple[float, float]
    tip_diameter: tuple[float, float]
    module: float
    pressure_angle: float
    helix_angle: float
    addendum: float
    dedendum: float
    rack_tip_radius: float
    centre_distance: float
    face_width: float
    relief: VariantRelief | None = None


def variant_of(pairs: ManyGearPairs, row: int) -> Variant:
    """One of many pairs."""
    z, x, tip = pairs.teeth[:, row], pairs.profile_shift[:, row], pairs.tip_diameters[:, row]
    module, alpha, beta, addendum, dedendum, rounding, distance, width = (
        float(values[row]) for values in (
            pairs.module, pairs.pressure_angle, pairs.helix_angle, pairs.addendum, pairs.dedendum,
            pairs.rack_tip_radius, pairs.centre_distance, pairs.face_width,
        )
    )  # fmt: skip
    return Variant(
        (int(z[0]), int(z[1])), (float(x[0]), float(x[1])), (float(tip[0]), float(tip[1])),
        module, alpha, beta, addendum, dedendum, rounding, distance, width,
    )  # fmt: skip
