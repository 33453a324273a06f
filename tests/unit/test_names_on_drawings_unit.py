"""Racks, materials, tolerance classes by the names that drawings have; what has none is refused in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.geometry.materials import NAMES, named_material
from fegear.geometry.rack import BasicRack


def scene_of(**gear):
    keys = {"teeth": 24, "module": "3 mm", "face_width": "20 mm", **gear}
    return build_scene({"results": ["geometry"], "gear": {"a": keys}}, "case", Path())


A = (1.0, 1.25, 0.38)
RACKS = {
    "ISO 53 A": A, "A": A, "DIN 867": A, "din867": A, "JIS B 1701": A, "JIS B 1701-1": A, "ISO 53 D": (1.0, 1.4, 0.39),
    "1.25/0.38/1.0": A, "1.4 / 0.39 / 1": (1.0, 1.4, 0.39), "1.25/.3/1.": (1.0, 1.25, 0.3),
    "DIN 3972 I": (1.0, 1.167, 0.2), "DIN 3972-II": (1.0, 1.25, 0.2),
}  # fmt: skip


@pytest.mark.parametrize("name", RACKS)
def test_a_rack_of_a_name(name):
    for rack in (name, {"profile": name}):
        made = scene_of(rack=rack).gears["a"].external_tooth.rack
        assert (made.addendum, made.dedendum, made.tip_radius) == pytest.approx(RACKS[name])
    own = scene_of(rack={"profile": name, "tip_radius": 0.1}).gears["a"].external_tooth.rack
    assert own.tip_radius == 0.1


def test_tools_of_din_3972_have_the_rounding_of_their_module():
    """Printed: m 1: 0.08 mm; m 2: 0.30 mm."""
    for module, rounding in (("1 mm", 0.08), ("2 mm", 0.15)):
        rack = scene_of(module=module, rack="DIN 3972 II").gears["a"].external_tooth.rack
        assert rack.tip_radius == pytest.approx(rounding)


def test_a_name_has_the_pressure_angle_of_its_gear():
    made = scene_of(rack="DIN 867", pressure_angle="22 deg").gears["a"].external_tooth.rack
    assert made == BasicRack.named("A", made.pressure_angle)


@pytest.mark.parametrize(
    ("rack", "module", "rule"),
    [
        ("DIN 3972 III", "3 mm", "pre-machining"), ("DIN 3972 I", "3.1 mm", "has no tip rounding for a module of 3.1"),
        ("AGMA 201.02", "3 mm", "is not a known profile"), ("1.25/0.38", "3 mm", "is not a known profile"),
        ("1.25/0.9/1.0", "3 mm", "full fillet"), ("", "3 mm", "is not a known profile"),
    ],
)  # fmt: skip
def test_profiles_that_are_none(rack, module, rule):
    with pytest.raises(InputError, match=rule) as refused:
        scene_of(rack=rack, module=module)
    assert refused.value.key.startswith("gear.a.rack")


@pytest.mark.parametrize("name", ["18CrNiMo7-6", "18 CrNiMo 7-6", "16MnCr5", "42CrMo4", "AISI 4140", "scm440", "C45"])
def test_a_steel_of_a_name_has_the_constants_of_steel(name):
    scene = scene_of(material=name)
    material = scene.gears["a"].material
    assert (material.young_modulus, material.poisson_ratio, material.density) == (206e9, 0.3, 7850.0)
    assert "ISO 6336-2" in scene.derived[0]
    assert "stress numbers are those of strength" in scene.derived[0]


def test_keys_that_are_given_come_before_those_of_the_name():
    material = scene_of(material={"name": "16MnCr5", "young_modulus": "210 GPa"}).gears["a"].material
    assert (material.young_modulus, material.density) == (210e9, 7850.0)


def test_a_plastic_asks_for_what_its_source_does_not_have():
    with pytest.raises(InputError, match="source of its modulus has none") as refused:
        scene_of(material="POM")
    assert refused.value.key == "gear.a.material.poisson_ratio"
    made = scene_of(material={"name": "Delrin", "poisson_ratio": 0.35}).gears["a"].material
    assert (made.young_modulus, made.poisson_ratio, made.density) == (2.9e9, 0.35, 1410.0)


def test_unknown_materials_name_the_nearest():
    with pytest.raises(InputError, match='did you mean "16MnCr5"'):
        scene_of(material="16MnCrr5")


def test_every_steel_has_a_type_that_ratings_know():
    from fegear.formulas.iso6336.part5_materials import MATERIALS

    kinds = {named_material(name).kind for name in NAMES} - {""}
    assert kinds <= set(MATERIALS)
    assert len(kinds) == 4


def test_a_steel_is_rated_as_its_type():
    for strength in ({"material": "18CrNiMo7-6"}, {"steel": "18CrNiMo7-6"}):
        scene = scene_of(strength=strength)
        assert scene.case.gear["a"].strength.material == "case-hardened-steel"
        assert "18CrNiMo7-6 is rated as case-hardened-steel of ISO 6336-5; confirm" in scene.derived[0]
    own = scene_of(strength={"steel": "42CrMo4", "material": "induction-hardened-steel"})
    assert own.case.gear["a"].strength.material == "induction-hardened-steel"
    for strength in ({"steel": "POM"}, {"steel": "unknown"}):
        with pytest.raises(InputError, match="is not a known steel"):
            scene_of(strength=strength)
    with pytest.raises(InputError, match="case-hardened-steel"):
        scene_of(strength={"material": "unknown"})


@pytest.mark.parametrize(
    "name", [6, "6", "ISO 1328-1 6", "ISO 1328 class 6", "DIN ISO 1328-1:2013 6", "ANSI/AGMA ISO 1328-1-B14 A6"]
)
def test_a_tolerance_class_of_a_name(name):
    assert scene_of(tolerance_class=name).case.gear["a"].tolerance_class == 6


@pytest.mark.parametrize("name", ["AGMA Q11", "DIN 3962 6", "DIN 58405 8f", "ISO 1328-1:1995 6", "Q 11", "", "6.5"])
def test_classes_of_other_standards_have_other_tolerances(name):
    with pytest.raises(InputError, match=r"is not a class of ISO 1328-1:2013; .* can be given as deviations"):
        scene_of(tolerance_class=name)


@pytest.mark.parametrize("name", [0, 12, "ISO 1328-1 12"])
def test_classes_that_the_standard_does_not_have(name):
    with pytest.raises(InputError, match="tolerance_class"):
        scene_of(tolerance_class=name)
