"""Fields of a run: files for other programs, written by meshio, and the loaded tooth in space, drawn by pyvista."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, MeshField, SolidMeshField
from fegear.engine.figure.items import Skin, TriangleField
from fegear.engine.figure.panel import Panel
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.base.arrays import Array, Index
    from fegear.geometry.gear import Gear

#: Where they stand below the folder of a run.
FOLDER = "fields"
#: Units of the values at the nodes.
_UNITS = {"displacement": "mm", "von_mises": "MPa"}
#: Teeth that a picture in space shows on either side of the loaded one, and where it is seen from: an external one from
#: above, an internal one from below.
_BESIDE = 3
_CAMERA = {1: (0.75, 0.55, 1.3), -1: (0.55, -0.5, 1.3)}


class FieldFile(NamedTuple):
    """A file of a field, below the folder of a run.

    Attributes
    ----------
    name : str
    values : str
        What its nodes have, with units.
    under : str
        The load; empty where the values' own meaning says it.
    """

    name: str
    values: str
    under: str

    def __str__(self) -> str:
        """One sentence about it."""
        load = f" under {self.under}" if self.under else ""
        return f"{FOLDER}/{self.name}: {self.values} at the nodes{load}, for ParaView, meshio and pyvista."


def field_file(figure: Figure) -> FieldFile | None:
    """The file of a figure that shows a part of a field; None where it shows none."""
    field = figure.field
    if field is None:
        return None
    named = (f"{name} [{_UNITS[name]}]" if name in _UNITS else name for name in field.values)
    return FieldFile(f"{file_name(field.name)}.vtu", ", ".join(named), figure.under)


def write_field(figure: Figure, folder: Path) -> FieldFile | None:
    """Write ``<name>.vtu`` of a figure that shows a part of a field; None where it shows none."""
    field, file = figure.field, field_file(figure)
    if field is None or file is None:
        return None
    from fegear.fem.plane.imported_mesh import write_vtu

    folder.mkdir(exist_ok=True)
    elements = field.wedges if isinstance(field, SolidMeshField) else field.triangles
    single = isinstance(field, MeshField)
    write_vtu(folder / file.name, np.asarray(field.points), (elements,), field.values, single=single)
    return file


def in_space(figure: Figure, gear: Gear) -> Figure | None:
    """The loaded tooth of a plane gear and its neighbours, as wide as the face; None where a figure has no plane field.

    Parameters
    ----------
    figure : Figure
        Its first panel is the whole gear, deformed and coloured, sector after sector from the loaded tooth.
    gear : Gear
    """
    shown = next((item for panel in figure.all_panels for item in panel.items if isinstance(item, TriangleField)), None)
    if shown is None or not isinstance(figure.field, MeshField):
        return None
    near = np.arange(-_BESIDE, _BESIDE + 1) if gear.teeth > 2 * _BESIDE else np.arange(gear.teeth)
    chosen = np.asarray(shown.triangles).reshape(3, gear.teeth, -1)[:, near].reshape(3, -1)
    nodes, corners = np.unique(chosen, return_inverse=True)
    points, triangles = np.asarray(shown.points)[:, nodes], corners.reshape(3, -1)
    end, count = np.full((1, nodes.size), 0.5 * gear.face_width * 1e3), nodes.size
    skin = Skin(
        np.hstack([np.vstack([points, end]), np.vstack([points, -end])]),
        np.hstack([triangles, triangles[::-1] + count, _walls(triangles, count)]),
        np.tile(np.asarray(shown.values)[nodes], 2),
        shown.top,
        shown.label,
        shown.unit,
    )
    camera = (_CAMERA[gear.tooth.side], (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    return replace(
        figure,
        key=f"{figure.key}_in_space",
        title=f"{figure.title}, 3D",
        panels=(Panel(Axis(), Axis(), (skin,), height=1.5, camera=camera),),
        views=(),
        columns=1,
        field=None,
    )


def _walls(triangles: Index, count: int) -> Array:
    """Triangles between the outlines of two equal ends, whose second has numbers higher by `count`, shape (3, n)."""
    sides = np.hstack([triangles[[a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
    _, first, times = np.unique(np.sort(sides, axis=0), axis=1, return_index=True, return_counts=True)
    one, other = sides[:, first[times == 1]]
    return np.hstack([np.stack([one, other, one + count]), np.stack([other, other + count, one + count])])
