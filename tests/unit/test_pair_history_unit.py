"""One tooth pair followed over its path."""

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.flanks import welbourn_amount
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.pair_history import pair_history
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief


def pair(addendum=1.0, z=28):
    gear = Gear(Tooth(z, BasicRack(addendum, addendum + 0.25, 0.2)), 3e-3, 0.02, 1e-2)
    return GearPair(gear, gear)


def engaged(p, name="weber-banaschek", **options):
    source = closed_form_compliance(p.driver, name)
    return Engagement(PairCompliance(p, source, source), **options)


@pytest.mark.parametrize("name", ["cornell", "weber-banaschek", "potential-energy"])
def test_the_pairs_loads_one_base_pitch_apart_add_up(name):
    p = pair()
    h = pair_history(engaged(p, name), [2000.0, 100.0], 120)
    middle = (h.x > p.x_lpstc + 1e-5) & (h.x < p.x_hpstc - 1e-5)
    np.testing.assert_allclose(h.share[middle], 1.0, rtol=1e-12)
    at = np.linspace(p.x_start + 1e-4, p.x_lpstc - 1e-4, 9)
    for i in range(2):
        first = np.interp(at, h.x, h.load[:, i])
        second = np.interp(at + p.base_pitch, h.x, h.load[:, i])
        np.testing.assert_allclose(first + second, [2000.0, 100.0][i], rtol=1e-4)
    assert h.x[0] == p.x_start
    assert h.x[-1] == p.x_end
    assert (h.hertz_pressure[:, 0] > h.hertz_pressure[:, 1]).all()


def test_corner_contact_starts_before_and_ends_after_the_path():
    p = pair()
    h = pair_history(engaged(p, corner_contact=True), [3000.0], 800)
    assert h.x[0] < p.x_start
    assert h.x[-1] > p.x_end
    assert h.load[0, 0] >= 0
    assert h.load[1:-1, 0].min() > 0
    steps = np.abs(np.diff(h.load[:, 0])) / 3000.0
    assert steps.max() < 0.1  # without corners the load jumps by a third


def test_hertz_pressure_is_the_textbook_value():
    """p = sqrt(w E* / (pi R)); 28/28 at the pitch point, 1000 N on 10 mm."""
    p = pair()
    h = pair_history(engaged(p), [1000.0], 201)
    at = np.argmin(np.abs(h.x))
    r1, r2 = (float(p.flank_curvature_radius(h.x[at], m)) for m in ("driver", "driven"))
    modulus = 206.8e9 / (1 - 0.09) / 2
    expected = np.sqrt(h.load[at, 0] / 0.01 * modulus * (1 / r1 + 1 / r2) / np.pi)
    assert h.hertz_pressure[at, 0] == pytest.approx(expected, rel=1e-9)


def test_welbourns_amount_is_the_deflection_at_the_hpstc_and_twice_the_spacing_error():
    e = engaged(pair())
    bare = welbourn_amount(e, 2000.0)
    assert welbourn_amount(e, 2000.0, 3e-6) == pytest.approx(bare + 6e-6, rel=1e-12)
    assert 5e-6 < bare < 5e-5
    with pytest.raises(InputError, match="no highest point"):
        welbourn_amount(engaged(pair(1.3, 60)), 2000.0)


def test_spacing_errors_stay_with_their_teeth():
    """A pair with an early tooth takes more than its share from first to last contact."""
    p = pair()
    errors = np.zeros(28)
    errors[5] = -3e-6  # material left on: it meets early
    plain = pair_history(engaged(p), [2000.0], 60)
    early = pair_history(engaged(p, driver_spacing=errors), [2000.0], 60, cycle=5)
    next_one = pair_history(engaged(p, driver_spacing=errors), [2000.0], 60, cycle=6)
    shared = plain.share[:, 0] < 0.99
    assert (early.share[shared, 0] >= plain.share[shared, 0]).all()
    assert (next_one.share[shared, 0] <= plain.share[shared, 0] + 1e-12).all()


@pytest.mark.parametrize("steps", range(-4, 5))
def test_round_off_of_a_relief_that_starts_at_single_contact_adds_no_position(steps):
    """Where one place is both the start of a relief and the end of another pair's contact, it counts once."""
    p = pair()
    start, end = (p.roll_angle(x, "driver") for x in (p.x_hpstc, p.x_end))
    for roll in (float(start), float(end)):
        off = roll * (1.0 + steps * 2.0**-52)
        engagement = engaged(p, driver_relief=EndRelief(10e-6, off, 1.1 * off))
        pitches = np.diff(np.append(engagement.breaks, engagement.breaks[0] + p.base_pitch)) / p.base_pitch
        assert pitches.min() > 1e-3
        assert len(engagement.breaks) == 2
        h = pair_history(engagement, [2000.0], 120)
        assert h.x.size == 120 + 2 * 2
        assert np.diff(h.x).min() > 1e-8 * p.base_pitch
