"""What is said of a line that is no TOML, and of helix angles with a sign."""

from pathlib import Path

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene, parse_document


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("hand = left", 'set hand = "left" (texts must be quoted)'),
        ("hand = left  # of the pinion", 'set hand = "left" (texts must be quoted)'),
        ("module = 2 mm", 'set module = "2 mm" (quantities with a unit must be quoted)'),
        ("tip_relief = { amount = 20 um, height = '1 mm' }", 'set amount = "20 um" (quantities with a unit must be'),
        ('tip_relief = { shape = "linear", height = -1.5e-3 mm }', 'set height = "-1.5e-3 mm"'),
        ("relief = True", "set relief = true"),
        ("relief = no", "set relief = false"),
        ("teeth = = 2", "quantities with a unit must be quoted"),
        ("teeth = 20 40", 'set teeth = "20 40"'),
        ("results = [rack-geometry]", "quantities with a unit must be quoted"),
        ('title = "a', "quantities with a unit must be quoted"),
    ],
)
def test_the_line_that_is_no_toml_is_written_as_it_should_be(line, remedy):
    with pytest.raises(InputError) as refused:
        parse_document(f"a = 1\n{line}\nb = 2\n", "case")
    assert "(at line 2, column" in str(refused.value)
    assert f"; {remedy}" in str(refused.value)


@pytest.mark.parametrize(
    ("more", "remedy"),
    [
        ({"hand": "left"}, 'set helix_angle = "20 deg"; hand = "left" defines the sign.'),
        ({}, 'set helix_angle = "20 deg" and hand = "left" or "right".'),
    ],
)
def test_a_negative_helix_angle_is_refused_with_its_hand(more, remedy):
    gear = {"teeth": 20, "normal_module": "2 mm", "helix_angle": "-20 deg", **more}
    with pytest.raises(InputError) as refused:
        build_scene({"results": ["geometry"], "gear": {"p": gear}}, "case", Path())
    assert str(refused.value) == f"gear.p.helix_angle = -20 deg: must be between 0 and 60 deg; {remedy}"
