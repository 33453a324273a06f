"""W. D. Mark, transfer function method for gear system dynamics: Tables 1 and 2, sections 1 and 4.

The files in tests/data are the report's Tables 1 and 2 with three slips repaired (row 21: 242.2 lb; row 29: 28.99 deg);
positions are x = R_b (roll angle - tan 20 deg), since the printed millimetres are rounded up to 4 um off.
"""

import math
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.contact.fourier import effective_error, fourier_series, panels
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.mark_series import reciprocal_series, spacing_series, spacing_transfer, static_error_series
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.table_compliance import table_sources
from fegear.contact.plane.transmission_error import pair_stiffness, revolution, transmission_error
from fegear.design.loading import LoadingFunction
from fegear.design.minimum_excitation import minimum_excitation
from fegear.formulas.sources import pair_compliance, source
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import normalised_tip_relief

DATA, CASES = Path(__file__).parents[1] / "data", Path(__file__).parents[2] / "cases"
ALPHA = math.radians(20.0)
PITCH_RADIUS, BASE_RADIUS = 4.445e-2, 4.445e-2 * math.cos(ALPHA)
BASE_PITCH = 2 * math.pi * BASE_RADIUS / 28
LOAD = 1615.0


def table(name):
    rows = np.genfromtxt(DATA / name, delimiter=",", names=True)
    return rows, BASE_RADIUS * (rows["roll_rad"] - math.tan(ALPHA))


def gears(length):
    """The report's test gears with tips such that the path of contact has the length asked for."""
    rho = BASE_RADIUS * math.tan(ALPHA) + length / 2
    tip = math.hypot(BASE_RADIUS, rho)
    module = 3.175e-3
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25), tip_radius=tip / module)
    gear = Gear(tooth, module, 0.02, 6.35e-3)
    pair = GearPair(gear, gear)
    assert pair.path_length == pytest.approx(length, rel=1e-9)
    return pair


def engagement(length=1.37450e-2, **options):
    rows, x = table("mark_table1_loads_deflections.csv")
    pair = gears(length)
    sources = table_sources(pair, x, rows["deflection_mm"] * 1e-3 / rows["load_N"], "tooth", "cubic")
    return Engagement(PairCompliance(pair, *sources), **options)


def test_mean_reciprocal_stiffness_is_the_papers():
    """Eq. 5.5 context: C_I = 1.26312e-8 m/N. 0.1 %: the paper's own fit and quadrature are not stated."""
    stiffness = pair_stiffness(engagement(), LOAD)
    assert stiffness.mean_compliance == pytest.approx(1.26312e-8, rel=1e-3)


def test_loads_of_table_1_follow_figure_12():
    """Linear loading s = 1 over L = 1.22971 cm; 0.5 N: the table has four digits, the figure's L five."""
    rows, x = table("mark_table1_loads_deflections.csv")
    loading = LoadingFunction(1.22971e-2, BASE_PITCH)
    np.testing.assert_allclose(LOAD * loading.fraction(x), rows["load_N"], atol=0.5, rtol=0)


def test_relief_of_table_2_is_the_largest_deflection_minus_deflection():
    """1e-6 mm: both deflections of the difference are printed to five digits, half a unit (5e-7 mm) each."""
    rows, _ = table("mark_table1_loads_deflections.csv")
    relief, _ = table("mark_table2_relief.csv")
    misfit = np.abs(rows["deflection_mm"].max() - rows["deflection_mm"] - relief["relief_mm"])
    assert misfit.max() < 1e-6


def test_pair_table_equals_tooth_tables_added():
    rows, x = table("mark_table1_loads_deflections.csv")
    c = rows["deflection_mm"] * 1e-3 / rows["load_N"]
    fit = np.polyfit(x, c, 3)
    at = np.linspace(-7e-3, 7e-3, 40)
    pair = gears(1.37450e-2)
    whole = table_sources(pair, at, np.polyval(fit, at) + np.polyval(fit, -at), "pair", "cubic")
    one = pair_stiffness(Engagement(PairCompliance(pair, *whole)), LOAD)
    assert one.mean_compliance == pytest.approx(pair_stiffness(engagement(), LOAD).mean_compliance, rel=1e-9)


def test_series_converges_to_the_reciprocal_and_says_where_it_does_not():
    """(1.9): M = 3 leaves half a per cent here; cut at 64 harmonics the products leave 5e-4 of the mean for ever."""
    s = pair_stiffness(engagement(), LOAD)
    found = reciprocal_series(s.points, s.mesh, 64, [3, 10, 40, 200])
    assert found.converges
    error, cut = found.pointwise_error, found.convolved_error
    assert np.all(error <= 2.0 * found.bound + 1e-15)
    assert error[0] == pytest.approx(5.8e-3, rel=0.02)
    assert np.all(np.diff(error[:3]) < 0.0)
    assert error[3] < 1e-14  # nested evaluation keeps its digits far beyond M = 40
    mean = [abs(one.mean / found.exact.mean - 1.0) for one in found.convolved]
    assert mean[-1] == pytest.approx(mean[-2], rel=1e-6)
    assert 2e-4 < mean[-1] < 8e-4
    assert cut[-1] == pytest.approx(cut[-2], rel=1e-6)
    sharp = panels(0.0, 1.0)
    assert not reciprocal_series(sharp, np.where(sharp.x < 0.9, 1.0, 40.0), 4, [3]).converges


