"""Every row and constant of ANSI/AGMA 2101-D04 that the code holds, typed once more from the standard, by clause.

Bending numbers of carburized, induction-hardened and 2.5 % chrome steel are recalled, as the code says of them.
"""

import math

import pytest

from fegear.base.errors import RangeError
from fegear.formulas.agma import agma2101_factors as factors
from fegear.formulas.agma.agma2101 import HARD_CASES, RECALLED_ROOTS, AllowableStress, Service, allowable_stress

#: Clause 8: B and C of A_v = 6 to 12.
B = {level: 0.25 * (level - 5.0) ** 0.667 for level in range(6, 13)}


@pytest.mark.parametrize("level", B)
def test_dynamic_factor_by_clause_8(level):
    b, c = B[level], 50.0 + 56.0 * (1.0 - B[level])
    # v in m/s, sqrt(196.85 v) as in the metric edition
    assert factors.dynamic_factor(8.0, level) == pytest.approx((c / (c + math.sqrt(196.85 * 8.0))) ** -b, rel=1e-12)
    fastest = (c + (14.0 - level)) ** 2 / 196.85
    assert factors.dynamic_factor(fastest * (1 - 1e-9), level) > 1.0
    with pytest.raises(RangeError, match="must not exceed"):
        factors.dynamic_factor(fastest * (1 + 1e-9), level)


@pytest.mark.parametrize(
    ("enclosure", "a", "b", "c"),
    [("open", 2.47e-1, 0.657e-3, -1.186e-7), ("commercial", 1.27e-1, 0.622e-3, -1.69e-7),
     ("precision", 0.675e-1, 0.504e-3, -1.44e-7), ("extra-precision", 0.380e-1, 0.402e-3, -1.27e-7)],
)  # fmt: skip
def test_load_distribution_by_clause_15(enclosure, a, b, c):
    """Table 2, K_Hpf of the three ranges of width, K_Hpm from S_1/S = .175 on, K_Hmc and K_He of .8."""
    for face, d in (
        (20.0, 40.0),
        (25.0, 40.0),
        (26.0, 40.0),
        (100.0, 60.0),
        (432.0, 500.0),
        (440.0, 400.0),
        (300.0, 2e3),
    ):
        slim = max(face / (10.0 * d), 0.05)
        if face <= 25.0:
            proportion = slim - 0.025
        elif face <= 432.0:
            proportion = slim - 0.0375 + 0.000492 * face
        else:
            proportion = slim - 0.1109 + 0.000815 * face - 0.353e-6 * face**2
        alignment = a + b * face + c * face**2
        for crowned, offset, adjusted in ((False, 0.1749, False), (True, 0.175, True)):
            found = factors.load_distribution(
                face * 1e-3, d * 1e-3, factors.Mounting(enclosure, crowned, offset, adjusted)
            )
            assert (found.proportion, found.alignment) == pytest.approx((proportion, alignment), rel=1e-12)
            lead, at, correction = (0.8, 1.1, 0.8) if crowned else (1.0, 1.0, 1.0)
            assert (found.lead, found.offset, found.correction) == (lead, at, correction)
            assert pytest.approx(1.0 + lead * (proportion * at + alignment * correction), rel=1e-12) == found.K_H
    for face, d, at in ((1021.0, 800.0, 0.0), (101.0, 50.0, 0.0), (50.0, 50.0, 0.51)):
        with pytest.raises(RangeError):
            factors.load_distribution(face * 1e-3, d * 1e-3, factors.Mounting(enclosure, offset_ratio=at))
    assert factors.load_distribution(1.02, 0.51, factors.Mounting(enclosure, offset_ratio=-0.5)).offset == 1.1


