"""Damaged REXS models: a case that can be planned or refused in words, or one sentence; never a traceback."""

from __future__ import annotations

import copy
import json
import random
import tomllib
from collections import Counter
from pathlib import Path

import pytest
from rexs_models import planetary_set, two_stages

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.exchange.rexs.gearbox import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.results.catalogue import STAGES

_VALUES = (0, -1, 1e300, -1e-300, "", "x", None, [], {}, [1, 2], True, 1e9, "1e999", "nan")
_UNITS = ("", "mm", "rad", "N", "kg", "1/min")
_TYPES = ("shaft", "cylindrical_gear", "ring_gear", "external_load", "x", "planetary_stage", "concept_bearing")


def damaged(seed: int) -> dict:
    """A model with one to three things wrong."""
    draw = random.Random(seed)  # noqa: S311
    tree = copy.deepcopy(draw.choice((two_stages, planetary_set))())
    parts, links = tree["components"], tree["relations"]
    for _ in range(draw.randint(1, 3)):
        part, what = draw.choice(parts), draw.random()
        if what < 0.4 and part["attributes"]:
            one = draw.choice(part["attributes"])
            key = "float" if "float" in one else "value"
            number = isinstance(one[key], int | float)
            one[key] = draw.choice((*_VALUES, *((one[key] * f for f in (-1, 10, 0.1, 1e6)) if number else ())))
            one["unit"] = draw.choice((one["unit"], one["unit"], *_UNITS)) if "unit" in one else ""
        elif what < 0.5 and part["attributes"]:
            part["attributes"].remove(draw.choice(part["attributes"]))
        elif what < 0.6:
            part["type"] = draw.choice(_TYPES)
        elif what < 0.7:
            part["id"] = draw.choice([*(one["id"] for one in parts), 10**30, -1])
        elif what < 0.8:
            links.remove(draw.choice(links))
        elif what < 0.9:
            draw.choice(draw.choice(links)["refs"])["id"] = draw.choice(parts)["id"]
        else:
            draw.choice(links)["type"] = draw.choice(("assembly", "stage", "side", "reference"))
    return tree


@pytest.mark.parametrize(("first", "count"), [(0, 60), pytest.param(60, 2000, marks=pytest.mark.long)])
def test_damaged_rexs_models_end_in_a_case_or_a_sentence(first, count):
    ends = Counter()
    for seed in range(first, first + count):
        try:
            found = tomllib.loads(case_of(model_of(json.dumps({"model": damaged(seed)}), Path("model.rexs"))))
            make_plan(build_scene(found, "case", Path()), STAGES)
            ends["planned"] += 1
        except FegearError as refusal:
            ends["refused" if "\n" not in str(refusal) else str(refusal)] += 1
    assert set(ends) == {"planned", "refused"}
    assert min(ends["planned"], ends["refused"]) > 0.1 * count
