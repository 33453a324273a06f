"""Building an atlas: the gears at the nodes of its regions are solved, one after the other, and each is kept.

Where the cache has a disk, building that was stopped goes on where it was: what is solved already is recalled.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

import fegear
from fegear.atlas.atlas import Atlas, Piece, compressed
from fegear.atlas.tables import Layout, errors_of, row_of
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.atlas.domain import Domain
    from fegear.atlas.family import Family
    from fegear.base.arrays import Array
    from fegear.geometry.gear import Gear


class Region(NamedTuple):
    """A region and how many gears are solved along each number: teeth, profile shift, tip height, bore."""

    domain: Domain
    counts: tuple[int, int, int, int]


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
    regions: Sequence[Region],
    settings: MeshSettings | None = None,
    *,
    reach: int = 1,
    cache: SolutionCache | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Atlas:
    """Solve the gears of an atlas.

    Parameters
    ----------
    family : Family
    regions : sequence of Region
        Best without overlap: of several that hold a gear the first answers.
    settings : MeshSettings, optional
    reach : int
        K: neighbours -K..K.
    cache : SolutionCache, optional
        Where rows of solved gears are recalled from and kept.
    progress : callable, optional
        Called with how many gears are solved, of how many, after each.

    Raises
    ------
    InputError
        If a region crosses the undercut line.
    GeometryError
        If there is no gear at a node of a region.
    """
    settings, cache = settings or MeshSettings(), cache or SolutionCache()
    grids = []
    for domain, counts in regions:
        domain.check(family)
        grids.append(domain.nodes(counts))
    gears = [
        [family.gear(place) for place in nodes.places(region.domain, family)]
        for region, nodes in zip(regions, grids, strict=True)
    ]
    total, done, found = sum(map(len, gears)), 0, []
    for some in gears:
        rows = []
        for gear in some:
            rows.append(cache.call_kept(_CODEC, solved, gear, settings, reach).value)
            done += 1
            if progress is not None:
                progress(done, total)
        found.append(rows)
    parts, basis = compressed(np.array([one["row"] for rows in found for one in rows]), Layout(reach))
    pieces, first = [], 0
    for region, nodes, rows in zip(regions, grids, found, strict=True):
        errors = np.array([one["errors"] for one in rows]).reshape(*nodes.shape, -1)
        mine = parts[first : first + len(rows)].reshape(*nodes.shape, -1)
        pieces.append(Piece(region.domain, nodes, mine, errors))
        first += len(rows)
    return Atlas(family, tuple(pieces), basis, reach, settings, fegear.__version__)
