"""Contact lines of all tooth pairs in reach, in the plane of action, divided into panels.

In the plane of action, x along the transverse line of action and z along the axes, the contact line of pair j at the
roll position x_0 is straight: x = x_0 + j p_bt - z tan(beta_b), the twist of the driver positive for a right hand. It
ends at the tips and form circles in use and at the ends of the common face (ISO 21771, 5.4).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError
from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from fegear.arrays import Array, Mask
    from fegear.geometry.pair import GearPair

#: A contact line shorter than this is left out [modules]: it is no longer long beside its Hertzian width.
SHORTEST_LINE = 0.15


@dataclass(frozen=True)
class ContactLines(ReadOnlyArrays):
    """Stations on the contact lines of P roll positions; arrays of shape (P, M), padded where fewer are needed.

    Parameters
    ----------
    roll : ndarray, shape (P,)
        Roll positions: x of pair 0 in the middle of the face [m].
    pair : ndarray of int
        j, the pair that a station belongs to; stations of one line stand together, ascending in z.
    present : ndarray of bool
        Whether there is a station.
    x, z : ndarray
        In the plane of action: from the pitch point along the line of action, from the middle of the common face [m].
    low, high : float
        Ends of the common face [m].
    at_edge : ndarray of bool
        Whether the line ends here at a tip or form circle.
    weight : ndarray, shape (P,)
        Part of a base pitch that each roll position stands for; they add up to 1. Empty: all alike.
    """

    roll: Array
    pair: NDArray[np.int64]
    present: Mask
    x: Array
    z: Array
    low: float
    high: float
    at_edge: Mask
    weight: Array = field(default_factory=lambda: np.empty(0))

    def mean(self, values: Array) -> Array:
        """Mean over a base pitch of what is known at the roll positions, shape (P, ...)."""
        count = self.roll.size
        weight = self.weight if self.weight.size else np.full(count, 1.0 / count)
        return np.asarray(np.tensordot(weight, values, axes=1))

    @property
    def panel(self) -> Array:
        """Length along the face from each station to the next of its line, 0 where there is none, (P, M - 1) [m]."""
        same = self.present[:, 1:] & self.present[:, :-1] & (self.pair[:, 1:] == self.pair[:, :-1])
        return np.asarray(np.where(same, np.diff(self.z, axis=1), 0.0))

    @property
    def support(self) -> Array:
        """Length along the face over which a station's unit of line load gathers its force, shape (P, M) [m]."""
        half = 0.5 * self.panel
        total = np.zeros(self.z.shape)
        total[:, :-1] += half
        total[:, 1:] += half
        return total

    @property
    def length(self) -> Array:
        """Of all lines along the face, shape (P,) [m]."""
        return np.asarray(self.panel.sum(axis=1))

    def at(self, position: int) -> list[slice]:
        """Where the lines of a roll position stand, in the order of their pairs."""
        count = int(self.present[position].sum())
        starts = [0, *(1 + np.flatnonzero(np.diff(self.pair[position, :count]))).tolist(), count]
        return [slice(a, b) for a, b in itertools.pairwise(starts)]


def base_twist(pair: GearPair) -> float:
    """Tangent of the base helix angle, positive for a right-handed driver."""
    return pair.driver.twist * pair.driver.base_radius


def shortest_line(pair: GearPair) -> float:
    """Length along the face below which a contact line is left out [m]."""
    return min(SHORTEST_LINE * pair.driver.module, 0.5 * pair.face_width)


def life_of_contact(pair: GearPair) -> tuple[float, float]:
    """First and last place of a contact line's middle while it touches the plane of action: x_0 + j p_bt [m]."""
    reach = abs(base_twist(pair)) * 0.5 * pair.face_width
    return pair.x_start - reach, pair.x_end + reach


def contact_lines(pair: GearPair, roll: ArrayLike, panel: float, weight: ArrayLike = ()) -> ContactLines:
    """Divide the contact lines of all pairs in reach.

    Parameters
    ----------
    pair : GearPair
    roll : array_like, shape (P,)
        Roll positions [m]: x of pair 0 in the middle of the face.
    panel : float
        Length of a panel along the face, at most [m].
    weight : array_like, shape (P,) or (0,)
        Part of a base pitch that each roll position stands for.

    Returns
    -------
    ContactLines

    Raises
    ------
    InputError
        If no pair is in reach at some position.
    """
    positions = np.atleast_1d(np.asarray(roll, dtype=float))
    half, slope, pitch = 0.5 * pair.face_width, base_twist(pair), pair.base_pitch
    shortest = shortest_line(pair)
    found: list[list[tuple[int, Array, Array, tuple[bool, bool]]]] = []
    for x0 in positions.tolist():
        lines = []
        first = math.floor((pair.x_start - abs(slope) * half - x0) / pitch)
        last = math.ceil((pair.x_end + abs(slope) * half - x0) / pitch)
        for j in range(first, last + 1):
            low, high, edges = _limits(pair, x0 + j * pitch, slope, half)
            if high - low < shortest * (1.0 - 1e-9):
                continue
            z = np.linspace(low, high, max(1, math.ceil((high - low) / panel - 1e-9)) + 1)
            lines.append((j, np.clip(x0 + j * pitch - slope * z, pair.x_start, pair.x_end), z, edges))
        if not lines:
            raise InputError(
                "pair", f"roll position {x0 * 1e3:.6g} mm", "has no tooth pair in reach of the line of action",
                "raise the contact ratio above 1",
            )  # fmt: skip
        found.append(lines)
    most = max(sum(z.size for _, _, z, _ in lines) for lines in found)
    shape = (positions.size, most)
    number, present = np.zeros(shape, dtype=np.int64), np.zeros(shape, dtype=bool)
    x_, z_, at_edge = np.zeros(shape), np.zeros(shape), np.zeros(shape, dtype=bool)
    for p, lines in enumerate(found):
        at = 0
        for j, x, z, edges in lines:
            here = slice(at, at + z.size)
            number[p, here], present[p, here], x_[p, here], z_[p, here] = j, True, x, z
            at_edge[p, at], at_edge[p, at + z.size - 1] = edges
            at += z.size
    return ContactLines(positions, number, present, x_, z_, -half, half, at_edge, np.asarray(weight, dtype=float))


def _limits(pair: GearPair, x: float, slope: float, half: float) -> tuple[float, float, tuple[bool, bool]]:
    """Between which heights a line is on the path and on the face, and whether its ends are tip or form circles."""
    slack = 1e-10 * pair.base_pitch
    if slope == 0.0:
        inside = pair.x_start - slack <= x <= pair.x_end + slack
        return (-half, half, (False, False)) if inside else (0.0, -1.0, (False, False))
    ends = sorted(((x - pair.x_end) / slope, (x - pair.x_start) / slope))
    return max(-half, ends[0]), min(half, ends[1]), (ends[0] > -half, ends[1] < half)
