"""A run reports the assumed defaults of keys that the case does not give and the answer depends on."""

from __future__ import annotations

import copy

import pytest

from fegear.case.built.pair_notes import effect_notes
from fegear.case.reading import build_scene

CASE = {
    "results": ["transmission-error"],
    "gear": {"a": {"teeth": 28, "module": "3 mm", "bore_radius": "15 mm", "face_width": "10 mm"}},
    "pair": {"I": {"driver": "a", "driven": "a", "load": "1000 N"}},
}


def said(case: dict, tmp_path) -> tuple[str, ...]:
    return effect_notes(build_scene(case, "case", tmp_path), "I")


@pytest.mark.parametrize(
    ("key", "expected"),
    [("face_width", ": face_width not specified, 1 mm assumed."), ("bore_radius", "half the root radius, 19.125 mm")],
)
def test_a_missing_length_is_reported_once_with_the_assumed_value(key, expected, tmp_path):
    assert said(CASE, tmp_path) == ()
    case = copy.deepcopy(CASE)
    del case["gear"]["a"][key]
    (remark,) = said(case, tmp_path)
    assert expected in remark


def test_a_body_that_the_source_does_not_know_is_not_talked_about(tmp_path):
    case = copy.deepcopy(CASE)
    del case["gear"]["a"]["bore_radius"]
    case["pair"]["I"]["compliance"] = {"source": "weber-banaschek"}
    assert said(case, tmp_path) == ()
