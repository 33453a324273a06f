"""The whole design of loaded flanks: exact topography, what can be ground, and how each holds up."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.base.one_thread import one_thread
from fegear.contact.wide.compliance import FlankCompliance, flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines
from fegear.contact.wide.loaded import FlankPair
from fegear.design.flanks.families import FamilyBest, best_of_family, led_on
from fegear.design.flanks.flank_tolerance import (
    FlankTolerance,
    decisive_tolerances,
    unrelieved_within,
    within_tolerances,
)
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import FAMILIES, Family, ReliefGrid, held_by, usual_grid
from fegear.design.flanks.judge import FlankJudge, Judged, flank_judge, mean_over_scatter
from fegear.design.flanks.scatter import Scatter
from fegear.design.flanks.topography import (
    FlankLoading,
    StationRelief,
    design_force,
    design_lines,
    station_relief,
    table_nodes,
    tabulated,
    topography,
)
from fegear.design.flanks.trials import FlankTrials, Tried
from fegear.design.load_range import proportions
from fegear.design.preferred import CLEARLY, classes_finer
from fegear.design.tip_relief.tip_tolerance import Decisive
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.flank_modification import Topography
from fegear.geometry.pair import GearPair, Member

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


def design_flanks(
    flanks: FlankPair,
    coarse: Mapping[Member, FlankBody],
    known: FlankCompliance,
    apart: FlankGaps,
    task: FlankDesignTask,
    progress: Callable[[float], None] | None = None,
) -> FlankDesign:
    """Design the flanks of a pair.

    Parameters
    ----------
    flanks : FlankPair
    coarse : mapping of {"driver", "driven"} to FlankBody
        The gears' coarser solutions, for errors.
    known : FlankCompliance
        Of the roll positions of the pair's other results, at which all combinations of a grid are tried.
    apart : FlankGaps
        What keeps the flanks apart besides the relief: misalignment that is known.
    task : FlankDesignTask
    progress : callable, optional

    Raises
    ------
    RangeError
        If no relief of a family keeps to the largest K_Hbeta.
    """
    report = progress or (lambda _fraction: None)
    pair, aligned = flanks.pair, apart.under(task.load)
    panel = flanks.panel * pair.driver.module
    lines = design_lines(pair, task.loading, task.positions, panel)

    def compliance_at(lines: ContactLines) -> FlankCompliance:
        with one_thread():
            return flank_compliance(
                pair, flanks.gears, lines, task.load, coupling=flanks.coupling, hertz=flanks.hertz, cache=flanks.cache
            )

    own = compliance_at(lines)
    report(0.3)
    gap = aligned.at(pair, lines)
    station = station_relief(own, gap, task.loading, task.load)
    x, z = table_nodes(station, pair)
    removal = tabulated(station, pair, x, z)
    table = topography(pair, "driver", x, z, removal)
    grid = task.grid or usual_grid(float(np.ptp(removal)), pair.path_length, pair.face_width, pair.base_pitch)
    judge = flank_judge(flanks, coarse, aligned, task.load, task.deviation)
    plain = judge.plain.known
    # What is ground leaves most where contact lines begin and end, and may leave as much between few roll positions:
    # grids and leaps are tried at few, reliefs are chosen by those that the judge has on both sides of these places.
    loads = np.array(task.loads)
    few = FlankTrials(pair, known, apart.at(pair, known.lines, loads), loads, weights=task.weights)
    force = design_force(known.lines, task.loading, task.load)
    more = FlankTrials(pair, plain, apart.at(pair, plain.lines, loads), loads, weights=task.weights)
    found: dict[str, FamilyBest] = {}
    wanted = [family for family in FAMILIES if family in task.families]
    for number, family in enumerate(wanted):
        starts = _starts([found[held] for held in held_by(family) if held in found])

        def ahead(part: float, first: float = number / len(wanted), share: float = 1.0 / len(wanted)) -> None:
            report(0.3 + 0.4 * (first + share * part))

        found[family] = best_of_family(more, family, grid, force, task.most_factor, starts, few, ahead)
        grid = found[family].grid  # what a family needs, those that hold it need, too
        ahead(1.0)
    if wanted and task.scatter.over_face.size > 1:
        starts = [one.relief for one in found.values() if one.family in (*held_by(wanted[-1]), wanted[-1])]
        scattered, scan = (replace(one, scatter=task.scatter) for one in (more, few))
        found[ROBUST] = best_of_family(scattered, wanted[-1], grid, force, task.most_factor, starts, scan)
        grid = found[ROBUST].grid
        # One start more: where scattered misalignment leads may be the better valley without it, too.
        found[wanted[-1]] = led_on(more, found[wanted[-1]], grid, found[ROBUST].relief, task.most_factor)
    report(0.8)
    reliefs: dict[str, GroundRelief | Topography] = {
        UNRELIEVED: GroundRelief(),
        EXACT: table,
        **{label: one.relief for label, one in found.items()},
    }
    here = replace(few, loads=np.array([task.load]), apart=aligned.at(pair, known.lines), weights=None)
    over = _OverLoads(judge.under(loads, apart), replace(more, weights=None))
    judged: list[FlankState] = []
    for label, relief in reliefs.items():
        judged.append(_state(label, relief, here, judge, over, task))
        report(0.8 + 0.2 * len(judged) / len(reliefs))
    states = tuple(judged)
    design = FlankDesign(task, station, x, z, removal, known.lines.roll, states, found, grid)
    design = replace(design, unrelieved_most=_unrelieved_most(over, pair, design))
    return replace(design, finer=_classes_finer(over, pair, design), decisive=_decisive(over, pair, design))


def _starts(held: Sequence[FamilyBest]) -> list[GroundRelief]:
    """Where a family's search begins besides its grid: valleys of those that it holds, and their sums."""
    found = [valley for one in held for valley in one.valleys]
    tips, leads = ([one for one in held if one.family == family] for family in ("profile", "lead"))
    sums = [
        GroundRelief.of(profile.numbers + lead.numbers, profile.tip_power)
        for first in tips for second in leads for profile, lead in product(first.valleys, second.valleys)
    ]  # fmt: skip
    return [*found, *sums]


