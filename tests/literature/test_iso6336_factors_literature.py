"""Single factors of ISO 6336 that published reports print for materials and pairs which the whole examples have not.

Two KISSsoft 03/2017 reports by ISO 6336:2006 method B, published in github.com/gfsReboucas/Drivetrain
(@NREL_5MW/stage_01.rtf, stage_02.rtf): a case-hardened planet in a through-hardened ring gear, 240 HB.
"""

import math

import pytest

from fegear.formulas.iso6336 import part1_dynamic as dynamic
from fegear.formulas.iso6336 import part1_face_load as face_load
from fegear.formulas.iso6336 import part1_face_load as misalignment
from fegear.formulas.iso6336 import part1_transverse as running_in
from fegear.formulas.iso6336 import part2_pitting as contact
from fegear.formulas.iso6336 import part2_pitting as flank
from fegear.formulas.iso6336 import part3_root_stress as tooth_root
from fegear.formulas.iso6336 import part3_strength as root
from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry
from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.formulas.iso6336.rated import Strength

HARD = Strength("Eh", 1500e6, 430e6)
SOFT = Strength("V", 700e6, 290e6, hardness=240.0, yield_strength=1000e6)


def half(digits: int) -> float:
    return 0.51 * 10.0**-digits


def test_running_in_of_a_hard_and_a_soft_gear():
    # second stage: f_pb 20.7 um, f_falpha 27 um, v below 5 m/s; y_p = 3.142, y_f = 4.098 um; C_ay 2.00 and 8.50 um
    for deviation, printed in ((20.7, 3.142), (27.0, 4.098)):
        both = tuple(running_in.pitch_allowance(s, deviation * 1e-6, 4.88) for s in (HARD, SOFT))
        assert running_in.mean(both) * 1e6 == pytest.approx(printed, abs=half(3))
    assert dynamic.running_in_relief((1500e6, 1500e6)) * 1e6 == pytest.approx(2.00, abs=half(2))
    assert dynamic.running_in_relief((700e6, 700e6)) * 1e6 == pytest.approx(8.50, abs=0.011)  # 8.511: cut, not rounded


@pytest.mark.parametrize(
    ("diameters", "angle", "v", "printed"),
    [
        ((718.865, 2368.025), 17.161, math.pi * 0.855 * 35.6632 / 60.0, (0.916, 1.025)),
        ((710.408, 1835.220), 15.630, math.pi * 0.378 * 246.776 / 60.0, (0.961, 1.026)),
    ],
)
def test_film_and_work_hardening_of_a_soft_gear(diameters, angle, v, printed):
    # the ring's base diameter counts as negative
    rho_1, rho_2 = (0.5e-3 * s * d * math.tan(math.radians(angle)) for s, d in zip((1, -1), diameters, strict=True))
    rho = rho_1 * rho_2 / (rho_1 + rho_2)
    assert flank.lubricant_factor(SOFT.contact, 220e-6) == pytest.approx(1.038, abs=half(3))
    assert flank.velocity_factor(SOFT.contact, v) == pytest.approx(printed[0], abs=half(3))
    assert flank.roughness_factor(SOFT.contact, (4.8e-6, 8e-6), rho) == pytest.approx(printed[1], abs=half(3))
    equivalent = flank.equivalent_roughness((4.8e-6, 8e-6), rho, 220e-6, v)
    assert flank.surface_hardened_factor(240.0, equivalent)[0] == pytest.approx(1.135, abs=half(3))


def test_root_of_a_soft_gear():
    assert root.size_factor("V", 21e-3) == pytest.approx(0.904, abs=half(3))
    assert root.size_factor("V", 45e-3) == pytest.approx(0.850, abs=half(3))
    assert root.surface_factor("V", 20e-6)[0] == pytest.approx(0.957, abs=half(3))
    # q_s of the rings from the printed s_Fn* and rho_F*; yield 1000 MPa
    layer, remark = root.slip_layer(SOFT)
    assert remark == ""
    for chord, radius, printed in ((2.875, 0.494, 1.003), (2.703, 0.418, 1.005)):
        assert root.notch_sensitivity(chord / (2.0 * radius), layer) == pytest.approx(printed, abs=half(3))


