"""Odd teeth of a gear in Python: what one has already stays, bodies replace each other, tooth 0 is the default."""

from __future__ import annotations

import pytest

from fegear.workbench.gear import _BODIES, Gear


class Known:
    """A gear of which only keys are looked at."""

    _odd_teeth = Gear._odd_teeth
    _with_odd_tooth = Gear._with_odd_tooth

    def __init__(self, keys):
        self.keys = keys

    def changed(self, **keys):
        return Known({**self.keys, **keys})


PIT = {"pits": [{"face_share": 0.4}]}


@pytest.mark.parametrize("given", [{**PIT}, {"tooth": 0, **PIT}, [{**PIT}], [{"tooth": 0, **PIT}]])
def test_a_table_without_a_number_is_of_tooth_0(given):
    known = Known({"odd_tooth": given})
    assert known._with_odd_tooth(0, crack="crack").keys["odd_tooth"] == [{"tooth": 0, **PIT, "crack": "crack"}]
    first = given if isinstance(given, dict) else given[0]
    assert known._with_odd_tooth(1, crack="crack").keys["odd_tooth"] == [first, {"tooth": 1, "crack": "crack"}]


@pytest.mark.parametrize("given", [{"tooth": 1, **PIT}, [{"tooth": 1, **PIT}]])
def test_another_tooth_stays_as_it_is(given):
    known = Known({"odd_tooth": given})
    assert known._with_odd_tooth(0, hole="hole").keys["odd_tooth"] == [
        {"tooth": 1, **PIT}, {"tooth": 0, "hole": "hole"},
    ]  # fmt: skip
    assert known._with_odd_tooth(1, hole="hole").keys["odd_tooth"] == [{"tooth": 1, **PIT, "hole": "hole"}]
    assert Known({})._with_odd_tooth(2, hole="hole").keys["odd_tooth"] == [{"tooth": 2, "hole": "hole"}]


@pytest.mark.parametrize("old", _BODIES)
@pytest.mark.parametrize("new", _BODIES)
def test_a_body_replaces_a_body_and_leaves_the_flank(old, new):
    known = Known({"odd_tooth": [{"tooth": 3, old: "old", **PIT}]})
    assert known._with_odd_tooth(3, **{new: "new"}).keys["odd_tooth"] == [{"tooth": 3, **PIT, new: "new"}]


def test_a_flank_leaves_the_body_and_ends_that_a_tooth_is_missing():
    known = Known({"odd_tooth": [{"tooth": 3, "crack": "old"}, {"tooth": 4, "missing": True}]})
    assert known._with_odd_tooth(3, **PIT).keys["odd_tooth"][-1] == {"tooth": 3, "crack": "old", **PIT}
    assert known._with_odd_tooth(4, **PIT).keys["odd_tooth"][-1] == {"tooth": 4, **PIT}


def test_a_pit_more_comes_after_those_that_the_tooth_has():
    more = Gear.with_pit(Known({"odd_tooth": [{**PIT}, {"tooth": 1, "pits": [{"face_share": 0.1}]}]}), 0, depth=2)
    assert more.keys["odd_tooth"][-1] == {"tooth": 0, "pits": [{"face_share": 0.4}, {"depth": 2}]}
    first = Gear.with_pit(Known({}), depth=2)
    assert first.keys["odd_tooth"] == [{"tooth": 0, "pits": [{"depth": 2}]}]
