"""Film, flash temperature, friction and loss factors: own integrals, limits, laws, and what the standards anchor."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from fegear.base.errors import RangeError
from fegear.formulas.flank_speeds import FlankSpeeds, flank_speeds
from fegear.formulas.flash_temperature import STEEL_HEAT, flash_temperature, reduced_modulus
from fegear.formulas.friction import (
    MEAN_LAWS,
    Surface,
    computed,
    helical_load_factor,
    mean_friction,
    ohlendorf,
    overlapping,
    wimmer,
)
from fegear.formulas.iso6336 import part20_flash, part21_integral, part22_micropitting
from fegear.formulas.iso6336.part22_micropitting import fzg_type_a, fzg_type_c
from fegear.formulas.iso6336.rated import LoadFactors, RatedSurface
from fegear.formulas.lubricant import Oil
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = reduced_modulus((206e9, 206e9), (0.3, 0.3))
OIL = Oil(220e-6, 19e-6)


def pair_of(rng, helix=0.0, face=0.02):
    module = 3e-3
    rack = BasicRack.named("A", math.radians(20.0))
    gears = [
        Gear(Tooth(int(z), rack, profile_shift=float(x), helix_angle=helix), module, 0.01, face, hand=hand)
        for z, x, hand in zip(
            rng.integers(18, 70, 2),
            rng.uniform(-0.1, 0.3, 2),
            ("right", "left") if helix else ("spur",) * 2,
            strict=True,
        )
    ]
    return GearPair(*gears)


def rated(pair=None, **changes):
    known = {
        "speed": 200.0, "load": 5000.0, "factors": LoadFactors(1.25, 1.1, 1.2, 1.0),
        "surface": Surface(OIL, 70.0, 5e-7),
    }  # fmt: skip
    return RatedSurface(pair or fzg_type_c(), **(known | changes))


def test_oil_passes_through_its_points_and_thins_as_it_warms():
    assert OIL.kinematic([40.0, 100.0]) == pytest.approx([220e-6, 19e-6], rel=1e-12)
    over = OIL.dynamic(np.linspace(-30.0, 200.0, 100))
    assert (np.diff(over) < 0.0).all()
    assert (over > 0.0).all()
    assert OIL.density(16.0) == pytest.approx(895.0)
    alpha = 2.657e-8 * float(OIL.dynamic(38.0)) ** 0.1348  # Formula 9 at the temperature to which it belongs
    assert OIL.pressure_viscosity(38.0) == pytest.approx(alpha, rel=1e-12)
    for wrong in ((1e-6, math.nan), (20e-6, 20e-6), (20e-6, 30e-6)):
        with pytest.raises(RangeError):
            Oil(*wrong)


def test_blok_s_constant_is_that_of_a_semi_elliptical_source_at_speed():
    """Surface of a half-space under a fast source: integral of q / sqrt(pi B^2 v (x - s)), done by quadrature."""

    def surface(x):  # s = x - t^2, half-width 1
        return quad(lambda t: 2.0 * math.sqrt(max(1.0 - (x - t * t) ** 2, 0.0)), 0.0, math.sqrt(x + 1.0))[0]

    greatest = max(surface(x) for x in np.linspace(-0.9, 1.0, 200))
    mu, w, v_1, v_2, radius = 0.05, 3e5, 6.0, 4.0, 0.01
    half = math.sqrt(8.0 * w * radius / (math.pi * STEEL))
    # q_0 = 2 mu w v / (pi b); each body takes its part so that both surfaces are equally hot
    heat = mu * w * abs(v_1 - v_2) / (STEEL_HEAT * (math.sqrt(v_1) + math.sqrt(v_2)))
    own = heat * 2.0 / (math.pi**1.5 * math.sqrt(half)) * greatest
    one = np.ones(1)
    found = flash_temperature(FlankSpeeds(0 * one, one, one, radius * one, v_1 * one, v_2 * one), w, mu, STEEL)
    assert found[0] == pytest.approx(own, rel=5e-3)  # the standard rounds 0.622 to 0.62
    film = part22_micropitting.film(
        Surface(OIL, 70.0, 5e-7), FlankSpeeds(0 * one, one, one, radius * one, v_1 * one, v_2 * one),
        2.0 * w / (math.pi * half), mu, 80.0, STEEL, STEEL_HEAT,
    )  # fmt: skip
    assert film.flash[0] == pytest.approx(own, rel=0.02)  # ISO/TR 15144-1 writes sqrt(pi)/2 for the same integral


def test_flash_temperature_is_zero_where_nothing_slides_and_grows_as_load_to_three_quarters():
    pair = fzg_type_c()
    at = flank_speeds(pair, np.array([0.0, pair.x_start, pair.x_end]), 150.0)
    once, twice = (flash_temperature(at, w, 0.05, STEEL) for w in (2e5, 4e5))
    assert once[0] == pytest.approx(0.0, abs=1e-9)
    assert (once[1:] > 0.0).all()
    assert twice[1:] == pytest.approx(once[1:] * 2.0**0.75)
    assert (flash_temperature(at, 0.0, 0.05, STEEL) == 0.0).all()
    mirrored = flank_speeds(pair.reversed(), np.array([-pair.x_start]), 150.0 * 16 / 24)
    assert flash_temperature(mirrored, 2e5, 0.05, STEEL)[0] == pytest.approx(once[1], rel=1e-9)
    for speed in (0.0, -1.0, math.nan):
        with pytest.raises(RangeError, match="must be greater than zero"):
            flank_speeds(pair, 0.0, speed)


def test_the_standard_s_anchors():
    """X_M = 50.0 of steel and X_alphabeta of Table 2 as ISO/TR 13989 prints them; K_Bgamma at both ends."""
    assert part21_integral.thermal_factor(STEEL) == pytest.approx(50.0, abs=0.2)
    straight = pair_of(np.random.default_rng(1))
    assert straight.driver.tooth.profile_shift != 0.0
    plain = GearPair(*(Gear(Tooth(z, BasicRack.named("A", math.radians(20.0))), 3e-3, 0.01, 0.02) for z in (20, 31)))
    assert part21_integral.angle_factor(plain) == pytest.approx(0.978, abs=6e-4)
    assert [helical_load_factor(e) for e in (1.5, 2.0, 3.5, 5.0)] == [1.0, 1.0, 1.3, 1.3]
    assert helical_load_factor(2.5) == pytest.approx(1.0 + 0.2 * math.sqrt(1.25))


def test_flash_temperature_is_that_of_the_equation_in_reduced_coordinates():
    """ISO/TR 13989-1, Eqs. A.5 and A.6 with X_alphabeta of -2, Eq. 13: the same as Blok's form over the whole path."""
    case = rated(fzg_type_a(), factors=LoadFactors())
    pair, x = case.pair, np.linspace(case.pair.x_start, case.pair.x_end, 7)
    u, gamma = 1.5, x / (pair.driver.base_radius * math.tan(pair.working_pressure_angle))
    geometry = 0.51 * part21_integral.angle_factor(pair) * math.sqrt(u + 1.0) * np.abs(
        np.sqrt(1 + gamma) - np.sqrt(1 - gamma / u)
    ) / ((1 + gamma) * (u - gamma)) ** 0.25  # fmt: skip
    literal = (
        0.05 * part21_integral.thermal_factor(case.modulus) * geometry * (case.unit_load * 1e-3) ** 0.75
        * math.sqrt(case.reference_speed) / (pair.centre_distance * 1e3) ** 0.25
    )  # fmt: skip
    found = flash_temperature(case.at(x), case.line_load, 0.05, case.modulus)
    assert found == pytest.approx(literal, rel=5e-3)  # 0.51 x 1.22 = 0.6222 there


