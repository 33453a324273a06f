"""The solid gear as a boundary of spline surfaces: a STEP file from gmsh's OpenCASCADE kernel, shown to be watertight.

Every face is a tensor product: the control points of a piece of the outline, turned and lifted by those of the helix.
The helix is the same for all of them, so that neighbours share their edges to round-off, whatever the tolerance is.
"""

from __future__ import annotations

import math
import os
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import FegearError
from fegear.fem.plane.gmsh_session import gmsh_session
from fegear.geometry.curves import Drawn, smooth_pieces
from fegear.geometry.gear import Gear
from fegear.geometry.spline import DEGREE, Spline, enclosed_area, fitted, spline_of

#: How far the surfaces may lie off the exact ones [modules]: some ten nanometres.
TOLERANCE = 1e-5
#: How far the kernel's volume may lie off the section's area times the face width, as a share.
_VOLUME = 1e-7
_MM = 1e3


#: Processor seconds of a gear: to begin with, for each tooth, and for each two of them: one core, 20 to 150 teeth.
_SECONDS = (1.0, 0.06, 4.6e-4)


def seconds_of_step(teeth: int) -> float:
    """About how many seconds the file of a gear takes."""
    return _SECONDS[0] + teeth * (_SECONDS[1] + teeth * _SECONDS[2])


class SolidModel(NamedTuple):
    """What was written, and what shows that it is one closed solid.

    Attributes
    ----------
    volume : float
        Of the kernel's solid [m^3].
    expected : float
        Area of the section times the face width [m^3].
    faces, edges : int
        Every edge lies on two faces.
    """

    volume: float
    expected: float
    faces: int
    edges: int


def write_step(
    path: Path,
    gear: Gear,
    pieces: Sequence[Drawn] | None = None,
    tolerance: float = TOLERANCE,
    back: Sequence[Drawn] | None = None,
) -> SolidModel:
    """Write the whole gear with its bore as one solid, in millimetres, the axis along z and the face from -b/2 to b/2.

    Parameters
    ----------
    path : Path
        Ends in ``.step``.
    gear : Gear
        Spur or helical.
    pieces : sequence of Drawn, optional
        Another right half of the outline than the generated one, see `relieved_outline`; of equal flanks another left
        half, too.
    tolerance : float
        [modules].
    back : sequence of Drawn, optional
        Of asymmetric teeth another left half, as seen from its own flank.

    Returns
    -------
    SolidModel

    Raises
    ------
    FegearError
        If the kernel's solid is not closed, or its volume is not that of the section times the face width.
    """
    outline = smooth_pieces(pieces or gear.tooth.outline.values())
    scale, half = gear.module * _MM, 0.5 * gear.face_width * _MM
    right = [spline_of(piece, tolerance) for piece in outline]
    behind = right
    if gear.asymmetric:
        behind = [spline_of(piece, tolerance) for piece in smooth_pieces(back or gear.tooth.back.outline.values())]
    left = [Spline(s.knots, s.control * np.array([-1.0, 1.0])) for s in behind]
    helix = fitted(lambda z: _turn(gear, z), -half, half, tolerance / gear.tooth.tip_radius)
    bore = gear.bore_radius * _MM
    tooth = enclosed_area(right) + enclosed_area(behind)
    area = abs(abs(tooth) * gear.teeth * scale**2 - math.pi * bore**2)
    with gmsh_session("fegear solid") as gmsh:
        try:
            _build(gmsh.model.occ, gear, (*left, *right), scale, helix, bore, len(left))
            solid = _alone(gmsh, path)
        except Exception as problem:
            raise FegearError(f"{path.name}: OpenCASCADE could not create a solid: {problem}") from problem
        volume, expected = gmsh.model.occ.getMass(3, solid) / _MM**3, area * 2.0 * half / _MM**3
        made = SolidModel(volume, expected, *_closed(gmsh, path.name))
        if abs(volume / expected - 1.0) > _VOLUME:
            raise FegearError(
                f"{path.name}: the solid's volume is {volume * _MM**3:.9g} mm^3, and the section's area times the "
                f"face width {expected * _MM**3:.9g} mm^3; not written."
            )
        with silence():
            gmsh.write(str(path))
    return made


def _build(
    occ: Any, gear: Gear, tooth: Sequence[Spline], scale: float, helix: Spline, bore: float, half: int = 1
) -> None:
    """The solid from the splines of one tooth's left and right half, beside what it was sewn from.

    The first `half` of them are those of the left one.
    """
    height = gear.face_width * _MM
    flanks = _around(occ, [(2, _surface(occ, s, scale, helix)) for s in tooth], gear.teeth)
    low = _around(occ, [(1, _edge(occ, s, scale, helix)) for s in tooth], gear.teeth)
    edges = [edge for ring in low for edge in ring]
    high = occ.copy(edges)
    occ.rotate(high, 0, 0, 0, 0, 0, 1, gear.face_width * gear.twist)
    occ.translate(high, 0, 0, height)
    rings = low, [high[k : k + len(tooth)] for k in range(0, len(high), len(tooth))]
    circle = occ.addCircle(0.0, 0.0, -0.5 * height, bore)
    other, wall = occ.extrude([(1, circle)], 0.0, 0.0, height)[:2]
    inward = -1 if gear.tooth.internal else 1  # the outer loop of a face comes first: the teeth, or a ring's circle
    caps = [
        (2, occ.addPlaneSurface([occ.addCurveLoop(_loop(ring, half)), occ.addCurveLoop([hole])][::inward]))
        for ring, hole in zip(rings, (circle, other[1]), strict=True)
    ]
    parts = [*(face for one in flanks for face in one), *caps, wall]
    occ.addVolume([occ.addSurfaceLoop([tag for _, tag in parts], sewing=True)])


