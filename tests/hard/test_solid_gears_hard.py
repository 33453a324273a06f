"""Estimated errors of solid gears of all sorts against finer solutions: the true one is larger in one at most."""

import math
from dataclasses import replace

import pytest

from fegear.fem.solid import SolidInfluence, SolidSettings, solid_influence, solid_settings, solve_solid
from fegear.fem.solid.influence import _SHARES as SHARES
from fegear.geometry import BasicRack, Tooth

#: Teeth, helix angle [deg], width [modules], bore over root radius, profile shift.
GEARS = [
    (12, 20, 3, 0.5, 0.3), (14, 0, 5, 0.6, 0.4), (18, 30, 4, 0.4, 0.2), (23, 20, 10, 0.5, 0.1), (28, 0, 8, 0.5, 0.0),
    (28, 35, 6, 0.7, 0.0), (40, 15, 12, 0.8, 0.0), (57, 20, 10, 0.9, -0.1), (80, 10, 5, 0.93, 0.0),
    (120, 25, 4, 0.9, 0.0), (20, 8, 20, 0.3, 0.0), (35, 28, 3, 0.85, 0.2),
]  # fmt: skip


def estimated_and_true(gear, settings, finer):
    teeth, degrees, width, bore, shift = gear
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.3), shift)
    shape = (tooth, math.tan(math.radians(degrees)) / (0.5 * teeth), float(width), 0.3, bore * tooth.root_radius)
    known = solid_influence(*shape, settings)
    # the finer solution in the coarser one's place: what `error` then tells is the difference from it, times shares
    true = SolidInfluence(known.fine, solve_solid(*shape, finer), {}).error
    return known.error, true


def test_a_coarse_solution_tells_its_error():
    told, true = estimated_and_true((12, 20, 2, 0.5, 0.3), SolidSettings().scaled(1.6), SolidSettings())
    assert all(true[key] / SHARES[key] <= told[key] for key in told)


@pytest.mark.long
def test_twelve_gears_tell_their_errors():
    finer = replace(solid_settings(3e-3), waves_per_module=2.4, band_half_width=0.17)
    above = dict.fromkeys(("contact", "neighbour", "root_tension", "root_compression"), 0)
    for gear in GEARS:
        told, true = estimated_and_true(gear, SolidSettings(), finer if gear[2] < 9 else solid_settings(3e-3))
        for key in above:
            # the shares are of what a coarser solution differs; the true error is the whole difference from a finer one
            above[key] += true[key] / SHARES[key] > told[key]
    assert max(above.values()) <= 1
