"""Numbers that are a slip of the unit: refused, or remarked on, before anything is solved."""

from __future__ import annotations

import copy
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from helical_gears import helical_gear
from pydantic import ValidationError

from fegear.base.errors import InputError
from fegear.case.built.pair_notes import pair_notes
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.shafts import mesh_places
from fegear.case.reading import apply_override, build_scene
from fegear.case.train import ShaftPart
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import deepest_relief, refuse_deep_relief
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import roll_of_radius, tip_relief
from fegear.results.catalogue import STAGES

CASE = {
    "results": ["load-sharing"],
    "gear": {
        "a": {
            "teeth": 28, "module": "3 mm", "face_width": "10 mm",
            "relief": {"tip": {"amount": "20 um", "length": "3 mm"}},
            "spacing_errors": ["1 um", *["0 um"] * 26, "-3 um"],
        }
    },
    "pair": {"I": {"driver": "a", "driven": "a", "load": "1 kN", "compliance": {"source": "cornell"}}},
    "effects": {"relief": True, "spacing_errors": True},
}  # fmt: skip


def scene_with(*overrides: str):
    document = copy.deepcopy(CASE)
    for override in overrides:
        apply_override(document, override)
    return build_scene(document, "case", Path())


def plan(*overrides: str):
    scene = scene_with(*overrides)
    return scene, make_plan(scene, STAGES)


def test_the_case_itself_is_plausible():
    scene, _ = plan()
    assert not any("metal" in remark for remark in pair_notes(scene, pair_spec(scene, "I")))


@pytest.mark.parametrize(
    ("override", "words"),
    [
        (
            "gear.a.module=3 m",
            r"gear\.a\.module = 3 m: is outside the range of gear modules.*a module of 3 mm is 3e-3 m",
        ),
        (
            "gear.a.face_width=10 m",
            r"gear\.a\.face_width = 10 m: is outside the range of face widths for a module of 3 mm, .* to 0\.9 m",
        ),
        ("gear.a.face_width=10 um", r"gear\.a\.face_width"),
        (
            "gear.a.material.young_modulus=206.8 Pa",
            r"gear\.a\.material\.young_modulus = 206\.8 Pa: is outside the range of Young's moduli of solids",
        ),
        ("gear.a.material.young_modulus=206.8 kPa", r"young_modulus"),
        ("gear.a.material.young_modulus=206800 GPa", r"young_modulus"),
        ("gear.a.material.density=7850 g/cm^3", r"gear\.a\.material\.density"),
        (
            "gear.a.relief.tip.amount=100 mm",
            r"gear\.a\.relief = 1e\+05 um.*times the maximum of.*check the unit",
        ),
        ("gear.a.relief.tip.amount=20 m", r"times the maximum of"),
        ("gear.a.relief.tip.amount=-1 mm", r"times the maximum of"),
        ('gear.a.relief={crowning={amount="20 mm"}}', r"times the maximum of"),
        ('gear.a.relief={table={radii=["40 mm", "45 mm"], removals=["0 mm", "5 mm"]}}', r"times the maximum of"),
        ("gear.a.relief.tip={amount='20 um', start_radius='44 m'}", r"gear\.a\.relief\.start"),
        (f"gear.a.spacing_errors={['1 m', *['0 um'] * 27]}", r"gear\.a\.spacing_errors = up to 1e\+06 um"),
        (f"gear.a.spacing_errors={['1 mm', *['0 um'] * 26, '-1 mm']}", r"gear\.a\.spacing_errors"),
        (f"gear.a.spacing_errors={['1 m'] * 28}", r"gear\.a\.spacing_errors"),
        (
            'gear.a.relief={table={radii=["41 m", "44 m"], removals=["0 um", "2 um"]}}',
            "lies outside the active profile,",
        ),
        (
            'gear.a.relief={table={radii=["46 mm", "47 mm"], removals=["0 um", "2 um"]}}',
            "lies outside the active profile,",
        ),
        (
            "gear.a.relief.tip.length=3 m",
            r"gear\.a\.relief = from roll angle .* lies outside the active profile",
        ),
        ('gear.a.relief={tip={amount="9 um", normalised_length=100}}', "lies outside the active profile,"),
        (
            'gear.a.relief={tip={amount="9 um", normalised_length=0.0009}}',
            "of the active profile long: too short to be",
        ),
        ('gear.a.relief={tip={amount="9 um", length="1 um"}}', "of the active profile long: too short to be"),
        (
            "pair.I.lubricant={viscosity_40='220 mm^2/s', temperature='60 degC', density_15='895000 kg/m^3'}",
            r"pair\.I\.lubricant\.density_15 = 895000 kg/m\^3: is outside the density range",
        ),
        (
            "pair.I.lubricant={viscosity_40='220 mm^2/s', temperature='60 degC', density_15='0.895 kg/m^3'}",
            "is outside the density range of lubricating oils,",
        ),
        (
            'gear.a.relief={tip={amount="9 um", start_radius="44 mm", at_radius="45 m"}}',
            "lies outside the active profile,",
        ),
        ('gear.a.relief={root={amount="9 um", start_radius="42 m"}}', "lies outside the active profile,"),
        ('gear.a.relief={crowning={amount="9 um", end_radius="45 m"}}', "lies outside the active profile,"),
        ("gear.a.rim_thickness=10 m", r"gear\.a\.rim_thickness = 10000 mm: must be between"),
        ("pair.I.load=1e6 kN", r"pair\.I\.load = 1e\+09 N on 10 mm face width.*strength of any tooth; check the units"),
        ("pair.I.loads=['1 kN', '100 MN']", r"pair\.I\.load .*strength of any tooth"),
    ],
)
def test_absurd_sizes_are_refused_before_solving(override, words):
    with pytest.raises(InputError, match=words) as refusal:
        plan(override)
    assert "\n" not in str(refusal.value)
    assert len(str(refusal.value)) < 250


