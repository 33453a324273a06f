"""A cracked solid gear beside a whole gear by another mesh and code: `make_cracked_solid_calculix.py`."""

import json
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.solid.bands import bands
from fegear.fem.solid.odd.odd_solid_solution import solve_odd_solid
from fegear.fem.solid.settings import solid_settings
from tests.other_codes.test_cracked_gear_other_codes import gear

KEPT = json.loads((Path(__file__).parent / "cracked_solid_calculix.json").read_text())
#: Half-width of the bands that stand for CalculiX's lines [modules]: those of 0.1 change c_ij between two places of one
#: flank by 4e-4 of the largest.
HALF_WIDTH = 0.02


@pytest.fixture(scope="module", params=[1e-2, 3e-3], ids=["usual", "finer"])
def solved(request):
    """Tolerance, gear, and its loaded places."""
    tooth, bore, crack, radii = gear(KEPT["gear"])
    settings = solid_settings(request.param)
    found = solve_odd_solid(tooth, 0.0, KEPT["width"], 0.3, bore, settings, odd={0: crack}, reach=2)
    return request.param, found, bands(np.array(radii), 0.0, 0.5 * KEPT["width"], HALF_WIDTH, profile="even")


@pytest.mark.dear
def test_couplings_are_those_of_calculix(solved):
    """15-node wedges, 100,000 nodes, the crack's front along the whole face; loads even along it."""
    _, found, line = solved
    wide = bands(line.radius, 0.0, 0.5 * KEPT["width"], 0.1, profile="even")
    largest = float(found.deflection(0, 0, wide, wide).max())
    for key, expected in KEPT["c"].items():
        i, p, j, q = map(int, key.split())
        off = (found.deflection(i, j, line, line)[p, q] - expected) / largest
        assert abs(off) < (2e-4 if i == j else 6e-5), key


@pytest.mark.dear
def test_root_stress_is_that_of_calculix(solved):
    """Of the cracked tooth, beside its mouth and on the other side, and of its neighbours; loads on either.

    Of itself, or of the largest of the gear where it is small: that of the next tooth is at its fillet's end. Between
    tolerances of 0.3 and 0.1 % the largest one moves by 3e-4; at 0.1 % it is 1.9e-3 off still: the reference is of one
    mesh.
    """
    tolerance, found, line = solved
    largest = max(abs(value) for value in KEPT["root"].values())
    for key, expected in KEPT["root"].items():
        i, side, j, q = key.split()
        value = float(found.largest_root_stress(int(i), int(j), side, line, [KEPT["z"]])[0][0, int(q)])
        assert value == pytest.approx(expected, rel=2.5e-3 if tolerance < 5e-3 else 6e-3, abs=1.2e-3 * largest), key
