"""The drawing against rules of thumb: broken rules are found, named with their remedy, and nothing else is."""

from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.geometry.checks import tip_thickness
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
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


HANDBOOK = {
    "teeth": 12, "normal_module": "3 mm", "helix_angle": "30 deg", "hand": "left", "profile_shift": 0.09809,
    "face_width": "20 mm", "bore_radius": "6 mm",
}  # fmt: skip
MATE = {"teeth": 60, "normal_module": "3 mm", "helix_angle": "30 deg", "hand": "right", "face_width": "20 mm",
        "bore_radius": "40 mm"}  # fmt: skip


def test_a_profile_shift_printed_with_five_digits_breaks_no_rule_of_backlash():
    """-0.8 nm of backlash at a = 125 mm; a shift that is really too large is still found."""
    broken, table, _ = checked(HANDBOOK, MATE, centre_distance="125 mm")
    of_backlash = table["rule"] == "backlash along the line of action"
    assert -1e-6 < table["value"][of_backlash][0] < 0.0
    assert ("I", "backlash along the line of action") not in broken
    for shift, jams in ((0.0981, False), (0.09815, False), (0.0985, True)):
        broken, *_ = checked(HANDBOOK | {"profile_shift": shift}, MATE, centre_distance="125 mm")
        assert (("I", "backlash along the line of action") in broken) == jams


@pytest.mark.parametrize("gear", [
    {"teeth": 12, "module": "5 mm", "face_width": "10 mm"},
    {"internal": True, "teeth": 60, "module": "5 mm", "face_width": "10 mm", "cutter": {"teeth": 20},
     "tip_diameter": "292 mm"},
])  # fmt: skip
def test_no_rule_judges_what_fegear_assumed(gear):
    scene = build_scene({"results": ["tooth-geometry-check"], "gear": {"a": gear}}, "case", Path())
    found = run_plan(scene, make_plan(scene, STAGES))
    (table,) = found.tables
    assert "rim below the teeth" not in table["rule"]
    key = "outer_radius" if "internal" in gear else "bore_radius"
    assert any(key in remark and "not checked" in remark for remark in found.remarks)


def test_undercut_is_an_amount_with_the_profile_shift_that_avoids_it():
    """x_min = h_fP - rho_fP (1 - sin(alpha)) - z sin^2(alpha) / 2 (ISO 21771)."""
    sine = np.sin(np.radians(20.0))
    _, table, results = checked({**SOUND, "teeth": 10, "bore_radius": "4 mm"}, {**SOUND, "teeth": 40})
    gear = Gear(Tooth(10), 3e-3, 4e-3)
    lost = (gear.form_radius - gear.base_radius) * 1e3
    amount = table["value"][(table["of"] == "a") & (table["rule"] == "undercut")][0]
    assert amount == pytest.approx(-lost, rel=1e-3)
    (remark,) = (one for one in results.remarks if one.startswith("a: undercut is "))
    assert f"{-amount:.4g} mm of the involute" in remark
    assert f"at least {1.0 + 0.25 * sine - 5.0 * sine**2 + 5e-5:.4f}" in remark


@pytest.mark.parametrize("helix", [0.0, 0.4])
@pytest.mark.parametrize("teeth", [10, 12, 17, 24])
def test_from_the_minimum_profile_shift_on_nothing_is_undercut(teeth, helix):
    for allowance in (0.0, 0.05):
        least = Tooth(teeth, profile_shift=0.45, thickness_allowance=allowance, helix_angle=helix).least_profile_shift
        for off in (-1e-6, 1e-6):
            tooth = Tooth(teeth, profile_shift=least + off, thickness_allowance=allowance, helix_angle=helix)
            assert tooth.undercut == (off < 0.0)
