"""Bad input: one sentence that names the key, the value, the rule and the remedy."""

from __future__ import annotations

import copy
import re
from pathlib import Path

import pytest

import fegear
from fegear.base.errors import GeometryError, InputError
from fegear.case.design import ChartPart, RobustnessPart
from fegear.case.dynamics import DesignChartPart
from fegear.case.flank_design import FlankMapPart
from fegear.case.reading import apply_override, build_scene, parse_document, read_scene
from fegear.engine.run import Silence

CASE = {
    "title": "One gear",
    "results": ["stiffness"],
    "gear": {
        "a": {
            "teeth": 28,
            "module": "1 mm",
            "rack": {"addendum": 1, "dedendum": 1.25, "tip_radius": 0.25},
            "bore_radius": "6.375 mm",
            "face_width": "10 mm",
            "material": {"young_modulus": "206.8 GPa", "poisson_ratio": 0.3},
        },
        "b": {"teeth": 35, "module": "1 mm"},
    },
    "pair": {"I": {"driver": "a", "driven": "b", "load": "100 N"}},
    "stiffness": {"gear": "a"},
}


def scene_with(*overrides: str):
    document = copy.deepcopy(CASE)
    for override in overrides:
        apply_override(document, override)
    return build_scene(document, "case", Path())


def test_a_case_is_read_into_si():
    scene = scene_with()
    assert scene.gears["a"].module == pytest.approx(1e-3, rel=1e-15)
    assert scene.gears["a"].material.young_modulus == pytest.approx(206.8e9, rel=1e-15)
    assert scene.pairs["I"].contact_ratio == pytest.approx(1.68, abs=0.05)
    assert scene.case.pair["I"].load == 100.0
    assert scene.gears["b"].bore_radius == pytest.approx(0.5 * scene.gears["b"].root_radius)


def test_diametral_pitch_gives_the_module():
    document = copy.deepcopy(CASE)
    document["gear"]["a"].pop("module")
    document["gear"]["a"] |= {"diametral_pitch": "8 / inch", "bore_radius": "20 mm"}
    document["pair"] = {}
    assert build_scene(document, "case", Path()).gears["a"].module == pytest.approx(25.4e-3 / 8, rel=1e-15)


def test_named_and_full_racks():
    assert scene_with("gear.a.rack=ISO 53 A").gears["a"].tooth.rack.tip_radius == 0.38
    full = scene_with("gear.a.rack.tip_radius=full").gears["a"].tooth
    assert full.root_land is None


