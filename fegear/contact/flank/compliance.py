"""Both solid gears' influence functions put together for all stations of all contact lines at a roll position.

Each gear is seen in its own drawing, loaded flank toward +x: turning the driven gear's by half a turn about the axis
lays both together, so heights z count alike on both, and hands are opposite. Pair j + 1 is ahead of pair j: its teeth
are k = +1 seen from the driver's loaded tooth and k = -1 seen from the driven gear's.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.fem.solid.bands import bands
from fegear.frozen import ReadOnlyArrays
from fegear.geometry.pair import MEMBERS
from fegear.tally import tallied

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.contact.flank.lines import ContactLines
    from fegear.fem.solid.bands import Bands
    from fegear.fem.solid.flank_body import FlankBody, FlankLines
    from fegear.geometry.pair import GearPair, Member

Hertz = Literal["load-dependent", "linear", "none"]

#: Half-width of a contact that does not know its load [modules], as in the plane.
_NOMINAL_HALF_WIDTH = 0.08
#: Pressed half-widths go in steps of this ratio, so that few of them occur.
_WIDTH_STEP = 0.8


@dataclass(frozen=True)
class FlankCompliance(ReadOnlyArrays):
    """What the stations of all contact lines do to each other; all that contact needs besides loads and gaps.

    Parameters
    ----------
    lines : ContactLines
    matrix : ndarray, shape (P, M, M)
        Approach of station i along the transverse line of action per unit force on station j, both gears, contacts of
        half-width one metre [m/N]; identity where no station is. What the Hertzian width does is in `log_slope`.
    log_slope : float
        A line load f [N/m] approaches by -2 log_slope f ln b more, b its half-width [m] over 1 m [m^2/N].
    width_factor : ndarray, shape (P, M)
        b^2 = width_factor f: 4 R / (pi E*) [m^3/N], R across the contact line.
    fixed_half_width : ndarray, shape (P, M), or None
        Half-width of contacts that do not follow their load [m]; None where they do.
    """

    lines: ContactLines
    matrix: Array
    log_slope: float
    width_factor: Array
    fixed_half_width: Array | None

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

    Returns
    -------
    FlankCompliance
    """
    module, lean = pair.driver.module, math.cos(pair.driver.base_helix_angle)
    rho = {member: pair.flank_curvature_radius(lines.x, member) for member in MEMBERS}
    across = np.maximum(rho["driver"] * rho["driven"] / (rho["driver"] + rho["driven"]), 1e-6 * module) / lean
    moduli = [pair.gear(m).material for m in MEMBERS]
    softness = sum((1.0 - m.poisson_ratio**2) / m.young_modulus for m in moduli)
    factor = 4.0 * across * softness / math.pi
    mean = np.sqrt(factor * (load / lines.length)[:, None])
    b = np.full(lines.x.shape, _NOMINAL_HALF_WIDTH * module) if hertz == "none" else mean
    most = lines.x.shape[1]
    matrix = np.zeros((*lines.x.shape, most))
    log_slope = 0.0
    places, spans = places_of(lines)
    for member in MEMBERS:
        gear, body = pair.gear(member), gears[member]
        softer = 1.0 / (gear.material.young_modulus * module)
        pressed = body.pressed(line_bands(pair, member, body, lines), spans)
        log_slope += pressed.slope / gear.material.young_modulus
        widened = pressed.widened(b[lines.present] / module)
        for (p, s), own, wider, common in zip(places, pressed.own(), widened, pressed.common, strict=True):
            matrix[p, s, s] += softer * (own + wider + 2.0 * math.log(module) * pressed.slope * common)
        if coupling:
            _couple(matrix, pressed, body.reach, 1 if member == "driver" else -1, lines, softer)
    index = np.arange(most)
    matrix[:, index, index] += np.where(lines.present, 0.0, 1.0)
    return FlankCompliance(lines, matrix, log_slope, factor, None if hertz == "load-dependent" else b)


def places_of(lines: ContactLines) -> tuple[list[tuple[int, slice]], list[slice]]:
    """Roll position and stations of every contact line, and its stations among those of all lines in a row."""
    places = [(p, s) for p in range(lines.roll.size) for s in lines.at(p)]
    ends = np.cumsum([0, *(s.stop - s.start for _, s in places)]).tolist()
    return places, [slice(a, b) for a, b in itertools.pairwise(ends)]


@tallied("neighbours")
def _couple(matrix: Array, pressed: FlankLines, reach: int, forward: int, lines: ContactLines, softer: float) -> None:
    """Add what the lines of each roll position do to each other, and its transpose (Maxwell)."""
    places, _ = places_of(lines)
    tooth = [forward * int(lines.pair[p, s.start]) for p, s in places]
    found: dict[int, list[tuple[int, int]]] = {}
    for a, b in itertools.combinations(range(len(places)), 2):
        if places[a][0] == places[b][0] and abs(k := tooth[a] - tooth[b]) <= reach:
            found.setdefault(k, []).append((a, b))
    for k, pairs in found.items():
        for (a, b), block in zip(pairs, pressed.between(k, pairs), strict=True):
            (p, first), (_, second) = places[a], places[b]
            matrix[p, first, second] += softer * block
            matrix[p, second, first] += softer * block.T


def line_bands(pair: GearPair, member: Member, body: FlankBody, lines: ContactLines) -> Bands:
    """Bands of all stations on a gear's flank, line by line as `places_of` has them."""
    module = pair.driver.module
    radius = np.clip(pair.radius(lines.x, member) / module, *_flank(body))[lines.present]
    return _bands(body, radius, lines.z[lines.present] / module, places_of(lines)[1])


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
