"""In which order variants stand, and where the present design stands among them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.design.sizing.feasible import BARE, LARGER_IS_BETTER, RELIEVED, ROOT, costs_of, reasons_of_rating
from fegear.design.sizing.front import pareto_front, rounded_costs
from fegear.design.sizing.limits import broken
from fegear.results.sizing.basis import present_pair
from fegear.results.sizing.sizing_data import Placed, PresentPlaced, SizedVariant

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.sizing.feasible import Lives
    from fegear.design.sizing.limits import SizingLimits
    from fegear.results.sizing.sizing_inputs import SizingInputs

#: Significant digits in which criteria differ when variants are put in order: ties are decided by the rule.
_DIGITS_OF_TE, _DIGITS = 2, 3
#: By how much the centre distance of a present design may miss its range.
_ROUNDED = 2e-4
#: Units in which criteria are read, and their size in SI.
_MICROMETRES, _MILLIMETRES = ("um", 1e-6), ("mm", 1e-3)
UNITS = {
    BARE: _MICROMETRES, RELIEVED: _MICROMETRES, ROOT: ("MPa", 1e6), "centre-distance": _MILLIMETRES,
    "module": _MILLIMETRES, "mass": ("kg", 1.0),
}  # fmt: skip


def in_order(criteria: Sequence[str], chosen: Sequence[SizedVariant]) -> list[SizedVariant]:
    """The front first: by the criteria in their order, ties by mass, larger module, fewer teeth, smaller beta, x_1."""
    known = [one for one in chosen if all(map(math.isfinite, one.costs))]
    unknown = [one for one in chosen if not all(map(math.isfinite, one.costs))]
    costs = np.array([one.costs for one in known]).reshape(len(known), len(criteria))
    on = set(pareto_front(costs).tolist())
    digits = [_DIGITS_OF_TE if name in (BARE, RELIEVED) else _DIGITS for name in criteria]
    rounded = [rounded_costs(costs[:, k], n) for k, n in enumerate(digits)]

    def key(i: int) -> tuple[float, ...]:
        one = known[i]
        rule = (one.mass, -one.module, one.teeth_1 + one.teeth_2, one.helix_angle, one.shift_1, one.number)
        return (i not in on, *(float(column[i]) for column in rounded), *rule)

    order = sorted(range(len(known)), key=key)
    found = [replace(known[i], place=k + 1 if i in on else 0) for k, i in enumerate(order)]
    return [*found, *(replace(one, place=0) for one in unknown)]


def with_shown(known: Array, chosen: Sequence[SizedVariant], lives: Lives) -> Array:
    """Criteria of all that live with those of the variants that are shown."""
    filled = known.copy()
    rows = np.searchsorted(lives.numbers, [one.number - 1 for one in chosen])
    for row, one in zip(rows.tolist(), chosen, strict=True):
        filled[row] = one.costs
    return filled


def _of_rounded_shifts(limits: SizingLimits) -> SizingLimits:
    """Limits for a design whose profile shifts are those of a drawing, rounded: its centre distance may be as well."""
    if limits.distances is None:
        return limits
    low, high = limits.distances
    return replace(limits, distances=(low * (1.0 - _ROUNDED), high * (1.0 + _ROUNDED)))


def placed_present(
    asked: SizingInputs, own: SizedVariant, chosen: Sequence[SizedVariant], lives: Lives, known: Array
) -> PresentPlaced:
    """The present design among the variants.

    Parameters
    ----------
    asked, own, chosen, lives
    known : ndarray
        Criteria of all that live, NaN where one is not known.
    """
    pairs = present_pair(asked.part, asked.part.present)  # type: ignore[arg-type]  # where there is a present design
    with np.errstate(invalid="ignore", divide="ignore"):
        rating, margin = reasons_of_rating(pairs, asked.duty)
        found = (*broken(pairs, _of_rounded_shifts(asked.limits)), *rating)
        by_formulas = costs_of(asked.by_formulas, pairs, margin, asked.duty.material.density)[0]
    off = abs(own.teeth_2 / own.teeth_1 / asked.part.ratio - 1.0) > asked.part.ratio_tolerance + 1e-9
    reasons = (*(("ratio",) if off else ()), *(words for words, mask in found if mask[0]))
    costs = np.array(own.costs)
    by_formulas, worst = np.nan_to_num(by_formulas, nan=np.inf), np.nan_to_num(costs, nan=np.inf)
    by_all = bool(np.isfinite(known).all() and np.isfinite(costs).all())
    others, cost = (known, costs) if by_all else (lives.criteria, by_formulas)
    worse = (others <= cost).all(axis=1) & (others < cost).any(axis=1)
    placed = []
    for k, name in enumerate(asked.criteria):
        unit, size = UNITS.get(name, ("", 1.0))
        sign = -1.0 if name in LARGER_IS_BETTER else 1.0
        compared = known[np.isfinite(known[:, k]), k]
        best = sign * float(compared.min()) / size if compared.size else math.nan
        better = int((compared < costs[k]).sum()) if math.isfinite(costs[k]) else compared.size
        placed.append(Placed(name, sign * own.costs[k] / size, best, better, compared.size, unit))
    shown = ((one, np.array(one.costs)) for one in chosen)
    dominates = (one for one, cost in shown if (cost <= worst).all() and (cost < worst).any())
    return PresentPlaced(own, reasons, tuple(placed), int(worse.sum()), by_all, next(dominates, None))
