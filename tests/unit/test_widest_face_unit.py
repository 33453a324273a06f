"""A face that no solid can be made of is refused when the case is planned, by the gear's own keys."""

from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.built.solid_influence import check_solid_gear
from fegear.case.reading import build_scene


def pair_of(width, tolerance):
    gear = {"teeth": 24, "module": "2 mm", "face_width": width}
    case = {
        "results": ["load-distribution"],
        "gear": {"a": gear, "b": gear},
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "20 N*m", "width": "solid"}},
        "accuracy": {"tolerance": tolerance},
    }
    return build_scene(case, "case", Path())


@pytest.mark.parametrize(
    ("width", "tolerance", "words"),
    [("121 mm", 0.05, "60 modules"), ("118 mm", 1e-3, "or increase the tolerance"), ("0.3 mm", 0.05, "0.2 and")],
)
def test_faces_that_cannot_be_solved_are_refused_before_the_run(width, tolerance, words):
    with pytest.raises(InputError, match=words) as refused:
        check_solid_gear(pair_of(width, tolerance), "a")
    assert refused.value.key == "gear.a.face_width"


def test_the_widest_face_is_taken():
    check_solid_gear(pair_of("120 mm", 0.05), "a")
