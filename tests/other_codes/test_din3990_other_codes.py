"""ISO 6336's factors that DIN 3990-11 shares, against another program's digits.

Numbers: the output kept in tests/test_1.py of github.com/hanslhansl/din3990 (z 19/104, m_n 4 mm, x .5/.15, spur).
"""

import math

import pytest

from fegear.formulas.iso6336 import part1_face_load as misalignment
from fegear.formulas.iso6336 import part1_transverse as running_in
from fegear.formulas.iso6336 import part2_pitting as contact
from fegear.formulas.iso6336 import part3_strength as root
from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry
from fegear.formulas.iso6336.part1_face_load import PinionShaft, face_load_factor, root_exponent
from fegear.formulas.iso6336.rated import Strength

MM = 1e-3
PAIR = PairGeometry(
    (GearShape(19, 0.5, 88 * MM, 70 * MM, 48.64 * MM), GearShape(104, 0.15, 425.2 * MM, 407.2 * MM, 48.64 * MM)),
    4 * MM, math.radians(20.0), 0.0, 248.506843355171 * MM,
)  # fmt: skip
STEEL = Strength("Eh", 1500e6, 430e6)


def test_geometry():
    assert math.degrees(PAIR.working_pressure_angle) == pytest.approx(21.531902292465457, rel=1e-12)
    assert PAIR.contact_ratio == pytest.approx(1.5363235945832296, rel=1e-12)
    assert PAIR.base_diameters == pytest.approx((71.41663917972905 * MM, 390.9121302469379 * MM), rel=1e-12)


def test_contact_stress():
    m, z = contact.single_pair_factors(PAIR)
    assert m == pytest.approx((1.00554704549864, 0.8835590102280203), rel=1e-12)
    assert z == (m[0], 1.0)
    factors = (contact.zone_factor(PAIR), contact.contact_ratio_factor(PAIR.contact_ratio, 0.0))
    assert factors == pytest.approx((2.3959406670899934, 0.906214912960638), rel=1e-12)
    stress = contact.nominal_contact_stress(PAIR, 14103.41869503906, (*factors, 189.8e3))
    assert stress == pytest.approx(875.3827378988153e6, rel=1e-12)


def test_face_load_factors():
    load = 25368.536123904036 / (48.64 * MM)
    shaft = PinionShaft("a", 0.2, 0.0, 0.06)
    f_sh, _ = misalignment.shaft_deformation(shaft, load, 48.64 * MM, 76 * MM)
    assert f_sh * 1e6 == pytest.approx(4.913484891366676, rel=1e-12)
    initial = 1.33 * f_sh
    assert initial * 1e6 == pytest.approx(6.534934905517679, rel=1e-12)
    # that program's K_v, and so F_betax, differ between the gears; y_beta is their mean
    worn = [running_in.helix_allowance(STEEL, f, 3.9) for f in (initial, 6.586991635726722e-6)]
    assert running_in.mean((worn[0], worn[1])) * 1e6 == pytest.approx(0.9841444905933301, rel=1e-9)
    k = face_load_factor(5.550790414924349e-6, 20e9, load)
    assert k == pytest.approx(1.1064272863295082, rel=1e-12)
    exponent = root_exponent((48.64, 48.64), (9.0, 9.0))
    assert k**exponent == pytest.approx(1.0864854433487987, rel=1e-12)


def test_static_notch_sensitivity():
    # Y_S for the load at the tip there; of case-hardened steel
    for y_s, printed in ((2.3254914040266397, 1.1432162177717213), (2.439724457289684, 1.1934787612074609)):
        assert root.static_notch_sensitivity(STEEL, y_s) == pytest.approx(printed, rel=1e-12)