class _OverLoads(NamedTuple):
    """The pair under the task's loads: as what is left is judged, and as it is searched."""

    judge: FlankJudge
    searched: FlankTrials


def _state(
    label: str, relief: GroundRelief | Topography, here: FlankTrials, judge: FlankJudge, over_loads: _OverLoads,
    task: FlankDesignTask,
) -> FlankState:  # fmt: skip
    """Judge a relief, and map what it leaves."""

    def gap(lines: ContactLines) -> Array:
        if isinstance(relief, GroundRelief):
            removed = relief.removal_on(here.pair, lines)
        else:
            height = lines.z + here.pair.face_height("driver")
            removed = relief.removal(lines.roll_angle(here.pair, "driver"), height)
        return np.where(lines.present, removed, 0.0)

    count = len(task.map_over_face)
    over = Scatter(np.array(task.map_over_face), np.full(count, 1.0 / count))
    mapped = replace(judge.plain, scatter=over, loads=np.array(task.map_loads))
    te, error = over_loads.judge.left(gap)
    left = np.ptp(te, axis=0)
    mean = left
    if task.scatter.over_face.size > 1:
        dense = over_loads.judge.dense
        mean = mean_over_scatter(dense, gap(dense.known.lines), task.deviation)
    most: Array | None = None
    if task.tolerance is not None and isinstance(relief, GroundRelief) and label != UNRELIEVED:
        dense = over_loads.judge.dense
        off = within_tolerances(over_loads.searched, here.pair, relief.numbers, task.tolerance)
        most = np.array([np.ptp(dense.of_numbers(one).te[0, :, i]) for i, one in enumerate(off)])
        most = np.maximum(most, left)
    lines = over_loads.judge.dense.known.lines
    phase = 2j * np.pi * lines.roll / here.pair.base_pitch
    first = 2.0 * np.abs(lines.mean(np.exp(-phase)[:, None] * (te - lines.mean(te))))
    return FlankState(
        label, relief if isinstance(relief, GroundRelief) else None, here.of_gap(gap(here.known.lines)).te[0, :, 0],
        judge.judge(gap), mapped.of_gap(gap(mapped.known.lines)), left, first, mean, error, most,
    )  # fmt: skip


def _left_densely(over: _OverLoads, numbers: Array) -> Array:
    """Peak-to-peak value of nine numbers of its own under each load, shape (L,) [m]."""
    return np.array([np.ptp(over.judge.dense.of_numbers(one).te[0, :, i]) for i, one in enumerate(numbers)])


def _unrelieved_most(over: _OverLoads, pair: GearPair, design: FlankDesign) -> Array | None:
    """What no relief leaves at most within the same tolerances; None where even without deviations it leaves more."""
    tolerance, none = design.task.tolerance, design.unrelieved.over_peak_to_peak
    if tolerance is None or not design.found:
        return None
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None or not np.any(most > none):
        return None
    return np.maximum(_left_densely(over, unrelieved_within(over.searched, pair, relief.numbers, tolerance)), none)


def _classes_finer(over: _OverLoads, pair: GearPair, design: FlankDesign) -> int | None:
    """By how many classes tolerances would have to be finer for what is to be ground to pay under every load."""
    tolerance, compared = design.task.tolerance, design.unrelieved_most
    if tolerance is None or not design.found or compared is None:
        return 0
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None:
        return 0

    def share(classes: int) -> Array:
        """Of what no relief leaves within tolerances that are so many classes finer."""
        allowed = tolerance.finer(classes)
        left, none = (
            _left_densely(over, of(over.searched, pair, relief.numbers, allowed))
            for of in (within_tolerances, unrelieved_within)
        )
        return np.asarray(left / np.maximum(none, design.unrelieved.over_peak_to_peak))

    return classes_finer(most / compared, np.ones(most.size), share, tolerance.finest)


def _decisive(over: _OverLoads, pair: GearPair, design: FlankDesign) -> tuple[Decisive | None, ...]:
    """Which tolerance decides the most that is left of what is to be ground; empty where nothing has any."""
    tolerance = design.task.tolerance
    if tolerance is None or not design.found:
        return ()
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None:
        return ()
    return decisive_tolerances(over.searched, pair, relief.numbers, tolerance, most)
