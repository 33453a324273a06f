"""Loaded transmission error beside frictionless contact of both complete gears in CalculiX (run by hand, minutes each).

    python benchmarks/calculix_contact.py 28 28 0 0 3.0      # teeth, teeth, shifts, x [mm]

Both gears are meshed whole: three fine sectors (contact edges of about 0.006 module) and coarse ones elsewhere, joined
along equal sides. The driven gear's bore is held, the driver's bore is turned by the transmission error that fegear
predicts for 350 N/mm; what CalculiX then finds is the load of every tooth pair and the stress in every fillet.
"""

import math
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE = 3.175e-3
LOAD = 350.0  # N on 1 mm of face
COARSE = MeshSettings()
#: Only what does not move the nodes of the sides may differ from the coarse sectors.
FINE = replace(COARSE, flank_edge_length=0.008, tip_edge_length=0.004, junction_edge_length=0.008, tip_growth=0.1)
PENALTY = 1e8  # MPa/mm: adds about 0.01 um


def whole(gear):
    """Points [mm], triangles, front edges (element, face, tooth) and fillet nodes by tooth."""
    z = gear.teeth
    bore = gear.bore_radius / gear.module
    sectors = {name: mesh_sector(gear.tooth, bore, s) for name, s in (("fine", FINE), ("coarse", COARSE))}
    points, triangles, faces, fillets, seen = [], [], [], {}, {}
    for k in range(z):
        mesh = sectors["fine" if k in (0, 1, z - 1) else "coarse"]
        angle = 2.0 * math.pi * k / z
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        place = (turn @ mesh.points).T * gear.module * 1e3
        sides = set(np.unique(np.hstack([mesh.edges["side_a"], mesh.edges["side_b"]])).tolist())
        number = np.empty(len(place), dtype=int)
        for i, p in enumerate(place):
            key = tuple(np.round(p, 6)) if i in sides else None
            if key is not None and key in seen:
                number[i] = seen[key]
                continue
            number[i] = len(points)
            points.append(p)
            if key is not None:
                seen[key] = number[i]
        if k in (0, 1, z - 1):
            tooth = k if k < 2 else -1
            middle = {int(m): (e, f) for f, row in enumerate(mesh.triangles[3:]) for e, m in enumerate(row)}
            front = np.hstack([mesh.edges[name] for name in ("flank", "tip") if name in mesh.edges])
            for m in front[2]:
                element, face = middle[int(m)]
                faces.append((len(triangles) + element + 1, face + 1, tooth))
            fillets[tooth] = number[np.unique(mesh.edges["fillet"])]
        triangles.extend(number[mesh.triangles].T.tolist())
    return np.array(points), np.array(triangles), faces, fillets


def turned(points, clockwise):
    c, s = math.cos(clockwise), math.sin(clockwise)
    return points @ np.array([[c, -s], [s, c]])


def deck(pair, x, delta, folder):
    """Write both gears in contact; the driver hangs above with its teeth down."""
    alpha = pair.working_pressure_angle
    text, offset, element_offset, surfaces = ["*NODE, NSET=NALL"], 0, 0, {}
    kept, elements, fillets = {}, [], {}
    for member in ("driven", "driver"):
        gear = pair.gear(member)
        points, triangles, faces, fillet = whole(gear)
        roll = float(pair.roll_angle(x, member))
        points = turned(points, -alpha - gear.tooth.base_half_angle + roll)
        centre = np.zeros(2)
        if member == "driver":
            centre = np.array([0.0, pair.centre_distance * 1e3])
            points = centre - points
        text += [f"{offset + i + 1}, {p[0]:.12e}, {p[1]:.12e}, 0." for i, p in enumerate(points)]
        elements += [
            f"{element_offset + e + 1}, " + ", ".join(str(offset + n + 1) for n in t) for e, t in enumerate(triangles)
        ]
        for e, f, tooth in faces:
            surfaces.setdefault(f"{member}_{tooth}".replace("-1", "m"), []).append(f"{element_offset + e}, S{f}")
        bore = np.flatnonzero(np.abs(np.hypot(*(points - centre).T) - gear.bore_radius * 1e3) < 1e-5)
        kept[member] = (points, centre, bore, offset)
        fillets[member] = {k: v + offset for k, v in fillet.items()}
        offset += len(points)
        element_offset += len(triangles)
    text += ["*ELEMENT, TYPE=CPE6, ELSET=EALL", *elements]
    for name, faces in surfaces.items():
        text += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *faces]
    material = pair.driver.material
    text += [
        "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material.young_modulus * 1e-6}, {material.poisson_ratio}",
        "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL", "1.0",
        "*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PENALTY:g}",
    ]  # fmt: skip
    teeth = ("m", "0", "1")
    # The driven tooth clockwise of the contact meets the driver's tooth counterclockwise of its own, and so on.
    couples = [("m", "1"), ("0", "0"), ("1", "m")]
    assert {a for a, _ in couples} == set(teeth)
    for driven, driver in couples:
        text += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", f"driven_{driven}, driver_{driver}"]
    points, _, bore, start = kept["driven"]
    text += ["*NSET, NSET=HELD", *(f"{start + i + 1}," for i in bore)]
    points, centre, bore, start = kept["driver"]
    text += ["*NSET, NSET=DRIVE", *(f"{start + i + 1}," for i in bore)]
    text += ["*BOUNDARY", "HELD, 1, 2", "*STEP, INC=200", "*STATIC", "1., 1.", "*BOUNDARY"]
    theta = delta / pair.driver.base_radius
    arm = points[bore] - centre
    move = turned(arm, theta) - arm
    for i, u in zip(bore, move, strict=True):
        text += [f"{start + i + 1}, 1, 1, {u[0]:.12e}", f"{start + i + 1}, 2, 2, {u[1]:.12e}"]
    text += ["*NODE PRINT, NSET=DRIVE", "RF", "*NODE PRINT, NSET=HELD", "RF"]
    text += ["*NODE FILE", "U", "*EL FILE", "S", "*END STEP", ""]
    (folder / "pair.inp").write_text("\n".join(text))
    return kept, fillets


