"""The drawing against rules of thumb: broken rules are found, named with their remedy, and nothing else is."""

from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.geometry.checks import tip_thickness
from fegear.geometry.gear import Gear
from fegear.geometry.tooth import Tooth
from fegear.results.catalogue import STAGES

STUB = {"addendum": 0.6, "dedendum": 1.25, "tip_radius": 0.25}
LONG = {"addendum": 1.2, "dedendum": 1.25, "tip_radius": 0.25}
SOUND = {"teeth": 28, "module": "3 mm", "bore_radius": "15 mm", "face_width": "10 mm"}


def checked(gear=SOUND, mate=SOUND, **pair):
    document = {
        "results": ["tooth-geometry-check"],
        "gear": {"a": gear, "b": mate},
        "pair": {"I": {"driver": "a", "driven": "b", **pair}},
    }
    scene = build_scene(document, "case", Path())
    results = run_plan(scene, make_plan(scene, STAGES))
    (table,) = results.tables
    broken = {
        (str(of), str(rule))
        for of, rule, verdict in zip(table["of"], table["rule"], table["verdict"], strict=True)
        if verdict == "broken"
    }
    return broken, table, results


def test_a_sound_drawing_breaks_no_rule():
    broken, table, results = checked()
    assert broken == set()
    assert results.remarks == ()
    assert {value.name: value.value for value in results.values}["rules_broken"] == 0.0
    assert len(table["of"]) == 3 * 2 + 2 + 2 * 2


@pytest.mark.parametrize(
    ("changes", "mate", "pair", "rule"),
    [
        ({"profile_shift": 0.9, "teeth": 14, "bore_radius": "8 mm"}, {}, {}, ("a", "tooth thickness at the tip")),
        ({"bore_radius": "36 mm"}, {}, {}, ("a", "rim below the teeth")),
        ({"teeth": 10, "bore_radius": "4 mm"}, {"teeth": 40}, {}, ("a", "undercut")),
        ({"rack": STUB}, {"rack": STUB}, {}, ("I", "transverse contact ratio")),
        ({"rack": LONG}, {}, {}, ("I", "tip clearance of the driver")),
    ],
)  # fmt: skip
def test_each_rule_is_found_broken_with_its_remedy(changes, mate, pair, rule):
    broken, _, results = checked({**SOUND, **changes}, {**SOUND, **mate}, **pair)
    assert rule in broken
    assert any(remark.startswith(f"{rule[0]}: {rule[1]} is ") for remark in results.remarks)
    assert len(results.remarks) == len(broken)


def test_the_tip_thickness_is_that_of_the_involute():
    """s_a = 2 r_a (pi/(2z) + inv alpha - inv alpha_a) of a gear without profile shift, from the involute function."""
    gear = Gear(Tooth(28), 3e-3, 15e-3)
    involute = lambda angle: np.tan(angle) - angle  # noqa: E731
    tip = np.arccos(gear.base_radius / gear.tip_radius)
    expected = 2.0 * gear.tip_radius * (np.pi / 56 + involute(np.radians(20.0)) - involute(tip))
    assert tip_thickness(gear) == pytest.approx(expected, rel=1e-12)