def test_life_of_a_soft_gear():
    for cycles, z_nt, y_nt in ((381.6e6, 0.940, 0.907), (1506.3e6, 0.901, 0.883)):
        assert flank.life_knots(SOFT).at(cycles) == pytest.approx(z_nt, abs=half(3))
        assert root.life_knots(SOFT).at(cycles) == pytest.approx(y_nt, abs=half(3))


def test_mean_stress_of_an_idler():
    # a planet's Y_M is printed as .700; annex B gives .714 for R = -1.2 and M = .5 (case-hardened, Y_S = 2)
    ratio = root.mean_stress_ratio("Eh", 2.0)
    assert ratio == pytest.approx(0.5)
    assert root.mean_stress_factor(ratio, -1.2) == pytest.approx(1.0 / 1.4, rel=1e-12)


def test_a_spur_pair_by_another_program_s_din_3990():
    """19/104 teeth, module 4 mm, x = .5/.15, 55 kW at 980/min; github.com/hanslhansl/din3990, tests/test_1.py.

    DIN 3990-11 of 1989 shares these formulas. The program stops its iteration of theta early (1e-4 of Y_F) and takes
    c_gamma = 20 N/(mm um); its K_v is DIN's, so the mean load is taken as printed.
    """
    gears = (
        GearShape(19, 0.5, 88e-3, 70e-3, 48.64e-3, 1.25, 0.25),
        GearShape(104, 0.15, 425.2e-3, 407.2e-3, 48.64e-3, 1.25, 0.25),
    )
    pair = PairGeometry(gears, 4e-3, math.radians(20.0), 0.0, 248.506843355171e-3)
    assert math.degrees(pair.working_pressure_angle) == pytest.approx(21.531902292465457, rel=1e-9)
    assert pair.contact_ratio == pytest.approx(1.5363235945832296, rel=1e-9)
    assert contact.contact_ratio_factor(pair.contact_ratio, 0.0) == pytest.approx(0.906214912960638, rel=1e-9)
    inner, single = contact.single_pair_factors(pair)
    assert inner == pytest.approx((1.00554704549864, 0.8835590102280203), rel=1e-9)
    assert single == pytest.approx((1.00554704549864, 1.0), rel=1e-9)
    assert contact.zone_factor(pair) == pytest.approx(2.3959406670899934, rel=1e-9)
    factors = contact.zone_factor(pair), 189.8e3, contact.contact_ratio_factor(pair.contact_ratio, 0.0), 1.0
    assert contact.nominal_contact_stress(pair, 14103.41869503906, factors) == pytest.approx(
        875.3827378988153e6, rel=1e-9
    )
    line_load = 25368.536123904036 / 48.64e-3
    seat = PinionShaft("a", 0.1, 0.0, 0.05)
    f_sh, _ = misalignment.shaft_deformation(seat, line_load, 48.64e-3, 76e-3)
    assert f_sh == pytest.approx(4.913484891366676e-6, rel=1e-9)
    wider = misalignment.initial_misalignment(Alignment(seat), f_sh, 0.0, 0.0, 0.0)
    assert wider == pytest.approx(6.534934905517679e-6, rel=1e-9)
    k = face_load.face_load_factor(5.550790414924349e-6, 20e9, line_load)
    assert k == pytest.approx(1.1064272863295082, rel=1e-9)
    exponent = face_load.root_exponent((48.64e-3, 48.64e-3), (9e-3, 9e-3))
    assert k**exponent == pytest.approx(1.0864854433487987, rel=1e-9)
    printed = (
        (8.748743355951145, 8.174657642839318, 1.3161477577049423, 2.246336378902072, 1.9147262565947287),
        (9.239504610725831, 7.834245947926714, 1.325999192893118, 2.1616566798058514, 2.008781657562889),
    )
    for gear, numbers in zip(gears, printed, strict=True):
        tooth = tooth_root.RackTooth(gear.teeth, gear.profile_shift, 1.25, 0.25)
        form = tooth_root.root_form(tooth, gear.tip_diameter / pair.module)  # at the tip: Y_Fa, Y_Sa
        found = 4.0 * form.root_chord, 4.0 * form.moment_arm, 4.0 * form.fillet_radius, form.Y_F, form.Y_S
        assert found == pytest.approx(numbers, rel=1.1e-4)
