"""A keyway in the bore: several sectors meshed as one, whose ends are those of ordinary sectors; held bores only.

A keyway is wider than a sector there, so the sectors -h..h beside it are one patch. The bore beside the keyway stays
held; its walls and its floor are free.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.fem.plane.boundary import Chain, sector_boundary
from fegear.fem.plane.edge_sizes import graded
from fegear.fem.plane.elements import check_cubic_edges
from fegear.fem.plane.odd.crack_over_sectors import joined_sectors
from fegear.fem.plane.tooth_meshing import mesh_inside

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.mesh import SectorMesh
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.involute_tooth import InvoluteTooth

#: Edges at the corners, as a share of depth and width; how fast they grow from there.
_CORNER, _GROWTH = 0.12, 0.4
#: What is left between a corner of the keyway and the root circle at least [modules].
_LEAST_RIM = 0.5
#: The widest keyway, as a share of the bore's diameter; the narrowest and shallowest [modules].
_WIDEST, _SMALLEST = 0.8, 0.05
#: How much of the bore beside the keyway the patch has at least, in depths of the keyway.
_BESIDE = 1.0
#: How often, and by which factor, edges are shortened when elements turn inside out.
_MOST_REFINEMENTS, _FINER = 4, 0.6

#: DIN 6885-1 (1968), parallel keys: bore up to [mm], width, depth in the hub t_2 [mm].
DIN_6885 = (
    (8.0, 2.0, 1.0), (10.0, 3.0, 1.4), (12.0, 4.0, 1.8), (17.0, 5.0, 2.3), (22.0, 6.0, 2.8), (30.0, 8.0, 3.3),
    (38.0, 10.0, 3.3), (44.0, 12.0, 3.3), (50.0, 14.0, 3.8), (58.0, 16.0, 4.3), (65.0, 18.0, 4.4), (75.0, 20.0, 4.9),
    (85.0, 22.0, 5.4), (95.0, 25.0, 5.4), (110.0, 28.0, 6.4), (130.0, 32.0, 7.4), (150.0, 36.0, 8.4),
    (170.0, 40.0, 9.4), (200.0, 45.0, 10.4), (230.0, 50.0, 11.4),
)  # fmt: skip
#: Smallest bore with a key of that table [mm].
_SMALLEST_BORE = 6.0


def din_6885(bore_diameter: float) -> tuple[float, float]:
    """Width of the keyway of a bore and its depth t_2 by DIN 6885-1 [m].

    Parameters
    ----------
    bore_diameter : float
        [m].

    Raises
    ------
    InputError
        If the table has no key for the bore.
    """
    for most, width, depth in DIN_6885:
        if _SMALLEST_BORE < 1e3 * bore_diameter <= most:
            return 1e-3 * width, 1e-3 * depth
    raise InputError(
        "bore_diameter", f"{1e3 * bore_diameter:.6g} mm",
        f"must be above {_SMALLEST_BORE:g} and at most {DIN_6885[-1][0]:g} mm for a key of DIN 6885-1",
        "specify width and depth of the keyway",
    )  # fmt: skip


@dataclass(frozen=True)
class Keyway:
    """A keyway; lengths in modules.

    Parameters
    ----------
    width : float
    depth : float
        From the bore to its floor, in its middle (t_2 of DIN 6885).
    angle : float
        Of its middle from the centre line of its tooth toward the loaded flank [rad], at most half a pitch.
    """

    width: float
    depth: float
    angle: float = 0.0

    def mirrored(self) -> Keyway:
        """The same keyway as a load on the other flank sees it."""
        return replace(self, angle=-self.angle)

    def half_angle(self, bore_radius: float) -> float:
        """Half of what it takes of the bore [rad]."""
        return math.asin(0.5 * self.width / bore_radius)

    def sectors_beside(self, teeth: int, bore_radius: float) -> int:
        """h: sectors on either side of its tooth's that are meshed with it."""
        reach = abs(self.angle) + self.half_angle(bore_radius) + _BESIDE * self.depth / bore_radius
        return max(1, math.ceil(reach * teeth / (2.0 * math.pi) - 0.5))


def refuse_keyway(tooth: InvoluteTooth, bore_radius: float, keyway: Keyway) -> None:
    """Refuse a keyway that the body has no room for.

    Raises
    ------
    InputError
    """
    most, half = 2.0 * _WIDEST * bore_radius, math.pi / tooth.teeth
    if not _SMALLEST <= keyway.width <= most:
        raise InputError("width", f"{keyway.width:.6g} modules", f"must be {_SMALLEST:g} to {most:.6g} modules "
                         f"({_WIDEST:g} of the bore's diameter)")  # fmt: skip
    if not keyway.depth >= _SMALLEST:
        raise InputError("depth", f"{keyway.depth:.6g} modules", f"must be at least {_SMALLEST:g} modules")
    if abs(keyway.angle) > half * (1.0 + 1e-9):
        raise InputError("angle", f"{math.degrees(keyway.angle):.6g} deg",
                         f"must be between -{math.degrees(half):.6g} and {math.degrees(half):.6g} deg (half a pitch)",
                         "describe the keyway at the nearest tooth")  # fmt: skip
    corner = math.hypot(0.5 * keyway.width, bore_radius + keyway.depth)
    if tooth.root_radius - corner < _LEAST_RIM:
        raise InputError(
            "depth", f"{keyway.depth:.6g} modules",
            f"leaves {tooth.root_radius - corner:.6g} modules between a corner of the keyway and the root circle; "
            f"at least {_LEAST_RIM:g} modules are required", "reduce depth, width or bore",
        )  # fmt: skip
    needed = 2 * keyway.sectors_beside(tooth.teeth, bore_radius) + 5
    if needed > tooth.teeth - 2:
        raise InputError("width", f"{keyway.width:.6g} modules", f"takes {needed - 4} of {tooth.teeth} sectors; at "
                         f"most {tooth.teeth - 6} are possible", "reduce width")  # fmt: skip


