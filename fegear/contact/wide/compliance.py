"""Both solid gears' influence functions put together for all stations of all contact lines at a roll position.

Each gear is seen in its own drawing, loaded flank toward +x: turning the driven gear's by half a turn about the axis
lays both together, so heights z count alike on both, and hands are opposite. A ring is drawn as its own mirror image
(`Gear.flank_twist`), and its mate has its hand. Teeth have numbers (`fegear.fem.alike_teeth`): in base pitch p pair j
is on tooth j - p of the driver and on tooth p - j of the driven gear.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from fegear.base.arrays import Array, Index, ReadOnlyArrays
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.base.tally import tallied
from fegear.contact.contact_law import ContactLaw
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.contact.wide.averages import Averages, averages
from fegear.contact.wide.lines import ContactLines
from fegear.fem.solid.bands import Bands, bands
from fegear.fem.solid.flank_body import FlankBody, FlankLines
from fegear.geometry.pair import MEMBERS, GearPair, Member

Hertz = Literal["load-dependent", "linear", "none"]

#: Half-width of a contact that does not know its load [modules], as in the plane.
_NOMINAL_HALF_WIDTH = 0.08
#: The load that a contact's width follows is averaged to either side over this many half-widths.
_WINDOW = 2.0
#: Pressed half-widths go in steps of this ratio, so that few of them occur.
_WIDTH_STEP = 0.8
#: Stations whose loads are held in memory at once.
_STATIONS_AT_ONCE = 4000


def _matrix(data: bytes | memoryview) -> Array | None:
    found = unpack(data)
    return found if isinstance(found, np.ndarray) and found.ndim == 3 else None


#: Matrices as they are kept on disk.
_PLAIN: Codec[Array] = Codec(pack, _matrix)


@dataclass(frozen=True)
class FlankCompliance(ReadOnlyArrays):
    """What the stations of all contact lines do to each other; all that contact needs besides loads and gaps.

    Parameters
    ----------
    lines : ContactLines
    matrix : ndarray, shape (P, M, M)
        Approach of station i along the transverse line of action per unit force on station j, both gears, contacts of
        `line_half_width` [m/N]; identity where no station is. What other widths change is in `log_slope`.
    log_slope : float
        A line load f [N/m] approaches by -2 log_slope f ln b more, b its half-width over `line_half_width` [m^2/N].
    width_factor : ndarray, shape (P, M)
        b^2 = width_factor f: 4 R / (pi E*) [m^3/N], R across the contact line.
    fixed_half_width : ndarray, shape (P, M), or None
        Half-width of contacts that do not follow their load [m]; None where they do.
    line_half_width : ndarray, shape (P, M), or None
        The half-width that stands for each contact line in `matrix` [m]; None for one metre, and for contacts whose
        width follows the load of a single place (see `averages`).
    spot : ndarray, shape (P, 1), or None
        Half-width of contacts that are much wider than their line's mean load makes them, as on crowned flanks that
        touch at a spot [m]; None where there are none.
    """

    lines: ContactLines
    matrix: Array
    log_slope: float
    width_factor: Array
    fixed_half_width: Array | None
    line_half_width: Array | None = None
    spot: Array | None = None

    @property
    def window(self) -> Array | None:
        """Distance to either side over which the load is averaged that a contact's width follows, (P, M) [m]."""
        if self.line_half_width is None or self.fixed_half_width is not None:
            return None
        return _WINDOW * (self.line_half_width if self.spot is None else np.maximum(self.line_half_width, self.spot))

    @cached_property
    def averages(self) -> Averages:
        """How the load that a contact's width follows is averaged along its line."""
        return averages(self.lines, self.window)

    def law(self, place: Index, share: tuple[float, float], tilt: Array | None = None) -> ContactLaw:
        """The law of line loads at a point of each panel, of contacts that follow their load, shape (B, M - 1).

        Parameters
        ----------
        place : ndarray of int, shape (B,)
            Roll positions.
        share : (float, float)
            Weights of the stations at both ends of a panel at the point.
        tilt : ndarray, shape (B, M - 1), optional
            theta R of tip edges [m]: see `edge_law`; without it no edge is near.
        """
        q = self.width_factor[place]
        unit = np.ones_like(q) if self.line_half_width is None else self.line_half_width[place]
        reference = unit[:, :-1] ** 2 / (share[0] * q[:, :-1] + share[1] * q[:, 1:])
        none = np.zeros(1)
        edges = None if tilt is None else EdgeContacts(tilt / unit[:, :-1], none, none)
        return ContactLaw(2.0 * self.log_slope, reference, edges)

    def half_width(self, line_load: Array) -> Array:
        """Hertzian half-width b under line loads of shape (P, M, L) [m]."""
        return np.asarray(np.sqrt(self.width_factor[:, :, None] * line_load))

    def pressure(self, line_load: Array) -> Array:
        """Largest Hertzian pressure 2 f / (pi b) of smooth long contacts, shape (P, M, L) [Pa]."""
        b = self.half_width(line_load)
        return np.divide(2.0 * line_load, np.pi * b, out=np.zeros_like(b), where=b > 0.0)


