"""Several sectors meshed as one, with a crack that may leave the sector of its tooth; and the rest of the ring.

The patch is as a sector of several pitches: what it is made of inside, the rest of the ring sees its two ends alone,
and is the same for every crack in it.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.chain import chain_of
from fegear.fem.plane.free_arc import free_arc
from fegear.fem.plane.odd.cracked_sector import CrackedSector, crack_in
from fegear.fem.plane.ring_closure import closed_stiffness
from fegear.fem.plane.sector_sides import between_sides, condensed_sector
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.supported_section import (
    assemble_section,
    assemble_section_two_orders,
    bore_end,
    section_on,
    supported_sector,
)
from fegear.geometry.outline import turned

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array, Mask
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.odd.crack import Crack
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport

#: Level of the outlines of teeth that have no crack.
_BESIDE = -5.0
#: Rims thinner than so many tooth depths take two sectors on either side of the cracked one, others one.
_THIN, _FEW, _MORE = 1.5, 1, 2


@dataclass(frozen=True)
class Rest:
    """A ring without the patch: stiffness between its ends.

    Parameters
    ----------
    half : int
        Sectors of the patch on either side of the cracked one.
    stiffness : ndarray, shape (2 m, 2 m)
        Between side A and side B of the patch.
    moves : ndarray of bool, shape (2 m,)
        Unknowns of these sides that are not held.
    lower : Rest, optional
        The same with elements one order lower.
    """

    half: int
    stiffness: Array
    moves: Mask
    lower: Rest | None = None


def sectors_beside(tooth: InvoluteTooth, bore_radius: float, support: RimSupport | None) -> int:
    """How many sectors on either side of the cracked one the patch takes: all held, or all free."""
    backup = (tooth.root_radius - bore_radius) / (tooth.tip_radius - tooth.root_radius)
    wanted = min(_MORE if backup < _THIN else _FEW, (tooth.teeth - 2) // 2)
    if support is not None and support.kind == "free_arc":
        return min(wanted, support.free_teeth // 2)
    return wanted


def rest_of_ring(
    tooth: InvoluteTooth,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    support: RimSupport | None,
    *,
    two_orders: bool = False,
) -> Rest:
    """Condense all sectors but those of the patch, on request with elements one order lower too; lengths in modules."""
    half = sectors_beside(tooth, bore_radius, support)
    mesh = supported_sector(tooth, bore_radius, settings, support)
    asked = mesh, poisson_ratio, plane, settings.order, settings.solver, support
    if not two_orders:
        return _rest(mesh, assemble_section(*asked), tooth, half, support)
    fine, lower = (_rest(mesh, each, tooth, half, support) for each in assemble_section_two_orders(*asked))
    return replace(fine, lower=lower)


def _rest(
    mesh: SectorMesh, elasticity: SectorElasticity, tooth: InvoluteTooth, half: int, support: RimSupport | None
) -> Rest:
    none = np.zeros(0, dtype=np.intp)
    others = tooth.teeth - 2 * half - 1
    if support is None or support.kind != "free_arc":
        sector, side, turn, _ = condensed_sector(mesh, elasticity, none)
        row = chain_of(between_sides(sector, side, turn).held, others)
        assert row is not None  # noqa: S101  (for mypy: there are other teeth)
        return Rest(half, _from_b_to_a(row, side), np.ones(2 * side, dtype=bool))
    arc = free_arc(mesh, elasticity, none, support.free_teeth)
    beside = support.free_teeth // 2 - half
    held, free, m = arc.held.chain(others - 2 * beside), chain_of(arc.part.held, beside), arc.held.free.size
    if not beside:
        assert held is not None  # noqa: S101  (for mypy: there are other teeth)
        return Rest(half, _from_b_to_a(held, m), np.tile(arc.held.free, 2))
    chains = [(free, 0, 1), (held, 1, 2), (free, 2, 3)]
    whole = closed_stiffness(chains, 4, m).reshape(4 * m, -1)
    inner, ends = np.r_[m : 3 * m][np.tile(arc.held.free, 2)], np.r_[0:m, 3 * m : 4 * m]
    border = whole[np.ix_(inner, ends)]
    row = whole[np.ix_(ends, ends)] - border.T @ np.linalg.solve(whole[np.ix_(inner, inner)], border)
    return Rest(half, _from_b_to_a(row, m), np.ones(2 * m, dtype=bool))


def _from_b_to_a(row: Array, m: int) -> Array:
    """A chain that begins at side B of the patch and ends at its side A, between sides A and B."""
    swapped = np.r_[m : 2 * m, 0:m]
    return np.asarray(row[np.ix_(swapped, swapped)])


def cracked_patch(
    tooth: InvoluteTooth,
    bore_radius: float,
    settings: MeshSettings,
    crack: Crack,
    half: int,
    support: RimSupport | None = None,
) -> CrackedSector:
    """Mesh the sectors -half..half as one, the crack in tooth 0; lengths in modules.

    Raises
    ------
    InputError
        If the crack leaves them, crosses itself or comes too near a surface.
    FegearError
        If gmsh fails, or no finer mesh along the crack is sound.
    """
    started = time.perf_counter()
    found = crack_in(patch_boundary(tooth, bore_radius, settings, half, support), tooth, settings, crack, started)
    return replace(found, mesh=section_on(found.mesh, settings, support))


def patch_boundary(
    tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, half: int, support: RimSupport | None
) -> list[Chain]:
    """The closed boundary of a patch, counterclockwise from its bore; outlines beside tooth 0 are coarse."""
    end, coarse = bore_end(settings, support), settings_at(_BESIDE)
    own = {k: (settings if k == 0 else coarse) for k in range(-half, half + 1)}
    kinds = {id(one): sector_boundary(tooth, bore_radius, one, bore_end=end) for one in own.values()}
    return joined_sectors({k: kinds[id(one)] for k, one in own.items()}, 2.0 * math.pi / tooth.teeth)


def joined_sectors(outlines: Mapping[int, list[Chain]], pitch: float) -> list[Chain]:
    """The closed boundary of sectors -h..h, their bores first, from the boundary of each (`sector_boundary`)."""
    half = max(outlines)
    sides = {chain.name: chain for chain in outlines[0] if chain.name in ("side_a", "side_b")}
    chains = [_turned(outlines[k][0], k * pitch) for k in range(-half, half + 1)]
    chains.append(_turned(sides["side_b"], half * pitch))
    for k in range(half, -half - 1, -1):
        for chain in outlines[k][1:]:
            if chain.name not in sides:
                name = chain.name if k == 0 else f"{chain.name}@{k}"
                chains.append(replace(_turned(chain, k * pitch), name=name))
    chains.append(_turned(sides["side_a"], -half * pitch))
    following = [*chains[1:], chains[0]]
    return [_ending_at(one, after.vertices[:, 0]) for one, after in zip(chains, following, strict=True)]


def _turned(chain: Chain, angle: float) -> Chain:
    return Chain(chain.name, *(turned(part, angle) for part in (chain.vertices, chain.middles, chain.tangents)))


def _ending_at(chain: Chain, point: Array) -> Chain:
    """Consecutive chains share their end points exactly."""
    vertices = chain.vertices.copy()
    vertices[:, -1] = point
    return replace(chain, vertices=vertices)
