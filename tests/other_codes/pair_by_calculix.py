"""Frictionless contact of two whole solid gears in CalculiX: the decks of `make_pair_calculix.py` and what they tell.

Nothing of fegear's solution is used but the approach that is tried: CalculiX' elements on the meshes of
`pair_meshed.py`, its own contact (surface to surface, penalty) and its own solver. Bores are held as fegear holds them;
the driver's is turned, and tilted where it is misaligned.
"""

import math
import re
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from fegear.fem.plane.root_stress import extreme

sys.path.insert(0, str(Path(__file__).parent))
from pair_meshed import FACE, MM, MODULE, flank_edges
from solid_by_calculix import surface_stress

LOAD = 900.0
#: Tilt of the driver in the plane of action: gap over the width of the face [m].
TILT = 10e-6
PENALTY = 5e7  # MPa/mm: a thousandth of the Hertzian approach
#: Approach and tilt of the two steps [m]: fegear's for 900 N, aligned and tilted.
APPROACHES = {
    "two whole lines": ((17.506e-6, 0.0), (15.3275e-6, TILT)),
    "a line that ends at the tip": ((18.55e-6, 0.0), (16.129e-6, TILT)),
}
FILLETS = ("fillet", "back_fillet")
#: Where the largest stress up a fillet is told [modules].
STATIONS = np.linspace(-1.4, 1.4, 15)
#: Faces of CalculiX' hexahedra and wedges over the edges of the section.
_FIRST_SIDE = 3


def side_faces(mesh, edges):
    """(element, face) of the solid over edges of the section, shape (layers, n) each; elements from 0, wedges first."""
    t, q = mesh.section.triangles, mesh.section.quadrilaterals
    wedges = mesh.wedges.shape[1]
    at = {int(m): (e, f, True) for f, row in enumerate(t[3:]) for e, m in enumerate(row)}
    at |= {int(m): (e, f, False) for f, row in enumerate(q[4:]) for e, m in enumerate(row)}
    layer = np.arange(mesh.layers)
    element, face = [], []
    for m in edges[2]:
        e, f, wedge = at[int(m)]
        element.append(layer * t.shape[1] + e if wedge else wedges + layer * q.shape[1] + e)
        face.append(np.full(mesh.layers, f + _FIRST_SIDE))
    return np.array(element).T, np.array(face).T


def write_deck(path, pair, bodies, steps):
    """Write both gears and one step per (approach [m], tilt [m over the face]); first node of each gear, from 0."""
    nodes, elements, sets, surfaces, first = ["*NODE, NSET=NALL"], [], [], {}, {}
    offset = before = 0
    for one in bodies:
        mesh = one.mesh
        first[one.member] = offset
        nodes += [f"{offset + i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(one.points.T, 1)]
        elements += _element_cards("C3D15", mesh.wedges + 1 + offset, before + 1)
        elements += _element_cards("C3D20", mesh.hexahedra + 1 + offset, before + mesh.wedges.shape[1] + 1)
        surfaces |= _surfaces(one, before)
        roots = [mesh.nodes_of(mesh.section.boundaries[n, k]) for n in FILLETS for k in one.teeth.values()]
        for name, members in (("fillet", np.unique(np.concatenate(roots))), ("bore", one.bore)):
            sets += [f"*NSET, NSET={one.member}_{name}".upper(), *(f"{n + 1 + offset}," for n in members)]
        offset += one.points.shape[1]
        before += mesh.wedges.shape[1] + mesh.hexahedra.shape[1]
    pairs = [(f"DRIVEN_P{j + 5}_Q{i}", f"DRIVER_P{j + 5}") for j in bodies[0].teeth for i in range(4)]
    faces = []
    for name in dict.fromkeys(name for couple in pairs for name in couple):
        faces += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *surfaces[name]]
    material = pair.driver.material
    law = [
        "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material.young_modulus * 1e-6}, {material.poisson_ratio}",
        "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL",
        "*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PENALTY:g}",
    ]  # fmt: skip
    for couple in pairs:
        law += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", ", ".join(couple)]
    law += ["*BOUNDARY", "DRIVEN_BORE, 1, 3"]
    driver = next(b for b in bodies if b.member == "driver")
    wanted = [line for couple in pairs for line in ("*CONTACT PRINT, SLAVE={}, MASTER={}".format(*couple), "CF")]
    for name, what in (("FILLET", "U"), ("BORE", "RF")):
        wanted += [line for one in bodies for line in (f"*NODE PRINT, NSET={one.member}_{name}".upper(), what)]
    for step in steps:
        law += ["*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY"]
        law += _moved(pair, driver, first["driver"], *step)
        law += [*wanted, "*END STEP"]
    path.write_text("\n".join([*nodes, *elements, *sets, *faces, *law]) + "\n", encoding="ascii")
    return first


def _element_cards(kind, elements, start):
    if not elements.size:
        return []
    cards = [f"*ELEMENT, TYPE={kind}, ELSET=EALL"]
    for i, nodes in enumerate(elements.T.tolist(), start):
        cards.append(f"{i}, " + ", ".join(map(str, nodes[:15])) + ("," if len(nodes) > 15 else ""))
        if len(nodes) > 15:
            cards.append(", ".join(map(str, nodes[15:])))
    return cards


