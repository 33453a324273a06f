"""Gear pairs at the edges of contact ratio, load and tooth numbers, on tooth compliances in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.edge_law import edge_law
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.meshing import Meshing
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import pair_stiffness, revolution, transmission_error
from fegear.design.loading import LoadingFunction, Ramp, sinusoidal_factor
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief, tip_relief

pytestmark = pytest.mark.last_bit

FACE = 0.01


def gear(teeth, tip_radius=math.nan, alpha=20.0, addendum=1.0, **tooth):
    rack = BasicRack(addendum, addendum + 0.25, 0.2, math.radians(alpha))
    return Gear(Tooth(teeth, rack, tip_radius=tip_radius, **tooth), 2e-3, 4e-3, FACE)


def engaged(pair, hertz="load-dependent", **options):
    sources = [closed_form_compliance(g, "weber-banaschek") for g in (pair.driver, pair.driven)]
    return Engagement(PairCompliance(pair, *sources, False, hertz, 1000.0), **options)


def with_contact_ratio(wanted, teeth=40, **shape):
    """A pair of equal gears whose tips are turned off until the contact ratio is the one wanted."""

    def pair(tip):
        return GearPair(gear(teeth, tip, **shape), gear(teeth, tip, **shape))

    usual = gear(teeth, **shape).tooth.tip_radius
    tip = brentq(lambda r: pair(r).contact_ratio - wanted, usual - 0.9, usual + 0.4, xtol=1e-15, rtol=1e-15)
    return pair(tip)


STANDARD = GearPair(gear(28), gear(41))


# ---- contact ratio --------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("above", [1e-12, 1e-9, 1e-6, 1e-3])
def test_just_above_one_two_pairs_meet_for_just_that_share_of_the_pitch(above):
    pair = with_contact_ratio(1.0 + above)
    e = engaged(pair)
    te = transmission_error(e, 1000.0)
    weights = te.points.weights / te.points.period
    two = (te.loaded.loads[:, :, 0] > 0.0).sum(axis=0) == 2
    assert weights[two].sum() == pytest.approx(pair.contact_ratio - 1.0, abs=3e-10)
    assert np.isfinite(te.series.coefficients).all()
    # As the double contact vanishes, what is left is one pair all the way.
    one = pair_stiffness(e, 1000.0)
    assert te.mean == pytest.approx(1000.0 * one.mean_compliance, rel=1e-9 + above)


@pytest.mark.parametrize("whole", [2, 3])
def test_whole_contact_ratios_are_crossed_without_a_jump_from_both_sides(whole):
    shape = {"alpha": 15.0, "addendum": 1.3, "teeth": 80}
    found = {}
    for beside in (-1e-4, -1e-6, -1e-10, 0.0, 1e-10, 1e-6, 1e-4):
        pair = with_contact_ratio(whole + beside, **shape) if whole == 2 else with_contact_ratio(
            whole + beside, alpha=10.0, addendum=1.35, teeth=150
        )  # fmt: skip
        te = transmission_error(engaged(pair), 3000.0)
        assert (te.loaded.loads[:, :, 0] > 0.0).sum(axis=0).min() >= whole - 1
        found[beside] = np.array([te.mean, abs(te.series.coefficients[1]), abs(te.series.coefficients[2])])
    scale = found[0.0][0]
    for beside, values in found.items():
        assert np.abs(values - found[0.0]).max() < scale * (1e-8 + 3.0 * abs(beside))


def test_a_contact_ratio_of_3_2_shares_between_three_and_four_pairs():
    pair = with_contact_ratio(3.2, teeth=150, alpha=10.0, addendum=1.35)
    e = engaged(pair)
    te = transmission_error(e, 3000.0)
    n = (te.loaded.loads[:, :, 0] > 0.0).sum(axis=0)
    assert (n.min(), n.max()) == (3, 4)
    assert float(n @ te.points.weights / te.points.period) == pytest.approx(3.2, abs=1e-9)
    np.testing.assert_allclose(te.loaded.loads.sum(axis=0), 3000.0, rtol=1e-13)


@pytest.mark.parametrize("below", [1e-9, 1e-3, 0.2])
def test_below_one_is_refused_with_the_effect_that_allows_it(below):
    pair = with_contact_ratio(1.0 - below)
    with pytest.raises(InputError, match=r"below 1.*corner_contact"):
        Meshing(pair)
    e = engaged(pair, corner_contact=True)
    x = pair.x_start + pair.base_pitch * np.linspace(0.0, 1.0, 41)
    z = e.solve(e.grid(x), [1000.0]).transmission_error
    assert np.isfinite(z).all()
    assert (z > 0.0).all()


# ---- loads ----------------------------------------------------------------------------------------------------------
LINE_LOADS = np.logspace(-3.0, 4.0, 29) * 1e3  # 1e-3 to 1e4 N/mm


def test_deflection_per_load_follows_the_logarithm_from_a_thousandth_to_ten_thousand_newtons_per_millimetre():
    """With one pair in contact zeta / W = c - (kappa / 2) ln W exactly, whatever the load."""
    e = engaged(STANDARD)
    middle = 0.5 * (STANDARD.x_lpstc + STANDARD.x_hpstc)
    loads = LINE_LOADS * FACE
    got = e.solve(e.grid([middle]), loads)
    assert (got.shared.pairs_in_contact == 1).all()
    per_load = got.transmission_error[0] / loads
    kappa = e.compliance.log_slope
    assert kappa > 0.0
    assert np.diff(per_load) == pytest.approx(-0.5 * kappa * np.diff(np.log(loads)), rel=1e-10)


@pytest.mark.parametrize("corners", [False, True])
def test_approach_and_each_pair_s_load_grow_with_the_load_over_seven_decades(corners):
    e = replace(engaged(STANDARD, corner_contact=corners), driver_relief=tip_relief(STANDARD.driver, 1e-5, length=2e-3))
    x = STANDARD.x_start + STANDARD.base_pitch * np.linspace(0.01, 0.99, 25)
    got = e.solve(e.grid(x), LINE_LOADS * FACE)
    assert (np.diff(got.transmission_error, axis=1) > 0.0).all()
    assert (np.diff(got.loads, axis=2) >= -1e-12 * got.loads[:, :, 1:].max(axis=0)).all()
    np.testing.assert_allclose(got.loads.sum(axis=0), np.broadcast_to(LINE_LOADS * FACE, got.loads.shape[1:]))
    assert (got.local_stiffness > 0.0).all()


def test_loads_at_the_tip_corner_and_at_the_start_of_the_involute():
    """Right at either end of the path, and a hair inside, with the corner's narrowed contact and without."""
    for pair in (STANDARD, with_contact_ratio(1.5)):
        for corners in (False, True):
            e = engaged(pair, corner_contact=corners)
            for end, inward in ((pair.x_start, 1.0), (pair.x_end - pair.base_pitch, -1.0)):
                x = end + inward * np.array([0.0, 1e-13, 1e-9, 1e-6]) * pair.base_pitch
                got = e.solve(e.grid(e.meshing.reduced(x)), LINE_LOADS[::7] * FACE)
                assert np.isfinite(got.transmission_error).all()
                assert (got.transmission_error > 0.0).all()
    # The corner narrows the contact: it can only soften it, and no longer does a contact's half-width away.
    t = np.linspace(-1.5, 50.0, 400)
    psi, _ = edge_law(t)
    assert (psi >= 0.0).all()
    assert (np.diff(psi) >= 0.0).all()


