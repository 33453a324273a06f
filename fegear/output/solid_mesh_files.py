"""A gear or rack (3D) for Abaqus, CalculiX (``.inp``) and ParaView (``.vtu``): hexahedra, wedges, pressed bands."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.errors import InputError
from fegear.case.built.tooth_influence import own_sector_mesh
from fegear.fem.plane.gear_section import Section, gear_section, uneven_section
from fegear.fem.plane.imported_mesh import write_vtu
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.rack.whole_rack import middle_tooth, rack_section
from fegear.fem.solid.extruded import SolidMesh, extruded, graded_stations, pressed_band
from fegear.fem.solid.rack.pressed_rack import pressed_band_on_rack
from fegear.geometry.gear import Gear
from fegear.geometry.toothed_rack import Rack
from fegear.output.deck_cards import deck_names, material_cards, number_lines
from fegear.output.dxf import AS_GENERATED
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.output.export_formats import Request, Written

_MM = 1e3
#: Abaqus' names of the elements.
_WEDGE, _HEXAHEDRON = "C3D15", "C3D20"
#: Half-width of a band's pressure and half the length of its hat along the face [modules]; at most this share of the
#: room between the band's centre and the nearer end of the flank.
_HALF_WIDTH, _HALF_LENGTH, _SHARE_OF_ROOM = 0.25, 0.5, 0.7
#: Edges in the section as a multiple of the usual ones; layers at the ends of the face and the thickest [modules].
_COARSENESS, _FIRST_LAYER, _LAYER = 1.4, 0.2, 0.5
#: Bands on a rack are at least so far from either end of the flank, as a share of it.
_INSIDE = 0.05
#: Layers grow by so much per length from the nearer end.
_GROWTH = 0.5
#: Force of a band [N].
FORCE = 1e3
#: More nodes than this are a file that no program reads.
_MOST_NODES = 3_000_000


class PressedGear(NamedTuple):
    """A whole gear with pressed bands on tooth 0.

    Attributes
    ----------
    mesh : SolidMesh
        In modules.
    bands : mapping of str to ndarray, shape (3, P)
        Nodal forces of a unit force along the transverse line of action, by words for each band.
    """

    mesh: SolidMesh
    bands: Mapping[str, Array]


def pressed_gear(
    gear: Gear,
    *,
    radius: float | None = None,
    face_positions: Sequence[float] = (0.0,),
    mesh: SectorMesh | None = None,
) -> PressedGear:
    """The whole solid gear with a pressed band at each face position.

    Parameters
    ----------
    gear : Gear
    radius : float, optional
        Of the bands' middle [m]; by default the pitch radius, or the flank's end nearest to it.
    face_positions : sequence of float
        Of the bands, from the middle of the face [m].
    mesh : SectorMesh, optional
        A user's own sector mesh, taken for all teeth; else the loaded tooth's is finer than the others'.

    Returns
    -------
    PressedGear

    Raises
    ------
    InputError
        If a band lies off the face, or the mesh would have more nodes than programs read.
    """
    one, half = gear.module, 0.5 * gear.face_width / gear.module
    hats = _hats(face_positions, half, one)
    body = gear.body_in_modules
    if body is not None and body.holes is not None:
        rule = "makes meshes of webs without holes only"
        raise InputError("--format", "solid", rule, "remove body.holes, or use another format")
    section = (
        gear_section(dict.fromkeys(range(gear.teeth), mesh))
        if mesh
        else uneven_section(gear.tooth, gear.bore_radius / one, _COARSENESS, body=body)
    )
    stations = _stations(section, half, hats, () if body is None else body.along(2.0 * half).ends)
    solid = extruded(section, stations, gear.twist * one, body)
    place = min(max(gear.pitch_radius if radius is None else radius, gear.form_radius), gear.involute_tip_radius)
    width = min(_HALF_WIDTH, _SHARE_OF_ROOM * _room(gear, place))
    bands = {
        f"radius {place * _MM:.6g} mm, half-width {width * one * _MM:.6g} mm, "
        f"face position {hat[1] * one * _MM:.6g} mm": pressed_band(solid, gear.tooth, place / one, width, hat)
        for hat in hats
    }
    return PressedGear(solid, bands)


def pressed_rack(
    rack: Rack, *, height: float = 0.0, face_positions: Sequence[float] = (0.0,), coarseness: float = _COARSENESS
) -> PressedGear:
    """The whole solid rack with a pressed band on its middle tooth at each face position.

    Parameters
    ----------
    rack : Rack
    height : float
        Of the bands' middle above the reference line [m]; at the end of the flank nearest to it, if that has none.
    face_positions : sequence of float
        Of the bands, from the middle of the face [m].
    coarseness : float
        As of `uneven_section`.

    Returns
    -------
    PressedGear

    Raises
    ------
    InputError
        As of `pressed_gear`.
    """
    one, half, tooth = rack.module, 0.5 * rack.face_width / rack.module, rack.tooth
    hats, section = _hats(face_positions, half, one), rack_section(rack, coarseness)
    solid = extruded(section, _stations(section, half, hats, ()), 0.0, slide=rack.slide)
    low, high = tooth.form_height, tooth.flank_end
    place = min(max(height / one, low + _INSIDE * (high - low)), high - _INSIDE * (high - low))
    room = min(place - low, high - place) / math.cos(tooth.pressure_angle)
    width, number = min(_HALF_WIDTH, _SHARE_OF_ROOM * room), middle_tooth(rack)
    bands = {
        f"height {place * one * _MM:.6g} mm, half-width {width * one * _MM:.6g} mm, "
        f"face position {hat[1] * one * _MM:.6g} mm": pressed_band_on_rack(solid, tooth, place, width, hat, number)
        for hat in hats
    }
    return PressedGear(solid, bands)


def _hats(face_positions: Sequence[float], half: float, module: float) -> list[tuple[float, float, float]]:
    """Where the pressure of each band rises from, peaks and falls to along the face [modules]."""
    places = np.array([float(p) for p in face_positions]) / module
    off = places[np.abs(places) > half * (1.0 + 1e-9)]
    if off.size:
        end = half * module * _MM
        rule = f"is outside the face width, {-end:.6g} to {end:.6g} mm"
        raise InputError("face_positions", f"{off[0] * module * _MM:.6g} mm", rule)
    return [(max(p - _HALF_LENGTH, -half), float(p), min(p + _HALF_LENGTH, half)) for p in np.clip(places, -half, half)]


def _stations(
    section: Section, half: float, hats: Sequence[tuple[float, float, float]], through: Sequence[float]
) -> Array:
    """Places of the layers along the face [modules]."""
    wanted = [x for hat in hats for x in hat] + list(through)
    stations = graded_stations(2.0 * half, wanted, _FIRST_LAYER, _GROWTH, _LAYER)
    nodes = int(1.3 * section.points.shape[1] * stations.size)
    if nodes > _MOST_NODES:
        rule = f"would give a mesh of about {nodes:.1g} nodes (maximum {_MOST_NODES:.0e})"
        raise InputError("--format", "solid", rule, "reduce face width, face positions or number of teeth")
    return stations


def _room(gear: Gear, radius: float) -> float:
    """Length of the flank from a radius to its nearer end [modules]."""
    tooth, one = gear.tooth, gear.module
    low, at, high = (
        0.5 * tooth.base_radius * float(tooth.roll(r)) ** 2
        for r in (tooth.form_radius, radius / one, tooth.involute_tip_radius)
    )
    return min(at - low, high - at)


def written_inp(request: Request) -> Written:
    """Write ``<gear>_solid.inp``."""
    found, path = _meshed(request), request.folder / f"{file_name(request.name)}_solid.inp"
    write_solid_inp(path, request.gear, found.mesh, found.bands, FORCE, {})
    return [path], ()


def written_vtu(request: Request) -> Written:
    """Write ``<gear>_solid.vtu`` with the bands' nodal forces."""
    found, path = _meshed(request), request.folder / f"{file_name(request.name)}_solid.vtu"
    write_solid_vtu(path, request.gear, found)
    return [path], ()


