"""The cantilever integrals against exact beams, adaptive quadrature and each other."""

import dataclasses
import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from fegear.base.errors import InputError, RangeError
from fegear.formulas import beam, potential_energy, weber_banaschek
from fegear.formulas import cornell as cornell_compliance
from fegear.formulas import potential_energy as sainsot
from fegear.formulas.root_section import load_line
from fegear.formulas.sources import SOURCES, source
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

RACK = BasicRack(1.0, 1.25, 0.25)


def gear(z: int = 28, plane: str = "strain", tooth: Tooth | None = None, bore: float = 0.5) -> Gear:
    t = Tooth(z, RACK) if tooth is None else tooth
    return Gear(t, 3.175e-3, bore * t.root_radius * 3.175e-3, 1e-2, plane=plane)


def radii(g: Gear, count: int = 25) -> np.ndarray:
    return np.linspace(g.form_radius, g.involute_tip_radius, count)


def test_rectangular_cantilever_is_the_textbook_one():
    # sections of a prismatic beam of length 3 and depth 2h = 0.8: P L^3/(3 E I) and L/A per unit load and width
    x, w = np.polynomial.legendre.leggauss(4)
    length, h = 3.0, 0.4
    cut = beam.Sections((0.5 * length * (x + 1))[None], np.full((1, 4), h), (0.5 * length * w)[None])
    i = beam.integrals(cut, np.array([length]))
    inertia = (2 * h) ** 3 / 12
    assert i.bending_2[0] == pytest.approx(length**3 / 3 / inertia, rel=1e-14)
    assert i.bending_1[0] == pytest.approx(length**2 / 2 / inertia, rel=1e-14)
    assert i.bending_0[0] == pytest.approx(length / inertia, rel=1e-14)
    assert i.area[0] == pytest.approx(length / (2 * h), rel=1e-14)


def adaptive(tooth: Tooth, radius: float) -> tuple[float, float]:
    """Integrals of u^2/I and 1/A over height by adaptive quadrature, the outline inverted point by point."""
    load = load_line(tooth, radius)
    y_load, apex = float(load.y[0]), float(load.apex[0])
    (_, low), (_, mid) = tooth.fillet.points(tooth.fillet.start), tooth.fillet.points(tooth.fillet.end)

    def half(curve, y: float) -> float:
        u = brentq(lambda p: float(curve.points(p)[1]) - y, curve.start, curve.end, xtol=1e-15)
        return float(curve.points(u)[0])

    bend = area = 0.0
    for curve, lo, hi in ((tooth.fillet, float(low), float(mid)), (tooth.involute, float(mid), y_load)):
        eps = 1e-12 * (hi - lo)
        kw = {"epsrel": 1e-9, "limit": 200}
        bend += quad(lambda y, c=curve: 12 * (apex - y) ** 2 / (2 * half(c, y)) ** 3, lo + eps, hi - eps, **kw)[0]
        area += quad(lambda y, c=curve: 0.5 / half(c, y), lo + eps, hi - eps, **kw)[0]
    return bend, area


@pytest.mark.parametrize("z", [10, 28, 120])
def test_integrals_match_adaptive_quadrature_over_height(z):
    tooth = Tooth(z, RACK, tip_radius=z / 2 + 0.95)
    radius = 0.3 * tooth.form_radius + 0.7 * tooth.involute_tip_radius
    load = load_line(tooth, radius)
    i = beam.integrals(beam.sections(tooth, load, tooth.fillet.start), load.apex)
    bend, area = adaptive(tooth, radius)
    assert i.bending_2[0] == pytest.approx(bend, rel=1e-8)
    assert i.area[0] == pytest.approx(area, rel=1e-8)


