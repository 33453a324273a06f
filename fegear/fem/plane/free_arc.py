"""A gear whose bore is free below some teeth and held below the others, as one with a slot, or between two keys.

The teeth in the middle of the free arc and beside it answer differently. The loaded one is always in the middle, so
that it stands for all: c_k(p, q) is the mean of what tooth k does under a load on the middle one and the middle one
under a load on tooth -k, which keeps c_k(p, q) = c_-k(q, p).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array, Index, Mask
from fegear.fem.plane.elasticity import SectorElasticity
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.odd.odd_ring import Held, held_sectors, odd_ring
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.sector_sides import BetweenSides, between_sides, bore_of_side, condensed_sector, ports_of


@dataclass(frozen=True)
class Free:
    """An ordinary sector with its bore free, and the held ones beside.

    Parameters
    ----------
    part : BetweenSides
    held : Held
    size : int
        Number of unknowns of a sector.
    seconds : mapping of str to float
    """

    part: BetweenSides
    held: Held
    size: int
    seconds: Mapping[str, float]


def free_sector(
    mesh: SectorMesh, elasticity: SectorElasticity, ports: Index, *, expandable: bool = False
) -> BetweenSides:
    """A sector whose bore is free, condensed onto its sides and ports."""
    motions = rigid_motions(elasticity)
    sector, side, turn, _ = condensed_sector(mesh, elasticity, ports, expandable=expandable, motions=motions)
    return between_sides(sector, side, turn)


def held_sector(
    mesh: SectorMesh, elasticity: SectorElasticity, ports: Index, half: int, *, expandable: bool = False
) -> Held:
    """The same sector with its bore held; sectors -half..half of the ring are not."""
    sector, side, turn, _ = condensed_sector(mesh, elasticity, ports, expandable=expandable)
    bore: Mask = bore_of_side(mesh, elasticity)
    return held_sectors(half, bore, between_sides(sector, side, turn))


def free_arc(mesh: SectorMesh, elasticity: SectorElasticity, ports: Index, teeth: int) -> Free:
    """Condense an ordinary sector with its bore free and with it held.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    ports : ndarray of int
        Unknowns that will be loaded or watched, none on the bore.
    teeth : int
        Above the free arc.
    """
    started = time.perf_counter()
    part, held = free_sector(mesh, elasticity, ports), held_sector(mesh, elasticity, ports, teeth // 2)
    return Free(part, held, part.sector.size, {"condensation": time.perf_counter() - started})


def free_arc_response(
    mesh: SectorMesh, elasticity: SectorElasticity, teeth: int, watch: Index, loaded: int, reach: int
) -> tuple[dict[int, Array], Free]:
    """Displacements of watched unknowns on sectors -reach..reach under forces on the first of them on sector 0.

    Parameters
    ----------
    mesh : SectorMesh
    elasticity : SectorElasticity
    teeth : int
        Above the free arc, sector 0 in the middle.
    watch : ndarray of int, shape (q,)
    loaded : int
        How many of them are loaded, the first ones.
    reach : int

    Returns
    -------
    response : dict of int to ndarray, shape (q, loaded)
    ring : Free
        With the seconds of closing it.
    """
    sector = free_arc(mesh, elasticity, np.unique(watch), teeth)
    started = time.perf_counter()
    ring = odd_ring(sector.part.held, {}, mesh.teeth, reach, sector.held)
    kinds = [sector.held.part if sector.held.of(k) else sector.part for k in range(-reach, reach + 1)]
    rows = [ports_of(part.sector, watch) for part in kinds]
    follow = [np.hstack([p.follow_a, p.follow_b])[r] for p, r in zip(kinds, rows, strict=True)]
    middle = follow[reach][:loaded]
    found = {k: follow[k + reach] @ ring.between(k, 0) @ middle.T for k in range(-reach, reach + 1)}
    # The other way round: the middle tooth watched under loads on the flanks of the others.
    back = {k: middle @ ring.between(0, -k) @ follow[reach - k][:loaded].T for k in range(-reach, reach + 1)}
    found[0] += kinds[reach].own[np.ix_(rows[reach], rows[reach][:loaded])]
    for k, moved in found.items():
        if k:
            moved[:loaded] = 0.5 * (moved[:loaded] + back[k])
    seconds = {**sector.seconds, "ring": time.perf_counter() - started}
    return found, Free(sector.part, sector.held, sector.size, seconds)