def _alone(gmsh: Any, path: Path) -> int:
    """The solid in an empty model, its tag: taking away what it was sewn from takes a time that grows with its square.

    It goes there through a file in OpenCASCADE's own format, from which only what has the highest dimension is read.
    """
    with tempfile.TemporaryDirectory(prefix=".", dir=path.parent) as folder, silence():
        kept = str(Path(folder) / "sewn.brep")
        gmsh.model.occ.synchronize()
        gmsh.write(kept)
        gmsh.model.remove()
        gmsh.model.add("fegear solid alone")
        ((_, solid),) = gmsh.model.occ.importShapes(kept, highestDimOnly=True)
    gmsh.model.occ.synchronize()
    return int(solid)


def _turn(gear: Gear, z: Array) -> Array:
    """cos, sin and height of the section at z [mm], shape (3, N)."""
    angle = gear.twist * z / _MM
    return np.stack([np.cos(angle), np.sin(angle), z])


def _raised(spline: Spline, scale: float, helix: Spline) -> Array:
    """Control points (heights, M, 3) [mm] of a section's spline [modules] carried along the helix."""
    section = scale * (spline.control[:, 0] + 1j * spline.control[:, 1])
    across = np.multiply.outer(helix.control[:, 0] + 1j * helix.control[:, 1], section)
    height = np.broadcast_to(helix.control[:, 2:], across.shape)
    return np.stack([across.real, across.imag, height], axis=-1)


def _knots(spline: Spline) -> tuple[list[float], list[int]]:
    values, count = np.unique(spline.knots, return_counts=True)
    return values.tolist(), count.tolist()


def _points(occ: Any, points: Array) -> list[int]:
    return [occ.addPoint(*p) for p in points.reshape(-1, 3).tolist()]


def _surface(occ: Any, spline: Spline, scale: float, helix: Spline) -> int:
    points = _points(occ, _raised(spline, scale, helix))
    (u, many_u), (v, many_v) = _knots(spline), _knots(helix)
    tag = occ.addBSplineSurface(
        points, len(spline.control), degreeU=DEGREE, degreeV=DEGREE, knotsU=u, knotsV=v, multiplicitiesU=many_u,
        multiplicitiesV=many_v,
    )  # fmt: skip
    occ.remove([(0, p) for p in points])
    return int(tag)


def _edge(occ: Any, spline: Spline, scale: float, helix: Spline) -> int:
    """The lower edge of the same surface."""
    points = _points(occ, _raised(spline, scale, helix)[0])
    values, count = _knots(spline)
    tag = occ.addBSpline(points, degree=DEGREE, knots=values, multiplicities=count)
    occ.remove([(0, p) for p in points])
    return int(tag)


def _around(occ: Any, one: list[tuple[int, int]], teeth: int) -> list[list[tuple[int, int]]]:
    """The shapes of one tooth and their copies, tooth by tooth counter-clockwise."""
    found = [one]
    for k in range(1, teeth):
        copies = occ.copy(one)
        occ.rotate(copies, 0, 0, 0, 0, 0, 1, 2.0 * math.pi * k / teeth)
        found.append(copies)
    return found


def _loop(ring: list[list[tuple[int, int]]], half: int) -> list[int]:
    """Edges of all teeth clockwise: left half to the tip, right half back to the space, on to the next tooth."""
    tags: list[int] = []
    for tooth in (ring[0], *ring[:0:-1]):
        tags += [tag for _, tag in (*tooth[:half], *tooth[: half - 1 : -1])]
    return tags


def _closed(gmsh: Any, name: str) -> tuple[int, int]:
    """Numbers of faces and edges of the only solid, whose edges all lie on two faces."""
    faces, edges = gmsh.model.getEntities(2), gmsh.model.getEntities(1)
    # The bore's wall meets itself in a seam, which bounds nothing and is not told.
    on = Counter(e for face in faces for _, e in gmsh.model.getBoundary([face], oriented=False))
    single = len(gmsh.model.getEntities(3)) == 1 and len(on) == len(edges) - 1
    if not single or any(count != 2 for count in on.values()):
        free = sum(count != 2 for count in on.values())
        raise FegearError(f"{name}: the surfaces do not close to one solid ({free} free edges); not written.")
    return len(faces), len(edges)


@contextmanager
def silence() -> Iterator[None]:
    """Send what the kernel prints on the process's own standard output nowhere."""
    sys.stdout.flush()
    kept, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(null)
