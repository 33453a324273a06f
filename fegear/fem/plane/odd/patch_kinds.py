"""Teeth of several sectors that are meshed as one: each as a kind of sector, and what loads on one do to the others.

The ring sees the two ends of the patch only. Every tooth has its own frame; what of the patch moves with its ends held
couples the teeth of it beside the ring.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.plane.influence import SIDES, Side
from fegear.fem.plane.odd.tooth_kind import FILLETS, MARGIN, ToothKind
from fegear.fem.plane.root_stress import fillet_strain
from fegear.fem.plane.sector_rows import stress_modulus
from fegear.fem.plane.sector_sides import between_sides, condensed_sector, ports_of
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.outline import turned

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.sector_sides import BetweenSides
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth


@dataclass(frozen=True)
class Patch:
    """Sectors -half..half meshed as one.

    Parameters
    ----------
    half : int
    flank : mapping of (int, int) to ndarray, shape (2 n_i, 2 n_j)
        Motion of the loaded run of tooth i under forces on that of another tooth j, the ends of the patch held.
    stress : mapping of (int, int, side) to ndarray, shape (points, 2 n_j)
        Tangential stress of the fillets of tooth i likewise.
    """

    half: int
    flank: Mapping[tuple[int, int], Array]
    stress: Mapping[tuple[int, int, Side], Array]


def patch_kinds(
    tooth: InvoluteTooth,
    mesh: SectorMesh,
    elasticity: SectorElasticity,
    half: int,
    poisson_ratio: float,
    plane: Plane,
) -> tuple[dict[int, ToothKind], Patch, Array]:
    """Condense a patch, and gather what of its teeth is loaded and looked at; its stiffness between its ends."""
    numbers = range(-half, half + 1)
    views = {k: _in_frame(mesh, elasticity, k) for k in numbers}
    flanks = {k: loaded_flank(*views[k], tooth, MARGIN) for k in numbers}
    fillets = {k: {side: fillet_strain(*views[k], name, tooth.side) for side, name in FILLETS.items()} for k in numbers}
    ports = np.unique(np.concatenate(
        [dofs for k in numbers for dofs in (flanks[k].dofs, *(fillets[k][side].dofs for side in SIDES))]
    ))  # fmt: skip
    condensed, side_size, turn, _ = condensed_sector(mesh, elasticity, ports, sectors=2 * half + 1)
    part = between_sides(condensed, side_size, turn)
    follow, modulus = np.hstack([part.follow_a, part.follow_b]), stress_modulus(poisson_ratio, plane)
    pitch = 2.0 * math.pi / tooth.teeth
    run = {k: _seen(part, flanks[k].dofs, k * pitch) for k in numbers}
    looked = {
        (k, side): modulus * (fillets[k][side].strain @ _seen(part, fillets[k][side].dofs, k * pitch))
        for k in numbers for side in SIDES
    }  # fmt: skip
    pushed = {k: part.own @ run[k].T for k in numbers}
    none = np.zeros((0, 2, 0))
    kinds = {
        k: ToothKind(
            tooth, views[k][0], flanks[k], fillets[k], run[k] @ follow, run[k] @ pushed[k],
            {side: looked[k, side] @ follow for side in SIDES}, {side: looked[k, side] @ pushed[k] for side in SIDES},
            none, none, 0.0, False, condensed.size,
        )
        for k in numbers
    }  # fmt: skip
    others = [(i, j) for i in numbers for j in numbers if i != j]
    patch = Patch(
        half, {(i, j): run[i] @ pushed[j] for i, j in others},
        {(i, j, side): looked[i, side] @ pushed[j] for i, j in others for side in SIDES},
    )  # fmt: skip
    return kinds, patch, part.held


def _in_frame(mesh: SectorMesh, elasticity: SectorElasticity, k: int) -> tuple[SectorMesh, SectorElasticity]:
    """A patch as tooth k sees it, whose boundaries have the names of a sector's."""
    angle, end = -k * 2.0 * math.pi / mesh.teeth, f"@{k}" if k else ""
    names = {
        name.removesuffix(end): name for name in mesh.edges if (name.endswith(end) if k else "@" not in name)
    }  # fmt: skip
    view = replace(
        mesh, points=turned(mesh.points, angle), edges={own: mesh.edges[name] for own, name in names.items()},
        bends={own: _turned(mesh.bends[name], angle) for own, name in names.items() if name in mesh.bends},
    )  # fmt: skip
    seen = replace(
        elasticity,
        edge_dofs={own: elasticity.edge_dofs[name] for own, name in names.items()},
        edge_places={own: _turned(elasticity.edge_places[name], angle) for own, name in names.items()},
    )
    return view, seen


def _turned(values: Array, angle: float) -> Array:
    """Vectors, shape (2, ...), turned clockwise."""
    return np.asarray(turned(values.reshape(2, -1), angle).reshape(values.shape))


def _seen(part: BetweenSides, dofs: Index, angle: float) -> Array:
    """Unknowns in the frame of a tooth at a clockwise angle as weights of the patch's ports, shape (n, ports)."""
    back = turned(np.eye(2), -angle)
    found = np.zeros((dofs.size, part.own.shape[0]))
    x, each, component = dofs - dofs % 2, np.arange(dofs.size), dofs % 2
    for other in (0, 1):
        found[each, ports_of(part.sector, x + other)] += back[component, other]
    return found