def flank_compliance(
    pair: GearPair,
    gears: Mapping[Member, FlankBody],
    lines: ContactLines,
    load: float,
    *,
    coupling: bool = True,
    hertz: Hertz = "load-dependent",
    cache: SolutionCache | None = None,
    cycle: int = 0,
) -> FlankCompliance:
    """Assemble the compliance of all stations at all roll positions.

    Parameters
    ----------
    pair : GearPair
    gears : mapping of {"driver", "driven"} to FlankBody
    lines : ContactLines
    load : float
        About which the ends of the contacts are taken, and all of a linear contact [N].
    coupling : bool
        Whether pairs deflect each other, as far as the solutions reach.
    hertz : {"load-dependent", "linear", "none"}
        The half-width follows each station's own line load; is that of the mean line load at `load`; or 0.08 modules.
    cache : SolutionCache, optional
        Where what does not depend on the load is recalled from and kept.
    cycle : int
        Number of the base pitch: which teeth are on the pairs.

    Returns
    -------
    FlankCompliance
    """
    module, lean = pair.driver.module, math.cos(pair.driver.base_helix_angle)
    across = _relative_radius(pair, lines) / lean
    moduli = [pair.gear(m).material for m in MEMBERS]
    softness = sum((1.0 - m.poisson_ratio**2) / m.young_modulus for m in moduli)
    factor = 4.0 * across * softness / math.pi
    b = np.sqrt(factor * (load / lines.length)[:, None])
    b = np.full(lines.x.shape, _NOMINAL_HALF_WIDTH * module) if hertz == "none" else b
    mean = _line_means(lines, b)
    # Apart, so that a changed load has little to find anew, and changed gaps nothing.
    known = cache or SolutionCache()
    usual = {member: gears[member].usual for member in MEMBERS}
    own = known.call_kept(_PLAIN, _own, pair, usual, lines).value
    matrix = own + known.call_kept(_PLAIN, _widened, pair, usual, lines, b, mean).value
    if coupling:
        matrix += known.call_kept(_PLAIN, _beside, pair, usual, lines).value
    if any(usual[member] is not gears[member] for member in MEMBERS):
        first = like_cycle(gears, lines, cycle)
        matrix += known.call(_by_odd_teeth, pair, gears, lines, first, coupling=coupling).value
    index = np.arange(lines.x.shape[1])
    matrix[:, index, index] += np.where(lines.present, 0.0, 1.0)
    log_slope = sum(gears[m].contact_slope / pair.gear(m).material.young_modulus for m in MEMBERS)
    return FlankCompliance(lines, matrix, log_slope, factor, None if hertz == "load-dependent" else b, mean)


def like_cycle(gears: Mapping[Member, FlankBody], lines: ContactLines, cycle: int) -> int:
    """The first base pitch whose teeth answer as those of another, itself if no other: 0 where all teeth are alike."""
    pairs = lines.pair[lines.present]
    low, high = int(pairs.min()), int(pairs.max())

    def pattern(number: int) -> tuple[int, int]:
        starts = zip(MEMBERS, (low - number, number - high), strict=True)
        driver, driven = (gears[member].same_as(first, high - low + 1) for member, first in starts)
        return driver, driven

    every = math.lcm(*(gears[member].period for member in MEMBERS))
    return next((number for number in range(every) if pattern(number) == pattern(cycle)), cycle)


