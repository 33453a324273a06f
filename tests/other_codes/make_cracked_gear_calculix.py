"""Write cracked_gear_calculix.json: a whole cracked gear in CalculiX, loaded at one place (by hand).

python -m tests.other_codes.make_cracked_gear_calculix
"""

import json
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from tests.helpers.cracked_gear import Solved, cracked_gear
from tests.other_codes.test_cracked_gear_other_codes import gear

SIZE, TIP = 0.12, 0.05


def made():
    """Deflection of teeth 0 and 1 at the first place under a unit force at the second place of tooth 0."""
    tooth, bore, crack, radii = gear("19 teeth")
    whole = Solved(tooth, bore, cracked_gear(tooth, bore, crack.path(tooth), radii, SIZE, TIP))
    held = np.flatnonzero(np.abs(np.hypot(*whole.points) - bore) < 1e-6 * bore)
    deck = ["*NODE, NSET=NALL", *(f"{i}, {x:.12e}, {y:.12e}" for i, (x, y) in enumerate(whole.points.T, 1))]
    deck += ["*ELEMENT, TYPE=CPE6, ELSET=GEAR"]
    deck += [", ".join(map(str, [i, *(nodes + 1)])) for i, nodes in enumerate(whole.triangles.T, 1)]
    deck += ["*MATERIAL, NAME=M", "*ELASTIC", "1.0, 0.3", "*SOLID SECTION, ELSET=GEAR, MATERIAL=M", "1.0"]
    deck += ["*BOUNDARY", *(f"{n + 1}, 1, 2" for n in held), "*STEP", "*STATIC", "*CLOAD"]
    force, node = whole.load((0, 1)), whole.nodes[0, 1]
    deck += [f"{node + 1}, {c + 1}, {force[2 * node + c]:.12e}" for c in range(2)]
    deck += ["*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "gear.inp").write_text("\n".join(deck))
        subprocess.run(["ccx", "gear"], cwd=name, check=True, stdout=subprocess.DEVNULL)
        rows = [line.split() for line in (Path(name) / "gear.dat").read_text().splitlines()]
    moved = np.zeros(whole.size)
    for row in rows:
        if len(row) == 4 and row[0].isdigit():
            moved[2 * int(row[0]) - 2 : 2 * int(row[0])] = float(row[1]), float(row[2])
    read = {f"c_{i}0": float(whole.load((i, 0)) @ moved) for i in (0, 1)}
    return {"size": SIZE, "tip": TIP, "nodes": whole.points.shape[1], **read}


if __name__ == "__main__":
    (Path(__file__).parent / "cracked_gear_calculix.json").write_text(json.dumps(made(), indent=1) + "\n")
