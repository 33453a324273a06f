"""A cracked solid gear beside a whole gear by another mesh and code: `make_cracked_solid_calculix.py`."""

import json
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.solid.bands import bands
from fegear.fem.solid.odd.odd_solid_solution import solve_odd_solid
from fegear.fem.solid.settings import SolidSettings
from tests.other_codes.test_cracked_gear_other_codes import gear

#: Half-width of the bands that stand for CalculiX's lines [modules].
HALF_WIDTH = 0.1


def couplings(settings):
    """c_ij of the places that CalculiX was asked for, both, and the largest c_00 of these bands [1/(E module)]."""
    kept = json.loads((Path(__file__).parent / "cracked_solid_calculix.json").read_text())
    tooth, bore, crack, radii = gear(kept["gear"])
    found = solve_odd_solid(tooth, 0.0, kept["width"], 0.3, bore, settings, odd={0: crack}, reach=1)
    line = bands(np.array(radii), 0.0, 0.5 * kept["width"], HALF_WIDTH, profile="even")
    places = [tuple(map(int, key.split())) for key in kept["c"]]
    own = np.array([found.deflection(i, j, line, line)[p, q] for i, p, j, q in places])
    return places, own, np.array(list(kept["c"].values())), float(found.deflection(0, 0, line, line).max())


@pytest.mark.dear
def test_couplings_are_those_of_calculix():
    """15-node wedges, some 50,000 nodes, the crack's front along the whole face; loads even along it.

    Quadratic wedges at the crack's tip are too stiff by what is left on the cracked tooth itself: finer sections and
    more functions along the face change these numbers by 3e-4.
    """
    places, found, expected, largest = couplings(SolidSettings())
    off = (found - expected) / largest
    beside = np.array([i != j for i, _, j, _ in places])
    assert np.abs(off[beside]).max() < 1.5e-4
    assert np.abs(off).max() < 1.6e-3
    assert (off[~beside] > 0.0).all()