def places_of(lines: ContactLines) -> tuple[list[tuple[int, slice]], list[slice]]:
    """Roll position and stations of every contact line, and its stations among those of all lines in a row."""
    places = [(p, s) for p in range(lines.roll.size) for s in lines.at(p)]
    ends = np.cumsum([0, *(s.stop - s.start for _, s in places)]).tolist()
    return places, [slice(a, b) for a, b in itertools.pairwise(ends)]


def _own(pair: GearPair, gears: Mapping[Member, FlankBody], lines: ContactLines) -> Array:
    """What each line does to itself under contacts of half-width one metre, less what `_widened` adds, (P, M, M)."""
    module = pair.driver.module
    matrix = np.zeros((*lines.x.shape, lines.x.shape[1]))
    for member in MEMBERS:
        softer, log = _softer(pair, member), 2.0 * math.log(module) * gears[member].contact_slope
        for places, pressed in _pressed(pair, gears, member, lines):
            for (p, s), own, common in zip(places, pressed.own(), pressed.common, strict=True):
                matrix[p, s, s] += softer * (own + log * common)
    return matrix


def _widened(
    pair: GearPair,
    gears: Mapping[Member, FlankBody],
    lines: ContactLines,
    half_width: Array,
    mean: Array,
) -> Array:
    """What half-widths change, those of the stations and of their lines, (P, M) [m]; cheap, shape (P, M, M)."""
    matrix = np.zeros((*lines.x.shape, lines.x.shape[1]))
    for member in MEMBERS:
        softer, slope = _softer(pair, member), gears[member].contact_slope
        for places, pressed in _pressed(pair, gears, member, lines):
            width = np.concatenate([half_width[p, s] for p, s in places]) / pair.driver.module
            for (p, s), wider, common in zip(places, pressed.widened(width), pressed.common, strict=True):
                matrix[p, s, s] += softer * (wider - 2.0 * math.log(mean[p, s.start]) * slope * common)
    return matrix


@tallied("neighbours")
def _beside(pair: GearPair, gears: Mapping[Member, FlankBody], lines: ContactLines) -> Array:
    """What the lines of each roll position do to each other, shape (P, M, M); its transpose by Maxwell."""
    matrix = np.zeros((*lines.x.shape, lines.x.shape[1]))
    for member in MEMBERS:
        body, softer = gears[member], _softer(pair, member)
        for places, pressed in _pressed(pair, gears, member, lines):
            tooth = teeth_on(member, lines, places)
            found: dict[int, list[tuple[int, int]]] = {}
            for _, group in itertools.groupby(range(len(places)), key=lambda line: places[line][0]):
                for a, b in itertools.combinations(group, 2):
                    if abs(k := tooth[a] - tooth[b]) <= body.reach:
                        found.setdefault(k, []).append((a, b))
            for k, pairs in found.items():
                for (a, b), block in zip(pairs, pressed.between(k, 0, pairs), strict=True):
                    (p, first), (_, second) = places[a], places[b]
                    matrix[p, first, second] += softer * block
                    matrix[p, second, first] += softer * block.T
    return matrix


def _by_odd_teeth(
    pair: GearPair, gears: Mapping[Member, FlankBody], lines: ContactLines, cycle: int, *, coupling: bool
) -> Array:
    """What teeth that differ change of both, shape (P, M, M): what is near the contacts stays as it is."""
    matrix = np.zeros((*lines.x.shape, lines.x.shape[1]))
    for member in MEMBERS:
        body, softer = gears[member], _softer(pair, member)
        line, (places, spans) = line_bands(pair, member, body, lines), places_of(lines)
        tooth = teeth_on(member, lines, places, cycle)
        found: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for _, group in itertools.groupby(range(len(places)), key=lambda number: places[number][0]):
            for a, b in itertools.combinations_with_replacement(group, 2):
                i, j = tooth[a], tooth[b]
                if (i == j or (coupling and abs(i - j) <= body.reach)) and body.differ(i, j):
                    found.setdefault((i, j), []).append((a, b))
        odd, usual = (one.pressed(line, spans, tooth) for one in (body, body.usual))
        for (i, j), pairs in found.items():
            blocks = odd.between(i, j, pairs), usual.between(i, j, pairs)
            for (a, b), new, old in zip(pairs, *blocks, strict=True):
                (p, first), (_, second) = places[a], places[b]
                change = softer * (new - old)
                matrix[p, first, second] += change
                if a != b:
                    matrix[p, second, first] += change.T
    return matrix


