"""Backlash of a train's mesh: that of its gears unless it is given, in every answer that reads it."""

import math

import pytest

import fegear
from fegear.base.errors import InputError
from fegear.case.built.train import train_inputs
from fegear.case.reading import build_scene
from fegear.dynamics.train.train_spec import build_train
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES


def case(allowance="53.2088886 um", distance="350 mm", **keys):
    mesh = {"driver": "one", "driven": "two", "damping_ratio": 0.07, **keys}
    return {
        "results": ["dynamic-factor"],
        "gear": {
            "a": {"teeth": 30, "module": "10 mm", "face_width": "100 mm", "thickness_allowance": allowance},
            "b": {"teeth": 40, "module": "10 mm", "face_width": "100 mm"},
        },
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "5000 N m", "centre_distance": distance,
                       "compliance": {"source": "weber-banaschek"}}},
        "train": {"body": {"one": {"gears": ["a"]}, "two": {"gears": ["b"]}}, "mesh": {"I": mesh},
                  "torque": {"one": "5000 N m"}, "balance": "two"},
        "dynamics": {"speeds": {"start": "1500 rpm", "stop": "3000 rpm", "count": 7}},
        "effects": {"contact_loss": True, "parametric": True},
    }  # fmt: skip


def backlash(folder, document):
    scene = build_scene(document, "case", folder)
    return build_train(train_inputs(scene).spec).meshes[0].backlash, scene.pairs["I"].normal_backlash


def test_it_is_that_of_the_gears_unless_given(tmp_path):
    found, own = backlash(tmp_path, case())
    assert found == own == pytest.approx(50e-6, rel=1e-6)
    assert backlash(tmp_path, case(distance="350.2 mm"))[0] > found
    assert backlash(tmp_path, case(backlash="20 um"))[0] == pytest.approx(20e-6)
    assert backlash(tmp_path, case(backlash="unlimited"))[0] == math.inf
    jam = backlash(tmp_path, case("0 mm", "349.996 mm"))
    assert jam[0] == 0.0 > jam[1]


def test_along_the_transverse_line_of_action_of_helical_gears(tmp_path):
    document = case(distance="405 mm")
    for name, hand in (("a", "right"), ("b", "left")):
        gear = document["gear"][name]
        gear |= {"normal_module": gear.pop("module"), "helix_angle": "30 deg", "hand": hand}
    del document["pair"]["I"]["compliance"]
    found, normal = backlash(tmp_path, document)
    helix = build_scene(document, "case", tmp_path).gears["a"].base_helix_angle
    assert found == pytest.approx(normal / math.cos(helix))
    assert found > 1.1 * normal > 0.0


def test_that_of_the_gears_said_once_more_contradicts_nothing(tmp_path):
    off = {**case(), "effects": {"contact_loss": False, "parametric": True}}
    for text in ("50.0 um", "unlimited"):
        own = case(backlash=text, allowance="53.2088886 um")
        assert make_plan(build_scene({**own, "effects": off["effects"]}, "case", tmp_path), STAGES).steps
    with pytest.raises(InputError, match="requires effects\\.contact_loss = true"):
        make_plan(build_scene({**case(backlash="60 um"), "effects": off["effects"]}, "case", tmp_path), STAGES)


def factors(document):
    results = fegear.run(document, progress=False)
    return results["dynamic_factor_I"].column("dynamic_factor").values[1:4]  # 1750, 2000, 2250 rpm


def on_discs(document):
    """The train with gears whose inertia is that of discs of the pitch circle on the usual bore."""
    for body, gear in (("one", "a"), ("two", "b")):
        made = fegear.Gear(**document["gear"][gear]).data.tables["geometry"]
        pitch, bore = (float(made[name][0]) * 1e-3 for name in ("pitch_radius", "bore_radius"))
        inertia = 0.5 * math.pi * 7850.0 * 0.1 * (pitch**4 - bore**4)
        document["train"]["body"][body] = {"inertia": f"{inertia!r} kg*m^2"}
    return document


@pytest.mark.dear
def test_the_dynamic_factor_counts_it(tmp_path):
    """An infinite one gave 3.601, 3.070, 2.653, with gears as heavy as discs of their pitch circles."""
    found = factors(on_discs(case()))
    assert found == pytest.approx([1.461, 1.089, 3.007], abs=5e-4)
    assert factors(on_discs(case(backlash="50.0 um"))) == pytest.approx(found, rel=1e-5)
    assert factors(on_discs(case(backlash="unlimited"))) == pytest.approx([3.601, 3.070, 2.653], abs=5e-4)


@pytest.mark.dear
def test_teeth_that_jam_by_rounding_lose_no_contact_and_are_named():
    document = case("0 mm", "349.997 mm")
    results = fegear.run(document, progress=False)
    assert results.values["I.largest_contact_loss"].value == 0.0
    said = " ".join(results.remarks)
    assert "Mesh I: no backlash (negative by 2.05 um, rounded profile shifts)" in said
    assert "set thickness_allowance of a gear, or train.mesh.I.backlash" in said
