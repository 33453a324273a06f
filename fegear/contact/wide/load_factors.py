"""Load factors of solved flanks: what uneven load along the face and between the pairs adds to load and root stress.

K_Hbeta is with the loads (`LoadedFlanks.face_load_factor`). For the root, three loads are compared, each over a whole
mesh cycle: the solved one; the same with the share of every pair spread evenly along its contact line; and the shares
of perfect flanks spread so. Their largest root tensions s_1, s_2, s_3 give K_Fbeta = s_1 / s_2, K_Falpha = s_2 / s_3.

The tension is that across the root, at right angles to the helix. Where a helical mesh begins or ends at a corner of
the face its stress is that of a contact at a point rather than of a bent tooth: nothing is looked for within half a
module of the ends of the face, and a share that would be spread evenly over less than a module of line is left out.

Load over the face averaged over a base pitch: contact lines followed from one roll position to the next.

Contact lines bear more at their ends than in their middle, and the ends wander along the face as the gears turn. At a
fixed place of the face the load therefore comes and goes faster than roll positions follow; along a line it changes
slowly. So each line is carried over to the next position by its own length: its ends move evenly between them, and so
does the load between its ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.wide.lines import ContactLines, long_line

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.root_stress import RootedLines
    from fegear.geometry.pair import GearPair


#: Of helical pairs: what is left out at the ends of the face [modules].
_FREE_END = 0.5


#: Places nearer to each other than this share of the face are one.
_BESIDE = 1e-9
#: Places along the face at which the gap is read for its straight part.
_READ = 101


@dataclass(frozen=True)
class RootFactors:
    """K_Fbeta and K_Falpha of one gear, and the largest root tension of the solved load, across the root [Pa]."""

    face: float
    transverse: float
    largest: float


def transverse_load_factor(found: LoadedFlanks, perfect: LoadedFlanks) -> Array:
    """K_Halpha, shape (L,): largest load on a pair over the mesh cycle, over the largest of perfect flanks."""
    return np.asarray(found.pair_load.max(axis=(0, 1)) / perfect.pair_load.max(axis=(0, 1)))


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
    largest, even, best = (rooted.largest("tension", force, places, across=True) for force in loads)
    return RootFactors(largest / even, even / best, largest)


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
        If the pair lies outside the range of the standard's mesh stiffness.
    """
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


#: Places between two roll positions at which the lines are looked at.
_BETWEEN = 8


def load_below(place: Array, line_load: Array, ends: Array) -> Array:
    """Integral of loads, straight between their stations, up to some places, shape (*ends.shape, L).

    Parameters
    ----------
    place : ndarray, shape (n,)
        Stations, ascending.
    line_load : ndarray, shape (n, L)
        Per length along `place`.
    ends : ndarray
    """
    h = np.diff(place)
    whole = np.zeros_like(line_load)
    np.cumsum(0.5 * h[:, None] * (line_load[1:] + line_load[:-1]), axis=0, out=whole[1:])
    at = np.clip(ends, place[0], place[-1])
    i = np.clip(np.searchsorted(place, at, side="right") - 1, 0, h.size - 1)
    part = ((at - place[i]) / h[i])[..., None]
    return np.asarray(
        whole[i] + h[i][..., None] * part * (line_load[i] + 0.5 * part * (line_load[i + 1] - line_load[i]))
    )


def averaged_along(lines: ContactLines, line_load: Array, window: Array | None) -> Array:
    """Loads averaged along their lines as far to either side as a window is longer than a panel, shape (P, M, L).

    Mirrored at the ends of a line: an even load stays what it is, and so does the sum of any. Where panels are longer
    than the window, loads are what they are.

    Parameters
    ----------
    lines : ContactLines
    line_load : ndarray, shape (P, M, L)
        [N/m].
    window : ndarray, shape (P, M), or None
        The same all along a line [m].
    """
    if window is None:
        return line_load
    found = line_load.copy()
    for p in np.flatnonzero(((lines.panel > 0.0) & (lines.panel < window[:, :-1])).any(axis=1)).tolist():
        for s in lines.at(p):
            z, load = lines.z[p, s], line_load[p, s]
            reach = min(float(window[p, s.start] - np.diff(z).max()), float(z[-1] - z[0]))
            if reach <= 0.0:
                continue
            place = np.concatenate([2.0 * z[0] - z[:0:-1], z, 2.0 * z[-1] - z[-2::-1]])
            mirrored = np.concatenate([load[:0:-1], load, load[-2::-1]])
            above, below = (load_below(place, mirrored, z + side * reach) for side in (1.0, -1.0))
            found[p, s] = (above - below) / (2.0 * reach)
    return found