def teeth_on(member: Member, lines: ContactLines, places: Sequence[tuple[int, slice]], cycle: int = 0) -> list[int]:
    """Numbers of a gear's teeth on contact lines in a base pitch."""
    forward = 1 if member == "driver" else -1
    return [forward * (int(lines.pair[p, s.start]) - cycle) for p, s in places]


def _softer(pair: GearPair, member: Member) -> float:
    """Metres per newton of a gear's dimensionless compliances."""
    return 1.0 / (pair.gear(member).material.young_modulus * pair.driver.module)


def _pressed(
    pair: GearPair, gears: Mapping[Member, FlankBody], member: Member, lines: ContactLines
) -> Iterator[tuple[list[tuple[int, slice]], FlankLines]]:
    """Press the lines on one gear, those of some roll positions at a time: where they stand, and what they answer."""
    body = gears[member]
    line, (places, spans) = line_bands(pair, member, body, lines), places_of(lines)
    # Whole roll positions, for what their lines do to each other.
    chunk = np.cumsum(lines.present.sum(axis=1)) // _STATIONS_AT_ONCE
    for _, group in itertools.groupby(range(len(places)), key=lambda i: int(chunk[places[i][0]])):
        some = list(group)
        start, stop = spans[some[0]].start, spans[some[-1]].stop
        moved = [slice(spans[i].start - start, spans[i].stop - start) for i in some]
        here = [places[i] for i in some]
        yield here, body.pressed(line.part(slice(start, stop)), moved, teeth_on(member, lines, here))


def line_bands(pair: GearPair, member: Member, body: FlankBody, lines: ContactLines) -> Bands:
    """Bands of all stations on a gear's flank, line by line as `places_of` has them."""
    module = pair.driver.module
    radius = np.clip(lines.radius(pair, member) / module, *_flank(body))[lines.present]
    heights = (lines.z[lines.present] + pair.face_height(member)) / module
    return _bands(body, radius, heights, places_of(lines)[1])


def _relative_radius(pair: GearPair, lines: ContactLines) -> Array:
    """Relative radius of curvature of both flanks, or of flank and edge, in the transverse section, (P, M) [m]."""
    if lines.edges is not None:
        return lines.edges.relative_radius
    first, second = (pair.flank_curvature_radius(lines.x, member) for member in MEMBERS)
    return np.maximum(first * second / (first + second), 1e-6 * pair.driver.module)


def _line_means(lines: ContactLines, values: Array) -> Array:
    """Geometric mean of each contact line, at all of its stations, shape (P, M)."""
    found = values.copy()
    for p, s in places_of(lines)[0]:
        found[p, s] = np.exp(np.log(values[p, s]).mean())
    return found


def _flank(body: FlankBody) -> tuple[float, float]:
    return body.flank.lowest_radius, body.flank.highest_radius


def _bands(body: FlankBody, radius: Array, stations: Array, spans: list[slice]) -> Bands:
    """Hats on the stations of contact lines, of few different half-widths that the section resolves."""
    widest = body.settings.band_half_width
    room = body.band_half_width(radius) / widest
    snapped = widest * _WIDTH_STEP ** np.ceil(np.log(room) / math.log(_WIDTH_STEP) - 1e-9)
    before, after = np.zeros((2, stations.size))
    for s in spans:
        before[s][1:] = after[s][:-1] = np.diff(stations[s])
    return bands(radius, stations, before, snapped, after=after, slope=body.line_slope(radius))
