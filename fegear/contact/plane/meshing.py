"""Which tooth pairs touch where at a roll position: on the path of contact, or at a tip corner beyond it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.plane.corner import CornerContact, corner_contact
from fegear.geometry.pair import GearPair

#: Zero is the gap of flanks on the path alone: beyond it round-off, too, leaves more [m].
_OFF_PATH = float(np.finfo(float).tiny)


@dataclass(frozen=True, slots=True)
class Contacts:
    """Places of contact of n tooth pairs at P roll positions; arrays of shape (n, P).

    Parameters
    ----------
    number : ndarray of int, shape (n,)
        Pair j is at x + j A; j > 0 has come into contact before.
    x : ndarray
        Positions on the line of action [m]; beyond the path where a corner touches.
    present : ndarray of bool
        Whether the pair is on the path (or, with corner contact, within the corner's reach).
    radius_driver, radius_driven : ndarray
        Contact radii [m]; any radius of the flank where the pair is absent.
    roll_driver, roll_driven : ndarray
        Their roll angles [rad].
    relative_radius : ndarray
        rho_1 rho_2 / (rho_1 + rho_2) of the flanks [m], rho negative on the hollow flank of a ring.
    edge : ndarray
        Slope at which the flanks part inward from the nearest tip corner times the relative radius [m]: minus the
        distance of the contact from the corner on the path; minus infinity where corners are rounded or ignored.
    gap : ndarray
        Distance that unmodified rigid flanks still have to go [m]: 0 on the path, infinite where absent.
    """

    number: NDArray[np.int64]
    x: Array
    present: NDArray[np.bool_]
    radius_driver: Array
    radius_driven: Array
    roll_driver: Array
    roll_driven: Array
    relative_radius: Array
    edge: Array
    gap: Array


class Touching(NamedTuple):
    """Places of contact of a pair; see `Contacts`."""

    gap: Array
    driver_length: Array
    driven_length: Array
    relative_radius: Array
    edge: Array


def refuse_gaps(pair: GearPair, key: str, *, corner_contact: bool) -> None:
    """Refuse a pair of which at some roll positions no teeth touch, on the path of contact or at a tip corner.

    Parameters
    ----------
    pair : GearPair
    key : str
        Of the pair in the case.
    corner_contact : bool
        Whether tip corners may touch the mating flank before and after the path of contact.

    Raises
    ------
    InputError
    """
    if pair.contact_ratio >= 1.0:
        return
    corners = sum(corner.reach for corner in _corners(pair)) / pair.base_pitch
    closed = pair.contact_ratio + corners >= 1.0
    if corner_contact and closed:
        return
    rule = "is below 1: no tooth pair is in contact at some roll positions"
    if not closed:
        rule += f", and corner contact extends it by {corners:.4g} base pitches only"
    longer = "increase addendum, numbers of teeth or profile shift"
    remedy = f"{longer}, or set effects.corner_contact = true" if closed else longer
    raise InputError(key, f"contact ratio {pair.contact_ratio:.4f}", rule, remedy)


def _corners(pair: GearPair) -> tuple[CornerContact, CornerContact]:
    return corner_contact(pair, "driven"), corner_contact(pair, "driver")


@dataclass(frozen=True)
class Meshing:
    """Finds the contacts of a gear pair.

    Parameters
    ----------
    pair : GearPair
    corner_contact : bool
        Whether tip corners may touch the mating flank before and after the path of contact.
    single : bool
        Whether it is of single teeth among others, which need not touch at every roll position.

    Raises
    ------
    InputError
        If the contact ratio is below 1 and corners may not help.
    """

    pair: GearPair
    corner_contact: bool = False
    single: bool = False

    def __post_init__(self) -> None:
        """Refuse pairs that lose contact."""
        if not self.single:
            refuse_gaps(self.pair, "pair", corner_contact=self.corner_contact)

    @cached_property
    def corners(self) -> tuple[CornerContact, CornerContact]:
        """The driven tip before the path and the driver's tip after it."""
        return _corners(self.pair)

    @property
    def pair_numbers(self) -> NDArray[np.int64]:
        """j of the pairs that can touch somewhere in the base pitch that starts at x_start."""
        ahead = math.ceil(self.pair.contact_ratio * (1.0 - 1e-12)) - 1
        low, high = (-1, ahead + 1) if self.corner_contact else (0, ahead)
        if self.corner_contact:
            low = -max(1, min(math.ceil(self.corners[0].reach / self.pair.base_pitch), 2))
            extra = self.corners[1].reach / self.pair.base_pitch
            high = max(ahead, math.ceil(self.pair.contact_ratio + min(extra, 1.0)) - 1)
        return np.arange(low, high + 1)

    def reduced(self, x: ArrayLike) -> Array:
        """The same roll position with x in [x_start, x_start + A)."""
        pitch, start = self.pair.base_pitch, self.pair.x_start
        return np.asarray(start + np.mod(np.asarray(x, dtype=float) - start, pitch))

    def contacts(self, x: ArrayLike) -> Contacts:
        """Contacts of all pairs at roll positions x, shape (P,) [m], each in [x_start, x_start + A].

        A pair exactly at either end of the path counts as present.
        """
        pair = self.pair
        at = np.atleast_1d(np.asarray(x, dtype=float))
        number = self.pair_numbers
        xs = at + number[:, None] * pair.base_pitch
        found = self.touching(xs)
        rb1, rb2 = pair.driver.base_radius, pair.driven.base_radius
        return Contacts(
            number, xs, found.gap < np.inf, np.hypot(rb1, found.driver_length), np.hypot(rb2, found.driven_length),
            found.driver_length / rb1, found.driven_length / rb2, found.relative_radius, found.edge, found.gap,
        )  # fmt: skip

    def touching(self, x: Array) -> Touching:
        """Contact of a pair at places along the line of action [m], of any shape; infinitely apart if there is none."""
        pair = self.pair
        slack = 1e-10 * pair.base_pitch
        inside = (x >= pair.x_start - slack) & (x <= pair.x_end + slack)
        on_path = np.clip(x, pair.x_start, pair.x_end)
        length1 = np.array(pair.flank_curvature_radius(on_path, "driver"))
        length2 = np.array(pair.flank_curvature_radius(on_path, "driven"))
        gap = np.where(inside, 0.0, np.inf)
        curvature = 1.0 / length1 + 1.0 / length2
        edge = np.full(x.shape, -np.inf)
        if self.corner_contact:
            for corner, beyond in zip(self.corners, (pair.x_start - x, x - pair.x_end), strict=True):
                edge = np.maximum(edge, np.where(inside, -corner.distance(on_path), -np.inf))
                off = ~inside & (beyond > 0.0) & (beyond < pair.base_pitch)
                if not (corner.exists and off.any()):
                    continue
                apart, flank, slope = corner.locate(beyond[off])
                gap[off] = np.maximum(apart, _OFF_PATH)
                (length1 if corner.flank_of == "driver" else length2)[off] = flank
                curvature[off] = 1.0 / flank + 1.0 / corner.radius_of_curvature
                edge[off] = -np.inf if corner.rounding > 0.0 else slope / curvature[off]
        relative = np.maximum(1.0 / curvature, 1e-6 * pair.driver.module)
        return Touching(gap, length1, length2, relative, edge)