def test_torque_becomes_a_load_along_the_line_of_action():
    document = copy.deepcopy(CASE)
    document["pair"]["I"] = {"driver": "a", "driven": "b", "torque": "1 N*m"}
    scene = build_scene(document, "case", Path())
    load = scene.case.pair["I"].normal_load(scene.pairs["I"])
    assert load == pytest.approx(1.0 / scene.gears["a"].base_radius, rel=1e-15)


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("gear.a.teth=3", "--set", 'did you mean "teeth"'),
        ("gear.a.material.poisson=0.3", "--set", 'did you mean "poisson_ratio"'),
        ("gear.a.material={poisson=0.3}", "gear.a.material.poisson", 'did you mean "poisson_ratio"'),
        ("gear.a.rack={adendum=1.0}", "gear.a.rack.adendum", 'did you mean "addendum"'),
        ("gera.a.teeth=3", "--set", 'did you mean "gear"'),
        ("gear.c.teeth=3", "--set", "not in this case"),
        ("title.x=3", "--set", "is not a table"),
        ("teeth", "--set", "KEY=VALUE"),
        ("gear.a.module=3 N", "gear.a.module", "is not a length"),
        ("gear.a.module=3", "gear.a.module", "has no unit;"),
        ("gear.a.module=-3 mm", "gear.a.module", "greater than zero"),
        ("gear.a.diametral_pitch=8 / inch", "gear.a.diametral_pitch", "contradicts module"),
        ("gear.a.teeth=28.5", "gear.a.teeth", "whole number"),
        ('gear.a.teeth="28"', "gear.a.teeth", "whole number"),
        ("gear.a.teeth=4", "gear.a.teeth", "between 5 and 1000"),
        ("gear.a.teeth=true", "gear.a.teeth", "whole number"),
        ("gear.a.material.poisson_ratio=0.5", "gear.a.material.poisson_ratio", r"inside \(-1, 0.5\)"),
        ("gear.a.material.poisson_ratio=-1.0", "gear.a.material.poisson_ratio", r"inside \(-1, 0.5\)"),
        ("gear.a.bore_radius=13 mm", "gear.a.bore_radius", r"between 0 and the root radius 12.75 mm"),
        ("gear.a.bore_radius=0 mm", "gear.a.bore_radius", "greater than zero"),
        ("gear.a.rack.tip_radius=0.6", "gear.a.rack.tip_radius", "maximum of 0.47"),
        ("gear.a.rack=ISO 53 E", "gear.a.rack", "is not a known profile"),
        ("gear.a.pressure_angle=60 deg", "gear.a.pressure_angle", "between 5 and 45"),
        ("gear.a.profile_shift=2.5", "gear.a.profile_shift", "pointed"),
        ("gear.a.tip_diameter=40 mm", "gear.a.tip_diameter = 40 mm", "pointed"),
        ("gear.a.tip_radius_rounding=3 mm", "gear.a.tip_radius_rounding = 3 mm", "use at most 0.5793 mm"),
        ("gear.a.plane=stres", "gear.a.plane", "'strain', 'stress' or 'auto'"),
        ("gear.b.plane=auto", "gear.b.face_width", "is required"),
        ("gear.a.profile_shift=nan", "gear.a.profile_shift", "finite"),
        ("gear.b.module=2 mm", "pair.I", "base pitches"),
        ("pair.I.driver=c", "pair.I.driver", "known here: a, b"),
        ("pair.I.centre_distance=20 mm", "pair.I.centre_distance", "leaves no backlash"),
        ("pair.I.centre_distance=60 mm", "pair.I.centre_distance", "is too large: no flank contact"),
        ("pair.I.torque=1 N*m", "pair.I.torque", "contradicts load"),
        ("pair.I.compliance.source=fem", "pair.I.compliance.source", "'fe'"),
        ("pair.I.compliance.source=table", "pair.I.compliance.file", "is required"),
        ("stiffness.gear=c", "stiffness.gear", "known here: a, b"),
        ('stiffness.radii=["3 N"]', "stiffness.radii[0]", "is not a length"),
        ("stiffness.radii=[]", "stiffness.radii", "empty"),
        ("stiffness.positions=1", "stiffness.positions", "greater than or equal to 2"),
        ("accuracy.tolerance=0", "accuracy.tolerance", "between"),
        ("accuracy.order=5", "accuracy.order", "less than or equal to 4"),
        ("effects.friction=1", "effects.friction", "true or false"),
        ("effects.hertz=non-linear", "effects.hertz", "'load-dependent'"),
        ("results=[]", "results", "must not be empty"),
        (
            'gear.a.fillet={kind="points",x=["1 mm","2 mm"],y=["3 mm","4 mm"]}',
            "gear.a.fillet.x",
            "at least [3-9] entries",
        ),
        (
            'gear.a.fillet={kind="arcs",radii=["1 mm","2 mm","3 mm"]}',
            "gear.a.fillet.radii",
            "at most 2 entries",
        ),
    ],
)
def test_a_refusal_names_key_and_rule(override, key, words):
    with pytest.raises(InputError, match=words) as refusal:
        scene_with(override)
    assert str(refusal.value).startswith(key)
    assert "\n" not in str(refusal.value)


def test_a_rim_is_given_once():
    gear = {"teeth": 28, "module": "3 mm", "face_width": "10 mm", "bore_radius": "20 mm", "rim_thickness": "6 mm"}
    gear["body"] = {"rim_thickness": "3 mm", "web_thickness": "3 mm"}
    with pytest.raises(InputError, match=r"gear\.a\.rim_thickness = 6 mm: contradicts body\.rim_thickness;"):
        build_scene({"gear": {"a": gear}, "results": ["geometry"]}, "case", Path())


@pytest.mark.parametrize(
    "override",
    ["design.load_factors=[0.1, 0,25]", "design.robustness.load_factors=[0.7, 1,3]", "study.profile_shift=[0,1, 0.5]"],
)
def test_a_decimal_comma_in_a_list_of_numbers_is_refused(override, tmp_path):
    """TOML reads [0.1, 0,25] as three numbers."""
    with pytest.raises(InputError, match=r"decimal comma \(.*use \d\.\d+, or \d, \d+ for two numbers|unknown key"):
        scene_with(override)
    key, _, value = override.rpartition("=")
    table, _, last = key.rpartition(".")
    (tmp_path / "case.toml").write_text(f'results = ["geometry"]\n[{table}]\n{last} = {value}\n')
    with pytest.raises(InputError, match="decimal comma"):
        read_scene(tmp_path / "case.toml")


