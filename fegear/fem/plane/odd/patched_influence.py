"""Solve a gear of which several sectors are meshed as one, between the ordinary ones; E = 1, lengths in modules."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.odd.odd_influence import OddInfluence, solved_already
from fegear.fem.plane.odd.odd_ring import patched_ring
from fegear.fem.plane.odd.patch_kinds import patch_kinds
from fegear.fem.plane.odd.tooth_kind import OddTooth, tooth_kind
from fegear.fem.plane.supported_section import assemble_sections

if TYPE_CHECKING:
    from fegear.fem.plane.influence import Influence
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth


@tallied("tooth shapes")
@tallied("odd sectors")
def solve_patched_influence(
    tooth: InvoluteTooth,
    mesh: SectorMesh,
    patch: SectorMesh,
    half: int,
    poisson_ratio: float,
    plane: Plane,
    settings: MeshSettings,
    *,
    reach: int,
    two_orders: bool = False,
    known: Influence | None = None,
) -> OddInfluence:
    """Solve one ring whose sectors -half..half are meshed as one, on a bore that is held.

    Parameters
    ----------
    tooth, mesh, poisson_ratio, plane, settings, reach, two_orders, known
        As of `solve_odd_influence`.
    patch : SectorMesh
        Its ends as the ordinary sector's sides.
    half : int

    Raises
    ------
    InputError
        If its ends are not the ordinary sector's sides, or there are too few teeth.
    FegearError
        If a stiffness is not positive definite.
    """
    solved = solved_already(known, two_orders)
    with one_thread():
        meshes = [patch] if solved else [patch, mesh]
        orders = assemble_sections(meshes, poisson_ratio, plane, settings, None, two_orders=two_orders)
        found = []
        for n, elasticity in enumerate(orders):
            started = time.perf_counter()
            if solved:
                usual, between = solved[n]
            else:
                usual, part = tooth_kind(OddTooth(tooth, mesh), elasticity[1], poisson_ratio, plane)
                between = part.held
            kinds, coupled, held = patch_kinds(tooth, patch, elasticity[0], half, poisson_ratio, plane)
            condensed = time.perf_counter()
            ring = patched_ring(between, held, half, tooth.teeth, reach)
            seconds = {
                "mesh": mesh.seconds + patch.seconds,
                "condensation": condensed - started,
                "ring": time.perf_counter() - condensed,
            }
            distance = settings.corner_distance
            found.append(OddInfluence(poisson_ratio, plane, distance, usual, kinds, ring, seconds, patch=coupled))
    return replace(found[0], lower=found[1]) if two_orders else found[0]