def _surfaces(one, before):
    """Faces of the driver's flanks, and those of the driven gear near the contact line by quarters of the face."""
    mesh, found = one.mesh, {}
    z = 0.5 * (mesh.stations[1:] + mesh.stations[:-1])
    quarter = np.clip(np.floor(4.0 * (z / (FACE / MODULE) + 0.5)), 0, 3).astype(int)
    for j, k in one.teeth.items():
        element, face = side_faces(mesh, flank_edges(mesh.section, k))
        parts = {f"DRIVER_P{j + 5}": np.ones(element.shape, dtype=bool)}
        if one.member == "driven":
            parts = {f"DRIVEN_P{j + 5}_Q{i}": (quarter == i)[:, None] & one.near[k] for i in range(4)}
        for name, taken in parts.items():
            found[name] = [f"{before + e + 1}, S{f}" for e, f in zip(element[taken], face[taken], strict=True)]
    return found


def _moved(pair, driver, start, approach, tilt):
    """The driver's bore, turned by the approach and tilted about its middle in the plane of action."""
    arm = driver.points[:, driver.bore] - driver.centre[:, None]
    push = push_direction(pair.working_pressure_angle)
    u = approach / pair.driver.base_radius * np.stack([arm[1], -arm[0], np.zeros(arm.shape[1])])
    u[:2] -= tilt / FACE * arm[2] * push[:2, None]
    u[2] += tilt / FACE * (push[:2] @ arm[:2])
    return [f"{start + i + 1}, {d}, {d}, {x:.12e}" for i, at in zip(driver.bore, u.T, strict=True)
            for d, x in enumerate(at, 1)]  # fmt: skip


def push_direction(alpha):
    """Unit vector along the transverse line of action in which the driver, above and turning clockwise, pushes."""
    return np.array([-math.cos(alpha), -math.sin(alpha), 0.0])


_FORCE = re.compile(r"statistics for slave set (\S+?), master set (\S+?) and time")
_NODE = re.compile(r"\s*(\d+)((?:\s+[-+]?\d\.\d+E[-+]\d+){3})\s*$")


def read_steps(path):
    """By step of the .dat file: moments about z of each slave surface [N mm], and node prints by their sets."""
    steps, lines = {}, path.read_text().splitlines()
    at = 0
    while at < len(lines):
        line = lines[at]
        found = re.search(r"time\s+([-+.\dE]+)", line)
        if not found:
            at += 1
            continue
        step = steps.setdefault(round(float(found[1]), 6), {"moment": {}, "nodes": {}})
        if name := _FORCE.search(line.replace("  ", " ")):
            while at < len(lines) - 2 and not re.match(r"\s*total surface force", lines[at]):
                at += 1
            if at + 2 >= len(lines):  # still being written
                break
            numbers = [float(x) for x in lines[at + 2].split()]
            step["moment"][name[1].strip()] = numbers[5], numbers[2]
            at += 3
        elif name := re.search(r"(displacements|forces).*for set (\S+)", line):
            rows, at = {}, at + 2
            while at < len(lines) and (row := _NODE.match(lines[at])):
                rows[int(row[1])] = [float(x) for x in row[2].split()]
                at += 1
            step["nodes"][name[2]] = rows
        else:
            at += 1
    return [steps[key] for key in sorted(steps)]


def told(pair, bodies, first, steps, found):
    """What each step says: loads of pairs by quarters of the face [N], both torques over the base radius [N], and the
    largest root stresses at `STATIONS` [MPa]."""
    by_base, result = pair.driven.base_radius * MM, []
    for (approach, tilt), step in zip(steps, found, strict=True):
        quarters, stress, torque = {}, {}, {}
        for name, (moment, _) in step["moment"].items():
            number, quarter = re.match(r"DRIVEN_P(\d+)_Q(\d)", name).groups()
            quarters.setdefault(int(number) - 5, [0.0] * 4)[int(quarter)] = round(abs(moment) / by_base, 3)
        for one in bodies:
            stress |= _root_stress(one, first[one.member], step, pair.driver.material.young_modulus * 1e-6)
            rows = step["nodes"][f"{one.member}_bore".upper()]
            arm = one.points[:2, np.array(list(rows)) - 1 - first[one.member]] - one.centre[:2, None]
            force = np.array(list(rows.values())).T
            torque[one.member] = round(abs(float((arm[0] * force[1] - arm[1] * force[0]).sum())) / by_base, 3)
        result.append({
            "approach_um": round(approach * 1e6, 6), "tilt_um": round(tilt * 1e6, 6), "load_by_bore": torque,
            "quarters": {str(j): q for j, q in sorted(quarters.items())}, "root_stress": stress,
        })  # fmt: skip
    return result


def _root_stress(one, start, step, young):
    rows, stress = step["nodes"][f"{one.member}_fillet".upper()], {}
    u = np.full((3, one.points.shape[1]), np.nan)
    u[:, np.array(list(rows)) - 1 - start] = np.array(list(rows.values())).T
    for j, k in one.teeth.items():
        for side, word, sign in zip(FILLETS, ("tension", "compression"), (1, -1), strict=True):
            zeta, arc, s = surface_stress(one.mesh, u, one.mesh.section.boundaries[side, k])
            value = CubicSpline(zeta, extreme(s[0].T, arc, sign, arc[-1])[0])(STATIONS) * young
            stress[f"{one.member} {word} {j}"] = [round(float(x), 2) for x in value]
    return stress
