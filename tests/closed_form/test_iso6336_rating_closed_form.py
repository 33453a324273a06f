"""ISO 6336's factors against what they stand for: Hertz at the pitch point and at B and D, inertias, twisted shafts."""

import math

import numpy as np
import pytest

from fegear.formulas.hertz import contact_modulus, line_contact, relative_curvature
from fegear.formulas.iso6336 import part1_dynamic as dynamic
from fegear.formulas.iso6336 import part1_face_load as misalignment
from fegear.formulas.iso6336 import part2_pitting as contact
from fegear.formulas.iso6336.pair_geometry import of_pair
from fegear.formulas.iso6336.part1_face_load import PinionShaft
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


def gear(z: int, beta: float = 0.0, hand: str = "spur", x: float = 0.0) -> Gear:
    return Gear(Tooth(z, BasicRack.named("A"), x, helix_angle=beta), 4e-3, 12e-3, 40e-3, hand=hand)


PAIRS = [GearPair(gear(20), gear(20)), GearPair(gear(18, x=0.4), gear(53, x=-0.1)), GearPair(gear(25), gear(90))]


@pytest.mark.parametrize("pair", PAIRS)
def test_contact_stress_of_spur_gears_is_that_of_hertz(pair):
    g = of_pair(pair)
    tangential = 6e3
    normal = tangential / g.face_width / math.cos(g.transverse_pressure_angle)
    modulus = contact_modulus(206.8e9, 0.3, 206.8e9, 0.3)

    def hertz(x: float) -> float:
        radii = [float(pair.flank_curvature_radius(x, m)) for m in ("driver", "driven")]
        return float(line_contact(normal, relative_curvature(*radii), modulus).peak_pressure)

    factors = (contact.zone_factor(g), contact.elasticity_factor(g))
    assert contact.nominal_contact_stress(g, tangential, factors) == pytest.approx(hertz(0.0), rel=1e-12)
    # M_1 at the driver's inner point of single pair contact, M_2 at the driven gear's
    m, z = contact.single_pair_factors(g)
    assert m[0] * hertz(0.0) == pytest.approx(hertz(pair.x_lpstc), rel=1e-9)
    assert m[1] * hertz(0.0) == pytest.approx(hertz(pair.x_hpstc), rel=1e-9)
    assert z == (max(m[0], 1.0), max(m[1], 1.0))
    assert of_pair(pair).contact_ratio == pytest.approx(g._contact_ratio(), rel=1e-9)


def test_zone_factor_of_helical_gears_is_hertz_along_the_contact_line():
    beta = math.radians(18.0)
    pair = GearPair(gear(22, beta, "right"), gear(61, beta, "left"))
    g = of_pair(pair)
    # along the contact line, b/cos(beta_b) long: force F_t/(cos(alpha_t) cos(beta_b)), curvature cos(beta_b) kappa_t
    c, tangential = math.cos(g.base_helix_angle), 6e3
    load = tangential / math.cos(g.transverse_pressure_angle) / c / (g.face_width / c)
    kappa = c / g.relative_curvature_radius
    peak = float(line_contact(load, kappa, contact_modulus(206.8e9, 0.3, 206.8e9, 0.3)).peak_pressure)
    factors = (contact.zone_factor(g), contact.elasticity_factor(g))
    assert contact.nominal_contact_stress(g, tangential, factors) == pytest.approx(peak, rel=1e-12)


def test_reduced_mass_is_that_of_two_inertias():
    g = of_pair(PAIRS[1])
    masses = []
    for shape, d_b in zip(g.gears, g.signed_base_diameters, strict=True):
        radii = np.linspace(0.5 * shape.bore_diameter, 0.25 * (shape.tip_diameter + shape.root_diameter), 200_001)
        inertia = np.trapezoid(2.0 * math.pi * shape.density * radii**3, radii)  # per face width
        masses.append(inertia / (0.5 * d_b) ** 2)
    assert dynamic.reduced_mass(g) == pytest.approx(1.0 / (1.0 / masses[0] + 1.0 / masses[1]), rel=1e-6)
    # three planets: each mesh moves a third of the sun
    assert dynamic.reduced_mass(g, (3, 1)) == pytest.approx(1.0 / (3.0 / masses[0] + 1.0 / masses[1]), rel=1e-6)
    # n_E1: the frequency of tooth engagement is that of the mass on the mesh stiffness
    c = 2e10
    found = dynamic.method_b(g, (1.4e10, c), 3e5, 100.0, dynamic.DynamicErrors(0.0, 0.0, 0.0, 0.0, 0.0, coarse=True))
    assert found.resonance_speed * g.gears[0].teeth == pytest.approx(math.sqrt(c / dynamic.reduced_mass(g)), rel=1e-12)


def test_shaft_deformation_of_a_pinion_in_the_middle_is_of_the_order_of_its_twist():
    # Without offset .023 mm um/N (b/d_1)^2 F_m/b is the pinion body's own twist and bending.
    width, diameter, load = 0.06, 0.06, 400e3
    found, remark = misalignment.shaft_deformation(PinionShaft("a", 0.15, 0.0, 0.05), load, width, diameter)
    assert remark == ""
    assert found == pytest.approx(400.0 * 0.023e-6, rel=1e-12)
    # a solid cylinder that takes up a uniform line load F_t/b over b: its ends twist by F_t d_1/2 b/2 / (G J)
    shear, polar = 79.3e9, math.pi * diameter**4 / 32.0
    twist = load * width * 0.5 * diameter * 0.5 * width / (shear * polar) * 0.5 * diameter
    assert 1.0 < found / twist < 3.0


@pytest.mark.parametrize(("arrangement", "sign"), [("a", 1), ("b", -1), ("c", 1), ("d", -1), ("e", -1)])
def test_an_offset_adds_to_the_twist_or_takes_off_it(arrangement, sign):
    middle = misalignment.shaft_deformation(PinionShaft(arrangement, 0.15, 0.0, 0.055), 4e5, 0.06, 0.06)[0]
    beside = misalignment.shaft_deformation(PinionShaft(arrangement, 0.15, 0.005, 0.055), 4e5, 0.06, 0.06)[0]
    assert math.copysign(1.0, beside - middle) == sign
    stiffened = misalignment.shaft_deformation(PinionShaft(arrangement, 0.15, 0.02, 0.05), 4e5, 0.06, 0.06)[0]
    plain = misalignment.shaft_deformation(PinionShaft(arrangement, 0.15, 0.02, 0.0523), 4e5, 0.06, 0.06)[0]
    assert stiffened > 0.0 < plain
    _, remark = misalignment.shaft_deformation(PinionShaft(arrangement, 0.15, 0.09, 0.05), 4e5, 0.06, 0.06)
    assert "s/l" in remark


def test_half_the_power_twists_more():
    whole, half = (
        misalignment.shaft_deformation(PinionShaft("a", 0.15, 0.0, 0.05, share), 4e5, 0.06, 0.06)[0]
        for share in (1.0, 0.5)
    )
    assert half == pytest.approx(3.0 * whole)  # B* = 1 + 2 (100 - 50)/50
