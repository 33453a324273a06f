"""The plane mesh of a gear or rack in mm: gmsh (``.msh``), ParaView (``.vtu``), Abaqus and CalculiX (``.inp``)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.case.built.tooth_influence import mesh_settings, own_sector_mesh
from fegear.fem.plane.gear_field import GearField
from fegear.fem.plane.imported_mesh import write_mesh_file, write_vtu
from fegear.fem.plane.loaded_gear import loaded_gear, nodal_fields
from fegear.fem.plane.whole_gear import WholeGear
from fegear.geometry.gear import Gear
from fegear.geometry.toothed_rack import Rack
from fegear.output.deck_cards import deck_names, material_cards, number_lines
from fegear.output.dxf import AS_GENERATED
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.output.export_formats import Request, Written

_MM = 1e3
#: Line load of the fields [N/m].
_LINE_LOAD = 1e3


def write_inp(path: Path, gear: Gear | Rack, whole: WholeGear, forces: Array) -> None:
    """Write an Abaqus or CalculiX deck of a whole gear or rack that runs as it is: held, 1 N/mm on one tooth.

    Parameters
    ----------
    path : Path
    gear : Gear or Rack
    whole : WholeGear
    forces : ndarray, shape (2, N)
        Nodal forces on the sector of the loaded tooth (of a rack all of it) for a unit line load.

    Notes
    -----
    Node sets are the boundaries over all teeth (``BORE``, ``FLANK``, ``FILLET``, ...) and of the loaded tooth
    (``FLANK_0``, ...). Units are mm, N, MPa.
    """
    points, width, names = whole.points * gear.module * _MM, gear.face_width * _MM, deck_names(gear)
    plane = gear.plane if isinstance(gear, Rack) else gear.plane_assumption
    kind = "CPE6" if plane == "strain" else "CPS6"
    subject = f"{names.kind.capitalize()} of {gear.teeth} teeth, module {gear.module * _MM:.9g} mm; mm, N, MPa"
    out = [
        "*HEADING",
        f"Flanks {AS_GENERATED}. {subject}",
        "*NODE, NSET=ALL",
    ]
    out += [f"{i}, {x:.12g}, {y:.12g}, 0" for i, (x, y) in enumerate(points.T, start=1)]
    out.append(f"*ELEMENT, TYPE={kind}, ELSET={names.kind.upper()}")
    out += [f"{i}, " + ", ".join(map(str, e)) for i, e in enumerate((whole.triangles + 1).T.tolist(), start=1)]
    for name in whole.boundaries:
        out.append(f"*NSET, NSET={name.upper()}")
        out += number_lines(whole.node_set(name) + 1)
    out += [
        *material_cards(gear),
        f"{width:.12g}",
        "*BOUNDARY",
        f"{names.fixed.upper()}, 1, 2",
        "*STEP",
        "*STATIC",
        "*CLOAD",
    ]
    for i in np.flatnonzero(np.any(forces != 0.0, axis=0)):
        node = whole.sector_nodes[0, i] + 1
        out += [f"{node}, {axis + 1}, {forces[axis, i] * width:.12g}" for axis in range(2)]
    out += ["*NODE FILE", "U", "*EL FILE", "S", f"*NODE PRINT, NSET=FLANK_{names.loaded}", "U", "*END STEP"]
    path.write_text("\n".join(out) + "\n", encoding="ascii")


def write_msh(path: Path, gear: Gear | Rack, whole: WholeGear) -> None:
    """Write the mesh with its named groups for gmsh."""
    write_mesh_file(path, whole.points * gear.module * _MM, whole.triangles, whole.boundaries)
    path.write_text(f"$Comments\nFlanks {AS_GENERATED}.\n$EndComments\n{path.read_text('utf-8')}", "utf-8")


def write_field(path: Path, gear: Gear | Rack, whole: WholeGear, field: GearField) -> None:
    """Write the mesh with displacement and stress under 1 N/mm for ParaView."""
    data, points = nodal_fields(gear, whole, field, _LINE_LOAD), whole.points * gear.module * _MM
    write_vtu(path, points, (whole.triangles,), data, remark=f"Flanks {AS_GENERATED}.")


def _solved(request: Request) -> tuple[WholeGear, GearField]:
    """The mesh of a gear and its field under a load on tooth 0, once for all files."""
    mesh = own_sector_mesh(request.scene, request.name)
    found: tuple[WholeGear, GearField] = request.cache.call(
        loaded_gear, request.gear, mesh_settings(request.scene.case.accuracy), mesh
    ).value
    return found


def _path(request: Request, ending: str) -> Path:
    return request.folder / f"{file_name(request.name)}.{ending}"


def written_msh(request: Request) -> Written:
    """Write ``<gear>.msh``."""
    path = _path(request, "msh")
    write_msh(path, request.gear, _solved(request)[0])
    return [path], ()


def written_vtu(request: Request) -> Written:
    """Write ``<gear>.vtu`` with displacement and stress."""
    (whole, field), path = _solved(request), _path(request, "vtu")
    write_field(path, request.gear, whole, field)
    return [path], ()


def written_inp(request: Request) -> Written:
    """Write ``<gear>.inp``."""
    (whole, field), path = _solved(request), _path(request, "inp")
    write_inp(path, request.gear, whole, field.forces)
    return [path], ()
