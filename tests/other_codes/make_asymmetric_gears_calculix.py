"""Write asymmetric_gears_calculix.json: either flank of three asymmetric gears by CalculiX (by hand, minutes).

python tests/other_codes/make_asymmetric_gears_calculix.py "28/18"

Each gear is one mesh of all its teeth, seen from the drive flank, of six-node elements. A pressure as wide as the
contact is put on the drive flank, then on the coast flank where it stands; nodal forces, deflections and the stress of
the fillets are made here of the mesh's edges, and CalculiX assembles and solves.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from test_asymmetric_ring_scikit_fem import GEARS, NU, WIDTH

from fegear.fem.plane.scikit_fem_alone import _whole_gear
from fegear.fem.plane.settings import settings_at
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth

FILE = Path(__file__).parent / "asymmetric_gears_calculix.json"
YOUNG = 1e5  # [MPa], for the digits of CalculiX' tables
#: Edges of the loaded tooth in modules: flanks and fillets alike.
FINE = replace(
    settings_at(-1), root_edge_length=0.02, root_fraction=0.04, flank_edge_length=0.012, tip_edge_length=0.012,
    junction_edge_length=0.006, back_edge_length=0.012, growth=0.2, tip_growth=0.2, side_growth=0.2, body_fraction=0.2,
    rim_fraction=0.15, order=2,
)  # fmt: skip
_GAUSS = np.polynomial.legendre.leggauss(8)
#: Parts of an edge under the pressure, whose ends are no smooth places.
_PARTS = 40


def the_tooth(name):
    """One of the three gears."""
    teeth, angles, tips, shift = GEARS[name]
    rack = AsymmetricRack(*(RackFlank(math.radians(a), r) for a, r in zip(angles, tips, strict=True)))
    return AsymmetricTooth(teeth, rack, shift)


def the_radius(side):
    """Where it is loaded: the middle of the usable flank."""
    return math.sqrt(0.5 * (side.form_radius**2 + side.involute_tip_radius**2))


def shapes(t):
    """Functions of the nodes at both ends and in the middle of an edge, and their slopes, at places t in (0, 1)."""
    values = np.array([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)])
    return values, np.array([4 * t - 3, 4 * t - 1, 4 - 8 * t])


def pressed(mesh, edges, side, radius, turn):
    """Nodal forces of a semi-elliptic pressure of resultant 1 about a radius of a flank, shape (2, nodes).

    `turn` is 1 where the flank lies on the right of its tooth, else -1.
    """
    forces = np.zeros_like(mesh.points)
    middle = 0.5 * radius**2 / side.base_radius  # arc length of an involute from the base circle is (r^2 - rb^2) / 2 rb
    nodes, weights = _GAUSS
    t = (np.arange(_PARTS)[:, None] + 0.5 * (1 + nodes)).ravel() / _PARTS
    w = np.tile(0.5 * weights / _PARTS, _PARTS)
    values, slopes = shapes(t)
    for edge in edges.T:
        at, along = mesh.points[:, edge] @ values, mesh.points[:, edge] @ slopes
        r = np.hypot(*at)
        place = (0.5 * r**2 / side.base_radius - middle) / WIDTH
        pressure = 2.0 / (math.pi * WIDTH) * np.sqrt(np.maximum(1.0 - place**2, 0.0))
        if not pressure.any():
            continue
        roll = np.sqrt(r**2 / side.base_radius**2 - 1.0)
        phi = side.base_half_angle - roll  # the normal points to (-cos phi, sin phi) into the tooth, on the right
        normal = np.array([-turn * np.cos(phi), np.sin(phi)])
        forces[:, edge] += (w * pressure * np.hypot(*along) * normal) @ values.T
    return forces


def tangential(mesh, edges, moved):
    """Tangential strain at two places of each edge, where elements of second order know it best: arc order is kept."""
    found = []
    for t in (0.5 - 0.5 / math.sqrt(3.0), 0.5 + 0.5 / math.sqrt(3.0)):
        _, slopes = shapes(np.array([t]))
        for edge in edges.T:
            along, change = mesh.points[:, edge] @ slopes[:, 0], moved[:, edge] @ slopes[:, 0]
            at = mesh.points[:, edge] @ shapes(np.array([t]))[0][:, 0]
            found.append((math.hypot(*at), float(along @ change) / float(along @ along)))
    return np.array(sorted(found)).T


def extreme(radius, strain, sign):
    """Largest (1) or smallest (-1) strain: the vertex of a parabola through the largest value and its neighbours."""
    top = int(np.argmax(sign * strain))
    here = slice(max(top - 1, 0), top + 2)
    a, b, c = np.polyfit(radius[here] - radius[top], strain[here], 2)
    return float(c - b * b / (4.0 * a)) if sign * a < 0.0 else float(strain[top])


def deck(mesh, loads, held, watched):
    """One step for each load; CalculiX reads 20 characters of a number."""
    out = ["*NODE, NSET=NALL"]
    out += [f"{i}, {x:.11g}, {y:.11g}, 0" for i, (x, y) in enumerate(mesh.points.T, start=1)]
    out.append("*ELEMENT, TYPE=CPE6, ELSET=GEAR")
    out += [f"{i}, " + ", ".join(map(str, e)) for i, e in enumerate((mesh.triangles + 1).T.tolist(), start=1)]
    for name, nodes in (("HELD", held), ("WATCHED", watched)):
        out.append(f"*NSET, NSET={name}")
        out += [f"{node + 1}," for node in nodes]
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {NU}", "*SOLID SECTION, ELSET=GEAR, MATERIAL=STEEL", "1."]
    out += ["*BOUNDARY", "HELD, 1, 2"]
    for forces in loads:
        out += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
        for node in np.flatnonzero(np.any(forces != 0.0, axis=0)):
            out += [f"{node + 1}, {axis + 1}, {forces[axis, node]:.12g}" for axis in (0, 1)]
        out += ["*NODE PRINT, NSET=WATCHED", "U", "*END STEP"]
    return "\n".join(out) + "\n"


def steps(text, count):
    """Displacements of each step, shape (2, nodes), times Young's modulus."""
    found = []
    for line in text.splitlines():
        if "displacements" in line:
            found.append(np.zeros((2, count)))
        elif len(row := line.split()) == 4 and row[0].isdigit():
            found[-1][:, int(row[0]) - 1] = float(row[1]) * YOUNG, float(row[2]) * YOUNG
    return found


