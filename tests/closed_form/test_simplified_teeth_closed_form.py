"""The potential-energy method on the tooth of the diagnosis literature, beside the papers' integrals over the angle."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from fegear.base.errors import RangeError
from fegear.formulas import potential_energy, potential_energy_simplified
from fegear.formulas.sources import pair_compliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair

E, NU, MODULE, ALPHA = 206.8e9, 0.3, 3.175e-3, math.radians(20.0)


def gear(teeth, bore):
    return Gear(Tooth(teeth), MODULE, bore, 16e-3, Material(E, NU), "stress")


def printed(teeth, radius):
    """Bending, shear and axial compliance per width by the integrals over the angle that Tian and Liang print."""
    base, root = 0.5 * MODULE * teeth * math.cos(ALPHA), 0.5 * MODULE * (teeth - 2.5)
    a2 = math.pi / (2 * teeth) + math.tan(ALPHA) - ALPHA
    a1 = math.sqrt((radius / base) ** 2 - 1.0) - a2
    thick = lambda a: math.sin(a) + (a2 - a) * math.cos(a)  # noqa: E731
    arm = lambda a: 1.0 + math.cos(a1) * ((a2 - a) * math.sin(a) - math.cos(a))  # noqa: E731
    low = a2
    if root > base:
        low = -(math.sqrt((root / base) ** 2 - 1.0) - a2)
    over = lambda f: quad(f, -a1, low, epsabs=0.0, epsrel=1e-11)[0]  # noqa: E731
    bending = over(lambda a: 3 * arm(a) ** 2 * (a2 - a) * math.cos(a) / (2 * E * thick(a) ** 3))
    shear = over(lambda a: 1.2 * (1 + NU) * (a2 - a) * math.cos(a) * math.cos(a1) ** 2 / (E * thick(a)))
    axial = over(lambda a: (a2 - a) * math.cos(a) * math.sin(a1) ** 2 / (2 * E * thick(a)))
    if root < base:  # a prism down to the root circle
        half, d = base * math.sin(a2), base * math.cos(a2) - root * math.cos(math.asin(base / root * math.sin(a2)))
        at_base = base * arm(a2)  # moment per load
        moment = quad(lambda s: (at_base + s * math.cos(a1)) ** 2, 0.0, d)[0]
        bending += moment * 12.0 / (E * (2.0 * half) ** 3)
        shear += 2.4 * (1 + NU) * math.cos(a1) ** 2 * d / (E * 2.0 * half)
        axial += math.sin(a1) ** 2 * d / (E * 2.0 * half)
    return bending, shear, axial


@pytest.mark.parametrize("teeth", [19, 30, 48, 80])
def test_the_beam_is_that_of_the_printed_integrals(teeth):
    one = gear(teeth, 0.25 * MODULE * teeth)
    for place in (0.98, 1.0, 1.02):
        radius = one.pitch_radius * place
        found = potential_energy_simplified.tooth_compliance(one, [radius])
        parts = [float(getattr(found, name)[0]) for name in ("bending", "shear", "axial")]
        assert parts == pytest.approx(printed(teeth, radius), rel=1e-8)


def on_the_page(teeth, bore, radius, from_circle=False):
    """Sainsot's body by the equations of the page on closed forms, numbers of his Table 1 as printed."""
    base, root = 0.5 * MODULE * teeth * math.cos(ALPHA), 0.5 * MODULE * (teeth - 2.5)
    half = math.pi / (2 * teeth) + math.tan(ALPHA) - ALPHA
    alpha = math.sqrt((radius / base) ** 2 - 1.0) - half
    theta, h = math.asin(base * math.sin(half) / root), root / bore
    powers = (1.0 / theta**2, h * h, h / theta, 1.0 / theta, h, 1.0)
    big_l, m, p, q = (
        sum(map(float.__mul__, row, powers))
        for row in (
            (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
            (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
            (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
            (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
        )
    )
    arm = (base / math.cos(alpha) - root * (1.0 if from_circle else math.cos(theta))) / (2.0 * root * theta)
    return math.cos(alpha) ** 2 / E * (big_l * arm**2 + m * arm + p * (1.0 + q * math.tan(alpha) ** 2))


@pytest.mark.parametrize(("teeth", "bore"), [(27, 14e-3), (33, 16e-3)])
def test_the_body_is_that_of_the_page(teeth, bore):
    """Its arm counts from the chord of the root circle; from the circle a body of 27 teeth is 2.5 % stiffer."""
    one = gear(teeth, bore)
    radii = [place * one.pitch_radius for place in (0.98, 1.0, 1.04)]
    found = potential_energy_simplified.tooth_compliance(one, radii)
    assert found.foundation == pytest.approx([on_the_page(teeth, bore, r) for r in radii], rel=1e-12)
    if teeth == 27:
        less = on_the_page(teeth, bore, radii[1], from_circle=True) / found.foundation[1]
        assert less == pytest.approx(1.0 - 0.025, abs=1e-3)


def test_the_pair_of_the_literature_has_a_stiffness():
    """19/48 teeth, of which the generated pinion is out of Sainsot's range; 10.86 with psi_b for theta_f."""
    pinion, wheel = gear(19, 10e-3), gear(48, 25e-3)
    pair = GearPair(pinion, wheel)
    with pytest.raises(RangeError, match="Sainsot"):
        potential_energy.tooth_compliance(pinion, [pinion.pitch_radius])
    found = pair_compliance(potential_energy_simplified.SOURCE, pair, [0.0], 170e3)
    assert found.stiffness[0] * 1e-9 == pytest.approx(10.86, rel=2e-2)
    with pytest.raises(RangeError, match="half tooth angle"):
        potential_energy_simplified.tooth_compliance(gear(12, 10e-3), [6.1 * MODULE])


def test_a_crack_takes_stiffness_by_its_depth():
    one = gear(19, 10e-3)
    radius, tooth = [one.pitch_radius], one.tooth
    foot, half = tooth.root_radius, tooth.base_radius * math.sin(tooth.base_half_angle)
    whole = potential_energy_simplified.tooth_compliance(one, radius)
    none = potential_energy_simplified.tooth_compliance(one, radius, (half * 1.5, foot))
    assert none.total == pytest.approx(whole.total, rel=1e-12)
    softer = [potential_energy_simplified.tooth_compliance(one, radius, (x, 0.0)).total[0] for x in (0.6, 0.3, 0.0)]
    assert np.all(np.diff([whole.total[0], *softer]) > 0.0)
    halved = potential_energy_simplified.tooth_compliance(one, radius, (0.0, 0.0))
    assert halved.bending == pytest.approx(8.0 * whole.bending, rel=1e-9)
