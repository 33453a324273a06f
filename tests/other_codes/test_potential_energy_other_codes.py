"""The potential-energy pair against the numbers that the rotordynamics code ROSS asserts for its GearElementTVMS.

ROSS (github.com/petrobras/ross) tests a pair of 62/62 teeth, m = 2 mm, 20 deg, 20 mm wide, bore 35 mm, E = 206 GPa:
contact ratio 1.7897798668330458, linear contact 3555868607.9 N/m, mesh stiffness at the start of
double contact 396622921 N/m.
"""

import numpy as np
import pytest

from fegear.formulas.sources import pair_compliance, source
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth

WIDTH = 20e-3


def test_pair_of_62_teeth():
    tooth = Tooth(62, BasicRack(1.0, 1.25, 0.38))  # ROSS: cutter tip radius 0.76 mm
    gear = Gear(tooth, 2e-3, 17.5e-3, WIDTH, Material(206e9, 0.3, 7810.0), "stress")
    pair = GearPair(gear, gear)
    assert pair.contact_ratio == pytest.approx(1.7897798668330458, rel=1e-12)
    found = pair_compliance(source("potential-energy"), pair, pair.x_start + np.array([0.0, pair.base_pitch]), 1e5)
    assert WIDTH / found.contact == pytest.approx(3555868607.9093266, rel=1e-9)
    # Two pairs side by side: fegear gives 4.1 % more. The two codes draw the tooth's root on their own; where the rest
    # comes from has not been traced, so this bounds the disagreement between codes and proves neither.
    assert (WIDTH / found.total).sum() == pytest.approx(396622921.3581085, rel=0.05)