def test_film_grows_and_shrinks_as_dowson_and_higginson_have_it():
    pair = fzg_type_c()
    surface, x = Surface(OIL, 70.0, 5e-7), np.array([0.0])
    slow, fast = (
        part22_micropitting.film(surface, flank_speeds(pair, x, v), 1e9, 0.05, 80.0, STEEL) for v in (50.0, 100.0)
    )
    assert slow.contact[0] == pytest.approx(80.0, abs=1e-9)  # nothing slides at the pitch point
    assert fast.thickness[0] == pytest.approx(slow.thickness[0] * 2.0**0.7)
    pressed = part22_micropitting.film(surface, flank_speeds(pair, x, 50.0), 2e9, 0.05, 80.0, STEEL)
    assert pressed.thickness[0] == pytest.approx(slow.thickness[0] * 2.0**-0.26)
    at = flank_speeds(pair, x, 50.0)
    own = 1.6 * at.relative_radius * (float(OIL.pressure_viscosity(80.0)) * STEEL) ** 0.6 * (
        float(OIL.dynamic(80.0)) * at.sum / (2.0 * STEEL * at.relative_radius)
    ) ** 0.7 * (2.0 * math.pi * (1e9 / STEEL) ** 2) ** -0.13  # fmt: skip
    assert slow.thickness == pytest.approx(own, rel=1e-12)
    assert slow.ratio[0] == pytest.approx(slow.thickness[0] / 5e-7)
    none = part22_micropitting.film(surface, at, 0.0, 0.05, 80.0, STEEL)
    assert none.flash[0] == 0.0
    assert math.isinf(none.ratio[0])


