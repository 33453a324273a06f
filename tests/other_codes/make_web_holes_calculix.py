"""Write web_holes_calculix.json: whole gears with holes in their web by CalculiX, under load (run by hand).

python tests/other_codes/make_web_holes_calculix.py [below|between|off]...

Quadratic wedges and hexahedra, all sides joined node by node; 16 teeth and six holes, which have half a turn in common.
One core takes some ten minutes for each load.
"""

import json
import sys
import tempfile
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix

from fegear.fem.plane import gear_section as plane
from fegear.fem.plane.boundary import sector_boundary
from fegear.fem.plane.holed_ring import holed_ring
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.fem.solid.extruded import extruded, pressed_band
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear_body import GearBody, WebHoles
from fegear.geometry.outline import turned
from fegear.geometry.rack import BasicRack

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "web_holes_calculix.json"
TOOTH, BORE, FACE = Tooth(16, BasicRack(1.0, 1.25, 0.25), 0.2), 2.0, 4.0
RADIUS, PLACES = 8.2, (-2.0, -1.0, 0.0, 1.0, 2.0)
COUNT, CIRCLE, HOLE = 6, 4.35, 0.9
#: The web's part of the face, and by how many of the 96 edges round the rim the first hole is turned from tooth 0: the
#: loaded tooth stands above a hole, between two, or a quarter of the way from one to the next.
KINDS = {"below": ((-0.5, 0.5), 0), "between": ((-0.5, 0.5), 8), "off": ((-1.5, -0.5), 4)}
EDGES, OTHERS, ROUND = 1.3, 2.8, 6
STATIONS = {
    "middle": [-2, -1.9, -1.5, -1.25, -1, -0.6, -0.5, -0.4, 0, 0.4, 0.5, 0.6, 1, 1.25, 1.5, 1.9, 2],
    "off": [-2, -1.9, -1.6, -1.5, -1.4, -1, -0.6, -0.5, -0.4, 0, 0.25, 0.5, 1, 1.25, 1.5, 1.9, 2],
}  # fmt: skip


def body(which):
    """The body of one kind."""
    web, edges = KINDS[which]
    holes = WebHoles(COUNT, CIRCLE, HOLE, 2.0 * np.pi * edges / (ROUND * TOOTH.teeth))
    return GearBody(5.7, 3.0, web, (-2.0, 2.0), holes=holes)


def section_of(which):
    """The whole plane section: teeth with their rim, the ring with holes, and the hub."""
    shape, whole = body(which), ROUND * TOOTH.teeth
    rim = rim_section(shape)
    edge = 2.0 * np.pi * shape.rim_radius / whole
    part = holed_ring(COUNT, (shape.hub_radius, shape.rim_radius), CIRCLE, HOLE, 1.0001 * edge, 3)
    mesh = part.mesh
    kept = replace_triangles(mesh, mesh.triangles[:, ~part.filled])
    three, four = plane.paired(kept)
    pieces = [(rim.points, rim.triangles, rim.quadrilaterals)]
    for i in range(COUNT):
        pieces.append((turned(mesh.points, shape.holes.angle + 2.0 * np.pi * i / COUNT), three, four))
    hub = hub_grid(np.arange(whole) * 2.0 * np.pi / whole, np.linspace(shape.hub_radius, BORE, 4))
    pieces.append((hub[0], np.zeros((6, 0), dtype=np.int64), hub[1]))
    points, triangles, quadrilaterals = [], [], []
    count = 0
    for place, three_, four_ in pieces:
        points.append(place)
        triangles.append(three_ + count)
        quadrilaterals.append(four_ + count)
        count += place.shape[1]
    every = np.hstack(points)
    close = cKDTree(every.T).query_pairs(1e-7, output_type="ndarray")
    merged = np.arange(count)
    for a, b in close[np.argsort(close.max(axis=1))]:
        merged[max(a, b)] = min(merged[a], merged[b])
    triangles, quadrilaterals = merged[np.hstack(triangles)], merged[np.hstack(quadrilaterals)]
    used = np.unique(np.concatenate([triangles.ravel(), quadrilaterals.ravel()]))
    number = np.full(count, -1)
    number[used] = np.arange(used.size)
    boundaries = {key: number[merged[edges]] for key, edges in rim.boundaries.items() if key[0] != "bore"}
    last = sum(p.shape[1] for p, _, _ in pieces[:-1])
    boundaries["bore", 0] = number[merged[hub[2] + last]]
    return plane.Section(every[:, used], number[triangles], number[quadrilaterals], boundaries, TOOTH.teeth, True)


