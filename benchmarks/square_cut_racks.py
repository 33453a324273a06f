"""How far the ends of helical racks matter: cut square, or along the helix as fegear's are; tetrahedra by CalculiX.

Run as ``python benchmarks/square_cut_racks.py [FACE_WIDTH] [COARSENESS]`` (in modules; 5 and 1.1): deflections of a
band on the first two teeth, at both ends of the face and in its middle, and their ratio. Both racks have one volume.
Module, force and Young's modulus are 1.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from fegear.fem.plane.gmsh_session import gmsh_session
from fegear.geometry.curves import Line
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_tooth import RackTooth

TEETH, BODY, POISSON = 4, 2.0, 0.3
TOOTH = RackTooth(BasicRack(), helix_angle=math.radians(20.0))
SLIDE, BACK = -math.tan(TOOTH.helix_angle), TOOTH.root_height - BODY
#: Height of the band, half-width of its semi-elliptic pressure, half its length along the face; finest edges.
HEIGHT, HALF_WIDTH, HALF_LENGTH, FINEST = 0.2, 0.25, 0.6, 0.09
#: Teeth beyond either end before a rack is cut square.
BEYOND = 3
#: Faces whose nodes are so near to a flank lie on it.
NEAR = 1e-6


def outline(first, last):
    """Corners of the section from the left to the right, shape (n, 2)."""
    half = np.vstack([
        curve.points(np.linspace(curve.start, curve.end, 2 if isinstance(curve, Line) else 9)).T
        for curve in TOOTH.outline.values()
    ])  # fmt: skip
    half = half[np.append(True, np.hypot(*np.diff(half, axis=0).T) > 1e-9)]
    up, down = half * [-1, 1], half[::-1]
    teeth = [np.vstack([up[:-1], down[:-1]]) + np.array([k * TOOTH.pitch, 0.0]) for k in range(first, last + 1)]
    return np.vstack([*teeth, half[:1] + np.array([last * TOOTH.pitch, 0.0])])


def meshed(square, width, coarseness, place):
    """Nodes, tetrahedra and faces of second order, fine about a place."""
    more = BEYOND if square else 0
    corners = outline(-more, TEETH - 1 + more)
    with gmsh_session("square") as gmsh:
        occ, low = gmsh.model.occ, -0.5 * width
        bottom = [(corners[-1, 0], BACK), (corners[0, 0], BACK)]
        points = [occ.addPoint(x + SLIDE * low, y, low) for x, y in [*corners, *bottom]]
        lines = [occ.addLine(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True)]
        drawn = occ.extrude([(2, occ.addPlaneSurface([occ.addCurveLoop(lines)]))], SLIDE * width, 0.0, width)
        if square:
            box = occ.addBox(-0.5 * TOOTH.pitch, BACK - 1.0, -width, TEETH * TOOTH.pitch, 10.0, 2.0 * width)
            occ.intersect([one for one in drawn if one[0] == 3], [(3, box)])
        occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 2.0)
        gmsh.model.mesh.setSizeCallback(
            lambda _dim, _tag, x, y, z, _size: (
                coarseness * min(FINEST + 0.22 * max(math.dist((x, y, z), place) - 0.5, 0.0), 1.1)
            )
        )
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        tags, places, _ = gmsh.model.mesh.getNodes()
        number = np.zeros(int(tags.max()) + 1, dtype=int)
        number[tags.astype(int)] = np.arange(tags.size)
        solid, faces = (
            number[gmsh.model.mesh.getElements(dim)[2][0].astype(int)].reshape(-1, n) for dim, n in ((3, 10), (2, 6))
        )
    return places.reshape(-1, 3), solid, faces


def band(points, faces, tooth, top):
    """Nodal forces of a unit force along the line of action on the right flank of a tooth, shape (nodes, 3)."""
    start, end = TOOTH.involute.points(np.array([TOOTH.involute.start, TOOTH.involute.end])).T
    along = (end - start) / np.hypot(*(end - start))
    section = np.stack([points[:, 0] - SLIDE * points[:, 2] - tooth * TOOTH.pitch, points[:, 1]], axis=1)
    off = np.abs((section - start) @ [along[1], -along[0]])
    on = (off[faces] < NEAR).all(axis=1) & (points[faces][:, :, 1] > start[1] - NEAR).all(axis=1)
    cos, sin = math.cos(TOOTH.pressure_angle), math.sin(TOOTH.pressure_angle)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    share, total = np.zeros(len(points)), 0.0
    for face in faces[on]:
        corner = points[face]
        area = np.linalg.norm(np.cross(corner[1] - corner[0], corner[2] - corner[0]))
        for s, first in zip(0.5 * (nodes + 1.0), weights, strict=True):
            for b, second in zip(0.5 * (nodes + 1.0), weights, strict=True):
                t = b * (1.0 - s)
                r = 1.0 - s - t
                shape = np.array([r * (2 * r - 1), s * (2 * s - 1), t * (2 * t - 1), 4 * r * s, 4 * s * t, 4 * t * r])
                _, y, z = shape @ corner
                pressure = math.sqrt(max(1.0 - ((y - HEIGHT) / cos / HALF_WIDTH) ** 2, 0.0))
                pressure *= max(1.0 - abs(z - top) / HALF_LENGTH, 0.0)
                part = 0.25 * first * second * (1.0 - s) * area * pressure
                share[face] += part * shape
                total += part
    return np.multiply.outer(share / total, [-cos, -sin, SLIDE * cos])


def deflection(folder, square, width, coarseness, tooth, top):
    """Mean deflection of a band under itself."""
    start, end = TOOTH.involute.points(np.array([TOOTH.involute.start, TOOTH.involute.end])).T
    place = 0.5 * (start[0] + end[0]) + tooth * TOOTH.pitch + SLIDE * top, HEIGHT, top
    points, solid, faces = meshed(square, width, coarseness, place)
    forces = band(points, faces, tooth, top)
    loaded, held = np.flatnonzero(forces.any(axis=1)), np.flatnonzero(np.abs(points[:, 1] - BACK) < NEAR)
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.10e}, {y:.10e}, {z:.10e}" for i, (x, y, z) in enumerate(points, 1))]
    deck.append("*ELEMENT, TYPE=C3D10, ELSET=E")
    deck += [", ".join(map(str, [i, *e])) for i, e in enumerate(solid[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]] + 1, 1)]
    deck += ["*NSET, NSET=HELD", *map(str, held + 1), "*NSET, NSET=LOADED", *map(str, loaded + 1)]
    deck += ["*MATERIAL, NAME=M", "*ELASTIC", f"1.0, {POISSON}", "*SOLID SECTION, ELSET=E, MATERIAL=M"]
    deck += ["*BOUNDARY", "HELD, 1, 3", "*STEP", "*STATIC", "*CLOAD"]
    deck += [f"{n + 1}, {c + 1}, {forces[n, c]:.10e}" for n in loaded for c in range(3)]
    deck += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP", ""]
    (folder / "rack.inp").write_text("\n".join(deck))
    subprocess.run(["ccx", "rack"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    rows = [line.split() for line in (folder / "rack.dat").read_text().splitlines()]
    return sum(
        float(forces[int(r[0]) - 1] @ np.array(r[1:], dtype=float)) for r in rows if len(r) == 4 and r[0].isdigit()
    )


if __name__ == "__main__":
    width, coarseness = (float(given) for given in (sys.argv[1:] + ["5", "1.1"][len(sys.argv) - 1 :])[:2])
    for tooth in (0, 1):
        for top in (0.5 - 0.5 * width, 0.0, 0.5 * width - 0.5):
            with tempfile.TemporaryDirectory() as folder:
                helical, square = (
                    deflection(Path(folder), cut, width, coarseness, tooth, top) for cut in (False, True)
                )
            print(f"tooth {tooth + 1}, z {top:+.2f}: {helical:.4f} {square:.4f} {100 * (square / helical - 1):+.1f} %")