@pytest.mark.parametrize(
    "tooth",
    [
        Tooth(8, RACK, tip_radius=4.9),
        Tooth(28, RACK),
        Tooth(28, BasicRack(1.0, 1.25, 0.0)),
        Tooth(28, BasicRack(1.0, 1.25, 0.02)),
        Tooth(28, BasicRack.full_fillet(1.0, 1.4)),
        Tooth(500, RACK),
        Tooth(28, RACK, tip_rounding=0.1),
        Tooth(14, RACK, 0.6, tip_radius=8.76),
    ],
    ids=[
        "undercut",
        "usual",
        "sharp rack",
        "nearly sharp rack",
        "full fillet",
        "500 teeth",
        "tip rounding",
        "pointed tip",
    ],
)
@pytest.mark.parametrize("name", ["cornell", "weber-banaschek", "potential-energy"])
def test_quadrature_is_spectral_and_good_to_1e_12(tooth, name):
    g = gear(tooth=tooth)
    if name == "potential-energy" and not 0.01 <= beam.root_half_angle(tooth) <= 0.12:
        with pytest.raises(RangeError, match="Sainsot"):
            SOURCES[name].tooth(g, radii(g))
        return
    formula = SOURCES[name].tooth
    exact = formula(g, radii(g), nodes=96).total
    error = [np.max(np.abs(formula(g, radii(g), nodes=n).total / exact - 1.0)) for n in (4, 8, 16, 32)]
    assert error[-1] < 1e-12
    # geometric convergence: doubling the nodes divides the error by at least 20 until round-off
    assert all(b < 0.05 * a or b < 1e-13 for a, b in itertools.pairwise(error))


@pytest.mark.parametrize("name", list(SOURCES))
def test_compliance_is_positive_and_grows_toward_the_tip(name):
    g = gear()
    c = SOURCES[name].tooth(g, radii(g))
    for part in (c.bending, c.shear, c.axial, c.foundation):
        assert np.all(part >= 0.0)
    assert np.all(np.diff(c.total) > 0.0)
    assert not c.bending.flags.writeable


@given(module=st.floats(1e-4, 0.1), modulus=st.floats(1e9, 1e12))
def test_compliance_per_unit_width_knows_no_size_and_falls_as_one_over_e(module, modulus):
    t = Tooth(28, RACK)
    a = Gear(t, module, 6.0 * module, 1e-2, Material(modulus, 0.3))
    b = gear(bore=6.0 / t.root_radius)
    for s in SOURCES.values():
        one = s.tooth(a, radii(a, 5)).total * modulus
        two = s.tooth(b, radii(b, 5)).total * b.material.young_modulus
        np.testing.assert_allclose(one, two, rtol=1e-10)


def test_webers_tooth_bending_is_the_energy_methods():
    # Both are the energy of the same cantilever; one takes the moment about the centre line, one about the flank.
    g = gear()
    a, b = weber_banaschek.tooth_compliance(g, radii(g)), potential_energy.tooth_compliance(g, radii(g))
    for name in ("bending", "shear", "axial"):
        np.testing.assert_allclose(getattr(a, name), getattr(b, name), rtol=1e-10)


def test_webers_printed_coefficients_follow_from_the_closed_forms():
    # printed for nu = 0.3 to two or three digits
    k = weber_banaschek.coefficients(0.3, "strain")
    assert k["bending"] == pytest.approx(10.92, abs=5e-3)
    assert k["shear"] == pytest.approx(3.1, abs=0.05)
    assert k["axial"] / k["shear"] == pytest.approx(0.294, abs=5e-3)
    assert k["rotation"] == pytest.approx(5.2, abs=0.05)
    assert k["coupling"] == pytest.approx(1.0, abs=0.05)
    assert k["shift"] == pytest.approx(1.4, abs=0.05)
    assert k["sink"] / k["shift"] == pytest.approx(0.294, abs=5e-3)


def test_plane_stress_and_plane_strain_agree_without_poissons_ratio():
    t = Tooth(28, RACK)
    kw = {"module": 1e-3, "bore_radius": 6e-3, "face_width": 1e-2, "material": Material(2e11, 0.0)}
    for s in SOURCES.values():
        one, two = (s.tooth(Gear(t, plane=p, **kw), [14e-3]).total for p in ("strain", "stress"))
        assert one == pytest.approx(two, rel=1e-14, abs=0.0)


