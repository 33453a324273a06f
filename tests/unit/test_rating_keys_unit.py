"""Keys of a rating: what they read, and what they refuse in a sentence."""

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene


def scene(gear=None, pair=None):
    a = {"teeth": 28, "module": "1 mm"} | (gear or {})
    return build_scene(
        {
            "results": ["geometry"],
            "gear": {"a": a},
            "pair": {"I": {"driver": "a", "driven": "a", "load": "10 N"} | (pair or {})},
        },
        "case",
        None,
    )


CASE = "case-hardened-steel"


@pytest.mark.parametrize(
    ("text", "vickers"),
    [
        ("700 HV", 700.0),
        ("285 HBW", 300.0),
        ("20.3 HRC", 240.0),
        ("60.1 HRC", 700.0),
        ("60 HRC", 697.5),
        ("68 HRC", 940.0),
    ],
)
def test_hardness_is_read_in_every_scale(text, vickers):
    part = scene({"strength": {"material": CASE, "hardness": text}}).case.gear["a"].strength
    assert part.hardness == pytest.approx(vickers, rel=1e-12)


@pytest.mark.parametrize(
    ("gear", "pair", "key", "said"),
    [
        ({"material": CASE, "hardness": "70 HRC"}, None, "gear.a.strength.hardness", "between 20.3 and 68 HRC"),
        ({"material": CASE, "hardness": "60 N"}, None, "gear.a.strength.hardness", "is not a hardness"),
        ({"hardness": "60 HRC"}, None, "gear.a.strength.material", "is required"),
        ({"material": "steel"}, None, "gear.a.strength.material", "must be 'normalized-steel'"),
        ({"material": CASE, "bending": "1 MPa", "bending_allowable": "2 MPa"}, None,
         "gear.a.strength.bending_allowable", "contradicts bending"),
        ({"material": "grey-iron", "core_hardness": "25 HRC"}, None, "gear.a.strength.core_hardness",
            "applies only to surface-hardened steel"),
        ({"material": CASE, "tensile_strength": "1 GPa"}, None, "gear.a.strength.tensile_strength", "cast iron"),
        ({"material": CASE, "contact": "1500 Pa"}, None, "gear.a.strength.contact",
            "is outside the range of gear materials,"),
        ({"material": CASE, "bending": "500 GPa"}, None, "gear.a.strength.bending", "check the unit"),
        ({"material": CASE, "long_life": 1.1}, None, "gear.a.strength.long_life", "less than or equal to 1"),
        (None, {"life": "1 h", "load_cycles": 5}, "pair.I.operation.load_cycles", "contradicts life"),
        (None, {"contacts": [1]}, "pair.I.operation.contacts", "must be two numbers, for driver and driven gear"),
        (None, {"application_factor": 0}, "pair.I.operation.application_factor", "greater than 0"),
        (None, {"application_factor": 125}, "pair.I.operation.application_factor", "above the plausible maximum of 10"),
        (None, {"mesh_load_factor": 12}, "pair.I.operation.mesh_load_factor", "above the plausible maximum of 10"),
        (None, {"load_cycles": 0.5}, "pair.I.operation.load_cycles", "greater than or equal to 1"),
        (None, {"dynamic_factor": 0.9}, "pair.I.operation.dynamic_factor", "greater than or equal to 1"),
        (None, {"spectrum": [{"load_factor": 1, "share": 0.9}]}, "pair.I.operation.spectrum", "add up to 0.9"),
        (None, {"spectrum": [{"share": 1}]}, "pair.I.operation.spectrum[0].torque", "is required, or load_factor"),
        (None, {"spectrum": [{"load_factor": 1, "torque": "1 N m", "share": 1}]},
         "pair.I.operation.spectrum[0].load_factor", "contradicts torque"),
        (None, {"spectrum": [{"load_factor": 1, "share": 1}, {"load_factor": 1, "time": "1 h"}]},
         "pair.I.operation.spectrum", "must not mix"),
        (None, {"spectrum": []}, "pair.I.operation.spectrum", "must not be empty"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused_with_its_key(gear, pair, key, said):
    with pytest.raises(InputError) as caught:
        scene({"strength": gear} if gear else None, {"operation": pair} if pair else None)
    assert caught.value.key == key
    assert said in str(caught.value)


def test_shafts_ask_for_what_the_formula_needs():
    with pytest.raises(InputError, match="arrangement"):
        scene(pair={"shafts": {"bearing_span": "100 mm", "offset": "0 mm", "diameter": "30 mm"}})
