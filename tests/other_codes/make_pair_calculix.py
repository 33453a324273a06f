"""Write pair_calculix.json: two whole solid gears in frictionless contact by CalculiX (run by hand).

python tests/other_codes/make_pair_calculix.py coarse "two whole lines"
python tests/other_codes/make_pair_calculix.py coarse "a line that ends at the tip"
python tests/other_codes/make_pair_calculix.py fillets "two whole lines"
python tests/other_codes/make_pair_calculix.py fillets "a line that ends at the tip"

Each run has two steps, aligned and with the driver tilted in the plane of action. Driver and driven are turned against
each other by what fegear predicts for 900 N; what CalculiX tells is the load that this takes, its shares and the stress
of the fillets. A run of the coarse mesh (122,000 equations) takes some 20 iterations of ten seconds of one core, with
finer fillets as many of twelve. Of "fillets" the committed file has the tilted steps alone.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import pair_by_calculix as calculix
import pair_meshed as meshed

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "pair_calculix.json"


def made(level, position):
    """What both steps tell, and the seconds that CalculiX took."""
    pair, share = meshed.the_pair(), meshed.POSITIONS[position]
    bodies = [meshed.body(pair, member, share, level) for member in ("driven", "driver")]
    steps = calculix.APPROACHES[position]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = calculix.write_deck(folder / "pair.inp", pair, bodies, steps)
        started = time.perf_counter()
        alone = dict(os.environ, OMP_NUM_THREADS="1")
        subprocess.run(["ccx", "pair"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
        found = calculix.told(pair, bodies, first, steps, calculix.read_steps(folder / "pair.dat"))
    nodes = sum(one.points.shape[1] for one in bodies)
    return {"nodes": nodes, "seconds": round(time.perf_counter() - started), "steps": found}


if __name__ == "__main__":
    level, position = sys.argv[1:3]
    result = made(level, position)
    known = json.loads(FILE.read_text()) if FILE.exists() else {}
    known.setdefault(position, {})[level] = result
    FILE.write_text(json.dumps(known, indent=1) + "\n")
    print(position, level, result["nodes"], result["seconds"])
