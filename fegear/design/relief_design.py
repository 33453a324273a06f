"""The whole design of a pair's relief: loading, relief by (4.6), what can be ground, and what each leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.solution_cache import SolutionCache
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.contact.plane.transmission_error import TransmissionError, transmission_error
from fegear.design.charts import Metric
from fegear.design.excitation_relief import MinimumExcitationRelief
from fegear.design.ground_digits import rounded_tips
from fegear.design.load_range import LoadRange, proportions
from fegear.design.loading import LoadingFunction
from fegear.design.minimum_excitation import ReliefTable, minimum_excitation, relief_nodes, relief_table
from fegear.design.oil_film import OilFilm
from fegear.design.preferred import classes_finer, preferred
from fegear.design.root_stress_loading import Allowed, StressOptimum, design_stress, least_root_stress
from fegear.design.tip_relief.grindable import TipReliefPair, grindable, tolerated
from fegear.design.tip_relief.relief_limits import ReliefLimits
from fegear.design.tip_relief.tip_tolerance import Decisive, TipTolerance
from fegear.design.tip_relief.tolerated import decisive_tolerances, unrelieved_within, within_tolerances
from fegear.geometry.pair import MEMBERS, Member
from fegear.geometry.relief import UNMODIFIED, Shape

#: No error of a relief is stated below this part of the largest deflection: the last digits of a mesh's coordinates,
#: which another processor rounds otherwise, move finite-element compliances, and the reliefs made of them, by up to
#: 3e-10 of it.
_DIGITS = 1e-9
#: How far a design has come when reliefs are searched for, what they leave is read, their tolerances are, what these
#: are compared with is, and the tolerances that would do.
_SEARCHES, _READINGS, _WITHIN, _COMPARED, _LAST = 0.1, 0.4, 0.65, 0.85, 0.95
#: Harmonics at loads other than that of the design, where the first one and the extremes are wanted.
_OVER_LOADS = 12


@dataclass(frozen=True)
class DesignTask:
    """What a relief is designed for.

    Parameters
    ----------
    loading : LoadingFunction
    load : float
        W_d [N].
    least_root_stress : bool
        Whether family and peak of the loading are chosen for the least root stress.
    grind : tuple of str
        Shapes of tip relief that a shop can grind.
    metric : {"peak_to_peak", "effective_error"}
        By which those are chosen.
    loads : tuple of float
        Of the curves [N].
    positions, harmonics : int
        Of the curves over the base pitch, and of the transmission errors.
    allowed : Allowed, optional
        With it pressure counts in that choice too.
    film : OilFilm, optional
        Between the flanks at the design load; the reliefs make up for it, and everything runs with it.
    over : LoadRange, optional
        Loads that reliefs to grind are designed for in place of the design load only.
    tip_tolerances : tuple of TipTolerance, optional
        Of the reliefs to grind on driver and driven gear.
    tip_limits : ReliefLimits, optional
        Of what is ground.
    at_most : bool
        Whether what is ground is chosen by the largest peak-to-peak value within its tolerances, over the metric as
        drawn.
    """

    loading: LoadingFunction
    load: float
    least_root_stress: bool
    grind: tuple[Shape, ...]
    metric: Metric
    loads: tuple[float, ...]
    positions: int
    harmonics: int
    allowed: Allowed | None = None
    film: OilFilm | None = None
    over: LoadRange | None = None
    tip_tolerances: tuple[TipTolerance, TipTolerance] | None = None
    tip_limits: ReliefLimits | None = None
    at_most: bool = False

    @property
    def over_loads(self) -> tuple[float, ...]:
        """Loads at which reliefs are compared: those of the range, or all of the curves [N]."""
        return self.loads if self.over is None else self.over.loads

    @property
    def over_weights(self) -> Array:
        """What each of these counts: only the design load without a range."""
        loads = np.array(self.over_loads)
        if self.over is None:
            return np.asarray(loads == self.load, dtype=float)
        return np.ones(loads.size) if self.over.weights is None else np.array(self.over.weights)

    def grind_on(self, engagement: Engagement, shape: Shape, cache: SolutionCache | None = None) -> TipReliefPair:
        """The reliefs of a shape to grind, for the range or for the design load."""
        over = self.load if self.over is None else self.over
        if self.at_most and self.tip_tolerances is not None:
            return tolerated(engagement, over, shape, self.tip_tolerances, limits=self.tip_limits, cache=cache)
        return grindable(engagement, over, shape, self.metric, limits=self.tip_limits, cache=cache)


@dataclass(frozen=True)
class MemberRelief:
    """Relief of one gear at the nodes of its table, shape (n,).

    Parameters
    ----------
    table : ReliefTable
    diagonal : ndarray or None
        Relief without the neighbours' loads (Mark 5.4) [m]; None where teeth are not coupled.
    error : ndarray or None
        Estimated error of the relief [m]; None where the compliances state none.
    """

    table: ReliefTable
    diagonal: Array | None
    error: Array | None


@dataclass(frozen=True)
class ReliefDesign:
    """A designed relief and what it leaves.

    Parameters
    ----------
    task : DesignTask
        Its loading is the one that was chosen.
    chosen : StressOptimum or None
        The loadings tried for the least root stress.
    designed : Engagement
        With the relief of (4.6) by the full influence matrix.
    reliefs : mapping of member to MemberRelief
    ground : mapping of shape to TipReliefPair
        What a shop can grind: for the range of the task, or for the design load.
    for_one_load : mapping of shape to TipReliefPair
        The same for the design load only, without the band of equally good ones; empty without a range.
    te : mapping of str to TransmissionError
        At the design load: "no relief", "designed", "diagonal only", each shape ground, and "present relief" where the
        pair has one; with a range also each shape for the design load only ("linear tip relief for one load").
    curves : mapping of str to Loaded
        The same over roll positions, for every load.
    over_range : mapping of str to tuple of TransmissionError
        The same as `te`, but for "diagonal only", at each of the task's `over_loads`.
    within : mapping of shape to ndarray, shape (L, 2)
        Least and largest peak-to-peak value at each of these with the reliefs to grind inside their tolerances [m];
        empty without tolerances, or with a film.
    decisive : tuple of Decisive or None
        Which tolerance decides the largest of these at each load for the shape to be ground; empty as `within`.
    finer : int or None
        By how many classes the tolerances would have to be finer for the shape to be ground to leave no more than no
        relief with profile slopes inside the same tolerances at any of these loads that counts: 0 where they do, None
        where none does.
    tables_leave : float
        Transmission error, peak to peak, of the relief tables read back linearly [m].
    rounded : mapping of shape to ndarray, shape (L,)
        Peak-to-peak value at each of these loads with the reliefs to grind as they are rounded for the drawing [m].
    unrelieved_most : ndarray, shape (L,), or None
        Largest peak-to-peak value at each of these loads without relief, with profile slopes inside the tolerances [m];
        None where the shape to be ground leaves no more than no relief without deviations.
    undeviated : ndarray, shape (L, 2), or None
        Where the largest value within the tolerances is made small: what the relief of the same shape that leaves the
        least as drawn leaves as drawn, and at most within the tolerances, at each of these loads [m].
    """

    task: DesignTask
    chosen: StressOptimum | None
    designed: Engagement
    reliefs: Mapping[Member, MemberRelief]
    ground: Mapping[Shape, TipReliefPair]
    for_one_load: Mapping[Shape, TipReliefPair]
    te: Mapping[str, TransmissionError]
    curves: Mapping[str, Loaded]
    over_range: Mapping[str, tuple[TransmissionError, ...]]
    within: Mapping[Shape, Array]
    tables_leave: float
    finer: int | None = 0
    decisive: tuple[Decisive | None, ...] = ()
    rounded: Mapping[Shape, Array] = field(default_factory=dict)
    unrelieved_most: Array | None = None
    undeviated: Array | None = None

    @property
    def shapes(self) -> list[Shape]:
        """Of the reliefs to grind, the one to be ground first: by what they leave, also within their tolerances."""
        part = proportions(np.array(self.task.over_loads), self.task.over_weights)
        within = {shape: float((both[:, 1] * part).max()) for shape, both in self.within.items()}
        return preferred({shape: one.objective for shape, one in self.ground.items()}, within)

    @property
    def best_ground(self) -> tuple[Shape, TipReliefPair]:
        """The shape to be ground, and its reliefs."""
        shape = self.shapes[0]
        return shape, self.ground[shape]


def design_relief(
    engagement: Engagement,
    shifted: Sequence[Engagement],
    task: DesignTask,
    progress: Callable[[float], None] | None = None,
    cache: SolutionCache | None = None,
) -> ReliefDesign:
    """Design the relief of both gears of a pair.

    Parameters
    ----------
    engagement : Engagement
        Reliefs and spacing errors of its own are left aside: they are what the design replaces. A relief of its own is
        compared with what is designed for a range.
    shifted : sequence of Engagement
        The same with one compliance each off by its estimated error.
    task : DesignTask
    progress : callable, optional
    cache : SolutionCache, optional
        Where searches for tip reliefs are recalled from and kept.
    """
    report = progress or (lambda _fraction: None)
    load, chosen = task.load, None
    plain = replace(
        engagement, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED,
        driver_spacing=np.empty(0), driven_spacing=np.empty(0),
    )  # fmt: skip
    if task.least_root_stress:
        chosen = least_root_stress(design_stress(plain.compliance), task.loading, allowed=task.allowed)
        task = replace(task, loading=chosen.loading)
    film = task.film
    states = {"no relief": plain, "designed": minimum_excitation(plain, task.loading, load, film=film)}
    designed = states["designed"]
    if plain.compliance.coupling and max(plain.compliance.driver.reach, plain.compliance.driven.reach) > 0:
        states["diagonal only"] = minimum_excitation(plain, task.loading, load, full_matrix=False, film=film)
    others = [
        minimum_excitation(replace(plain, compliance=s.compliance), task.loading, load, film=film) for s in shifted
    ]
    reliefs = _reliefs(designed, states.get("diagonal only"), others)
    report(_SEARCHES)
    ground: dict[Shape, TipReliefPair] = {}
    for_one_load: dict[Shape, TipReliefPair] = {}
    for number, shape in enumerate(dict.fromkeys(task.grind)):
        ground[shape] = task.grind_on(designed, shape, cache)
        states[f"{shape} tip relief"] = ground[shape].applied(plain)
        if task.over is not None:
            for_one_load[shape] = grindable(
                designed, load, shape, task.metric, banded=False, limits=task.tip_limits, cache=cache
            )
            states[f"{shape} tip relief for one load"] = for_one_load[shape].applied(plain)
        report(_SEARCHES + (_READINGS - _SEARCHES) * (number + 1) / len(task.grind))
    if (engagement.driver_relief, engagement.driven_relief) != (UNMODIFIED, UNMODIFIED):
        states["present relief"] = replace(engagement, driver_spacing=np.empty(0), driven_spacing=np.empty(0))
    if film is not None:
        states = {label: film.between(state) for label, state in states.items()}
    te: dict[str, TransmissionError] = {}
    over_range: dict[str, tuple[TransmissionError, ...]] = {}
    for number, (label, state) in enumerate(states.items()):
        te[label] = transmission_error(state, load, task.harmonics)
        if label != "diagonal only":
            over_range[label] = tuple(
                te[label] if one == load else transmission_error(state, one, _OVER_LOADS) for one in task.over_loads
            )
        report(_READINGS + (_WITHIN - _READINGS) * (number + 1) / len(states))
    rounded = {shape: _as_rounded(plain, one, task) for shape, one in ground.items()}
    within: dict[Shape, Array] = {}
    if film is None and task.tip_tolerances is not None:
        for number, (shape, one) in enumerate(ground.items()):
            within[shape] = within_tolerances(plain, (one.driver, one.driven), task.tip_tolerances, task.over_loads)
            report(_WITHIN + (_COMPARED - _WITHIN) * (number + 1) / len(ground))
    report(_COMPARED)
    x = roll_positions(engagement, task.positions)
    curves = {label: state.solve(state.grid(x), task.loads) for label, state in states.items()}
    driver, driven = (reliefs[member].table.relieved() for member in MEMBERS)
    read = replace(designed, driver_relief=driver, driven_relief=driven)
    tables_leave = transmission_error(read if film is None else film.between(read), load, task.harmonics).peak_to_peak
    design = ReliefDesign(
        task, chosen, designed, reliefs, ground, for_one_load, te, curves, over_range, within, tables_leave,
        rounded=rounded,
    )  # fmt: skip
    design = replace(design, unrelieved_most=_unrelieved_most(plain, design), undeviated=_undeviated(plain, design))
    report(_LAST)
    return replace(design, finer=_classes_finer(plain, design), decisive=_decisive(plain, design))


def _as_rounded(plain: Engagement, ground: TipReliefPair, task: DesignTask) -> Array:
    """Peak-to-peak value at each load with the digits of the drawing [m]."""
    state = rounded_tips(plain.pair, ground).applied(plain)
    if task.film is not None:
        state = task.film.between(state)
    found = (
        transmission_error(state, one, task.harmonics if one == task.load else _OVER_LOADS) for one in task.over_loads
    )
    return np.array([one.peak_to_peak for one in found])


def _unrelieved_most(plain: Engagement, design: ReliefDesign) -> Array | None:
    """What no relief leaves at most within the same tolerances; None where even without deviations it leaves more."""
    task = design.task
    if task.tip_tolerances is None or not design.within:
        return None
    none = np.array([one.peak_to_peak for one in design.over_range["no relief"]])
    worse = (design.within[design.best_ground[0]][:, 1] > none) & (task.over_weights > 0.0)
    return unrelieved_within(plain, task.tip_tolerances, task.over_loads) if worse.any() else None


def _undeviated(plain: Engagement, design: ReliefDesign) -> Array | None:
    """What the relief that leaves the least as drawn leaves so, and at most, beside the one to be ground."""
    task = design.task
    tips = design.best_ground[1].undeviated if design.ground else None
    if tips is None or task.tip_tolerances is None:
        return None
    state = replace(plain, driver_relief=tips[0], driven_relief=tips[1])
    drawn = [transmission_error(state, load, _OVER_LOADS).peak_to_peak for load in task.over_loads]
    most = within_tolerances(plain, tips, task.tip_tolerances, task.over_loads)[:, 1]
    return np.stack([np.array(drawn), most], axis=1)


def _classes_finer(plain: Engagement, design: ReliefDesign) -> int | None:
    """By how many classes tolerances would have to be finer for the shape to be ground to pay at every load."""
    task = design.task
    if task.tip_tolerances is None or not design.within or design.unrelieved_most is None:
        return 0
    shape, ground = design.best_ground
    both, counts = task.tip_tolerances, task.over_weights > 0.0
    loads = np.array(task.over_loads)[counts]

    def share(classes: int) -> Array:
        """Of what no relief leaves within tolerances that are so many classes finer."""
        allowed = both[0].finer(classes), both[1].finer(classes)
        most = within_tolerances(plain, (ground.driver, ground.driven), allowed, loads)[:, 1]
        return np.asarray(most / unrelieved_within(plain, allowed, loads))

    finest = min(one.finest for one in both)
    as_given = design.within[shape][counts, 1] / design.unrelieved_most[counts]
    return classes_finer(as_given, np.ones(loads.size), share, finest)


def _decisive(plain: Engagement, design: ReliefDesign) -> tuple[Decisive | None, ...]:
    """Which tolerance decides what the shape to be ground leaves at most at each load; empty without tolerances."""
    task = design.task
    if task.tip_tolerances is None or not design.within:
        return ()
    shape, ground = design.best_ground
    tips, most = (ground.driver, ground.driven), design.within[shape][:, 1]
    return decisive_tolerances(plain, tips, task.tip_tolerances, task.over_loads, most)


def relief_at(designed: Engagement, member: Member, roll_angles: ArrayLike) -> ReliefTable:
    """Designed relief of one gear at roll angles of its own [rad], in their order."""
    x = designed.pair.x_of_roll(np.asarray(roll_angles, dtype=float), member)
    return relief_table(_own(designed, member), x)


def _own(engagement: Engagement, member: Member) -> MinimumExcitationRelief:
    """The relief that `minimum_excitation` has put on a flank."""
    relief = engagement.driver_relief if member == "driver" else engagement.driven_relief
    return cast("MinimumExcitationRelief", relief)


def _reliefs(
    designed: Engagement, diagonal: Engagement | None, others: Sequence[Engagement]
) -> dict[Member, MemberRelief]:
    nodes, found = relief_nodes(*(_own(designed, member) for member in MEMBERS)), {}
    for member in MEMBERS:
        table = relief_table(_own(designed, member), nodes)
        plain = None if diagonal is None else _own(diagonal, member).at(table.x)
        changes = [np.abs(_own(other, member).at(table.x) - table.relief) for other in others]
        least = _DIGITS * float(table.deflection.max())
        found[member] = MemberRelief(table, plain, np.maximum(np.sum(changes, axis=0), least) if changes else None)
    return found