@pytest.mark.parametrize("fine", ["[0.1, 0.25]", "[0,1,2]", "[0, 1, 2.5]", "[0.1,0.25]", "[0,\n1]"])
def test_other_lists_of_numbers_are_left_alone(fine):
    assert len(parse_document(f"a = {fine}", "case")["a"]) >= 2


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ({"balance": "lod"}, r'train\.balance = "lod": is not a body of this case; did you mean "load"'),
        ({"torque": {"motr": "5 N*m"}}, r'train\.torque = "motr": is not a body'),
        ({"mesh": {"I": {"driver": "motor", "driven": "wheel"}}}, r'train\.mesh\.I\.driven = "wheel": is not a body'),
        ({"mesh": {"II": {"driver": "motor", "driven": "load"}}}, r'no pair of this case is called II; set pair = "I"'),
        ({"mesh": {"II": {"pair": "J", "driver": "motor", "driven": "load"}}}, r'train\.mesh\.II\.pair = "J": is not'),
        ({"damper": {"d": {"a": "lead", "damping": "1 N*m*s"}}}, r'train\.damper\.d\.a = "lead": is not a body'),
    ],
)
def test_names_in_a_train_that_no_result_reads_are_held_against_the_case_too(part, words):
    document = copy.deepcopy(CASE)
    document["train"] = {
        "body": {"motor": {"inertia": "1 kg*m^2"}, "load": {"inertia": "1 kg*m^2"}},
        "mesh": {"I": {"driver": "motor", "driven": "load"}},
        "torque": {"motor": "5 N*m"},
        **part,
    }
    with pytest.raises(InputError, match=words):
        build_scene(document, "case", Path())


def test_geometry_keeps_its_kind_of_error():
    with pytest.raises(GeometryError):
        scene_with("gear.a.bore_radius=13 mm")


@pytest.mark.parametrize("missing", ["results", "gear.a.teeth", "gear.a.module", "pair.I.driver"])
def test_what_is_required_is_named(missing):
    document = copy.deepcopy(CASE)
    table = document
    *steps, last = missing.split(".")
    for step in steps:
        table = table[step]
    table.pop(last)
    with pytest.raises(InputError, match=r"required|missing") as refusal:
        build_scene(document, "case", Path())
    assert refusal.value.key == missing


def test_a_misspelt_key_is_reported_before_the_one_that_is_missing():
    document = copy.deepcopy(CASE)
    document["gear"]["a"]["teth"] = document["gear"]["a"].pop("teeth")
    with pytest.raises(InputError, match=r'gear\.a\.teth = 28: is an unknown key.*did you mean "teeth"'):
        build_scene(document, "case", Path())


@pytest.mark.parametrize(("symbol", "key"), [("x", "profile_shift"), ("d_a", "tip_diameter"), ("B", "face_width")])
def test_a_symbol_of_the_drawing_is_refused_with_its_key(symbol, key):
    document = copy.deepcopy(CASE)
    document["gear"]["a"][symbol] = 0.3
    with pytest.raises(InputError, match=rf'gear\.a\.{symbol} = 0\.3: is an unknown key.*did you mean "{key}"'):
        build_scene(document, "case", Path())


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        read_scene(tmp_path / "none.toml")
    broken = tmp_path / "broken.toml"
    broken.write_text("gear = {")
    with pytest.raises(InputError, match="invalid TOML:"):
        read_scene(broken)
    broken.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="UTF-16"):
        read_scene(broken)
    with pytest.raises(InputError, match="cannot be read"):
        read_scene(tmp_path)


def test_override_values_are_toml_and_else_text():
    document: dict = copy.deepcopy(CASE)
    for override in ("gear.a.teeth=30", 'gear.a.module="2 mm"', "gear.b.module=2 mm", "accuracy.tolerance=1e-2"):
        apply_override(document, override)
    assert document["gear"]["a"]["teeth"] == 30
    assert document["gear"]["a"]["module"] == document["gear"]["b"]["module"] == "2 mm"
    assert document["accuracy"] == {"tolerance": 0.01}


SOURCES = "cornell, fe, potential-energy, potential-energy-simplified, table, weber-banaschek"


@pytest.mark.parametrize(
    ("override", "remedy"),
    [
        ("pair.I.compliance=cornell", 'use compliance = { source = "cornell" }'),
        ("pair.I.compliance=cornel", f'did you mean compliance = {{ source = "cornell" }}? The sources are {SOURCES}'),
        ("pair.I.compliance=5", "use compliance = { ... } with its keys: file, fit, of, source"),
        ("effects=true", ""),  # too many keys to be written out
    ],
)
def test_a_single_value_for_a_table_is_answered_with_the_table(override, remedy):
    with pytest.raises(InputError) as refused:
        scene_with(override)
    assert (refused.value.rule, refused.value.remedy) == ("must be a table of keys and values", remedy)


def test_the_remedy_for_a_single_value_is_accepted():
    assert scene_with('pair.I.compliance={ source = "cornell" }').case.pair["I"].compliance.source == "cornell"


