"""Compliance and coupling of an atlas's gears by more products than their stresses have.

Transmission errors want them better, a gear without root stress and estimated errors is solved in a quarter of the
time, and its compliances are few numbers. So regions grow on for these alone, from the products of the atlas: gears are
chosen and solved for all of them anew, and the errors that the atlas states stay what they are.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.atlas.finer import Finer
from fegear.atlas.polynomials import chosen, fitted, next_degrees, products
from fegear.atlas.tables import compliances_of
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import Codec, SolutionCache
from fegear.fem.plane.solution import solve_gear

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.atlas.interpolation import Atlas, Piece
    from fegear.base.arrays import Array
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear

#: Rounds, how many products there are in each for every one of the round before, and their highest degrees.
_ROUNDS, _GROWTH, _HIGHEST = 2, 1.35, (12, 13, 8, 11)
#: Solved gears over products, how many more, how many at most, and of how many they are chosen.
_MORE, _AND, _MOST, _CANDIDATES = 1.4, 4, 400, 4000


def compliances(gear: Gear, settings: MeshSettings, reach: int) -> dict[str, Array]:
    """Of a gear of pure numbers, as the first numbers of its row."""
    return {"compliances": compliances_of(solve_gear(gear, settings, reach=reach, estimate_error=False))}


def _read(data: bytes | memoryview) -> dict[str, Array] | None:
    try:
        known = unpack(data)
    except (ValueError, KeyError, TypeError):
        return None
    return known if isinstance(known, dict) and known.keys() == {"compliances"} else None


_CODEC: Codec[dict[str, Array]] = Codec(pack, _read)


def refined(
    atlas: Atlas, *, cache: SolutionCache | None = None, progress: Callable[[int, int], None] | None = None
) -> Atlas:
    """The same atlas with finer compliances.

    Parameters
    ----------
    atlas : Atlas
    cache : SolutionCache, optional
        Where solved gears are recalled from and kept.
    progress : callable, optional
        Called after each gear with how many are solved, and how many will be at most.
    """
    cache, pieces, done = cache or SolutionCache(), [], 0
    for number, piece in enumerate(atlas.pieces):
        after = (len(atlas.pieces) - number - 1) * _MOST

        def said(count: int, wanted: int, before: int = done, after: int = after) -> None:
            if progress is not None:
                progress(before + count, before + wanted + after)

        finer, count = _grown(atlas, piece, cache, said)
        done += count
        pieces.append(replace(piece, finer=finer))
    return replace(atlas, pieces=tuple(pieces))


def _grown(atlas: Atlas, piece: Piece, cache: SolutionCache, progress: Callable[[int, int], None]) -> tuple[Finer, int]:
    """Finer compliances of a region, and how many gears were solved for them."""
    family, domain = atlas.family, piece.domain
    places = domain.candidates(family, _CANDIDATES)
    every = np.array(places, dtype=float).T
    at, turning = domain.coordinates(family, every), family.turning(every)
    highest = [limit if varies else 0 for limit, varies in zip(_HIGHEST, domain.varies, strict=True)]
    highest[0] = min(highest[0], domain.teeth[1] - domain.teeth[0])
    degrees = piece.degrees
    coefficients = piece.coefficients @ atlas.common.rows[:, : atlas.layout.compliances]
    taken: list[int] = []
    rows: list[Array] = []
    for _ in range(_ROUNDS):
        more = next_degrees(degrees, np.abs(coefficients).max(axis=1), tuple(highest), _GROWTH)
        wanted = math.ceil(_MORE * more.shape[0]) + _AND
        if more.shape[0] == degrees.shape[0] or wanted > min(_MOST, len(places)):
            break
        degrees = more
        left = np.setdiff1d(np.arange(len(places)), taken)
        known, others = (products(degrees, at[:, which]) for which in (np.array(taken, dtype=int), left))
        for number in left[chosen(known, others, wanted - len(taken))]:
            gear = family.gear(places[number])
            found = cache.call_kept(_CODEC, compliances, gear, atlas.settings, atlas.reach).value["compliances"]
            one = found[None].copy()
            atlas.layout.turned(one, -turning[number : number + 1])
            rows.append(one[0])
            taken.append(int(number))
            progress(len(taken), wanted)
        coefficients = fitted(np.array(rows), products(degrees, at[:, taken]))[0]
    return Finer(degrees, coefficients), len(taken)
