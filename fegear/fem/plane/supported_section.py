"""The section of a gear as its rim's support wants it.

Where the bore is free over an arc, edges are short at its ends. A rim on a web has layers of elements from its inside
down to where the web is held. The web is thinner than the face and free along the axis: its elements are those of plane
stress, as stiff as their share of the face is. That is the web as an elastic foundation of the rim, whatever waves go
round it.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.body import with_body, zones
from fegear.fem.plane.elasticity import SectorElasticity, assemble, assemble_two_orders, lame
from fegear.fem.plane.elements import SectorElements, sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.scikit_fem_solver import assembled
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.gear_body import GearBody

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Mask
    from fegear.fem.plane.settings import MeshSettings, Solver
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_side import InvoluteSide
    from fegear.geometry.rim_support import RimSupport

#: Layers through a web at least, and by what share of its logarithm the radius falls through one: a torque's stress
#: grows with the inverse square of the radius.
_FEWEST, _FALL = 2, 0.3


#: Edges where a held and a free bore meet, as a share of those along the fillet: stress has no bound there.
_BORE_END = 0.1


def bore_end(settings: MeshSettings, support: RimSupport | None) -> float:
    """How short edges are at both ends of a sector's bore [modules]; 0 for those of the body."""
    return _BORE_END * settings.root_edge_length if support is not None and support.kind == "free_arc" else 0.0


def supported_sector(
    tooth: InvoluteSide, bore_radius: float, settings: MeshSettings, support: RimSupport | None
) -> SectorMesh:
    """Mesh the sector of a tooth down to where it is held."""
    mesh = mesh_sector(tooth, bore_radius, settings, bore_end=bore_end(settings, support))
    return section_on(mesh, settings, support)


def section_on(mesh: SectorMesh, settings: MeshSettings, support: RimSupport | None) -> SectorMesh:
    """The section of a gear whose rim and teeth are meshed: with its web, if it stands on one."""
    if support is None or support.kind != "web":
        return mesh
    rim = float(np.hypot(*mesh.points[:, mesh.edges["bore"][0, 0]]))
    fewest = max(_FEWEST, math.ceil(math.log(rim / support.inner_radius) / _FALL))
    return with_body(mesh, _body(rim, support), support.inner_radius, settings.rim_fraction, fewest)


def assemble_section(
    mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int, solver: Solver, support: RimSupport | None
) -> SectorElasticity:
    """As `assemble`, of a section that may stand on a web."""
    usual = assemble(mesh, poisson_ratio, plane, order, solver)
    if support is None or support.kind != "web":
        return usual
    if solver == "scikit-fem":
        return _in_parts(mesh, usual, sector_elements(mesh, order), poisson_ratio, plane, support)
    return _thinner(mesh, usual, assemble(mesh, poisson_ratio, "stress", order), support)


def assemble_section_two_orders(
    mesh: SectorMesh, poisson_ratio: float, plane: Plane, order: int, solver: Solver, support: RimSupport | None
) -> tuple[SectorElasticity, SectorElasticity]:
    """As `assemble_two_orders`, of a section that may stand on a web."""
    higher, lower = assemble_two_orders(mesh, poisson_ratio, plane, order, solver)
    if support is None or support.kind != "web":
        return higher, lower
    if solver == "scikit-fem":
        elements = sector_elements(mesh, order)
        return (
            _in_parts(mesh, higher, elements, poisson_ratio, plane, support),
            _in_parts(mesh, lower, elements.one_order_lower(), poisson_ratio, plane, support),
        )
    web = assemble_two_orders(mesh, poisson_ratio, "stress", order)
    return _thinner(mesh, higher, web[0], support), _thinner(mesh, lower, web[1], support)


def assemble_sections(
    meshes: Sequence[SectorMesh],
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    support: RimSupport | None,
    *,
    two_orders: bool,
) -> list[list[SectorElasticity]]:
    """Several sections by the settings' order, and by the next lower one with two orders: those of one order each."""
    order, solver = settings.order, settings.solver
    if not two_orders:
        return [[assemble_section(one, poisson_ratio, plane, order, solver, support) for one in meshes]]
    pairs = [assemble_section_two_orders(one, poisson_ratio, plane, order, solver, support) for one in meshes]
    return [list(each) for each in zip(*pairs, strict=True)]


def _thinner(mesh: SectorMesh, usual: SectorElasticity, web: SectorElasticity, support: RimSupport) -> SectorElasticity:
    inside = of_web(mesh)[:, None, None]
    return replace(usual, stiffness=np.where(inside, support.web * web.stiffness, usual.stiffness))


def _in_parts(
    mesh: SectorMesh,
    usual: SectorElasticity,
    elements: SectorElements,
    poisson_ratio: float,
    plane: Plane,
    support: RimSupport,
) -> SectorElasticity:
    """The same assembled by scikit-fem."""
    inside = of_web(mesh)
    rim = assembled(elements, *lame(poisson_ratio, plane), np.flatnonzero(~inside))
    web = assembled(elements, *lame(poisson_ratio, "stress"), np.flatnonzero(inside))
    return replace(usual, whole=rim + support.web * web)


def of_web(mesh: SectorMesh) -> Mask:
    """Which elements are the web's."""
    name = next(name for name in mesh.edges if name.partition(":")[0] == "rim_inside")
    rim = float(np.hypot(*mesh.points[:, mesh.edges[name][0, 0]]))
    return np.asarray(zones(_body(rim, None), mesh.points, mesh.triangles[:3]) > 0)


def _body(rim_radius: float, support: RimSupport | None) -> GearBody:
    """Rim and web, which here has no place along the face, as sections take them."""
    inside = 0.0 if support is None else support.inner_radius
    deep = rim_radius - inside
    return GearBody(rim_radius, inside, (0.0, deep), (0.0, deep))
