"""The least largest stress of a family of fillets within its limits, by linear programmes in regions of trust.

At the least many points of the fillet are stressed alike, so that the largest stress has a kink there, and what slopes
of one point promise the next one takes away. Each step lets the largest of all points fall as their slopes say, within
the slopes of the limits, and is kept where the truth follows (R. Fletcher, Practical Methods of Optimization, 14.5).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.design.fillet.fillet_bench import FilletBench, Judged
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.design.fillet.shared_bottom import BothFillets, BothSides
from fegear.geometry.fillet_shapes import PointsFillet

#: First and last region of trust, of the family's spread; how slopes are taken; rounds; promised gain that ends it.
_TRUST, _NO_TRUST, _SLOPE, _ROUNDS, _ENDED = 0.5, 2e-3, 0.02, 30, 1e-4
#: Weight of a broken limit against the relative stress.
_BROKEN = 10.0
#: How far below zero what is left of a limit may end.
KEPT = 1e-3
#: Weight of the largest stress of each of two fillets against that of both: the less stressed one is not left as it is.
_EACH = 0.02

#: Families of fillets.
Family = MovedEllipses | BothSides
#: Fillets of a family.
Designed = PointsFillet | BothFillets


@dataclass(frozen=True)
class Found:
    """The best fillet of a family from a start.

    Parameters
    ----------
    numbers : ndarray
    shape : PointsFillet or BothFillets
    stress : float
        On the search's mesh, under the present loads [Pa].
    tried : int
        Fillets that were solved.
    room : float
        What is left of its limits; negative: broken, see `FilletBench.room`.
    """

    numbers: Array
    shape: Designed
    stress: float
    tried: int
    room: float = 0.0

    @property
    def kept(self) -> bool:
        """Whether it keeps its limits."""
        return self.room > -KEPT


def search(bench: FilletBench, family: Family, present: float, start: Array) -> Found:
    """Lead a fillet to the least nearby.

    Parameters
    ----------
    bench : FilletBench
    family : MovedEllipses
    present : float
        Stress that others are measured by [Pa].
    start : ndarray
        Numbers of a fillet that can be.
    """
    begun, spread, trust = bench.tried, family.spread, _TRUST
    numbers = np.asarray(start, dtype=float)
    at = _judged(bench, family, numbers)
    if at is None:
        raise GeometryError("fillet_design", "the start", "is not a fillet of this gear")
    for _ in range(_ROUNDS):
        slopes = _slopes(bench, family, numbers, at)
        while trust > _NO_TRUST:
            step, promised = _programme(at, slopes, present, numbers, family, trust)
            if promised < _ENDED:
                return _found(bench, family, numbers, at, begun)
            there = _judged(bench, family, numbers + step * spread)
            gained = -math.inf if there is None else _merit(at, present) - _merit(there, present)
            if there is not None and gained > 0.1 * promised:
                numbers, at = numbers + step * spread, there
                trust *= 1.6 if gained > 0.6 * promised else 1.0
                break
            trust *= 0.3
        else:
            break
    return _found(bench, family, numbers, at, begun)


def _found(bench: FilletBench, family: Family, numbers: Array, at: Judged, begun: int) -> Found:
    room = float(at.room.min())
    return Found(numbers, family.shape(numbers), float(at.stress.max()), bench.tried - begun, room)


def _judged(bench: FilletBench, family: Family, numbers: Array) -> Judged | None:
    try:
        return bench.judged(bench.tooth(family.shape(numbers)))
    except GeometryError:
        return None


def _merit(one: Judged, present: float) -> float:
    each = one.each / present
    lesser = _EACH * float(each.sum()) if each.size > 1 else 0.0
    return float(each.max()) + lesser + _BROKEN * max(0.0, -float(one.room.min()))


def _slopes(bench: FilletBench, family: Family, numbers: Array, at: Judged) -> tuple[Array, Array]:
    """Change of stress and room by each number, over its spread."""
    stress, room = [], []
    for n in range(numbers.size):
        found, step = None, 0.0
        for step in (_SLOPE, -_SLOPE, 0.1 * _SLOPE, -0.1 * _SLOPE):
            off = numbers.copy()
            off[n] += step * family.spread[n]
            if not family.lower[n] <= off[n] <= family.upper[n]:
                continue
            if (found := _judged(bench, family, off)) is not None:
                break
        stress.append(np.zeros(at.stress.size) if found is None else (found.stress - at.stress) / step)
        room.append(np.zeros(at.room.size) if found is None else (found.room - at.room) / step)
    return np.array(stress).T, np.array(room).T


def _programme(
    at: Judged, slopes: tuple[Array, Array], present: float, numbers: Array, family: Family, trust: float
) -> tuple[Array, float]:
    """Step of the spread that the slopes say is best, and the merit that it promises to gain."""
    from scipy.optimize import linprog

    n, fillets, spread = numbers.size, at.each.size, family.spread
    # unknowns: step, largest stress of each fillet over the present one, that of both, largest broken limit
    both = int(fillets > 1)
    of_each = np.repeat(np.eye(fillets), at.stress.size // fillets, axis=0)
    stress = np.hstack([slopes[0] / present, -of_each, np.zeros((at.stress.size, both + 1))])
    room = np.hstack([-slopes[1], np.zeros((at.room.size, fillets + both)), -np.ones((at.room.size, 1))])
    rows, limits = [stress, room], [-at.stress / present, at.room]
    cost = [_EACH if both else 1.0] * fillets + [1.0] * both + [_BROKEN]
    if both:
        rows.append(
            np.hstack([np.zeros((fillets, n)), np.eye(fillets), -np.ones((fillets, 1)), np.zeros((fillets, 1))])
        )
        limits.append(np.zeros(fillets))
    low, high = ((limit - numbers) / spread for limit in (family.lower, family.upper))
    bounds = [(max(-trust, a), min(trust, b)) for a, b in zip(low.tolist(), high.tolist(), strict=True)]
    bounds += [(0.0, None)] * (fillets + both + 1)
    found = linprog(
        np.concatenate([np.zeros(n), cost]), np.vstack(rows), np.concatenate(limits), bounds=bounds, method="highs",
    )  # fmt: skip
    if found.x is None:
        return np.zeros(n), 0.0
    return np.asarray(found.x[:n]), _merit(at, present) - float(found.fun)
