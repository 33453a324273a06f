"""Building an atlas: gears of its regions are solved, one after the other, until polynomials through them are as good.

Where the cache has a disk, building that was stopped goes on where it was: what is solved already is recalled.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import fegear
from fegear.atlas.common_rows import common_rows
from fegear.atlas.interpolation import Atlas, Piece
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
#: With what regions begin that are made like others.
_FIRST_LIKE = (2, 2, 1, 2)
#: How many products there are in a round for each of the round before.
_GROWTH = 1.35
#: Solved gears over products of a fit, and how many more.
_MORE, _AND = 1.4, 4
#: The same of those regions: with few products the scatter of meshes is what is left.
_MORE_LIKE = 1.6
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
    like: Sequence[Atlas] = (),
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
    like : sequence of Atlas
        With as many neighbours. A region that one of this very family has is taken over. Of others only what rows
        differ by is sought, which takes fewer gears: from those of the regions of the same number, for the rounding of
        the rack where there are two atlases of other families.

    Raises
    ------
    InputError
        If a region crosses the undercut line.
    GeometryError
        If there is no gear at a place of a region.
    """
    settings, cache, budget = settings or settings_at(LEVEL), cache or SolutionCache(), budget or Budget()
    regions: list[_Region] = []
    for number, domain in enumerate(domains):
        domain.check(family)
        regions.append(_Region(family, domain, settings, reach, cache, _known(like, family, domain, number)))
    for number, region in enumerate(regions):
        before, after = sum(one.count for one in regions[:number]), len(regions) - number - 1
        region.grow(budget, lambda done, wanted, before=before, after=after: progress and progress(  # type: ignore[misc]  # mypy cannot infer a lambda with a default
            before + done, before + wanted + after * wanted))  # fmt: skip
    common = common_rows(np.concatenate([rows for one in regions for rows in one.spanning]), Layout(reach))
    pieces = tuple(one.piece(common.parts, common.rows) for one in regions)
    return Atlas(family, pieces, common, reach, settings, budget.tolerance, fegear.__version__)


class _Known(NamedTuple):
    """What another atlas knows of a region, and by how much it counts."""

    atlas: Atlas
    number: int
    weight: float = 1.0

    @property
    def piece(self) -> Piece:
        """The region there."""
        return self.atlas.pieces[self.number]

    def rows(self, at: Array) -> Array:
        """Of gears with the same coordinates, without what the body turns by, (G, numbers)."""
        return np.asarray(self.piece.parts(at) @ self.atlas.common.rows)

    def same(self, family: Family, domain: Domain) -> bool:
        """Whether it is this region itself."""
        return self.atlas.family == family and self.piece.domain == domain


def _known(like: Sequence[Atlas], family: Family, domain: Domain, number: int) -> list[_Known]:
    """The same region, or else up to two that it is made like."""
    for one in like:
        if one.family == family and domain in one.domains:
            return [_Known(one, one.domains.index(domain))]
    others = [one for one in like if one.family != family and number < len(one.pieces)][-2:]
    if len(others) < 2 or others[0].family.rounding == others[1].family.rounding:
        return [_Known(one, number) for one in others[-1:]]
    first, second = (one.family.rounding for one in others)
    share = (family.rounding - first) / (second - first)
    return [_Known(others[0], number, 1.0 - share), _Known(others[1], number, share)]


class _Region:
    """A region while its gears are solved."""

    def __init__(
        self, family: Family, domain: Domain, settings: MeshSettings, reach: int, cache: SolutionCache,
        known: Sequence[_Known] = (),
    ) -> None:  # fmt: skip
        self._family, self._domain, self._settings, self._cache = family, domain, settings, cache
        self._known = known
        self._whole = bool(known) and known[0].same(family, domain)
        self._reach, self._layout = reach, Layout(reach)
        self._left = domain.candidates(family, _CANDIDATES)
        self._places: list[Place] = []
        self._rows: list[Array] = []
        self._errors: list[Array] = []
        self._degrees = degrees_within(self._only_varying(_FIRST_LIKE if known else _FIRST))

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

    @property
    def rest(self) -> Array:
        """Of the solved gears, what another atlas does not know, (N, numbers)."""
        found, at = self.rows, self._at
        for one in self._known:
            found -= one.weight * one.rows(at)
        return found

    @property
    def spanning(self) -> list[Array]:
        """Rows that the common ones have to stand for."""
        others = [one.rows(one.piece.solved) for one in self._known]
        return others if self._whole else [self.rows, *others]

    def grow(self, budget: Budget, progress: Progress) -> None:
        """Take more products until the fit without a gear misses it by the tolerance at most, or all are solved."""
        if self._whole:
            return
        counts = [0, 1, *(self._layout.quantities.index(one) for one in ("tension 0", "compression 0"))]
        degrees, tried = self._degrees, [self._degrees]
        while True:
            wanted = math.ceil((_MORE_LIKE if self._known else _MORE) * degrees.shape[0]) + _AND
            if self.count and wanted > min(budget.gears, self.count + len(self._left)):
                # what scatters gets no better by more products: the set that misses least counts
                self._degrees = min(tried, key=lambda one: float(np.quantile(self._off(one, counts), _SHARE)))
                return
            self._solve(degrees, wanted, progress)
            self._degrees = degrees
            tried.append(degrees)
            coefficients, off = fitted(self.rest, products(degrees, self._at))
            missed = self._missed(off)[:, counts].max(axis=1)
            if np.quantile(missed, _SHARE) <= budget.tolerance:
                return
            row = np.array(self._rows).mean(axis=0)
            sizes = np.array([self._layout.differences(row, one)[counts].max() for one in coefficients])
            degrees = next_degrees(degrees, sizes, self._only_varying(_HIGHEST), _GROWTH)
            if degrees.shape[0] == self._degrees.shape[0]:
                return

    def _off(self, degrees: Index, counts: list[int]) -> Array:
        """How far fits without each gear miss it, (N,)."""
        return np.asarray(self._missed(fitted(self.rest, products(degrees, self._at))[1])[:, counts].max(axis=1))

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
        if self._whole:
            known, rows = self._known[0].piece, self._known[0].atlas.common.rows
            coefficients = known.coefficients @ parts_of(rows)
            return replace(known, coefficients=coefficients.astype(np.float32).astype(float))
        degrees, at = self._degrees, self._at
        coefficients, off = fitted(parts_of(self.rest), products(degrees, at))
        errors = self._missed(off @ common) + np.array(self._errors)
        for one in self._known:
            more = one.weight * one.piece.coefficients @ parts_of(one.atlas.common.rows)
            degrees, coefficients = _sum(degrees, coefficients, one.piece.degrees, more)
        rounded = coefficients.astype(np.float32).astype(float)
        return Piece(self._domain, degrees, rounded, at.astype(np.float32).astype(float),
                     errors.astype(np.float32).astype(float))  # fmt: skip


def _sum(degrees: Index, coefficients: Array, others: Index, more: Array) -> tuple[Index, Array]:
    """Two sums of products as one."""
    every, place = np.unique(np.concatenate([degrees, others]), axis=0, return_inverse=True)
    found = np.zeros((every.shape[0], coefficients.shape[1]))
    np.add.at(found, place.ravel(), np.concatenate([coefficients, more]))
    return every, found


def _array(places: Sequence[Place]) -> Array:
    return np.array(places, dtype=float).T