def test_permissible_film_follows_the_test_gears():
    """Thicker films for thicker oils and earlier failure; within an eighth of the curves of Annex A, read by eye."""
    read = {100: (0.25, 0.09), 220: (0.40, 0.145), 460: (0.57, 0.20)}
    for grade, drawn in read.items():
        found = [part22_micropitting.permissible_ratio(Oil(grade * 1e-6), stage) for stage in (5, 10)]
        assert found == pytest.approx(drawn, rel=0.125)
    over = [part22_micropitting.permissible_ratio(OIL, stage) for stage in range(5, 11)]
    assert (np.diff(over) < 0.0).all()
    with pytest.raises(RangeError, match="5 to 10"):
        part22_micropitting.permissible_ratio(OIL, 4)


def test_safeties_fall_with_the_load_and_rise_with_the_test():
    light, heavy = (rated(load=load) for load in (3000.0, 9000.0))
    x = np.array([0.0])
    temperatures = [part20_flash.flash_temperatures(one, x).largest for one in (light, heavy)]
    integral = [part21_integral.integral_temperature(one).integral for one in (light, heavy)]
    films = [part22_micropitting.least_ratio(one)[0] for one in (light, heavy)]
    assert temperatures[1] > temperatures[0] > 70.0
    assert integral[1] > integral[0] > 70.0
    assert films[1] < films[0]
    for of_test in (part20_flash.scuffing_temperature, part21_integral.scuffing_integral_temperature):
        assert of_test(heavy, 12) > of_test(heavy, 8) > 80.0
    assert part20_flash.safety(200.0, 135.0, 70.0) == pytest.approx(2.0)
    assert math.isinf(part20_flash.safety(200.0, 70.0, 70.0))


def test_load_sharing_of_the_standard_meets_its_corners():
    pair = fzg_type_c()
    a, e, p = pair.x_start, pair.x_end, pair.base_pitch
    x = np.array([a, e - p, 0.0, a + p, e])
    assert part20_flash.load_sharing_factor(pair, x) == pytest.approx([1 / 3, 1.0, 1.0, 1.0, 1 / 3])
    beside = np.array([e - p - 1e-9, a + p + 1e-9])
    assert part20_flash.load_sharing_factor(pair, beside) == pytest.approx([2 / 3, 2 / 3], abs=1e-6)
    assert part20_flash.spur_sharing(pair, np.array([a, (a + e - p) / 2, e])) == pytest.approx([1 / 3, 1 / 2, 1 / 3])
    coarse = part20_flash.load_sharing_factor(pair, np.array([a, e]), 10)
    assert coarse == pytest.approx([8 / 15, 8 / 15])


def test_contact_ratio_factor_is_steady_where_its_ranges_meet():
    """X_epsilon of -21 where one addendum ratio passes 1, and the symmetric pair's value where both are alike."""
    for low, high in (((1.0 - 1e-9, 0.6), (1.0 + 1e-9, 0.6)), ((0.6, 1.0 - 1e-9), (0.6, 1.0 + 1e-9))):
        assert part21_integral.contact_ratio_factor(*low) == pytest.approx(part21_integral.contact_ratio_factor(*high))
    with pytest.raises(RangeError):
        part21_integral.contact_ratio_factor(1.6, 1.5)


@pytest.mark.parametrize("law", MEAN_LAWS)
def test_mean_laws_have_their_exponents(law):
    surface = Surface(OIL, 70.0, 5e-7)
    base = mean_friction(law, surface, 4e5, 8.0, 0.01)
    assert mean_friction(law, surface, 8e5, 8.0, 0.01) == pytest.approx(base * 2**0.2)
    assert mean_friction(law, surface, 4e5, 16.0, 0.01) == pytest.approx(base * 2**-0.2)
    thick = Surface(OIL, 40.0, 5e-7)
    ratio = float(OIL.dynamic(40.0) / OIL.dynamic(70.0))
    assert mean_friction(law, thick, 4e5, 8.0, 0.01) == pytest.approx(base * ratio**-0.05)
    assert 0.02 < base < 0.12
    assert mean_friction(law, surface, 0.0, 8.0, 0.01) == 0.0
    assert mean_friction(law, surface, 4e5, 0.0, 0.01) == 0.5  # boundary: no law holds there
    with pytest.raises(RangeError):
        Surface(OIL, 70.0, 0.0)