def test_cornell_beam_is_the_limit_of_the_papers_element_sum():
    # Eqs. 6 and 7 with n elements of equal length between the section and the load: error falls as 1/n^2.
    g = gear()
    tooth, e, nu = g.tooth, g.plane_modulus, 0.3
    radius = 14.5
    load = load_line(tooth, radius)
    b, y_half, y_load = float(load.angle[0]), float(load.x[0]), float(load.y[0])
    from fegear.formulas.root_section import fillet_parameter, fillet_point

    foot = fillet_point(tooth, fillet_parameter(tooth, math.radians(75.0))).height
    exact = cornell_compliance.tooth_compliance(g, radius * g.module)
    whole = float((exact.bending + exact.shear + exact.axial)[0])

    def half(y: float) -> float:
        curve = tooth.fillet if y < float(tooth.fillet.points(tooth.fillet.end)[1]) else tooth.involute
        return float(
            curve.points(brentq(lambda p: float(curve.points(p)[1]) - y, curve.start, curve.end, xtol=1e-15))[0]
        )

    def sum_of_elements(n: int) -> float:
        t = (y_load - foot) / n
        total = 0.0
        for i in range(n):
            lever = (n - i - 1) * t
            x = half(foot + (i + 0.5) * t)
            area, inertia = 2 * x, (2 * x) ** 3 / 12
            total += (
                math.cos(b) ** 2 * (t**3 + 3 * t * t * lever + 3 * t * lever**2) / (3 * inertia)
                - math.cos(b) * math.sin(b) * (t * t + 2 * t * lever) * y_half / (2 * inertia)
                + math.cos(b) ** 2 * 12 * (1 + nu) * t / (5 * area)
                + math.sin(b) ** 2 * t / area
            ) / e
        return total

    coarse, fine = (abs(sum_of_elements(n) - whole) for n in (20, 80))
    assert fine < 2e-4 * whole
    assert math.log(coarse / fine, 4) == pytest.approx(2.0, abs=0.4)


def test_sainsots_coefficients_reach_the_papers_table_of_extremes():
    # The paper gives the extremes of its elastic-ring results: L at most 6.94, P at most 13.47, Q at least 0.141. The
    # polynomials reach them within 0.01 of L and Q and 0.5 % of P, their own fit error; a wrong digit would not.
    grid = [sainsot.coefficients(h, t) for h in np.linspace(1.4, 7, 29) for t in np.linspace(0.02, 0.12, 23)]
    big_l, _, p, q = np.array(grid).T
    assert big_l.max() == pytest.approx(6.94, abs=0.01)
    assert p.max() == pytest.approx(13.47, rel=5e-3)
    assert q.min() == pytest.approx(0.141, abs=0.01)


def test_contact_parts_are_of_one_size():
    # For steel at 250 N/mm all three approaches of one tooth lie within a factor of four of each other: Palmgren's
    # highest; the linear one lowest because it counts only the contact zone itself.
    g = gear()
    r = np.array([g.pitch_radius])
    value = {n: float(s.contact(g, r, 2.5e5, 1.3e-4)[0]) for n, s in SOURCES.items()}
    assert value["potential-energy"] < value["weber-banaschek"] < value["cornell"] < 6 * value["potential-energy"]


def test_contact_of_a_table_has_the_tables_shape():
    g = gear()
    for s in SOURCES.values():
        assert s.contact(g, radii(g, 7), 1e5, 1e-4).shape == (7,)
        assert s.contact(g, radii(g, 7)[:, None], [1e5, 2e5], 1e-4).shape == (7, 2)
        assert np.all(s.contact(g, radii(g, 7), 0.0, 0.0) == 0.0)


@pytest.mark.parametrize("name", list(SOURCES))
def test_loads_off_the_involute_are_refused(name):
    g = gear()
    for r in (0.9 * g.form_radius, 1.1 * g.tip_radius, math.nan):
        with pytest.raises(RangeError, match=r"is outside the involute, 13\.2544 to 15 modules"):
            SOURCES[name].tooth(g, [r])


def test_sainsots_range_is_kept():
    with pytest.raises(RangeError, match="fitted"):
        sainsot.coefficients(1.2, 0.05)
    with pytest.raises(RangeError, match="fitted"):
        sainsot.coefficients(2.0, 0.3)
    with pytest.raises(RangeError, match="bore radius"):
        potential_energy.tooth_compliance(gear(bore=0.9), [14.0 * 3.175e-3])


def test_unknown_source_names_the_nearest():
    assert source("cornell").remark.startswith("single tooth, no coupling to neighbouring teeth")
    with pytest.raises(InputError, match="weber-banaschek"):
        source("weber-banachek")


def test_every_source_states_its_origin():
    for s in SOURCES.values():
        assert all(getattr(s, f.name) for f in dataclasses.fields(s))
