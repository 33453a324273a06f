"""The solid gear for Abaqus and CalculiX (``.inp``): wedges and hexahedra, the pressed band as nodal loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.output.dxf import AS_GENERATED

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from fegear.arrays import Array, Index
    from fegear.fem.extruded import SolidMesh
    from fegear.geometry import Gear

_MM = 1e3
#: Abaqus' names of the elements.
_WEDGE, _HEXAHEDRON = "C3D15", "C3D20"


def _number(x: float) -> str:
    """At most 20 characters: CalculiX reads no more of a number."""
    return f"{x:.12e}"


def _lines(numbers: Index, per_line: int = 12) -> Iterator[str]:
    for first in range(0, len(numbers), per_line):
        yield ", ".join(map(str, numbers[first : first + per_line]))


def _elements(kind: str, elements: Index, first: int) -> Iterator[str]:
    """Element cards; more than 15 nodes take a second line."""
    if not elements.size:
        return
    yield f"*ELEMENT, TYPE={kind}, ELSET=GEAR"
    for i, nodes in enumerate((elements + 1).T.tolist(), start=first):
        yield f"{i}, " + ", ".join(map(str, nodes[:15])) + ("," if len(nodes) > 15 else "")
        if len(nodes) > 15:
            yield ", ".join(map(str, nodes[15:]))


def write_solid_inp(
    path: Path, gear: Gear, mesh: SolidMesh, loads: Mapping[str, Array], force: float, printed: Mapping[str, Index]
) -> None:
    """Write a deck that runs as it is: bore held, one step per load.

    Parameters
    ----------
    path : Path
    gear : Gear
        Its module and material; the shape is the mesh's.
    mesh : SolidMesh
    loads : mapping of str to ndarray, shape (3, P)
        Nodal forces of a unit force along the transverse line of action, by the names of the steps.
    force : float
        That force [N].
    printed : mapping of str to ndarray of int
        Further node sets, whose displacements are printed into the ``.dat`` file.

    Notes
    -----
    Node sets are the boundaries over all teeth that the mesh has (``BORE``, ``FLANK``, ``FILLET``, ...), of tooth 0
    (``FLANK_0``, ...), and the two ends of the face (``FRONT``, ``BACK``). Units are mm, N, MPa.
    """
    scale = gear.module * _MM
    section = mesh.section
    out = [
        "*HEADING",
        f"Solid gear of {gear.teeth} teeth, module {scale:.9g} mm; mm, N, MPa. Flanks {AS_GENERATED}",
        "*NODE, NSET=ALL",
    ]
    out += [f"{i}, {_number(x)}, {_number(y)}, {_number(z)}" for i, (x, y, z) in enumerate((mesh.points * scale).T, 1)]
    out += _elements(_WEDGE, mesh.wedges, 1)
    out += _elements(_HEXAHEDRON, mesh.hexahedra, 1 + mesh.wedges.shape[1])
    plane = np.arange(section.points.shape[1])
    sets = {name: mesh.nodes_of(section.edges(name)) for name in section.names}
    sets |= {
        f"{name}_0": mesh.nodes_of(section.boundaries[name, 0])
        for name in section.names
        if name != "bore" and (name, 0) in section.boundaries
    }
    sets |= {"front": mesh.at_station(plane, mesh.layers), "back": mesh.at_station(plane, 0)}
    for name, nodes in {**sets, **printed}.items():
        out.append(f"*NSET, NSET={name.upper()}")
        out += _lines(nodes + 1)
    out += [
        "*MATERIAL, NAME=GEAR",
        "*ELASTIC",
        f"{gear.material.young_modulus * 1e-6:.9g}, {gear.material.poisson_ratio:.9g}",
        "*DENSITY",
        f"{gear.material.density * 1e-12:.9g}",
        "*SOLID SECTION, ELSET=GEAR, MATERIAL=GEAR",
        "*BOUNDARY",
        "BORE, 1, 3",
    ]
    for name, forces in loads.items():
        out += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", f"** {name}"]
        for node in np.flatnonzero(np.any(forces != 0.0, axis=0)):
            out += [f"{node + 1}, {c + 1}, {_number(forces[c, node] * force)}" for c in range(3)]
        if not printed:
            out += ["*NODE FILE", "U", "*EL FILE", "S"]
        for number_set in printed or {"FLANK_0": None}:
            out += [f"*NODE PRINT, NSET={number_set.upper()}", "U"]
        out.append("*END STEP")
    path.write_text("\n".join(out) + "\n", encoding="ascii")
