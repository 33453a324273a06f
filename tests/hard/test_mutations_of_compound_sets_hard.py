"""Random mutations of planetary sets described as data: one sentence, or a set whose numbers are finite.

The mutator is seeded, so that what it finds can be found again: number `n` is always the same mutation.
"""

from __future__ import annotations

import random
import traceback
import warnings
from pathlib import Path

import numpy as np
import pytest
from mutations import failures, mutated, processor_seconds, sentence

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

BODY = {"mass": "2 kg", "inertia": "0.01 kg*m^2"}
TEETH = {"s1": 26, "p1": 21, "s2": 34, "p2": 20, "r": 74, "big": 36, "r2": 82}
GEARS = {
    name: {"teeth": teeth, "module": "1.5 mm", "face_width": "20 mm",
           **({"internal": True, "cutter": {"teeth": 25}} if name.startswith("r") else {})}
    for name, teeth in TEETH.items()
}  # fmt: skip
SETS = [
    {
        "fixed": "c", "input": "s1", "output": "r", "torque": "100 N*m", "speed": "1500 rpm", "clockwise": True,
        "harmonics": 6,
        "search": {"ratio": 2.846, "tolerance": 0.02, "coaxial": 0.5, "clearance": 1.5, "most": 4, "teeth": {
            "s1": [25, 27], "p1": [20, 22], "s2": [33, 35], "p2": [19, 21], "r": [72, 76]}},
        "shaft": {"s1": {"bearing": "0 N/m"}, "s2": {"bearing": "100 N/um"}, "r": {"turning": "1e6 N*m/rad"},
                  "c": {"body": BODY, "bearing": "200 N/um"}},
        "planet": {"p1": {"carrier": "c", "planets": 3, "pin": "200 N/um"},
                   "p2": {"carrier": "c", "planets": 3, "first_angle": "47.2744754615 deg", "body": BODY}},
        "mesh": [{"gears": ["s1", "p1"], "stiffness": "300 N/um", "efficiency": 0.99},
                 {"gears": ["p1", "p2"], "stiffness": "310 N/um"}, {"gears": ["s2", "p2"], "stiffness": "320 N/um"},
                 {"gears": ["r", "p2"], "stiffness": "330 N/um", "efficiency": 0.985}],
    },
    {
        "fixed": ["ring"], "input": "sun", "torque": "50 N*m",
        "shaft": {"sun": {"gears": "s1"}, "ring": {"gears": ["r2"]}, "c": {"body": BODY, "bearing": "50 N/um"}},
        "planet": {"step": {"carrier": "c", "gears": ["big", "p2"], "angles": ["0 deg", "180 deg"], "pin": "90 N/um",
                            "centre_distance": "46.5 mm"}},
        "mesh": [{"gears": ["sun", "step.big"], "stiffness": "300 N/um"},
                 {"gears": ["step.p2", "ring"], "stiffness": "300 N/um"}],
    },
    {
        "shaft": {"sun": {"gears": ["s1", "s2"], "body": BODY, "bearing": "1 N/um"}, "r": {}, "out": {"body": BODY},
                  "c": {"body": BODY}},
        "planet": {"p2": {"carrier": "out", "planets": 4}, "rear": {"carrier": "c", "gears": "p2", "planets": 3}},
        "mesh": [{"gears": ["sun.s2", "p2"], "stiffness": "300 N/um"}, {"gears": ["r", "p2"], "stiffness": "3 N/um"},
                 {"gears": ["sun.s2", "rear"], "stiffness": "300 N/um"}],
    },
]  # fmt: skip


def case(own):
    """A case with one set, all that can be asked of it."""
    results = ["compound-set", "compound-modes", *(["tooth-numbers"] if "search" in own else [])]
    return {"results": results, "gear": GEARS, "compound": {"R": own}}


def described(number):
    """A case with a set of which some keys are mutated."""
    draw = random.Random(number)  # noqa: S311
    own = draw.choice(SETS)
    part = draw.choice(
        [key for key in ("shaft", "planet", "mesh", "search", "search", "all") if key in own or key == "all"]
    )
    made = mutated(own, draw) if part == "all" else {**own, part: mutated({part: own[part]}, draw).get(part, {})}
    return case(made)


def run(document):
    """Results of a case, all of whose numbers but blank ones are finite."""
    scene = build_scene(document, "mutated", Path())
    results = run_plan(scene, make_plan(scene, STAGES))
    assert all(np.isfinite(value.si) for value in results.values)
    return results


def judge(number):
    """Empty if a mutation is refused in a sentence, or gives a set with finite numbers."""
    try:
        with processor_seconds(20.0), warnings.catch_warnings():
            warnings.simplefilter("error")
            run(described(number))
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001  (any other is what is looked for)
        return traceback.format_exc(limit=-4)
    return ""


@pytest.mark.dear
def test_sets_that_are_not_mutated_run():
    for own in SETS:
        assert run(case(own))


@pytest.mark.dear
def test_a_sample_of_mutated_sets_is_refused_in_a_sentence_or_answered():
    assert failures(judge, range(0, 500, 25)) == ""


@pytest.mark.long
def test_mutated_sets_are_refused_in_a_sentence_or_answered():
    assert failures(judge, range(500)) == ""