def test_a_list_for_a_table_is_named_as_it_was_written():
    for given, key, rule in (("[]", "torques", "must not be empty"), ('["1 N*m", "1 mm"]', "torques[1]", "is not a"),
                             ("{values=[]}", "torques.values", "must not be empty")):  # fmt: skip
        with pytest.raises(InputError, match=rule) as refused:
            scene_with(f"pair.I.torques={given}")
        assert refused.value.key == f"pair.I.{key}"
    with pytest.raises(InputError, match="must not be empty") as refused:
        scene_with("dynamics.speeds=[]")
    assert refused.value.key == "dynamics.speeds"


@pytest.mark.parametrize(
    ("keys", "key", "words"),
    [("load_factor = 0.5, share = 1.0", "", ""), ("load_factor = 0.5, time = '2 h'", "", ""),
     ("torque = '5 N*m', load_factor = 0.5, share = 0.5", "load_factor", "contradicts torque"),
     ("load_factor = 0.5, share = 0.5, time = '2 h'", "time", "contradicts share"),
     ("share = 0.5", "torque", "is required, or load_factor"), ("load_factor = 0.5", "share", "is required, or time")],
)  # fmt: skip
def test_a_bin_of_a_spectrum_has_one_load_and_one_share(keys, key, words):
    override = f"pair.I.operation.spectrum=[{{ {keys} }}]"
    if not key:
        scene_with(override)
        return
    with pytest.raises(InputError, match=words) as error:
        scene_with(override)
    assert error.value.key.endswith(f".{key}")


@pytest.mark.parametrize("results", [["stiffness"], ["load-sharing"]])
def test_a_run_never_says_that_more_than_all_of_a_task_is_done(monkeypatch, results):
    told = []
    monkeypatch.setattr(Silence, "advance", lambda _self, fraction: told.append(fraction))
    document = copy.deepcopy(CASE) | {"results": results, "accuracy": {"tolerance": 0.3}}
    fegear.run(document, progress=False)
    assert told
    assert all(0.0 <= fraction <= 1.0 for fraction in told)


@pytest.mark.parametrize(("part", "one", "other", "limit"), [
    (DesignChartPart, {"amounts": 1.0}, {"lengths": 0.5}, 100_000),
    (ChartPart, {"amounts": "1 um"}, {"lengths": 0.5}, 100_000),
    (RobustnessPart, {"load_factors": 1.0}, {"spacing_errors": "1 um"}, 100_000),
    (FlankMapPart, {"over_face": "1 um"}, {"load_factors": 1.0}, 2_000),
])  # fmt: skip
def test_as_many_combinations_as_are_said_are_taken_and_not_one_more(part, one, other, limit):
    """Of two lists: 11 times 9091 is 100001, 3 times 667 is 2001."""

    def read(first, second):
        lists = {key: [value] * first for key, value in one.items()} | {k: [v] * second for k, v in other.items()}
        return part.model_validate(lists | ({"relief_errors": [0.0]} if part is RobustnessPart else {}))

    more = 11 if limit == 100_000 else 3
    assert read(10, limit // 10)
    assert (limit + 1) % more == 0
    with pytest.raises(ValueError, match=rf" = {limit + 1:,} [a-z ]+, above the limit"):
        read(more, (limit + 1) // more)


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (["scale", "scale"], '["scale", "scale"]'), ([{"on": True, "at": [1, 2.5]}], "[{ on = true, at = [1, 2.5] }]"),
        ({}, "{}"), ([], "[]"), ((1,), "[1]"), (True, "True"), ("a\nb", "a b"),
    ],
)  # fmt: skip
def test_a_refused_list_is_written_as_in_a_case_file(value, said):
    assert str(InputError("a.fit", value, "must be")) == f"a.fit = {said}: must be."


def test_a_train_without_bodies_is_refused_with_the_tables_of_its_pair():
    """What the remedy says makes a train."""
    document = copy.deepcopy(CASE)
    document["pair"]["I"] = {"driver": "a", "driven": "b", "torque": "5 N*m"}
    document |= {"results": ["natural-modes"], "train": {"mesh": {"I": {"damping_ratio": 0.07}}}}
    with pytest.raises(InputError, match=r"train\.body = \(not given\): is required; for both gears") as refused:
        build_scene(copy.deepcopy(document), "case", Path())
    for change in re.split(r", (?=train)| and (?=train)", refused.value.remedy.split(" set ", 1)[1]):
        apply_override(document, change.replace("...", "5 N*m"))
    scene = build_scene(document, "case", Path())
    assert [body.gears for body in scene.case.train.body.values()] == [["a"], ["b"]]
    assert scene.case.train.mesh["I"].damping_ratio == 0.07
    del document["pair"], document["train"]["body"]
    with pytest.raises(InputError, match=r"is required\.?$"):
        build_scene(document, "case", Path())
