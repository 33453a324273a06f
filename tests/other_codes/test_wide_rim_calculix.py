"""A wide helical ring in a spline compared with CalculiX: quadratic solids of all its teeth."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import solid_settings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.rim_support import RimSupport

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix
import wide_rim_by_calculix as ring


def band(name):
    low, top, high = calculix.hat(calculix.BANDS[name][1])
    return bands(ring.RING.radius, top, top - low, calculix.HALF_WIDTH, after=high - top)


@pytest.mark.long
@pytest.mark.parametrize("load", ["middle", "front"])
def test_a_whole_wide_ring_in_a_spline_is_that_of_calculix(tmp_path, program, load):
    """70 s of CalculiX a load, 72,000 nodes. Seen: deflections .2 %; root compression .4 % of the largest."""
    beta = math.radians(20.0)
    mesh, named = calculix.solid(beta, 1.0, (0.5,), 0.5, shape=ring.RING)
    moved = ring.solve(tmp_path, mesh, named[load], program("ccx"))
    known = solve_solid(
        ring.RING.tooth, calculix.twist_of(beta, ring.RING), calculix.FACE, calculix.NU, ring.RING.bore,
        solid_settings(3e-3), support=RimSupport(),
    )  # fmt: skip
    for name, (tooth, _) in calculix.BANDS.items():
        mine = float(known.deflection(tooth, band(name), band(load))[0, 0])
        assert mine == pytest.approx(calculix.deflection(moved, named[name]), rel=3e-3)
    mine = known.largest_root_stress(0, "compression", band(load), calculix.STATIONS)[0][:, 0]
    wanted = calculix.largest_along(mesh, moved, "back_fillet", -1, -1)
    np.testing.assert_allclose(mine, wanted, atol=8e-3 * np.abs(wanted).max())


def test_tractions_of_the_spline_have_the_cylinder_s_area_and_moments():
    mesh, _ = calculix.solid(0.0, 6.0, (0.5,), 0.5, shape=ring.RING)
    work = np.einsum("rcn,scn->rs", ring.rigid(mesh.points), ring.even_tractions(mesh))
    outer, width = ring.RING.bore, calculix.FACE
    tilt = 0.5 * outer**2 + width**2 / 12.0
    wanted = 2.0 * math.pi * outer * width * np.diag([1.0, 1.0, 1.0, tilt, tilt, outer**2])
    np.testing.assert_allclose(work, wanted, atol=1e-4 * wanted.max())
