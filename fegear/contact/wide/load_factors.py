"""Load factors of solved flanks: what uneven load along the face and between the pairs adds to load and root stress.

K_Hbeta is with the loads (`LoadedFlanks.face_load_factor`). For the root, three loads are compared, each over a whole
mesh cycle: the solved one; the same with the share of every pair spread evenly along its contact line; and the shares
of perfect flanks spread so. Their largest root tensions s_1, s_2, s_3 give K_Fbeta = s_1 / s_2, K_Falpha = s_2 / s_3.

The tension is that across the root, at right angles to the helix. Where a helical mesh begins or ends at a corner of
the face its stress is that of a contact at a point rather than of a bent tooth: nothing is looked for within half a
module of the ends of the face, and a share that would be spread evenly over less than a module of line is left out.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.contact.wide.lines import ContactLines, long_line

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.geometry.pair import GearPair


#: Of helical pairs: what is left out at the ends of the face [modules].
_FREE_END = 0.5


#: Every so many roll positions are looked at, and what is taken for an error of what that changes; half of it of so
#: many positions, where largest values come with the second power of their distance (of two helical pairs those of 16
#: were 4 to 29 times as far off as those of 48) rather than as at a kink.
_FEWER, _MANY = ((2, 1.0), (3, 0.5)), 48
#: Places nearer to each other than this share of the face are one.
_BESIDE = 1e-9
#: Places along the face at which the gap is read for its straight part.
_READ = 101


class FactorsLeft(NamedTuple):
    """What the number of roll positions leaves open of K_Fbeta, K_Falpha and the largest root tension [Pa]."""

    face: float
    transverse: float
    largest: float


_NOTHING_LEFT = FactorsLeft(0.0, 0.0, 0.0)


@dataclass(frozen=True)
class RootFactors:
    """K_Fbeta and K_Falpha of one gear, and the largest root tension of the solved load, across the root [Pa].

    `left_by_positions` is what the number of roll positions leaves open of these.
    """

    face: float = shown("", "maximum root stress over that with uniform load along each contact line", name="K_Fbeta")
    transverse: float = shown(
        "", "maximum root stress with uniform load along each line over that of unmodified flanks", name="K_Falpha"
    )
    largest: float = shown("MPa", "maximum root stress in the normal section")
    left_by_positions: FactorsLeft = _NOTHING_LEFT


def transverse_load_factor(found: LoadedFlanks, perfect: LoadedFlanks) -> Array:
    """K_Halpha, shape (L,): largest load on a pair over the mesh cycle, over the largest of perfect flanks."""
    return np.asarray(found.pair_load.max(axis=(0, 1)) / perfect.pair_load.max(axis=(0, 1)))


def transverse_left_by_positions(found: LoadedFlanks, perfect: LoadedFlanks) -> Array:
    """What the number of roll positions leaves open of K_Halpha, shape (L,): see `fewer_positions`."""
    load, ideal = found.pair_load.max(axis=0), perfect.pair_load.max(axis=0)
    whole = load.max(axis=0) / ideal.max(axis=0)
    changes = [
        part * np.abs(load[at].max(axis=0) / ideal[at].max(axis=0) - whole)
        for part, at in fewer_positions(found.lines.roll.size)
    ]
    return np.asarray(np.max(changes, axis=0))


def fewer_positions(count: int) -> list[tuple[float, Mask]]:
    """Parts of so many roll positions, shape (P,) each, and how much of what each changes is taken for an error.

    A factor is a ratio of largest values, which stand between the positions. Without every second of them either the
    nearest position or the next one is left: both change nothing if these are equally far. Every third has neither
    once: a kink is half as far from the nearest position, at most, as that moves it.
    """
    number = np.arange(count)
    of = 0.5 if count >= _MANY else 1.0
    every = [(of * part, number % step == first) for step, part in _FEWER for first in range(step)]
    return [(part, at) for part, at in every if at.any()]


def left_of_largest(values: Array, position: Index, count: int) -> Array:
    """What the number of roll positions leaves open of the largest of some values, shape (L,): see `fewer_positions`.

    Parameters
    ----------
    values : ndarray, shape (T, L)
    position : ndarray of int, shape (T,)
        At which of the roll positions each is.
    count : int
        Number of roll positions.
    """
    largest = values.max(axis=0)
    changes = [part * (largest - values[at[position]].max(axis=0)) for part, at in fewer_positions(count)]
    return np.asarray(np.max(changes, axis=0))


def even_along_the_lines(lines: ContactLines, force: Array, shortest: float = 0.0) -> Array:
    """The force of every contact line spread evenly along it, shape (P, M) [N]; none on lines of less than `shortest`.

    A line's length is that along the face [m].
    """
    even, support = np.zeros(force.shape), lines.support
    for p in range(lines.roll.size):
        for s in lines.at(p):
            if lines.z[p, s][-1] - lines.z[p, s][0] < shortest:
                continue
            even[p, s] = force[p, s].sum() * support[p, s] / support[p, s].sum()
    return even


def root_factors(found: LoadedFlanks, perfect: LoadedFlanks, rooted: RootedLines, z: Array, case: int) -> RootFactors:
    """K_Fbeta and K_Falpha of a gear.

    Parameters
    ----------
    found, perfect : LoadedFlanks
        As loaded, and without anything that keeps the flanks apart; on the lines of `rooted`.
    rooted : RootedLines
        Of the gear.
    z : ndarray
        Places along the face at which stress is looked for [m].
    case : int
        Number of the load.
    """
    solved, ideal = found.contact.force[:, :, case], perfect.contact.force[:, :, case]
    helical, m, lines = found.pair.driver.helix_angle != 0.0, found.pair.driver.module, found.lines
    shortest = long_line(found.pair) if helical else 0.0
    loads = solved, even_along_the_lines(lines, solved, shortest), even_along_the_lines(lines, ideal, shortest)
    # A place that stands at such an end, in all but its last digit, counts.
    free = _FREE_END * m - _BESIDE * (lines.high - lines.low)
    inside = (z >= lines.low + free) & (z <= lines.high - free)
    places = z[inside] if helical and inside.any() else z
    felt = [rooted.surface("tension", force, places) for force in loads]

    def largest(at: Mask | None = None) -> list[float]:
        return [
            rooted.largest("tension", force, places, surface, across=True, at=at)
            for force, surface in zip(loads, felt, strict=True)
        ]

    whole = largest()
    face, transverse = _ratios(whole)
    changes = []
    for part, at in fewer_positions(lines.roll.size):
        fewer = largest(at)
        changes.append(part * np.abs(np.subtract((*_ratios(fewer), fewer[0]), (face, transverse, whole[0]))))
    return RootFactors(face, transverse, whole[0], FactorsLeft(*np.max(changes, axis=0).tolist()))


def _ratios(largest: Sequence[float]) -> tuple[float, float]:
    """K_Fbeta and K_Falpha of largest tensions s_1, s_2, s_3; one where no load that counts is on the lines."""
    face, transverse = (one / two if two > 0.0 else 1.0 for one, two in pairwise(largest))
    return face, transverse


def straight_gap(pair: GearPair, gaps: FlankGaps) -> float:
    """F_betay: straight part of the gap over the face at the pitch point, from end to end, by least squares [m]."""
    half = 0.5 * pair.face_width
    z = np.linspace(-half, half, _READ)[None]
    on = np.ones(z.shape, dtype=bool)
    lines = ContactLines(np.zeros(1), np.zeros(z.shape, dtype=np.int64), on, np.zeros(z.shape), z, -half, half, ~on)
    gap = gaps.at(pair, lines)
    return float(2.0 * half * (z * gap).sum() / (z * z).sum())


def iso_face_load_factor(pair: GearPair, gaps: FlankGaps, load: float) -> float:
    """K_Hbeta by the closed formula of ISO 6336-1, from the straight part of the gap, not run in.

    Parameters
    ----------
    pair : GearPair
    gaps : FlankGaps
    load : float
        F_bt, along the transverse line of action [N].

    Raises
    ------
    RangeError
        If the pair lies outside the range of the standard's mesh stiffness: of asymmetric teeth it has none.
    """
    if pair.asymmetric:
        angle = math.degrees(pair.from_the_back.driver.normal_pressure_angle)
        raise RangeError("non-working flanks", f"{angle:.6g} deg", "are not in ISO 6336-1 (equal flanks only)")
    from fegear.formulas.iso6336.part1_face_load import face_load_factor
    from fegear.formulas.iso6336.part1_stiffness import pair_stiffness

    specific_load = pair.specific_load(load)
    stiffness = pair_stiffness(pair, specific_load=specific_load).mesh_beta
    return face_load_factor(straight_gap(pair, gaps.under(load)), stiffness, specific_load)


def iso_root_exponent(pair: GearPair) -> float:
    """N_F of ISO 6336-1 for both gears of a pair."""
    from fegear.formulas.iso6336.part1_face_load import root_exponent

    gears = pair.driver, pair.driven
    depths = [gear.module * abs(gear.tooth.tip_radius - gear.tooth.root_radius) for gear in gears]
    return root_exponent((gears[0].face_width, gears[1].face_width), (depths[0], depths[1]))
