"""The whole gear's mesh in millimetres for gmsh (``.msh``), ParaView (``.vtu``), Abaqus and CalculiX (``.inp``)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.plane.imported_mesh import write_mesh_file, write_vtu
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.whole_gear import WholeGear, loaded_gear, nodal_fields
from fegear.geometry.gear import Gear
from fegear.output.dxf import AS_GENERATED

_MM = 1e3


def _lines(items: list[str], per_line: int) -> Iterator[str]:
    for first in range(0, len(items), per_line):
        yield ", ".join(items[first : first + per_line])


def write_inp(path: Path, gear: Gear, whole: WholeGear, forces: Array) -> None:
    """Write an Abaqus or CalculiX deck of the whole gear that runs as it is: bore held, 1 N/mm on tooth 0.

    Parameters
    ----------
    path : Path
    gear : Gear
    whole : WholeGear
    forces : ndarray, shape (2, N)
        Nodal forces on tooth 0's sector for a unit line load.

    Notes
    -----
    Node sets are the boundaries over all teeth (``BORE``, ``FLANK``, ``FILLET``, ...) and of tooth 0 (``FLANK_0``,
    ...). Units are mm, N, MPa.
    """
    points, width = whole.points * gear.module * _MM, gear.face_width * _MM
    kind = "CPE6" if gear.plane_assumption == "strain" else "CPS6"
    out = [
        "*HEADING",
        f"Flanks {AS_GENERATED}. Gear of {gear.teeth} teeth, module {gear.module * _MM:.9g} mm; mm, N, MPa",
        "*NODE, NSET=ALL",
    ]
    out += [f"{i}, {x:.12g}, {y:.12g}, 0" for i, (x, y) in enumerate(points.T, start=1)]
    out.append(f"*ELEMENT, TYPE={kind}, ELSET=GEAR")
    out += [f"{i}, " + ", ".join(map(str, e)) for i, e in enumerate((whole.triangles + 1).T.tolist(), start=1)]
    for name in whole.boundaries:
        out.append(f"*NSET, NSET={name.upper()}")
        out += _lines([str(node + 1) for node in whole.node_set(name)], 12)
    out += [
        "*MATERIAL, NAME=GEAR",
        "*ELASTIC",
        f"{gear.material.young_modulus * 1e-6:.9g}, {gear.material.poisson_ratio:.9g}",
        "*DENSITY",
        f"{gear.material.density * 1e-12:.9g}",
        "*SOLID SECTION, ELSET=GEAR, MATERIAL=GEAR",
        f"{width:.12g}",
        "*BOUNDARY",
        "BORE, 1, 2",
        "*STEP",
        "*STATIC",
        "*CLOAD",
    ]
    for i in np.flatnonzero(np.any(forces != 0.0, axis=0)):
        node = whole.sector_nodes[0, i] + 1
        out += [f"{node}, {axis + 1}, {forces[axis, i] * width:.12g}" for axis in range(2)]
    out += ["*NODE FILE", "U", "*EL FILE", "S", "*NODE PRINT, NSET=FLANK_0", "U", "*END STEP"]
    path.write_text("\n".join(out) + "\n", encoding="ascii")


def write_meshes(
    gear: Gear, folder: Path, name: str, formats: set[str], settings: MeshSettings, mesh: SectorMesh | None = None
) -> list[Path]:
    """Write the whole gear's mesh as ``<name>.msh``, ``.vtu`` (with displacement and stress) and ``.inp``.

    Parameters
    ----------
    gear : Gear
    folder : Path
    name : str
    formats : set of {"msh", "vtu", "inp"}
    settings : MeshSettings
    mesh : SectorMesh, optional
        A user's own sector mesh.

    Returns
    -------
    list of Path
    """
    whole, field = loaded_gear(gear, settings, mesh)
    points = whole.points * gear.module * _MM
    written = []
    if "msh" in formats:
        written.append(folder / f"{name}.msh")
        write_mesh_file(written[-1], points, whole.triangles, whole.boundaries)
        written[-1].write_text(
            f"$Comments\nFlanks {AS_GENERATED}.\n$EndComments\n{written[-1].read_text('utf-8')}", "utf-8"
        )
    if "vtu" in formats:
        written.append(folder / f"{name}.vtu")
        data = nodal_fields(gear, whole, field, 1e3)
        write_vtu(written[-1], points, (whole.triangles,), data, remark=f"Flanks {AS_GENERATED}.")
    if "inp" in formats:
        written.append(folder / f"{name}.inp")
        write_inp(written[-1], gear, whole, field.forces)
    return written
