"""Building an atlas: gears of its regions are solved, one after the other, until polynomials through them are as good.

Where the cache has a disk, building that was stopped goes on where it was: what is solved already is recalled.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import fegear
from fegear.atlas.atlas import Atlas, Piece
from fegear.atlas.common_rows import common_rows
from fegear.atlas.polynomials import chosen, degrees_within, fitted, next_degrees, products
from fegear.atlas.tables import Layout, errors_of, row_of
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.atlas.domain import Domain
    from fegear.atlas.family import Family, Place
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear

    Degrees = tuple[int, int, int, int]
    Progress = Callable[[int, int], None]

#: Level of the meshes: finer ones scatter no less.
LEVEL = -1.0
#: Degrees along teeth, profile shift, tip height and bore that a region begins with, and never exceeds.
_FIRST, _HIGHEST = (3, 3, 2, 3), (10, 11, 6, 9)
#: How many products there are in a round for each of the round before.
_GROWTH = 1.35
#: Solved gears over products of a fit, and how many more.
_MORE, _AND = 1.4, 4
#: Gears that may be solved in a region.
_CANDIDATES = 4000
#: Share of the gears whose error must be below the tolerance.
_SHARE = 0.9


class Budget(NamedTuple):
    """What building may cost: a relative tolerance, and how many gears of a region are solved at most."""

    tolerance: float = 2e-4
    gears: int = 400


def solved(gear: Gear, settings: MeshSettings, reach: int) -> dict[str, Array]:
    """Row of a gear of pure numbers, and the estimated errors."""
    known = solve_gear(gear, settings, reach=reach)
    return {"row": row_of(known), "errors": errors_of(known)}


def _read(data: bytes | memoryview) -> dict[str, Array] | None:
    try:
        known = unpack(data)
    except (ValueError, KeyError, TypeError):
        return None
    return known if isinstance(known, dict) and {"row", "errors"} <= known.keys() else None


_CODEC: Codec[dict[str, Array]] = Codec(pack, _read)


def build_atlas(
    family: Family,
    domains: Sequence[Domain],
    settings: MeshSettings | None = None,
    *,
    budget: Budget | None = None,
    reach: int = 1,
    cache: SolutionCache | None = None,
    progress: Progress | None = None,
) -> Atlas:
    """Solve the gears of an atlas.

    Parameters
    ----------
    family : Family
    domains : sequence of Domain
        Best without overlap: of several that hold a gear the first answers.
    settings : MeshSettings, optional
    budget : Budget, optional
    reach : int
        K: neighbours -K..K.
    cache : SolutionCache, optional
        Where rows of solved gears are recalled from and kept.
    progress : callable, optional
        Called after each gear with how many are solved, and how many will be as far as is known.

    Raises
    ------
    InputError
        If a region crosses the undercut line.
    GeometryError
        If there is no gear at a place of a region.
    """
    settings, cache, budget = settings or settings_at(LEVEL), cache or SolutionCache(), budget or Budget()
    regions: list[_Region] = []
    for domain in domains:
        domain.check(family)
        regions.append(_Region(family, domain, settings, reach, cache))
    for number, region in enumerate(regions):
        before, after = sum(one.count for one in regions[:number]), len(regions) - number - 1
        region.grow(budget, lambda done, wanted, before=before, after=after: progress and progress(  # type: ignore[misc]
            before + done, before + wanted + after * wanted))  # fmt: skip
    common = common_rows(np.concatenate([one.rows for one in regions]), Layout(reach))
    pieces = tuple(one.piece(common.parts, common.rows) for one in regions)
    return Atlas(family, pieces, common, reach, settings, budget.tolerance, fegear.__version__)


class _Region:
    """A region while its gears are solved."""

    def __init__(
        self, family: Family, domain: Domain, settings: MeshSettings, reach: int, cache: SolutionCache
    ) -> None:
        self._family, self._domain, self._settings, self._cache = family, domain, settings, cache
        self._reach, self._layout = reach, Layout(reach)
        self._left = domain.candidates(family, _CANDIDATES)
        self._places: list[Place] = []
        self._rows: list[Array] = []
        self._errors: list[Array] = []
        self._degrees = degrees_within(self._only_varying(_FIRST))

    def _only_varying(self, degrees: Degrees) -> Degrees:
        first, second, third, fourth = (d if v else 0 for d, v in zip(degrees, self._domain.varies, strict=True))
        teeth = self._domain.teeth
        return min(first, teeth[1] - teeth[0]), second, third, fourth

    @property
    def count(self) -> int:
        """How many are solved."""
        return len(self._places)

    @property
    def rows(self) -> Array:
        """Of the solved gears, without what the body turns by, (N, numbers)."""
        found = np.array(self._rows)
        self._layout.turned(found, -self._family.turning(_array(self._places)))
        return found

    def grow(self, budget: Budget, progress: Progress) -> None:
        """Take more products until the fit without a gear misses it by the tolerance at most, or all are solved."""
        counts = [0, 1, *(self._layout.quantities.index(one) for one in ("tension 0", "compression 0"))]
        degrees = self._degrees
        while True:
            wanted = math.ceil(_MORE * degrees.shape[0]) + _AND
            if self.count and wanted > min(budget.gears, self.count + len(self._left)):
                return
            self._solve(degrees, wanted, progress)
            self._degrees = degrees
            coefficients, off = fitted(self.rows, products(degrees, self._at))
            missed = self._missed(off)[:, counts].max(axis=1)
            if np.quantile(missed, _SHARE) <= budget.tolerance:
                return
            row = np.array(self._rows).mean(axis=0)
            sizes = np.array([self._layout.differences(row, one)[counts].max() for one in coefficients])
            degrees = next_degrees(degrees, sizes, self._only_varying(_HIGHEST), _GROWTH)
            if degrees.shape[0] == self._degrees.shape[0]:
                return

    @property
    def _at(self) -> Array:
        return self._domain.coordinates(self._family, _array(self._places))

    def _solve(self, degrees: Index, wanted: int, progress: Progress) -> None:
        known = products(degrees, self._at) if self.count else np.zeros((0, degrees.shape[0]))
        others = products(degrees, self._domain.coordinates(self._family, _array(self._left)))
        taken = chosen(known, others, wanted - self.count)
        for number in taken:
            place = self._left[number]
            gear = self._family.gear(place)
            found = self._cache.call_kept(_CODEC, solved, gear, self._settings, self._reach).value
            self._places.append(place)
            self._rows.append(found["row"])
            self._errors.append(found["errors"])
            progress(self.count, wanted)
        gone = set(taken)
        self._left = [place for number, place in enumerate(self._left) if number not in gone]

    def _missed(self, off: Array) -> Array:
        """Differences of rows in the proportions in which errors are stated, (N, quantities)."""
        return np.array([self._layout.differences(row, one) for row, one in zip(self._rows, off, strict=True)])

    def piece(self, parts_of: Callable[[Array], Array], common: Array) -> Piece:
        """What an atlas keeps of it."""
        degrees, at = self._degrees, self._at
        coefficients, off = fitted(parts_of(self.rows), products(degrees, at))
        errors = self._missed(off @ common) + np.array(self._errors)
        rounded = coefficients.astype(np.float32).astype(float)
        return Piece(self._domain, degrees, rounded, at.astype(np.float32).astype(float),
                     errors.astype(np.float32).astype(float))  # fmt: skip


def _array(places: Sequence[Place]) -> Array:
    return np.array(places, dtype=float).T
