"""Laws that every loaded pair must obey, on smooth made-up compliances: fast, and nothing is hidden by a mesh."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smooth_tooth import SmoothTooth

from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.meshing import Meshing
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import contact_changes, pair_stiffness, revolution, transmission_error
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief, roll_of_radius, tip_relief


def gear(z, x=0.0, addendum=1.0, **tooth):
    return Gear(Tooth(z, BasicRack(addendum, addendum + 0.25, 0.2), x, **tooth), 2e-3, 4e-3, 1e-2)


def engaged(pair, coupling=True, **options):
    c = PairCompliance(pair, SmoothTooth(pair.driver), SmoothTooth(pair.driven), coupling)
    return Engagement(c, **options)


STANDARD = GearPair(gear(28), gear(41))
HIGH = GearPair(gear(60, addendum=1.25), gear(75, addendum=1.25))


def relieved(e, amount=15e-6, length=2e-3):
    return replace(
        e,
        driver_relief=tip_relief(e.pair.driver, amount, length=length),
        driven_relief=tip_relief(e.pair.driven, 0.7 * amount, length=1.3 * length),
    )


@given(
    st.sampled_from([STANDARD, HIGH]), st.floats(-3.0, 4.0), st.floats(0.0, 30e-6), st.booleans(), st.integers(0, 10**6)
)
def test_laws_of_contact_hold_over_seven_decades_of_load(pair, log_load, amount, corners, seed):
    rng = np.random.default_rng(seed)
    e = replace(
        relieved(engaged(pair, corner_contact=corners), amount),
        driver_spacing=5e-6 * rng.standard_normal(pair.driver.teeth),
        driven_spacing=5e-6 * rng.standard_normal(pair.driven.teeth),
    )
    load = 10.0**log_load * 1e3 * e.compliance.face_width  # 1e-3 to 1e4 N/mm
    x = pair.x_start + pair.base_pitch * rng.random(12)
    got = e.solve(e.grid(x), [load], cycle=seed)
    w, z = got.loads[:, :, 0], got.transmission_error[:, 0]
    np.testing.assert_allclose(w.sum(axis=0), load, rtol=1e-13)
    assert (w >= 0).all()
    u = np.einsum("jkp,kp->jp", got.grid.matrices.at_load(got.loads)[..., 0], w)
    gap = np.where(got.grid.contacts.present, u + got.separation - z, np.inf)
    scale = np.abs(z) + np.abs(u).max()
    assert (gap >= -1e-11 * scale).all()
    assert (np.abs(gap)[w > 1e-9 * load] <= 1e-11 * np.broadcast_to(scale, w.shape)[w > 1e-9 * load]).all()


@pytest.mark.parametrize("pair", [STANDARD, HIGH])
@pytest.mark.parametrize("corners", [False, True])
def test_reversing_driver_and_driven_mirrors_everything(pair, corners):
    one = relieved(engaged(pair, corner_contact=corners))
    back = engaged(pair.reversed(), corner_contact=corners)
    other = replace(back, driver_relief=one.driven_relief, driven_relief=one.driver_relief)
    x = pair.x_start + pair.base_pitch * np.linspace(0.013, 0.987, 23)
    a, b = one.solve(one.grid(x), [800.0, 5000.0]), other.solve(other.grid(-x), [800.0, 5000.0])
    np.testing.assert_allclose(b.transmission_error, a.transmission_error, rtol=1e-9)
    for p in range(x.size):
        first = {round(v * 1e9): w for v, w in zip(a.pair_x[:, p], a.loads[:, p, 1], strict=True) if w > 0}
        second = {round(-v * 1e9): w for v, w in zip(b.pair_x[:, p], b.loads[:, p, 1], strict=True) if w > 0}
        assert first.keys() == second.keys()
        for key, w in first.items():
            assert second[key] == pytest.approx(w, rel=1e-8)


def test_compliance_matrices_are_symmetric_and_positive():
    e = engaged(HIGH)
    x = HIGH.x_start + HIGH.base_pitch * np.linspace(0, 1, 15)
    grid = e.grid(x)
    c = grid.matrices.compliance
    np.testing.assert_array_equal(c, np.swapaxes(c, 0, 1))
    assert np.linalg.eigvalsh(np.moveaxis(c, 2, 0)).min() > 0
    assert grid.contacts.present.sum(axis=0).max() == math.ceil(HIGH.contact_ratio)


def test_stiffness_of_the_pairs_is_the_row_sum_of_the_inverse():
    """(A.8) against (A.11): the matrices are symmetric, so both routes agree."""
    e = engaged(STANDARD)
    s = pair_stiffness(e, 1000.0)
    grid = e.grid(s.points.x)
    loads = (s.pair / s.mesh * 1000.0)[:, :, None]
    c = np.moveaxis(grid.matrices.at_load(loads)[..., 0], 2, 0)
    here = grid.contacts.present.T
    c = np.where(here[:, :, None] & here[:, None, :], c, np.eye(2))
    expected = np.where(here[:, :, None] & here[:, None, :], np.linalg.inv(c), 0.0).sum(axis=1).T
    np.testing.assert_allclose(s.pair, expected, rtol=1e-10)


def test_local_stiffness_is_the_slope_of_load_over_approach():
    e = relieved(engaged(STANDARD))
    grid = e.grid(STANDARD.x_start + STANDARD.base_pitch * np.array([0.1, 0.4, 0.8]))
    w, h = 2000.0, 0.01
    z = e.solve(grid, [w - h, w + h]).transmission_error
    slope = 2 * h / (z[:, 1] - z[:, 0])
    np.testing.assert_allclose(e.solve(grid, [w]).local_stiffness[:, 0], slope, rtol=1e-6)


def test_transmission_error_jumps_only_where_unrelieved_pairs_enter_and_leave():
    e = engaged(STANDARD)
    start, pitch = STANDARD.x_start, STANDARD.base_pitch
    h = 1e-10
    for at in e.breaks:
        z = e.solve(e.grid(e.meshing.reduced([at - h, at + h])), [2000.0]).transmission_error[:, 0]
        assert abs(z[1] - z[0]) > 0.1 * z.mean()
    inside = start + pitch * np.linspace(0.001, 0.999, 4001)
    z = e.solve(e.grid(inside), [2000.0]).transmission_error[:, 0]
    away = np.abs(inside[1:, None] - np.array(e.breaks)).min(axis=1) > pitch / 2000
    assert np.abs(np.diff(z))[away].max() < 2e-3 * z.mean()


def test_enough_relief_makes_it_continuous():
    e = relieved(engaged(STANDARD), 60e-6, 2.5e-3)
    for at in e.breaks:
        z = e.solve(e.grid(e.meshing.reduced([at - 1e-10, at + 1e-10])), [2000.0]).transmission_error[:, 0]
        assert z[1] == pytest.approx(z[0], rel=1e-5)


def test_corner_contact_makes_it_continuous_without_relief():
    e = engaged(STANDARD, corner_contact=True)
    for at in (STANDARD.x_start, STANDARD.x_end):
        z = e.solve(e.grid(e.meshing.reduced([at - 1e-9, at + 1e-9])), [2000.0]).transmission_error[:, 0]
        assert z[1] == pytest.approx(z[0], rel=1e-4)


def test_fourier_coefficients_converge_with_the_quadrature_although_there_are_kinks():
    e = relieved(engaged(STANDARD), 20e-6)
    assert contact_changes(e, 1500.0).size > 0
    best = transmission_error(e, 1500.0, 32, order=28).series
    errors = [
        np.abs(transmission_error(e, 1500.0, 32, order=n).series.coefficients - best.coefficients).max()
        for n in (6, 12)
    ]
    assert errors[1] < 1e-7 * float(best.mean)
    assert errors[1] < errors[0]


def test_contact_changes_are_where_bisection_finds_them():
    e, load = relieved(engaged(STANDARD), 20e-6), 1500.0
    pitch = STANDARD.base_pitch

    def loaded(x):
        return e.solve(e.grid([x]), [load]).loads[:, 0, 0] > 0.0

    for change in contact_changes(e, load):
        low, high = change - 2e-6 * pitch, change + 2e-6 * pitch
        before = loaded(low)
        assert (loaded(high) != before).any()
        for _ in range(20):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if (loaded(middle) == before).all() else (low, middle)
        assert abs(change - low) < 1e-6 * pitch


def test_a_light_load_shows_the_profile_itself():
    """As the load vanishes the transmission error is the least modification of the pairs in reach."""
    e = relieved(engaged(STANDARD))
    grid = e.grid(STANDARD.x_start + STANDARD.base_pitch * np.linspace(0.05, 0.95, 9))
    z = e.solve(grid, [1e-9]).transmission_error[:, 0]
    m = np.where(grid.contacts.present, e.modification(grid.contacts), np.inf).min(axis=0)
    np.testing.assert_allclose(z, m, atol=1e-16)


def test_contact_ratio_below_one_is_refused_unless_corners_may_help():
    short = GearPair(gear(28, tip_radius=14.35), gear(28, tip_radius=14.35))
    assert short.contact_ratio < 1
    with pytest.raises(InputError, match="below 1"):
        Meshing(short)
    e = engaged(short, corner_contact=True)
    x = short.x_start + short.base_pitch * np.linspace(0, 1, 50)
    z = e.solve(e.grid(x), [100.0]).transmission_error
    assert np.isfinite(z).all()
    assert (z > 0).all()


def test_relief_so_deep_that_pairs_lose_contact_still_carries_the_load_on_one():
    deep = EndRelief(5e-3, float(roll_of_radius(STANDARD.driver, STANDARD.driver.pitch_radius)), 0.6)
    e = replace(engaged(STANDARD), driver_relief=deep)
    x = STANDARD.x_start + STANDARD.base_pitch * np.linspace(0.01, 0.99, 40)
    got = e.solve(e.grid(x), [1000.0])
    assert (got.shared.pairs_in_contact == 1).all()
    np.testing.assert_allclose(got.loads.sum(axis=0), 1000.0)


def test_absurd_load_is_refused_in_words():
    e = engaged(STANDARD)
    with pytest.raises(RangeError, match="is too high: contact width leads to a non-positive tooth pair stiffness"):
        e.solve(e.grid([0.0]), [1e18])


@pytest.mark.parametrize("hertz", ["linear", "none"])
def test_linear_contacts_scale(hertz):
    c = PairCompliance(STANDARD, SmoothTooth(STANDARD.driver), SmoothTooth(STANDARD.driven), True, hertz, 1000.0)
    e = Engagement(c)
    grid = e.grid(STANDARD.x_start + STANDARD.base_pitch * np.array([0.1, 0.5]))
    z = e.solve(grid, [10.0, 1000.0]).transmission_error
    np.testing.assert_allclose(z[:, 1], 100 * z[:, 0], rtol=1e-12)
    if hertz == "linear":
        one = engaged(STANDARD)
        single = e.meshing.contacts(np.array([0.5 * (STANDARD.x_lpstc + STANDARD.x_hpstc)]))
        if single.present.sum() == 1:
            exact = one.solve(one.grid(single.x[single.present]), [1000.0]).transmission_error
            got = e.solve(e.grid(single.x[single.present]), [1000.0]).transmission_error
            np.testing.assert_allclose(got, exact, rtol=1e-12)


@pytest.mark.parametrize("ratio_gears", [(GearPair(gear(40), gear(40)), 1), (HIGH, 2)])
def test_contact_ratios_from_one_to_above_two(ratio_gears):
    pair, least = ratio_gears
    e = engaged(pair)
    x = pair.x_start + pair.base_pitch * (np.arange(100) + 0.5) / 100
    n = e.solve(e.grid(x), [1000.0]).shared.pairs_in_contact
    assert n.min() == least
    assert n.mean() == pytest.approx(pair.contact_ratio, abs=0.02)


def test_exact_transfer_function_predicts_the_rotational_harmonics():
    """Small spacing errors on linear teeth, all pairs staying in contact: (1.28) with the exact transfer function."""
    rng = np.random.default_rng(7)
    c = PairCompliance(STANDARD, SmoothTooth(STANDARD.driver), SmoothTooth(STANDARD.driven), True, "none")
    errors = 1e-9 * rng.standard_normal(28)
    perfect, flawed = Engagement(c), Engagement(c, driver_spacing=errors)
    harmonics = 60
    a = revolution(flawed, 3000.0, 28, harmonics).coefficients - revolution(perfect, 3000.0, 28, harmonics).coefficients
    s = pair_stiffness(perfect, 3000.0)
    n = np.arange(harmonics + 1)
    # (1.27); a pair's error enters with the weight K_S / K_T as it travels along the path.
    spectrum = np.fft.fft(errors) / errors.size
    weight = s.pair / s.mesh * s.points.weights / s.points.period
    phase = np.exp(-2j * np.pi * np.multiply.outer(n / 28, s.x) / s.points.period)
    expected = spectrum[n % 28] * (phase * weight).sum(axis=(-2, -1))
    np.testing.assert_allclose(a, expected, atol=1e-6 * 1e-9)
