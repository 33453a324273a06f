"""ISO 6336-1 and ISO 6336-3 against published examples."""

import math

import pytest

from fegear.errors import ConvergenceError, RangeError
from fegear.formulas import iso6336_root_stress as root
from fegear.formulas import iso6336_stiffness as stiff
from fegear.formulas.fillet_section import section_at_tangent
from fegear.geometry import BasicRack, Gear, GearPair, Tooth


def contact_ratio_of_tr_30() -> float:
    # ISO/TR 6336-30, example 1: z 17/103, m_n 8, beta 15.8 deg, a 500, tip diameters 159.66 and 872.35
    z, m, beta, a, tips = (17, 103), 8.0, math.radians(15.8), 500.0, (159.66, 872.35)
    alpha_t = math.atan(math.tan(math.radians(20.0)) / math.cos(beta))
    base = [n * m / math.cos(beta) * math.cos(alpha_t) for n in z]
    alpha_wt = math.acos(sum(base) / 2 / a)
    path = 0.5 * sum(math.sqrt(t * t - b * b) for t, b in zip(tips, base, strict=True)) - a * math.sin(alpha_wt)
    return path / (math.pi * m / math.cos(beta) * math.cos(alpha_t))


def test_stiffness_of_the_worked_example():
    # Tolerance: half a unit of the last printed digit (five decimals).
    s = stiff.stiffness(
        (17, 103),
        contact_ratio_of_tr_30(),
        helix_angle=math.radians(15.8),
        profile_shift=(0.145, 0.0),
        dedendum=(1.4, 1.4),
    )
    assert s.theoretical / 1e9 == pytest.approx(17.85584, abs=6e-6)
    assert s.single / 1e9 == pytest.approx(12.37047, abs=6e-6)
    assert s.mesh_alpha / 1e9 == pytest.approx(17.46485, abs=6e-6)
    assert s.mesh_beta / 1e9 == pytest.approx(14.84512, abs=6e-6)


def pair(z: int, rack: BasicRack) -> GearPair:
    g = Gear(Tooth(z, rack), 1e-3, 1e-3)
    return GearPair(g, g)


def test_form_and_stress_correction_factor_at_the_outer_single_contact_point():
    # Equal gears, z = 25, x = 0, rack 1/1.25/0.38: Y_F Y_S = 2.848, printed to four digits.
    p = pair(25, BasicRack.named("A"))
    gear = root.RackTooth(25)
    d = root.outer_single_contact_diameter(gear, 27.0, p.contact_ratio)
    assert d == pytest.approx(2e3 * float(p.radius(p.x_hpstc, "driver")), rel=1e-12)
    f = root.root_form(gear, d)
    product = f.Y_F * f.Y_S
    assert product == pytest.approx(2.848, abs=5e-4)
    # sigma_F0 = F_t / (b m_n) Y_F Y_S: 100 N/mm on module 2 mm.
    assert root.nominal_root_stress(f, 1000.0, 10e-3, 2e-3) == pytest.approx(50e6 * product, rel=1e-14)
    with pytest.raises(RangeError, match="positive"):
        root.nominal_root_stress(f, 1000.0, 0.0, 2e-3)
    for member in ("driver", "driven"):
        same = root.pair_root_form(p, member)
        both = same.Y_F * same.Y_S
        assert both == pytest.approx(product, rel=1e-12)


@pytest.mark.parametrize("z", [9, 12, 17, 25, 60, 200, 1000])
@pytest.mark.parametrize("shift", [0.0, 0.35])
@pytest.mark.parametrize("letter", ["A", "B", "C", "D"])
def test_the_standards_section_is_the_30_degree_tangent_of_the_generated_fillet(z, shift, letter):
    # The standard's auxiliary equations are exact geometry: agreement to round-off, undercut teeth included.
    rack = BasicRack.named(letter)
    tooth = Tooth(z, rack, shift, tip_radius=z / 2 + shift + 0.8)
    f = root.root_form(root.RackTooth(z, shift, rack.dedendum, rack.tip_radius), 2.0 * tooth.tip_radius)
    p = section_at_tangent(tooth, math.pi / 6)
    assert f.root_chord == pytest.approx(p.thickness, rel=1e-11)
    assert f.fillet_radius == pytest.approx(p.fillet_radius, rel=1e-11)
    assert f.height == pytest.approx(p.height, rel=1e-11)


