"""ISO 6336 of internal pairs: signs and curvatures against radii along the path of contact, which know no formula."""

import math

import numpy as np
import pytest

from fegear.base.errors import FegearError, RangeError
from fegear.formulas.iso6336 import part2_pitting as flanks
from fegear.formulas.iso6336.pair_geometry import Body, of_pair
from fegear.formulas.iso6336.part1_dynamic import reduced_mass
from fegear.formulas.iso6336.part1_stiffness import stiffness
from fegear.formulas.iso6336.part3_internal import ring_root_form, ring_tooth
from fegear.formulas.iso6336.part3_root_stress import ring_rim_factor
from fegear.formulas.iso6336.part5_materials import crushing_depth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair


def random_pairs(count, seed, helix=0.0):
    rng, found = np.random.default_rng(seed), []
    cut, hand = {"helix_angle": helix}, "left" if helix else "spur"
    while len(found) < count:
        try:
            tooth = Tooth(int(rng.integers(18, 36)), profile_shift=rng.uniform(0.0, 0.4), **cut)
            planet = Gear(tooth, 4e-3, 15e-3, 30e-3, hand=hand)
            teeth = planet.teeth + int(rng.integers(20, 60))
            ring = InternalTooth(
                teeth, PinionCutter(18), profile_shift=rng.uniform(-0.4, 0.2),
                tip_radius=teeth / 2 / math.cos(helix) - 0.8, **cut,
            )  # fmt: skip
            wheel = Gear(ring, 4e-3, 4e-3 * (ring.root_radius + 3.0), 40e-3, hand=hand)
            pair = GearPair(planet, wheel) if rng.random() < 0.5 else GearPair(wheel, planet)
            if any(check.margin < 0.0 for check in pair.internal_checks):
                continue  # such a pair can be drawn, but its path of contact is not that of the formulas
            if 1.05 < pair.contact_ratio < 1.95 and pair.internal:
                found.append(pair)
        except FegearError:
            continue
    return found


@pytest.fixture(scope="module")
def pairs():
    return random_pairs(40, 28)


def curvature(pair, x):
    """1/rho of the contact at x: both radii of curvature from where the contact stands."""
    radii = []
    for member in ("driver", "driven"):
        gear = pair.gear(member)
        radii.append((gear.tooth.internal, math.sqrt(float(pair.radius(x, member)) ** 2 - gear.base_radius**2)))
    return sum(-1.0 / rho if hollow else 1.0 / rho for hollow, rho in radii)


def test_contact_stress_is_that_of_hertz_at_the_curvatures_of_the_path(pairs):
    """Z_H Z_E at the pitch point and with Z_B at the pinion's inner point: cylinders under the normal load."""
    for pair in pairs:
        geometry, load = of_pair(pair), 5e3
        first = geometry.members[0]
        driver, tangential = pair.driver, load * pair.driver.base_radius / pair.driver.pitch_radius
        material = driver.material
        modulus = material.young_modulus / (1.0 - material.poisson_ratio**2)
        inner = pair.x_lpstc if first == "driver" else pair.x_hpstc
        factors = (flanks.zone_factor(geometry), flanks.elasticity_factor(geometry))
        nominal = flanks.nominal_contact_stress(geometry, tangential, factors)
        (m_1, _), (_, z_d) = flanks.single_pair_factors(geometry)
        for at, found in ((0.0, nominal), (inner, m_1 * nominal)):
            hertz = math.sqrt(load / geometry.face_width * curvature(pair, at) * modulus / (2.0 * math.pi))
            assert found == pytest.approx(hertz, rel=1e-9)
        assert z_d == 1.0


def test_helical_flanks_are_pressed_as_hertz_says_in_their_normal_section():
    """Z_H Z_E at the pitch point: F_bt / b on cylinders of rho_t / cos(beta_b); Z_B between spur and overlap 1."""
    for pair in random_pairs(10, 29, helix := math.radians(14.0)):
        geometry, load = of_pair(pair), 5e3
        tangential = load * pair.driver.base_radius / pair.driver.pitch_radius
        material = pair.driver.material
        modulus = material.young_modulus / (1.0 - material.poisson_ratio**2)
        bent = curvature(pair, 0.0) * math.cos(pair.driver.base_helix_angle)
        hertz = math.sqrt(load / geometry.face_width * bent * modulus / (2.0 * math.pi))
        factors = (flanks.zone_factor(geometry), flanks.elasticity_factor(geometry))
        assert flanks.nominal_contact_stress(geometry, tangential, factors) == pytest.approx(hertz, rel=1e-9)
        (m_1, _), (z_b, z_d) = flanks.single_pair_factors(geometry)
        part = min(geometry.overlap_ratio, 1.0)
        assert part == pytest.approx(min(30e-3 * math.sin(helix) / (math.pi * 4e-3), 1.0), rel=1e-9)
        assert (z_b, z_d) == (pytest.approx(max(m_1 - part * (m_1 - 1.0), 1.0), rel=1e-12), 1.0)
        assert geometry._contact_ratio() == pytest.approx(pair.contact_ratio, rel=1e-9)


def test_a_helix_that_vanishes_leaves_the_rating_of_the_spur_pair():
    (spur,), (small,) = (random_pairs(1, 30, helix) for helix in (0.0, 1e-6))
    one, two = of_pair(spur), of_pair(small)
    assert small.contact_ratio == pytest.approx(spur.contact_ratio, rel=1e-6)
    for question in (flanks.zone_factor, lambda g: flanks.single_pair_factors(g)[1][0], reduced_mass):
        assert question(two) == pytest.approx(question(one), rel=1e-5)
    forms = [ring_root_form(g, g.load_diameter(g.teeth - 1.6, 1.5)) for g in
             (ring_tooth(one.gears[1].outline), ring_tooth(two.gears[1].outline))]  # fmt: skip
    assert pytest.approx(forms[0].Y_F, rel=1e-6) == forms[1].Y_F


