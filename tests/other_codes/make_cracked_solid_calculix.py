"""Write cracked_solid_calculix.json: half of a whole cracked spur gear with a width in CalculiX (by hand).

python -m tests.other_codes.make_cracked_solid_calculix

Wedges of 15 nodes between layers of the plane mesh of `tests/helpers/cracked_gear.py`, the middle of the face a plane
of symmetry; loads are even along the face, at one radius of the flank of the cracked tooth and of the next one. Edges
are short on these teeth and long on all others. The section alone (plane strain) shows what the mesh leaves: with edges
of 0.3 modules everywhere, 0.12 of the crack at its tip, c_00 was 2e-3 of itself too small, with these it is 2e-4.
"""

import itertools
import json
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from tests.helpers.cracked_gear import cracked_gear, turned
from tests.other_codes.test_cracked_gear_other_codes import gear

NAME, NU = "19 teeth", 0.3
#: Edges of teeth -1 to 1, of their fillets, at the crack's tip (a share of its length), of the others over 0.4 modules.
SIZE, FILLET, TIP, FACTOR = 0.09, 0.04, 0.015, 3.0
#: Half of the face width, and heights of the layers from its middle [modules].
HALF, LAYERS = 1.5, (0.0, 0.7, 1.2, 1.5)
LOADED = ((0, 1), (1, 1))
#: Fillets whose surface stress is read: tooth, whether on the loaded flank.
FILLETS = ((-1, True), (0, True), (0, False), (1, True), (1, False))
#: Where along an edge, and up the lowest layer, stress of quadratic elements is best.
GAUSS = (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0))


def toward(tooth, point):
    """Unit vector along the line of action, into the tooth."""
    x, y = point
    angle = math.atan2(x, y) - math.acos(tooth.base_radius / math.hypot(x, y))
    return np.array([-math.cos(angle), math.sin(angle)])


def wedges(points, six):
    """Numbers of the nodes of every level, places, and elements of 15 nodes."""
    vertices = np.unique(six[:3])
    levels = np.interp(np.arange(2 * len(LAYERS) - 1) / 2.0, np.arange(len(LAYERS)), LAYERS)
    number, places = [], []
    for level, z in enumerate(levels):
        own = np.full(points.shape[1], -1)
        used = np.arange(points.shape[1]) if level % 2 == 0 else vertices
        own[used] = len(places) + np.arange(used.size)
        places += [(*points[:, n], z) for n in used]
        number.append(own)
    elements = []
    for low in range(0, len(levels) - 1, 2):
        bottom, middle, top = (one[six] for one in number[low : low + 3])
        elements.append(np.vstack([bottom[:3], top[:3], bottom[3:], top[3:], middle[:3]]))
    return number, np.array(places), np.hstack(elements)


def along_face(number, node):
    """Nodes of a line along the half face, and what each has of a unit force that is even along it."""
    found = {}
    for low, height in zip(range(0, len(number) - 1, 2), np.diff(LAYERS), strict=True):
        for step, weight in zip(range(3), (1.0, 4.0, 1.0), strict=True):
            at = int(number[low + step][node])
            found[at] = found.get(at, 0.0) + weight / 6.0 * height / HALF
    return found


def fillet_faces(tooth, points, six, k, loaded):
    """Edges of a fillet, (3, n) nodes of the section: first, last, middle one; and its curve, (2, 40001)."""
    curve = tooth.outline["fillet"]
    line = curve.points(np.linspace(curve.start, curve.end, 40001)) * np.array([[1.0 if loaded else -1.0], [1.0]])
    line = turned(line, 2.0 * math.pi * k / tooth.teeth)
    edges = np.hstack([six[[a, b, m]] for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5))])
    _, first, count = np.unique(edges[2], return_index=True, return_counts=True)
    edges = edges[:, first[count == 1]]
    low, high = line.min(axis=1, keepdims=True) - 1e-4, line.max(axis=1, keepdims=True) + 1e-4
    beside = points[:, edges[2]]
    edges = edges[:, ((beside > low) & (beside < high)).all(axis=0)]
    away = np.array([np.hypot(*(line - at[:, None])).min() for at in points[:, edges[2]].T])
    return edges[:, away < 1e-4], line


