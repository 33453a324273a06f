"""Estimated errors of loaded flanks: solved again with the gears' coarser solutions and longer panels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.contact.flank.gaps import FlankGaps
    from fegear.contact.flank.loaded import FlankPair, LoadedFlanks
    from fegear.contact.fourier import Panels
    from fegear.fem.solid.flank_body import FlankBody
    from fegear.geometry.pair import Member

#: By how much panels are longer.
_LONGER = 1.5


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
    over = other.mean_between(found.cells)
    factor = over.max(axis=0) / (found.load / (found.lines.high - found.lines.low))
    return FlankError(
        np.abs(again - te), share, np.abs(other.mean_transmission_error - found.mean_transmission_error),
        np.abs(np.ptp(again, axis=0) - np.ptp(te, axis=0)) + _between_positions(flanks.points, te),
        np.abs(factor - found.face_load_factor), np.abs(other.largest_line_load - found.largest_line_load),
        np.abs(other.largest_pressure - found.largest_pressure),
        other,
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


def _between_positions(points: Panels, te: Array) -> Array:
    """What half of the roll positions on each piece of the base pitch miss of the peak-to-peak value [m]."""
    piece = np.searchsorted(points.breaks, points.x)
    within = np.arange(points.x.size) - np.searchsorted(piece, piece)  # from the start of its piece on
    last = np.append(piece[1:] != piece[:-1], True)
    return np.asarray(np.ptp(te, axis=0) - np.ptp(te[(within % 2 == 0) | last], axis=0))
