"""One ring solved for all that can be asked of its teeth: assembled, closed, and read off as influence functions."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.free_arc import free_arc_response
from fegear.fem.plane.influence import Influence, Side
from fegear.fem.plane.rim import PinForces, supported_response
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.root_stress import FilletStrain, fillet_strain
from fegear.fem.plane.sector_rows import SectorRows, sector_rows, stress_modulus
from fegear.fem.plane.supported_section import assemble_section, assemble_section_two_orders
from fegear.fem.plane.trace import loaded_flank

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.free_arc import Free
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.ring_closure import Ring
    from fegear.fem.plane.settings import Solver
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_side import InvoluteSide
    from fegear.geometry.rim_support import RimSupport


@tallied("tooth shapes")
def solve_influence(
    tooth: InvoluteSide,
    mesh: SectorMesh,
    poisson_ratio: float,
    plane: Plane,
    *,
    order: int = 2,
    reach: int = 1,
    corner_distance: float = 0.006,
    margin: float = 0.15,
    sector_teeth: int = 0,
    two_orders: bool = False,
    support: RimSupport | None = None,
    solver: Solver = "condensed",
) -> Influence:
    """Solve one ring for all that can be asked of its teeth.

    Parameters
    ----------
    tooth : InvoluteSide
    mesh : SectorMesh
    poisson_ratio : float
    plane : {"strain", "stress"}
    order : {2, 3, 4}
    reach : int
        K: neighbours -K..K; at most (z - 1) // 2.
    corner_distance : float
        Nearer than this to a corner of the flank the exact wedge gives c_0; the narrowest pressure that loads the
        mesh [modules].
    margin : float
        How far below the flank a patch may reach into the fillet [modules].
    sector_teeth : int
        Solve a sector of so many teeth with free sides, loaded in the middle, instead of the ring; the reach is then
        at most (sector_teeth - 1) // 2.
    two_orders : bool
        Whether to solve with elements one order lower as well (`Influence.lower`), which takes .4 of the time again.
    support : RimSupport, optional
        Of the rim [modules]; by default the whole bore, or outer circle of a ring gear, is held.
    solver : {"condensed", "scikit-fem"}
        What assembles a sector and eliminates its inner unknowns.

    Returns
    -------
    Influence
    """
    what = _Asked(tooth, mesh, poisson_ratio, plane, reach, corner_distance, margin, sector_teeth, support)
    with one_thread():
        started = time.perf_counter()
        if not two_orders:
            return _solve(what, assemble_section(mesh, poisson_ratio, plane, order, solver, support), started)
        elasticity, lower = assemble_section_two_orders(mesh, poisson_ratio, plane, order, solver, support)
        return replace(_solve(what, elasticity, started), lower=_solve(what, lower, time.perf_counter()))


class _Asked(NamedTuple):
    """What a ring is solved for, whatever its elements; as of `solve_influence`."""

    tooth: InvoluteSide
    mesh: SectorMesh
    poisson_ratio: float
    plane: Plane
    reach: int
    corner_distance: float
    margin: float
    sector_teeth: int
    support: RimSupport | None


def _solve(what: _Asked, elasticity: SectorElasticity, started: float) -> Influence:
    tooth, mesh, poisson_ratio, plane, reach, corner_distance, margin, sector_teeth, support = what
    reach = min(reach, ((sector_teeth or tooth.teeth) - 1) // 2)
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    fillets: dict[Side, FilletStrain] = {
        "tension": fillet_strain(mesh, elasticity, "fillet", tooth.side),
        "compression": fillet_strain(mesh, elasticity, "back_fillet", tooth.side),
    }
    assembled = time.perf_counter()
    watch = np.concatenate([flank.dofs, fillets["tension"].dofs, fillets["compression"].dofs])
    response: Mapping[int, Array]
    pins: PinForces | None = None
    rows: SectorRows | None = None
    closed = time.perf_counter()
    ring: Ring | Free
    if support is None or support.kind == "web":
        ring = close_ring(mesh, elasticity, watch, reach, sector_teeth=sector_teeth)
        closed = time.perf_counter()
        response = ring.respond(flank.dofs, watch)
        if not sector_teeth:
            rows = sector_rows(ring.part, flank, fillets, poisson_ratio, plane)
    elif support.kind == "free_arc":
        response, ring = free_arc_response(mesh, elasticity, support.free_teeth, watch, flank.dofs.size, reach)
    else:
        response, pins, ring = supported_response(mesh, elasticity, support, watch, flank.dofs.size, reach)
    n, t = flank.dofs.size, fillets["tension"].dofs.size
    modulus = stress_modulus(poisson_ratio, plane)
    compliance: dict[int, Array] = {}
    stress: dict[tuple[int, Side], Array] = {}
    for k, u in response.items():
        compliance[k] = np.ascontiguousarray(u[:n])  # as it comes back from a file, so that sums run in one order
        stress[k, "tension"] = modulus * (fillets["tension"].strain @ u[n : n + t])
        stress[k, "compression"] = modulus * (fillets["compression"].strain @ u[n + t :])
    solved = time.perf_counter()
    seconds = {"mesh": mesh.seconds, "assembly": assembled - started, **ring.seconds, "influence": solved - closed}
    return Influence(
        tooth, poisson_ratio, plane, mesh, flank, compliance, fillets, stress,
        corner_distance, reach, ring.size, seconds, pins=pins, support=support, rows=rows,
    )  # fmt: skip
