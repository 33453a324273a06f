"""A rack of seven teeth compared with CalculiX, all teeth explicit (`make_rack_calculix.py`)."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.rack.solved_rack import solve_rack_teeth
from fegear.fem.plane.settings import settings_at

sys.path.insert(0, str(Path(__file__).parent))
import rack_by_calculix as calculix

TOLD = json.loads(Path(__file__).with_name("rack_calculix.json").read_text())


@pytest.fixture(scope="module")
def rack():
    """Solved a little coarser than usual."""
    return solve_rack_teeth(
        calculix.TOOTH, calculix.BODY, calculix.TEETH, calculix.NU, "strain", settings_at(-1), reach=3
    )[0]


@pytest.mark.parametrize("loaded", calculix.LOADED)
def test_deflections_and_root_stress(rack, loaded):
    told, one = TOLD[str(loaded)], rack.loaded(loaded)
    place, half = np.array([calculix.HEIGHT]), np.array([calculix.HALF_WIDTH])
    load = one.flank.patches(*one.place(place, half))[:, 0]
    size = told["deflection"][loaded]
    for k, c in one.compliance.items():
        assert load @ c @ load == pytest.approx(told["deflection"][loaded + k], abs=5e-4 * size)
    for side in ("tension", "compression"):
        assert one.largest_root_stress(0, side, place, half)[0][0] == pytest.approx(
            told[side], rel=8e-3
        )  # its largest Gauss point
