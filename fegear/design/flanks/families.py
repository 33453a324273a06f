"""The modification of a family that leaves the least: all combinations of a grid, then descents from the best of them.

Every combination is loaded with `QuickFlanks`; the best are loaded exactly, in the order of what the quick way found,
until the next is so much above the least found that no error of the quick way seen so far could make up for it. The
least of the grid is thereby known, not guessed. From the best of them that lie apart, and from further starts, valleys
within the box of the grid are searched (`fegear.design.flanks.valleys`). Where the best lies at an end of the box that
may be moved, the box is widened and the search goes on.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.shown import shown
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import FAMILIES, GROUPS, Family, ReliefGrid
from fegear.design.flanks.quick import QuickFlanks, quick_flanks
from fegear.design.flanks.search import descend
from fegear.design.flanks.trials import FlankTrials, Tries
from fegear.design.flanks.valley_floors import valley_floors
from fegear.design.flanks.valleys import deepest_valleys, keeps

#: Candidates loaded exactly, at least and at most; those from which descents start; coarse panels over the face.
_LEAST_EXACT, _MOST_EXACT, _STARTS, _PANELS = 160, 240, 60, 5

#: Starts for tip reliefs only: floors of valleys and places of the grid, for which fewer are loaded exactly.
_FLOORS, _ON_GRID, _LEAST_BY_FLOORS = 24, 8, 40

#: Part of the progress of a family for its grid.
_SCREENED = 0.15

#: Combinations whose gaps are held at a time; K_Hbeta of the quick way may err by this much.
_HELD, _FACTOR_SLACK = 4096, 1.05

#: How often a box is widened at most, and the gain, over the value, below which a wider one is not worth it.
_WIDENINGS, _WORTH_WIDENING = 3, 2e-3


@dataclass(frozen=True, slots=True)
class FamilyBest:
    """The best modification of a family.

    Parameters
    ----------
    family : str
    on_grid : GroundRelief
        Best of all combinations of the grid.
    relief : GroundRelief
        Best of all, after the descents.
    value : float
        What this one leaves, see `FlankTrials.value` [m].
    valleys : tuple of GroundRelief
        It and the next best that were found, in other valleys or in the same.
    grid : ReliefGrid
        In whose box it was found, which may be wider than that of the grid that was tried.
    at_ends : mapping of str to bool, optional
        Which of its numbers lie at an end of the box, past which there may be better ones, and whether at the upper.
    """

    family: Family
    on_grid: GroundRelief
    relief: GroundRelief
    value: float
    valleys: tuple[GroundRelief, ...]
    grid: ReliefGrid
    candidates: int = shown("", "number of combinations evaluated", name="combinations")
    exact: int = shown("", "computed exactly", name="loaded_exactly")
    value_on_grid: float = shown(
        "um", "best value on the grid before local optimisation; 0: no search", name="best_on_grid"
    )
    quick_error: float = shown(
        "um", "largest observed overestimate of the approximate method used to screen the combinations"
    )
    proven: bool = shown("", "1: optimum on the grid proven")
    at_ends: Mapping[str, bool] = field(default_factory=dict)


def quick_values(
    quick: QuickFlanks, trials: FlankTrials, family: Family, grid: ReliefGrid
) -> tuple[Array, Array, Array]:
    """Load all combinations of a family's grid the quick way.

    Returns
    -------
    numbers : ndarray, shape (C, 9)
    value : ndarray, shape (C,)
        See `FlankTrials.value` [m].
    factor : ndarray, shape (C,)
        Largest K_Hbeta over misalignments and loads.
    """
    combinations = grid.combinations(family)
    numbers = grid.numbers(family, combinations)
    # Modifications add up: each choice of a group is averaged over the stations once.
    parts = []
    for group in FAMILIES[family]:
        choices = np.zeros((grid.choices(group).shape[0], numbers.shape[1]))
        choices[:, GROUPS[group]] = grid.choices(group)
        parts.append(quick.gaps(np.stack([trials.gap(one) for one in choices])))
    alike = trials.apart.ndim == 2
    apart = [quick.gaps(trials.apart_under(i) + trials.deviations) for i in range(1 if alike else trials.loads.size)]
    value, factor = np.empty(len(numbers)), np.empty(len(numbers))
    for first in range(0, len(numbers), _HELD):
        some = slice(first, first + _HELD)
        gap = np.sum([part[combinations[some, column]] for column, part in enumerate(parts)], axis=0)
        ripple = np.zeros((len(gap), trials.loads.size))
        largest = np.zeros(len(gap))
        for number, weight in enumerate(trials.scatter.weights):
            for i, load in enumerate(trials.loads):
                approach, k = quick.solve(gap + apart[0 if alike else i][number], float(load))
                ripple[:, i] += weight * np.ptp(approach, axis=1)
                largest = np.maximum(largest, k)
        value[some], factor[some] = (ripple * trials.proportion).max(axis=1), largest
    return numbers, value, factor


def best_of_family(
    trials: FlankTrials,
    family: Family,
    grid: ReliefGrid,
    force: Array,
    most_factor: float = np.inf,
    starts: Sequence[GroundRelief] = (),
    scan: FlankTrials | None = None,
    progress: Callable[[float], None] | None = None,
) -> FamilyBest:
    """Find the modification of a family that leaves the least.

    Parameters
    ----------
    trials : FlankTrials
        At the roll positions that count.
    family : str
    grid : ReliefGrid
    force : ndarray, shape (P, M)
        Forces at the stations of `scan`, about which the quick way takes compliances as straight [N].
    most_factor : float
        Largest K_Hbeta that is allowed, at all loads and misalignments.
    starts : sequence of GroundRelief
        Further starts of descents: the best of smaller families, so that more freedom never leaves more.
    scan : FlankTrials, optional
        Fewer roll positions at which the grid is tried; those of `trials` without.
    progress : callable, optional

    Raises
    ------
    RangeError
        If no combination keeps to the largest K_Hbeta.
    """
    few, report = scan or trials, progress or (lambda _fraction: None)
    quick = quick_flanks(few.known, force, _PANELS, few.cells)
    low, high = box = grid.limits(family)
    by_floors = family == "profile" and bool(min(high[GROUPS["driver_tip"][0]], high[GROUPS["driven_tip"][0]]) > 0.0)
    found = _screened(few, quick, family, grid, most_factor, _LEAST_BY_FLOORS if by_floors else _LEAST_EXACT)
    if not found.best:
        raise RangeError(
            "flank_design.largest_face_load_factor", f"{most_factor:.4g}",
            f"is not met by any of the {found.candidates} combinations of {family}; minimum about "
            f"{found.least_factor:.4g}",
            "increase the limit, or extend the grid to more crowning, end relief or slope",
        )  # fmt: skip
    left_on_grid, on_grid = found.best[0]
    ahead = found.best[:_ON_GRID] if by_floors and most_factor == np.inf else found.best
    places = [*(np.clip(start.numbers, low, high) for start in starts), *(at for _, at in ahead)]
    report(_SCREENED)
    floors = _floors(trials, box) if by_floors else []
    valleys = deepest_valleys(
        few, trials, places, box, most_factor, floors, lambda part: report(_SCREENED + (1.0 - _SCREENED) * part)
    )
    if not valleys:  # at more roll positions none keeps to the limit any more: what does so at few of them stays
        valleys = [(trials.value(trials.of_numbers(on_grid).peak_to_peak), on_grid)]
    at_ends = grid.at_ends(family, valleys[0][1])
    for _ in range(_WIDENINGS):
        wider = grid.widened(family, valleys[0][1])
        if wider is grid:
            break
        further = deepest_valleys(few, trials, [at for _, at in valleys], wider.limits(family), most_factor)
        if not further or further[0][0] > (1.0 - _WORTH_WIDENING) * valleys[0][0]:  # nothing better past these ends
            at_ends = {name: at_ends[name] for name in at_ends if wider.reach.get(name) == grid.reach.get(name)}
            break
        grid, valleys = wider, further
        at_ends = grid.at_ends(family, valleys[0][1])
    reliefs = tuple(trials.relief(at) for _, at in valleys)
    return FamilyBest(
        family, trials.relief(on_grid), reliefs[0], valleys[0][0], reliefs, grid, found.candidates, found.exact,
        left_on_grid, found.error, found.proven, at_ends,
    )  # fmt: skip


def _floors(trials: FlankTrials, box: tuple[Array, Array]) -> list[Array]:
    """Tip reliefs on the floors of valleys."""
    plain = trials.of_gap(np.zeros(trials.known.lines.x.shape)).found[0].contact.force
    at_loads = [quick_flanks(trials.known, plain[:, :, i], _PANELS, 1) for i in range(trials.loads.size)]
    return valley_floors(at_loads, trials, box)[:_FLOORS]


@dataclass(frozen=True, slots=True)
class _Screened:
    """The best combinations of a grid, by the positions at which it was tried.

    Parameters
    ----------
    best : list of (float, ndarray)
        What is left [m] and nine numbers, the best first, at most `_STARTS`.
    candidates, exact : int
        Combinations, and those that were loaded exactly.
    error : float
        By which the quick way was too high at most [m].
    proven : bool
    least_factor : float
        Smallest K_Hbeta of any, by the quick way.
    """

    best: list[tuple[float, Array]]
    candidates: int
    exact: int
    error: float
    proven: bool
    least_factor: float


def _screened(
    few: FlankTrials, quick: QuickFlanks, family: Family, grid: ReliefGrid, most_factor: float, least: int
) -> _Screened:  # fmt: skip
    """Try all combinations of a grid the quick way, and the best of them exactly, so many at least."""
    numbers, rough, factor = quick_values(quick, few, family, grid)
    allowed = factor <= most_factor * _FACTOR_SLACK
    order = np.argsort(np.where(allowed, rough, np.inf), kind="stable")[: int(allowed.sum())]
    seen: list[tuple[float, int]] = []
    error, exact, tries = 0.0, 0, Tries(few, np.ptp(numbers, axis=0))

    def load(i: int) -> None:
        nonlocal error, exact, seen
        tried = tries.of(numbers[i])
        exact += 1
        value = few.value(tried.peak_to_peak)
        error = max(error, rough[i] - value)
        # K_Hbeta costs as much as the contact: asked only of those that a descent might start from.
        if (len(seen) < _STARTS or value < seen[-1][0]) and keeps(tried, most_factor):
            seen = sorted([*seen, (value, i)])[:_STARTS]

    for i in order[:_MOST_EXACT].tolist():
        if exact >= least and seen and rough[i] - error > seen[0][0]:
            break
        load(i)
    in_order = exact
    if not seen:  # what leaves least is above the limit by no more than the quick way may err
        for i in sorted(order[in_order:].tolist(), key=lambda i: float(factor[i]))[:_STARTS]:
            load(i)
    ended = exact == len(order) or (
        in_order < len(order) and bool(seen) and (float(rough[order[in_order]]) - error > seen[0][0])
    )
    proven = bool(seen) and ended
    best = [(value, numbers[i]) for value, i in seen]
    return _Screened(best, len(numbers), exact, error, proven, float(factor.min()))


def led_on(
    trials: FlankTrials, best: FamilyBest, grid: ReliefGrid, start: GroundRelief, most_factor: float = np.inf
) -> FamilyBest:
    """Try a further start of the same family; the best of both."""
    low, high = grid.limits(best.family)
    at = np.clip(start.numbers, low, high)
    tried = trials.of_numbers(at)
    if not keeps(tried, most_factor):
        return best
    value, at = descend(trials, at, trials.value(tried.peak_to_peak), (low, high), most_factor)
    if value >= best.value:
        return best
    return replace(best, relief=trials.relief(at), value=value, at_ends=grid.at_ends(best.family, at))
