"""The meshes of a rack in millimetres: plane ones of spur racks, 3D ones of spur and helical racks.

The reference line is y = 0, the first tooth stands at x = 0, the middle of the face is z = 0; the middle tooth is
loaded, and its back or its pins are held.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.built.rack import check_body, rack_inputs
from fegear.case.built.tooth_influence import mesh_settings
from fegear.fem.plane.gear_field import GearField
from fegear.fem.plane.rack.whole_rack import rack_field, whole_rack
from fegear.fem.plane.whole_gear import WholeGear
from fegear.output.file_names import file_name
from fegear.output.plane_mesh_files import write_field, write_inp, write_msh
from fegear.output.solid_mesh_files import FORCE, PressedGear, pressed_rack, write_solid_inp, write_solid_vtu

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.toothed_rack import Rack
    from fegear.output.export_formats import Request, Written


def loaded_rack(rack: Rack, settings: MeshSettings) -> tuple[WholeGear, GearField]:
    """The plane mesh of a rack, and its field under a unit line load on its middle tooth."""
    whole, mesh = whole_rack(rack, settings)
    return whole, rack_field(rack, mesh, settings.patch_half_width)


def _rack(request: Request) -> Rack:
    return rack_inputs(request.scene, request.name).pair.rack


def _solved(request: Request) -> tuple[WholeGear, GearField]:
    """Once for all files."""
    rack = _rack(request)
    check_body(request.name, rack)
    found: tuple[WholeGear, GearField] = request.cache.call(
        loaded_rack, rack, mesh_settings(request.scene.case.accuracy)
    ).value
    return found


def _meshed(request: Request) -> PressedGear:
    """Once for all files."""
    rack = _rack(request)
    check_body(request.name, rack)
    found: PressedGear = request.cache.call(pressed_rack, rack).value
    return found


def _path(request: Request, ending: str) -> Path:
    return request.folder / f"{file_name(request.name)}_rack{ending}"


def written_msh(request: Request) -> Written:
    """Write ``<rack>_rack.msh``."""
    path = _path(request, ".msh")
    write_msh(path, _rack(request), _solved(request)[0])
    return [path], ()


def written_vtu(request: Request) -> Written:
    """Write ``<rack>_rack.vtu`` with displacement and stress."""
    path, (whole, field) = _path(request, ".vtu"), _solved(request)
    write_field(path, _rack(request), whole, field)
    return [path], ()


def written_inp(request: Request) -> Written:
    """Write ``<rack>_rack.inp``."""
    path, (whole, field) = _path(request, ".inp"), _solved(request)
    write_inp(path, _rack(request), whole, field.forces)
    return [path], ()


def written_solid_inp(request: Request) -> Written:
    """Write ``<rack>_rack_solid.inp``."""
    path, found = _path(request, "_solid.inp"), _meshed(request)
    write_solid_inp(path, _rack(request), found.mesh, found.bands, FORCE, {})
    return [path], ()


def written_solid_vtu(request: Request) -> Written:
    """Write ``<rack>_rack_solid.vtu`` with the bands' nodal forces."""
    path = _path(request, "_solid.vtu")
    write_solid_vtu(path, _rack(request), _meshed(request))
    return [path], ()
