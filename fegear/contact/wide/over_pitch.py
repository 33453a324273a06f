"""What is stated of a whole base pitch: means and largest values, at as many roll positions as these need.

Tables stand at the roll positions that a case asks for. Means of few positions are off by more than the gears' meshes
leave open, and peaks stand between them: where a tip edge comes into contact the transmission error has a kink of its
own, at a place that only the loads know. So whatever is stated of the base pitch as a whole is found at many positions,
and its largest and smallest transmission error are looked for once more where the curve's two sides would meet.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.contact.between_positions import likely_peaks, worth_a_look
from fegear.contact.fourier import Panels
from fegear.contact.wide.along_lines import swept_mean
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks

#: Roll positions of which means are taken, at least.
POSITIONS = 48
#: Rounds of looking for peaks between positions.
_ROUNDS = 3
#: What is taken for an error of what half of the positions change: of a mean over them, and of the load over the face.
_OF_MEAN, _OF_FACE = 0.5, 0.5


class Stated(NamedTuple):
    """Numbers of a base pitch under every load, or their errors; arrays of shape (L,).

    Parameters
    ----------
    mean, peak_to_peak : ndarray
        Of the transmission error [m].
    face_load_factor : ndarray
    largest_line_load, largest_pressure : ndarray
        [N/m], [Pa].
    """

    mean: Array
    peak_to_peak: Array
    face_load_factor: Array
    largest_line_load: Array
    largest_pressure: Array


@dataclass(frozen=True)
class OverPitch(ReadOnlyArrays):
    """Loaded flanks over a whole base pitch.

    Parameters
    ----------
    found : LoadedFlanks
        At many roll positions, under every load.
    points : Panels
        These.
    peaks : ndarray, shape (2, L)
        Smallest and largest transmission error, those between the positions among them [m].
    beyond : ndarray, shape (L,)
        By how much both together may lie farther apart, as far as the curve's slopes tell [m].
    """

    found: LoadedFlanks
    points: Panels
    peaks: Array
    beyond: Array

    @property
    def stated(self) -> Stated:
        """The numbers."""
        found = self.found
        return Stated(
            found.mean_transmission_error, self.peaks[1] - self.peaks[0], found.face_load_factor,
            found.largest_line_load, found.largest_pressure,
        )  # fmt: skip

    @property
    def left_by_positions(self) -> Stated:
        """What the number of roll positions leaves open of them."""
        found, kept = self.found, every_second(self.points)
        te, x, period = found.transmission_error, self.points.x, self.points.period
        fewer = np.array([_straight_mean(x[kept], one[kept], period) for one in te.T])
        straight = np.array([_straight_mean(x, one, period) for one in te.T])
        mean = np.maximum(_OF_MEAN * np.abs(fewer - straight), np.abs(straight - found.mean_transmission_error))
        return Stated(
            mean, self.beyond, face_left_by_positions(self.points, found),
            *(one.max(axis=0) - one[kept].max(axis=0) for one in (found.largest_line_loads, found.largest_pressures)),
        )  # fmt: skip


def over_pitch(
    flanks: FlankPair, found: LoadedFlanks, gaps: FlankGaps, about: float, *, peaks: bool = True
) -> OverPitch:
    """Load flanks at as many roll positions as numbers of the whole base pitch need.

    Parameters
    ----------
    flanks : FlankPair
    found : LoadedFlanks
        At its own roll positions; taken as it is where these are enough.
    gaps : FlankGaps
    about : float
        Load about which compliances are made, see `FlankPair.compliance` [N].
    peaks : bool
        Whether the largest and smallest transmission error are looked for between positions.
    """
    if flanks.positions < POSITIONS:
        flanks = replace(flanks, positions=POSITIONS)
        found = flanks.solve(found.load, gaps, flanks.compliance(about))
    points = flanks.points
    roll, te = points.x, found.transmission_error
    for turn in range(_ROUNDS + 1):
        likely = [likely_peaks(roll, sign * te, points.period) for sign in (-1.0, 1.0)]
        new = worth_a_look(roll, likely, points.period)
        if not peaks or turn == _ROUNDS or not new.size:
            break
        more = flanks.solve(found.load, gaps, flanks.compliance(about, new)).transmission_error
        order = np.argsort(np.concatenate([roll, new]), kind="stable")
        roll, te = np.concatenate([roll, new])[order], np.concatenate([te, more])[order]
    beyond = np.sum([np.maximum(height.max(axis=0), 0.0) for _, height in likely], axis=0)
    return OverPitch(found, points, np.stack([te.min(axis=0), te.max(axis=0)]), beyond)


def every_second(points: Panels) -> Mask:
    """Every second roll position on each piece of the base pitch, and its last one."""
    piece = np.searchsorted(points.breaks, points.x)
    within = np.arange(points.x.size) - np.searchsorted(piece, piece)  # from the start of its piece on
    return np.asarray((within % 2 == 0) | np.append(piece[1:] != piece[:-1], True))


def _straight_mean(x: Array, values: Array, period: float) -> float:
    """Mean over a period of what is straight between places of it."""
    step = np.diff(x, append=x[0] + period)
    return float(step @ (values + np.roll(values, -1)) / (2.0 * period))


def face_left_by_positions(points: Panels, found: LoadedFlanks) -> Array:
    """What the number of roll positions leaves open of K_Hbeta, shape (L,).

    A part of the largest change of the mean load anywhere on the face by half of them, over the mean.
    """
    lines, kept = found.lines, every_second(points)
    fewer = replace(
        lines, roll=lines.roll[kept], pair=lines.pair[kept], present=lines.present[kept], x=lines.x[kept],
        z=lines.z[kept], at_edge=lines.at_edge[kept], weight=np.empty(0), edges=None,
    )  # fmt: skip
    again = swept_mean(fewer, found.line_load[kept], found.cells, points.period) / np.diff(found.cells)[:, None]
    mean = found.load / (lines.high - lines.low)
    return np.asarray(_OF_FACE * np.abs(again - found.mean_over_face).max(axis=0) / mean)