def surface_stress(points, edges, line, number, moved):
    """Places up a fillet, as a share of its points, and stress along it at `GAUSS` of the lowest layer's faces."""
    place, found = [], []
    height, t = LAYERS[1] - LAYERS[0], GAUSS[0]
    ends, middles = edges[:2], edges[2]
    for s in GAUSS:
        # Faces of eight nodes: those of the edge at either end of the layer, its ends halfway.
        a, b, c, d = (1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t
        by_s = {
            (0, 0): -(1 - t) * (1 - 2 * s - 2 * t) - 2 * a, (0, 1): (1 - t) * (2 * s - 2 * t - 1) + 2 * b,
            (2, 1): t * (2 * s + 2 * t - 3) + 2 * c, (2, 0): -t * (2 * t - 2 * s - 1) - 2 * d,
            (0, 2): 4 * (1 - 2 * s) * (1 - t), (2, 2): 4 * (1 - 2 * s) * t,
            (1, 0): -4 * t * (1 - t), (1, 1): 4 * t * (1 - t),
        }  # fmt: skip
        by_t = {
            (0, 0): -(1 - s) * (1 - 2 * s - 2 * t) - 2 * a, (0, 1): -s * (2 * s - 2 * t - 1) - 2 * b,
            (2, 1): s * (2 * s + 2 * t - 3) + 2 * c, (2, 0): (1 - s) * (2 * t - 2 * s - 1) + 2 * d,
            (0, 2): -4 * s * (1 - s), (2, 2): 4 * s * (1 - s),
            (1, 0): 4 * (1 - s) * (1 - 2 * t), (1, 1): 4 * s * (1 - 2 * t),
        }  # fmt: skip

        def of(level, at):
            return number[level][middles if at == 2 else ends[at]]

        along = sum(points[:, middles if at == 2 else ends[at]] * w for (_, at), w in by_s.items())
        size = np.hypot(*along)
        stretch = (sum(moved[of(*key)][:, :2].T * w for key, w in by_s.items()) * along).sum(axis=0) / size**2
        axial = sum(moved[of(*key)][:, 2] * w for key, w in by_t.items()) / height
        found.append((stretch + NU * axial) / (1.0 - NU**2))
        at = points[:, ends[0]] * (1 - s) * (1 - 2 * s) + points[:, ends[1]] * s * (2 * s - 1)
        at = at + points[:, middles] * 4 * s * (1 - s)
        place.append(np.array([np.hypot(*(line - one[:, None])).argmin() for one in at.T]))
    place, order = np.concatenate(place) / line.shape[1], np.argsort(np.concatenate(place))
    return place[order], np.concatenate(found)[order]


def largest(place, stress, sign):
    """Largest value of a smooth curve through the places around it."""
    close = np.sort(np.abs(place - place[(sign * stress).argmax()]).argsort()[:12])
    middle, low, high = place[close].mean(), place[close].min(), place[close].max()
    # Beyond the last of these places there is a part of an edge: the largest value may be at the fillet's end.
    low, high = 0.0 if low == place.min() else low, 1.0 if high == place.max() else high
    curve = np.polynomial.Polynomial.fit(place[close] - middle, stress[close], 4)
    return float(sign * (sign * curve(np.linspace(low - middle, high - middle, 401))).max())


def made():
    """Mean deflections of places under unit forces on half of the face, halved: those of a unit force on all of it."""
    tooth, bore, crack, radii = gear(NAME)
    points, six, nodes = cracked_gear(
        tooth, bore, crack.path(tooth), radii, SIZE / FACTOR, TIP / FACTOR, FILLET / FACTOR, factor=FACTOR
    )
    number, places, elements = wedges(points, six)
    held = np.flatnonzero(np.abs(np.hypot(*places[:, :2].T) - bore) < 1e-6 * bore)
    middle = np.flatnonzero(places[:, 2] == 0.0)
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(places, 1))]
    deck += ["*ELEMENT, TYPE=C3D15, ELSET=GEAR"]
    deck += [", ".join(map(str, [i, *(one + 1)])) for i, one in enumerate(elements.T, 1)]
    deck += ["*MATERIAL, NAME=M", "*ELASTIC", f"1.0, {NU}", "*SOLID SECTION, ELSET=GEAR, MATERIAL=M"]
    deck += ["*BOUNDARY", *(f"{n + 1}, 1, 3" for n in held), *(f"{n + 1}, 3, 3" for n in middle)]
    lines = {key: (along_face(number, node), toward(tooth, points[:, node])) for key, node in nodes.items()}
    faces = {key: fillet_faces(tooth, points, six, *key) for key in FILLETS}
    seen = {n for line, _ in lines.values() for n in line}
    seen |= {int(n) for edges, _ in faces.values() for one in number[:3] for n in one[edges].ravel() if n >= 0}
    seen = sorted(seen)
    deck += ["*NSET, NSET=SEEN", *(str(n + 1) for n in seen)]
    for key in LOADED:
        line, way = lines[key]
        deck += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
        deck += [f"{n + 1}, {c + 1}, {share * way[c]:.12e}" for n, share in line.items() for c in range(2)]
        deck += ["*NODE PRINT, NSET=SEEN", "U", "*END STEP"]
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "gear.inp").write_text("\n".join([*deck, ""]))
        subprocess.run(["ccx", "gear"], cwd=name, check=True, stdout=subprocess.DEVNULL)
        rows = [line.split() for line in (Path(name) / "gear.dat").read_text().splitlines()]
    rows = [row for row in rows if len(row) == 4 and row[0].isdigit()]
    found, roots = {}, {}
    for step, (j, q) in enumerate(LOADED):
        moved = np.full((len(places), 3), np.nan)
        for n, *u in rows[step * len(seen) : (step + 1) * len(seen)]:
            moved[int(n) - 1] = [float(value) for value in u]
        for (i, p), (line, way) in lines.items():
            if (i, p) != (j, q):
                value = sum(share * float(way @ moved[n, :2]) for n, share in line.items())
                found[f"{i} {p} {j} {q}"] = 0.5 * value
        for (i, loaded), (edges, line) in faces.items():
            if j not in (0, i):  # nothing but round-off of the smallest
                continue
            place, stress = surface_stress(points, edges, line, number, moved)
            sign = 1.0 if loaded else -1.0
            ends = [0.0, 1.0]
            if i == 0 and loaded:  # the crack's mouth parts its fillet
                ends.insert(1, float(np.hypot(*(line - crack.path(tooth)[:, :1])).argmin() / line.shape[1]))
            pieces = [(place > low) & (place < high) for low, high in itertools.pairwise(ends)]
            value = sign * max(sign * largest(place[on], stress[on], sign) for on in pieces)
            roots[f"{i} {'tension' if loaded else 'compression'} {j} {q}"] = 0.5 * value
    z = GAUSS[0] * LAYERS[1]
    return {"gear": NAME, "width": 2.0 * HALF, "size": SIZE, "nodes": len(places), "c": found, "z": z, "root": roots}


if __name__ == "__main__":
    (Path(__file__).parent / "cracked_solid_calculix.json").write_text(json.dumps(made(), indent=1) + "\n")