def test_ohlendorf_is_equal_sharing_and_wimmer_any_contact_ratio():
    rng = np.random.default_rng(5)
    for _ in range(20):
        pair = pair_of(rng)
        if not (pair.x_start < pair.x_end - pair.base_pitch <= 0.0 <= pair.x_start + pair.base_pitch < pair.x_end):
            continue
        assert wimmer(pair) == pytest.approx(ohlendorf(pair), rel=1e-12)
        x = np.linspace(pair.x_start, pair.x_end, 20_001)
        alone = (x > pair.x_end - pair.base_pitch) & (x < pair.x_start + pair.base_pitch)
        mean = np.trapezoid(np.abs(x) * np.where(alone, 1.0, 0.5), x) / pair.base_pitch
        assert computed(pair, mean) == pytest.approx(ohlendorf(pair), rel=2e-4)
    with pytest.raises(RangeError):
        ohlendorf(fzg_type_c().__class__(*(Gear(Tooth(z, BasicRack(1.35, 1.6, 0.2)), 3e-3, 0.01) for z in (50, 60))))


def test_wimmer_over_the_face_is_brute_force_and_ends_in_both_limits():
    rng = np.random.default_rng(11)
    for face in (2e-5, 0.012, 0.05):
        pair = pair_of(rng, math.radians(15.0), face)
        pitch, half = pair.base_pitch, 0.5 * pair.overlap_ratio
        phase, z = (np.arange(400) + 0.5) / 400, (np.arange(400) + 0.5) / 400 - 0.5
        line = phase[:, None, None] + np.arange(-5, 6)[None, :, None] + 2.0 * half * z
        on = (line > pair.x_start / pitch) & (line < pair.x_end / pitch)
        mean = ((np.abs(line) * on).sum(axis=(1, 2)) / on.sum(axis=(1, 2))).mean() * pitch
        assert wimmer(pair) == pytest.approx(computed(pair, mean), rel=3e-3)
    whole = pair_of(np.random.default_rng(3), math.radians(15.0), math.pi * 3e-3 / math.sin(math.radians(15.0)))
    assert whole.overlap_ratio == pytest.approx(1.0)
    assert wimmer(whole) == pytest.approx(overlapping(whole), rel=1e-9)


def test_the_approach_factor_falls_from_one_to_six_tenths():
    """X_Q over the ratio of the contact ratios of approach and recess, 1 up to 1.5, 0.6 from 3 on."""
    found = []
    for shifts in ((0.6, -0.5), (0.3, -0.2), (0.0, 0.0), (-0.2, 0.2), (-0.3, 0.4), (-0.4, 0.6), (-0.4, 0.75)):
        gears = (Gear(Tooth(26, profile_shift=shift), 3e-3, 0.02, face_width=0.02) for shift in shifts)
        one = rated(GearPair(*gears))
        first, second = part21_integral.contact_ratios(one.pair)[::-1]
        found.append(first / second)
        assert part21_integral.integral_temperature(one).approach == pytest.approx(
            float(np.interp(first / second, [1.5, 3.0], [1.0, 0.6])), rel=1e-12
        )
    assert min(found) < 1.5 < found[-3] < found[-2] < 3.0 < max(found)


def test_a_pair_and_its_reverse_warm_alike_but_for_the_shock_of_approach():
    """Whichever gear drives: friction, geometry at the pinion's tip, film and mirrored flash temperatures."""
    for pair in (fzg_type_a(), fzg_type_c()):
        one, other = rated(pair), rated(pair.reversed(), speed=200.0 * 16 / 24)
        first, second = (part21_integral.integral_temperature(case) for case in (one, other))
        for name in ("friction", "thermal", "angle", "geometry", "contact_ratio"):
            assert getattr(first, name) == pytest.approx(getattr(second, name), rel=1e-9), name
        x = np.linspace(pair.x_start, pair.x_end, 9)
        here, there = part20_flash.flash_temperatures(one, x), part20_flash.flash_temperatures(other, -x)
        assert here.flash / here.approach == pytest.approx(there.flash / there.approach, rel=1e-9, abs=1e-6)
        assert here.approach[x > 0.0] == pytest.approx(1.0)
        assert there.approach[x < 0.0] == pytest.approx(1.0)
        assert part22_micropitting.least_ratio(one)[0] == pytest.approx(part22_micropitting.least_ratio(other)[0])
        assert wimmer(pair) == pytest.approx(wimmer(pair.reversed()), rel=1e-12)