def test_pair_stiffness_takes_the_pinion_first():
    a, b = (Gear(Tooth(z, BasicRack.named("A"), x), 1e-3, 1e-3) for z, x in ((40, 0.0), (20, 0.3)))
    p = GearPair(a, b)
    expected = stiff.stiffness(
        (20, 40), p.contact_ratio, profile_shift=(0.3, 0.0), dedendum=(1.25, 1.25), young_modulus=(206.8e9, 206.8e9)
    )
    assert stiff.pair_stiffness(p) == expected
    assert stiff.pair_stiffness(p.reversed()).single == expected.single


def test_low_load_and_material_follow_the_standard():
    base = stiff.stiffness((20, 40), 1.6)
    assert stiff.stiffness((20, 40), 1.6, specific_load=1e5).single == pytest.approx(base.single)
    assert stiff.stiffness((20, 40), 1.6, specific_load=5e4).single == pytest.approx(base.single * 0.5**0.25)
    iron = stiff.stiffness((20, 40), 1.6, young_modulus=(103e9, 103e9))
    assert iron.single == pytest.approx(0.5 * base.single)


def test_blank_factor_bounds():
    assert stiff.blank_factor(None) == 1.0
    assert stiff.blank_factor(1.0, 5.0) == 1.0
    assert stiff.blank_factor(0.1, 0.5) == stiff.blank_factor(0.2, 1.0)
    assert stiff.blank_factor(0.2, 1.0) == pytest.approx(1 + math.log(0.2) / (5 * math.exp(0.2)))


def test_rim_and_deep_tooth_factors_are_continuous():
    # 1.6 ln(2.242/1.2) = 1.00003: the standard's own rounding
    assert root.rim_factor(1.2 - 1e-12, 1.0) == pytest.approx(1.0, abs=1e-3)
    assert root.deep_tooth_factor(2.05 + 1e-12) == pytest.approx(1.0, abs=1e-3)
    assert root.deep_tooth_factor(2.5) == pytest.approx(0.7, abs=2e-3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: stiff.theoretical_stiffness(20, 40, -0.4, -0.3), "x_1"),
        (lambda: stiff.theoretical_stiffness(20, 40, 0.0, 0.3), "must not be below"),
        (lambda: stiff.theoretical_stiffness(-20, 40), "external"),
        (lambda: stiff.stiffness((20, 40), 0.9), "at least 1"),
        (lambda: stiff.stiffness((20, 40), 2.6), "below 2.5"),
        (lambda: stiff.stiffness((20, 40), 1.6, helix_angle=-0.1), "between 0 and 45"),
        (lambda: stiff.stiffness((20, 40), 1.6, dedendum=(4.0, 4.0)), "beyond the range"),
        (lambda: root.RackTooth(25, tip_radius=0.0), "rounded rack"),
        (lambda: root.RackTooth(-25), "external"),
        (lambda: root.root_form(root.RackTooth(25, dedendum=1.25, tip_radius=0.9), 27.0), "fillets overlap"),
        (lambda: root.stress_correction_factor(2.0, 1.0, 0.1), "q_s"),
        (lambda: root.root_form(root.RackTooth(25), 20.0), "below the base diameter"),
        (lambda: root.root_form(root.RackTooth(12, 0.6), 19.0), "pointed"),
        (lambda: root.rim_factor(0.4, 1.0), "must exceed 0.5"),
        (lambda: root.helix_factor(-1.0, 0.1), "must not be negative"),
    ],
)
def test_out_of_range_says_why(call, words):
    with pytest.raises((RangeError, ConvergenceError), match=words):
        call()
