"""Contact lines of all tooth pairs in reach, in the plane of action, divided into panels.

In the plane of action, x along the transverse line of action and z along the axes, the contact line of pair j at the
roll position x_0 is straight: x = x_0 + j p_bt - z tan(beta_b), the twist of the driver positive for a right hand (of
a ring for a left one). It ends at the tips and form circles in use and at the ends of the common face (ISO 21771, 5.4),
or goes on along the tip edges (`fegear.contact.wide.lines`).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.contact.wide.tip_edges import TipEdges, edge_reach, tip_edges
from fegear.geometry.pair import GearPair, Member

#: A contact line shorter than this is left out [modules]: it is no longer long beside its Hertzian width.
SHORTEST_LINE = 0.15
#: Lines shorter than this decide no largest value [modules]: they come and go at corners of the face, where panels are
#: as long as they are, and what they bear hangs on their number.
LONG_LINE = 1.0
#: Panels between ends of missing parts of flanks, and beside them, are no shorter than this share of the others.
_SHORTEST_PANEL = 0.125
#: Nothing nearer than this to where a line reaches a tip or form circle does, either [modules along the face]: loads
#: grow without a bound toward a sharp edge, and with only the last station neglected they would grow with the panels.
BESIDE_EDGE = 0.2


@dataclass(frozen=True)
class MissingPart:
    """Part of the plane of action in which a flank is missing: between two x and two z [m]."""

    x: tuple[float, float]
    z: tuple[float, float]

    def ends(self, at: float, slope: float) -> list[float]:
        """Heights at which the line x = at - slope z may enter or leave it."""
        return [*self.z, *((at - x) / slope for x in self.x if slope)]


@dataclass(frozen=True)
class ContactLines(ReadOnlyArrays):
    """Stations on the contact lines of P roll positions; arrays of shape (P, M), padded where fewer are needed.

    Parameters
    ----------
    roll : ndarray, shape (P,)
    pair : ndarray of int
        j, the pair that a station belongs to; stations of one line stand together, ascending in z.
    at_edge : ndarray of bool
        Whether a line ends here at a tip or form circle, or stands on a sharp tip edge.
    weight : ndarray, shape (P,)
        Part of a base pitch that each roll position stands for; they add up to 1. Empty: all alike.
    edges : TipEdges or None
        What the stations touch where lines go on along the tip edges; None where they end there.
    """

    roll: Array = shown("mm", "mesh position: x of tooth pair 0 at mid-face")
    pair: NDArray[np.int64] = shown("", "number of the tooth pair, increasing in the direction of rotation")
    present: Mask = shown("", "1: point exists (0: padding)")
    x: Array = shown(
        "mm", "position along the line of action, from the pitch point", label="position on the line of action"
    )
    z: Array = shown("mm", "face position from mid-face", label="face position z")
    low: float = shown("mm", "face position of end I of the common face width")
    high: float = shown("mm", "face position of end II of the common face width")
    at_edge: Mask = shown("", "1: contact line ends at a tip or form circle", name="edge")
    weight: Array = field(default_factory=lambda: np.empty(0))

    edges: TipEdges | None = None

    def roll_length(self, pair: GearPair, member: Member) -> Array:
        """Roll length of one gear where the stations touch, shape (P, M) [m]: on the path its radius of curvature."""
        return pair.flank_curvature_radius(self.x, member) if self.edges is None else self.edges.length(member)

    def roll_angle(self, pair: GearPair, member: Member) -> Array:
        """Roll angle of one gear where the stations touch, shape (P, M) [rad]."""
        return self.roll_length(pair, member) / pair.gear(member).base_radius

    def radius(self, pair: GearPair, member: Member) -> Array:
        """Radius of one gear where the stations touch, shape (P, M) [m]."""
        return pair.place_of_length(self.roll_length(pair, member), member)

    def mean(self, values: Array) -> Array:
        """Mean over a base pitch of what is known at the roll positions, shape (P, ...)."""
        count = self.roll.size
        weight = self.weight if self.weight.size else np.full(count, 1.0 / count)
        return np.asarray(np.tensordot(weight, values, axes=1))

    @cached_property
    def panel(self) -> Array:
        """Length along the face from each station to the next of its line, 0 where there is none, (P, M - 1) [m]."""
        same = self.present[:, 1:] & self.present[:, :-1] & (self.pair[:, 1:] == self.pair[:, :-1])
        return np.asarray(np.where(same, np.diff(self.z, axis=1), 0.0))

    @cached_property
    def support(self) -> Array:
        """Length along the face over which a station's unit of line load gathers its force, shape (P, M) [m]."""
        half = 0.5 * self.panel
        total = np.zeros(self.z.shape)
        total[:, :-1] += half
        total[:, 1:] += half
        return total

    @cached_property
    def middle(self) -> Array:
        """How far above a station the middle of what it carries lies, half as far as of the panels, (P, M) [m].

        It tells which side two stations at the same place are of.
        """
        quarter = 0.25 * self.panel
        total = np.zeros(self.z.shape)
        total[:, :-1] += quarter
        total[:, 1:] -= quarter
        return total

    @cached_property
    def length(self) -> Array:
        """Of all lines along the face, shape (P,) [m]."""
        return np.asarray(self.panel.sum(axis=1))

    def long(self, shortest: float) -> Mask:
        """Whether stations belong to lines of at least a length along the face [m], shape (P, M)."""
        found = np.zeros(self.present.shape, dtype=bool)
        for p in range(self.roll.size):
            for s in self.at(p):
                found[p, s] = self.z[p, s][-1] - self.z[p, s][0] >= shortest * (1.0 - 1e-9)
        return found

    def clearance(self, pair: GearPair, distance: float) -> Array:
        """How much farther than a distance along the face stations are from where lines reach tip or form circles.

        Counted along the line of action, negative nearer to it, shape (P, M) [m]. Also where a line would do so beyond
        the end of the face: one that comes to a corner changes steadily. Spur pairs' lines stand along tips as a whole,
        at no distance.
        """
        room = (1.0 - 1e-9) * distance * abs(base_twist(pair))
        if self.edges is None:
            return np.minimum(np.abs(self.x - pair.x_start), np.abs(self.x - pair.x_end)) - room
        return np.asarray(-room - self.edges.tilt)

    def clear(self, pair: GearPair, distance: float) -> Mask:
        """Stations farther than a distance along the face from where their line reaches a tip or form circle, (P, M).

        All stations of spur pairs are, and so are those beside rounded tips on which lines go on.
        """
        return np.asarray(self.present & ~self.at_edge & ~(self.clearance(pair, distance) < 0.0))

    def at(self, position: int) -> tuple[slice, ...]:
        """Where the lines of a roll position stand, in the order of their pairs."""
        return self._spans[position]

    @cached_property
    def _spans(self) -> tuple[tuple[slice, ...], ...]:
        found = []
        for present, pair in zip(self.present, self.pair, strict=True):
            count = int(present.sum())
            starts = [0, *(1 + np.flatnonzero(np.diff(pair[:count]))).tolist(), count]
            found.append(tuple(slice(a, b) for a, b in itertools.pairwise(starts)))
        return tuple(found)


