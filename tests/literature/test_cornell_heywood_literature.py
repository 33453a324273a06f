"""Cornell's root stress: the test gear of NASA CR-3626 (W. D. Mark 1982), Eqs. 5.17 to 5.22 and Appendix B."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from fegear.base.errors import RangeError
from fegear.formulas import cornell_heywood as cornell
from fegear.formulas.cornell import section_lengths
from fegear.formulas.root_section import fillet_point, load_line
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

# z = 28, 8 teeth per inch of diameter, 20 deg: R_b = 1.75 in cos(20 deg); all lengths in cm
R_B = 1.75 * 2.54 * math.cos(math.radians(20.0))
BETA = math.radians(3.98222)
PAPER = cornell.RootSection(R_B, BETA, 0.1016, 4.0909406, 0.56958151)
THINNING = 28 * (Tooth(28).base_half_angle - BETA)
PAPER_TOOTH = Tooth(28, BasicRack(1.0, 1.34225, 0.22972), thickness_allowance=THINNING)
#: from the base circle to the tip circle, 1.875 in
ROLLS = np.linspace(0.0, math.sqrt((1.875 * 2.54 / R_B) ** 2 - 1.0), 21)


def test_root_thickness_follows_from_the_radial_flank_to_all_digits():
    assert cornell.RootSection.radial(R_B, BETA, 0.1016, 4.0909406).root_thickness == pytest.approx(
        0.56958151, abs=5e-9
    )


@given(st.floats(0.0, math.pi / 2), st.floats(0.0, float(ROLLS[-1])))
def test_iteration_converges_from_any_start(start, roll):
    expected, _ = cornell.critical_angle(PAPER, roll)
    found, count = cornell.critical_angle(PAPER, roll, start)
    assert found == pytest.approx(expected, abs=1e-11)
    assert count <= 20


def test_iteration_finds_the_stationary_point_without_the_square_root_term():
    # Cornell's 0.16 stands for 0.26 / 2^0.7 = 0.16005: the place moves by less than 1e-3 deg.
    gamma, _ = cornell.critical_angle(PAPER, ROLLS)
    angle, _, arm = cornell.lever(PAPER, ROLLS)
    for g, phi, l0 in zip(gamma, angle, arm, strict=True):

        def stress(x: float, phi: float = phi, l0: float = l0) -> float:
            h = PAPER.root_thickness + 2 * PAPER.fillet_radius * (1 - math.cos(x))
            lp = l0 + PAPER.fillet_radius * math.sin(x)
            return -(1 + 0.26 * (h / 2 / PAPER.fillet_radius) ** 0.7) * (6 * lp / h**2 - math.tan(phi) / h)

        best = minimize_scalar(stress, bounds=(0.0, math.pi / 2), method="bounded", options={"xatol": 1e-10})
        assert math.degrees(abs(best.x - g)) < 1e-3


def test_lever_arms_satisfy_the_papers_own_geometry():
    # B.7 and B.8 derived from the figure against B.9: l_s' = l_s - (h_W/2) tan(phi'), l_0 = l_s' - r sin(gamma_s)
    eps = ROLLS[1:]
    angle, half, arm = cornell.lever(PAPER, eps)
    gamma = BETA - eps + np.arctan(eps)
    r_w = R_B * np.hypot(1.0, eps)
    np.testing.assert_allclose(half, r_w * np.sin(gamma), rtol=1e-13)
    np.testing.assert_allclose(
        arm, r_w * (np.cos(gamma) - np.sin(gamma) * np.tan(eps - BETA)) - PAPER.fillet_height, rtol=1e-11
    )
    np.testing.assert_allclose(angle, eps - BETA)


def test_section_lengths_are_those_that_the_paper_prints():
    """B.3 to B.10 as printed; B.2 with A and B of the table gives the place again, B.1 the stress."""
    found = section_lengths(PAPER, ROLLS)
    r, gamma = PAPER.fillet_radius, BETA - ROLLS + np.arctan(ROLLS)
    r_w, phi = R_B * np.hypot(1.0, ROLLS), ROLLS - BETA
    np.testing.assert_allclose(found.load_angle, phi, atol=1e-15)
    np.testing.assert_allclose(found.load_half_angle, gamma, rtol=1e-12)
    np.testing.assert_allclose(found.load_thickness, 2 * r_w * np.sin(gamma), rtol=1e-12)
    h_0, r_m = PAPER.root_thickness, PAPER.fillet_height
    np.testing.assert_allclose(found.thickness, h_0 + 2 * r * (1 - np.cos(found.place)), rtol=1e-13)
    l_b = R_B * math.cos(BETA) - r_m  # from R_m up to the base circle's point of the flank (B.17)
    l_s = l_b + r * np.sin(found.place) + R_B * (np.hypot(1.0, ROLLS) * np.cos(gamma) - math.cos(BETA))
    np.testing.assert_allclose(found.to_load, l_s, rtol=1e-11)
    np.testing.assert_allclose(found.to_line, l_s - r_w * np.sin(gamma) * np.tan(phi), rtol=1e-11)
    np.testing.assert_allclose(found.a, h_0 / r + 2 * (1 - np.cos(found.place)), rtol=1e-13)
    np.testing.assert_allclose(found.b, found.arm / r + np.sin(found.place), rtol=1e-13)
    np.testing.assert_allclose(cornell.next_angle(found.a, found.b, np.tan(phi)), found.place, atol=1e-11)
    stress = cornell.modified_heywood(
        found.thickness, found.to_line, found.to_load, found.load_thickness, r, found.load_angle, 0.25
    )
    np.testing.assert_allclose(stress, cornell.root_stress(PAPER, ROLLS).stress, rtol=1e-12)


def test_stress_grows_with_the_load_radius_beyond_the_pitch_point():
    stress = cornell.root_stress(PAPER, ROLLS[ROLLS > 0.3]).stress
    assert np.all(np.diff(stress) > 0.0)


def test_stress_scales_as_one_over_length():
    metres = cornell.RootSection(R_B / 100, BETA, 0.001016, 0.040909406, 0.0056958151)
    np.testing.assert_allclose(
        cornell.root_stress(metres, ROLLS).stress, 100 * cornell.root_stress(PAPER, ROLLS).stress, rtol=1e-12
    )


def test_generated_tooth_resembles_the_papers_inputs():
    # The paper gives no rack. The generated tooth with its beta (thinning 0.04204 modules), its fillet radius (rack
    # tip radius 0.22972) and a root circle 1.4 modules below the pitch circle must give its R_m and h_0.
    section = cornell.RootSection.radial_of(PAPER_TOOTH)
    module = 0.3175
    assert PAPER_TOOTH.base_half_angle == pytest.approx(BETA, abs=1e-8)
    assert section.fillet_radius * module == pytest.approx(0.1016, abs=5e-5)
    assert PAPER_TOOTH.root_radius == pytest.approx(14.0 - 1.4, abs=5e-6)
    assert section.fillet_height * module == pytest.approx(4.0909406, abs=2e-6)
    assert section.root_thickness * module == pytest.approx(0.56958151, abs=1e-6)


def test_height_of_the_fillet_follows_from_a_dedendum_of_1_4_modules_to_seven_digits():
    # the radial flank at beta touches a circle of 0.04 in that stands on the root circle of 1.575 in: 1.6106065 in
    root, r = 1.75 - 1.4 / 8.0, 0.04
    assert math.cos(BETA) * math.sqrt((root + r) ** 2 - r**2) == pytest.approx(1.6106065, abs=1e-7)


@pytest.mark.parametrize("z", [8, 12, 17, 28, 60, 300])
def test_on_a_generated_tooth_the_place_solves_b2_with_the_true_section(z):
    tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), tip_radius=z / 2 + 0.9)
    low = max(tooth.form_radius, tooth.base_radius)
    for radius in np.linspace(low + 0.2, tooth.tip_radius, 4):
        result = cornell.tooth_root_stress(tooth, float(radius))
        assert result.stress > 0.0
        if result.remark:
            continue
        load = load_line(tooth, radius)
        lever = float(load.apex[0]) - result.height
        a, b = 2 * result.half_thickness / result.fillet_radius, lever / result.fillet_radius
        again = float(cornell.next_angle(a, b, math.tan(float(load.angle[0]))))
        assert again == pytest.approx(result.tangent_angle, abs=1e-9)


def test_with_a_circular_fillet_both_routes_agree():
    # Replace the trochoid by its circle of curvature at the found place: the paper's own iteration must stop there.
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    radius = 14.6
    r = cornell.tooth_root_stress(tooth, radius)
    g = r.tangent_angle
    section = cornell.RootSection(
        tooth.base_radius,
        tooth.base_half_angle,
        r.fillet_radius,
        r.height + r.fillet_radius * math.sin(g),
        2.0 * (r.half_thickness - r.fillet_radius * (1.0 - math.cos(g))),
    )
    found = cornell.root_stress(section, tooth.roll(radius))
    assert float(found.angle) == pytest.approx(g, abs=1e-9)
    assert float(found.stress) == pytest.approx(r.stress, rel=1e-9)


def test_fillet_point_lies_on_the_outline():
    tooth = Tooth(28)
    p = fillet_point(tooth, tooth.fillet.end)
    assert p.radius == pytest.approx(tooth.form_radius, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: cornell.critical_angle(PAPER, -0.1), "must not be negative"),
        (lambda: cornell.critical_angle(PAPER, 3.0), "intersection of the flanks|centre line"),
        (lambda: cornell.RootSection(R_B, BETA, -0.1, 4.0, 0.5), "must be positive"),
        (lambda: cornell.RootSection(R_B, BETA, 0.1, 4.0, 0.5, -1.0), "must not be negative"),
        (lambda: cornell.stress_at(cornell.RootSection(R_B, BETA, 0.1, 4.3, 0.5), 0.1, 0.5), "above the root section"),
        (
            lambda: cornell.critical_angle(cornell.RootSection(R_B, BETA, 0.1, 4.9, 0.5), 0.1),
            "acts too low on the flank: no stress maximum in",
        ),
        (lambda: cornell.RootSection.radial_of(Tooth(80)), "no radial flank"),
        (lambda: cornell.tooth_root_stress(Tooth(28), 12.0), r"is outside the involute, 13\.2544 to 15 modules"),
    ],
)
def test_out_of_range_says_why(call, words):
    with pytest.raises(RangeError, match=words):
        call()