def test_loads_that_no_steel_carries_are_refused():
    e = engaged(STANDARD)
    with pytest.raises(RangeError, match="is too high: contact width leads to a non-positive tooth pair stiffness"):
        e.solve(e.grid([0.0]), [1e16])
    for load in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError, match="must be positive and finite"):
            e.solve(e.grid([0.0]), [load])


# ---- relief and tooth numbers ---------------------------------------------------------------------------------------
def test_relief_that_takes_pairs_apart_leaves_one_pair_and_no_gap_in_the_load():
    """So long that it starts below the pitch point: the gears run on the relief, and the error is its own size."""
    roll = float(STANDARD.roll_angle(0.6 * STANDARD.x_start, "driver"))
    e = replace(engaged(STANDARD), driver_relief=EndRelief(1e-3, roll, float(STANDARD.driver.tooth.involute.end)))
    te = transmission_error(e, 1000.0)
    loaded = te.loaded.loads[:, :, 0]
    np.testing.assert_allclose(loaded.sum(axis=0), 1000.0, rtol=1e-12)
    assert ((loaded > 0.0).sum(axis=0) == 1).mean() > 0.9
    assert te.peak_to_peak > 1e-4
    assert np.isfinite(te.series.coefficients).all()


@pytest.mark.parametrize(("driver", "driven"), [(28, 28), (28, 42), (28, 41), (28, 61)])
def test_identical_and_hunting_tooth_numbers(driver, driven):
    """The same errors repeat after the least common multiple; what every tooth shares is no rotational harmonic.

    The harmonics of 1708 base pitches once took sixteen gigabytes.
    """
    pair = GearPair(gear(driver), gear(driven))
    cycles = math.lcm(driver, driven)
    rng = np.random.default_rng(0)
    e = replace(
        engaged(pair), driver_spacing=2e-6 * rng.random(driver), driven_spacing=2e-6 * rng.random(driven)
    )  # fmt: skip
    found = revolution(e, 1000.0, cycles, cycles, order=4)
    again = e.spacing(e.grid([0.0]).contacts, cycles) - e.spacing(e.grid([0.0]).contacts, 0)
    assert np.abs(again).max() == 0.0
    n = np.arange(1, cycles)
    own = (n % (cycles // driver) == 0) | (n % (cycles // driven) == 0)
    # Orders of either gear's own rotation carry the errors; the others only what the changes of contact mix in.
    amplitude = found.amplitude[: cycles - 1]
    assert amplitude[own].max() > 20.0 * np.median(amplitude[~own]) if (~own).any() else amplitude.max() > 0.0
    same = replace(e, driver_spacing=np.full(driver, 1e-6), driven_spacing=np.full(driven, -2e-6))
    rotational = revolution(same, 1000.0, cycles, cycles, order=4).amplitude[: cycles - 1]
    assert rotational.max() < 1e-12 * 1e-6 * cycles


# ---- loading functions at the ends of their parameters --------------------------------------------------------------
@pytest.mark.parametrize("exponent", [3, 7, 15])
def test_loading_functions_with_slopes_of_zero_and_of_the_exponent(exponent):
    """s = 0 enters with no slope at all, s = r is the steepest start that still rises all the way."""
    pitch = STANDARD.base_pitch
    flat, steep = (LoadingFunction(1.6 * pitch, pitch, ramp=Ramp(s, exponent)) for s in (0.0, float(exponent)))
    assert flat.initial_slope() == 0.0
    assert steep.initial_slope() > 0.0
    for f in (flat, steep):
        x = f.centre - f.length * np.linspace(0.5, 0.0, 2001)
        assert (np.diff(f.fraction(x)) >= -1e-13).all()
        assert f.fraction(x + pitch) + f.fraction(x) + f.fraction(x - pitch) == pytest.approx(np.ones(2001), abs=1e-12)
        g = np.linspace(0.0, 40.0, 401) / pitch
        assert np.isfinite(f.spectrum(g)).all()
    with pytest.raises(InputError, match=r"design\.slope"):
        Ramp(exponent * (1.0 + 1e-6), exponent)


@pytest.mark.parametrize("s", [0.0, 0.5, 2.0])
def test_spectra_pass_smoothly_through_orders_zero_and_one(s):
    for at in (0.0, 1.0):
        q = at + np.array([-1e-3, -1e-7, -1e-12, 0.0, 1e-12, 1e-7, 1e-3])
        values = np.array([float(sinusoidal_factor(abs(v), s)) for v in q])
        slope = (values[-1] - values[0]) / 2e-3
        assert values == pytest.approx(values[3] + slope * (q - at), abs=5e-6)
        assert values[1:-1] == pytest.approx(np.full(5, values[3]), abs=3e-7 * (1.0 + abs(slope)))
