"""Young's modulus of plastics: over temperature, under creep, by name; what is refused, what is said."""

import math
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.case.shaft import ShaftInSpacePart
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

CURVE = {"temperature": ["20 degC", "60 degC", "100 degC"], "modulus": ["3 GPa", "1.5 GPa", "1 GPa"]}
PLASTIC = {"poisson_ratio": 0.35, "density": "1410 kg/m^3"}


def scene(material, results=("geometry",), **more):
    gears = {
        "a": {"teeth": 17, "module": "1 mm", "face_width": "8 mm", "bore_radius": "3 mm"},
        "b": {"teeth": 31, "module": "1 mm", "face_width": "8 mm", "bore_radius": "5 mm", "material": material, **more},
    }
    pair = {"driver": "a", "driven": "b", "torque": "0.5 N*m", "speed": "600 rpm"}
    return build_scene({"results": list(results), "gear": gears, "pair": {"I": pair}}, "case", Path())


def modulus(material):
    return scene(material).gears["b"].material.young_modulus


@pytest.mark.parametrize(
    ("at", "expected"), [("20 degC", 3e9), ("60 degC", 1.5e9), ("100 degC", 1e9), ("40 degC", math.sqrt(4.5) * 1e9),
                         ("90 degC", 1e9 * 1.5**0.25), ("140 degF", 1.5e9)],
)  # fmt: skip
def test_the_logarithm_of_the_modulus_runs_straight_between_points(at, expected):
    assert modulus({**PLASTIC, "modulus_over_temperature": CURVE, "temperature": at}) == pytest.approx(
        expected, rel=1e-12
    )


def test_what_is_given_replaces_the_modulus_of_a_name_and_nothing_else():
    named = {"name": "POM", "poisson_ratio": 0.35}
    assert modulus(named) == 2.9e9
    assert modulus({**named, "creep_modulus": "1.1 GPa"}) == 1.1e9
    hot = scene({**named, "modulus_over_temperature": CURVE, "temperature": "60 degC"})
    assert hot.gears["b"].material.young_modulus == pytest.approx(1.5e9)
    assert hot.gears["b"].material.density == 1410.0
    assert hot.gears["a"].material.young_modulus > 200e9


def test_the_run_says_with_which_modulus_it_computed():
    said = [
        " ".join(scene({**PLASTIC, **how}).derived)
        for how in ({"creep_modulus": "1.1 GPa"}, {"modulus_over_temperature": CURVE, "temperature": "60 degC"})
    ]
    assert (
        "Gear b: E = 1.1 GPa (creep_modulus) for long-term loads; vibration depends on the short-term modulus."
        in said[0]
    )
    assert "Gear b: E = 1.5 GPa at 60 degC (modulus_over_temperature), for short-term loads." in said[1]


def test_compliances_are_inverse_to_the_modulus():
    document = {
        "results": ["stiffness"],
        "gear": {"b": {"teeth": 31, "module": "1 mm", "bore_radius": "5 mm", "material": {**PLASTIC}}},
        "accuracy": {"tolerance": 0.3},
    }
    found = []
    for how in ({"young_modulus": "3 GPa"}, {"creep_modulus": "1.5 GPa"},
                {"modulus_over_temperature": CURVE, "temperature": "60 degC"}):  # fmt: skip
        document["gear"]["b"]["material"] = {**PLASTIC, **how}
        tables = fegear.run(document, progress=False).tables
        found.append(np.asarray(tables["stiffness_b"]["c_self"], dtype=float))
    assert found[1] == pytest.approx(2.0 * found[0], rel=1e-9)
    assert found[2] == pytest.approx(found[1], rel=1e-12)


@pytest.mark.parametrize(
    ("material", "key", "rule"),
    [
        ({"modulus_over_temperature": CURVE}, "modulus_over_temperature", "requires temperature"),
        ({"temperature": "60 degC"}, "temperature", "requires modulus_over_temperature"),
        ({"modulus_over_temperature": CURVE, "temperature": "19 degC"}, "temperature", "20 to 100 degC"),
        ({"modulus_over_temperature": CURVE, "temperature": "101 degC"}, "temperature", "20 to 100 degC"),
        ({"modulus_over_temperature": CURVE, "temperature": "60 degC", "creep_modulus": "1 GPa"}, "creep_modulus",
         "contradicts modulus_over_temperature"),
        ({"young_modulus": "3 GPa", "creep_modulus": "1 GPa"}, "creep_modulus", "contradicts young_modulus"),
        ({"creep_modulus": "-1 GPa"}, "creep_modulus", "greater than zero"),
        ({"modulus_over_temperature": {**CURVE, "modulus": ["3 GPa", "1 GPa"]}, "temperature": "60 degC"},
         "modulus_over_temperature.temperature", "3 temperatures for 2 moduli"),
        ({"modulus_over_temperature": {"temperature": ["60 degC", "20 degC"], "modulus": ["1 GPa", "3 GPa"]},
          "temperature": "60 degC"}, "modulus_over_temperature.temperature", "strictly increasing"),
    ],
)  # fmt: skip
def test_moduli_that_make_no_sense_are_refused_by_their_key(material, key, rule):
    with pytest.raises(InputError, match=rule) as refused:
        scene({**PLASTIC, **material})
    assert refused.value.key == f"gear.b.material.{key}"


def test_a_plastic_gear_is_not_rated_and_the_refusal_does_not_advise_a_steel():
    asked = scene({**PLASTIC, "creep_modulus": "1 GPa"}, ["rating"])
    with pytest.raises(InputError, match="VDI 2736") as refused:
        make_plan(asked, STAGES)
    assert refused.value.key == "gear.b.material"


def test_shafts_take_it_too():
    part = ShaftInSpacePart.model_validate({
        "axis": ["0 mm", "0 mm"], "sections": [{"length": "40 mm", "outer": "8 mm"}],
        "material": {**PLASTIC, "creep_modulus": "1 GPa"},
    })  # fmt: skip
    assert part.build().young_modulus == 1e9
    assert part.build(rigid=True).young_modulus == math.inf
