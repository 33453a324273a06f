"""Cases written to REXS come back as the same cases; what the standard has no attribute for is said."""

from __future__ import annotations

import json
import re
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from rexs_cases import imported, same, there_and_back, with_all_of_a_flank
from rexs_models import in_json, planetary_set, two_stages

import fegear.cli
from fegear.base.errors import InputError
from fegear.case.built.shafts import gearbox_of
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import TWO_STAGES
from fegear.case.drafts.text import draft
from fegear.case.reading import build_scene, read_scene
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.exchange.rexs.written_gearbox import model_text

CASES = Path(__file__).parents[2] / "cases"
HERE = Path("model.rexs")


@pytest.mark.parametrize("made", [lambda: imported(two_stages()), with_all_of_a_flank], ids=["plain", "everything"])
def test_a_gearbox_comes_back_as_it_was(made):
    scene = made()
    again, remarks = there_and_back(scene)
    assert remarks == ()
    assert again.gears.keys() == scene.gears.keys()
    for name, gear in scene.gears.items():
        assert same(again.gears[name], gear), name
        one, other = (found.case.gear[name] for found in (again, scene))
        for key in ("strength", "roughness", "tolerance_class", "relief", "lead"):
            assert same(getattr(one, key), getattr(other, key)), (name, key)
    for name, pair in scene.pairs.items():
        assert same(again.pairs[name].centre_distance, pair.centre_distance)
        one, other = (found.case.pair[name] for found in (again, scene))
        for key in ("torque", "speed", "axial_offset", "lubricant", "operation", "driver", "driven"):
            assert same(getattr(one, key), getattr(other, key)), (name, key)
    first, second = gearbox_of(again), gearbox_of(scene)
    assert first.names == second.names
    for one, other in zip(first.shafts, second.shafts, strict=True):
        assert same(one.shaft, other.shaft)
        assert same(one.loads, other.loads)
        assert [same(a.at, b.at) and same(a.bearing, b.bearing) for a, b in zip(one.seats, other.seats, strict=True)]
    assert same(first.couplings, second.couplings)
    assert model_text(there_and_back(again)[0], "")[0] == model_text(again, "")[0]


def test_a_planetary_set_comes_back_as_it_was():
    scene = imported(planetary_set())
    again, remarks = there_and_back(scene)
    assert remarks == ()
    assert same(again.case.planetary["P"], scene.case.planetary["P"])
    assert all(same(again.gears[name], gear) for name, gear in scene.gears.items())


@pytest.mark.parametrize("name", ["two_stage_shafts", "rating_helical", "helical_stage_train", "pinion_and_wheel"])
def test_cases_that_come_with_fegear_keep_their_pairs(name):
    scene = read_scene(CASES / f"{name}.toml", ())
    again, _ = there_and_back(scene)
    for one, other in zip(scene.pairs.values(), again.pairs.values(), strict=True):
        for role in ("driver", "driven"):
            first, second = getattr(one, role), getattr(other, role)
            for key in ("module", "root_radius", "tip_radius", "base_radius", "face_width", "helix_angle"):
                assert getattr(second, key) == pytest.approx(getattr(first, key), rel=1e-12)
        assert other.centre_distance == pytest.approx(one.centre_distance, rel=1e-12)
    loads = [
        [part.normal_load(found.pairs[name]) for name, part in found.case.pair.items()] for found in (scene, again)
    ]
    assert loads[1] == pytest.approx(loads[0], rel=1e-10)


def test_a_shaft_between_two_stages_gets_no_torque_from_rounded_ones():
    """The torque of stage II had six digits: 6e-5 N m were left, and became a coupling in the model."""
    document = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    torque = document["pair"]["II"]["torque"]
    assert "coupling" not in document["shaft"]["mid"]
    document["pair"]["II"]["torque"] = f"{float(torque.split()[0]) * (1.0 + 1e-6)} N*m"
    again, _ = there_and_back(build_scene(document, "box", Path()))
    couplings = {name: part.coupling for name, part in again.case.shaft.items()}
    assert couplings == {"in": 0.0, "mid": None, "out": pytest.approx(0.12)}
    assert again.case.pair["II"].normal_load(again.pairs["II"]) == pytest.approx(
        read_scene(CASES / "two_stage_shafts.toml", ()).case.pair["II"].normal_load(again.pairs["II"]), rel=1e-5
    )


