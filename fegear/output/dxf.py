"""DXF drawings of tooth and gear in millimetres: closed polylines, and splines with true arcs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import Array
from fegear.case.built.flank_modifications import described_relief
from fegear.geometry.curves import Arc, Drawn, Line, smooth_pieces
from fegear.geometry.gear import Gear
from fegear.geometry.outline import gear_outline, relieved_outline, tooth_outline, turned
from fegear.geometry.relief import Relief
from fegear.geometry.spline import DEGREE, Spline, spline_of
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.output.export_formats import Request, Written

#: How far chords and splines may lie off the exact curve [modules].
CHORD_TOLERANCE = 1e-4
SPLINE_TOLERANCE = 1e-8
_MM = 1e3
AS_GENERATED = "as generated, without relief"
#: Splines of pieces by the piece's id: one tooth's serve all.
Splines = dict[int, Spline]


def drawing(flanks: str) -> tuple[Any, Any]:
    """A new document in millimetres that says what its flanks are, and its space."""
    import ezdxf
    from ezdxf import units

    document = ezdxf.new("R2010", units=units.MM)
    document.header.custom_vars.append("FLANKS", flanks)
    for layer, colour in (("OUTLINE", 7), ("BORE", 5)):
        document.layers.add(layer, color=colour)
    return document, document.modelspace()


def add_polyline(space: Any, points: Array, layer: str) -> None:
    """Add a closed polyline through points, shape (2, N) [mm]."""
    space.add_lwpolyline([(x, y) for x, y in points.T], close=True, dxfattribs={"layer": layer})


def add_curve(
    space: Any, curve: Drawn, scale: float, turn: float, *, mirrored: bool, known: Splines,
    beside: Array | float = 0.0,
) -> None:  # fmt: skip
    """Add one piece of the outline as the entity that holds it best, mirrored about +y, turned clockwise and moved."""
    side = np.array([[-1.0 if mirrored else 1.0], [1.0]])

    def place(points: Array) -> Array:
        return np.asarray(turned(points * side, turn) * scale + beside)

    layer = {"layer": "OUTLINE"}
    if isinstance(curve, Line):
        a, b = place(curve.points(np.array([curve.start, curve.end]))).T
        space.add_line(tuple(a), tuple(b), dxfattribs=layer)
    elif isinstance(curve, Arc):
        centre = place(np.array(curve.centre)[:, None])[:, 0]
        low, high = sorted((curve.start, curve.end))
        # The curve's angle runs clockwise from +y, DXF's counterclockwise from +x.
        first, last = (math.pi / 2 + low, math.pi / 2 + high) if mirrored else (math.pi / 2 - high, math.pi / 2 - low)
        start, end = math.degrees(first - turn), math.degrees(last - turn)
        space.add_arc(tuple(centre), curve.radius * scale, start, end, dxfattribs=layer)
    else:
        if id(curve) not in known:
            known[id(curve)] = spline_of(curve, SPLINE_TOLERANCE)
        knots, control = known[id(curve)]
        spline = space.add_spline(degree=DEGREE, dxfattribs=layer)
        spline.control_points = [(x, y, 0.0) for x, y in place(control.T).T]
        spline.knots = knots.tolist()


def write_dxf(
    gear: Gear,
    folder: Path,
    name: str,
    relief: Relief | None = None,
    flanks: str = AS_GENERATED,
    back_relief: Relief | None = None,
) -> list[Path]:
    """Write ``<name>_{tooth,gear}_{polyline,spline}.dxf``.

    Parameters
    ----------
    gear : Gear
    folder : Path
    name : str
        Name of the gear.
    relief : Relief, optional
        What is ground off both flanks of every tooth.
    flanks : str
        What the drawings hold, for their property ``FLANKS``.
    back_relief : Relief, optional
        Of asymmetric teeth what is ground off the other flanks; `relief` is then that of the right ones only.

    Returns
    -------
    list of Path
        The tooth is drawn as its sector down to the bore, +y along its centre line; the gear with its bore circle.
    """
    bore, pitch, scale = gear.bore_radius * _MM, 2.0 * math.pi / gear.teeth, gear.module * _MM
    pieces = _pieces(gear, relief)
    back = _pieces(gear.from_the_back, back_relief) if gear.asymmetric else pieces
    sector = tooth_outline(gear.tooth, CHORD_TOLERANCE, pieces, back) * scale
    known: Splines = {}
    ends = turned(np.array([[0.0], [bore]]), pitch / 2), turned(np.array([[0.0], [bore]]), -pitch / 2)
    arc = np.linspace(pitch / 2, -pitch / 2, 33)
    written = []

    def save(document: Any, part: str) -> None:
        written.append(folder / f"{name}_{part}.dxf")
        document.saveas(written[-1])

    document, space = drawing(flanks)
    add_polyline(space, np.hstack([sector, bore * np.stack([np.sin(arc), np.cos(arc)])]), "OUTLINE")
    save(document, "tooth_polyline")

    document, space = drawing(flanks)
    add_polyline(space, gear_outline(gear, CHORD_TOLERANCE, pieces, back) * _MM, "OUTLINE")
    space.add_circle((0.0, 0.0), bore, dxfattribs={"layer": "BORE"})
    save(document, "gear_polyline")

    smooth = smooth_pieces(pieces)
    halves = ((smooth, False), (smooth_pieces(back) if gear.asymmetric else smooth, True))
    document, space = drawing(flanks)
    for curve, mirrored in _one_by_one(halves):
        add_curve(space, curve, scale, 0.0, mirrored=mirrored, known=known)
    for end, corner in zip(ends, (sector[:, -1], sector[:, 0]), strict=True):
        space.add_line(tuple(end[:, 0]), tuple(corner), dxfattribs={"layer": "OUTLINE"})
    low, high = 90.0 - math.degrees(pitch) / 2, 90.0 + math.degrees(pitch) / 2
    space.add_arc((0.0, 0.0), bore, low, high, dxfattribs={"layer": "BORE"})
    save(document, "tooth_spline")

    document, space = drawing(flanks)
    for k in range(gear.teeth):
        for curve, mirrored in _one_by_one(halves):
            add_curve(space, curve, scale, k * pitch, mirrored=mirrored, known=known)
    space.add_circle((0.0, 0.0), bore, dxfattribs={"layer": "BORE"})
    save(document, "gear_spline")
    return written


def _pieces(gear: Gear, relief: Relief | None) -> list[Drawn]:
    return list(gear.tooth.outline.values()) if relief is None else relieved_outline(gear, relief)


def _one_by_one(halves: tuple[tuple[Sequence[Drawn], bool], ...]) -> Iterator[tuple[Drawn, bool]]:
    """Curves of both halves of a tooth in turn, as they are drawn: each right one, mirrored or not."""
    for row in zip_longest(*([(curve, mirrored) for curve in pieces] for pieces, mirrored in halves)):
        yield from (one for one in row if one is not None)


def written_dxf(request: Request) -> Written:
    """Write the drawings of a gear with the relief that the case gives it."""
    name, found = request.name, described_relief(request.scene, request.name)
    back = described_relief(request.scene, request.name, back=True).relief if request.gear.asymmetric else found.relief
    if found.relief is None and back is None:
        flanks = AS_GENERATED
    elif request.gear.asymmetric:
        working = [one is not None for one in (found.relief, back)]
        seen = request.gear, request.gear.from_the_back
        ground = [str(one.tooth.working_flank) for one, on in zip(seen, working, strict=True) if on]
        flanks = f"with the relief of the case, {' and '.join(sorted(ground, reverse=True))} flank"
    else:
        flanks = "with the relief of the case, both flanks"
    flanks += f", as in pair {found.pair}" if found.pair else ""
    spur = name in request.scene.spur_gears
    remarks = () if spur else (f"Gear {name}, DXF: transverse section.",)
    return write_dxf(request.gear, request.folder, file_name(name), found.relief, flanks, back), remarks
