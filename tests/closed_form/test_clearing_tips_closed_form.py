"""Tip diameters with which internal pairs run: named where tips meet, and confirmed by polygons that are rolled."""

import importlib.util
import re
from dataclasses import replace
from pathlib import Path

import pytest

import fegear
from fegear.base.errors import InputError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_interference import clearing_tips, internal_checks
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter


def polygons():
    """The polygons of the other test: outlines and motion alone."""
    path = Path(__file__).with_name("test_internal_interference_closed_form.py")
    spec = importlib.util.spec_from_file_location("internal_interference_by_polygons", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def case(pinion=20, ring=60, **more):
    return {
        "results": ["geometry"],
        "gear": {
            "p": {"teeth": pinion, "module": "3 mm"},
            "r": {"teeth": ring, "module": "3 mm", "internal": True, "cutter": {"teeth": 25}},
        },
        "pair": {"I": {"driver": "p", "driven": "r", "load": "1 kN"}},
    } | more


def diameter(text):
    found = re.search(r"set tip_diameter of the (pinion|ring gear) to ([0-9.]+) mm", text)
    assert found, text
    return {"pinion": "p", "ring gear": "r"}[found[1]], float(found[2])


def test_a_pair_without_profile_shift_is_drawn_and_says_the_tip_diameter_that_clears():
    found = fegear.run(case(), progress=False)
    said = " ".join(found.remarks)
    assert "interference with the fillet, by 0.01024 mm" in said
    assert "planet" not in said
    gear, tip = diameter(said)
    repaired = case()
    repaired["gear"][gear]["tip_diameter"] = f"{tip} mm"
    assert not any("tip_diameter" in one for one in fegear.run(repaired, progress=False).remarks)


def test_results_under_load_are_refused_with_that_diameter():
    with pytest.raises(InputError) as error:
        fegear.run(case(results=["transmission-error"]), progress=False)
    assert error.value.key == "pair.I"
    assert diameter(str(error.value)) == diameter(" ".join(fegear.run(case(), progress=False).remarks))


@pytest.mark.parametrize("pinion", [17, 20, 25, 30])
@pytest.mark.parametrize("ring", [60, 80, 100])
def test_usual_pairs_without_profile_shift_are_drawn(pinion, ring):
    fegear.run(case(pinion, ring), progress=False)


@pytest.mark.dear
@pytest.mark.parametrize(("z1", "z3"), [(20, 60), (22, 61), (17, 60), (30, 80), (17, 23)])
def test_polygons_at_that_tip_are_clear_and_beyond_it_meet(z1, z3):
    by_polygons = polygons()
    planet = Tooth(z1, thickness_allowance=0.02, **({"profile_shift": 0.2} if z3 == 23 else {}))
    cutter = PinionCutter(min(25, z3 - 5))
    ring = InternalTooth(z3, cutter, **({"profile_shift": -0.2, "tip_radius": 10.9} if z3 == 23 else {}))
    distance = 0.5 * (z3 - z1)
    before = [one for one in internal_checks(planet, ring, distance) if one.refused and one.margin < 0.0]
    assert before
    tips = clearing_tips(planet, ring, distance)
    if tips is None:
        pytest.fail("no tip clears")
    clear = [
        gear if tip is None else replace(gear, tip_radius=tip) for gear, tip in zip((planet, ring), tips, strict=True)
    ]
    assert min(one.margin for one in internal_checks(*clear, distance) if one.refused) >= 0.0
    assert by_polygons.rolled(*clear, distance) < by_polygons.MEETS
    longer = [replace(one, tip_radius=0.5 * (one.tip_radius + own.tip_radius))
              for one, own in zip(clear, (planet, ring), strict=True)]  # fmt: skip
    assert by_polygons.rolled(*longer, distance) > by_polygons.MEETS


def test_where_no_cut_of_one_gear_does_the_planet_is_cut_by_quarters_and_the_ring_by_the_rest():
    planet = Tooth(39, profile_shift=0.23)
    teeth = InternalTooth(42, PinionCutter(28, tip_radius=0.2), profile_shift=-0.05)

    def clears(one, other):
        return min(check.margin for check in internal_checks(one, other, 1.489) if check.refused) >= 0.0

    tips = clearing_tips(planet, teeth, 1.489)
    cut = replace(planet, tip_radius=tips.planet)
    assert clears(cut, replace(teeth, tip_radius=tips.ring))
    assert not clears(cut, replace(teeth, tip_radius=tips.ring - 1e-3))
    share = (planet.tip_radius - tips.planet) / (planet.tip_radius - planet.form_radius)
    assert share == pytest.approx(0.25)
    ring = [teeth.tip_radius + part * (teeth.form_radius - teeth.tip_radius) for part in (0.1, 0.5, 0.79)]
    assert not any(clears(planet, replace(teeth, tip_radius=tip)) for tip in ring)


def ring(**cutter):
    return {"results": ["geometry"],
            "gear": {"r": {"teeth": 50, "module": "2 mm", "internal": True, "cutter": cutter}}}  # fmt: skip


def test_a_ring_of_an_unknown_tool_is_made_by_its_root_circle_and_fillet_radius():
    found = fegear.run(ring(root_diameter="105 mm", tip_radius=0.2), progress=False)
    tooth = found.scene.gears["r"].tooth
    assert 2.0 * tooth.root_radius * 2.0 == pytest.approx(105.0)
    assert any(f"cutter.teeth not specified, {tooth.cutter.teeth} assumed" in one for one in found.remarks)
    by_polygons = polygons()
    sharp = by_polygons.cutter_side(tooth)
    assert by_polygons.pulled(sharp, tooth, tooth.generating_distance) < by_polygons.MEETS


def test_a_cutter_of_too_few_teeth_is_refused_with_the_largest_that_clears():
    with pytest.raises(InputError) as error:
        fegear.run(ring(teeth=20), progress=False)
    teeth = int(re.search(r"set cutter.teeth = (\d+), the largest cutter without interference", str(error.value))[1])
    assert teeth > 20
    fegear.run(ring(teeth=teeth), progress=False)
