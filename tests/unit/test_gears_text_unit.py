"""What a drafted gear says of its body: half the root radius, or a rim of 1.2 tooth depths where that is thicker."""

from __future__ import annotations

import math
import re
from itertools import product

import pytest

from fegear.case.drafts.answers import Answers
from fegear.case.drafts.gears_text import gear_text

#: Dedendum of the racks of ISO 53 [modules].
DEDENDUM = {"A": 1.25, "B": 1.25, "C": 1.25, "D": 1.4}


@pytest.mark.parametrize("rack", DEDENDUM)
@pytest.mark.parametrize("kind", ["pair", "gear"])
@pytest.mark.parametrize(("teeth", "shift"), list(product([8, 12, 14, 17, 25, 60], [-0.3, 0.0, 0.4])))
def test_a_small_gear_has_a_hole_that_leaves_a_rim(kind, rack, teeth, shift):
    given = {"teeth": f"{teeth} 40" if kind == "pair" else f"{teeth}", "module": "2 mm", "rack": rack,
             "profile_shift": f"{shift} 0" if kind == "pair" else f"{shift}"}  # fmt: skip
    text = gear_text(Answers(kind, given), 0)
    found = re.search(r'bore_radius = "([\d.]+) mm" +# gear body fixed there: (.*); replace by that', text)
    root = 0.5 * teeth - DEDENDUM[rack] + shift
    with_rim = root - 1.21 * (1.0 + DEDENDUM[rack])
    thin = 0.0 < with_rim < 0.5 * root
    assert float(found[1]) == pytest.approx(2.0 * (with_rim if thin else 0.5 * root), rel=2e-3)
    assert found[2] == ("a rim of 1.2 tooth depths" if thin else "half the root radius")
    # the default of a tip circle, and what the gear itself was asked
    assert re.search(r'# tip_diameter = "([\d.]+) mm"', text)[1] == f"{2.0 * (teeth + 2.0 * (1.0 + shift)):.6g}"
    assert re.search(r"^teeth = (\d+)$", text, re.MULTILINE)[1] == f"{teeth}"
    assert f'rack = "ISO 53 {rack}"' in text


@pytest.mark.parametrize(("kind", "helix"), [("helical", 30.0)])
@pytest.mark.parametrize("teeth", [14, 40])
def test_of_a_helical_gear_root_and_rim_are_those_of_its_transverse_section(kind, helix, teeth):
    given = {"teeth": f"{teeth} 40", "module": "2 mm", "profile_shift": "0.1 0", "helix_angle": f"{helix} deg",
             "rack": "A"}  # fmt: skip
    text = gear_text(Answers(kind, given), 0)
    root = 0.5 * teeth / math.cos(math.radians(helix)) - 1.25 + 0.1
    with_rim = root - 1.21 * 2.25
    assert float(re.search(r'bore_radius = "([\d.]+) mm"', text)[1]) == pytest.approx(
        2.0 * (min(0.5 * root, with_rim)), rel=2e-3
    )
    assert 'hand = "right"' in text
    assert 'hand = "left"' in gear_text(Answers(kind, given), 1)
