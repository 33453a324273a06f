"""REXS models as cases, there and back, and changed attribute by attribute."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
from rexs_models import in_json, part

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of
from fegear.exchange.rexs.written_gearbox import model_text
from fegear.results.catalogue import STAGES

HERE = Path("model.rexs")


def text_of(tree: dict) -> str:
    return case_of(model_of(in_json(tree), Path("model.rexs")))


def case(tree: dict) -> dict:
    """The case, which can be planned."""
    found = tomllib.loads(text_of(tree))
    make_plan(build_scene(found, "case", Path()), STAGES)
    return found


def put(tree: dict, number: int, **attributes: object) -> dict:
    """The model with attributes of a component set."""
    made = part(0, "", **attributes)
    parts = [
        {**one, "attributes": [*(a for a in one["attributes"] if a["id"] not in attributes), *made["attributes"]]}
        if one["id"] == number else one
        for one in tree["components"]
    ]  # fmt: skip
    return {**tree, "components": parts}


def more(tree: dict, *components: dict, relations: tuple[dict, ...] = (), drop: tuple[int, ...] = ()) -> dict:
    links = [one for one in tree["relations"] if one["id"] not in drop]
    return {**tree, "components": [*tree["components"], *components], "relations": [*links, *relations]}


def there_and_back(scene):
    """A scene written and read again, and what was left out."""
    text, remarks = model_text(scene, "2026-01-01T00:00:00")
    return build_scene(tomllib.loads(case_of(model_of(text, HERE))), scene.name, Path()), remarks


def imported(tree):
    return build_scene(tomllib.loads(case_of(model_of(in_json(tree), HERE))), "case", Path())


def same(one, other):
    """Equal to rounding of what is written with 15 digits, down to what dataclasses and case tables hold."""
    if hasattr(one, "model_dump"):
        return same(one.model_dump(), other.model_dump())
    if hasattr(one, "__dataclass_fields__"):
        return type(one) is type(other) and all(
            same(getattr(one, key), getattr(other, key)) for key in one.__dataclass_fields__
        )
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float | np.ndarray):
        return other is not None and np.allclose(one, other, rtol=1e-11, atol=1e-15, equal_nan=True)
    return one == other
