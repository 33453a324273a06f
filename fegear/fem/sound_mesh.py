"""Whether a user's triangles make one sound tooth sector of the gear that the case describes, and where they do not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.arrays import Array, Index
    from fegear.errors import InputError
    from fegear.geometry.tooth import Tooth

    #: Makes the error from a rule and a remedy.
    Refuse = Callable[[str, str], InputError]

#: A flank farther than this from the gear's involute belongs to another gear [modules].
_OFF_FLANK = 0.05
#: The same for the fillet, which racks that differ by a tenth of a module in tip radius part by as much, for the circle
#: of the bore and for the end of the flank at the tip [modules].
_OFF_FILLET, _OFF_BORE, _OFF_TIP = 0.02, 0.02, 0.05
#: Nodes nearer than this are one [modules].
_ONE_PLACE = 1e-7


def check_triangles(points: Array, cells: Index, module: float, refuse: Refuse) -> None:
    """Refuse triangles that overlap, are turned over, leave a hole or do not hang together.

    Parameters
    ----------
    points : ndarray, shape (3, N)
        [modules].
    cells : ndarray of int, shape (3 or 6, M)
    module : float
        [m], for the places in messages.
    refuse : callable
    """

    def where(place: Array) -> str:
        x, y = place[:2] * module * 1e3
        return f"at x = {x:.5g}, y = {y:.5g} mm"

    if cells.size and (cells.min() < 0 or cells.max() >= points.shape[1]):
        raise refuse(f"has elements on nodes that it does not have (it has {points.shape[1]})", "write it again")
    used = np.unique(cells)
    bad = used[~np.isfinite(points[:, used]).all(axis=0)]
    if bad.size:
        raise refuse(f"has {bad.size} nodes that are nowhere (node {bad[0] + 1} of the file: nan)", "write it again")
    if np.ptp(points[2, used]) > 1e-6 * np.ptp(points[:2, used]):
        raise refuse("does not lie in a plane z = constant", "mesh the transverse section in the x-y plane")
    corners = cells[:3]
    a, b, c = (points[:2, corner] for corner in corners)
    area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    turned = area <= 0.0 if np.count_nonzero(area > 0.0) >= 0.5 * area.size else area >= 0.0
    if turned.any():
        place = where(((a + b + c) / 3.0)[:, np.argmax(turned)])
        raise refuse(f"has {np.count_nonzero(turned)} inverted elements (one {place})", "repair the mesh")
    _, first, times = np.unique(np.sort(corners, axis=0), axis=1, return_index=True, return_counts=True)
    if (times > 1).any():
        place = where(((a + b + c) / 3.0)[:, first[np.argmax(times > 1)]])
        raise refuse(f"has {np.count_nonzero(times > 1)} elements twice (one {place})", "leave the copies out")
    vertices = np.unique(corners)
    near = cKDTree(points[:2, vertices].T).query_pairs(_ONE_PLACE, output_type="ndarray")
    if near.size:
        place = where(points[:, vertices[near[0, 0]]])
        raise refuse(f"has {len(near)} pairs of nodes at one place (one {place})", "merge them")
    _check_boundary(points, corners, where, refuse)


def _check_boundary(points: Array, corners: Index, where: Callable[[Array], str], refuse: Refuse) -> None:
    """Refuse edges of three elements, and any boundary but one closed line."""
    ends = np.sort(np.hstack([corners[[0, 1]], corners[[1, 2]], corners[[2, 0]]]), axis=0)
    edges, times = np.unique(ends, axis=1, return_counts=True)
    if (times > 2).any():
        place = where(points[:, edges[0, np.argmax(times > 2)]])
        raise refuse(f"has edges between more than two elements (one {place})", "leave overlapping elements out")
    outer = edges[:, times == 1]
    nodes, local = np.unique(outer, return_inverse=True)
    local = local.reshape(2, -1)
    graph = coo_matrix((np.ones(local.shape[1]), (local[0], local[1])), shape=(nodes.size, nodes.size))
    parts, part = connected_components(graph, directed=False)
    if parts > 1:
        # The outline is the line that reaches farthest up; any other is a hole or a piece that hangs on nothing.
        outline = part[np.argmax(np.hypot(*points[:2, nodes]))]
        place = where(points[:, nodes[np.argmax(part != outline)]])
        raise refuse(f"has {parts - 1} holes or loose pieces (one {place})", "a sector is one piece without holes")
    if (np.bincount(local.reshape(-1)) != 2).any():
        place = where(points[:, nodes[np.argmax(np.bincount(local.reshape(-1)) != 2)]])
        raise refuse(f"hangs together by a single node ({place})", "repair the mesh")


def check_gear(
    points: Array, edges: Mapping[str, Index], tooth: Tooth, bore_radius: float, module: float, refuse: Refuse
) -> None:
    """Refuse boundaries that are not the gear's.

    Parameters
    ----------
    points : ndarray, shape (2, N)
        [modules].
    edges : mapping of str to ndarray of int, shape (3, n)
    tooth : Tooth
    bore_radius : float
        [modules]; NaN leaves it unchecked.
    module : float
        [m], for messages.
    refuse : callable
    """
    flank = points[:, np.unique(edges["flank"])]
    radius, angle = np.hypot(*flank), np.arctan2(*flank)
    inside = radius >= tooth.base_radius
    if not inside.any():
        raise refuse("has its whole flank inside the base circle", "check the length unit and the gear's data")
    off = np.abs(angle[inside] - tooth.involute.polar(radius[inside])) * radius[inside]
    if off.max() > _OFF_FLANK:
        raise refuse(
            f"has a flank up to {off.max():.3g} modules off the gear's involute",
            "check the length unit, the tooth number and that the tooth stands on the y axis",
        )
    mm = module * 1e3
    if abs(radius.max() - tooth.involute_tip_radius) > _OFF_TIP:
        raise refuse(
            f"has a flank that ends at radius {radius.max() * mm:.6g} mm, the case's at "
            f"{tooth.involute_tip_radius * mm:.6g} mm",
            "give tip_diameter, tip_radius_rounding or tip_chamfer as the mesh has them",
        )
    bore = np.hypot(*points[:, np.unique(edges["bore"][:2])])
    if np.abs(bore - bore_radius).max() > _OFF_BORE:
        raise refuse(
            f"has its bore at radius {bore.min() * mm:.6g} to {bore.max() * mm:.6g} mm, the case at "
            f"{bore_radius * mm:.6g} mm",
            f'write bore_radius = "{bore.mean() * mm:.8g} mm" if the mesh is right',
        )


def check_fillet(points: Array, edges: Mapping[str, Index], tooth: Tooth, module: float, refuse: Refuse) -> None:
    """Refuse fillets that the gear's rack does not cut; arguments as of `check_gear`."""
    outline = [piece.points(np.linspace(piece.start, piece.end, 4001)) for piece in tooth.outline.values()]
    tree = cKDTree(np.hstack(outline).T)
    for name, sign in (("fillet", 1.0), ("back_fillet", -1.0)):
        nodes = points[:, np.unique(edges[name][:2])]
        off, _ = tree.query((nodes * np.array([[sign], [1.0]])).T)
        worst = int(np.argmax(off))
        if off[worst] > _OFF_FILLET:
            raise refuse(
                f"has a fillet up to {off[worst]:.2g} modules off the one that the case's rack cuts, at radius "
                f"{np.hypot(*nodes[:, worst]) * module * 1e3:.6g} mm",
                'check rack (dedendum, tip_radius) and profile_shift, or write tooth_mesh_fillet = "own"',
            )
