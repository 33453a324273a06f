"""Loss factors that others print of the FZG test gears, to the printed digits.

C. Fernandes (FEUP), reports C14, C40 and H501 of the open program GEARpie: Ohlendorf's H_V and Wimmer's integral, the
latter summed over a finite number of places there. Dimensions as printed in the reports.
"""

import math

import pytest

from fegear.formulas.flash_temperature import flank_speeds, reduced_modulus
from fegear.formulas.friction import ohlendorf, wimmer
from fegear.formulas.iso6336.part22_micropitting import pressure
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth


def printed(teeth, module, shifts, tips, helix=0.0, face=14e-3):
    rack, gears = BasicRack.named("A", math.radians(20.0)), []
    for z, x, tip, hand in zip(teeth, shifts, tips, ("right", "left"), strict=True):
        transverse = module / math.cos(helix)
        tooth = Tooth(z, rack, profile_shift=x, thickness_allowance=0.01, tip_radius=tip / module, helix_angle=helix)
        gears.append(Gear(tooth, module, 0.4 * transverse * z, face, hand=hand if helix else "spur"))
    return GearPair(*gears, 91.5e-3)


SPUR = ((16, 24), 4.5e-3, (0.1817, 0.1715))
CASES = {
    "C14": (printed(*SPUR, (41.228e-3, 59.182e-3)), 1.44, 0.1950, 0.1945),
    "C40": (printed(*SPUR, (41.318e-3, 59.272e-3)), 1.46, 0.1986, 0.1984),
    # overlap ratio 0.54 as printed: its face width is not
    "H501": (
        printed((20, 30), 3.5e-3, (0.1809, 0.0891), (40.336e-3, 58.132e-3), math.radians(15.0), 23e-3),
        1.46, 0.1639, 0.1869,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_loss_factors_as_printed(name):
    pair, contact_ratio, closed, summed = CASES[name]
    assert round(pair.contact_ratio, 2) == contact_ratio
    assert round(ohlendorf(pair), 4) == pytest.approx(closed, abs=1.01e-4)
    assert wimmer(pair) == pytest.approx(summed, rel=5e-3)


def test_pressure_at_the_pitch_point_as_printed():
    """C14 at 200 N m: 1347.3 MPa, and 5912.1 N in the plane of action."""
    pair = CASES["C14"][0]
    load = 200.0 / pair.driver.base_radius
    assert round(load, 1) == pytest.approx(5912.1, abs=0.11)
    modulus = reduced_modulus((206e9, 206e9), (0.3, 0.3))
    found = pressure(flank_speeds(pair, 0.0, 157.1), load / 14e-3, modulus)
    assert float(found) * 1e-6 == pytest.approx(1347.3, abs=0.5)
