"""Mesh files of any format that meshio knows (its only door)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.arrays import Array, Index


def write_mesh_file(
    path: Path,
    points: Array,
    triangles: Index,
    boundaries: Mapping[str, Index],
    point_data: Mapping[str, Array],
    *,
    single: bool = False,
) -> None:
    """Write six-node triangles with named boundary edges and nodal fields.

    Parameters
    ----------
    path : Path
        ``.msh`` (gmsh 2.2, with the boundaries as physical groups) or ``.vtu``.
    points : ndarray, shape (2, N)
    triangles : ndarray of int, shape (6, M)
    boundaries : mapping of str to ndarray of int, shape (3, n)
        Kept in ``.msh`` only; VTU has no names for edges.
    point_data : mapping of str to ndarray, shape (N,) or (N, 3)
    single : bool
        Whether ``.vtu`` holds seven digits and is not packed: as large as 16 packed digits, and written at once.
    """
    import meshio

    flat = np.column_stack([points.T, np.zeros(points.shape[1])])
    if path.suffix == ".vtu":
        data = {name: values.astype(np.float32) if single else values for name, values in point_data.items()}
        corners = triangles.T.astype(np.int32) if single else triangles.T
        gear = meshio.Mesh(flat.astype(np.float32) if single else flat, [("triangle6", corners)], point_data=data)
        gear.write(path, binary=True, compression=None if single else "zlib")
        return
    cells = [("triangle6", triangles.T), *(("line3", edges.T) for edges in boundaries.values())]
    tags = [np.full(block.shape[0], tag) for tag, (_, block) in enumerate(cells, start=1)]
    names = {"gear": np.array([1, 2])}
    names |= {name: np.array([tag, 1]) for tag, name in enumerate(boundaries, start=2)}
    mesh = meshio.Mesh(
        flat,
        cells,
        point_data=dict(point_data),
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data=names,
    )
    mesh.write(path, file_format="gmsh22", binary=False)


def write_solid_file(
    path: Path, points: Array, wedges: Index, hexahedra: Index, point_data: Mapping[str, Array]
) -> None:
    """Write quadratic wedges and hexahedra with nodal fields as VTU.

    Parameters
    ----------
    path : Path
    points : ndarray, shape (3, N)
    wedges : ndarray of int, shape (15, M)
    hexahedra : ndarray of int, shape (20, K)
    point_data : mapping of str to ndarray, shape (N,) or (N, 3)
    """
    import meshio
    from meshio._mesh import topological_dimension

    topological_dimension.setdefault("wedge15", 3)  # meshio 5.3 reads and writes these, but forgot to list them here
    cells = [("wedge15", wedges.T), ("hexahedron20", hexahedra.T)]
    mesh = meshio.Mesh(points.T, [(kind, block) for kind, block in cells if block.size], point_data=dict(point_data))
    mesh.write(path, binary=True, compression="zlib")


def read_mesh_file(path: Path) -> Any:
    """Read a mesh of any format that meshio knows.

    Raises
    ------
    ValueError
        If meshio cannot read it; the text is meshio's.
    """
    import meshio

    try:
        return meshio.read(path)
    except (Exception, SystemExit) as problem:  # noqa: BLE001  (each of its formats raises its own; unknown ones exit)
        raise ValueError(str(problem) or type(problem).__name__) from None