def test_yield_strengths_come_back_and_a_required_safety_is_said_to_be_lost():
    document = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    document["shaft"]["mid"] |= {"yield_strength": "700 MPa", "safety_yield": 1.5}
    scene = build_scene(document, "box", Path())
    again, remarks = there_and_back(scene)
    assert [one for one in remarks if one.startswith("Shaft ")] == ["Shaft mid: safety_yield not written to REXS."]
    assert same(again.case.shaft["mid"].yield_strength, 700e6)
    written = {name for name, one in again.case.shaft.items() if "yield_strength" in one.model_fields_set}
    assert written == {"mid"}  # what is assumed is not written as if it were known


@pytest.mark.parametrize(("material", "kept"), [("through-hardened-alloy-steel", True), ("case-hardened-steel", False)])
def test_a_yield_strength_of_teeth_comes_back_where_their_rating_asks_for_it(material, kept):
    document = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    gear = next(iter(document["gear"]))
    hardness = {"hardness": "320 HV"} if kept else {}
    document["gear"][gear]["strength"] = {"material": material, "yield_strength": "700 MPa", **hardness}
    again, _ = there_and_back(build_scene(document, "box", Path()))
    assert again.case.gear[gear].strength.yield_strength == (pytest.approx(700e6) if kept else None)


def test_what_has_no_attribute_is_said_and_a_case_without_pairs_refused():
    document = tomllib.loads(case_of(model_of(in_json(two_stages()), HERE)))
    document["gear"]["gear_11"] |= {"thickness_allowance": "50 um", "relief": {"table": [
        {"radii": ["19 mm", "21 mm"], "removals": ["0 um", "5 um"]}]}}  # fmt: skip
    document["pair"]["I"]["operation"]["mesh_load_factor"] = 1.2
    _, remarks = there_and_back(build_scene(document, "case", Path()))
    assert remarks == (
        "Gear gear_11: thickness_allowance not written to REXS.",
        "Gear gear_11, relief: table not written to REXS.",
        "Pair I, operation: mesh_load_factor not written to REXS.",
    )
    alone = build_scene({"gear": {"a": document["gear"]["gear_13"]}, "results": ["geometry"]}, "case", Path())
    with pytest.raises(InputError, match="is required: a REXS model contains gears in mesh"):
        model_text(alone, "")


def test_a_gear_that_drives_its_like_becomes_two():
    document = {
        "gear": {"a": {"teeth": 30, "module": "3 mm", "face_width": "20 mm"}},
        "pair": {"I": {"driver": "a", "driven": "a", "torque": "50 N*m", "speed": "900 rpm"}},
    }
    again, _ = there_and_back(build_scene({**document, "results": ["geometry"]}, "case", Path()))
    assert len(again.gears) == 2
    assert (again.case.pair["I"].torque, again.case.pair["I"].speed) == pytest.approx((50.0, 30.0 * np.pi))