def _meshed(request: Request) -> PressedGear:
    """The mesh of a gear, once for all files."""
    mesh = own_sector_mesh(request.scene, request.name)
    found: PressedGear = request.cache.call(pressed_gear, request.gear, mesh=mesh).value
    return found


def write_solid_vtu(path: Path, gear: Gear | Rack, found: PressedGear) -> None:
    """Write the mesh and the nodal forces of its bands for ParaView."""
    mesh = found.mesh
    data = {f"force_{i}": FORCE * forces.T for i, forces in enumerate(found.bands.values())}
    write_vtu(path, mesh.points * gear.module * _MM, (mesh.wedges, mesh.hexahedra), data)


def _number(x: float) -> str:
    """At most 20 characters: CalculiX reads no more of a number."""
    return f"{x:.12e}"


def _elements(kind: str, elements: Index, first: int, name: str) -> Iterator[str]:
    """Element cards; more than 15 nodes take a second line."""
    if not elements.size:
        return
    yield f"*ELEMENT, TYPE={kind}, ELSET={name}"
    for i, nodes in enumerate((elements + 1).T.tolist(), start=first):
        yield f"{i}, " + ", ".join(map(str, nodes[:15])) + ("," if len(nodes) > 15 else "")
        if len(nodes) > 15:
            yield ", ".join(map(str, nodes[15:]))


