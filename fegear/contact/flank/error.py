"""Estimated errors of loaded flanks: solved again with the gears' coarser solutions and longer panels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.flank.swept import swept_mean
from fegear.contact.flank.transmission_error import from_half

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array, Mask
    from fegear.contact.flank.gaps import FlankGaps
    from fegear.contact.flank.loaded import FlankPair, LoadedFlanks
    from fegear.contact.fourier import Panels
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.geometry.pair import Member

#: By how much panels are longer.
_LONGER = 1.5
#: What is taken for an error of the change of shares, of that of the largest load at any roll position, and of that by
#: half of the roll positions: held against solutions with a fourth of the panel's length on finer meshes.
_SHARES, _LOCAL, _OF_HALF = 1.2, 2.5, 0.5
#: The same for the peak-to-peak transmission error: of a change of its shape, and of what half of the roll positions
#: miss of the curve, whose peaks beside tip edges may stand between all of them.
_SHAPE, _OF_CURVE = 0.8, 3.0


@dataclass(frozen=True)
class FlankError:
    """Changes by the coarser solution, one for each load.

    Parameters
    ----------
    transmission_error : ndarray, shape (P, L)
        [m].
    share : ndarray, shape (pairs, P, L)
    mean, peak_to_peak : ndarray, shape (L,)
        Of the transmission error [m].
    face_load_factor : ndarray, shape (L,)
    largest_line_load, largest_pressure : ndarray, shape (L,)
        [N/m], [Pa].
    coarse : LoadedFlanks
        The coarser solution itself.
    """

    transmission_error: Array
    share: Array
    mean: Array
    peak_to_peak: Array
    face_load_factor: Array
    largest_line_load: Array
    largest_pressure: Array
    coarse: LoadedFlanks


def flank_error(
    flanks: FlankPair, found: LoadedFlanks, coarse: Mapping[Member, FlankBody], gaps: FlankGaps
) -> FlankError:
    """Solve again with less of everything that leaves an error; the pressed width of the bands stays.

    Parameters
    ----------
    flanks : FlankPair
    found : LoadedFlanks
        What it gave.
    coarse : mapping of {"driver", "driven"} to FlankBody
    gaps : FlankGaps
    """
    other = replace(flanks, gears=coarse, panel=_LONGER * flanks.panel).solve(found.load, gaps)
    te, again = found.transmission_error, other.transmission_error
    at = np.searchsorted(other.pair_numbers, found.pair_numbers)
    same = [k < other.pair_numbers.size and other.pair_numbers[k] == j
            for k, j in zip(at.tolist(), found.pair_numbers.tolist(), strict=True)]  # fmt: skip
    share = np.stack([np.abs(found.share[i] - (other.share[k] if on else 0.0))
                      for i, (k, on) in enumerate(zip(at.tolist(), same, strict=True))])  # fmt: skip
    shift = np.abs(other.mean_transmission_error - found.mean_transmission_error)
    return FlankError(
        np.abs(again - te), _SHARES * share, shift,
        # Most of how far the curve changes its shape: its largest and smallest values may do so together.
        np.maximum(np.abs(np.ptp(again, axis=0) - np.ptp(te, axis=0)), _SHAPE * np.ptp(again - te, axis=0))
        + _between_positions(flanks.points, te),
        _over_face(flanks.points, found, other, shift / found.mean_transmission_error),
        _largest(found, found.line_load, found.largest_line_loads, other.largest_line_loads),
        _largest(found, found.pressure, found.largest_pressures, other.largest_pressures), other,
    )  # fmt: skip


def with_misses(error: FlankError, found: LoadedFlanks, missed: float) -> FlankError:
    """The same for bodies that are known to miss compliances by a share, as slices do: no coarser solution shows that.

    Deflections are off by it; shares, load over the face and line loads, which only follow its unevenness, at most by
    it; pressure goes with the root of the load.
    """
    share = found.share
    return replace(
        error,
        transmission_error=error.transmission_error + missed * np.abs(found.transmission_error),
        share=error.share + missed * share * (1.0 - share),
        mean=error.mean + missed * np.abs(found.mean_transmission_error),
        peak_to_peak=error.peak_to_peak + missed * np.ptp(found.transmission_error, axis=0),
        face_load_factor=error.face_load_factor + missed * (found.face_load_factor - 1.0),
        largest_line_load=error.largest_line_load + missed * found.largest_line_load,
        largest_pressure=error.largest_pressure + 0.5 * missed * found.largest_pressure,
    )


def _over_face(points: Panels, found: LoadedFlanks, other: LoadedFlanks, softer: Array) -> Array:
    """Of K_Hbeta: the largest change anywhere on the face, for that of the largest value may be small by chance.

    No less than the compliances change together, `softer`, and with what half of the roll positions miss.
    """
    lines, kept = found.lines, _half(points)
    fewer = replace(
        lines, roll=lines.roll[kept], pair=lines.pair[kept], present=lines.present[kept], x=lines.x[kept],
        z=lines.z[kept], at_edge=lines.at_edge[kept], weight=np.empty(0), edges=None,
    )  # fmt: skip
    mean = found.load / (lines.high - lines.low)
    again = swept_mean(fewer, found.line_load[kept], found.cells, points.period) / np.diff(found.cells)[:, None]
    changes = [np.abs(one - found.mean_over_face).max(axis=0) / mean
               for one in (other.mean_between(found.cells), again)]  # fmt: skip
    return np.asarray(np.maximum(changes[0], softer * found.face_load_factor) + _OF_HALF * changes[1])


def _largest(found: LoadedFlanks, values: Array, first: Array, second: Array) -> Array:
    """Of a largest value: its change at any roll position, and by how much tips bear more that were left out of it."""
    lines = found.lines
    ends = lines.at_edge if lines.edges is None else lines.at_edge & (lines.edges.gap == 0.0)
    above = np.where(ends[:, :, None], values, 0.0).max(axis=(0, 1)) - first.max(axis=0)
    return np.asarray(_LOCAL * np.abs(second - first).max(axis=0) + np.maximum(above, 0.0))


def _half(points: Panels) -> Mask:
    """Every second roll position on each piece of the base pitch, and its last one."""
    piece = np.searchsorted(points.breaks, points.x)
    within = np.arange(points.x.size) - np.searchsorted(piece, piece)  # from the start of its piece on
    return np.asarray((within % 2 == 0) | np.append(piece[1:] != piece[:-1], True))


def _between_positions(points: Panels, te: Array) -> Array:
    """What half of the roll positions on each piece of the base pitch miss of the curve and its peak-to-peak [m]."""
    missed = np.array([np.abs(from_half(points, one) - one).max() for one in te.T])
    return np.maximum(_OF_CURVE * missed, np.ptp(te, axis=0) - np.ptp(te[_half(points)], axis=0))
