"""A rack of seven teeth, one loaded, by CalculiX: plane quadratic elements of all teeth.

Nothing of fegear's solution is used but the nodes of one tooth (gmsh's): teeth are joined, the load is put on and the
mean deflection and the root stress are summed here. Module, force and modulus are one.
"""

import math
import os
import re
import subprocess

import numpy as np

from fegear.fem.plane.rack.rack_mesh import rack_sector
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_tooth import PITCH, RackTooth

NU, BODY, TEETH = 0.3, 2.0, 7
TOOTH = RackTooth(BasicRack())
#: Height of the load and half-width of its semi-elliptic pressure [modules]; loaded teeth: in the middle, the first.
HEIGHT, HALF_WIDTH = 0.3, 0.18
LOADED = (3, 0)
SETTINGS = MeshSettings(
    root_edge_length=0.03, root_fraction=0.12, flank_edge_length=0.04, tip_edge_length=0.04, junction_edge_length=0.03,
    back_edge_length=0.12, growth=0.3, tip_growth=0.3, side_growth=0.25, body_fraction=0.1, rim_fraction=0.1, order=2,
)  # fmt: skip


def joined():
    """Points and triangles of all teeth, and the numbers of each tooth's nodes."""
    mesh = rack_sector(TOOTH, BODY, SETTINGS)
    every = np.hstack([mesh.points + np.array([[PITCH * k], [0.0]]) for k in range(TEETH)])
    _, first, number = np.unique(np.round(every.T, 8) + 0.0, axis=0, return_index=True, return_inverse=True)
    number = number.reshape(TEETH, -1)
    return mesh, every[:, first], np.hstack([number[k][mesh.triangles] for k in range(TEETH)]), number


def contact(mesh):
    """Unit load on the flank of a tooth, shape (2, nodes): its product with displacements is the mean deflection."""
    edges = mesh.edges["flank"]
    xi = (np.arange(400) + 0.5) / 200.0 - 1.0
    value = np.array([0.5 * xi * (xi - 1), 0.5 * xi * (xi + 1), 1 - xi * xi])
    y = np.einsum("in,iq->nq", mesh.points[1, edges], value)
    length = np.hypot(*(mesh.points[:, edges[1]] - mesh.points[:, edges[0]]))
    arc = (y - HEIGHT) / math.cos(TOOTH.pressure_angle)
    share = np.sqrt(np.maximum(1.0 - (arc / HALF_WIDTH) ** 2, 0.0)) * length[:, None]
    share /= share.sum()
    force = np.zeros_like(mesh.points)
    for c, inward in enumerate((-math.cos(TOOTH.pressure_angle), -math.sin(TOOTH.pressure_angle))):
        np.add.at(force[c], edges, inward * np.einsum("iq,nq->in", value, share))
    return force


def solve(folder, loaded):
    """Mean deflections of all teeth under a load on one, and the largest root stress of its roundings."""
    mesh, points, triangles, number = joined()
    force = contact(mesh)
    back = np.unique(np.concatenate([number[k][np.unique(mesh.edges["bore"])] for k in range(TEETH)]))
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.12e}, {y:.12e}, 0" for i, (x, y) in enumerate(points.T, 1))]
    deck += ["*ELEMENT, TYPE=CPE6, ELSET=EALL"]
    deck += [", ".join(map(str, [i, *(t + 1)])) for i, t in enumerate(triangles.T, 1)]
    deck += ["*MATERIAL, NAME=M", "*ELASTIC", f"1.0, {NU}", "*SOLID SECTION, ELSET=EALL, MATERIAL=M", "1.0"]
    deck += ["*BOUNDARY", *(f"{n + 1}, 1, 2" for n in back), "*STEP", "*STATIC", "*CLOAD"]
    deck += [
        f"{number[loaded][n] + 1}, {c + 1}, {force[c, n]:.12e}"
        for c in range(2) for n in np.flatnonzero(force[c])
    ]  # fmt: skip
    deck += ["*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    (folder / "rack.inp").write_text("\n".join(deck))
    subprocess.run(["ccx", "rack"], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "OMP_NUM_THREADS": "1"})  # fmt: skip
    rows = re.findall(r"^ +(\d+) +(\S+) +(\S+) +\S+$", (folder / "rack.dat").read_text(), re.MULTILINE)
    moved = np.zeros_like(points)
    for n, x, y in rows:
        moved[:, int(n) - 1] = float(x), float(y)
    deflection = [float((force * moved[:, number[k]]).sum()) for k in range(TEETH)]
    stress = {}
    for side, name in (("tension", "fillet"), ("compression", "back_fillet")):
        found = []
        edges = number[loaded][mesh.edges[name]]
        for xi in (-1 / math.sqrt(3), 1 / math.sqrt(3)):
            slope = np.array([xi - 0.5, xi + 0.5, -2 * xi])
            d, u = (np.einsum("cin,i->cn", of[:, edges], slope) for of in (points, moved))
            found.append((d * u).sum(axis=0) / (d**2).sum(axis=0) / (1 - NU**2))
        stress[side] = float(np.max(found) if side == "tension" else np.min(found))
    return {"nodes": points.shape[1], "deflection": deflection, **stress}
