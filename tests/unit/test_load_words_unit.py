"""Loads are called as the case gives them: by the torque in titles, legends and captions, or by the force."""

from __future__ import annotations

import re

import pytest

import fegear
from fegear.engine.figure.figure import Figure
from fegear.engine.sheet.load_words import load_words, loads_as_given
from fegear.window.order import HarrisMaps

CASE = """
results = ["load-sharing", "transmission-error", "relief-chart"]
[gear.a]
teeth = 25
module = "3 mm"
face_width = "20 mm"
[gear.b]
teeth = 40
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "b"
{loads}
compliance = {{ source = "cornell" }}
[design.chart]
amounts = ["10 um", "20 um", "30 um"]
lengths = [0.4, 0.8, 1.2]
"""
LEVER = 0.0375 * 0.9396926207859084
GIVEN = {
    "torques": ('torque = "200 N*m"\ntorques = ["100 N*m", "190 N*m"]', ("100 N m", "190 N m", "200 N m")),
    "loads": (
        f'load = "{200.0 / LEVER:.12g} N"\nloads = ["{100.0 / LEVER:.12g} N", "{190.0 / LEVER:.12g} N"]',
        tuple(f"{torque / LEVER:.5g} N" for torque in (100.0, 190.0, 200.0)),
    ),
}


def texts(figure: Figure) -> str:
    """Heading, caption and all that a figure's curves and choices are called."""
    panels = [*figure.panels, *(panel for view in figure.views for panel in view.panels)]
    labels = [getattr(item, "name", "") for panel in panels for item in panel.items]
    named = [figure.heading, figure.under, figure.caption, *(view.label for view in figure.views)]
    return "\n".join([*named, *labels])


@pytest.fixture(scope="module")
def found():
    return {key: fegear.run(CASE.format(loads=loads), progress=False) for key, (loads, _) in GIVEN.items()}


@pytest.mark.parametrize("key", GIVEN)
def test_titles_legends_and_captions_call_loads_as_the_case_gives_them(found, key):
    drawn = [one for one in found[key].figures if isinstance(one, Figure)]
    drawn_texts = "\n".join(map(texts, drawn))
    said = set(re.findall(r"\d[\d.]* N(?: m)?\b(?!/)", drawn_texts))
    assert said == set(GIVEN[key][1])
    named = {one.key for one in drawn if GIVEN[key][1][-1] in texts(one)}
    assert named >= {"load_sharing_I", "transmission_error_I", "relief_chart_I"}
    assert GIVEN[key][1][-1] in found[key].tables["load_sharing_I"].title


def test_columns_keys_and_numbers_do_not_depend_on_how_loads_are_called(found):
    by_torque, by_load = found["torques"], found["loads"]
    for one in by_torque.tables:
        other = by_load.tables[one.name]
        assert [column.name for column in one.columns] == [column.name for column in other.columns]
    assert [one.name for one in by_torque.values] == [one.name for one in by_load.values]


def test_the_map_beside_the_slider_is_in_the_words_of_the_case(found):
    for key, unit in (("torques", " N m with the"), ("loads", " N with the")):
        assert unit in HarrisMaps().at_rest(found[key])["I"]["figure"]["caption"]


def test_a_load_of_what_is_no_pair_is_a_force_and_words_end_with_their_result(found):
    scene = found["torques"].scene
    with loads_as_given(scene, "I"):
        assert load_words(200.0 / LEVER) == "200 N m"
        with loads_as_given(scene, "a"):
            assert load_words(8783.71) == "8783.7 N"
        assert load_words(190.04 / LEVER, 3) == "190 N m"
    assert load_words(8783.71) == "8783.7 N"