def test_nested_products_are_the_papers_binomial_sum():
    """(1.9) to (1.13) as printed, with repeated convolutions of the stiffness' own coefficients, M = 5."""
    s = pair_stiffness(engagement(), LOAD)
    count, terms = 20, 5
    mean = float(s.mesh @ s.points.weights / s.points.period)
    one = fourier_series(s.points, s.mesh / mean, count).coefficients
    a, power = np.concatenate([one[:0:-1].conj(), one]), np.eye(2 * count + 1)[count].astype(complex)
    total = np.zeros_like(power)
    for r in range(terms + 1):
        total += (-1) ** r * math.comb(terms + 1, r + 1) * power
        power = np.convolve(a, power)[count : 3 * count + 1]
    found = reciprocal_series(s.points, s.mesh, count, [terms]).convolved[0]
    np.testing.assert_allclose(found.coefficients * mean, total[count:], atol=1e-13)


def test_stiffness_coefficients_are_the_transform_of_one_pairs_stiffness():
    """(1.14), (1.17): alpha_K is the transform of K_S along one pair's own path at the tooth-mesh orders."""
    e = engagement()
    s = pair_stiffness(e, LOAD)
    n = np.arange(6)
    own = np.exp(-2j * np.pi * np.multiply.outer(n, s.x) / BASE_PITCH) * s.pair * s.points.weights / BASE_PITCH
    whole = fourier_series(s.points, s.mesh, 5).coefficients
    np.testing.assert_allclose(own.sum(axis=(-2, -1)), whole, atol=1e-12 * abs(whole[0]))


def test_modifications_enter_weighted_by_the_stiffness():
    """(1.22) to (1.26): with tip relief, all pairs loaded, the formulas are the exact transmission error."""
    pair = gears(1.37450e-2)
    reliefs = (normalised_tip_relief(pair, member, 15.24e-6, 1.0) for member in ("driver", "driven"))
    e = engagement(**dict(zip(("driver_relief", "driven_relief"), reliefs, strict=True)))
    exact = transmission_error(e, LOAD, 32).series
    found = static_error_series(e, LOAD, 32, 3)
    np.testing.assert_allclose(found.linear.coefficients, exact.coefficients, atol=1e-11 * float(exact.mean))
    long = static_error_series(e, LOAD, 32, 60)
    np.testing.assert_allclose(long.pointwise.coefficients, exact.coefficients, atol=1e-11 * float(exact.mean))
    left = np.abs(found.pointwise.coefficients - exact.coefficients).max()
    assert 1e-3 * float(exact.mean) < left < 1e-2 * float(exact.mean)


def test_spacing_transfer_is_near_the_exact_one_and_right_where_it_must_be():
    """(1.29) as read here: 1 for errors of all teeth alike, none at mesh harmonics, within .06 of uniform teeth."""
    order = np.linspace(0.0, 3.0, 61)
    for ratio in (1.1, 1.3, 1.466, 1.7):
        x = np.linspace(-ratio / 2, ratio / 2, 20001)
        weight = np.where(np.abs(x) < (2.0 - ratio) / 2, 1.0, 0.5)
        exact = [np.trapezoid(weight * np.cos(2 * np.pi * g * x), x) for g in order]
        found = spacing_transfer(order, ratio)
        assert found[0] == 1.0
        np.testing.assert_allclose(found[20::20], 0.0, atol=1e-15)
        assert np.abs(found - exact).max() < 0.06
        assert np.abs(np.sinc(order * ratio) - exact).max() > 0.09  # without the sum
        np.testing.assert_array_equal(spacing_transfer(-order, ratio), found)


@pytest.mark.parametrize("gears", ["driver", "driven", "both"])
def test_spacing_errors_by_the_closed_form(gears):
    """(1.28) beside load sharing over all base pitches: within .065 of the errors' own spectrum, the slow ones 1 %."""
    rng = np.random.default_rng(11)
    errors = {
        f"{one}_spacing": 0.3e-6 * rng.standard_normal(28) for one in ("driver", "driven") if gears in (one, "both")
    }
    e = engagement(**errors)
    exact = revolution(e, LOAD, 28, 84).coefficients[1:28]
    found = spacing_series(e, 84).coefficients[1:28]
    spectrum = sum(np.fft.fft(one) / 28 for one in errors.values())[1:]
    assert np.all(np.abs(found - exact) < 0.065 * np.abs(spectrum))
    np.testing.assert_allclose(found[:3], exact[:3], rtol=0.01)


