"""DXF drawings of racks in millimetres: the whole rack as a closed polyline, and as lines, arcs and splines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.rack import drawn_rack
from fegear.geometry.rack_outline import rack_outline
from fegear.geometry.rack_relief import relieved_rack_outline
from fegear.output.dxf import AS_GENERATED, CHORD_TOLERANCE, Splines, add_curve, add_polyline, drawing
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.geometry.curves import Drawn
    from fegear.geometry.rack_relief import RackRelief
    from fegear.geometry.toothed_rack import Rack
    from fegear.output.export_formats import Request, Written

_MM = 1e3


def write_rack_dxf(rack: Rack, folder: Path, name: str, relief: RackRelief | None = None) -> list[Path]:
    """Write ``<name>_rack_{polyline,spline}.dxf``: the reference line at y = 0, the first tooth at x = 0.

    Parameters
    ----------
    rack : Rack
    folder : Path
    name : str
    relief : RackRelief, optional
        What is ground off both flanks of every tooth.
    """
    flanks = AS_GENERATED if relief is None else "with the relief of the case, both flanks"
    pieces: list[Drawn] = list(rack.tooth.outline.values()) if relief is None else relieved_rack_outline(rack, relief)
    outline = rack_outline(rack, CHORD_TOLERANCE, pieces=pieces) * _MM
    written = [folder / f"{name}_rack_{part}.dxf" for part in ("polyline", "spline")]
    document, space = drawing(flanks)
    add_polyline(space, outline[:, :-1], "OUTLINE")
    document.saveas(written[0])

    document, space = drawing(flanks)
    known: Splines = {}
    for number in range(rack.teeth):
        beside = np.array([[number * rack.pitch * _MM], [0.0]])
        for mirrored in (False, True):
            for curve in pieces:
                add_curve(space, curve, rack.module * _MM, 0.0, mirrored=mirrored, known=known, beside=beside)
    corners = outline[:, [-2, 0, 1, 2]]  # left end above and below, right end below and above
    for a, b in zip(corners.T[:-1], corners.T[1:], strict=True):
        space.add_line(tuple(a), tuple(b), dxfattribs={"layer": "OUTLINE"})
    document.saveas(written[1])
    return written


def written_rack(request: Request) -> Written:
    """Write the drawings of a rack with the relief that the case gives it."""
    rack, relief = drawn_rack(request.scene, request.name)
    return write_rack_dxf(rack, request.folder, file_name(request.name), relief), ()
