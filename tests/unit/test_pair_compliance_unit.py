"""One tooth pair in closed form: symmetry, sums, limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import GeometryError, InputError, RangeError
from fegear.contact.plane.table_compliance import refuse_table
from fegear.formulas import cornell as cornell_compliance
from fegear.formulas import potential_energy, potential_energy_simplified, weber_banaschek
from fegear.formulas.beam import NODES
from fegear.formulas.outcome import attempt
from fegear.formulas.root_stress_formulas import root_stress_table
from fegear.formulas.sources import SOURCES, pair_compliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

NODES_FREE = {
    m.SOURCE.name: m.tooth_compliance
    for m in (cornell_compliance, weber_banaschek, potential_energy, potential_energy_simplified)
}
RACK = BasicRack(1.0, 1.25, 0.25)


def pair(z1: int = 28, z2: int = 28) -> GearPair:
    teeth = [Tooth(z, RACK) for z in (z1, z2)]
    return GearPair(*(Gear(t, 2e-3, 1e-3 * t.root_radius, 1e-2) for t in teeth))


def positions(p: GearPair, count: int = 21) -> np.ndarray:
    return np.linspace(p.x_start, p.x_end, count)


@pytest.mark.parametrize("name", list(SOURCES))
def test_equal_gears_are_symmetric_about_the_pitch_point(name):
    p = pair()
    c = pair_compliance(SOURCES[name], p, positions(p), 2e5)
    np.testing.assert_allclose(c.total, c.total[::-1], rtol=1e-10)
    np.testing.assert_allclose(c.driver, c.driven[::-1], rtol=1e-10)
    assert not c.contact.flags.writeable


@pytest.mark.parametrize("name", list(SOURCES))
def test_exchanging_driver_and_driven_mirrors_the_path(name):
    p = pair(28, 45)
    x = positions(p)
    one = pair_compliance(SOURCES[name], p, x, 2e5)
    two = pair_compliance(SOURCES[name], p.reversed(), -x, 2e5)
    np.testing.assert_allclose(one.total, two.total, rtol=1e-10)


@pytest.mark.parametrize("name", ["cornell", "weber-banaschek"])
def test_the_pair_stiffens_with_load_and_less_than_tenfold_over_seven_decades(name):
    p = pair()
    loads = np.logspace(0, 7, 15)
    k = pair_compliance(SOURCES[name], p, np.zeros(15), loads).stiffness
    assert np.all(np.diff(k) > 0.0)
    assert k[-1] < 10 * k[0]


def test_bad_calls_say_why():
    p = pair()
    with pytest.raises(RangeError, match="must be positive"):
        pair_compliance(SOURCES["cornell"], p, 0.0, 0.0)
    with pytest.raises(RangeError, match=r"is outside the involute, .* to 15 modules"):
        pair_compliance(SOURCES["cornell"], p, 1.1 * p.x_end, 1e5)


@st.composite
def teeth(draw: st.DrawFn) -> Tooth:
    z = draw(st.integers(5, 1000))
    dedendum = draw(st.floats(1.0, 1.6))
    alpha = np.radians(draw(st.sampled_from([14.5, 20.0, 22.5, 25.0])))
    try:
        full = BasicRack(1.0, dedendum, 0.0, alpha).full_fillet_radius
        rack = BasicRack(1.0, dedendum, max(draw(st.floats(0.0, 1.0)) * full, 0.0), alpha)
        shift = draw(st.floats(-0.6, 1.0))
        tip = z / 2 + shift + draw(st.floats(0.3, 1.1))
        return Tooth(z, rack, shift, tip_radius=tip, thickness_allowance=draw(st.sampled_from([0.0, 0.05])))
    except GeometryError:
        return Tooth(28, RACK)


@given(teeth(), st.floats(0.0, 1.0))
def test_any_tooth_gives_finite_numbers_or_reasons(tooth, where):
    radius = tooth.form_radius + where * (tooth.involute_tip_radius - tooth.form_radius)
    for outcomes in root_stress_table(tooth, [radius]).values():
        for o in outcomes:
            if o.ok:
                assert np.isfinite(o.unwrap().stress)
                assert o.unwrap().radius <= tooth.tip_radius
            else:
                assert len(o.reason) > 20
    gear = Gear(tooth, 1e-3, 0.5e-3 * tooth.root_radius)
    for source in SOURCES.values():
        o = attempt(lambda s=source: s.tooth(gear, [radius * 1e-3]))
        if o.ok:
            assert np.isfinite(o.unwrap().total).all()
            assert (o.unwrap().total > 0.0).all()
            finer = NODES_FREE[source.name](gear, [radius * 1e-3], nodes=2 * NODES)
            np.testing.assert_allclose(o.unwrap().total, finer.total, rtol=1e-10)
        else:
            assert "Sainsot" in o.reason


@pytest.mark.parametrize(("left", "taken"), [(0.0, True), (0.149, True), (0.151, False)])
def test_a_table_may_leave_out_fifteen_per_cent_of_the_path_at_either_end(left, taken):
    p = pair()
    for first, last in ((left, 0.0), (0.0, left)):
        x = np.linspace(p.x_start + first * p.path_length, p.x_end - last * p.path_length, 9)
        compliance = np.full(9, 20.0 / (p.face_width * p.driver.material.young_modulus))
        if taken:
            refuse_table(p, x, compliance, "pair")
        else:
            with pytest.raises(InputError, match=r"at most 15 % at each end; 15\.1 % is missing"):
                refuse_table(p, x, compliance, "pair")
