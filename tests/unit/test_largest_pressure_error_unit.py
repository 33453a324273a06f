"""Estimated error of the largest Hertzian pressure: what the load's leaves, and what lies between the positions."""

import numpy as np
import pytest

from fegear.contact.loaded_teeth import LoadHistory
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.pair_history import PairHistory, pair_history
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.relief import UNMODIFIED, EndRelief
from fegear.geometry.tooth import Tooth


def history(x, pressure, load_error):
    """Positions with such a pressure under 100 N."""
    load, share = np.full((len(x), 1), 100.0), np.ones((len(x), 1))
    found = PairHistory(np.asarray(x, dtype=float), load[:, 0], load, share, load, np.reshape(pressure, (-1, 1)), load)
    return LoadHistory(found, 0, None if load_error is None else np.full_like(load, load_error), None)


def test_a_peak_between_positions_is_that_of_the_parabola():
    x = np.array([0.0, 1.0, 2.3, 3.0, 4.0])
    pressure = 1e9 - 3e7 * (x - 2.0) ** 2
    found = history(x, pressure, 0.0)
    assert found.largest_pressure_error == pytest.approx(1e9 - found.largest_hertz_pressure, rel=1e-9)


@pytest.mark.parametrize("where", [2.1, 2.4, 2.9, 3.2])
def test_a_kink_between_positions_is_where_the_lines_from_both_sides_meet(where):
    x = np.arange(7.0)
    pressure = 1e9 - np.where(x < where, 2e7, 5e7) * np.abs(x - where)
    found = history(x, pressure, 0.0)
    assert found.largest_pressure_error == pytest.approx(1e9 - found.largest_hertz_pressure, rel=1e-9)


def test_a_pair_bears_no_more_than_the_whole_load_between_positions():
    x, share = np.arange(5.0), np.array([0.5, 0.9, 0.98, 0.7, 0.4])
    found = history(x, np.ones(5), 0.0)
    found.found.load[:, 0], found.found.share[:, 0] = 100.0 * share, share
    assert found.largest_load_error == pytest.approx(2.0, rel=1e-9)
    assert found.largest_share_error == pytest.approx(2.0 / 98.0, rel=1e-9)
    found.found.load[:, 0], found.found.share[:, 0] = 50.0 * share, 0.5 * share
    assert found.largest_load_error == pytest.approx(14.0 * 16.0 / 34.0, rel=1e-9)  # the lines meet so far above


def test_half_of_the_loads_relative_error_is_added():
    """A pressure grows with the root of the load."""
    x = np.array([0.0, 1.0, 2.0])
    pressure = np.array([0.9e9, 1e9, 0.9e9])
    assert history(x, pressure, 4.0).largest_pressure_error == pytest.approx(0.5 * 0.04 * 1e9, rel=1e-9)
    assert history(x, pressure, None).largest_pressure_error is None


@pytest.mark.parametrize("x", [[0.0, 1.0, 1.0 + 1e-6, 2.0], [0.0, 1.0 - 1e-6, 1.0, 2.0]])
def test_beside_a_jump_whose_two_sides_are_positions_nothing_lies_between(x):
    found = history(x, [0.5e9, 0.6e9, 1e9, 0.9e9] if x[1] == 1.0 else [0.9e9, 1e9, 0.6e9, 0.5e9], 0.0)
    assert 0.0 < found.largest_pressure_error < 1e-8 * found.largest_hertz_pressure


def test_at_an_end_of_the_path_only_digits_are_left():
    found = history([0.0, 1.0, 2.0], [1e9, 0.9e9, 0.7e9], 0.0)
    assert 0.0 < found.largest_pressure_error < 1e-8 * 1e9


@pytest.mark.parametrize("positions", [8, 13, 20, 60])
@pytest.mark.parametrize("amount", [0.0, 20e-6])
def test_few_positions_state_what_many_give_more(positions, amount):
    gears = [Gear(Tooth(z), 3e-3, 0.3 * z * 3e-3, 0.02) for z in (28, 41)]
    pair = GearPair(*gears)
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in gears]
    compliance = PairCompliance(pair, *sources, False, "load-dependent", 4000.0)
    start, end = (float(pair.roll_angle(x, "driver")) for x in (pair.x_lpstc, pair.x_end))
    e = Engagement(compliance, driver_relief=EndRelief(amount, start, end) if amount else UNMODIFIED)

    def found(count):
        one = pair_history(e, [4000.0], count)
        return LoadHistory(one, 0, np.zeros_like(one.load), None)

    few, many = found(positions), found(4000)
    assert many.largest_hertz_pressure - few.largest_hertz_pressure <= 1.5 * few.largest_pressure_error
