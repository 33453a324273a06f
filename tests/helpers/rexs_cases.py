"""REXS models as cases, there and back, and changed attribute by attribute."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
from rexs_models import in_json, part, two_stages

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


def with_all_of_a_flank():
    """Two stages whose first gear has a tool with protuberance, reliefs, a crown, a material, oil and K_A."""
    document = tomllib.loads(case_of(model_of(in_json(two_stages()), HERE)))
    document["gear"]["gear_11"] |= {
        "rack": {"dedendum": 1.4, "tip_radius": 0.3, "protuberance": 0.05, "grinding_allowance": 0.03},
        "relief": {"tip": [{"amount": "8 um", "start_radius": "20.7 mm"}, {"amount": "2 um", "length": "0.8 mm",
                   "shape": "parabolic"}], "crowning": [{"amount": "3 um"}]},
        "lead": {"crowning": "4 um", "slope": "-6 um", "end_relief": [
            {"amount": "9 um", "length": "4 mm", "end": "I"},
            {"amount": "7 um", "length": "3 mm", "end": "II", "shape": "parabolic"}]},
        "tip_diameter": "44.4 mm", "tip_chamfer": "0.1 mm",
        "strength": {"material": "nitrided-nitriding-steel", "hardness": "700 HV", "contact": "1250 MPa"},
        "roughness": {"flank": "0.4 um", "root_rz": "9 um"}, "tolerance_class": 4, "bore_radius": "12 mm",
    }  # fmt: skip
    document["pair"]["I"] |= {
        "operation": {"application_factor": 1.35, "life": "8000 h"},
        "lubricant": {"viscosity_40": "150 mm^2/s", "kind": "polyglycol", "temperature": "80 degC"},
    }  # fmt: skip
    document["pair"]["II"]["operation"]["life"] = "8000 h"
    document["bearing"]["bearing_52"] = {
        "elements": {"kind": "ball", "count": 9, "diameter": "8 mm", "pitch_diameter": "39 mm", "clearance": "12 um"},
        "life": {"dynamic_rating": "14 kN", "axial_factor": 1.6, "limit": 0.27, "radial_factor": 0.56},
    }  # fmt: skip
    document["bearing"]["bearing_54"] = {"radial": "300 N/um", "radial_clearance": "10 um"}
    document["shaft"]["shaft_5"] |= {
        "sections": [{"length": "70 mm", "outer": "40 mm", "inner": "10 mm"},
                     {"length": "50 mm", "outer": "44 mm", "outer_end": "36 mm"}],
        "loads": [{"at": "118 mm", "force": ["100 N", "-800 N", "25 N"], "moment": ["3 N*m", "0 N*m", "0 N*m"]}],
        "material": {"young_modulus": "190 GPa"},
    }  # fmt: skip
    document["gear"]["gear_12"]["lead"] = {"slope": "5 um"}
    document["shaft"]["shaft_4"]["rigid"] = True
    return build_scene(document, "case", Path())