def made(name):
    """c_0 and root stress of both fillets under a load in the middle of either flank; module 1, E = 1."""
    tooth = the_tooth(name)
    sides = {"drive": tooth.drive, "coast": tooth.coast}
    mesh = _whole_gear(tooth.drive, 0.6 * tooth.drive.root_radius, FINE, [])
    flanks = {"drive": "flank:0", "coast": "back_flank:0"}
    fillets = {"drive": "fillet:0", "coast": "back_fillet:0"}
    loads = [
        pressed(mesh, mesh.edges[flanks[flank]], side, the_radius(side), 1.0 if flank == "drive" else -1.0)
        for flank, side in sides.items()
    ]
    held = np.unique(np.hstack([edge.ravel() for key, edge in mesh.edges.items() if key.startswith("bore:")]))
    watched = np.unique(np.hstack([mesh.edges[key].ravel() for key in (*flanks.values(), *fillets.values())]))
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "g.inp").write_text(deck(mesh, loads, held, watched))
        alone = dict(os.environ, OMP_NUM_THREADS="1")
        subprocess.run(["ccx", "g"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
        moved = steps((Path(folder) / "g.dat").read_text(), mesh.points.shape[1])
    modulus, found = 1.0 / (1.0 - NU**2), {"nodes": mesh.points.shape[1]}
    for flank, forces, u in zip(sides, loads, moved, strict=True):
        other = "coast" if flank == "drive" else "drive"
        found[flank] = {
            "resultant": float(np.hypot(*forces.sum(axis=1))),
            "c_self": float((forces * u).sum()) + 0.5 / (math.pi * modulus),
            "tension": modulus * extreme(*tangential(mesh, mesh.edges[fillets[flank]], u), 1),
            "compression": modulus * extreme(*tangential(mesh, mesh.edges[fillets[other]], u), -1),
        }
    return found


if __name__ == "__main__":
    for gear in sys.argv[1:]:
        known = json.loads(FILE.read_text()) if FILE.exists() else {}
        known[gear] = made(gear)
        FILE.write_text(json.dumps(known, indent=1) + "\n")
