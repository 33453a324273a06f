"""Profile modifications: shapes, starts, refusals."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import (
    CombinedRelief,
    TabulatedRelief,
    crowning,
    modified_flank,
    normalised_tip_relief,
    roll_of_radius,
    root_relief,
    tip_relief,
)

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))
GEAR = Gear(TOOTH, 3.175e-3, 0.02, 6.35e-3)
PAIR = GearPair(GEAR, GEAR)
TIP = float(roll_of_radius(GEAR, GEAR.involute_tip_radius))


@pytest.mark.parametrize(("shape", "middle"), [("linear", 5e-6), ("parabolic", 2.5e-6)])
def test_tip_relief_runs_from_start_to_tip(shape, middle):
    start = TIP - 0.08
    r = tip_relief(GEAR, 10e-6, start_roll=start, shape=shape)
    np.testing.assert_allclose(r.removal([start - 0.1, start, start + 0.04, TIP]), [0, 0, middle, 10e-6], atol=1e-18)
    assert r.kinks == (start,)


def test_the_three_ways_to_say_where_a_relief_starts_agree():
    length = 3e-3
    by_length = tip_relief(GEAR, 1e-5, length=length)
    by_roll = tip_relief(GEAR, 1e-5, start_roll=TIP - length / GEAR.base_radius)
    radius = math.hypot(GEAR.base_radius, TIP * GEAR.base_radius - length)
    by_radius = tip_relief(GEAR, 1e-5, start_radius=radius)
    assert by_length.start == pytest.approx(by_roll.start, rel=1e-14)
    assert by_radius.start == pytest.approx(by_roll.start, rel=1e-12)


def test_amount_may_be_measured_below_the_tip():
    """Mark's tip-relief gears: linear in x, 0.01524 mm at the addendum radius less 0.381 mm."""
    at = GEAR.tip_radius - 0.381e-3
    r = tip_relief(GEAR, 0.01524e-3, start_roll=0.44, at_radius=at)
    assert r.removal(roll_of_radius(GEAR, at)) == pytest.approx(0.01524e-3, rel=1e-14)
    assert r.removal(TIP) > 0.01524e-3


def test_root_relief_grows_inward():
    r = root_relief(GEAR, 8e-6, end_radius=GEAR.form_radius, length=2e-3, shape="parabolic")
    inner = float(roll_of_radius(GEAR, GEAR.form_radius))
    step = 1e-3 / GEAR.base_radius
    np.testing.assert_allclose(r.removal([inner, inner + step, inner + 3 * step]), [8e-6, 2e-6, 0], atol=1e-17)


def test_normalised_length_one_is_the_hpstc_and_the_pitch_point_is_1284():
    """TM-89901: the first relief length runs from the tip to the HPSTC; the pitch point is at L_n = 1.284."""
    r = normalised_tip_relief(PAIR, "driver", 2e-5, 1.0)
    assert r.start == pytest.approx(float(PAIR.roll_angle(PAIR.x_hpstc, "driver")), rel=1e-14)
    driven = normalised_tip_relief(PAIR, "driven", 2e-5, 1.0)
    assert driven.start == pytest.approx(r.start, rel=1e-12)
    pitch = (TIP - float(PAIR.roll_angle(0.0, "driver"))) / (TIP - r.start)
    assert pitch == pytest.approx(1.284, abs=5e-4)


def test_crowning_is_a_parabola_about_the_middle():
    c = crowning(GEAR, 4e-6, GEAR.form_radius, GEAR.tip_radius)
    a, b = c.start, c.end
    np.testing.assert_allclose(c.removal([a, 0.5 * (a + b), b, 0.75 * a + 0.25 * b]), [4e-6, 0, 4e-6, 1e-6], atol=1e-18)