def keyed_patch(tooth: InvoluteTooth, bore_radius: float, settings: MeshSettings, keyway: Keyway) -> SectorMesh:
    """Mesh the sectors beside a keyway as one; boundaries of tooth k have the names of a sector's and ``@k``, but of 0.

    Raises
    ------
    InputError
        If there is no room for it.
    FegearError
        If gmsh fails, or no finer mesh around it is sound.
    """
    refuse_keyway(tooth, bore_radius, keyway)
    started, scale = time.perf_counter(), 1.0
    half = keyway.sectors_beside(tooth.teeth, bore_radius)
    usual = sector_boundary(tooth, bore_radius, settings)
    chains = joined_sectors(dict.fromkeys(range(-half, half + 1), usual), 2.0 * math.pi / tooth.teeth)
    count = usual[0].vertices.shape[1] - 1
    for _ in range(_MOST_REFINEMENTS):
        new = _bore(tooth, bore_radius, keyway, half, count, scale)
        new[0] = replace(new[0], vertices=np.column_stack([chains[0].vertices[:, :1], new[0].vertices[:, 1:]]))
        last = chains[2 * half].vertices[:, -1:]
        new[-1] = replace(new[-1], vertices=np.column_stack([new[-1].vertices[:, :-1], last]))
        try:
            mesh = mesh_inside([*new, *chains[2 * half + 1 :]], tooth.teeth, started, settings.side_growth)
            if settings.order > 2:
                check_cubic_edges(mesh)
        except InputError as problem:
            if problem.key != "mesh":
                raise
            refused = problem
            scale *= _FINER
            continue
        return mesh
    raise FegearError(
        f"No valid mesh around the keyway: it still {refused.rule}; change its width or angle a little."
    ) from refused


def _bore(tooth: InvoluteTooth, bore_radius: float, keyway: Keyway, half: int, count: int, scale: float) -> list[Chain]:
    """The bore of a patch from its first side to its last, the keyway in it."""
    pitch = 2.0 * math.pi / tooth.teeth
    usual = pitch * bore_radius / count
    corner = scale * min(_CORNER * keyway.depth, _CORNER * keyway.width, usual)
    ends = [keyway.angle + side * keyway.half_angle(bore_radius) for side in (-1.0, 1.0)]
    outer, across = bore_radius + keyway.depth, 0.5 * keyway.width
    inner = math.sqrt(bore_radius**2 - across**2)

    def from_corner(length: float, *, first: bool, last: bool) -> Array:
        def size(s: Array) -> Array:
            away = np.full(s.shape, np.inf)
            if first:
                away = np.minimum(away, s)
            if last:
                away = np.minimum(away, length - s)
            return np.minimum(usual, corner + _GROWTH * away)

        return graded(length, size)

    def arc(start: float, end: float, *, first: bool) -> Chain:
        nodes = start + from_corner((end - start) * bore_radius, first=first, last=not first) / bore_radius
        nodes[-1] = end
        angle = np.sort(np.concatenate([nodes, 0.5 * (nodes[1:] + nodes[:-1])]))
        points = bore_radius * np.stack([np.sin(angle), np.cos(angle)])
        return Chain("bore", points[:, ::2], points[:, 1::2], np.stack([np.cos(nodes), -np.sin(nodes)]))

    turn = np.array([[math.cos(keyway.angle), math.sin(keyway.angle)],
                     [-math.sin(keyway.angle), math.cos(keyway.angle)]])  # fmt: skip
    corners = turn @ np.array([[-across, -across, across, across], [inner, outer, outer, inner]])

    def straight(start: Array, end: Array) -> Chain:
        length = float(np.hypot(*(end - start)))
        share = from_corner(length, first=True, last=True) / length
        at = np.sort(np.concatenate([share, 0.5 * (share[1:] + share[:-1])]))
        points = start[:, None] + (end - start)[:, None] * at
        points[:, -1] = end
        way = np.repeat(((end - start) / length)[:, None], share.size, axis=1)
        return Chain("keyway", points[:, ::2], points[:, 1::2], way)

    before, after = arc(-(half + 0.5) * pitch, ends[0], first=False), arc(ends[1], (half + 0.5) * pitch, first=True)
    before = replace(before, vertices=np.column_stack([before.vertices[:, :-1], corners[:, 0]]))
    after = replace(after, vertices=np.column_stack([corners[:, 3], after.vertices[:, 1:]]))
    walls = [straight(corners[:, n], corners[:, n + 1]) for n in range(3)]
    return [before, *walls, after]
