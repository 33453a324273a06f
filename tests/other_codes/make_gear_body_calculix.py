"""Write gear_body_calculix.json: whole gears on a web by CalculiX, under load and in vibration (run by hand).

python tests/other_codes/make_gear_body_calculix.py [middle|off|inclined|steep]...

Quadratic wedges and hexahedra, all sides joined node by node. Two cores take twenty minutes for the loads of one gear
(153,000 nodes, 141,000 on an inclined web); its waves are those of one sector with CalculiX' cyclic symmetry (10,000
nodes, the layers finest where the web ends). CalculiX' stiffness matrix, as `*FREQUENCY, SOLVER=MATRIXSTORAGE` writes
it, solved by Pardiso for all five loads at once takes two minutes: those of "off" are from there, the first of them the
same to the seven digits that SPOOLES prints.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix

from fegear.fem.plane import gear_section
from fegear.fem.plane.body import with_body
from fegear.fem.solid.extruded import extruded, pressed_band
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.gear_body import GearBody
from fegear.geometry.rack import BasicRack
from fegear.output.solid_mesh_files import write_solid_inp

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "gear_body_calculix.json"
TOOTH, BORE, FACE = Tooth(16, BasicRack(1.0, 1.25, 0.25), 0.2), 2.0, 4.0
RADIUS, PLACES = 8.2, (-2.0, -1.0, 0.0, 1.0, 2.0)
#: The web in the middle of the face and off it; inclined by 20 degrees, and by 30 between a helical rim and a hub that
#: is narrower than the face.
BODIES = {
    "middle": GearBody(5.7, 3.0, (-0.5, 0.5), (-2.0, 2.0)),
    "off": GearBody(5.7, 3.0, (-1.5, -0.5), (-2.0, 2.0)),
    "inclined": GearBody(5.7, 3.0, (-1.5, -0.5), (-2.0, 2.0), math.tan(math.radians(20.0))),
    "steep": GearBody(5.7, 3.0, (-1.25, -0.5), (-1.0, 2.0), math.tan(math.radians(30.0))),
}
#: Twist [rad/module], 15 degrees on the reference circle.
TWISTS = {"steep": math.tan(math.radians(15.0)) / TOOTH.pitch_radius}
#: Edges of tooth 0 and of the others as a multiple of the usual ones, under load and for modes; planes along the face.
EDGES, COARSE = (1.2, 2.0), 3.0
LOADED = np.unique(np.round([*np.linspace(-2, 2, 17), -1.9, 1.9, -1.6, -1.4, -0.6, -0.4, 0.4, 0.6], 9))
LEANING = np.unique(np.round([*np.linspace(-2, 2, 17), -1.9, 1.9, -1.6, -1.4, -0.6, -0.4], 9))
MODES = {
    "middle": [-2, -1.25, -0.75, -0.57, -0.5, -0.43, -0.2, 0.2, 0.43, 0.5, 0.57, 0.75, 1.25, 2],
    "off": [-2, -1.75, -1.57, -1.5, -1.43, -1.2, -0.8, -0.57, -0.5, -0.43, -0.25, 0.2, 1, 2],
}
MODES["inclined"] = MODES["off"]
#: Of spur teeth: a twisted sector has no plane sides.
MODES["steep"] = [-2, -1.6, -1.33, -1.25, -1.17, -1, -0.75, -0.58, -0.5, -0.42, -0.25, 0.2, 1, 2]
#: Nodal diameters up to which modes are wanted, and how many with each.
DIAMETERS, EACH = 3, 2


def hat(place):
    return max(place - 0.5, -2.0), place, min(place + 0.5, 2.0)


def under_load(which):
    """Deflections between bands, and the largest root tension along the face of each."""
    calculix.TOOTH, calculix.BORE = TOOTH, BORE
    body = BODIES[which]
    section = gear_section.uneven_section(TOOTH, BORE, *EDGES, body)
    mesh = extruded(section, LEANING if body.lean else LOADED, TWISTS.get(which, 0.0), body)
    bands = {f"{p:g}": pressed_band(mesh, TOOTH, RADIUS, 0.25, hat(p), 0) for p in PLACES}
    with tempfile.TemporaryDirectory() as folder:
        moved = calculix.solve(Path(folder), "g", mesh, bands, tuple(bands))
    return {
        "deflection": [[calculix.deflection(moved[a], bands[b]) for b in bands] for a in bands],
        "tension": [calculix.largest_along(mesh, moved[a], "fillet", 1).tolist() for a in bands],
    }


def frequencies(which):
    """Lowest natural frequencies [sqrt(E / rho) / module] with each number of nodal diameters, the bore held."""
    gear_section.with_body = lambda rim, body, bore, _share: with_body(rim, body, bore, 0.1)
    body, material = BODIES[which], Material(200e9, calculix.NU, 7850.0)
    section = gear_section.uneven_section(TOOTH, BORE, COARSE, COARSE, body, row=1)
    mesh = extruded(section, np.array(MODES[which]), 0.0, body)
    x, y, _ = mesh.points
    used = np.unique(np.concatenate([mesh.wedges.ravel(), mesh.hexahedra.ravel()]))
    free = used[np.hypot(x, y)[used] > BORE * (1.0 + 1e-6)]
    cards = []
    for name, angle in (("A", -np.pi / TOOTH.teeth), ("B", np.pi / TOOTH.teeth)):
        side = free[np.abs(np.arctan2(x, y)[free] - angle) < 1e-7]
        cards += [f"*SURFACE, NAME={name}, TYPE=NODE", *(str(node + 1) for node in side)]
    cards += [
        "*TIE, POSITION TOLERANCE=1e-4, CYCLIC SYMMETRY, NAME=SIDES", "A, B",
        f"*CYCLIC SYMMETRY MODEL, N={TOOTH.teeth}, NGRAPH=1, TIE=SIDES", "0, 0, 0, 0, 0, 1",
        "*STEP", "*FREQUENCY", str(2 * EACH),  # turned by a quarter of a wave each is found again
        f"*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={DIAMETERS}", "*END STEP",
    ]  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        deck = Path(folder) / "m.inp"
        write_solid_inp(deck, Gear(TOOTH, 1e-3, BORE * 1e-3, FACE * 1e-3, material), mesh, {}, 1.0, {})
        deck.write_text(deck.read_text() + "\n".join(cards) + "\n")
        subprocess.run(["ccx", "m"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        rows = [line.split() for line in deck.with_suffix(".dat").read_text().splitlines()]
    unit = 2e-3 * np.pi / np.sqrt(material.young_modulus / material.density)
    found = []
    for n in range(DIAMETERS + 1):
        every = sorted(unit * float(row[4]) for row in rows if len(row) == 6 and row[0] == str(n) and row[1].isdigit())
        found.append([one for one, last in zip(every, [0.0, *every], strict=False) if one > 1.001 * last][:EACH])
    return found


if __name__ == "__main__":
    for which in sys.argv[1:] or BODIES:
        known = json.loads(FILE.read_text()) if FILE.exists() else {}
        known[which] = under_load(which) | ({"frequencies": frequencies(which)} if which in MODES else {})
        FILE.write_text(json.dumps(known, indent=1) + "\n")
