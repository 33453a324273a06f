"""Largest load and pressure of a tooth pair between the positions of its table, and their estimated errors."""

from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.loaded_teeth import LoadHistory
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.largest_on_pair import largest_on_pair
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.pair_history import pair_history
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.relief import UNMODIFIED, EndRelief

LOAD = 4000.0


def engaged(amount=0.0):
    """A pair, of which the driver's tip is relieved."""
    gears = [Gear(Tooth(z), 3e-3, 0.3 * z * 3e-3, 0.02) for z in (28, 41)]
    pair = GearPair(*gears)
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in gears]
    start, end = (float(pair.roll_angle(x, "driver")) for x in (0.3 * pair.x_end, pair.x_end))
    relief = EndRelief(amount, start, end) if amount else UNMODIFIED
    return Engagement(PairCompliance(pair, *sources, False, "load-dependent", LOAD), driver_relief=relief)


class Softer:
    """A source of compliance, so many times as soft."""

    def __init__(self, base, times):
        self._base, self._times = base, times

    def __getattr__(self, name):
        return getattr(self._base, name)

    def own(self, *at):
        return self._times * self._base.own(*at)


def shifted(e, times):
    return replace(e, compliance=replace(e.compliance, driver=Softer(e.compliance.driver, times)), grids=None)


def largest(e, positions, shifts=()):
    return largest_on_pair(e, shifts, LOAD, pair_history(e, [LOAD], positions), 0)


@pytest.mark.parametrize("positions", [8, 13, 20, 60])
@pytest.mark.parametrize("amount", [0.0, 9e-6, 20e-6])
def test_few_positions_find_what_many_do(positions, amount):
    """At 8 positions 3 % of a load, and 2 % of a pressure, stood between them."""
    e = engaged(amount)
    few, many = largest(e, positions), pair_history(e, [LOAD], 20_001)
    assert few.share == pytest.approx(many.share.max(), rel=2e-5)
    assert few.pressure == pytest.approx(many.hertz_pressure.max(), rel=2e-5)
    assert few.share >= many.share.max() * (1.0 - 1e-9) - 2e-5
    assert float(few.place.split("=")[1].split()[0]) * 1e-3 == pytest.approx(
        many.x[many.hertz_pressure[:, 0].argmax()], abs=2e-3 * e.pair.base_pitch
    )


def test_few_positions_alone_do_miss_them():
    e = engaged(20e-6)
    missed = [largest(e, n).pressure / pair_history(e, [LOAD], n).hertz_pressure.max() - 1.0 for n in (8, 13, 20)]
    assert max(missed) > 1e-3


@pytest.mark.parametrize("amount", [0.0, 9e-6, 20e-6])
def test_errors_are_what_a_shift_of_the_compliance_changes(amount):
    e = engaged(amount)
    found, other = largest(e, 60, [shifted(e, 1.02)]), largest(shifted(e, 1.02), 60)
    for one, error, again in (
        (found.share, found.share_error, other.share),
        (found.pressure, found.pressure_error, other.pressure),
    ):
        assert error >= abs(again - one) - 1e-4 * error
        assert error < max(20.0 * abs(again - one), 0.02 * one)


def test_a_load_that_is_whole_has_no_error_and_a_pressure_always_one():
    found = largest(engaged(), 60, [shifted(engaged(), 1.02)])
    assert (found.share, found.share_error) == (1.0, 0.0)
    assert found.pressure_error > 0.0


def test_a_source_that_states_no_error_leaves_none():
    e = engaged()
    history = pair_history(e, [LOAD], 60)
    found = LoadHistory(history, 0, None, None, largest=largest_on_pair(e, (), LOAD, history, 0))
    assert (found.largest_load_error, found.largest_share_error, found.largest_pressure_error) == (None, None, None)


def test_a_pair_that_bears_nothing_has_nothing_largest():
    e = engaged()
    history = pair_history(e, [LOAD], 60)
    none = replace(history, load=np.zeros_like(history.load))
    assert largest_on_pair(e, (), LOAD, none, 0) is None
    found = LoadHistory(none, 0, None, None)
    assert (found.largest_load, found.largest_share, found.largest_hertz_pressure) == (0.0, 0.0, 0.0)
