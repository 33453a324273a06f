"""Result flank-fracture: what it reads, refuses, finds and says."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.results.rating.flank_fracture import _of_pair
from fegear.workbench.run import run

CASE = {"material": "case-hardened-steel", "hardness": "60 HRC", "core_hardness": "32 HRC", "case_depth": "0.8 mm"}
SOFT = {"material": "through-hardened-alloy-steel", "hardness": "300 HV", "core_hardness": None}


def case(strength=None, results=("flank-fracture",), **pair):
    gear = {
        "module": "4 mm", "face_width": "40 mm", "tolerance_class": 6, "strength": CASE | (strength or {}),
        "roughness": {"flank_rz": "4.8 um", "root_rz": "16 um"},
    }  # fmt: skip
    gear["strength"] = {key: value for key, value in gear["strength"].items() if value is not None}
    return {
        "results": list(results),
        "gear": {"a": {"teeth": 21, "profile_shift": 0.35} | gear, "b": {"teeth": 62} | gear},
        "pair": {
            "I": {
                "driver": "a", "driven": "b", "torque": "520 N*m", "speed": "1480 rpm",
                "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "70 degC"},
            } | pair
        },
    }  # fmt: skip


def numbers(*args, **changes):
    found = run(case(*args, **changes), progress=False)
    return {value.name.removeprefix("I."): value.si for value in found.values}, found


def columns(found, name):
    (table,) = (table for table in found.tables if table.name == name)
    return {column.name: np.asarray(column.si) for column in table.columns}


def test_pressure_over_the_path_is_that_of_iso_6336_22_and_contact_stress_at_the_pitch_point():
    values, found = numbers(results=("flank-fracture", "rating"))
    path, rating = columns(found, "flank_fracture_I"), {v.name: v.si for v in found.values}
    at_pitch = int(np.abs(path["x"]).argmin())
    assert path["x"][at_pitch] == 0.0
    # sigma_H of the wheel (Z_D = 1) is that at C with Z_epsilon: one pair alone bears the load there
    (table,) = (t for t in found.tables if t.name == "rating_I")
    shown = {c.name: c.si for c in table.columns}
    factor = dict(zip(shown["symbol"], shown["driven"], strict=True))
    pitch = rating["I.driven.sigma_H"] / factor["Z_epsilon"]
    assert path["hertz_pressure"][at_pitch] == pytest.approx(pitch, rel=1e-3)
    assert path["half_width"] == pytest.approx(
        4.0 * path["relative_radius"] * path["hertz_pressure"] * (1.0 - 0.3**2) / 206.8e9, rel=1e-9
    )
    assert values["driver.S_FF"] == pytest.approx(1.0 / values["driver.A_FF"])
    assert values["driver.A_FF"] == pytest.approx(path["exposure_driver"].max())
    assert values["driver.A_FF"] <= values["driver.A_FF_load"]
    assert len([figure for figure in found.figures if "flank_fracture" in figure.name]) == 2


def test_a_deeper_case_is_exposed_less_and_a_larger_load_more():
    shallow, deep = (numbers({"case_depth": text})[0] for text in ("0.4 mm", "1.2 mm"))
    assert deep["driver.A_FF_load"] < shallow["driver.A_FF_load"]
    less, more = (numbers(operation={"application_factor": k})[0] for k in (1.0, 2.0))
    assert more["driver.A_FF"] > less["driver.A_FF"]
    strong = numbers(iso_6336={"flank_fracture_material_factor": 1.13})[0]
    assert strong["driver.A_FF"] - 0.04 == pytest.approx((less["driver.A_FF"] - 0.04) / 1.13, rel=1e-9)


def test_measured_profiles_take_the_place_of_the_curves():
    profile = {"depth": ["0 mm", "0.5 mm", "1 mm", "2 mm"], "hardness": ["720 HV", "650 HV", "500 HV", "330 HV"]}
    residual = {"depth": ["0 mm", "5 mm"], "stress": ["0 MPa", "0 MPa"]}
    values, found = numbers({"hardness_profile": profile, "residual_stress": residual, "case_depth": None})
    assert values["driver.case_depth"] == pytest.approx(0.5e-3 + 0.5e-3 * 100.0 / 150.0)
    assert values["driver.A_FF"] == pytest.approx(values["driver.A_FF_load"], rel=1e-12)
    assert not any("Lang" in remark for remark in found.remarks)
    below = columns(found, "flank_fracture_I_driver")
    assert below["hardness"][0] == 720.0
    assert below["strength"] == pytest.approx(0.4e6 * below["hardness"])


def test_what_falls_short_is_said_first_and_what_is_recalled_always():
    _, found = numbers({"case_depth": "0.3 mm"}, operation={"application_factor": 4.0})
    told = " ".join(found.remarks)
    assert "is above the permissible 0.8" in told
    assert "mm required against case crushing." in told
    assert "Not verified against a source" in told
    _, found = numbers({"case_depth": "2 mm"})
    assert "exceeds 1.6 mm" in " ".join(found.remarks)
    _, found = numbers({"material": "induction-hardened-steel", "hardness": "55 HRC"})
    assert "extrapolation" in " ".join(found.remarks)


@pytest.mark.parametrize(
    ("strength", "key", "said"),
    [
        ({"case_depth": None}, "strength.case_depth", "is required for flank fracture"),
        ({"core_hardness": None}, "strength.core_hardness", "is required: core hardness below the case"),
        ({"core_hardness": "560 HV"}, "strength.core_hardness", "below the 550 HV"),
        ({"hardness": "500 HV", "contact": "1400 MPa", "bending": "450 MPa"}, "strength.hardness", "above the 550 HV"),
        (SOFT, "strength.case_depth", "surface-hardened"),
        (SOFT | {"case_depth": None}, "strength.material", "has no hardened case"),
        ({"hardness_profile": {"depth": ["0 mm", "1 mm"], "hardness": ["700 HV"] * 3}}, "depth",
            "specify one value for each depth"),
        ({"hardness_profile": {"depth": ["1 mm", "1 mm"], "hardness": ["700 HV"] * 2}}, "depth",
            "must be strictly increasing"),
        ({"residual_stress": {"depth": ["0 mm", "1 mm"], "stress": ["0 MPa", "-400 GPa"]}}, "stress",
            "exceeds the residual stress of any steel,"),
    ],
)  # fmt: skip
def test_a_case_that_cannot_be_rated_is_refused_under_its_key(strength, key, said):
    with pytest.raises(InputError) as refused:
        numbers(strength)
    assert key in str(refused.value)
    assert said in str(refused.value)


def test_helical_pairs_are_rated_too():
    gear = {"normal_module": "4 mm", "helix_angle": "15 deg", "face_width": "60 mm", "strength": CASE}
    changed = case()
    changed["gear"] = {
        "a": {"teeth": 21, "hand": "right"} | gear, "b": {"teeth": 62, "hand": "left"} | gear,
    }  # fmt: skip
    found = run(changed, progress=False)
    values = {value.name: value.si for value in found.values}
    assert 0.04 < values["I.driver.A_FF"] < values["I.driver.A_FF_load"] < 2.0
    assert math.isfinite(values["I.driver.case_depth_crushing"])


def test_a_spectrum_is_rated_at_its_largest_level():
    spectrum = [{"load_factor": 1.5, "share": 0.1}, {"load_factor": 0.5, "share": 0.9}]
    values, found = numbers(operation={"spectrum": spectrum, "life": "1000 h"})
    alone, _ = numbers(torque="780 N*m")
    assert values["driver.A_FF"] == pytest.approx(alone["driver.A_FF"], rel=1e-9)
    assert values["driver.case_depth_crushing"] == pytest.approx(alone["driver.case_depth_crushing"], rel=1e-9)
    assert any("maximum level of the load spectrum, 1.5 times" in remark for remark in found.remarks)


@pytest.mark.parametrize(
    ("of_third", "said"),
    [
        (
            {"strength": {"material": "through-hardened-alloy-steel", "hardness": "300 HV"}},
            "has no hardened case: flank fracture applies to surface-hardened teeth",
        ),
        ({"rim_thickness": "3 mm"}, "rim thickness / tooth height"),
    ],
)
def test_a_pair_that_is_not_evaluated_takes_no_other_with_it(of_third, said):
    """The whole run was refused; alone the pair still is."""
    document = case()
    document["gear"]["c"] = document["gear"]["b"] | {"teeth": 45} | of_third
    document["pair"]["II"] = document["pair"]["I"] | {"driven": "c"}
    found = run(document, progress=False)
    (remark,) = (one for one in found.remarks if " not evaluated:" in one)
    assert remark.startswith("Flank fracture of pair II not evaluated: ")
    assert said in remark
    alone = run(case(), progress=False)
    assert [v for v in found.values if v.name.startswith("I.")] == [*alone.values]
    assert not [v for v in found.values if v.name.startswith("II.")]
    del document["pair"]["I"]
    with pytest.raises(InputError, match=said):
        run(document, progress=False)


def test_the_quality_of_each_gear_is_that_of_its_material():
    """Of a gear without one MQ; a formula that asks for it sees those of pinion and wheel in this order."""
    document = case()
    for name, strength in (("a", CASE | {"quality": "ME"}), ("b", CASE)):
        document["gear"][name] = document["gear"][name] | {"strength": strength}
    assert _of_pair(build_scene(document, "case", Path()), "I").qualities == ("ME", "MQ")
