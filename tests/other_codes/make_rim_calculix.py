"""Write rim_calculix.json: ring gears on pins and in a spline by CalculiX (by hand, a minute).

python tests/other_codes/make_rim_calculix.py
"""

import json
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import rim_by_calculix as calculix

FILE = Path(__file__).parents[2] / "fegear" / "verify" / "data" / "rim_calculix.json"
#: Edges along flank and fillet of the loaded tooth and of the others, in multiples of the usual ones.
COARSENESS, OTHERS = 0.4, 0.4

if __name__ == "__main__":
    known = {}
    for ring in calculix.RINGS:
        with tempfile.TemporaryDirectory() as name:
            known[ring] = calculix.solved(Path(name), ring, COARSENESS, OTHERS)
    FILE.write_text(json.dumps(known, indent=1) + "\n")
