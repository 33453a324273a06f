"""What objects of Python show of themselves: a sentence or a line, not pages of arrays."""

from dataclasses import dataclass

import numpy as np
import pytest

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.brief import Brief, brief
from fegear.contact.load import load
from fegear.contact.pair_spec import PairSpec
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.workbench.run import run

GEAR = {"teeth": 23, "module": "3 mm", "face_width": "20 mm", "bore_radius": "15 mm"}
CASE = {
    "results": ["load-sharing", "transmission-error"],
    "gear": {"a": GEAR},
    "pair": {"I": {"driver": "a", "driven": "a", "load": "5 kN", "compliance": {"source": "weber-banaschek"}}},
}


@dataclass(frozen=True, slots=True)
class Held(ReadOnlyArrays):
    curve: np.ndarray
    few: np.ndarray
    inner: object
    many: tuple
    text: str = "x" * 100


@dataclass(frozen=True)
class Own(Brief):
    x: float

    def __repr__(self):
        return "own"


def test_fields_are_written_without_what_is_within_them():
    held = Held(np.zeros((30, 4)), np.array([1.0, 2.5]), Held(np.zeros(1), np.zeros(1), None, ()), tuple(range(9)))
    assert repr(held) == (
        "Held(curve=<array 30 x 4>, few=[1. , 2.5], inner=Held(...), many=(0, 1, 2, 3, ... 9 in all), "
        f"text='{'x' * 60}...')"
    )
    assert repr(Own(1.0)) == "own"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ((), "()"), ([], "[]"), ({}, "{}"), ((1,), "(1,)"), ({"a": [1, 2]}, "{'a': [2 of them]}"), (1 / 3, "0.333333"),
        (True, "True"), (None, "None"), (np.float64(2.0), "2"), (len, "<len>"), (Gear, "<Gear>"),
        (np.array([None, None]), "<array 2>"),
    ],
)  # fmt: skip
def test_a_value_is_written_in_a_few_words(value, text):
    assert brief(value) == text


def test_a_loaded_pair_is_a_sentence_and_its_answers_are_lines():
    """It took 200 lines."""
    gear = Gear(Tooth(23), 3e-3, 15e-3, 10e-3)
    spec = PairSpec(GearPair(gear, gear), (1000.0, 3000.0), compliance="weber-banaschek", neighbour_coupling=False)
    teeth = load(spec)
    said = repr(teeth)
    assert said.startswith("LoadedPair: 23 on 23 teeth, module 3 mm, face width 10 mm, under 3000 N and 1 more. Compl")
    assert "\n" not in said
    assert len(said) < 400
    for answer in (teeth.history(), teeth.transmission_error(), teeth.transmission_error().series[0]):
        assert len(repr(answer).splitlines()) == 1
        assert len(repr(answer)) < 1000


def test_what_a_run_found_is_short_in_every_part():
    found = run(CASE, progress=False)
    assert found.plan is not None
    for one in (found.scene, found.plan, *found.outcomes.values(), *(one.data for one in found.outcomes.values())):
        assert len(repr(one)) < 1500, type(one)
        assert len(repr(one).splitlines()) == 1, type(one)
    assert " figures, 2 notes (" in repr(found)