def test_a_load_that_no_metal_carries_is_remarked_on():
    scene, _ = plan("pair.I.load=100 kN")
    (remark,) = [remark for remark in pair_notes(scene, pair_spec(scene, "I")) if "metal" in remark]
    assert remark.startswith("Pair I: line load 10000 N/mm: F/(b m) = 3333 MPa")
    soft, _ = plan("pair.I.load=1 kN", "gear.a.material.young_modulus=2.5 GPa")  # a plastic at .013 of its modulus
    assert not any("metal" in remark for remark in pair_notes(soft, pair_spec(soft, "I")))


def test_a_geometry_run_remarks_on_a_contact_ratio_below_one():
    document = {
        "results": ["geometry"],
        "gear": {"a": {"teeth": 20, "module": "3 mm", "tip_diameter": "61.5 mm"}},
        "pair": {"I": {"driver": "a", "driven": "a"}},
    }
    scene = build_scene(document, "case", Path())
    assert scene.pairs["I"].contact_ratio < 1.0
    remarks = run_plan(scene, make_plan(scene, STAGES)).remarks
    assert any(
        r.startswith("Pair I: contact ratio 0.") and "is below 1, motion is not transmitted" in r for r in remarks
    )


@pytest.mark.parametrize(
    ("sizes", "words"),
    [
        ({"module": 3}, r"module = 3 m: .*a module of 3 mm is 3e-3 m in SI"),
        ({"module": 3e-3, "bore_radius": 10e-3, "face_width": 20}, "20 mm are 20e-3 m in SI"),
        ({"module": 3e-3, "bore_radius": 10e-3, "material": Material(206.8e3)}, "206.8 GPa are 206.8e9 Pa in SI"),
        ({"module": 3e-3, "bore_radius": 10e-3, "material": Material(density=7.85)}, "steel has 7850"),
        ({"module": 3e-3, "bore_radius": 10}, "bore_radius"),
    ],
)
def test_millimetres_for_metres_are_refused_in_python(sizes, words):
    with pytest.raises(InputError, match=words):
        Gear(Tooth(20), **{"bore_radius": 10, **sizes})


def test_a_gear_of_pure_numbers_may_have_any_size():
    assert Gear(Tooth(20), 1.0, 5.0, 100.0, Material(1.0)).module == 1.0


def test_millimetres_for_metres_are_refused_of_helical_gears():
    with pytest.raises(InputError, match="module = 3 m"):
        helical_gear(20, 3, math.radians(20), math.radians(15), 20, "left")
    with pytest.raises(InputError, match="face_width = 20 m"):
        helical_gear(20, 3e-3, math.radians(20), math.radians(15), 20, "left")


def test_the_deepest_relief_is_just_taken():
    gear = Gear(Tooth(28, BasicRack()), 3e-3, 20e-3)
    pair = GearPair(gear, gear)
    tip = float(roll_of_radius(gear, gear.involute_tip_radius))
    low = float(pair.roll_angle(pair.x_start, "driver"))
    most = float(deepest_relief(gear, tip))
    assert most == pytest.approx(0.3e-3)
    at_most = tip_relief(gear, most * (1 - 1e-12), length=2e-3)
    refuse_deep_relief(gear, at_most, low, tip)
    with pytest.raises(InputError, match="um at radius 45 mm"):
        refuse_deep_relief(gear, replace(at_most, amount=1.001 * most), low, tip)
    with pytest.raises(InputError, match="module \\(at most half the tooth thickness\\)"):
        refuse_deep_relief(gear, replace(at_most, amount=-1.001 * most), low, tip)
    assert np.isfinite(most)


def on_a_shaft(**section: str):
    """The pair's first gear on a shaft of one section."""
    document = copy.deepcopy(CASE)
    document["shaft"] = {
        "s": {
            "sections": [{"length": "80 mm", "outer": "40 mm", **section}],
            "gears": [{"gear": "a", "at": "40 mm"}],
            "bearings": [{"bearing": "b", "at": "5 mm"}, {"bearing": "b", "at": "75 mm"}],
        }
    }
    document["bearing"] = {"b": {"fixed": True}}
    return build_scene(document, "case", Path())


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ({"length": "35 m"}, "sections = 35 m: exceeds the plausible maximum of 30 m in length"),
        ({"outer": "38 m"}, "sections = 38 m: exceeds the plausible maximum of 20 m in diameter"),
        ({"outer_end": "14e27 m"}, "maximum of 20 m in diameter"),
        ({"outer": "1.5 m"}, "is 16.7 times the diameter of the largest gear on the shaft"),
    ],
)
def test_shafts_in_metres_that_were_meant_in_millimetres_are_refused(section, words):
    on_a_shaft()
    with pytest.raises(InputError, match=words):
        mesh_places(on_a_shaft(**section))


@pytest.mark.parametrize(("key", "value"), [("length", "800 m"), ("diameter", "38 m")])
def test_shafts_of_trains_have_sizes_of_shafts(key, value):
    sizes = {"length": "200 mm", "diameter": "40 mm"}
    ShaftPart(a="a", b="b", **sizes)
    with pytest.raises(ValidationError, match="exceeds the plausible maximum of"):
        ShaftPart(a="a", b="b", **(sizes | {key: value}))
