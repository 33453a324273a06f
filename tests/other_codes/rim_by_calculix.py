"""A whole ring gear on pins or in a spline, one tooth loaded, by CalculiX: plane quadratic elements of all teeth.

Nothing of fegear's solution is used but the section's nodes (gmsh's, by `uneven_section`): load, means over the pins'
arcs (*EQUATION), tractions of the spline and the fillets' stress are summed here. Module, force and modulus are one.
"""

import math
import os
import re
import subprocess

import numpy as np

from fegear.fem.plane.gear_section import uneven_section
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rim_support import RimSupport

NU, RIM = 0.3, 2.0
TOOTH = InternalTooth(48, PinionCutter(20, 0.1, 1.25, tip_radius=0.25), tip_radius=23.2)
OUTER = TOOTH.root_radius + RIM
#: Where the load stands [modules], and the half-width of its semi-elliptic pressure.
RADIUS, HALF_WIDTH = 23.9, 0.18
PINS = RimSupport(6, 2.0, 0.05)
#: Support, kind of plane and loaded tooth.
RINGS = {
    "pins, near one": (PINS, "strain", 0),
    "pins, between two": (PINS, "strain", 4),
    "splined": (RimSupport(), "stress", 0),
}
#: Of the elements, whose modulus is its inverse: CalculiX makes solids of plane elements, and plane stress is thin.
THICKNESS = 0.01
NEIGHBOURS = (-1, 0, 1, 2, 12)
_GAUSS = np.polynomial.legendre.leggauss(3)


def _shapes(xi):
    """Quadratic shape functions of an edge (first, second, middle) on [-1, 1], and their slopes."""
    return np.array([0.5 * xi * (xi - 1), 0.5 * xi * (xi + 1), 1 - xi * xi]), np.array([xi - 0.5, xi + 0.5, -2 * xi])


def contact(section, tooth):
    """Unit load on the flank of a tooth, shape (2, nodes): its product with displacements is the mean deflection."""
    edges = section.boundaries["flank", tooth]
    value, slope = _shapes((np.arange(400) + 0.5) / 200.0 - 1.0)
    at = np.einsum("cin,iq->cnq", section.points[:, edges], value)
    along = np.einsum("cin,iq->cnq", section.points[:, edges], slope)
    base = TOOTH.base_radius
    arc = 0.5 * ((at**2).sum(axis=0) - RADIUS**2) / base  # of an involute
    share = np.sqrt(np.maximum(1.0 - (arc / HALF_WIDTH) ** 2, 0.0))
    share = share / (share * np.hypot(*along)).sum()
    force = np.zeros_like(section.points)
    for c, normal in enumerate((-along[1], along[0])):  # times the length of an edge per place on it
        np.add.at(force[c], edges, np.einsum("iq,nq->in", value, share * normal))
    return force


def pin_means(section, support):
    """Weights of nodes in the mean over each pin's arc, {node: weight} by pin."""
    edges = section.edges("bore")
    angle = np.arctan2(*section.points[:, edges[:2]])
    span = np.mod(angle[1] - angle[0] + math.pi, 2 * math.pi) - math.pi
    found = []
    for pin in range(support.pins):
        row, count, half = {}, 2000, 0.5 * support.width / OUTER
        for i in range(count):
            wanted = support.angle + 2 * math.pi * pin / support.pins + half * ((2 * i + 1) / count - 1)
            into = (np.mod(wanted - angle[0] + math.pi, 2 * math.pi) - math.pi) / span
            edge = np.flatnonzero((into >= 0.0) & (into < 1.0))[0]
            for node, weight in zip(edges[:, edge], _shapes(2 * into[edge] - 1)[0], strict=True):
                row[int(node)] = row.get(int(node), 0.0) + float(weight) / count
        found.append(row)
    return found


def rigid(points):
    """Two translations and a turn, shape (3, 2, nodes)."""
    one, none = np.ones(points.shape[1]), np.zeros(points.shape[1])
    return np.array([[one, none], [none, one], [-points[1], points[0]]])