def write_solid_inp(
    path: Path,
    gear: Gear | Rack,
    mesh: SolidMesh,
    loads: Mapping[str, Array],
    force: float,
    printed: Mapping[str, Index],
) -> None:
    """Write a deck that runs as it is: bore or back held, one step per load.

    Parameters
    ----------
    path : Path
    gear : Gear or Rack
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
    (``FLANK_0``, ...; of a rack of its loaded tooth), and the two ends of the face (``FRONT``, ``BACK``; of a rack
    ``FACE_FRONT``, ``FACE_BACK``). Units are mm, N, MPa.
    """
    scale, names = gear.module * _MM, deck_names(gear)
    section, tooth = mesh.section, max(names.loaded - 1, 0)
    out = [
        "*HEADING",
        f"Solid {names.kind} of {gear.teeth} teeth, module {scale:.9g} mm; mm, N, MPa. Flanks {AS_GENERATED}",
        "*NODE, NSET=ALL",
    ]
    out += [f"{i}, {_number(x)}, {_number(y)}, {_number(z)}" for i, (x, y, z) in enumerate((mesh.points * scale).T, 1)]
    out += _elements(_WEDGE, mesh.wedges, 1, names.kind.upper())
    out += _elements(_HEXAHEDRON, mesh.hexahedra, 1 + mesh.wedges.shape[1], names.kind.upper())
    plane = np.arange(section.points.shape[1])
    sets = {name: mesh.nodes_of(section.edges(name)) for name in section.names}
    sets |= {
        f"{name}_{names.loaded}": mesh.nodes_of(section.boundaries[name, tooth])
        for name in section.names
        if name != names.fixed and (name, tooth) in section.boundaries
    }
    face = "face_" if names.kind == "rack" else ""
    sets |= {f"{face}front": mesh.at_station(plane, mesh.layers), f"{face}back": mesh.at_station(plane, 0)}
    for name, nodes in {**sets, **printed}.items():
        out.append(f"*NSET, NSET={name.upper()}")
        out += number_lines(nodes + 1)
    out += [*material_cards(gear), "*BOUNDARY", f"{names.fixed.upper()}, 1, 3"]
    for name, forces in loads.items():
        out += ["*STEP", "*STATIC", "*CLOAD, OP=NEW", f"** {name}"]
        for node in np.flatnonzero(np.any(forces != 0.0, axis=0)):
            out += [f"{node + 1}, {c + 1}, {_number(forces[c, node] * force)}" for c in range(3)]
        if not printed:
            out += ["*NODE FILE", "U", "*EL FILE", "S"]
        for number_set in printed or (f"FLANK_{names.loaded}",):
            out += [f"*NODE PRINT, NSET={number_set.upper()}", "U"]
        out.append("*END STEP")
    path.write_text("\n".join(out) + "\n", encoding="ascii")
