"""The solid of a rack as a STEP file, with the relief that the case gives it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.built.rack import drawn_rack
from fegear.fem.solid.rack_step import write_rack_step
from fegear.geometry.rack_relief import relieved_rack_outline
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.output.export_formats import Request, Written


def written_rack(request: Request) -> Written:
    """Write ``<rack>_rack.step``."""
    rack, relief = drawn_rack(request.scene, request.name)
    path = request.folder / f"{file_name(request.name)}_rack.step"
    write_rack_step(path, rack, None if relief is None else relieved_rack_outline(rack, relief))
    return [path], ()
