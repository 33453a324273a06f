"""Key ``bore_diameter``: the same gear as with half of it as ``bore_radius``, wherever that counts."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene

GEAR = """
results = ["stiffness"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
{keys}
[stiffness]
gear = "a"
positions = 3
"""


def scene(keys):
    return build_scene(tomllib.loads(GEAR.format(keys=keys)), "case", Path())


@pytest.mark.parametrize(
    "more",
    ["", 'web_thickness = "8 mm"', 'body = { rim_thickness = "4 mm", hub_radius = "18 mm", web_thickness = "6 mm" }'],
)
def test_a_gear_is_the_same_by_both_keys(more):
    by_radius, by_diameter = (scene(f"{key}\n{more}") for key in ('bore_radius = "12 mm"', 'bore_diameter = "24 mm"'))
    assert by_diameter.gears["a"] == by_radius.gears["a"]
    assert by_diameter.gears["a"].bore_radius == pytest.approx(12e-3)
    one, other = by_radius.case.gear["a"], by_diameter.case.gear["a"]
    assert one.gives_rim
    assert other.gives_rim
    assert one.rim(35e-3) == other.rim(35e-3)


def kinds(bore, more):
    """A gear with asymmetric teeth, of a pair in plane, and one with a ring in mesh."""
    text = f"""
results = ["geometry"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
{bore}
{more}
[gear.b]
teeth = 40
module = "3 mm"
face_width = "20 mm"
{more}
bore_diameter = "60 mm"
[pair.I]
driver = "a"
driven = "b"
torque = "100 N*m"
"""
    return build_scene(tomllib.loads(text), "case", Path())


def test_an_asymmetric_gear_is_the_same_by_both_keys():
    more = 'coast_pressure_angle = "28 deg"'
    by_radius, by_diameter = (kinds(bore, more) for bore in ('bore_radius = "12 mm"', 'bore_diameter = "24 mm"'))
    assert by_radius.gears["a"] == by_diameter.gears["a"]
    assert by_diameter.gears["b"].bore_radius == pytest.approx(30e-3)


@pytest.mark.parametrize("key", ["bore_radius", "bore_diameter"])
def test_an_internal_gear_refuses_either_key_under_its_name(key):
    text = f'internal = true\ncutter = {{ teeth = 20 }}\n{key} = "12 mm"'
    with pytest.raises(InputError, match=rf"gear\.a\.{key} = "):
        scene(text)


@pytest.mark.parametrize(
    ("keys", "key", "words"),
    [
        ('bore_diameter = "24 mm"\nbore_radius = "12 mm"', "bore_diameter", "contradicts bore_radius"),
        ('bore_diameter = "90 mm"', "bore_diameter = 90 mm", "(radius 45 mm)"),
        ('bore_diameter = "-2 mm"', "bore_diameter", "greater than zero"),
    ],
)
def test_a_bore_that_cannot_be_is_refused_under_its_key(keys, key, words):
    with pytest.raises(InputError) as refusal:
        scene(keys)
    assert f"gear.a.{key}" in str(refusal.value)
    assert words in str(refusal.value)
