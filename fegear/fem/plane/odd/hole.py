"""A round hole through the body beside one tooth: within the sector of this tooth, whose sides stay the ordinary one's.

Its edge is free. What it needs is room: elements between it and the next surface, or the sector's sides, whose nodes
are those of the ordinary sector.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.supported_section import bore_end, section_on
from fegear.fem.plane.tooth_meshing import mesh_inside

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport

#: The smallest hole, and what is left beside it at least [modules], or as a share of its radius.
SMALLEST, _LEAST_ROOM, _ROOM_SHARE = 0.02, 0.02, 0.1
#: The same as a share of the edge beside it: long edges of the sector beside short ones of a hole make flat triangles.
#: Of 122 holes on random gears, a third of them as large as may be, 6 had no sound mesh even so, with 0.12 23, with 0.3
#: none.
_OF_EDGE = 0.2
#: Edges around it: at least so many, and no longer than this share of what is left beside it.
_FEWEST, _OF_ROOM = 20, 1.0
#: How often, and by which factor, edges are shortened when elements turn inside out.
_MOST_REFINEMENTS, _FINER = 4, 0.6


@dataclass(frozen=True)
class Hole:
    """A round hole; lengths in modules, in the frame of its tooth.

    Parameters
    ----------
    radius : float
    centre : tuple of (float, float)
        Gear centre at the origin, tooth centre line along +y, loaded flank at x > 0.
    """

    radius: float
    centre: tuple[float, float]

    def mirrored(self) -> Hole:
        """The same hole as a load on the other flank sees it."""
        return replace(self, centre=(-self.centre[0], self.centre[1]))


def hole_at(radius: float, distance: float, angle: float) -> Hole:
    """A hole by the polar coordinates of its centre.

    Parameters
    ----------
    radius : float
        Of the hole [modules].
    distance : float
        Of its centre from the gear's [modules].
    angle : float
        From the tooth's centre line toward its loaded flank [rad].
    """
    return Hole(radius, (distance * math.sin(angle), distance * math.cos(angle)))


def refuse_hole(tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, hole: Hole) -> float:
    """What is left beside a hole [modules]; refused where that is too little.

    Raises
    ------
    InputError
    """
    angle, half = math.degrees(math.atan2(*hole.centre)), 180.0 / tooth.teeth
    if abs(angle) >= half:
        raise InputError("angle", f"{angle:.6g} deg", f"must be between -{half:.6g} and {half:.6g} deg (half a pitch)",
                         "describe the hole at the nearest tooth")  # fmt: skip
    chains = sector_boundary(tooth, bore_radius, settings)
    return _room(chains, hole)


def _room(chains: list[Chain], hole: Hole) -> float:
    closed = np.hstack([chain.vertices[:, :-1] for chain in chains])
    closed = np.column_stack([closed, closed[:, 0]])
    off = closed - np.array(hole.centre)[:, None]
    inside = abs(np.diff(np.unwrap(np.arctan2(off[1], off[0]))).sum()) > math.pi
    first, chord = off[:, :-1], np.diff(off)
    share = np.clip(-(first * chord).sum(axis=0) / np.maximum((chord**2).sum(axis=0), 1e-300), 0.0, 1.0)
    away = np.hypot(*(first + share * chord)) if inside else np.zeros(1)
    if hole.radius < SMALLEST:
        raise InputError("diameter", f"{2.0 * hole.radius:.6g} modules", f"must be at least {2.0 * SMALLEST:g} modules")
    beside = np.maximum(_LEAST_ROOM, _OF_EDGE * np.hypot(*chord))
    most = float(min((away - beside).min(), away.min() / (1.0 + _ROOM_SHARE)))
    if hole.radius > most * (1.0 + 1e-9):
        remedy = "move it away from bore, root and the middle of the tooth spaces, or reduce accuracy.tolerance"
        if most > SMALLEST:
            raise InputError(
                "diameter", f"{2.0 * hole.radius:.6g} modules",
                f"must be at most {2.0 * most:.6g} modules at this place (within the sector of its tooth, one pitch)",
                remedy,
            )  # fmt: skip
        raise InputError(
            "position_radius", f"{math.hypot(*hole.centre):.6g} modules",
            "puts the hole outside the sector of its tooth (one pitch) or across its outline", remedy,
        )  # fmt: skip
    return float(away.min()) - hole.radius


def holed_sector(
    tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, hole: Hole, support: RimSupport | None = None
) -> SectorMesh:
    """Mesh the sector of a tooth with a hole in its body.

    Parameters
    ----------
    tooth : InvoluteTooth
    bore_radius : float
        [modules].
    settings : MeshSettings
        Those of the gear's ordinary sectors.
    hole : Hole
    support : RimSupport, optional
        Of the rim [modules].

    Raises
    ------
    InputError
        If the hole does not lie within the sector.
    FegearError
        If gmsh fails, or no finer mesh around the hole is sound.
    """
    started, scale = time.perf_counter(), 1.0
    chains = sector_boundary(tooth, bore_radius, settings, bore_end=bore_end(settings, support))
    room = _room(chains, hole)
    for _ in range(_MOST_REFINEMENTS):
        try:
            mesh = mesh_inside(chains, tooth.teeth, started, settings.side_growth, _edge(hole, scale * room, scale))
            if settings.order > 2:
                check_cubic_edges(mesh)
        except InputError as problem:
            if problem.key != "mesh":
                raise
            refused = problem
            scale *= _FINER
            continue
        return section_on(mesh, settings, support)
    raise FegearError(
        f"No valid mesh around the hole: it still {refused.rule}; reduce its diameter or accuracy.tolerance."
    ) from refused


def _edge(hole: Hole, room: float, scale: float) -> Chain:
    """Edges around a hole, the body on their left."""
    count = max(math.ceil(_FEWEST / scale), math.ceil(2.0 * math.pi * hole.radius / (_OF_ROOM * room)))
    angle = -math.pi / count * np.arange(2 * count + 1)
    way: Array = np.stack([np.cos(angle), np.sin(angle)])
    points = np.array(hole.centre)[:, None] + hole.radius * way
    points[:, -1] = points[:, 0]
    tangents = np.stack([way[1], -way[0]])[:, ::2]
    return Chain("hole", points[:, ::2], points[:, 1::2], tangents)