@pytest.mark.parametrize("ratio", [1.2, 1.5, 1.8])
def test_range_of_contact_ratios_of_the_closed_form(ratio):
    """Teeth of Cornell's compliance whose tips give the contact ratio: within .09 of the spectrum, slow errors .2 %."""
    z, m, width = 60, 3.175e-3, 6.35e-3
    base = z * m / 2 * math.cos(ALPHA)
    tip = math.hypot(base, base * math.tan(ALPHA) + ratio * math.pi * base / z)
    gear = Gear(Tooth(z, BasicRack(1.35, 1.6, 0.2), tip_radius=tip / m), m, 0.02, width)
    pair = GearPair(gear, gear)
    assert pair.contact_ratio == pytest.approx(ratio, rel=1e-9)
    x = np.linspace(pair.x_start, pair.x_end, 101) * (1 - 1e-9)
    compliance = pair_compliance(source("cornell"), pair, x, LOAD / width).total / width
    errors = 0.3e-6 * np.random.default_rng(3).standard_normal(z)
    e = Engagement(PairCompliance(pair, *table_sources(pair, x, compliance, "pair", "cubic")), driver_spacing=errors)
    exact = revolution(e, LOAD, z, z).coefficients[1:z]
    found = spacing_series(e, z).coefficients[1:z]
    off = np.abs(found - exact) / np.abs(np.fft.fft(errors)[1:] / z)
    assert off.max() < 0.09
    assert off[:3].max() < 2e-3


def test_beyond_its_contact_ratios_the_closed_form_is_remarked():
    case = CASES / "sources" / "mark_series.toml"
    thin = {"gear.test.tip_diameter": "92.96 mm", "gear.eccentric.tip_diameter": "92.96 mm", "effects.relief": False}
    assert "is valid for contact ratios 1.2 to 1.8 (here 1.1" in " ".join(fegear.run(case, thin).remarks)
    assert ": Mark's closed-form solution for pitch" not in " ".join(fegear.run(case).remarks)


def test_transmission_error_is_load_times_reciprocal_stiffness():
    """(1.8) for unmodified teeth with all pairs of the path in contact."""
    e = engagement()
    s = pair_stiffness(e, LOAD)
    te = transmission_error(e, LOAD, 32)
    expected = fourier_series(s.points, LOAD / s.mesh, 32)
    np.testing.assert_allclose(te.series.coefficients, expected.coefficients, atol=1e-12 * float(expected.mean))


def test_a_plain_fft_converges_slowly_and_quadrature_does_not():
    """DESIGN note: alpha_3 of the mesh stiffness is 27 % off at N = 128 by FFT; observed order about 1."""
    e = engagement()
    s = pair_stiffness(e, LOAD)
    exact = fourier_series(s.points, s.mesh, 8)
    finer = fourier_series(panels_of(e, 24), mesh_at(e, panels_of(e, 24).x), 8)
    np.testing.assert_allclose(finer.coefficients, exact.coefficients, rtol=0, atol=1e-13 * float(exact.mean))
    errors = []
    for n in (128, 512, 2048):
        x = e.pair.x_start + BASE_PITCH * np.arange(n) / n
        c = (mesh_at(e, x) * np.exp(-2j * np.pi * 3 * x / BASE_PITCH)).mean()
        errors.append(abs(c / exact.coefficients[3] - 1))
    assert errors[0] > 0.02
    assert errors[2] > errors[0] / 100  # first order: 16 times finer is nowhere near 256 times better


def panels_of(e, order):
    return panels(e.pair.x_start, e.pair.base_pitch, e.breaks, waves=64, order=order)


def mesh_at(e, x):
    grid = e.grid(x)
    k = np.where(grid.contacts.present, 1.0 / grid.matrices.compliance[np.arange(2), np.arange(2)], 0.0)
    return k.sum(axis=0)


def test_effective_error_is_the_definition():
    p = panels(0.0, 1.0, waves=24)
    series = fourier_series(p, 3.0 + 2.0 * np.cos(2 * np.pi * p.x) + 1.5 * np.sin(6 * np.pi * p.x), 12)
    assert effective_error(series) == pytest.approx(2.0 + 2.5, rel=1e-12)
    with pytest.raises(InputError):
        effective_error(fourier_series(p, p.x, 5))


def test_design_from_the_papers_compliances_is_table_2():
    """(5.4) with the cubic fit in place of the tabulated deflections; 1.3e-4 mm is what the fit leaves (1 %).

    The table counts from its own deepest entry, the design from the loading's corner 0.26 mm further on.
    """
    e = engagement(1.5353e-2)
    loading = LoadingFunction(1.22971e-2, BASE_PITCH)
    designed = minimum_excitation(e, loading, LOAD)
    rows, _ = table("mark_table2_relief.csv")
    got = designed.driver_relief.removal(rows["roll_rad"])
    np.testing.assert_allclose((got - got[17]) * 1e3, rows["relief_mm"], atol=1.3e-4)
    te = transmission_error(designed, LOAD, 16)
    assert te.peak_to_peak < 1e-12 * te.mean + 1e-15
    # the relief goes on beyond the design zone, so that 20 % more load finds no tip interference
    before, at_start = designed.driver_relief.at(np.array([loading.x_start - 1e-3, loading.x_start]))
    assert before > at_start
