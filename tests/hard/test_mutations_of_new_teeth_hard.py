"""Random mutations of asymmetric teeth, fillets, double helical pairs, plastics: one sentence, or finite numbers.

Each case says under which tables keys are mutated; what is computed is the geometry, and what a run would check.
Seeded: a number is always the same mutation.
"""

from __future__ import annotations

import copy
import random
import traceback
import warnings
from pathlib import Path

import numpy as np
import pytest
from mutations import failures, mutated, processor_seconds, reached, sentence

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

BOTH = {"pressure_angle": "28 deg", "coast_pressure_angle": "18 deg", "face_width": "20 mm"}
ASYMMETRIC = {
    "p": {"teeth": 23, "module": "4 mm", **BOTH, "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.25},
          "profile_shift": 0.3, "thickness_allowance": "40 um",
          "relief": {"tip": {"amount": "10 um", "length": "2 mm"}},
          "coast_relief": {"tip": {"amount": "5 um", "length": "1 mm"}}},
    "w": {"teeth": 41, "module": "4 mm", **BOTH, "rack": {"tip_radius": 0.15}, "thickness_allowance": "40 um"},
    "r": {"internal": True, "teeth": 60, "module": "4 mm", **BOTH, "profile_shift": -0.3, "tip_diameter": "236 mm",
          "thickness_allowance": "80 um", "rim_thickness": "16 mm",
          "cutter": {"teeth": 25, "profile_shift": 0.1, "tip_radius": 0.1, "coast_tip_radius": 0.15}},
}  # fmt: skip
TURNED = {
    name: {"teeth": teeth, "normal_module": "3 mm", **BOTH, "helix_angle": "16 deg", "hand": hand,
           "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.25}, "thickness_allowance": "40 um"}
    for name, teeth, hand in (("p", 23, "right"), ("w", 37, "left"))
}  # fmt: skip
TURNED["w"] |= {
    "lead": {"slope": "8 um", "end_relief": [{"amount": "4 um", "length": "3 mm", "end": "I"}]},
    "coast_lead": {"crowning": "3 um", "slope": "-5 um"},
}
SHAPED = {
    "p": {"teeth": 28, "module": "3 mm", "face_width": "10 mm",
          "fillet": {"kind": "ellipse", "form_diameter": "80 mm", "root_diameter": "76.6 mm"}},
    "w": {"teeth": 40, "module": "3 mm", "face_width": "10 mm"},
}  # fmt: skip
HELICAL = {
    name: {"teeth": teeth, "normal_module": "3 mm", "pressure_angle": "20 deg", "helix_angle": "28 deg", "hand": hand,
           "face_width": "12 mm"}
    for name, teeth, hand in (("p", 23, "right"), ("w", 47, "left"))
}  # fmt: skip
PLASTIC = {
    "p": {"teeth": 20, "module": "1 mm", "face_width": "8 mm", "material": {
        "name": "POM", "poisson_ratio": 0.4, "temperature": "60 degC",
        "modulus_over_temperature": {"temperature": ["20 degC", "60 degC", "100 degC"],
                                     "modulus": ["2.8 GPa", "1.6 GPa", "0.8 GPa"]}}},
    "w": {"teeth": 31, "module": "1 mm", "face_width": "8 mm",
          "material": {"poisson_ratio": 0.4, "creep_modulus": "1.4 GPa"}},
}  # fmt: skip
PAIR = {"driver": "p", "driven": "w", "load": "1 kN"}
DOUBLE = {
    "gap": "20 mm", "apex_offset": "8 um", "stagger": 0.5, "floating": "driver", "axial_play": "0.1 mm",
    "axial_force": "100 N",
}  # fmt: skip
DESIGN = {
    "pair": "I", "gear": "w", "other_pair": "II", "objective": "alternating", "clearance": "60 um",
    "minimum_radius": "0.4 mm", "waves": 3, "searches": 2,
}  # fmt: skip
RING = {"internal": True, "teeth": 90, "module": "3 mm", "cutter": {"teeth": 25}, "face_width": "10 mm"}
#: A case, the results that it asks for, and the place of what is mutated.
CASES = {
    "asymmetric pinion": ({"gear": ASYMMETRIC, "pair": {"I": PAIR}}, ("geometry", "load-sharing"), ("gear", "p")),
    "asymmetric ring": (
        {"gear": ASYMMETRIC, "pair": {"I": PAIR | {"driven": "r"}}}, ("geometry", "load-sharing"), ("gear", "r")),
    "asymmetric idler": (
        {"gear": ASYMMETRIC, "pair": {"I": PAIR | {"driver": "w", "driven": "p"}, "II": PAIR | {"driven": "r"}}},
        ("geometry", "idler-root-stress"), ("pair",)),
    "asymmetric helical": (
        {"gear": TURNED, "pair": {"I": PAIR | {"width": "slices"}}}, ("geometry", "load-distribution"), ("gear", "w")),
    "asymmetric pair": ({"gear": ASYMMETRIC, "pair": {"I": PAIR | {"flank": "coast"}}}, ("geometry",), ("pair", "I")),
    "fillet": ({"gear": SHAPED, "pair": {"I": PAIR}}, ("geometry", "root-stress-history"), ("gear", "p")),
    "fillet design": (
        {"gear": SHAPED | {"r": RING}, "pair": {"I": PAIR, "II": PAIR | {"driver": "w", "driven": "r"}},
         "fillet_design": DESIGN}, ("fillet-design",), ("fillet_design",)),
    "double helical": (
        {"gear": HELICAL, "pair": {"I": PAIR | {"double_helical": DOUBLE}}}, ("double-helical",), ("pair", "I")),
    "plastic": ({"gear": PLASTIC, "pair": {"I": PAIR | {"load": "50 N"}}}, ("geometry", "load-sharing"), ("gear",)),
}  # fmt: skip


def judge(number):
    """Empty if a mutation is refused in a sentence, or gives a plan and finite geometry."""
    draw = random.Random(number)  # noqa: S311
    document, results, place = CASES[sorted(CASES)[number % len(CASES)]]
    document = copy.deepcopy(document) | {"results": list(results), "effects": {"relief": True}}
    reached(document, place[:-1])[place[-1]] = mutated(reached(document, place), draw)
    try:
        with warnings.catch_warnings(), processor_seconds(20.0):
            warnings.simplefilter("error")
            scene = build_scene(document, "new", Path())
            make_plan(scene, STAGES)
            if results[0] == "geometry":
                only = build_scene(document | {"results": ["geometry"]}, "new", Path())
                found = run_plan(only, make_plan(only, STAGES))
                assert all(np.isfinite(value.si) for value in found.values), str(found.values)
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001  (any other is what is looked for)
        return traceback.format_exc(limit=-4)
    return ""


@pytest.mark.parametrize("name", CASES)
def test_the_cases_that_are_mutated_plan(name):
    document, results, _ = CASES[name]
    assert make_plan(build_scene(document | {"results": list(results)}, name, Path()), STAGES).steps


def test_a_sample_of_mutations_is_refused_in_a_sentence_or_answered():
    assert failures(judge, range(0, 700, 35)) == ""


@pytest.mark.long
def test_mutations_are_refused_in_a_sentence_or_answered():
    assert failures(judge, range(700)) == ""
