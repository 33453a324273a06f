"""Write ring_calculix.json: a planet in its ring gear in frictionless contact by CalculiX (by hand, 3 to 6 minutes).

python tests/other_codes/make_ring_calculix.py "two pairs" 10.363872088532364
python tests/other_codes/make_ring_calculix.py "one pair and a tip corner" 10.979875760985975

The planet is turned by what fegear predicts for 290 N/mm, in micrometres along the line of action; what CalculiX tells
is the load that this takes, its shares and the stress of the fillets.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import ring_by_calculix as calculix

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "ring_calculix.json"


def made(position, approach_um):
    """What CalculiX tells."""
    pair, share = calculix.the_pair(), calculix.POSITIONS[position]
    bodies = [calculix.body(pair, member, share) for member in ("driven", "driver")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = calculix.write_deck(folder / "pair.inp", pair, bodies, approach_um * 1e-6)
        alone = dict(os.environ, OMP_NUM_THREADS="1")
        subprocess.run(["ccx", "pair"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
        found = calculix.told(pair, bodies, first, folder / "pair.dat")
    return {"approach_um": approach_um, "nodes": sum(one["points"].shape[1] for one in bodies), **found}


if __name__ == "__main__":
    position, approach = sys.argv[1], float(sys.argv[2])
    known = json.loads(FILE.read_text()) if FILE.exists() else {}
    known[position] = made(position, approach)
    FILE.write_text(json.dumps(known, indent=1) + "\n")
