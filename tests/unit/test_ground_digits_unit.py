"""Digits that a drawing bears: steps of amounts and lengths, and reliefs with them."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.ground_digits import amount_step, rounded_tips, to_step
from fegear.design.tip_relief.grindable import TipReliefPair
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief, roll_of_radius
from fegear.results.relief.grinding import TIP, Grinding, rounded_rows

PINION = Gear(Tooth(21, BasicRack()), 2e-3, 10e-3, 0.02)
WHEEL = Gear(Tooth(47, BasicRack()), 2e-3, 20e-3, 0.02)
RING = Gear(InternalTooth(66, PinionCutter(25, addendum=1.25, tip_radius=0.2)), 2e-3, 0.09)


@pytest.mark.parametrize(
    ("largest", "step"),
    [(12e-6, 1e-7), (1e-6, 1e-7), (0.27e-6, 1e-8), (-0.27e-6, 1e-8), (0.05e-6, 1e-9), (0.0, 1e-7)],
)
def test_amounts_have_a_tenth_of_a_micron_and_two_digits_below_one(largest, step):
    assert amount_step(largest) == pytest.approx(step)


def test_what_is_not_known_stays_so():
    assert math.isnan(to_step(math.nan, 1e-6))
    assert to_step(62.5803503612e-3, 1e-6) == pytest.approx(62.580e-3, abs=1e-15)


def reliefs(gears, amounts, lengths):
    tips = [
        EndRelief(amount, top - math.copysign(length / gear.base_radius, top), top, 2.0)
        for gear, amount, length in zip(gears, amounts, lengths, strict=True)
        for top in [float(roll_of_radius(gear, gear.involute_tip_radius))]
    ]
    nothing = np.zeros(1)
    return TipReliefPair(
        *tips, *(nothing,) * 4, 0.0, 0.0, (tips[0],) * 2, (tips[1],) * 2, np.zeros(4), np.zeros((2, 4)), 0, 0, 0,
        0.0, 0.0, 0.0,
    )  # fmt: skip


@pytest.mark.parametrize("mate", [WHEEL, RING])
def test_rounded_reliefs_start_and_remove_what_the_table_says(mate):
    length = 1.2345678e-3
    sign = 1.0 if mate is WHEEL else -1.0  # towards the tip of a ring its roll angles grow from below
    given = reliefs((PINION, mate), (8.482266e-6, 7.774122e-6), (2.345678e-3, sign * length))
    found = rounded_tips(GearPair(PINION, mate), given)
    for gear, tip, before in ((PINION, found.driver, given.driver), (mate, found.driven, given.driven)):
        diameter = 2e3 * gear.base_radius * math.hypot(1.0, tip.start)
        assert diameter == pytest.approx(round(diameter, 3), abs=1e-9)
        assert diameter == pytest.approx(2e3 * gear.base_radius * math.hypot(1.0, before.start), abs=0.5001e-3)
        assert tip.amount * 1e6 == pytest.approx(round(before.amount * 1e6, 1))
        assert (tip.end, tip.power) == (before.end, before.power)
    again = rounded_tips(GearPair(PINION, mate), found)
    assert again.driver.start == pytest.approx(found.driver.start, abs=1e-12)
    assert again.driver.amount == pytest.approx(found.driver.amount, rel=1e-12)


def test_a_relief_shorter_than_a_step_keeps_its_start():
    given = reliefs((PINION, WHEEL), (5e-6, 5e-6), (2e-7, 2e-7))
    found = rounded_tips(GearPair(PINION, WHEEL), given)
    assert (found.driver.start, found.driven.start) == (given.driver.start, given.driven.start)


def test_rows_are_rounded_by_the_largest_amount_of_their_design():
    def row(design, amount):
        return Grinding(
            "p", "driver", design, TIP, "linear", amount, 0.16410039e-6, 5.123e-6, 62.5803503612e-3,
            0.108941e-3, 70.4e-3, math.radians(18.8834127), 9.0708245e-3,
        )  # fmt: skip

    first, small, tiny = rounded_rows([row("a", 8.482266e-6), row("a", 0.27351e-6), row("b", 0.27351e-6)])
    numbers = SimpleNamespace(**{name: getattr(first, name) for name in ("amount", "start_diameter", "length")})
    assert (numbers.amount * 1e6, numbers.start_diameter * 1e3, numbers.length * 1e3) == pytest.approx(
        (8.5, 62.58, 9.071), abs=1e-9
    )
    assert math.degrees(first.start_roll_angle) == pytest.approx(18.88, abs=1e-9)
    assert (first.amount_error, first.start_diameter_error) == pytest.approx((0.16e-6, 0.11e-3))
    assert (small.amount * 1e6, tiny.amount * 1e6) == pytest.approx((0.3, 0.27), abs=1e-9)
    assert math.isnan(first.amount_from)
