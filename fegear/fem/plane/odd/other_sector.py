"""Mesh the sector of a tooth of another outline: its sides are those of the ordinary sector."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.edge_sizes import front_sizes, graded
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.supported_section import bore_end, section_on, supported_sector
from fegear.fem.plane.tooth_meshing import mesh_inside

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.odd.other_outline import OtherTip
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport

#: Parts of the outline of a sector that a missing tooth leaves.
_LEFT = ("bore", "side_b", "root_land", "side_a")


def shorter_sector(
    ordinary: InvoluteTooth,
    bore_radius: float,
    settings: MeshSettings,
    one: OtherTip,
    support: RimSupport | None = None,
) -> tuple[InvoluteTooth, SectorMesh]:
    """A tooth with another tip circle, and the mesh of its sector; lengths in modules."""
    tooth = one.tooth(ordinary)
    return tooth, supported_sector(tooth, bore_radius, settings, support)


def empty_sector(
    ordinary: InvoluteTooth, bore_radius: float, settings: MeshSettings, support: RimSupport | None = None
) -> SectorMesh:
    """Mesh of a sector that ends at the root circle; lengths in modules."""
    started = time.perf_counter()
    outline = sector_boundary(ordinary, bore_radius, settings, bore_end=bore_end(settings, support))
    chains = [chain for chain in outline if chain.name in _LEFT]
    place = next(i for i, chain in enumerate(chains) if chain.name == "side_b") + 1
    place += chains[place].name == "root_land"
    start, end = chains[place - 1].vertices[:, -1], chains[place].vertices[:, 0]
    fillet = front_sizes(ordinary, settings)["fillet"]
    first, longest = float(fillet(np.zeros(1))[0]), settings.back_edge_length
    length = 2.0 * ordinary.root_radius * math.atan2(abs(start[0]), start[1])

    def size(s: Array) -> Array:
        return np.minimum(first + settings.growth * np.minimum(s, length - s), longest)

    chains.insert(place, _arc(start, end, graded(length, size, fewest=2) / length))
    mesh = mesh_inside(chains, ordinary.teeth, started, settings.side_growth)
    if settings.order > 2:
        check_cubic_edges(mesh)
    return section_on(mesh, settings, support)


def _arc(start: Array, end: Array, shares: Array) -> Chain:
    """Edges along the root circle between two points of it, at shares of the way."""
    radius, first, last = float(np.hypot(*start)), math.atan2(start[0], start[1]), math.atan2(end[0], end[1])
    angle = first + (last - first) * np.sort(np.concatenate([shares, 0.5 * (shares[1:] + shares[:-1])]))
    points = radius * np.stack([np.sin(angle), np.cos(angle)])
    points[:, 0], points[:, -1] = start, end
    turn = math.copysign(1.0, last - first)
    tangents = turn * np.stack([np.cos(angle), -np.sin(angle)])[:, ::2]
    return Chain("root_land", points[:, ::2], points[:, 1::2], tangents)
