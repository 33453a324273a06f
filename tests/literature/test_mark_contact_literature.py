"""W. D. Mark, transfer function method for gear system dynamics: Tables 1 and 2, sections 1 and 4.

The files in tests/data are the report's Tables 1 and 2 with three slips repaired (row 21: 242.2 lb; row 29: 28.99 deg);
positions are x = R_b (roll angle - tan 20 deg), since the printed millimetres are rounded up to 4 um off.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.contact.engagement import Engagement
from fegear.contact.fourier import effective_error, fourier_series, panels
from fegear.contact.mark_series import reciprocal_series
from fegear.contact.pair_compliance import PairCompliance
from fegear.contact.table_compliance import table_sources
from fegear.contact.transmission_error import pair_stiffness, transmission_error
from fegear.design.loading import LoadingFunction
from fegear.design.minimum_excitation import minimum_excitation
from fegear.errors import InputError
from fegear.geometry import BasicRack, Gear, GearPair, Tooth

DATA = Path(__file__).parents[1] / "data"
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
    s = pair_stiffness(engagement(), LOAD)
    exact = fourier_series(s.points, 1.0 / s.mesh, 32)
    errors = []
    for terms in (3, 10, 40, 200):
        got = reciprocal_series(s.points, s.mesh, 32, terms)
        assert got.converges
        errors.append(np.abs(got.series.coefficients - exact.coefficients).max() / exact.mean)
        assert errors[-1] <= got.bound * 2.0 + 1e-15
    assert errors[0] > errors[1] > errors[2]
    assert errors[3] < 1e-14  # nested evaluation keeps its digits far beyond M = 40
    uneven = np.where(s.points.x < s.points.x.mean(), 1.0, 40.0)
    sharp = panels(0.0, 1.0)
    k = np.where(sharp.x < 0.9, 1.0, 40.0)
    assert not reciprocal_series(sharp, k, 4, 3).converges
    assert uneven.min() > 0


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