def test_angles_contact_ratio_and_reduced_curvature_are_those_of_the_pair(pairs):
    for pair in pairs:
        geometry = of_pair(pair)
        assert geometry.gears[1].signed_teeth == -max(pair.driver.teeth, pair.driven.teeth)
        assert geometry.signed_ratio < 0.0 < geometry.signed_diameters[0]
        assert geometry.working_pressure_angle == pytest.approx(pair.working_pressure_angle, rel=1e-12)
        assert geometry._contact_ratio() == pytest.approx(pair.contact_ratio, rel=1e-9)
        assert 1.0 / geometry.relative_curvature_radius == pytest.approx(curvature(pair, 0.0), rel=1e-9)


def test_the_rings_load_stands_at_its_outer_point_of_single_pair_contact(pairs):
    for pair in pairs:
        geometry = of_pair(pair)
        ring = geometry.members[1]
        at = pair.x_hpstc if ring == "driver" else pair.x_lpstc
        shape = geometry.gears[1]
        found = ring_tooth(shape.outline).load_diameter(shape.active_tip_diameter / geometry.module, pair.contact_ratio)
        assert found * geometry.module == pytest.approx(2.0 * float(pair.radius(at, ring)), rel=1e-9)


def test_a_ring_is_as_stiff_as_a_rack_and_moves_as_its_rim_does(pairs):
    """q' with 1/z_n2 = 0; m_red of a held ring is the planet's, of one that turns J/r_b^2 of both in series."""
    for pair in pairs:
        geometry = of_pair(pair)
        one, two = geometry.gears
        shifts = {"profile_shift": (0.3, -0.1)}
        rack = stiffness((one.teeth, 10**9), 1.5, **shifts).single
        assert stiffness((one.teeth, two.signed_teeth), 1.5, **shifts).single == pytest.approx(rack, rel=1e-7)
        masses = []
        for gear, base, edge in zip(
            geometry.gears, geometry.signed_base_diameters, (0.0, two.bore_diameter), strict=True
        ):
            middle, inside = 0.5 * (gear.tip_diameter + gear.root_diameter), gear.bore_diameter if not edge else 0.0
            ends = (middle, edge) if edge else (inside, middle)
            inertia = 0.5 * math.pi * gear.density * ((0.5 * ends[1]) ** 4 - (0.5 * ends[0]) ** 4)
            masses.append(inertia / (0.5 * base) ** 2)
        assert reduced_mass(geometry) == pytest.approx(1.0 / (1.0 / masses[0] + 1.0 / masses[1]), rel=1e-12)
        bodies = [Body(fixed=pair.gear(member).tooth.internal) for member in ("driver", "driven")]
        assert reduced_mass(of_pair(pair, tuple(bodies))) == pytest.approx(masses[0], rel=1e-12)


def test_c_prime_of_rings_goes_on_below_the_stated_shifts_and_says_so():
    """Rings of planetary sets and published external pairs lie below x_1 + x_2 = -0.5; the series goes on smoothly."""

    def of(x_ring, wheel=-65):
        return stiffness((23, wheel), 1.5, profile_shift=(0.3, x_ring))

    inside, edge, beyond = (of(x) for x in (-0.7, -0.8, -0.9))
    assert (inside.remark, edge.remark) == ("", "")
    assert "x_1 + x_2 = -0.6 is outside -0.5 to 2" in beyond.remark
    steps = [1e9 / two.theoretical - 1e9 / one.theoretical for one, two in ((inside, edge), (edge, beyond))]
    assert steps[1] - steps[0] == pytest.approx(2.0 * 0.00182 * 0.1**2, rel=1e-6)  # Table 9: only x_2^2 is curved
    assert beyond.single < edge.single < 1.02 * beyond.single
    assert "2.3 is outside -0.5 to 2" in of(2.0).remark
    outside = of(-0.9, wheel=65)
    assert "x_1 + x_2 = -0.6 is outside -0.5 to 2" in outside.remark
    assert of(-0.8, wheel=65).single * 0.97 < outside.single < of(-0.8, wheel=65).single


def test_thin_rims_of_rings_weaken_their_roots():
    assert ring_rim_factor(3.5) == 1.0
    assert ring_rim_factor(3.4999) == pytest.approx(1.0, abs=4e-3)  # the standard's curve ends at .9963
    assert ring_rim_factor(8.324 / math.e) == pytest.approx(1.15)
    with pytest.raises(RangeError, match="must exceed"):
        ring_rim_factor(1.75)


def test_a_case_is_crushed_at_the_depth_that_the_curvature_at_the_pitch_point_asks_for(pairs):
    """Eht_c = 2 sigma_H rho_red / (U_H cos(beta_b)) at the pitch point."""
    outer = Gear(Tooth(21), 4e-3, 15e-3), Gear(Tooth(62, profile_shift=0.2), 4e-3, 50e-3)
    for pair in (*pairs, GearPair(*outer), GearPair(*outer[::-1])):
        one, two = (pair.gear(name) for name in ("driver", "driven"))
        tangent = math.tan(pair.working_pressure_angle)
        curvature = sum(g.tooth.side / (g.base_radius * tangent) for g in (one, two))
        expected = 2.0 * 1.2e9 / abs(curvature) / (60e9 * math.cos(one.base_helix_angle))
        assert crushing_depth(pair, 1.2e9, 60e9) == pytest.approx(expected, rel=1e-12)
