"""A pair of asymmetric teeth beside frictionless contact of both whole gears in CalculiX (`make_asymmetric_calculix`).

Turned by fegear's approach for 200 N/mm, CalculiX' own meshes, contact and solver carry 200.18 (two pairs) and 200.11
N/mm (one pair), shared within 0.09 % of the load; contacts that move along their flanks, which load sharing neglects,
take half of the first difference. Root stresses are within 0.35 %.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))
import make_asymmetric_calculix as calculix

from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.verify.calculix import under_approach
from tests.helpers.moved_contacts import moved_contacts

FOUND = json.loads(calculix.FILE.read_text())


@pytest.mark.parametrize("case", [pytest.param(case, marks=pytest.mark.long) for case in FOUND])
def test_loads_and_root_stress_under_the_same_approach(case):
    flank, position = case.split(", ")
    e, known = calculix.engagement(flank), FOUND[case]
    pair = e.pair
    x = pair.x_start + calculix.POSITIONS[flank, position] * pair.base_pitch
    state = under_approach(e, x, calculix.LINE_LOAD * 1e3 * pair.face_width, known["approach_um"] * 1e-6)
    loads = {
        str(j): w / pair.face_width * 1e-3
        for j, w in zip(state.grid.contacts.number, state.loads[:, 0, 0], strict=True)
        if w > 0.0
    }
    total = sum(known["loads"].values())
    assert sum(loads.values()) == pytest.approx(total, rel=1e-3)
    assert loads == pytest.approx(known["loads"], abs=1e-3 * total)
    on = state.loads[:, 0, 0] > 0.0
    tangent = state.grid.matrices.tangent(state.loads)[np.ix_(on, on)][:, :, 0, 0]
    more = np.linalg.solve(tangent, moved_contacts(e, state)[on]) / pair.face_width * 1e-3
    moved = {j: load + one for (j, load), one in zip(loads.items(), more, strict=True)}
    assert moved == pytest.approx(known["loads"], abs=8e-4 * total)
    for member in ("driver", "driven"):
        found = root_stress_history(e, state, member).stress[:, 0, 0] * 1e-6
        for row, j in enumerate(state.grid.contacts.number):
            if str(j) in loads:
                assert found[row] == pytest.approx(known["root_tension"][f"{member} {j}"], rel=8e-3)
