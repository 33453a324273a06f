"""Write solid_calculix.json: whole gears by CalculiX, spur and with 20 degrees of helix (run by hand).

python tests/other_codes/make_solid_calculix.py [spur|helical|ring|helical_ring]...

Gears have ten teeth; of a ring's twenty, five are meshed, in a row with free sides.

Edges of tooth 0 and layers of the finer mesh are half as long as those of the coarser one. On two cores the coarser
mesh takes half a minute a load, the finer one three minutes and 4 GB.
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "solid_calculix.json"
#: Edge lengths of tooth 0 as a multiple of the usual ones; the layers from an end of the face, and inside it [modules].
LEVELS = {"coarse": (2.0, (0.2, 0.3), 0.5), "fine": (1.0, (0.1, 0.15, 0.25), 0.25)}
CASES = {
    "spur": (0.0, ("middle", "front"), calculix.EXTERNAL),
    "helical": (20.0, ("middle", "front", "back"), calculix.EXTERNAL),
    "ring": (0.0, ("middle", "front"), calculix.RING),
    "helical_ring": (20.0, ("middle", "front", "back"), calculix.RING),
}


def made(case, level):
    """Numbers of one gear on one mesh, and the seconds they took."""
    degrees, loaded, shape = CASES[case]
    mesh, bands = calculix.solid(np.radians(degrees), *LEVELS[level], shape=shape)
    started = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        fields = calculix.solve(Path(folder), "g", mesh, bands, loaded, shape=shape)
    return calculix.told(mesh, bands, fields, shape.tooth.side) | {"seconds": round(time.perf_counter() - started, 1)}


if __name__ == "__main__":
    for case in sys.argv[1:] or CASES:
        for level in LEVELS:
            found = json.loads(FILE.read_text()) if FILE.exists() else {}
            found.setdefault(case, {"helix_angle": CASES[case][0]})[level] = made(case, level)
            FILE.write_text(json.dumps(found, indent=1) + "\n")
            print(case, level, found[case][level]["nodes"], found[case][level]["seconds"], flush=True)
