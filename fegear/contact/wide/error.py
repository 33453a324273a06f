"""Estimated errors of loaded flanks: solved again with longer panels, then with the gears' coarser solutions, too.

Largest line loads and pressures stand beside kinks of the load along its line and at roll positions between those that
are looked at; what longer panels change of them at one position says little about that. They are looked for once more
where they may stand, with shorter panels at twice as many positions, and there with coarser gears: what these change
beside the ends of the face is lost between long panels.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.base.errors import ConvergenceError
from fegear.base.shown import shown
from fegear.contact.between_positions import JUMP
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import long_line
from fegear.contact.wide.loaded import FlankPair, LoadedFlanks
from fegear.contact.wide.over_pitch import OverPitch, Stated
from fegear.contact.wide.spots import missed_of_spots
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.pair import Member

#: By how much panels are longer.
_LONGER = 1.5
#: What is taken for an error of the change of shares, of that of the largest load at a roll position by coarser gears,
#: and of that of the shape of the transmission error: compared with solutions of a fourth of the panel's length on
#: finer meshes.
_SHARES, _LOCAL, _SHAPE = 1.2, 1.25, 0.5
#: Largest loads are looked for again at positions where they are this part of the largest of all, and beside these;
#: with panels so much longer; so many positions at a time.
_LIKELY, _SHORTER, _AT_ONCE = 0.8, 0.5, 16
#: What is taken for an error of what that changes.
_OF_FINER = 1.5
#: What is taken for an error of the pressure read between stations: of what it is above the largest at a station.
_BETWEEN = 0.6
#: What longer panels change of the mean transmission error of spots, as an error of its peak to peak.
_OF_SPOT = 0.6
#: What is taken for an error of what coarser gears change of the mean transmission error and of its peak to peak: on
#: five random pairs they changed it 3 to 14 and 10 to 40 times as much as it was off, on six others 4 to 9 and 2 to 4
#: times, on a spur pair 2.5 and 1.4 times. Edges are longer by 1.35, so that the mean, an energy, goes with about the
#: sixth power of the edges. Of single harmonics less is error (of nine helical pairs 0.37 at most).
OF_GEARS_MEAN, OF_GEARS_SHAPE, OF_GEARS_HARMONICS = 0.5, 0.6, 0.4
#: The same of K_Hbeta: of five of six pairs 0.1 to 0.4 of it was true, of one 1.1, with as much of longer panels.
_OF_GEARS_FACE = 0.6


@dataclass(frozen=True)
class FlankError:
    """Changes by the coarser solution, one for each load.

    Parameters
    ----------
    transmission_error : ndarray, shape (P, L)
        [m].
    share : ndarray, shape (pairs, P, L)
    longer, coarse : LoadedFlanks
        The coarser solutions themselves: on longer panels, and of coarser gears on these.
    mean, peak_to_peak, face_load_factor, largest_line_load, largest_pressure : ndarray, shape (L,)
        Of what is stated of the whole base pitch (`Stated`).
    """

    transmission_error: Array
    share: Array
    longer: LoadedFlanks
    coarse: LoadedFlanks
    mean: Array = shown("um", "mean transmission error", name="te_mean")
    peak_to_peak: Array = shown("um", "over the base pitch", name="te_peak_to_peak")
    face_load_factor: Array = shown("", "maximum / mean load per face width", name="K_Hbeta")
    largest_line_load: Array = shown(
        "N/mm", "on one contact line longer than one module, away from tip and form circles"
    )
    largest_pressure: Array = shown("MPa", "smooth flanks", name="largest_hertz_pressure")


def flank_error(
    flanks: FlankPair,
    found: LoadedFlanks,
    coarse: Mapping[Member, FlankBody],
    gaps: FlankGaps,
    over: OverPitch,
    about: float,
) -> FlankError:
    """Solve again with less of everything that leaves an error; the pressed width of the bands stays.

    Longer panels and coarser gears may change a number in opposite directions: they are changed one after the other,
    and what each of them changes adds up, with what roll positions leave open. Of the transmission error, which is an
    integral of both, they leave errors that know nothing of each other: the root of their sum of squares counts.

    Parameters
    ----------
    flanks : FlankPair
    found : LoadedFlanks
        What it gave.
    coarse : mapping of {"driver", "driven"} to FlankBody
    gaps : FlankGaps
    over : OverPitch
        What is stated of the whole base pitch.
    about : float
        Load about which compliances are made, see `FlankPair.compliance` [N].
    """
    longer = replace(flanks, panel=_LONGER * flanks.panel)
    fewer = longer.solve(found.load, gaps, longer.compliance(about))
    softer = replace(longer, gears=coarse)
    other = softer.solve(found.load, gaps, softer.compliance(about))
    steps = (found, fewer, other)
    changes = [_changes(one, two, over) for one, two in pairwise(steps)]
    # Where panels are long beside a spot it comes and goes with them: at other roll positions by other amounts.
    by_panels = changes[0]
    changes[0] = by_panels._replace(peak_to_peak=np.maximum(by_panels.peak_to_peak, _OF_SPOT * by_panels.mean))
    by_gears = changes[1]
    changes[1] = by_gears._replace(
        mean=OF_GEARS_MEAN * by_gears.mean,
        peak_to_peak=OF_GEARS_SHAPE * by_gears.peak_to_peak,
        face_load_factor=_OF_GEARS_FACE * by_gears.face_load_factor,
    )
    left = over.left_by_positions
    if finer := finer_changes(flanks, coarse, gaps, over, about):  # instead of longer panels and fewer positions
        changes[0] = changes[0]._replace(**dict.fromkeys(finer, np.zeros(found.load.shape)))
        left = left._replace(**{key: _OF_FINER * change for key, (change, _) in finer.items()})
        # Long panels hide what gears change beside the ends of the face.
        shown = {key: np.maximum(getattr(changes[1], key), change) for key, (_, change) in finer.items()}
        changes[1] = changes[1]._replace(**shown)
    at_stations = np.where(over.found.smooth[:, :, None], over.found.pressure, 0.0).max(axis=(0, 1))
    between = over.found.largest_pressure - at_stations
    by_spots = (
        missed_of_spots(over.found.known, over.found.contact, values, long_line(found.pair))
        for values in (over.found.bounded_line_load, over.found.smooth_pressure)
    )
    left = left._replace(
        largest_line_load=left.largest_line_load + next(by_spots),
        largest_pressure=left.largest_pressure + next(by_spots) + _BETWEEN * between,
    )
    together = Stated(*map(np.add, *changes))._replace(
        mean=np.hypot(*(one.mean for one in changes)), peak_to_peak=np.hypot(*(one.peak_to_peak for one in changes))
    )
    sums = Stated(*map(np.add, together, left))
    by_panels_here, by_gears_here = (two.transmission_error - one.transmission_error for one, two in pairwise(steps))
    te = np.hypot(by_panels_here, OF_GEARS_SHAPE * by_gears_here)
    share = sum(_share_changes(found, one, two) for one, two in pairwise(steps))
    return FlankError(te, _SHARES * np.asarray(share), fewer, other, *sums)


def finer_changes(
    flanks: FlankPair, coarse: Mapping[Member, FlankBody], gaps: FlankGaps, over: OverPitch, about: float
) -> dict[str, tuple[Array, Array]]:
    """What shorter panels at more roll positions change of the largest line load and pressure, and on these the gears.

    Parameters
    ----------
    flanks : FlankPair
    coarse : mapping of {"driver", "driven"} to FlankBody
        On short panels they are loaded where the largest values of both stand.
    gaps : FlankGaps
    over : OverPitch
        What they were read from.
    about : float
        As of `flank_error`.

    Returns
    -------
    dict
        Both changes, shape (L,) each, by the names of `Stated`; empty where contacts on panels so short find no
        balance, as spots may.
    """
    found, shorter = over.found, replace(flanks, panel=_SHORTER * flanks.panel)
    softer, names = replace(shorter, gears=coarse), ("largest_line_load", "largest_pressure")
    roll = likely_positions(over.points.x, over.points.period, (found.largest_line_loads, found.largest_pressures))
    try:
        parts = [
            shorter.solve(found.load, gaps, shorter.compliance(about, roll[i : i + _AT_ONCE]))
            for i in range(0, roll.size, _AT_ONCE)
        ]
        values = {name: np.concatenate([getattr(part, f"{name}s") for part in parts]) for name in names}
        at = {name: first_of_largest(one, axis=0) for name, one in values.items()}
        places = np.unique(np.concatenate(list(at.values())))
        other = softer.solve(found.load, gaps, softer.compliance(about, roll[places]))
    except ConvergenceError:
        return {}
    case, changes = np.arange(found.load.size), {}
    for name, one in values.items():
        largest, again = one[at[name], case], getattr(other, f"{name}s")[np.searchsorted(places, at[name]), case]
        changes[name] = np.abs(largest - getattr(found, name)), np.abs(again - largest)
    return changes


def likely_positions(roll: Array, period: float, values: Sequence[Array]) -> Array:
    """Roll positions at which one of several values, shape (P, L) each, may be largest, and those halfway beside them.

    Parameters
    ----------
    roll : ndarray, shape (P,)
        Ascending within a period [m].
    period : float
        [m].
    values : sequence of ndarray
    """
    near = np.any([(one > _LIKELY * one.max(axis=0)).any(axis=1) for one in values], axis=0)
    step = np.diff(roll, append=roll[0] + period)
    halfway = (near | np.roll(near, -1)) & (step > JUMP * period)
    return np.sort(np.concatenate([roll[near], (roll + 0.5 * step)[halfway]]))


def no_estimate(found: LoadedFlanks) -> FlankError:
    """Errors that nobody estimated: none is a number, and the coarser solution is the solution itself."""
    unknown = np.full(found.load.size, np.nan)
    te, share = np.full(found.transmission_error.shape, np.nan), np.full(found.share.shape, np.nan)
    return FlankError(te, share, found, found, *[unknown] * len(Stated._fields))


def _changes(found: LoadedFlanks, other: LoadedFlanks, over: OverPitch) -> Stated:
    """Changes from one solution to another of it at the same roll positions, and what they make of what is stated."""
    te, again = found.transmission_error, other.transmission_error
    shift = np.abs(other.mean_transmission_error - found.mean_transmission_error)
    mean = found.load / (found.lines.high - found.lines.low)
    over_face = np.abs(other.mean_between(found.cells) - found.mean_over_face).max(axis=0) / mean
    return Stated(
        shift,
        # Most of how far the curve changes its shape: its largest and smallest values may do so together.
        np.maximum(np.abs(np.ptp(again, axis=0) - np.ptp(te, axis=0)), _SHAPE * np.ptp(again - te, axis=0)),
        # The largest change anywhere on the face, for that of the largest value may be small by chance; no less than
        # the compliances change together.
        np.maximum(over_face, shift / found.mean_transmission_error * found.face_load_factor),
        _of_largest(found, found.largest_line_loads, other.largest_line_loads, over, over.found.largest_line_loads),
        _of_largest(found, found.largest_pressures, other.largest_pressures, over, over.found.largest_pressures),
    )


def _share_changes(found: LoadedFlanks, one: LoadedFlanks, two: LoadedFlanks) -> Array:
    """Changes of the shares of the pairs of `found`, shape (pairs, P, L)."""
    first, second = (dict(zip(f.pair_numbers.tolist(), f.share, strict=True)) for f in (one, two))
    none = np.zeros(found.share.shape[1:])
    return np.stack([np.abs(second.get(j, none) - first.get(j, none)) for j in found.pair_numbers.tolist()])


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


def _of_largest(found: LoadedFlanks, first: Array, second: Array, over: OverPitch, values: Array) -> Array:
    """Change of a largest value of the base pitch, shape (L,), from changes at some of its roll positions, (P, L).

    Each of `values`, at the roll positions of `over`, may change by as large a share as those next to it do. Where one
    that is far below the largest does so, the largest stays what it is: counted is what the largest of all may become.
    """
    share = np.divide(np.abs(second - first), first, out=np.zeros_like(first), where=first > 0.0)
    pitch, roll, at = found.pair.base_pitch, over.points.x, found.lines.roll
    share = np.stack([np.interp(roll, at, one, period=pitch) for one in share.T], axis=1)
    off, largest = _LOCAL * share * values, values.max(axis=0)
    return np.maximum((values + off).max(axis=0) - largest, largest - (values - off).max(axis=0))
