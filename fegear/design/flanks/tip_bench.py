"""Teeth with a width set up for trying tip reliefs: two sets of roll positions, and one on which what is left is read.

What tip reliefs leave is largest where contact lines begin and end, and as large between few roll positions: reliefs
are chosen on more of them, and what is stated of one is read on more still, with an error from fewer positions, shorter
panels and the gears' coarser solutions. Lead modifications of the gears, misalignment and bent shafts stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.fourier import FourierSeries, Panels, fourier_series
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.roll_points import roll_points
from fegear.contact.wide.tip_edges import edge_reach
from fegear.design.flanks.forms import TipPower
from fegear.design.flanks.trials import FlankTrials
from fegear.design.load_range import LoadRange
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.pair import Member
from fegear.geometry.relief import UNMODIFIED

#: Roll positions at which reliefs are chosen and at which they are read.
SEARCHED, READ = 48, 96
#: Panels of the search to one of those whose change counts as an error.
_FINER = 2
#: What is taken for an error of a change by four times fewer positions or longer panels.
_OF_FEWER = 0.5
#: Harmonics of what is left: those of the effective error.
HARMONICS = 12


def without_tips(gaps: FlankGaps) -> FlankGaps:
    """What keeps the flanks apart besides profile reliefs and spacing errors."""
    none = np.empty(0)
    return replace(
        gaps, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED, driver_spacing=none, driven_spacing=none
    )  # fmt: skip


@dataclass(frozen=True)
class TipTrials:
    """A pair under the loads of a design.

    Parameters
    ----------
    points : Panels
        Roll positions of `more`.
    few, more : FlankTrials
        At the roll positions of the pair's other results, and at more.
    """

    points: Panels
    few: FlankTrials
    more: FlankTrials

    def over(self, over: LoadRange, tip_power: float, apart: FlankGaps) -> TipTrials:
        """The same under other loads."""
        loads, few, more = np.array(over.loads), self.few, self.more
        return TipTrials(self.points, *(
            replace(
                one, apart=apart.at(one.pair, one.known.lines, loads), loads=loads, weights=over.weights,
                tip_power=tip_power,
            )
            for one in (few, more)
        ))  # fmt: skip


def tip_trials(flanks: FlankPair, known: FlankCompliance, apart: FlankGaps, load: float) -> TipTrials:
    """Set up a pair for trying tip reliefs at one load [N]."""
    pair, one = flanks.pair, np.array([load])
    points = roll_points(pair, SEARCHED, edge_reach(pair, flanks.most_gap))
    more = flanks.compliance(load, points.x)
    return TipTrials(points, *(FlankTrials(pair, c, apart.at(pair, c.lines, one), one) for c in (known, more)))


@dataclass(frozen=True)
class Read(ReadOnlyArrays):
    """What one relief leaves over a base pitch under L loads.

    Parameters
    ----------
    te : ndarray, shape (P, L)
        Transmission error [m].
    error : ndarray, shape (L,)
        Estimated, of its peak-to-peak value [m].
    series : FourierSeries
    """

    te: Array
    error: Array
    series: FourierSeries

    @property
    def peak_to_peak(self) -> Array:
        """Shape (L,) [m]."""
        return np.asarray(np.ptp(self.te, axis=0))


@dataclass(frozen=True)
class TipReader:
    """A pair on which what reliefs leave is read.

    Parameters
    ----------
    points : Panels
        Its roll positions.
    dense, plain, thin, soft : FlankTrials
        At these; at a fourth of them; there with shorter panels, and of the gears' coarser solutions.
    """

    points: Panels
    dense: FlankTrials
    plain: FlankTrials
    thin: FlankTrials
    soft: FlankTrials

    def under(self, loads: Array, apart: FlankGaps) -> TipReader:
        """The same under other loads [N]."""
        return self._each(lambda one: replace(one, apart=apart.at(one.pair, one.known.lines, loads), loads=loads))

    def shaped(self, tip_power: TipPower) -> TipReader:
        """The same for tip reliefs of another shape."""
        return self._each(lambda one: replace(one, tip_power=tip_power))

    def _each(self, changed: Callable[[FlankTrials], FlankTrials]) -> TipReader:
        return TipReader(self.points, *map(changed, (self.dense, self.plain, self.thin, self.soft)))

    def read(self, numbers: Array | None = None, apart: FlankGaps | None = None) -> Read:
        """What the nine numbers of a relief leave; other gaps instead, which have all reliefs already.

        Parameters
        ----------
        numbers : ndarray, shape (9,), optional
            None for none.
        apart : FlankGaps, optional
        """

        def left(trials: FlankTrials) -> Array:
            if apart is not None:
                trials = replace(trials, apart=apart.at(trials.pair, trials.known.lines, trials.loads))
            gap = np.zeros(trials.known.lines.x.shape) if numbers is None else trials.gap(numbers)
            return trials.of_gap(gap).te[0]

        dense, plain, thin, soft = map(left, (self.dense, self.plain, self.thin, self.soft))
        at = [np.ptp(one, axis=0) for one in (dense, plain, thin, soft)]
        off = _OF_FEWER * np.abs(at[0] - at[1]) + _OF_FEWER * np.abs(at[2] - at[1]) + np.abs(at[3] - at[1])
        return Read(dense, off, fourier_series(self.points, dense, HARMONICS))


def tip_reader(
    flanks: FlankPair, coarse: Mapping[Member, FlankBody], apart: FlankGaps, load: float
) -> TipReader:  # fmt: skip
    """Set up a pair for reading what reliefs leave.

    Parameters
    ----------
    flanks : FlankPair
    coarse : mapping of {"driver", "driven"} to FlankBody
        The gears' coarser solutions, for errors.
    apart : FlankGaps
        Without tip reliefs.
    load : float
        About which compliances are made [N].
    """
    pair, one = flanks.pair, np.array([load])
    beyond = edge_reach(pair, flanks.most_gap)
    points = {count: roll_points(pair, count, beyond) for count in (READ, READ // 4)}

    def trials(count: int, of: FlankPair) -> FlankTrials:
        known = of.compliance(load, points[count].x)
        return FlankTrials(pair, known, apart.at(pair, known.lines, one), one)

    few = READ // 4
    return TipReader(
        points[READ], trials(READ, flanks), trials(few, flanks),
        trials(few, replace(flanks, panel=flanks.panel / _FINER)), trials(few, replace(flanks, gears=coarse)),
    )  # fmt: skip
