"""Either flank of three asymmetric gears beside CalculiX on meshes of whole gears (make_asymmetric_gears_calculix).

The coast flank is pressed where it stands, on the left of the tooth that is seen from its drive flank.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import make_asymmetric_gears_calculix as calculix

from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape

FOUND = json.loads(calculix.FILE.read_text())


@pytest.mark.parametrize("flank", ["drive", "coast"])
@pytest.mark.parametrize("name", calculix.GEARS)
def test_compliance_and_root_stress_of_either_flank(name, flank):
    side, known = calculix.the_tooth(name).side(flank), FOUND[name][flank]
    radius, settings = np.array([calculix.the_radius(side)]), settings_at(-1)
    ring = influence_of_shape(side, 0.6 * side.root_radius, calculix.NU, "strain", settings, 1)
    c_self = ring.self_compliance(radius, settings.patch_half_width, calculix.WIDTH)
    assert c_self == pytest.approx([known["c_self"]], rel=2e-4)
    for fillet in ("tension", "compression"):
        found = ring.largest_root_stress(0, fillet, radius, calculix.WIDTH)[0]
        assert found == pytest.approx([known[fillet]], rel=2e-3), fillet