def even_tractions(section):
    """Nodal forces of tractions on the outer circle as even as rigid motions, shape (3, 2, nodes)."""
    edges, motions = section.edges("bore"), rigid(section.points)
    value, slope = _shapes(_GAUSS[0])
    speed = np.hypot(*np.einsum("cin,iq->cnq", section.points[:, edges], slope))
    at = np.einsum("rcin,iq->rcnq", motions[:, :, edges], value)
    loads = np.einsum("iq,nq,q,rcnq->rcin", value, speed, _GAUSS[1], at)
    found = np.zeros_like(motions)
    for r in range(3):
        for c in range(2):
            np.add.at(found[r, c], edges, loads[r, c])
    return found


def solved(folder, ring, coarseness, others):
    """What CalculiX says: deflections at the contact's place on teeth, stress of both fillets, of 1/E and 1/module."""
    support, plane, tooth = RINGS[ring]
    section = uneven_section(TOOTH, OUTER, coarseness, others)
    support = RimSupport(support.pins, support.width, support.angle - 2 * math.pi * tooth / TOOTH.teeth)
    load, tractions, motions = contact(section, 0), even_tractions(section), rigid(section.points)
    inverse = np.linalg.inv(np.einsum("rcn,scn->rs", motions, tractions))
    applied, held = load, []
    if support.pins:
        for row in pin_means(section, support):
            terms = sorted(row.items(), key=lambda one: -abs(one[1]))
            for c in (1, 2):
                held += ["*EQUATION", f"{len(terms)}", *(f"{n + 1}, {c}, {w:.12e}" for n, w in terms)]
    else:
        applied = load - np.tensordot(inverse @ np.tensordot(motions, load, 2), tractions, 1)
        outer = np.unique(section.edges("bore"))
        first, last = outer[np.argmax(section.points[1, outer])], outer[np.argmin(section.points[1, outer])]
        held = ["*BOUNDARY", f"{first + 1}, 1, 2", f"{last + 1}, 1, 1"]
    letter = {"strain": "E", "stress": "S"}[plane]
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.12e}, {y:.12e}, 0." for i, (x, y) in enumerate(section.points.T, 1))]
    number = 0
    for cells in (section.triangles, section.quadrilaterals):
        deck += [f"*ELEMENT, TYPE=CP{letter}{cells.shape[0]}, ELSET=EALL"]
        deck += [", ".join(map(str, [number + i, *(nodes + 1)])) for i, nodes in enumerate(cells.T, 1)]
        number += cells.shape[1]
    deck += held
    deck += ["*MATERIAL, NAME=ONE", "*ELASTIC", f"{1.0 / THICKNESS}, {NU}"]
    deck += ["*SOLID SECTION, ELSET=EALL, MATERIAL=ONE", f"{THICKNESS}"]
    deck += ["*STEP", "*STATIC", "*CLOAD"]
    deck += [f"{n + 1}, {c + 1}, {applied[c, n]:.12e}" for c in range(2) for n in np.flatnonzero(applied[c])]
    deck += ["*NODE PRINT, NSET=NALL", "U", "*END STEP"]
    (folder / "ring.inp").write_text("\n".join(deck) + "\n", encoding="ascii")
    alone = dict(os.environ, OMP_NUM_THREADS="1")
    subprocess.run(["ccx", "ring"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
    moved = np.full_like(section.points, np.nan)
    for line in (folder / "ring.dat").read_text().splitlines():
        if row := re.match(r"\s*(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+\S+\s*$", line):
            moved[:, int(row[1]) - 1] = float(row[2]), float(row[3])
    if not support.pins:
        moved = moved - np.tensordot(inverse.T @ np.tensordot(tractions, moved, 2), motions, 1)
    found = {"nodes": section.points.shape[1], "torque": float((motions[2] * load).sum())}
    found["deflection"] = {k: float((contact(section, k) * moved).sum()) for k in NEIGHBOURS}
    modulus = 1.0 / (1.0 - NU**2) if plane == "strain" else 1.0
    for side, name, sign in (("tension", "fillet", 1.0), ("compression", "back_fillet", -1.0)):
        edges, slope = section.boundaries[name, 0], _shapes(np.array([-1.0, 1.0]) / math.sqrt(3.0))[1]
        along, stretch = (np.einsum("cin,iq->cnq", of[:, edges], slope) for of in (section.points, moved))
        strain = (along * stretch).sum(axis=0) / (along**2).sum(axis=0)
        found[f"root_{side}"] = float(sign * modulus * (sign * strain).max())
    return found
