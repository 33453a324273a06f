"""Three teeth of a helical asymmetric gear against CalculiX (`make_asymmetric_solid_calculix`), either flank loaded.

CalculiX' numbers are extrapolated from two meshes, edges and layers of the finer one half as long.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import make_asymmetric_solid_calculix as made
import solid_by_calculix as calculix

from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid

FOUND = json.loads(made.FILE.read_text())
#: One over two to the third power, less one.
_LEFT = 1.0 / 7.0


def converged(flank, *keys):
    coarse, fine = FOUND[flank]["coarse"], FOUND[flank]["fine"]
    for key in keys:
        coarse, fine = coarse[key], fine[key]
    coarse, fine = np.array(coarse), np.array(fine)
    return fine + _LEFT * (fine - coarse)


@pytest.mark.dear
@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_either_flank_is_as_near_as_those_of_equal_teeth(flank):
    """With the settings and limits of `test_solid_gear_calculix`."""
    shape = made.shape(flank)
    settings = replace(SolidSettings().scaled(1.2), waves_per_module=3.0)
    solid = solve_solid(
        shape.tooth, calculix.twist_of(made.BETA, shape), calculix.FACE, calculix.NU, shape.bore, settings, reach=1,
        sector_teeth=shape.row,
    )  # fmt: skip

    def band(name):
        low, top, high = calculix.hat(calculix.BANDS[name][1])
        return bands(shape.radius, top, top - low, calculix.HALF_WIDTH, after=high - top)

    off = dict.fromkeys(("own", "other", "tension", "compression"), 0.0)
    for loaded in ("middle", "front"):
        own = converged(flank, "deflection", loaded, loaded)
        for name, (tooth, _) in calculix.BANDS.items():
            mine = float(solid.deflection(tooth, band(name), band(loaded))[0, 0])
            kind = "own" if name == loaded else "other"
            off[kind] = max(off[kind], abs(mine - converged(flank, "deflection", loaded, name)) / own)
        for side in ("tension", "compression"):
            wanted = converged(flank, side, loaded)
            mine = solid.largest_root_stress(0, side, band(loaded), calculix.STATIONS)[0][:, 0]
            off[side] = max(off[side], float(np.abs(mine - wanted).max() / np.abs(wanted).max()))
    assert off["other"] < 0.005, off
    assert off["own"] < 0.020, off
    assert off["tension"] < 0.008, off
    assert off["compression"] < 0.018, off
