"""Write converged_gears.json: nine gears with converged values, solved as in make_random_gears.py (run by hand).

python tests/golden/make_converged_gears.py
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from make_random_gears import converged

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

RACKS = {"0.25": BasicRack(1.0, 1.25, 0.25), "0.38": BasicRack.named("A"), "full": BasicRack.full_fillet()}
#: teeth, profile shift, rack tip radius, bore over root radius
GEARS = [
    (17, 0.3, "0.25", 0.5),
    (17, -0.1, "0.38", 0.5),
    (28, 0.0, "0.25", 0.5),
    (28, 0.0, "full", 0.5),
    (28, 0.0, "0.25", 0.95),
    (40, 0.0, "0.38", 0.7),
    (40, 0.5, "full", 0.9),
    (100, 0.0, "0.25", 0.5),
    (100, 0.2, "0.38", 0.95),
]


def told(teeth, shift, rack, bore):
    """One gear at nine load positions from the start of the involute to the tip."""
    values = converged(Tooth(teeth, RACKS[rack], shift), bore, 0.3, "strain", positions=9)
    return {"teeth": teeth, "profile_shift": shift, "rack": rack, "bore": bore} | values


if __name__ == "__main__":
    out = Path(__file__).with_name("converged_gears.json")
    out.write_text(json.dumps([told(*gear) for gear in GEARS], indent=1) + "\n")
