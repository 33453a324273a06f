"""Write asymmetric_solid_calculix.json: three teeth of a helical asymmetric gear by CalculiX (by hand, minutes).

python tests/other_codes/make_asymmetric_solid_calculix.py drive|coast

As `make_solid_calculix`; the teeth stand in a row with free sides.
"""

import json
import math
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix

from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth

FILE = Path(__file__).parent / "asymmetric_solid_calculix.json"
BETA = math.radians(20.0)
#: As of `make_solid_calculix`, coarser.
LEVELS = {"coarse": (2.5, (0.2, 0.3), 0.5), "fine": (1.25, (0.1, 0.15, 0.25), 0.25)}
TOOTH = AsymmetricTooth(
    13, AsymmetricRack(RackFlank(math.radians(28.0), 0.15), RackFlank(math.radians(20.0), 0.25)), 0.3
)  # fmt: skip


def shape(flank):
    """Where bands press: the middle of the flank."""
    side = TOOTH.side(flank)
    radius = math.sqrt(0.5 * (side.form_radius**2 + side.involute_tip_radius**2))
    return calculix.Shape(side, 0.6 * side.root_radius, radius, 3)


def made(flank, level):
    """Numbers of one flank on one mesh."""
    mesh, bands = calculix.solid(BETA, *LEVELS[level], shape=shape(flank))
    with tempfile.TemporaryDirectory() as folder:
        fields = calculix.solve(Path(folder), "g", mesh, bands, ("middle", "front"), shape=shape(flank))
    return calculix.told(mesh, bands, fields)


if __name__ == "__main__":
    for flank in sys.argv[1:]:
        for level in LEVELS:
            found = json.loads(FILE.read_text()) if FILE.exists() else {}
            found.setdefault(flank, {})[level] = made(flank, level)
            FILE.write_text(json.dumps(found, indent=1) + "\n")
            print(flank, level, found[flank][level]["nodes"], flush=True)