def base_twist(pair: GearPair) -> float:
    """Tangent of the base helix angle, positive for a right-handed external and a left-handed internal driver."""
    return pair.driver.flank_twist * pair.driver.base_radius


def shortest_line(pair: GearPair) -> float:
    """Length along the face below which a contact line is left out [m]."""
    return min(SHORTEST_LINE * pair.driver.module, 0.5 * pair.face_width)


def long_line(pair: GearPair) -> float:
    """Length along the face from which on a contact line decides largest values [m]: all lines of spur gears."""
    return min(LONG_LINE * pair.driver.module, 0.5 * pair.face_width)


def life_of_contact(pair: GearPair) -> tuple[float, float]:
    """First and last place of a contact line's middle while it touches the plane of action: x_0 + j p_bt [m]."""
    reach = abs(base_twist(pair)) * 0.5 * pair.face_width
    return pair.x_start - reach, pair.x_end + reach


def contact_lines(
    pair: GearPair,
    roll: ArrayLike,
    panel: float,
    weight: ArrayLike = (),
    most_gap: float = 0.0,
    missing: tuple[MissingPart, ...] = (),
) -> ContactLines:
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
    most_gap : float
        Lines go on along tip edges up to this distance from the mate [m]; 0 for lines that end at tips.
    missing : tuple of MissingPart
        Of flanks of some teeth: lines of all have two stations at each end of these, one for either side.

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
    before, after = edge_reach(pair, most_gap)
    start, end = pair.x_start - before, pair.x_end + after
    found: list[list[tuple[int, Array, Array, tuple[bool, bool]]]] = []
    for x0 in positions.tolist():
        lines = []
        first = math.floor((start - abs(slope) * half - x0) / pitch)
        last = math.ceil((end + abs(slope) * half - x0) / pitch)
        for j in range(first, last + 1):
            at = x0 + j * pitch
            low, high, edges = _limits(at, slope, half, (start, end), 1e-10 * pitch)
            if high - low < shortest * (1.0 - 1e-9):
                continue
            tips = sorted((at - x) / slope for x in (pair.x_start, pair.x_end)) if slope and most_gap > 0.0 else []
            z = _stations(low, high, tips, [end for part in missing for end in part.ends(at, slope)], panel)
            lines.append((j, np.clip(at - slope * z, start, end), z, edges))
        if not lines:
            raise InputError(
                "pair", f"roll position {x0 * 1e3:.6g} mm", "has no tooth pair in contact",
                "increase the contact ratio above 1",
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
    touched = tip_edges(pair, x_) if most_gap > 0.0 else None
    if touched is not None:
        on_edge = np.where(touched.gap > 0.0, touched.tilt > -np.inf, touched.tilt >= -1e-9 * pair.base_pitch)
        at_edge = present & (on_edge | (at_edge & (touched.gap == 0.0)))
    return ContactLines(
        positions, number, present, x_, z_, -half, half, at_edge, np.asarray(weight, dtype=float), touched
    )


def _stations(low: float, high: float, tips: list[float], missing: list[float], panel: float) -> Array:
    """Stations of a line: equal panels, from tip edge to tip edge where these lie on it."""
    inside = [z for z in tips if low + 0.5 * panel < z < high - 0.5 * panel]
    fixed = [low, *inside, high]
    jumps = _apart(missing, fixed, _SHORTEST_PANEL * panel)
    ends = sorted([*fixed, *jumps])
    parts = [np.linspace(a, b, max(1, math.ceil((b - a) / panel - 1e-9)) + 1) for a, b in itertools.pairwise(ends)]
    return np.concatenate([parts[0], *(part[int(part[0] not in jumps) :] for part in parts[1:])])


def _apart(places: list[float], fixed: list[float], distance: float) -> list[float]:
    """Of places on a line those farther than a distance from all other ends of panels.

    There a load ends at full height: two stations at the same place carry what is on either side. With a single one it
    would fall to nothing over a panel, and the end of a missing part of the flank were uncertain by half of it.
    """
    inside = {z for z in places if fixed[0] < z < fixed[-1]}
    return [z for z in inside if all(abs(z - other) >= distance for other in (*fixed, *inside) if other != z)]


def _limits(
    x: float, slope: float, half: float, path: tuple[float, float], slack: float
) -> tuple[float, float, tuple[bool, bool]]:
    """Between which heights a line is on the path and on the face, and whether its ends are those of the path."""
    if slope == 0.0:
        inside = path[0] - slack <= x <= path[1] + slack
        return (-half, half, (False, False)) if inside else (0.0, -1.0, (False, False))
    ends = sorted(((x - path[1]) / slope, (x - path[0]) / slope))
    return max(-half, ends[0]), min(half, ends[1]), (ends[0] > -half, ends[1] < half)
