"""Spur pairs as arrays: what load sharing of many plane pairs reads, in the form that machine code takes.

The twin of `fegear.contact.plane.pair_compliance.PairCompliance` and its engagement. Arrays of gears have the shape
(2, N), driver and driven; arrays of pairs (N,). Lengths are in metres.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.contact.plane.fe_compliance import FiniteElementCompliance

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Engagement

#: Points over the flank at which c_0 is known, and at which its neighbours are.
OWN, BESIDE = 95, 14


@dataclass(frozen=True, eq=False)
class ManyFlanks(ReadOnlyArrays):
    """Solved teeth of both gears of each pair, and where their flanks begin and end.

    Parameters
    ----------
    own : ndarray, shape (2, N, 95)
        c_0 at the nominal half-width, 0.08 modules, at the roll lengths of `own_lengths` [m^2/N].
    beside : ndarray, shape (2, N, K, 14, 14)
        Chebyshev coefficients of c_k(p, q), k = 1 to K [m^2/N].
    lowest, highest, base_radius : ndarray, shape (2, N)
        Roll lengths of the flank's ends, rising toward the tip, negative of internal gears; r_b [m].
    log_slope : ndarray, shape (2, N)
        kappa [m^2/N].
    plane_modulus : ndarray, shape (2, N)
        E / (1 - nu^2), in plane stress E [Pa].
    """

    own: Array
    beside: Array
    lowest: Array
    highest: Array
    base_radius: Array
    log_slope: Array
    plane_modulus: Array

    @property
    def side(self) -> Array:
        """1 of external gears, -1 of internal ones, shape (2, N)."""
        return np.where(self.highest < 0.0, -1.0, 1.0)


@dataclass(frozen=True, eq=False)
class ManyReliefs(ReadOnlyArrays):
    """Tip reliefs of both gears of each pair, shape (2, N).

    Parameters
    ----------
    amount : ndarray
        At the end of the flank [m].
    start : ndarray
        Share of the flank's roll length, between root and tip form circle, at which the relief starts: below 1.
    power : ndarray
        1: linear, 2: parabolic.
    """

    amount: Array
    start: Array
    power: Array

    def __post_init__(self) -> None:
        """Refuse reliefs without length."""
        if not ((self.start < 1.0) & (self.start >= 0.0)).all():
            raise InputError("relief.start", "a share", "must be at least 0 and below 1")
        if not (self.power >= 1.0).all():
            raise InputError("relief.power", "a power", "must be at least 1", "1 is linear, 2 parabolic")


@dataclass(frozen=True, eq=False)
class ManyEngagements(ReadOnlyArrays):
    """Pairs in mesh.

    Parameters
    ----------
    flanks : ManyFlanks
    module, base_pitch, centre_distance, face_width : ndarray, shape (N,)
        [m].
    reliefs : ManyReliefs, optional
    corner_contact : bool
        Whether tip corners touch the mating flank before and after the path of contact.
    """

    flanks: ManyFlanks
    module: Array
    base_pitch: Array
    centre_distance: Array
    face_width: Array
    reliefs: ManyReliefs | None = None
    corner_contact: bool = True
    #: What the kernel reads of each pair, shape (N, 32): see `fegear.contact.many.corners`.
    numbers: Array = field(init=False)

    def __post_init__(self) -> None:
        """Put together what the kernel reads of each pair."""
        f = self.flanks
        side = f.side
        angle = np.arccos(np.minimum(np.abs((side * f.base_radius).sum(axis=0)) / self.centre_distance, 1.0))
        at_pitch = side * f.base_radius * np.tan(angle)
        tip = np.hypot(f.base_radius, f.highest)
        # The tip's corner has a right angle and the flank's own pressure angle.
        soft = 0.5 * np.pi * _wedge_slope(0.5 * np.pi + np.arccos(f.base_radius / tip)) - 1.0
        start = np.maximum(-(f.highest[1] - at_pitch[1]), f.lowest[0] - at_pitch[0])
        end = np.minimum(f.highest[0] - at_pitch[0], -(f.lowest[1] - at_pitch[1]))
        by_tip = np.stack([
            np.abs(-(f.highest[1] - at_pitch[1]) - start), np.abs(f.highest[0] - at_pitch[0] - end)
        ])  # fmt: skip
        count = self.module.size
        relief = np.zeros((3, 2, count)) if self.reliefs is None else np.stack(
            [self.reliefs.amount, self.reliefs.start, self.reliefs.power])  # fmt: skip
        relief[2] = np.where(relief[0] == 0.0, 1.0, relief[2])
        pitch = self.base_pitch
        modulus = 1.0 / (1.0 / f.plane_modulus[0] + 1.0 / f.plane_modulus[1])
        numbers = np.stack([
            at_pitch[0], at_pitch[1], pitch, start, end, f.base_radius[0], f.base_radius[1], self.centre_distance,
            tip[0], tip[1], by_tip[0] <= 1e-9 * pitch, by_tip[1] <= 1e-9 * pitch, f.lowest[0], f.highest[0],
            f.lowest[1], f.highest[1], modulus, f.log_slope[0], f.log_slope[1], soft[0], soft[1],
            self.face_width, self.module,
            relief[0, 0], relief[1, 0], relief[2, 0], relief[0, 1], relief[1, 1], relief[2, 1], *side, angle,
        ], axis=1)  # fmt: skip
        object.__setattr__(self, "numbers", np.ascontiguousarray(numbers, dtype=float))


def _wedge_slope(angle: Array) -> Array:
    """As `fegear.fem.plane.contact_width.wedge_slope`, of many angles."""
    along, across = np.sin(0.5 * angle) ** 2, np.cos(0.5 * angle) ** 2
    return np.asarray(2.0 * (along / (angle + np.sin(angle)) + across / (angle - np.sin(angle))))


def engagements_of(engagements: Sequence[Engagement]) -> ManyEngagements:
    """Arrays of engagements that are given one by one, of solved gears with sharp tips and without reliefs.

    Raises
    ------
    InputError
        If the tips of one of them are rounded, or its compliance is that of a formula.
    """
    sources = [(one.compliance.driver, one.compliance.driven) for one in engagements]
    known = [source for both in sources for source in both if isinstance(source, FiniteElementCompliance)]
    gears = [(one.pair.driver, one.pair.driven) for one in engagements]
    rounded = any(gear.tooth.tip_rounding for both in gears for gear in both)
    if len(known) < 2 * len(sources) or rounded:
        raise InputError("pairs", "one of them", "must be of solved gears with sharp tips")

    def each(of: Callable[[FiniteElementCompliance], object]) -> Array:
        return np.array([[of(both[i]) for both in sources] for i in (0, 1)], dtype=float)  # type: ignore[arg-type]  # all are finite elements: looked at above

    reach = min(source.reach for source in known)
    flanks = ManyFlanks(
        each(lambda one: one.own_spline.y),
        each(lambda one: [one.neighbours[k] for k in range(1, reach + 1)]),
        each(lambda one: one.lowest), each(lambda one: one.highest),
        np.array([[both[i].base_radius for both in gears] for i in (0, 1)]), each(lambda one: one.log_slope),
        np.array([[both[i].plane_modulus for both in gears] for i in (0, 1)]),
    )  # fmt: skip
    pairs = [one.pair for one in engagements]
    module, pitch, distance, width = np.array([
        (pair.driver.module, pair.base_pitch, pair.centre_distance, pair.face_width) for pair in pairs
    ]).T  # fmt: skip
    corners = engagements[0].corner_contact
    return ManyEngagements(flanks, module, pitch, distance, width, corner_contact=corners)
