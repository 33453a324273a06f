"""A user's own tooth mesh: any format that meshio reads, with five named groups.

The groups are ``flank``, ``fillet`` (each on both sides of the tooth), ``bore``, ``side_a`` and ``side_b``, as physical
groups or edge sets, node sets, or nonzero point data of that name. The tooth's centre line is the y axis and the gear's
centre the origin; side A lies half a pitch to the left of it. Three-node and six-node triangles are read; three-node
ones get their middle nodes on the straight edges.

Whether a user's triangles make one sound tooth sector of the gear that the case describes, and where they do not.

Mesh files of any format that meshio knows (its only door).
"""

from __future__ import annotations

from contextlib import redirect_stdout
from io import StringIO
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

import numpy as np

from fegear.base.errors import InputError
from fegear.fem.plane.mesh import SectorMesh

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Index
    from fegear.geometry.involute_tooth import InvoluteTooth

    Refuse = Callable[[str, str], InputError]


GROUPS = ("flank", "fillet", "bore", "side_a", "side_b")
#: meshio's name of the quadratic element of so many nodes.
_ELEMENTS = {6: "triangle6", 15: "wedge15", 20: "hexahedron20"}


def read_sector_mesh(
    path: Path,
    tooth: InvoluteTooth,
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
    tooth : InvoluteTooth
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
        Whether the fillet is the user's own (optimised, ground): it is then not compared with the rack's.

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
        raise InputError(key, f'"{path}"', "file not found", "specify the path relative to the case file")
    try:
        data = read_mesh_file(path)
    except ValueError as problem:
        raise refuse(f"cannot be read by meshio ({problem})", "save it as .msh, .inp, .vtu or .med") from None
    blocks = [b.data for b in data.cells if b.type in ("triangle", "triangle6")]
    if not blocks or any(b.type in ("quad", "quad8", "quad9", "tetra") for b in data.cells):
        raise refuse("must consist of triangles", "mesh the sector with three-node or six-node triangles")
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
            f'has no group "{name}" (it has: {", ".join(known) or "none"})', f"add the groups {', '.join(GROUPS)}"
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
            raise refuse(f'has a group "{name}" without boundary edges')
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
    from scipy.spatial import cKDTree

    def where(place: Array) -> str:
        x, y = place[:2] * module * 1e3
        return f"at x = {x:.5g}, y = {y:.5g} mm"

    if cells.size and (cells.min() < 0 or cells.max() >= points.shape[1]):
        raise refuse(f"has elements with missing nodes (it has {points.shape[1]} nodes)", "write it again")
    used = np.unique(cells)
    bad = used[~np.isfinite(points[:, used]).all(axis=0)]
    if bad.size:
        raise refuse(f"has {bad.size} nodes with invalid coordinates (node {bad[0] + 1}: nan)", "write it again")
    if np.ptp(points[2, used]) > 1e-6 * np.ptp(points[:2, used]):
        raise refuse("must be in a plane z = constant", "mesh the transverse section in the x-y plane")
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
        raise refuse(f"has {np.count_nonzero(times > 1)} duplicate elements (one {place})", "remove the duplicates")
    vertices = np.unique(corners)
    near = cKDTree(points[:2, vertices].T).query_pairs(_ONE_PLACE, output_type="ndarray")
    if near.size:
        place = where(points[:, vertices[near[0, 0]]])
        raise refuse(f"has {len(near)} pairs of coincident nodes (one {place})", "merge them")
    _check_boundary(points, corners, where, refuse)


def _check_boundary(points: Array, corners: Index, where: Callable[[Array], str], refuse: Refuse) -> None:
    """Refuse edges of three elements, and any boundary but one closed line."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    ends = np.sort(np.hstack([corners[[0, 1]], corners[[1, 2]], corners[[2, 0]]]), axis=0)
    edges, times = np.unique(ends, axis=1, return_counts=True)
    if (times > 2).any():
        place = where(points[:, edges[0, np.argmax(times > 2)]])
        raise refuse(f"has edges between more than two elements (one {place})", "remove overlapping elements")
    outer = edges[:, times == 1]
    nodes, local = np.unique(outer, return_inverse=True)
    local = local.reshape(2, -1)
    graph = coo_matrix((np.ones(local.shape[1]), (local[0], local[1])), shape=(nodes.size, nodes.size))
    parts, part = connected_components(graph, directed=False)
    if parts > 1:
        # The outline is the line that reaches farthest up; any other is a hole or a piece that hangs on nothing.
        outline = part[np.argmax(np.hypot(*points[:2, nodes]))]
        place = where(points[:, nodes[np.argmax(part != outline)]])
        raise refuse(
            f"has {parts - 1} holes or unconnected parts (one {place})", "the sector must be one part without holes"
        )
    if (np.bincount(local.reshape(-1)) != 2).any():
        place = where(points[:, nodes[np.argmax(np.bincount(local.reshape(-1)) != 2)]])
        raise refuse(f"is connected by a single node only ({place})", "repair the mesh")


def check_gear(
    points: Array, edges: Mapping[str, Index], tooth: InvoluteTooth, bore_radius: float, module: float, refuse: Refuse
) -> None:
    """Refuse boundaries that are not the gear's.

    Parameters
    ----------
    points : ndarray, shape (2, N)
        [modules].
    edges : mapping of str to ndarray of int, shape (3, n)
    tooth : InvoluteTooth
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
        raise refuse("has its entire flank inside the base circle", "check the length unit and the gear data")
    off = np.abs(angle[inside] - tooth.involute.polar(radius[inside])) * radius[inside]
    if off.max() > _OFF_FLANK:
        raise refuse(
            f"has a flank up to {off.max():.3g} modules away from the involute of the gear",
            "check the length unit, the tooth number and that the tooth is centred on the y axis",
        )
    mm = module * 1e3
    if abs(radius.max() - tooth.involute_tip_radius) > _OFF_TIP:
        raise refuse(
            f"has a flank ending at radius {radius.max() * mm:.6g} mm, in the case at "
            f"{tooth.involute_tip_radius * mm:.6g} mm",
            "set tip_diameter, tip_radius_rounding or tip_chamfer as in the mesh",
        )
    bore = np.hypot(*points[:, np.unique(edges["bore"][:2])])
    if np.abs(bore - bore_radius).max() > _OFF_BORE:
        raise refuse(
            f"has its bore at radius {bore.min() * mm:.6g} to {bore.max() * mm:.6g} mm, in the case at "
            f"{bore_radius * mm:.6g} mm",
            f'set bore_radius = "{bore.mean() * mm:.8g} mm" if the mesh is correct',
        )


def check_fillet(
    points: Array, edges: Mapping[str, Index], tooth: InvoluteTooth, module: float, refuse: Refuse
) -> None:
    """Refuse fillets that the gear's rack does not cut; arguments as of `check_gear`."""
    from scipy.spatial import cKDTree

    outline = [piece.points(np.linspace(piece.start, piece.end, 4001)) for piece in tooth.outline.values()]
    tree = cKDTree(np.hstack(outline).T)
    for name, sign in (("fillet", 1.0), ("back_fillet", -1.0)):
        nodes = points[:, np.unique(edges[name][:2])]
        off, _ = tree.query((nodes * np.array([[sign], [1.0]])).T)
        worst = int(np.argmax(off))
        if off[worst] > _OFF_FILLET:
            raise refuse(
                f"has a fillet deviating up to {off[worst]:.2g} modules from the one generated by the rack of the "
                f"case, at radius {np.hypot(*nodes[:, worst]) * module * 1e3:.6g} mm",
                'check rack (dedendum, tip_radius) and profile_shift, or set tooth_mesh_fillet = "own"',
            )


def write_mesh_file(path: Path, points: Array, triangles: Index, boundaries: Mapping[str, Index]) -> None:
    """Write six-node triangles as ``.msh`` (gmsh 2.2) with named boundary edges as physical groups.

    Parameters
    ----------
    path : Path
    points : ndarray, shape (2, N)
    triangles : ndarray of int, shape (6, M)
    boundaries : mapping of str to ndarray of int, shape (3, n)
    """
    import meshio

    cells = [("triangle6", triangles.T), *(("line3", edges.T) for edges in boundaries.values())]
    tags = [np.full(block.shape[0], tag) for tag, (_, block) in enumerate(cells, start=1)]
    names = {"gear": np.array([1, 2])}
    names |= {name: np.array([tag, 1]) for tag, name in enumerate(boundaries, start=2)}
    mesh = meshio.Mesh(
        np.column_stack([points.T, np.zeros(points.shape[1])]),
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data=names,
    )
    mesh.write(path, file_format="gmsh22", binary=False)


def write_vtu(
    path: Path,
    points: Array,
    elements: tuple[Index, ...],
    point_data: Mapping[str, Array],
    *,
    remark: str = "",
    single: bool = False,
) -> None:
    """Write quadratic elements with nodal fields as ``.vtu``, for ParaView.

    Parameters
    ----------
    path : Path
    points : ndarray, shape (2 or 3, N)
    elements : tuple of ndarray of int, shape (n, M)
        Six-node triangles, 15-node wedges or 20-node hexahedra.
    point_data : mapping of str to ndarray, shape (N,) or (N, 3)
    remark : str
        A comment at the head of the file.
    single : bool
        Whether the file holds seven digits and is not packed: as large as 16 packed digits, and written at once.
    """
    import meshio
    from meshio._mesh import topological_dimension

    topological_dimension.setdefault("wedge15", 3)  # meshio 5.3 reads and writes these, but forgot to list them here
    real, whole = (np.float32, np.int32) if single else (np.float64, np.int64)
    flat = np.zeros((points.shape[1], 3), dtype=real)
    flat[:, : points.shape[0]] = points.T
    cells = [(_ELEMENTS[block.shape[0]], block.T.astype(whole)) for block in elements if block.size]
    # meshio writes names as they are, whatever they mean in XML.
    data = {escape(name, {'"': "&quot;"}): values.astype(real) for name, values in point_data.items()}
    mesh = meshio.Mesh(flat, cells, point_data=data)
    mesh.write(path, binary=True, compression=None if single else "zlib")
    if remark:
        head, _, rest = path.read_bytes().partition(b"\n")
        path.write_bytes(head + f"\n<!-- {remark} -->\n".encode() + rest)


def read_mesh_file(path: Path) -> Any:
    """Read a mesh of any format that meshio knows.

    Raises
    ------
    ValueError
        If meshio cannot read it; the text is meshio's.
    """
    import meshio

    try:
        # Of formats that share an ending it tries one after the other, and prints what the first ones say.
        with redirect_stdout(StringIO()):
            return meshio.read(path)
    except (Exception, SystemExit) as problem:  # noqa: BLE001  (each of its formats raises its own; unknown ones exit)
        raise ValueError(str(problem) or type(problem).__name__) from None
