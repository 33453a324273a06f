"""What a relief leaves is known as well as the compliances and the search are: no better than without relief."""

from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief
from fegear.results.relief.left_errors import LeftError, left_error
from fegear.results.relief.relief_over_range import _errors

M, LOAD = 3e-3, 2000.0


@pytest.fixture(scope="module")
def loaded():
    gears = [
        Gear(t, M, 0.5 * t.root_radius * M, 0.02) for t in (Tooth(z, BasicRack(1.0, 1.25, 0.38)) for z in (19, 31))
    ]
    solved = tuple(solve_gear(g, settings_at(-6.0), reach=2) for g in gears)
    return load_plane(PairSpec(GearPair(*gears), (LOAD,), neighbour_coupling=True), solved)


def with_relief(engagement, amount):
    pair = engagement.pair
    ends = [float(g.tooth.roll(g.tooth.involute_tip_radius)) for g in (pair.driver, pair.driven)]
    driver, driven = (EndRelief(amount, end - 0.1, end) for end in ends)
    return replace(engagement, driver_relief=driver, driven_relief=driven)


def test_errors_are_those_of_the_compliances_whatever_is_left(loaded):
    e, shifted = loaded.engagement, loaded.shifted
    assert shifted
    plain = left_error(transmission_error(e, LOAD), shifted)
    assert 0.0 < plain.peak_to_peak < 0.2 * transmission_error(e, LOAD).peak_to_peak
    te = transmission_error(with_relief(e, 8e-6), LOAD)
    known = left_error(te, shifted, 1e-9)
    assert known.peak_to_peak > 0.1 * plain.peak_to_peak
    assert known.larger == max(known)
    # Of the search is added; by compliances that are off by twice as much it is about twice as much.
    assert known.peak_to_peak == pytest.approx(left_error(te, shifted).peak_to_peak + 1e-9, rel=1e-12)
    assert known.effective == pytest.approx(left_error(te, shifted).effective + 1e-9, rel=1e-12)
    # The true change by one of them is not more.
    other = transmission_error(replace(with_relief(e, 8e-6), compliance=shifted[0].compliance), LOAD)
    assert abs(other.peak_to_peak - te.peak_to_peak) <= 1.01 * known.peak_to_peak + 1e-9


def test_without_estimates_only_the_search_is_known(loaded):
    te = transmission_error(loaded.engagement, LOAD)
    assert left_error(te, (), 2e-9) == LeftError(2e-9, 2e-9)
    assert left_error(te, ()) == LeftError(None, None)
    assert left_error(te, ()).larger is None
    assert _errors([te], (), None) is None
    assert np.array_equal(_errors([te, te], loaded.shifted, None), [left_error(te, loaded.shifted).peak_to_peak] * 2)
