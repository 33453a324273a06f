"""What is known of all variants that live before any is solved: criteria by formulas and by the atlas.

Variants of a family that an atlas contains have their transmission error from it, all of them; the best of the others
are left to coarse finite elements, of helical ones the best by thin slices of such gears.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.design.sizing.by_atlas import LENGTHS, AtlasDuty, Bare, Relieved, bare_errors, relieved_errors
from fegear.design.sizing.feasible import BARE, RELIEVED, ROOT
from fegear.design.sizing.front import best_by_fronts, best_by_ranks, pareto_front, rounded_costs
from fegear.results.sizing.by_atlas import bare_of, relieved_of, sliced_of
from fegear.results.sizing.by_fe import FromFE
from fegear.results.sizing.sizing_data import BestRelief

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.design.sizing.feasible import Lives
    from fegear.design.sizing.space import SizingSpace
    from fegear.engine.progress import Progress
    from fegear.engine.stage import Work
    from fegear.geometry.many_pairs import ManyGearPairs

#: Variants of a front that are shown at most, and variants that are shown at least where so many are known.
MOST_SHOWN, _LEAST_SHOWN = 500, 24


@dataclass(frozen=True, eq=False)
class Estimated:
    """Criteria of all variants that live.

    Parameters
    ----------
    costs : ndarray, shape (N, k)
        NaN where one is not known.
    bare : Bare
    rows : ndarray of int, shape (R,)
        Of those for which a relief was searched, ascending.
    relieved : Relieved
        Of these.
    sliced : ndarray, shape (N,)
        Transmission error of helical ones by thin slices, for an order only; NaN of others, empty where none is wanted.
    """

    costs: Array
    bare: Bare
    rows: Index
    relieved: Relieved | None
    sliced: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def known(self) -> Index:
        """Rows of which every criterion is known."""
        return np.flatnonzero(np.isfinite(self.costs).all(axis=1))

    def estimate(self, row: int) -> FromFE | None:
        """Transmission error of one by the atlas."""
        return _from_atlas(self.bare, row)

    def relief(self, row: int) -> BestRelief | None:
        """Its relief, where one was searched."""
        at = int(np.searchsorted(self.rows, row))
        if self.relieved is None or at == self.rows.size or self.rows[at] != row:
            return None
        return _relief(self.relieved, at)

    def at_limit(self, row: int) -> tuple[str, ...]:
        """Whether the amount of its relief is the largest that was tried."""
        at = int(np.searchsorted(self.rows, row))
        if self.relieved is None or at == self.rows.size or self.rows[at] != row or not self.relieved.at_limit[at]:
            return ()
        return ("amount of relief (maximum)",)


def _from_atlas(bare: Bare, row: int) -> FromFE | None:
    te, error, root, root_error = (float(values[row]) for values in bare)
    return FromFE(te, error, root, root_error, source="atlas") if math.isfinite(te) else None


def _relief(found: Relieved, at: int) -> BestRelief | None:
    te, amount = float(found.te[at]), float(found.amount[at])
    if not math.isfinite(te):
        return None
    kind = LENGTHS[int(found.kind[at])] if amount > 0.0 else ""
    return BestRelief(te, amount, kind, (float(found.lengths[0, at]), float(found.lengths[1, at])))


def of_one(pairs: ManyGearPairs, duty: AtlasDuty, *, relieved: bool) -> tuple[FromFE | None, BestRelief | None]:
    """What the atlas says of a single pair, the present design."""
    with np.errstate(invalid="ignore", divide="ignore"):
        bare = _from_atlas(bare_errors(pairs, duty), 0)
        return bare, _relief(relieved_errors(pairs, duty), 0) if relieved and bare else None


def estimated(
    space: SizingSpace, lives: Lives, names: tuple[str, ...], duty: AtlasDuty | None, most: tuple[int, int], work: Work,
    progress: Progress,
) -> Estimated:  # fmt: skip
    """Criteria of all variants that live.

    Parameters
    ----------
    space, lives
    names : tuple of str
        Criteria.
    duty : AtlasDuty or None
        None where no atlas can be asked.
    most : (int, int)
        Variants that are looked up, and those for which reliefs are searched, at most.
    work, progress
    """
    count = lives.numbers.size
    costs = np.full((count, len(names)), np.nan)
    for k, name in enumerate(names):
        if name in lives.names:
            costs[:, k] = lives.criteria[:, lives.names.index(name)]
    unknown, none = np.full(count, np.nan), np.zeros(0, dtype=np.int64)
    if duty is None or not count:
        return Estimated(costs, Bare.unknown(count), none, None, unknown)
    bare, share = Bare.unknown(count), 0.5 if RELIEVED in names else 1.0
    looked = best_by_ranks(lives.criteria, most[0])
    found = bare_of(space, lives.numbers[looked], duty, work, lambda part: progress(share * part))
    for values, of_looked in zip(bare, found, strict=True):
        values[looked] = of_looked
    for k, name in enumerate(names):
        if name in (BARE, RELIEVED, ROOT):
            costs[:, k] = bare.root if name == ROOT else bare.te
    if RELIEVED not in names:
        unknown[looked] = sliced_of(space, lives.numbers[looked], duty, work, lambda _part: None)
        return Estimated(costs, bare, none, None, unknown)
    held = np.flatnonzero(np.isfinite(costs).all(axis=1))
    rows = held[best_by_fronts(costs[held], most[1])]
    relieved = relieved_of(space, lives.numbers[rows], duty, work, lambda part: progress(share + (1.0 - share) * part))
    costs[:, names.index(RELIEVED)] = np.nan
    costs[rows, names.index(RELIEVED)] = relieved.te
    return Estimated(costs, bare, rows, relieved, unknown)


def screened_rows(lives: Lives, known: Estimated, names: tuple[str, ...], count: int) -> Index:
    """Which of the variants that no atlas contains are left to coarse finite elements, front after front.

    Those with a transmission error by thin slices are compared by that and what formulas give, the others by formulas;
    both have their share of the `count`.
    """
    other = np.flatnonzero(~np.isfinite(known.bare.te))
    sliced = np.isfinite(known.sliced[other]) & (BARE in names)
    by_slices, by_formulas = other[sliced], other[~sliced]
    share = round(count * by_slices.size / max(other.size, 1))
    if by_slices.size and by_formulas.size:
        share = min(max(share, 1), max(count - 1, 1))
    given = [k for k, name in enumerate(names) if name in lives.names or name == BARE]
    costs = known.costs[by_slices].copy()
    if BARE in names:
        costs[:, names.index(BARE)] = known.sliced[by_slices]
    return np.concatenate([
        by_slices[best_by_fronts(costs[:, given], share)],
        by_formulas[best_by_fronts(lives.criteria[by_formulas], count - share)],
    ])  # fmt: skip


def shown_rows(costs: Array, rows: Index, first: int, *, compared: bool) -> Index:
    """Which of the variants with known criteria are shown.

    The front, of a large one the `first` by the criteria in their order and others evenly along it; where others are to
    be `compared`, of a small one the fronts behind it as well.
    """
    front = pareto_front(costs[rows])
    if front.size <= MOST_SHOWN:
        least = min(_LEAST_SHOWN, rows.size) if compared else 0
        return rows[best_by_fronts(costs[rows], max(front.size, least))]
    along = front[np.lexsort(rounded_costs(costs[rows][front]).T[::-1])]
    even = np.linspace(first, front.size - 1, MOST_SHOWN - first).round().astype(int)
    return rows[along[np.unique([*range(first), *even])]]
