"""End II of an idler, or of a planet, is at one end in the mesh that drives it and at the other where it drives."""

import tomllib
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.built.solid_influence import check_solid_gear
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

SET = Path(__file__).parents[2] / "cases" / "helical_planetary_set.toml"


def idler(offset, second, **more):
    body = {"rim_thickness": "3 mm", "web_thickness": "3 mm", "web_offset": offset, "hub_radius": "11 mm"} | more
    gear = {"teeth": 24, "module": "2 mm", "bore_radius": "7 mm", "face_width": "8 mm"}
    pairs = {"I": {"driver": "a", "driven": "b", "torque": "20 N*m"}, "II": second | {"torque": "20 N*m"}}
    case = {
        "results": ["load-distribution"],
        "gear": {"a": gear, "b": gear | {"body": body}, "c": gear},
        "pair": {key: one | {"width": "solid"} for key, one in pairs.items()},
    }
    return build_scene(case, "case", Path())


def test_a_web_off_the_middle_of_an_idler_is_refused():
    with pytest.raises(InputError, match="ambiguous for idler b: end II is at opposite ends in pairs I and II"):
        check_solid_gear(idler("1.5 mm", {"driver": "b", "driven": "c"}), "b")


def test_webs_in_the_middle_and_wheels_of_two_pinions_are_solved():
    check_solid_gear(idler("0 mm", {"driver": "b", "driven": "c"}), "b")
    check_solid_gear(idler("1.5 mm", {"driver": "c", "driven": "b"}), "b")


def test_an_idler_is_not_taken_by_one_tooth_over_its_holes():
    """Its other flank is loaded in the other mesh, which stands differently to them; the mean of all is alike."""
    holes = {"count": 5, "circle_diameter": "30 mm", "diameter": "4 mm"}
    one, second = {"driver": "b", "driven": "c"}, {"driver": "c", "driven": "b"}
    with pytest.raises(InputError, match="loaded in pair I; pair II loads the other flank") as found:
        check_solid_gear(idler("0 mm", one, holes=holes | {"tooth": 3}), "b")
    assert found.value.key == "gear.b.body.holes.tooth"
    check_solid_gear(idler("0 mm", one, holes=holes), "b")
    check_solid_gear(idler("0 mm", second, holes=holes | {"tooth": 3}), "b")


def set_with_a_web(offset):
    case = tomllib.loads(SET.read_text())
    body = {"rim_thickness": "5 mm", "web_thickness": "5 mm", "web_offset": offset, "hub_radius": "17 mm"}
    case["gear"]["planet"] |= {"body": body}
    case["results"] = ["planet-load-sharing"]
    return build_scene(case, "case", SET.parent)


def test_a_web_off_the_middle_of_a_planet_is_refused():
    """The sun drives it and it drives the ring: before anything is solved."""
    with pytest.raises(
        InputError, match="ambiguous for idler planet: end II is at opposite ends in pairs P_sun and P_ring"
    ):
        make_plan(set_with_a_web("2 mm"), STAGES)
    assert make_plan(set_with_a_web("0 mm"), STAGES)
