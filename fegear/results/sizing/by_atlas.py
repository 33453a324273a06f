"""Transmission error of all variants by the atlas, in parts: any process computes them, and they are kept at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import FegearError
from fegear.design.sizing.by_atlas import (
    AtlasDuty,
    Bare,
    Relieved,
    bare_errors,
    of_an_atlas,
    relieved_errors,
    sliced_errors_of,
)

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.design.sizing.space import SizingSpace
    from fegear.engine.progress import Progress
    from fegear.engine.stage import Work
    from fegear.geometry.many_pairs import ManyGearPairs

#: Variants of one part, and of one for which reliefs are searched: half a second.
_PART, _RELIEVED = 1000, 50


@dataclass(frozen=True)
class AtlasPart:
    """Some variants to be looked up.

    Parameters
    ----------
    pairs : ManyGearPairs
    duty : AtlasDuty
    made_from : str
        Digest of the atlases.
    """

    pairs: ManyGearPairs
    duty: AtlasDuty
    made_from: str


def bare_part(part: AtlasPart) -> dict[str, Any]:
    """As `bare_errors`, plain arrays."""
    return bare_errors(part.pairs, part.duty)._asdict()


def relieved_part(part: AtlasPart) -> dict[str, Any]:
    """As `relieved_errors`, plain arrays."""
    return relieved_errors(part.pairs, part.duty)._asdict()


def sliced_part(part: AtlasPart) -> dict[str, Any]:
    """As `sliced_errors_of`, plain arrays."""
    return {"te": sliced_errors_of(part.pairs, part.duty)}


def bare_of(space: SizingSpace, numbers: Index, duty: AtlasDuty, work: Work, progress: Progress) -> Bare:
    """Transmission error of unmodified variants by number; NaN where no atlas contains them."""
    pairs = space.pairs(numbers)
    known = [rows for _, rows in of_an_atlas(pairs, duty.poisson_ratio)]
    rows = np.sort(np.concatenate(known)) if known else np.zeros(0, dtype=np.int64)
    found = _mapped(bare_part, pairs.at(rows), duty, work, _PART, progress)
    bare = Bare.unknown(numbers.size)
    for name, values in bare._asdict().items():
        if found:
            values[rows] = np.concatenate([one[name] for one in found])
    return bare


def sliced_of(space: SizingSpace, numbers: Index, duty: AtlasDuty, work: Work, progress: Progress) -> Array:
    """Transmission error of helical variants by thin slices; NaN of others."""
    pairs, te = space.pairs(numbers), np.full(numbers.size, np.nan)
    known = [rows for _, rows in of_an_atlas(pairs, duty.poisson_ratio, helical=True)]
    rows = np.sort(np.concatenate(known)) if known else np.zeros(0, dtype=np.int64)
    if rows.size:
        found = _mapped(sliced_part, pairs.at(rows), duty, work, _PART, progress)
        te[rows] = np.concatenate([one["te"] for one in found])
    return te


def relieved_of(space: SizingSpace, numbers: Index, duty: AtlasDuty, work: Work, progress: Progress) -> Relieved:
    """The same with the best relief."""
    found = _mapped(relieved_part, space.pairs(numbers), duty, work, _RELIEVED, progress)
    if not found:
        none = np.zeros(0)
        return Relieved(none, none, none.astype(np.int64), np.zeros((2, 0)), none.astype(bool))
    return Relieved._make(np.concatenate([one[name] for one in found], axis=-1) for name in Relieved._fields)


def _mapped(
    function: Any, pairs: ManyGearPairs, duty: AtlasDuty, work: Work, size: int, progress: Progress
) -> tuple[dict[str, Any], ...]:
    from fegear.atlas.shipped import fingerprint
    from fegear.engine.executor import Executor, map_points
    from fegear.engine.processes import Failure

    digest = fingerprint()
    points = [AtlasPart(pairs.at(slice(a, a + size)), duty, digest) for a in range(0, len(pairs), size)]
    executor = work.executor if len(points) > 1 else Executor(here=True)  # one part is not worth a process
    found = map_points(function, points, executor, work.cache, progress=progress)
    for one in found:
        if isinstance(one, Failure):
            raise FegearError(f"{one.kind}: {one.reason}")
    return found