def test_rim_hardness_and_elastic_factors():
    # 5.2.5: K_B = 1.6 ln(2.242/m_B) below 1.2
    assert [factors.rim_factor(m) for m in (0.5, 0.9, 1.2, 9.0)] == pytest.approx(
        [1.6 * math.log(2.242 / 0.5), 1.6 * math.log(2.242 / 0.9), 1.0, 1.0], rel=1e-12
    )
    # 14.1: A = 8.98e-3 HB_1/HB_2 - 8.29e-3 from 1.2 to 1.7, .00698 beyond; u counts to 20
    for hard, a in ((1.1, 0.0), (1.2, 8.98e-3 * 1.2 - 8.29e-3), (1.5, 8.98e-3 * 1.5 - 8.29e-3), (2.0, 0.00698)):
        found = factors.hardness_ratio_factor(4.0, 200.0 * hard, 200.0)
        assert found == pytest.approx(1.0 + 3.0 * a, rel=1e-12)
    assert factors.hardness_ratio_factor(30.0, 400.0, 200.0) == pytest.approx(1.0 + 19.0 * 0.00698, rel=1e-12)
    # 14.2: 1 + .00075 e^(-.448 R_a) (450 - HB_2), R_a to 1.6 um
    hand = 1.0 + 0.00075 * math.exp(-0.448 * 0.8) * 150.0
    assert factors.work_hardening_factor(0.8e-6, 300.0) == pytest.approx(hand, rel=1e-12)
    assert factors.work_hardening_factor(1.6e-6, 300.0) > factors.work_hardening_factor(1.61e-6, 300.0) == 1.0
    # 12: Z_E = 190 sqrt(N/mm^2) of steel on steel
    assert factors.elastic_coefficient((206e9, 206e9), (0.3, 0.3)) / 1e3 == pytest.approx(190.0, abs=0.5)
    different = math.sqrt(1.0 / (math.pi * (0.91 / 206e9 + (1 - 0.28**2) / 110e9)))
    assert factors.elastic_coefficient((206e9, 110e9), (0.3, 0.28)) == pytest.approx(different, rel=1e-12)


def test_life_factors_by_clause_17():
    # figure 17
    assert factors.pitting_cycle_factor(100.0) == factors.pitting_cycle_factor(1e4) == pytest.approx(
        2.466 * 1e4**-0.056, rel=1e-12
    )  # fmt: skip
    found = [
        factors.pitting_cycle_factor(1e6), factors.pitting_cycle_factor(1e7), factors.pitting_cycle_factor(1e9),
        factors.pitting_cycle_factor(1e9, "lower"), factors.pitting_cycle_factor(1e6, nitrided=True),
        factors.pitting_cycle_factor(1e9, nitrided=True),
    ]  # fmt: skip
    printed = [2.466 * 1e6**-0.056, 2.466 * 1e7**-0.056, 1.4488 * 1e9**-0.023, 2.466 * 1e9**-0.056,
               1.249 * 1e6**-0.0138, 1.4488 * 1e9**-0.023]  # fmt: skip
    assert found == pytest.approx(printed, rel=1e-12)
    # figure 18: 160, 250, 400 HB, case carburized, nitrided; 3e6 cycles on: 1.3558 N^-.0178 or 1.6831 N^-.0323
    laws = [
        (160.0, "through-hardened", 2.3194, 0.0538), (120.0, "given", 2.3194, 0.0538),
        (250.0, "through-hardened", 4.9404, 0.1045), (400.0, "through-hardened", 9.4518, 0.148),
        (450.0, "given", 9.4518, 0.148), (300.0, "carburized", 6.1514, 0.1192),
        (300.0, "induction-hardened", 6.1514, 0.1192), (300.0, "nitrided-4140", 3.517, 0.0817),
        (300.0, "nitrided-chrome", 3.517, 0.0817),
    ]  # fmt: skip
    for brinell, treatment, a, b in laws:
        for cycles, at in ((100.0, 1e3), (1e3, 1e3), (1e5, 1e5)):
            found = factors.bending_cycle_factor(cycles, brinell, treatment)
            assert found == pytest.approx(a * at**-b, rel=1e-12)
        assert factors.bending_cycle_factor(3e6, brinell, treatment) == pytest.approx(1.3558 * 3e6**-0.0178, rel=1e-12)
        lower = factors.bending_cycle_factor(1e9, brinell, treatment, "lower")
        assert lower == pytest.approx(1.6831 * 1e9**-0.0323, rel=1e-12)
    between = factors.bending_cycle_factor(1e4, 205.0, "through-hardened")
    assert between == pytest.approx(math.sqrt(2.3194 * 1e4**-0.0538 * 4.9404 * 1e4**-0.1045), rel=1e-12)
    # table 11
    printed = {0.5: 0.70, 0.9: 0.85, 0.99: 1.0, 0.999: 1.25, 0.9999: 1.5}
    assert {r: factors.reliability_factor(r) for r in printed} == pytest.approx(printed, rel=1e-9)
    middle = 1.0 - math.sqrt(0.01 * 0.001)
    assert factors.reliability_factor(middle) == pytest.approx(1.125, rel=1e-9)


