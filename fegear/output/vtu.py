"""Meshes with nodal fields for ParaView: VTK's unstructured grids in XML, numbers in base64 (VTK file formats, 4).

Written here, for a run that draws one mesh needs nothing else of a library of mesh formats.
"""

from __future__ import annotations

import base64
import sys
import zlib
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.base.arrays import Array, Index

    Values = NDArray[np.generic]

#: VTK's number of the quadratic element of so many nodes: triangle, wedge and hexahedron.
_KIND = {6: 22, 15: 26, 20: 25}
_TYPES = {"f4": "Float32", "f8": "Float64", "i4": "Int32", "i8": "Int64", "u1": "UInt8"}


def write_vtu(
    path: Path,
    points: Array,
    elements: tuple[Index, ...],
    point_data: Mapping[str, Array],
    *,
    remark: str = "",
    single: bool = False,
) -> None:
    """Write quadratic elements with nodal fields as ``.vtu``.

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
    real, whole = ("f4", "i4") if single else ("f8", "i8")
    blocks = [block for block in elements if block.size]
    flat = np.zeros((points.shape[1], 3), dtype=real)
    flat[:, : points.shape[0]] = points.T
    nodes = np.concatenate([block.T.reshape(-1) for block in blocks]).astype(whole)
    sizes = np.concatenate([np.full(block.shape[1], block.shape[0]) for block in blocks])
    kinds = np.concatenate([np.full(block.shape[1], _KIND[block.shape[0]], dtype="u1") for block in blocks])
    cells = {"connectivity": nodes, "offsets": np.cumsum(sizes).astype(whole), "types": kinds}
    fields = {name: values.astype(real) for name, values in point_data.items()}
    packed = "" if single else ' compressor="vtkZLibDataCompressor"'
    parts = [
        '<?xml version="1.0"?>',
        f'<VTKFile type="UnstructuredGrid" version="0.1" byte_order="{sys.byteorder.title()}Endian"{packed}>',
        *([f"<!-- {remark} -->"] if remark else []),
        f'<UnstructuredGrid>\n<Piece NumberOfPoints="{flat.shape[0]}" NumberOfCells="{kinds.size}">',
    ]
    for group, arrays in (("Points", {"Points": flat}), ("Cells", cells), ("PointData", fields)):
        parts += [f"<{group}>", *(_array(*one, packed=not single) for one in arrays.items()), f"</{group}>"]
    parts.append("</Piece>\n</UnstructuredGrid>\n</VTKFile>\n")
    path.write_text("\n".join(parts), "ascii", newline="\n")


def _array(name: str, values: Values, *, packed: bool) -> str:
    """One array: a header of 32-bit sizes, then the bytes, packed as one block or as they are."""
    content = values.tobytes()
    head = [len(content)]
    if packed:
        size, content = len(content), zlib.compress(content)
        head = [1, size, size, len(content)]  # blocks, size of one, of the last one, and packed
    header = np.array(head, dtype=np.uint32).tobytes()
    # What is packed has a header that is encoded by itself.
    text = b"".join(map(base64.b64encode, (header, content) if packed else (header + content,)))
    across = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
    kind = _TYPES[values.dtype.str[1:]]
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{across} format="binary">\n{text.decode()}\n</DataArray>'
