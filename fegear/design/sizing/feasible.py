"""Feasible variants: all are enumerated, the limits that they break counted, and those that keep all rated by formulas.

What is left are numbers of variants and their criteria; memory does not grow with what was excluded.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.design.sizing.limits import SizingLimits, broken, masses
from fegear.design.sizing.rated import SizingDuty, safeties

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index, Mask
    from fegear.design.sizing.space import SizingSpace
    from fegear.geometry.many_pairs import ManyGearPairs

#: Criteria of which more is better.
LARGER_IS_BETTER = frozenset({"safety", "contact-ratio", "sliding"})
#: Transmission error of unmodified flanks, and with the best tip relief.
BARE, RELIEVED = "transmission-error", "relieved-transmission-error"
#: Root stress of unmodified flanks.
ROOT = "root-stress"
#: Criteria that only finite elements give, at first hand or by an atlas of solved gears.
BY_FE = frozenset({BARE, RELIEVED, ROOT})


@dataclass(frozen=True)
class Lives(ReadOnlyArrays):
    """Variants that keep all limits.

    Parameters
    ----------
    numbers : ndarray, shape (N,)
    criteria : ndarray, shape (N, k)
        Costs of the criteria that formulas give: negative where more is better.
    names : tuple of str
        Of the criteria.
    reasons : mapping of str to int
        How many variants each reason excluded.
    count : int
        Of all variants.
    """

    numbers: Index
    criteria: Array
    names: tuple[str, ...]
    reasons: Mapping[str, int]
    count: int


def costs_of(names: tuple[str, ...], pairs: ManyGearPairs, margin: Array, density: float) -> Array:
    """Costs of criteria by name, shape (N, k)."""
    of: dict[str, Callable[[], Array]] = {
        "mass": lambda: masses(pairs, density),
        "centre-distance": lambda: pairs.centre_distance,
        "loss": lambda: pairs.tooth_loss_factor,
        "safety": lambda: margin,
        "contact-ratio": lambda: pairs.contact_ratio + pairs.overlap_ratio,
        "sliding": lambda: pairs.specific_sliding.min(axis=0),
        "module": lambda: pairs.module,
    }
    found = [(-1.0 if name in LARGER_IS_BETTER else 1.0) * of[name]() for name in names]
    return np.array(found).reshape(len(names), len(pairs)).T


def reasons_of_rating(pairs: ManyGearPairs, duty: SizingDuty) -> tuple[tuple[tuple[str, Mask], ...], Array]:
    """Why pairs fail the rating, in order, and their load margins."""
    found = safeties(pairs, duty)
    s_h, s_f = found.contact.min(axis=0), found.bending.min(axis=0)
    with np.errstate(invalid="ignore"):
        failed = (("S_H", s_h < duty.required[0]), ("S_F", s_f < duty.required[1]))
    refused = tuple((f"not rated: {words}", mask) for words, mask in found.refused)
    return (*refused, *failed), found.margin(duty.required)


def _count(reasons: dict[str, int], found: tuple[tuple[str, Mask], ...], alive: Mask) -> Mask:
    """Count the first reason of each; which pass all."""
    for words, mask in found:
        hit = mask & alive
        reasons[words] = reasons.get(words, 0) + int(hit.sum())
        alive = alive & ~mask
    return alive


def sieve(
    space: SizingSpace,
    limits: SizingLimits,
    duty: SizingDuty,
    names: tuple[str, ...],
    progress: Callable[[float], None] = lambda _part: None,
) -> Lives:
    """Look at every variant.

    Parameters
    ----------
    space, limits, duty
    names : tuple of str
        Criteria that formulas give.
    progress : callable
        Receives the fraction done.
    """
    space.refuse_none_or_too_many()
    reasons: dict[str, int] = {}
    numbers: list[Index] = []
    criteria: list[Array] = []
    for some, pairs in space.chunks():
        alive = _count(reasons, broken(pairs, limits), np.ones(len(pairs), dtype=bool))
        where = np.flatnonzero(alive)
        if where.size:
            kept = pairs.at(where)
            found, margin = reasons_of_rating(kept, duty)
            passed = np.flatnonzero(_count(reasons, found, np.ones(where.size, dtype=bool)))
            numbers.append(some[where[passed]])
            criteria.append(costs_of(names, kept.at(passed), margin[passed], duty.material.density))
        progress(float(some[-1] + 1) / space.count)
    empty = np.zeros((0, len(names)))
    return Lives(
        np.concatenate(numbers) if numbers else np.zeros(0, dtype=np.int64),
        np.concatenate(criteria) if criteria else empty,
        names, {words: n for words, n in reasons.items() if n}, space.count,
    )  # fmt: skip
