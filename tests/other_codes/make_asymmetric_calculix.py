"""Write asymmetric_calculix.json: a pair of asymmetric teeth in frictionless contact by CalculiX (by hand, minutes).

python tests/other_codes/make_asymmetric_calculix.py drive "two pairs"

The driver is turned by what fegear predicts for 200 N/mm; what CalculiX finds is the load that this takes, its shares
and the stress of the fillets.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import ring_by_calculix as calculix

from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair

FILE = Path(__file__).parent / "asymmetric_calculix.json"
LINE_LOAD = 200.0  # [N/mm]
#: Flank and roll position as a share of a base pitch after the start of the path.
POSITIONS = {("drive", "two pairs"): 0.15, ("drive", "one pair"): 0.6, ("coast", "two pairs"): 0.2}


def the_pair(flank):
    """30 degrees driving, 20 coasting."""
    rack = AsymmetricRack(RackFlank(math.radians(30.0), 0.15), RackFlank(math.radians(20.0), 0.3))
    gears = [
        Gear(AsymmetricTooth(z, rack, x).side(flank), 3e-3, bore, 20e-3)
        for z, x, bore in ((22, 0.2, 15e-3), (31, 0.0, 25e-3))
    ]
    return GearPair(*gears)


def engagement(flank):
    """As fegear has it, with its finest usual meshes."""
    pair = the_pair(flank)
    driver, driven = (
        finite_element_compliance(solve_gear(gear, settings_at(0), reach=3, estimate_error=False))
        for gear in (pair.driver, pair.driven)
    )
    return Engagement(PairCompliance(pair, driver, driven), corner_contact=True)


def made(flank, position):
    """What CalculiX finds under fegear's approach."""
    pair, share = the_pair(flank), POSITIONS[flank, position]
    e = engagement(flank)
    state = e.solve(e.grid([pair.x_start + share * pair.base_pitch]), [LINE_LOAD * 1e3 * pair.face_width])
    approach = float(state.transmission_error[0, 0])
    bodies = [calculix.body(pair, member, share) for member in ("driven", "driver")]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        first = calculix.write_deck(folder / "pair.inp", pair, bodies, approach)
        alone = dict(os.environ, OMP_NUM_THREADS="1")
        subprocess.run(["ccx", "pair"], cwd=folder, check=True, stdout=subprocess.DEVNULL, env=alone)
        found = calculix.told(pair, bodies, first, folder / "pair.dat")
    return {"approach_um": approach * 1e6, "nodes": sum(one["points"].shape[1] for one in bodies), **found}


if __name__ == "__main__":
    flank, position = sys.argv[1:3]
    known = json.loads(FILE.read_text()) if FILE.exists() else {}
    known[f"{flank}, {position}"] = made(flank, position)
    FILE.write_text(json.dumps(known, indent=1) + "\n")
