"""A loaded pair against frictionless contact of both complete gears in CalculiX.

Reference: 66,000 nodes, contact elements of 0.017 mm; 119,000 nodes changed nothing beyond 0.003 %. z = 28/28, module
3.175 mm, rack 1.0/1.25/0.25, bore at half the root radius, E = 206.8 GPa, nu = 0.3, plane strain, 350 N/mm along the
line of action. Tolerances: 0.1 % in transmission error, 0.3 N/mm in loads and 2 % with a corner in contact are what the
patch exchange (1e-3 in c_0) and the local treatment of the corner are good for; found: 0.05 %, 0.2 N/mm, 0.1 %.
"""

import numpy as np
import pytest

from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tooth import Tooth

LOAD = 350.0  # N on 1 mm of face


@pytest.fixture(scope="module")
def compliance():
    tooth, module = Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3
    gear = Gear(tooth, module, tooth.root_radius * module / 2, 1e-3)
    source = finite_element_compliance(solve_gear(gear, reach=3, estimate_error=False))
    return PairCompliance(GearPair(gear, gear), source, source)


def solve(compliance, x, **options):
    engagement = Engagement(compliance, **options)
    return engagement.solve(engagement.grid([x]), [LOAD])


@pytest.mark.parametrize("corner_contact", [False, True])
def test_two_pairs_on_the_path(compliance, corner_contact):
    got = solve(compliance, 3.0e-3, corner_contact=corner_contact)
    assert got.transmission_error[0, 0] == pytest.approx(17.361e-6, rel=1e-3)
    at = {round(float(x), 7): w for x, w in zip(got.pair_x[:, 0], got.loads[:, 0, 0], strict=True)}
    assert at[3.0e-3] == pytest.approx(193.6, abs=0.3)
    assert at[round(3.0e-3 - compliance.pair.base_pitch, 7)] == pytest.approx(156.4, abs=0.3)


def test_one_pair_with_the_tips_kept_from_touching(compliance):
    got = solve(compliance, 1.5e-3)
    assert got.transmission_error[0, 0] == pytest.approx(25.467e-6, rel=1e-3)
    assert got.shared.pairs_in_contact[0, 0] == 1


def test_the_next_tip_corner_takes_a_third_of_the_load(compliance):
    """As it really is: the corner of the approaching driven tip, 0.197 mm before the path, carries 125 N/mm."""
    got = solve(compliance, 1.5e-3, corner_contact=True)
    assert got.transmission_error[0, 0] == pytest.approx(18.56e-6, rel=0.02)
    approaching = np.argmin(got.pair_x[:, 0] + np.where(got.loads[:, 0, 0] > 0, 0, 1))
    assert got.loads[approaching, 0, 0] == pytest.approx(125.0, rel=0.02)
    gap = got.grid.contacts.gap[approaching, 0]
    assert gap == pytest.approx(1.05e-6, rel=0.02)  # 1.05 um, read off the meshed gears


def test_largest_root_tension_of_both_gears_and_both_pairs(compliance):
    """0.5 %: what fillet edges of 0.05 module are good for."""
    engagement = Engagement(compliance)
    loaded = engagement.solve(engagement.grid([3.0e-3]), [LOAD])
    at_x = int(np.argmin(np.abs(loaded.pair_x[:, 0] - 3.0e-3)))
    behind = int(np.argmin(np.abs(loaded.pair_x[:, 0] - 3.0e-3 + compliance.pair.base_pitch)))
    for member, pair_at_x, pair_behind in (("driver", 194.0e6, 102.2e6), ("driven", 136.5e6, 190.3e6)):
        stress = root_stress_history(engagement, loaded, member).stress[:, 0, 0]
        assert stress[at_x] == pytest.approx(pair_at_x, rel=5e-3)
        assert stress[behind] == pytest.approx(pair_behind, rel=5e-3)
