"""Limits of tip reliefs to be found: which gears have one, largest amounts, lengths and starts."""

import math
from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.case.built.relief_limits import relief_limits
from fegear.case.design import DesignPart
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.load_range import LoadRange
from fegear.design.relief_bench import bench
from fegear.design.tip_relief.grindable import grindable, relief_over_path
from fegear.design.tip_relief.relief_limits import ReliefLimits
from fegear.engine.sheet.seen import Seen
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import roll_of_radius
from fegear.results.relief.relief_answer import _at_limits

GEARS = [Gear(Tooth(z, BasicRack()), 3e-3, 0.1 * z * 3e-3, 0.02) for z in (24, 36)]
PAIR = GearPair(*GEARS)
INF = math.inf
OVER = LoadRange((3000.0, 6000.0))


@pytest.fixture(scope="module")
def engagement():
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in GEARS]
    return Engagement(PairCompliance(PAIR, *sources, hertz="linear", nominal_load=6000.0))


def limits(**keys):
    return relief_limits(DesignPart.model_validate(keys), PAIR)


def test_nothing_is_limited_by_default():
    assert limits() is None


def test_one_gear_only_leaves_the_other_without_amount():
    assert limits(relieve="driver") == ReliefLimits((INF, 0.0), (INF, INF))
    assert limits(limits={"amount": "0.3 mm"}).amounts == pytest.approx((3e-4, 3e-4))  # a tenth of the module
    found = limits(relieve="driven", limits={"amount": "20 um"})
    assert found.amounts == (0.0, pytest.approx(20e-6))
    assert found.lengths == (INF, INF)


def test_lengths_are_over_the_path_and_starts_are_lengths_from_the_tip():
    found = limits(limits={"length": "5 mm", "driven_start_diameter": "110 mm"})
    assert found.amounts == (INF, INF)
    assert found.lengths[0] == pytest.approx(5e-3 / PAIR.path_length)
    gear = GEARS[1]
    tip, start = (float(roll_of_radius(gear, radius)) for radius in (gear.involute_tip_radius, 0.055))
    assert found.lengths[1] == pytest.approx(gear.base_radius * (tip - start) / PAIR.path_length)
    assert not found.alike
    assert limits(limits={"amount": "20 um", "length": "5 mm"}).alike
    both = limits(limits={"length": "1 mm", "driven_start_diameter": "108 mm"})  # the shorter counts
    assert both.lengths == pytest.approx((1e-3 / PAIR.path_length,) * 2)


@pytest.mark.parametrize(
    ("keys", "key", "rule"),
    [
        ({"driver_start_diameter": "60 mm"}, "design.limits.driver_start_diameter", "is outside the active profile"),
        ({"driver_start_diameter": "90 mm"}, "design.limits.driver_start_diameter", "68.3407 to 78 mm"),
        ({"driven_start_diameter": "113.99 mm"}, "design.limits.driven_start_diameter", "too close to the tip"),
        ({"length": "0.2 mm"}, "design.limits.length", "must be at least 0.2[0-9]* mm"),
        ({"amount": "20 mm"}, "design.limits.amount", 'is above 0.3 mm, .* did you mean "20 um"'),
        ({"amount": "0.31 mm"}, "design.limits.amount", 'did you mean "0.31 um"'),
        ({"amount": "20 m"}, "design.limits.amount", "check the unit"),
    ],
)
def test_limits_without_room_are_refused(keys, key, rule):
    with pytest.raises(RangeError, match=rule) as refused:
        limits(limits=keys)
    assert key in str(refused.value)


def left(engagement, grid):
    """Peak-to-peak values of reliefs (C, 4) at the worst of both loads, in proportion, on a grid of its own [m]."""
    table = bench(engagement, order=6)
    contacts = table.grid.contacts
    removal = 0.0
    for i, (gear, roll) in enumerate(zip(GEARS, (contacts.roll_driver, contacts.roll_driven), strict=True)):
        each = {
            one: relief_over_path(gear, PAIR.path_length, *one, 1.0).removal(roll)
            for one in {tuple(p[2 * i : 2 * i + 2]) for p in grid}
        }
        removal = removal + np.stack([each[tuple(p[2 * i : 2 * i + 2])] for p in grid], axis=-1)
    return np.max(
        [table.errors(removal, load).peak_to_peak * part for load, part in ((3000.0, 2.0), (6000.0, 1.0))], axis=0
    )


def numbers(found):
    p = []
    for gear, tip in zip(GEARS, (found.driver, found.driven), strict=True):
        p += [tip.amount, (tip.end - tip.start) * gear.base_radius / PAIR.path_length]
    return np.array(p)


@pytest.mark.dear
@pytest.mark.parametrize(
    "within",
    [
        ReliefLimits((INF, 0.0)), ReliefLimits((0.0, INF)), ReliefLimits((8e-6, 12e-6)),
        ReliefLimits((INF, INF), (0.4, 0.5)),
    ],
)  # fmt: skip
def test_no_relief_within_the_limits_leaves_less_by_brute_force(engagement, within):
    found = grindable(engagement, OVER, "linear", banded=False, limits=within)
    p = numbers(found)
    tops = [min(one, 50e-6) for one in within.amounts]
    longest = [min(one, 1.0) for one in within.lengths]
    assert (p[::2] <= np.array(tops) * (1.0 + 1e-9)).all()
    assert all(length <= most * (1.0 + 1e-9) for length, most in zip(p[1::2], longest, strict=True))
    axes = []
    for top, longer in zip(tops, longest, strict=True):
        axes += [np.linspace(0.0, top, 7) if top else np.zeros(1), np.linspace(0.1, longer, 5) if top else np.ones(1)]
    least = left(engagement, list(product(*axes))).min()
    assert left(engagement, [p])[0] < 1.01 * 1.01 * least  # the least removal of equally good ones; grids


def test_limits_that_are_reached_are_named():
    """The driver's amount and the driven gear's start; what is inside its limits is not."""
    within = ReliefLimits((20e-6, 20e-6), (0.5, 0.3))
    tips = [
        relief_over_path(gear, PAIR.path_length, amount, length, 1.0)
        for gear, amount, length in zip(GEARS, (20e-6, 7e-6), (0.4, 0.3), strict=True)
    ]
    start = 2.0 * GEARS[1].base_radius * math.hypot(1.0, tips[1].start) * 1e3

    def said(limits, shapes=("linear",)):
        ground = {"linear": SimpleNamespace(driver=tips[0], driven=tips[1])}
        design = SimpleNamespace(task=SimpleNamespace(tip_limits=limits), shapes=list(shapes), ground=ground)
        data = SimpleNamespace(data=SimpleNamespace(design=design, pair=SimpleNamespace(pair=PAIR)))
        return list(_at_limits(Seen(data, SimpleNamespace(gears={"driver": "p", "driven": "w"}), "I")))

    (one,) = said(within)
    assert one == (
        f"Pair I: at design.limits: amount on gear p (20 µm), start on gear w (d {start:.1f} mm); less may remain "
        "with wider limits."
    )
    assert said(None) == said(within, shapes=()) == said(ReliefLimits()) == []
    assert ReliefLimits((0.0, INF)).active(0, 0.0, 1.0) == (False, False)