#: sigma_HP and sigma_FP [MPa] by treatment, grade and HB: tables 3 and 4, figures 8 to 11.
ALLOWED = {
    ("through-hardened", 1, 200.0): (2.22 * 200 + 200, 0.533 * 200 + 88.3),
    ("through-hardened", 1, 400.0): (2.22 * 400 + 200, 0.533 * 400 + 88.3),
    ("through-hardened", 2, 200.0): (2.41 * 200 + 237, 0.703 * 200 + 113),
    ("through-hardened", 2, 180.0): (2.41 * 180 + 237, 0.703 * 180 + 113),
    ("carburized", 1, 300.0): (1240, 380), ("carburized", 2, 300.0): (1550, 450), ("carburized", 3, 300.0): (1895, 515),
    ("induction-hardened", 1, 300.0): (1205, 310), ("induction-hardened", 2, 300.0): (1345, 380),
    ("nitrided-4140", 1, 300.0): (1070, 0.568 * 300 + 83.8), ("nitrided-4140", 2, 300.0): (1160, 0.749 * 300 + 110),
    ("nitrided-nitralloy", 1, 300.0): (1170, 0.594 * 300 + 87.76),
    ("nitrided-nitralloy", 2, 300.0): (1260, 0.784 * 300 + 114.81),
    ("nitrided-chrome", 1, 300.0): (1070, 0.7255 * 300 + 63.89),
    ("nitrided-chrome", 2, 300.0): (1185, 0.7255 * 300 + 153.63),
    ("nitrided-chrome", 3, 300.0): (1305, 0.7255 * 300 + 201.91),
}  # fmt: skip


def test_allowable_stresses_by_clause_16():
    for asked, printed in ALLOWED.items():
        found = allowable_stress(*asked)
        assert (found.contact / 1e6, found.bending / 1e6) == pytest.approx(printed, rel=1e-12), asked
        assert (found.treatment, found.brinell) == (asked[0], asked[2])
        assert found.reversed_bending == AllowableStress(found.contact, 0.7 * found.bending, asked[2], asked[0])
    ranges = {"through-hardened": (180, 400), "nitrided-4140": (270, 350), "nitrided-nitralloy": (250, 350),
              "nitrided-chrome": (290, 350)}  # fmt: skip
    for treatment, (soft, hard) in ranges.items():
        for inside in (soft, hard):
            allowable_stress(treatment, 1, float(inside))
        for outside in (soft - 0.1, hard + 0.1):
            with pytest.raises(RangeError, match="HB"):
                allowable_stress(treatment, 1, outside)
    assert {treatment for treatment, *_ in ALLOWED} - {"through-hardened"} == HARD_CASES
    assert {"carburized", "induction-hardened", "nitrided-chrome"} == RECALLED_ROOTS


def test_what_a_service_is_unless_said_otherwise():
    usual = Service(1000.0, 5.0)
    assert (usual.cycles, usual.accuracy, usual.overload, usual.reliability) == ((1e7, 1e7), 8, 1.0, 0.99)
    assert (usual.size, usual.surface, usual.temperature, usual.pinion_roughness) == ((1.0, 1.0), 1.0, 1.0, 0.8e-6)
    assert usual.backup_ratio == (math.inf, math.inf)
    assert (usual.mounting.enclosure, usual.mounting.crowned, usual.mounting.offset_ratio) == ("commercial", False, 0.0)
