"""Test gears of the NASA four-square rig: the numbers printed in W. D. Mark's report, section 5."""

import math

import pytest

from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE = 25.4e-3 / 8


def test_printed_geometry_of_the_four_square_test_gears():
    gear = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25, math.radians(20.0))), MODULE, 20e-3)
    pair = GearPair(gear, gear)
    # Printed with five or six digits, so half a unit of the last one; L_nominal is printed to 1e-5 cm
    # although its own inputs round to that, hence one unit.
    assert pair.base_pitch * 100 == pytest.approx(0.93730, abs=5e-6)
    assert gear.base_radius * 100 == pytest.approx(4.17693, abs=5e-6)
    assert pair.path_length * 100 == pytest.approx(1.53530, abs=1e-5)
    assert pair.contact_ratio == pytest.approx(1.638, abs=5e-4)


def test_active_length_of_the_tip_relief_gears_ends_where_the_relief_of_the_tip_corner_starts():
    # L = 1.37450 cm belongs to an active tip 0.381 mm below the addendum circle (PAPERS, Mark).
    short = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25), tip_radius=15.0 - 0.381e-3 / MODULE), MODULE, 20e-3)
    assert GearPair(short, short).path_length * 100 == pytest.approx(1.37450, abs=1e-5)
