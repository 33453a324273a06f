"""The whole gear's mesh in millimetres for gmsh (``.msh``), ParaView (``.vtu``), Abaqus and CalculiX (``.inp``)."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.field import GearField, gear_field
from fegear.fem.mesh_files import write_mesh_file
from fegear.fem.sector import mesh_sector
from fegear.output.outline import turned
from fegear.output.whole_gear import WholeGear, whole_gear

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from fegear.fem import MeshSettings
    from fegear.fem.mesh import SectorMesh
    from fegear.geometry import Gear

    Array = NDArray[np.float64]
    Index = NDArray[np.int64]

_MM = 1e3
#: Six-node triangles are of this order, and want edges so much shorter than those of fourth order.
_FIELD_ORDER, _SIX_NODE_EDGES = 2, 0.7


def loaded_gear(
    gear: Gear, settings: MeshSettings, mesh: SectorMesh | None = None, radius: float | None = None
) -> tuple[WholeGear, GearField]:
    """Solve the whole gear under 1 N/mm on tooth 0.

    Parameters
    ----------
    gear : Gear
    settings : MeshSettings
        The field is solved on six-node triangles, which other programs read; edges meant for a higher order are
        shortened.
    mesh : SectorMesh, optional
        A user's own sector mesh.
    radius : float, optional
        Load radius [m]; by default the pitch radius, or the flank's end nearest to it.
    """
    if settings.order > _FIELD_ORDER:
        settings = replace(settings.scaled(_SIX_NODE_EDGES), order=_FIELD_ORDER)
    shape = mesh or mesh_sector(gear.tooth, gear.bore_radius / gear.module, settings)
    place = min(max(gear.pitch_radius if radius is None else radius, gear.form_radius), gear.involute_tip_radius)
    room = min(place - gear.form_radius, gear.involute_tip_radius - place) / gear.module
    half_width = max(min(settings.patch_half_width, room), settings.corner_distance)
    nu, plane = gear.material.poisson_ratio, gear.plane_assumption
    return whole_gear(shape), gear_field(gear.tooth, shape, nu, plane, place / gear.module, half_width)


def nodal_fields(gear: Gear, whole: WholeGear, field: GearField, line_load: float) -> dict[str, Array]:
    """Displacement [mm] and von Mises stress [MPa] at the nodes of the whole gear.

    Parameters
    ----------
    gear : Gear
    whole : WholeGear
    field : GearField
    line_load : float
        [N/m].

    Returns
    -------
    dict
        ``displacement`` of shape (N, 3) and ``von_mises`` of shape (N,); on the seam of two sectors their mean.
    """
    count = whole.points.shape[1]
    displacement, stress, times = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    pitch = 2.0 * np.pi / gear.teeth
    for k, nodes in enumerate(whole.sector_nodes):
        displacement[nodes, :2] = turned(field.displacement[k], k * pitch).T
        stress[nodes] += field.von_mises[k]
        times[nodes] += 1.0
    return {
        "displacement": displacement * line_load / gear.material.young_modulus * _MM,
        "von_mises": stress / times * line_load / gear.module * 1e-6,
    }


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
    out = ["*HEADING", f"Gear of {gear.teeth} teeth, module {gear.module * _MM:.9g} mm; mm, N, MPa", "*NODE, NSET=ALL"]
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
        write_mesh_file(written[-1], points, whole.triangles, whole.boundaries, {})
    if "vtu" in formats:
        written.append(folder / f"{name}.vtu")
        write_mesh_file(written[-1], points, whole.triangles, {}, nodal_fields(gear, whole, field, 1e3))
    if "inp" in formats:
        written.append(folder / f"{name}.inp")
        write_inp(written[-1], gear, whole, field.forces)
    return written