def reaction(folder, kept, pair, member):
    """Line load [N/mm] from the torque on a bore."""
    rows = [line.split() for line in (folder / "pair.dat").read_text().splitlines()]
    force = {int(r[0]): (float(r[1]), float(r[2])) for r in rows if len(r) == 4 and r[0].isdigit()}
    points, centre, bore, start = kept[member]
    torque = sum(
        (points[i] - centre)[0] * force[start + i + 1][1] - (points[i] - centre)[1] * force[start + i + 1][0]
        for i in bore
    )
    return abs(torque) / (pair.gear(member).base_radius * 1e3)


def fillet_stress(folder, fillets):
    """Largest principal stress [MPa] among the nodes of each fillet."""
    stress, inside = {}, False
    for line in (folder / "pair.frd").read_text().splitlines():
        if line.startswith(" -4  STRESS"):
            inside = True
        elif inside and line.startswith(" -1"):
            v = [float(line[13 + 12 * i : 25 + 12 * i]) for i in range(4)]
            stress[int(line[3:13])] = 0.5 * (v[0] + v[1]) + math.hypot(0.5 * (v[0] - v[1]), v[3])
        elif inside and line.startswith(" -3"):
            inside = False
    return {(m, k): max(stress[n + 1] for n in nodes) for m, f in fillets.items() for k, nodes in f.items()}


def main(z1, z2, shift1, shift2, x_mm, corner=True):
    gears = []
    for z, shift in ((z1, shift1), (z2, shift2)):
        tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), shift)
        gears.append(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE))
    pair = GearPair(*gears)
    x = np.array([x_mm * 1e-3])
    spec = PairSpec(pair, (LOAD,), corner_contact=corner)
    engagement = load_plane(spec, [solve_gear(g, reach=2) for g in gears]).engagement
    loaded = engagement.solve(engagement.grid(x), np.array([LOAD]))
    delta = float(np.ravel(loaded.transmission_error)[0])
    print(f"x = {x_mm} mm in {pair.x_start * 1e3:.3f} .. {pair.x_end * 1e3:.3f} mm")
    print(f"fegear: transmission error {delta * 1e6:.4f} um, loads", np.ravel(loaded.loads), "N/mm")
    for member in ("driver", "driven"):
        stress = root_stress_history(engagement, loaded, member).stress
        print(f"fegear: largest root tension of the {member}'s teeth", np.ravel(stress) * 1e-6, "MPa")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        kept, fillets = deck(pair, float(x[0]), delta, folder)
        done = subprocess.run(["ccx", "pair"], cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            print(done.stdout[-2000:])
            return
        for member in ("driver", "driven"):
            print(member, "load found by CalculiX", reaction(folder, kept, pair, member), "N/mm, asked 350")
        print({k: round(v, 2) for k, v in fillet_stress(folder, fillets).items()})


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), *(float(v) for v in sys.argv[3:6]), corner="off" not in sys.argv)