def swept_mean(lines: ContactLines, line_load: Array, ends: Array, pitch: float) -> Array:
    """Load of all lines together between heights, averaged over a base pitch, shape (n - 1, L) [N].

    Parameters
    ----------
    lines : ContactLines
        At roll positions of one base pitch, ascending.
    line_load : ndarray, shape (P, M, L)
        [N/m].
    ends : ndarray, shape (n,)
        Heights [m].
    pitch : float
        Base pitch [m].
    """
    count = lines.roll.size
    known = [{int(lines.pair[p, s.start]): s for s in lines.at(p)} for p in range(count)]
    total = np.zeros((ends.size, line_load.shape[2]))
    moving: list[tuple[float, tuple[int, slice], tuple[int, slice]]] = []
    for p in range(count):
        q, ahead = (p + 1) % count, (p + 1) // count
        step = float((lines.roll[q] + ahead * pitch - lines.roll[p]) / pitch)
        after = {j - ahead: s for j, s in known[q].items()}  # a base pitch on, every pair is where the one ahead was
        if known[p].keys() != after.keys():
            for where, spans in ((p, known[p]), (q, after)):
                for s in spans.values():
                    total += 0.5 * step * load_below(lines.z[where, s], line_load[where, s], ends)
            continue
        moving += [(step, (p, s), (q, after[j])) for j, s in known[p].items()]
    if moving:
        total += _moved(lines, line_load, ends, moving)
    return np.diff(total, axis=0)


def _moved(
    lines: ContactLines, line_load: Array, ends: Array, moving: list[tuple[float, tuple[int, slice], tuple[int, slice]]]
) -> Array:
    """Load below heights, averaged while lines move from where they are at one roll position to the next, (n, L) [N].

    Each is as far on its way as all others; on its length the load is that of both ends of the way in turn.
    """
    theta = ((np.arange(_BETWEEN) + 0.5) / _BETWEEN)[:, None]
    places: tuple[list[Array], list[Array]] = ([], [])
    loads: tuple[list[Array], list[Array]] = ([], [])
    low: tuple[list[float], list[float]] = ([], [])
    length: tuple[list[float], list[float]] = ([], [])
    for _, *both in moving:
        for end, (p, s) in enumerate(both):
            z = lines.z[p, s]
            low[end].append(z[0])
            length[end].append(z[-1] - z[0])
            places[end].append((z - z[0]) / (z[-1] - z[0]))
            loads[end].append(line_load[p, s] * (z[-1] - z[0]))
    (low_0, low_1), (length_0, length_1) = (np.array(one)[:, :, None, None] for one in (low, length))
    share = (ends - low_0 - theta * (low_1 - low_0)) / (length_0 + theta * (length_1 - length_0))
    before, behind = (_loads_below(place, load, share) for place, load in zip(places, loads, strict=True))
    step = np.array([one for one, *_ in moving])[:, None, None]
    way = theta[:, :, None]
    return np.asarray((step * ((1.0 - way) * before + way * behind).mean(axis=1)).sum(axis=0))


def _loads_below(place: list[Array], line_load: list[Array], ends: Array) -> Array:
    """`load_below` of K lines, each as far as its own places, shape (K, ...), on lines of length 1: (K, ..., L)."""
    sizes = np.array([one.size for one in place])
    first = np.cumsum(sizes) - sizes
    flat, load = np.concatenate(place), np.concatenate(line_load)
    h, two = np.diff(flat, append=np.nan), 0.5 * (load + np.roll(load, -1, axis=0))
    piece = h[:, None] * two
    piece[first + sizes - 1] = 0.0  # from one line to the next
    whole = np.concatenate([np.zeros((1, load.shape[1])), np.cumsum(piece, axis=0)[:-1]])
    which = np.arange(sizes.size).reshape(-1, *[1] * (ends.ndim - 1))
    at = np.clip(ends, 0.0, 1.0)
    # Lines stand one behind the other, two lengths apart; a station missed by rounding changes nothing of the integral.
    i = np.searchsorted(flat + 2.0 * np.repeat(np.arange(sizes.size), sizes), at + 2.0 * which, side="right") - 1
    i = np.clip(i, first[which], (first + sizes - 2)[which])
    part = ((at - flat[i]) / h[i])[..., None]
    below = whole[i] - whole[first[which]]
    return np.asarray(below + h[i][..., None] * part * (load[i] + 0.5 * part * (load[i + 1] - load[i])))