def test_tables_interpolate_and_are_held_beyond_their_ends():
    """A table of 31 to 33 mm that went on straight added 19.3 um of material below, where its first entry is 2.3."""
    linear = TabulatedRelief(np.array([0.2, 0.3, 0.5]), np.array([2e-6, 0.0, 4e-6]))
    for kept in (linear.roll, linear.values):
        with pytest.raises(ValueError, match="read-only"):
            kept[0] = 0.0
    np.testing.assert_allclose(linear.removal([0.1, 0.2, 0.25, 0.4, 0.6]), [2e-6, 2e-6, 1e-6, 2e-6, 4e-6], atol=1e-18)
    t = np.linspace(0.2, 0.5, 13)
    cubic = TabulatedRelief(t, (t - 0.35) ** 2, "cubic")
    fine = np.linspace(0.2, 0.5, 200)
    assert np.abs(cubic.removal(fine) - (fine - 0.35) ** 2).max() < 2e-4
    assert (np.diff(cubic.removal(np.linspace(0.36, 0.5, 300))) > 0).all()
    np.testing.assert_allclose(cubic.removal([0.0, 0.1, 0.6, 9.0]), cubic.values[[0, 0, -1, -1]], rtol=1e-14)


def test_parts_add_up():
    a, b = tip_relief(GEAR, 1e-5, length=2e-3), crowning(GEAR, 2e-6, GEAR.form_radius, GEAR.tip_radius)
    both = CombinedRelief((a, b))
    t = np.linspace(0.2, TIP, 30)
    np.testing.assert_allclose(both.removal(t), a.removal(t) + b.removal(t))
    assert both.kinks == a.kinks


def test_modified_flank_lies_inside_the_involute_by_the_removal():
    r = tip_relief(GEAR, 1e-5, length=3e-3)
    t = np.linspace(0.3, TIP, 50)
    exact = GEAR.tooth.involute.points(t) * GEAR.module
    np.testing.assert_allclose(np.hypot(*(exact - modified_flank(GEAR, r, t))), r.removal(t), atol=1e-17)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: tip_relief(GEAR, 1e-5),
        lambda: tip_relief(GEAR, 1e-5, start_roll=0.4, length=1e-3),
        lambda: tip_relief(GEAR, 1e-5, start_roll=TIP + 0.1),
        lambda: tip_relief(GEAR, 1e-5, start_radius=GEAR.base_radius * 0.9),
        lambda: tip_relief(GEAR, 1e-5, length=1e-3, shape="round"),
        lambda: tip_relief(GEAR, math.nan, length=1e-3),
        lambda: root_relief(GEAR, 1e-5, end_radius=GEAR.form_radius, start_roll=0.0),
        lambda: normalised_tip_relief(PAIR, "driver", 1e-5, 0.0),
        lambda: crowning(GEAR, 1e-6, GEAR.tip_radius, GEAR.form_radius),
        lambda: TabulatedRelief(np.array([0.3, 0.2]), np.zeros(2)),
        lambda: TabulatedRelief(np.array([0.3]), np.zeros(1)),
    ],
)
def test_nonsense_is_refused(wrong):
    with pytest.raises(InputError, match=r"relief"):
        wrong()


@pytest.mark.parametrize(
    ("make", "key"),
    [
        (lambda: tip_relief(GEAR, 1e-5, length=1e-3, at_radius=0.02), "relief.tip.at_radius"),
        (lambda: tip_relief(GEAR, 1e-5, start_radius=0.02), "relief.tip.start_radius"),
        (lambda: root_relief(GEAR, 1e-5, length=1e-3, end_radius=0.02), "relief.root.end_radius"),
        (lambda: crowning(GEAR, 1e-5, 0.02, 0.045), "relief.crowning.start_radius"),
    ],
    ids=["measured", "tip", "root", "crowning"],
)
def test_a_radius_inside_the_base_circle_is_refused_by_its_own_key(make, key):
    """Roll angles of nan went on, with a warning of numpy, to "must lie below the tip's nan rad"."""
    with pytest.raises(InputError, match="lies inside the base circle of 41") as refused:
        make()
    assert refused.value.key == key
