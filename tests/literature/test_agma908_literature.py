"""AGMA 908-B89 J factors and the concentration factors behind them."""

import math
from itertools import pairwise

import pytest

from fegear.base.errors import RangeError
from fegear.formulas import dolan_broghamer, heywood
from fegear.formulas.agma import agma908
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

RACK = BasicRack(1.0, 1.25, 0.25)


def pair(z1: int, z2: int, thinning: float = 0.024) -> GearPair:
    a, b = (Gear(Tooth(z, RACK, thickness_allowance=thinning), 1e-3, 1e-3) for z in (z1, z2))
    return GearPair(a, b)


# AGMA 908-B89, tables of J for 20 deg, h_ao 1.25, r_ao 0.25, thinning 0.024: printed to two digits, hence 0.005.
def test_j_of_26_to_26():
    p = pair(26, 26)
    for member in ("driver", "driven"):
        assert pytest.approx(0.35, abs=5e-3) == agma908.pair_geometry_factor(p, member).J
        assert pytest.approx(0.25, abs=5e-3) == agma908.pair_geometry_factor(p, member, tip=True).J


def test_j_grows_with_the_teeth_of_gear_and_mate():
    j = [agma908.pair_geometry_factor(pair(z, 60), "driver").J for z in (24, 35, 55, 135)]
    assert j == sorted(j)
    k = [agma908.pair_geometry_factor(pair(26, z), "driver").J for z in (26, 35, 55, 135)]
    assert k == sorted(k)


def test_correction_factor_is_dolan_and_broghamers_at_their_angles():
    # AGMA's straight lines through both measured angles miss their rounded constants by up to 0.002: 0.7 % of K.
    for degrees in (14.5, 20.0):
        a = math.radians(degrees)
        for t, r, h in ((2.0, 0.3, 1.2), (1.8, 0.5, 0.9), (2.4, 0.25, 2.0)):
            k = float(dolan_broghamer.concentration_factor(t, r, h, a))
            assert agma908.stress_correction_factor(t, r, h, a) == pytest.approx(k, rel=7e-3)


def test_lewis_parabola_touches_the_fillet_from_inside():
    tooth = Tooth(26, RACK)
    g = agma908.geometry_factor(tooth, tooth.tip_radius)
    apex = g.section.height + g.load_height
    x, y = tooth.fillet.points([tooth.fillet.start + f * (tooth.fillet.end - tooth.fillet.start) for f in (0.2, 0.9)])
    # the parabola's half thickness at the height of other fillet points stays inside the tooth
    assert (x >= g.section.half_thickness * ((apex - y) / g.load_height) ** 0.5).all()


@pytest.mark.parametrize(("z", "shift"), [(129, 0.25), (135, 0.0), (200, 0.0), (400, 0.5), (1000, 0.0)])
def test_many_teeth_loaded_at_the_tip_have_a_section_on_the_trochoid_beyond_the_fillet(z, shift):
    """Own search: the rack's tip circle is rolled, and of the sections of its trace the one is taken whose bending
    6 h / s^2 is largest; that is where Lewis' parabola touches (AGMA 908-B89 bounds its iteration nowhere)."""
    import numpy as np

    tooth = Tooth(z, RACK, shift)
    apex = tooth.base_radius / math.cos(float(tooth.roll(tooth.tip_radius)) - tooth.base_half_angle)
    beta = np.linspace(1e-3, 1.5, 400_001)  # of the contact normal against the space's centre line
    rho, depth, r = RACK.tip_radius, RACK.dedendum - RACK.tip_radius - shift, 0.5 * z
    offset = RACK.tip_centre_offset
    along = depth * np.tan(beta)  # centre of the circle before the pitch point, as the normal passes through it
    turn = (along - offset) / r
    x, y = along + rho * np.sin(beta), r - depth - rho * np.cos(beta)
    angle = math.pi / z - (np.arctan2(x, y) - turn)
    half, height = np.hypot(x, y) * np.sin(angle), np.hypot(x, y) * np.cos(angle)
    bending = np.where(height < apex, (apex - height) / half**2, 0.0)
    best = int(np.argmax(bending))
    assert 0 < best < beta.size - 1
    found = agma908.geometry_factor(tooth, tooth.tip_radius)
    assert found.section.half_thickness == pytest.approx(half[best], rel=1e-5)
    assert found.load_height == pytest.approx(apex - height[best], rel=2e-5)
    assert 0.28 < found.J < 0.33


def test_j_at_the_tip_goes_on_smoothly_where_the_section_leaves_the_fillet():
    j = [agma908.geometry_factor(Tooth(z, RACK, 0.1), Tooth(z, RACK, 0.1).tip_radius).J for z in range(120, 220, 4)]
    steps = [b - a for a, b in pairwise(j)]
    assert all(s > 0.0 for s in steps)
    assert max(abs(b - a) for a, b in pairwise(steps)) < 2e-5


def test_heywoods_factor_at_two_known_points():
    # 1 + 0.26 (e/R)^0.7: e = R gives 1.26; a straight side (R infinite) gives 1
    assert float(heywood.concentration_factor(1.0, 1.0)) == pytest.approx(1.26)
    assert float(heywood.concentration_factor(1.0, math.inf)) == 1.0


def test_heywoods_place_is_a_maximum_along_the_fillet():
    import numpy as np

    from fegear.formulas.root_section import load_line

    tooth, radius = Tooth(28, RACK), 14.5
    best = heywood.tooth_root_stress(tooth, radius)
    load = load_line(tooth, radius)
    beta = np.linspace(tooth.fillet.start, tooth.fillet.end - 0.02, 400)
    x, y = tooth.fillet.points(beta)
    phi = float(load.angle[0])
    values = heywood.fillet_stress(
        x,
        (load.apex - y) * math.cos(phi),
        np.hypot(load.x - x, load.y - y),
        -1 / tooth.fillet.curvatures(beta),
        -math.sin(phi),
    )
    assert best.stress >= values.max()
    assert best.stress == pytest.approx(values.max(), rel=1e-4)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: dolan_broghamer.concentration_factor(2.0, 0.3, 1.0, math.radians(25)), "not tested"),
        (lambda: dolan_broghamer.concentration_factor(-2.0, 0.3, 1.0, math.radians(20)), "must be positive"),
        (lambda: agma908.stress_correction_factor(2.0, 0.0, 1.0, 0.35), "must be positive"),
        (lambda: agma908.pair_geometry_factor(pair(10, 60), "driver"), "undercut"),
        (lambda: heywood.concentration_factor(1.0, 0.0), "sharp corner"),
        (
            lambda: heywood.tooth_root_stress(Tooth(60, RACK), Tooth(60, RACK).form_radius),
            "gives no stress maximum inside the fillet",
        ),
        (lambda: agma908.geometry_factor(Tooth(28, RACK), 10.0), r"is outside the involute, 13\.2544 to 15 modules"),
    ],
)
def test_out_of_range_says_why(call, words):
    with pytest.raises(RangeError, match=words):
        call()
