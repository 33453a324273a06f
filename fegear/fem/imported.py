"""A user's own tooth mesh: any format that meshio reads, with five named groups.

The groups are ``flank``, ``fillet`` (each on both sides of the tooth), ``bore``, ``side_a`` and ``side_b``, as physical
groups or edge sets, node sets, or nonzero point data of that name. The tooth's centre line is the y axis and the gear's
centre the origin; side A lies half a pitch to the left of it. Three-node and six-node triangles are read; three-node
ones get their middle nodes on the straight edges.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.errors import InputError
from fegear.fem.mesh import SectorMesh
from fegear.fem.mesh_files import read_mesh_file
from fegear.fem.sound_mesh import check_fillet, check_gear, check_triangles

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.arrays import Array, Index
    from fegear.geometry.tooth import Tooth

GROUPS = ("flank", "fillet", "bore", "side_a", "side_b")


def read_sector_mesh(
    path: Path,
    tooth: Tooth,
    module: float,
    bore_radius: float,
    unit: float = 1e-3,
    key: str = "tooth_mesh",
    own_fillet: bool = False,
) -> SectorMesh:
    """Read a tooth sector mesh.

    Parameters
    ----------
    path : Path
    tooth : Tooth
        The gear that the mesh is of.
    module : float
        The gear's module [m].
    bore_radius : float
        The gear's, which the mesh's must be [m].
    unit : float
        Length unit of the file [m], millimetres by default.
    key : str
        Name of the input for error messages.
    own_fillet : bool
        Whether the fillet is the user's own (optimised, ground): it is then not held against the rack's.

    Returns
    -------
    SectorMesh

    Raises
    ------
    InputError
        If the file is missing or unreadable, a group is missing, elements are inverted, there twice or of another kind,
        there is a hole, or the mesh is of another gear: flank, fillet or bore.
    """

    def refuse(rule: str, remedy: str = "") -> InputError:
        return InputError(key, f'"{path.name}"', rule, remedy)

    if not path.is_file():
        raise InputError(key, f'"{path}"', "is not there", "give the path relative to the case file")
    try:
        data = read_mesh_file(path)
    except ValueError as problem:
        raise refuse(f"cannot be read by meshio ({problem})", "write it as .msh, .inp, .vtu or .med") from None
    blocks = [b.data for b in data.cells if b.type in ("triangle", "triangle6")]
    if not blocks or any(b.type in ("quad", "quad8", "quad9", "tetra") for b in data.cells):
        raise refuse("does not consist of triangles", "mesh the sector with three-node or six-node triangles")
    if len({block.shape[1] for block in blocks}) > 1:
        raise refuse("mixes three-node and six-node triangles", "use one kind")
    cells = np.vstack(blocks).T.astype(np.int64)
    place = np.zeros((3, len(data.points)))
    place[: np.shape(data.points)[1]] = np.asarray(data.points, dtype=float).T * (unit / module)
    check_triangles(place, cells, module, refuse)
    points = place[:2]
    a, b, c = (points[:, corner] for corner in cells[:3, :1].T[0])
    if (b[0] - a[0]) * (c[1] - a[1]) < (b[1] - a[1]) * (c[0] - a[0]):  # all of them clockwise
        cells = cells[[0, 2, 1] if cells.shape[0] == 3 else [0, 2, 1, 5, 4, 3]]
    points, six, old = _six_node(points, cells)
    edges = _named_edges(six, {name: _group(data, name, old, refuse) for name in GROUPS}, points, refuse)
    mesh = SectorMesh(points, six, edges, tooth.teeth, path.name)
    check_gear(points, edges, tooth, bore_radius / module, module, refuse)
    if not own_fillet:
        check_fillet(points, edges, tooth, module, refuse)
    return mesh


def _six_node(points: Array, cells: Index) -> tuple[Array, Index, Index]:
    """Renumber: vertices first, then a node in the middle of each edge; also each node's old number (-1: new)."""
    vertices, local = np.unique(cells[:3], return_inverse=True)
    corners = local.reshape(3, -1)
    pairs = np.sort(np.stack([corners, corners[[1, 2, 0]]]), axis=0).reshape(2, -1)
    keys, first, inverse = np.unique(pairs[0] * vertices.size + pairs[1], return_index=True, return_inverse=True)
    if cells.shape[0] == 6:
        old_middle = cells[3:].reshape(-1)[first]
        middle = points[:, old_middle]
    else:
        old_middle = np.full(keys.size, -1, dtype=np.int64)
        middle = 0.5 * (points[:, vertices[keys // vertices.size]] + points[:, vertices[keys % vertices.size]])
    six = np.concatenate([corners, vertices.size + inverse.reshape(3, -1)])
    return np.hstack([points[:, vertices], middle]), six, np.concatenate([vertices, old_middle])


def _group(data: Any, name: str, old: Index, refuse: Any) -> NDArray[np.bool_]:
    """Which nodes (new numbers) belong to a named group."""
    members: list[Index] = []
    sets = data.cell_sets_dict.get(name, {}) if data.cell_sets else {}
    for kind, indices in sets.items():
        members.append(data.cells_dict[kind][indices].reshape(-1))
    if name in data.field_data and "gmsh:physical" in data.cell_data:
        tag = int(data.field_data[name][0])
        for block, tags in zip(data.cells, data.cell_data["gmsh:physical"], strict=True):
            if block.type.startswith("line"):
                members.append(block.data[tags == tag].reshape(-1))
    if name in data.point_sets:
        members.append(np.asarray(data.point_sets[name]))
    if name in data.point_data:
        members.append(np.flatnonzero(np.asarray(data.point_data[name]).reshape(-1)))
    if not members or not sum(m.size for m in members):
        known = sorted({*data.cell_sets, *data.point_sets, *data.field_data})
        raise refuse(
            f'has no group "{name}" (it has: {", ".join(known) or "none"})', f"name the groups {', '.join(GROUPS)}"
        )
    return np.isin(old, np.concatenate(members).astype(np.int64))


def _named_edges(six: Index, groups: dict[str, NDArray[np.bool_]], points: Array, refuse: Any) -> dict[str, Index]:
    """Boundary edges of each group, counterclockwise; flank and fillet split into loaded (x > 0) and back side."""
    edges = np.hstack([six[[0, 1, 3]], six[[1, 2, 4]], six[[2, 0, 5]]])
    middles, counts = np.unique(edges[2], return_counts=True)
    outer = edges[:, np.isin(edges[2], middles[counts == 1])]
    named: dict[str, Index] = {}
    for name, member in groups.items():
        inside = member[outer[0]] & member[outer[1]]
        # In quadratic meshes the middle node distinguishes an edge of the group from a chord between its ends.
        if member[outer[2]].any():
            inside &= member[outer[2]]
        if not inside.any():
            raise refuse(f'has a group "{name}" that holds no edge of the boundary')
        right = points[0, outer[2]] > 0.0
        if name in ("flank", "fillet"):
            named[name], named[f"back_{name}"] = outer[:, inside & right], outer[:, inside & ~right]
        else:
            named[name] = outer[:, inside]
    for name in ("flank", "fillet", "back_fillet"):
        if named[name].size == 0:
            raise refuse(
                f'has no "{name.removeprefix("back_")}" edges on the {"left" if "back" in name else "right"} side'
            )
    return named