@pytest.mark.dear
def test_the_command_writes_results_of_a_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    box = case_of(model_of(in_json(two_stages()), HERE))
    Path("box.toml").write_text(box.replace('width = "solid"', 'width = "slices"'), "utf-8")

    def say(*arguments):
        monkeypatch.setattr(sys, "argv", ["fegear", *arguments])
        with pytest.raises(SystemExit) as end:
            fegear.cli.main()
        return int(end.value.code or 0), "".join(capsys.readouterr())

    assert (
        say(
            "run",
            "box.toml",
            "--no-plots",
            "--results",
            "geometry,rating,shaft-deflection",
            "--set",
            "accuracy.tolerance=5e-2",
        )[0]
        == 0
    )
    assert say("export", "results/box", "--format", "rexs", "--out", "out")[0] == 0
    model = ET.parse("out/box.rexs").getroot()  # noqa: S314
    assert model.get("version") == "1.7"
    found = json.loads(Path("results/box/summary.json").read_text("utf-8"))["results"]
    text = Path("out/box.rexs").read_text("utf-8")
    for key, attribute in (("I.driver.S_H", "safety_factor_pitting_iso_6336_2019"),
                           ("I.contact_ratio", "radial_contact_ratio")):  # fmt: skip
        value = float(re.search(rf'id="{attribute}"[^>]*>([^<]*)<', text)[1])
        assert value == pytest.approx(found[key]["value"], rel=1e-12)
    bent = model.findall(".//attribute[@id='displacement_v_of_nodes']/array")
    assert len(bent) == 3
    assert len(model.findall(".//attribute[@id='force_acting_on_inner_component_w']")) == 6
    # What is read again is the case, not its results.
    assert tomllib.loads(case_of(model_of(text, HERE)))["pair"]["I"]["torque"] == "100 N*m"
    # From Python the model holds the same.
    run = fegear.run("box.toml", {"results": ["geometry", "rating", "shaft-deflection"], "accuracy.tolerance": 5e-2})
    (model,) = run.export("python", "rexs")
    values = [re.findall(r'id="safety[^>]*>([^<]*)<', one) for one in (text, model.read_text("utf-8"))]
    assert values[0] == values[1] != []
    assert "can be exported as rexs only" in say("export", "results/box", "--format", "dxf")[1]


def drafted(**bearings):
    """A drafted gearbox with other bearings."""
    document = tomllib.loads(draft(Answers(TWO_STAGES, {}), "case"))
    document["bearing"] |= bearings
    return build_scene(document, "case", Path())


def test_bearings_by_designation_come_back_by_designation():
    outer = drafted().case.bearing["middle_floating"].designation
    located = {
        "designation": "6309-2Z",
        "catalogue": {"static_rating": "31.5 kN", "clearance": "8 um"},
        "life": {"dynamic_rating": "55 kN"},
    }
    ribbed = {"designation": "NUP" + outer.removeprefix("NU") + " ECP", "life": {}}  # locates as the ball bearing does
    tapered = {"designation": "30210", "life": {}}
    for changes in ({}, {"middle_locating": located}, {"middle_locating": ribbed}, {"output_locating": tapered}):
        scene = drafted(**changes)
        again, _ = there_and_back(scene)
        stop = {"output_locating_along"} if "output_locating" in changes else set()  # one tapered bearing holds one way
        assert again.case.bearing.keys() == scene.case.bearing.keys() | stop
        for name, bearing in scene.case.bearing.items():
            one = again.case.bearing[name]
            assert one.designation == bearing.designation
            assert same(one.rating, bearing.rating)
            assert same(one.printed, bearing.printed)
            assert same(one.build(), bearing.build())
            if "catalogue" not in bearing.given:
                assert one.catalogue is None


@pytest.mark.parametrize("changed", ["width", "catalogue_designation", "bearing_type"])
def test_dimensions_or_a_type_of_another_bearing_than_the_designation_has_are_kept_as_dimensions(changed):
    scene = drafted()
    name, known = "output_locating", scene.case.bearing["output_locating"]
    text, _ = model_text(scene, "")
    model = ET.fromstring(text)  # noqa: S314  (our own)
    (part,) = (one for one in model.iter("component") if one.get("name") == name)
    (one,) = (one for one in part if one.get("id") == changed)
    one.text = {
        "width": f"{known.printed.width * 1e3 + 2.0:g}",
        "catalogue_designation": "6" + known.designation[1:-2] + "99",
        "bearing_type": "radial_roller_bearing",
    }[changed]
    case = case_of(model_of(ET.tostring(model, "unicode"), HERE))
    assert case.count("no dynamic load rating: that of the designation") == len(scene.case.bearing) - 1
    assert case.count("no dynamic load rating: estimated from the dimensions") == 1
    again = build_scene(tomllib.loads(case), "case", Path())
    found = again.case.bearing[name]
    assert found.designation is None
    assert same(found.printed.bore, known.printed.bore)
    assert same(found.printed.outside_diameter, known.printed.outside_diameter)
    assert found.printed.kind == ("cylindrical" if changed == "bearing_type" else "ball")
    wider = 2e-3 if changed == "width" else 0.0
    assert found.printed.width == pytest.approx(known.printed.width + wider)
