"""The solid rack as a STEP file: its outline as splines and lines, raised along its helix, shown to be watertight."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.errors import FegearError
from fegear.fem.plane.gmsh_session import gmsh_session
from fegear.fem.solid.step_model import TOLERANCE, SolidModel, silence
from fegear.geometry.curves import Drawn, smooth_pieces
from fegear.geometry.spline import DEGREE, Spline, enclosed_area, spline_of
from fegear.geometry.toothed_rack import Rack

#: How far the kernel's volume may lie off the section's area times the face width, as a share.
_VOLUME = 1e-7
_MM = 1e3


def write_rack_step(
    path: Path, rack: Rack, pieces: Sequence[Drawn] | None = None, tolerance: float = TOLERANCE
) -> SolidModel:
    """Write a rack with its body as one solid, in millimetres.

    The reference line is y = 0 in the middle of the face z = 0, the first tooth is at x = 0.

    Parameters
    ----------
    path : Path
        Ends in ``.step``.
    rack : Rack
    pieces : sequence of Drawn, optional
        Half of a tooth, relieved; by default as generated.
    tolerance : float
        [modules].

    Raises
    ------
    FegearError
        If the kernel's solid is not closed, or its volume is not that of the section times the face width.
    """
    half = [spline_of(piece, tolerance) for piece in smooth_pieces(pieces or rack.tooth.outline.values())]
    width, expected = rack.face_width, rack.face_width * _area(rack, half)
    with gmsh_session("fegear rack") as gmsh:
        occ = gmsh.model.occ
        try:
            loop = occ.addCurveLoop(_outline(occ, rack, half))
            occ.extrude([(2, occ.addPlaneSurface([loop]))], rack.slide * width * _MM, 0.0, width * _MM)
            occ.synchronize()
        except Exception as problem:
            raise FegearError(f"{path.name}: OpenCASCADE could not create a solid: {problem}") from problem
        solids, faces, edges = (gmsh.model.getEntities(k) for k in (3, 2, 1))
        on = Counter(edge for face in faces for _, edge in gmsh.model.getBoundary([face], oriented=False))
        if len(solids) != 1 or len(on) != len(edges) or any(count != 2 for count in on.values()):
            raise FegearError(f"{path.name}: the surfaces do not close to one solid; not written.")
        volume = occ.getMass(3, solids[0][1]) / _MM**3
        if abs(volume / expected - 1.0) > _VOLUME:
            raise FegearError(
                f"{path.name}: the solid's volume is {volume * _MM**3:.9g} mm^3, and the section's area times the "
                f"face width {expected * _MM**3:.9g} mm^3; not written."
            )
        with silence():
            gmsh.write(str(path))
    return SolidModel(volume, expected, len(faces), len(edges))


def _area(rack: Rack, half: Sequence[Spline]) -> float:
    """Of the section, teeth and body [m^2]: of half a tooth down to the back, twice as often as there are teeth."""
    pitch, back = 0.5 * rack.pitch / rack.module, rack.reference_height / rack.module
    start = half[0].control[0]
    # half the integral of y dx - x dy along the back and up the middle of the space besides
    below = -0.5 * back * pitch - 0.5 * float(start[0]) * (float(start[1]) + back)
    return 2.0 * rack.teeth * abs(enclosed_area(half) + below) * rack.module**2


def _outline(occ: Any, rack: Rack, half: Sequence[Spline]) -> list[int]:
    """Edges of the section counter-clockwise, at the lower end of the face; neighbours share their points."""
    z, scale, pitch = -0.5 * rack.face_width * _MM, rack.module * _MM, rack.pitch * _MM
    lower = rack.slide * z  # way of the section there
    back = -rack.reference_height * _MM
    left = [Spline(s.knots, s.control * np.array([-1.0, 1.0])) for s in half]
    far = (rack.teeth - 0.5) * pitch
    first = occ.addPoint(far + lower, float(half[0].control[0, 1]) * scale, z)
    edges, last = [], first

    def follow(spline: Spline, beside: float, *, backwards: bool) -> None:
        nonlocal last
        control = spline.control[::-1] if backwards else spline.control
        knots = spline.knots[-1] + spline.knots[0] - spline.knots[::-1] if backwards else spline.knots
        values, count = np.unique(knots, return_counts=True)
        points = [occ.addPoint(float(x) * scale + beside + lower, float(y) * scale, z) for x, y in control[1:]]
        edges.append(
            occ.addBSpline([last, *points], degree=DEGREE, knots=values.tolist(), multiplicities=count.tolist())
        )
        last = points[-1]

    for number in range(rack.teeth)[::-1]:
        for spline in half:
            follow(spline, number * pitch, backwards=False)
        for spline in left[::-1]:
            follow(spline, number * pitch, backwards=True)
    corners = [occ.addPoint(x + lower, back, z) for x in (-0.5 * pitch, far)]
    for a, b in zip((last, *corners), (*corners, first), strict=True):
        edges.append(occ.addLine(a, b))
    return edges
