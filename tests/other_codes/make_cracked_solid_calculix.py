"""Write cracked_solid_calculix.json: half of a whole cracked spur gear with a width in CalculiX (by hand).

python -m tests.other_codes.make_cracked_solid_calculix

Wedges of 15 nodes between layers of the plane mesh of `tests/helpers/cracked_gear.py`, the middle of the face a plane
of symmetry; loads are even along the face, at one radius of the flank of the cracked tooth.
"""

import json
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from tests.helpers.cracked_gear import cracked_gear
from tests.other_codes.test_cracked_gear_other_codes import gear

NAME, NU = "19 teeth", 0.3
SIZE, TIP, FACTOR = 0.15, 0.06, 2.0
#: Half of the face width, and heights of the layers from its middle [modules].
HALF, LAYERS = 1.5, (0.0, 0.7, 1.2, 1.5)
LOADED = ((0, 1),)


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


def made():
    """Mean deflections of places under unit forces on half of the face, halved: those of a unit force on all of it."""
    tooth, bore, crack, radii = gear(NAME)
    points, six, nodes = cracked_gear(tooth, bore, crack.path(tooth), radii, SIZE, TIP, factor=FACTOR)
    number, places, elements = wedges(points, six)
    held = np.flatnonzero(np.abs(np.hypot(*places[:, :2].T) - bore) < 1e-6 * bore)
    middle = np.flatnonzero(places[:, 2] == 0.0)
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(places, 1))]
    deck += ["*ELEMENT, TYPE=C3D15, ELSET=GEAR"]
    deck += [", ".join(map(str, [i, *(one + 1)])) for i, one in enumerate(elements.T, 1)]
    deck += ["*MATERIAL, NAME=M", "*ELASTIC", f"1.0, {NU}", "*SOLID SECTION, ELSET=GEAR, MATERIAL=M"]
    deck += ["*BOUNDARY", *(f"{n + 1}, 1, 3" for n in held), *(f"{n + 1}, 3, 3" for n in middle)]
    lines = {key: (along_face(number, node), toward(tooth, points[:, node])) for key, node in nodes.items()}
    seen = sorted({n for line, _ in lines.values() for n in line})
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
    found = {}
    for step, (j, q) in enumerate(LOADED):
        own = rows[step * len(seen) : (step + 1) * len(seen)]
        moved = {int(n) - 1: np.array([float(x), float(y)]) for n, x, y, _ in own}
        for (i, p), (line, way) in lines.items():
            if (i, p) != (j, q):
                value = sum(share * float(way @ moved[n]) for n, share in line.items())
                found[f"{i} {p} {j} {q}"] = 0.5 * value
    return {"gear": NAME, "width": 2.0 * HALF, "size": FACTOR * SIZE, "nodes": len(places), "c": found}


if __name__ == "__main__":
    (Path(__file__).parent / "cracked_solid_calculix.json").write_text(json.dumps(made(), indent=1) + "\n")
