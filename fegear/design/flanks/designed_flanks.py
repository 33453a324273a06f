"""Designed flanks: the task, each way to relieve them with what it leaves, and the one of these to be ground."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.design.flanks.families import FamilyBest
from fegear.design.flanks.flank_tolerance import FlankTolerance
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import Family, ReliefGrid
from fegear.design.flanks.judge import Judged
from fegear.design.flanks.scatter import Scatter
from fegear.design.flanks.topography import FlankLoading, StationRelief
from fegear.design.flanks.trials import Tried
from fegear.design.load_range import proportions
from fegear.design.preferred import CLEARLY
from fegear.design.tip_relief.tip_tolerance import Decisive

UNRELIEVED, EXACT, ROBUST = "no relief", "exact topography", "robust"

#: A modification more has to leave less by this share at least, and by more than the error of what is left.
_WORTH = 0.02
#: Amounts below this are no modification [m].
_NOTHING = 5e-9
#: Relative differences below this are none.
_ROUNDED = 1e-6
#: Places of the amounts among the nine numbers of a ground relief: tips, crowning, end relief, slope, bias.
_AMOUNTS = np.array([0, 2, 4, 5, 7, 8])


@dataclass(frozen=True)
class FlankDesignTask:
    """What flanks are designed for.

    Parameters
    ----------
    loading : FlankLoading
    load : float
        W_d [N].
    loads : tuple of float
        Over which what can be ground is chosen: the worst of them, in proportion to its load [N].
    families : tuple of str
    grid : ReliefGrid or None
        None for `usual_grid`.
    most_factor : float
        Largest K_Hbeta that ground reliefs may have at those loads.
    scatter : Scatter
        Of the misalignment, over which the robust relief is chosen.
    deviation : float
        Its standard deviation, as gap over the face [m].
    positions : int
        Roll positions over a base pitch.
    map_over_face, map_loads : tuple of float
        Misalignments [m] and loads [N] of the maps.
    weights : tuple of float, optional
        What each of the loads counts; all the same by default.
    tolerance : FlankTolerance, optional
        Of what is ground; none by default.
    """

    loading: FlankLoading
    load: float
    loads: tuple[float, ...]
    families: tuple[Family, ...]
    grid: ReliefGrid | None
    most_factor: float
    scatter: Scatter
    deviation: float
    positions: int
    map_over_face: tuple[float, ...]
    map_loads: tuple[float, ...]
    weights: tuple[float, ...] | None = None
    tolerance: FlankTolerance | None = None


@dataclass(frozen=True)
class FlankState(ReadOnlyArrays):
    """One way to relieve the flanks and what it leaves at the design load.

    Parameters
    ----------
    label : str
    relief : GroundRelief or None
        None for the exact topography.
    te : ndarray, shape (P,)
        Transmission error at the roll positions of the pair's other results [m].
    judged : Judged
        What it leaves, with errors.
    mapped : Tried
        Over the misalignments and loads of the maps.
    over_peak_to_peak, over_first : ndarray, shape (L,)
        Peak-to-peak value and amplitude of the first harmonic at each of the task's loads, aligned as given [m].
    over_mean : ndarray, shape (L,)
        Mean of the peak-to-peak value over the scatter at each of these loads [m].
    over_error : ndarray, shape (L,), optional
        Of `over_peak_to_peak` [m].
    over_most : ndarray, shape (L,), optional
        Largest peak-to-peak value within the task's tolerances, aligned as given [m]; None where nothing is ground.
    """

    label: str
    relief: GroundRelief | None
    te: Array
    judged: Judged
    mapped: Tried
    over_peak_to_peak: Array
    over_first: Array
    over_mean: Array
    over_error: Array | None = None
    over_most: Array | None = None

    @property
    def modifications(self) -> int:
        """How many a shop has to grind: amounts, of both gears."""
        return int((np.abs(self.amounts) > _NOTHING).sum())

    @property
    def amounts(self) -> Array:
        """Of what is ground, in the order of `_AMOUNTS` [m]."""
        return (self.relief or GroundRelief()).numbers[_AMOUNTS]


@dataclass(frozen=True)
class FlankDesign(ReadOnlyArrays):
    """A design of loaded flanks.

    Parameters
    ----------
    task : FlankDesignTask
    station : StationRelief
    x, z : ndarray, shapes (n,), (m,)
        Nodes of the topography in the plane of action [m].
    removal : ndarray, shape (n, m)
        By both gears together [m].
    roll : ndarray, shape (P,)
        Positions of `FlankState.te` [m].
    states : tuple of FlankState
        Without relief, exact topography, the best of every family, and the robust one if misalignment scatters.
    found : mapping of str to FamilyBest
        By the labels of what can be ground.
    grid : ReliefGrid
    finer : int or None
        By how many classes the tolerances of `best` would have to be finer for it to leave no more than no relief with
        deviations inside the same tolerances under any load: 0 where they do, None where none does.
    decisive : tuple of Decisive or None
        Which tolerance decides the most that `best` leaves under each of the task's loads; empty without tolerances.
    unrelieved_most : ndarray, shape (L,), or None
        Largest peak-to-peak value without relief, with deviations inside the tolerances of what is ground [m]; None
        where `best` leaves no more than no relief without deviations.
    """

    task: FlankDesignTask
    station: StationRelief
    x: Array
    z: Array
    removal: Array
    roll: Array
    states: tuple[FlankState, ...]
    found: Mapping[str, FamilyBest]
    grid: ReliefGrid
    finer: int | None = 0
    decisive: tuple[Decisive | None, ...] = ()
    unrelieved_most: Array | None = None

    @property
    def unrelieved(self) -> FlankState:
        """Without relief."""
        return self.states[0]

    @property
    def exact(self) -> FlankState:
        """With the exact topography."""
        return self.states[1]

    @property
    def robust(self) -> tuple[FlankState, ...]:
        """What can be ground and leaves the least over the scatter; empty where misalignment does not scatter."""
        return tuple(state for state in self.states if state.label == ROBUST)

    @property
    def ground(self) -> tuple[FlankState, ...]:
        """What can be ground."""
        return tuple(state for state in self.states if state.label in self.found)

    @property
    def least(self) -> FlankState:
        """What can be ground and leaves the least: at the design load, or by the worst of several."""
        return min(self.ground, key=self.left_by)

    @property
    def best(self) -> FlankState:
        """The one to be ground: `least`, or one of fewer modifications that leaves no more within its error.

        So does one of fewer whose further modifications are smaller than their tolerances: no inspection finds these.
        One that leaves clearly less at the worst within its tolerances goes before all of them. Where misalignment
        scatters, the mean over it goes first; one of fewer is then not to lose clearly more by its tolerances.
        """
        least = self.least
        fewer = [s for s in self.ground if s.modifications <= least.modifications and self._holds(s)]
        like = [least, *(s for s in fewer if s is not least and (self.alike(s) or self.within_tolerance(s)))]
        simple = min(like, key=lambda s: (s.modifications, self.left_by(s)))
        clear = [] if self.scattered else [
            s for s in self.ground
            if self.within_by(s) < CLEARLY * self.within_by(simple) and s.modifications <= least.modifications
        ]  # fmt: skip
        return min(clear, key=self.within_by, default=simple)

    def _holds(self, state: FlankState) -> bool:
        """Whether a way that is alike over scattered misalignment leaves no clearly larger maximum than `least`."""
        return not self.scattered or CLEARLY * self.within_by(state) <= self.within_by(self.least)

    def within_by(self, state: FlankState) -> float:
        """What a way leaves at most within its tolerances, as `left_by`; infinite where that is not known [m]."""
        return math.inf if state.over_most is None else float((state.over_most * self._counts).max())

    @property
    def _counts(self) -> Array:
        """By what a value under each of the task's loads is multiplied before the worst is taken, shape (L,)."""
        weights = None if self.task.weights is None else np.array(self.task.weights)
        return np.asarray(proportions(np.array(self.task.loads), weights), dtype=float)

    def left_under(self, state: FlankState) -> Array:
        """Peak-to-peak value that a way leaves under each of the task's loads, or its mean over the scatter [m]."""
        return state.over_mean if self.scattered else state.over_peak_to_peak

    def worst_load(self, values: Array) -> int:
        """Number of the load under which a value is largest in proportion."""
        return int(np.argmax(values * self._counts))

    @property
    def chosen(self) -> tuple[FlankState, ...]:
        """The one to be ground, and the robust one where that is another."""
        best = self.best
        return (best, *(state for state in self.robust if state is not best))

    def alike(self, state: FlankState) -> bool:
        """Whether a way leaves as little as `least`, within its error."""
        least = self.least
        left = self.left_by(least)
        return self.left_by(state) - left <= min(_WORTH * left, max(self.error_of(state), self.error_of(least)))

    def within_tolerance(self, state: FlankState) -> bool:
        """Whether `least` has all modifications of a way, and all others below their tolerances.

        A way that leaves more than no relief under any load never counts.
        """
        tolerance, least = self.task.tolerance, self.least
        if tolerance is None or least.relief is None or state.relief is None:
            return False
        ours, theirs = state.amounts, least.amounts
        further = (np.abs(ours) <= _NOTHING) & (np.abs(theirs) > _NOTHING)
        lost = (np.abs(theirs) <= _NOTHING) & (np.abs(ours) > _NOTHING)
        if lost.any() or not further.any() or (state.over_peak_to_peak > self.unrelieved.over_peak_to_peak).any():
            return False
        allowed = tolerance.amounts[_AMOUNTS]
        return bool((np.abs(theirs)[further] < (1.0 - _ROUNDED) * allowed[further]).all())

    @property
    def scattered(self) -> bool:
        """Whether misalignment scatters: ways are then compared by their mean over it."""
        return self.task.scatter.over_face.size > 1

    def error_of(self, state: FlankState) -> float:
        """Of `left_by` [m]; under several loads with the share of the value that it has at the design load."""
        ripple = state.judged.mean_over_scatter if self.scattered else state.judged.peak_to_peak
        return ripple.error if ripple.value == 0.0 else ripple.error / ripple.value * self.left_by(state)

    def left_by(self, state: FlankState) -> float:
        """Peak-to-peak value that a way leaves: at the design load, or by the worst of several in proportion [m].

        Where misalignment scatters, its mean over the scatter.
        """
        task = self.task
        if task.loads == (task.load,):
            return (state.judged.mean_over_scatter if self.scattered else state.judged.peak_to_peak).value
        return float((self.left_under(state) * self._counts).max())