def replace_triangles(mesh, triangles):
    """The mesh with some of its triangles alone."""
    return replace(mesh, triangles=triangles.copy())


def rim_section(shape):
    """Teeth and rim, tooth 0 fine, with so many edges round the rim's inside."""
    kinds = []
    settings = [plane._settings(f, *edges) for f, edges in zip((EDGES, OTHERS, OTHERS), plane._EDGES, strict=True)]
    for share in np.linspace(0.2, 0.6, 161):
        chains = sector_boundary(TOOTH, shape.rim_radius, replace(settings[0], rim_fraction=share))
        if next(c for c in chains if c.name == "bore").middles.shape[1] == ROUND:
            break
    boundaries = [chains, *(sector_boundary(TOOTH, shape.rim_radius, kind) for kind in settings[1:])]
    shared = {chain.name: chain for chain in chains if chain.name in plane._SHARED}
    kinds = [
        mesh_inside([shared.get(c.name, c) for c in own], TOOTH.teeth, growth=kind.side_growth)
        for own, kind in zip(boundaries, settings, strict=True)
    ]
    first = -((TOOTH.teeth - 1) // 2)
    return plane.gear_section({k: kinds[min(abs(k), 2)] for k in range(first, first + TOOTH.teeth)})


def hub_grid(angles, radii):
    """Quadrilaterals between circles: points, elements and the innermost edges; edges bend with their circles."""
    n, step = angles.size, angles[1] - angles[0]
    at = [(r, a) for r in radii for a in angles]
    at += [(r, a + 0.5 * step) for r in radii for a in angles]
    at += [(0.5 * (r + s), a) for r, s in pairwise(radii) for a in angles]
    points = np.array([(r * np.sin(a), r * np.cos(a)) for r, a in at]).T
    m = radii.size
    own, arc, rise = (np.arange(k * n).reshape(k, n) + start for k, start in ((m, 0), (m, m * n), (m - 1, 2 * m * n)))
    right = np.roll(np.arange(n), -1)
    four = [own[1:], own[1:, right], own[:-1, right], own[:-1], arc[1:], rise[:, right], arc[:-1], rise]
    return points, np.stack(four).reshape(8, -1), np.stack([own[-1], own[-1, right], arc[-1]])


def hat(place):
    """Where the hat of a band rises and falls."""
    return max(place - 0.5, -2.0), place, min(place + 0.5, 2.0)


def under_load(which):
    """Deflections between bands, and the largest root tension along the face of each."""
    calculix.TOOTH, calculix.BORE = TOOTH, BORE
    shape = body(which)
    stations = STATIONS["off" if which == "off" else "middle"]
    mesh = extruded(section_of(which), np.array(stations, dtype=float), 0.0, shape)
    bands = {f"{p:g}": pressed_band(mesh, TOOTH, RADIUS, 0.25, hat(p), 0) for p in PLACES}
    # What is alike to both sides of the middle is loaded on one.
    loaded = tuple(bands)[: None if which == "off" else len(PLACES) // 2 + 1]
    with tempfile.TemporaryDirectory() as folder:
        moved = calculix.solve(Path(folder), "g", mesh, bands, loaded)
    deflection = [[calculix.deflection(moved[a], bands[b]) for b in bands] for a in loaded]
    tension = [calculix.largest_along(mesh, moved[a], "fillet", 1).tolist() for a in loaded]
    for a in reversed(range(len(PLACES) - len(loaded))):
        deflection.append(deflection[a][::-1])
        tension.append(tension[a][::-1])
    nodes = np.unique(np.concatenate([mesh.wedges.ravel(), mesh.hexahedra.ravel()])).size
    return {"nodes": int(nodes), "deflection": deflection, "tension": tension}


if __name__ == "__main__":
    for which in sys.argv[1:] or KINDS:
        known = json.loads(FILE.read_text()) if FILE.exists() else {}
        known[which] = under_load(which)
        FILE.write_text(json.dumps(known, indent=1) + "\n")
