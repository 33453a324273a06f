"""A thin rim whose bore is fixed all round is said, and what to do; gears of plastics are no case-hardened steel."""

import math
from pathlib import Path
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.case.built.gear_strength import gear_strength
from fegear.case.built.rated_duty import bore_remarks
from fegear.case.reading import build_scene
from fegear.contact.compared.rated_gears import rated_spur_pair
from fegear.fem.solid.settings import solid_settings
from fegear.formulas.iso6336.part3_pair import RatingChoice
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.gear_body import GearBody
from fegear.results.gear.crosscheck_iso import iso_inputs
from fegear.results.gear.solved_gear import _present_solid

ROOT = 38.25  # root radius of 28 teeth of 3 mm


def scene(gear=None, results="geometry", **more):
    a = {"teeth": 28, "module": "3 mm", "face_width": "10 mm"} | (gear or {})
    case = {"results": [results], "gear": {"a": a, "b": {"teeth": 28, "module": "3 mm", "face_width": "10 mm"}}}
    return build_scene(
        case | {"pair": {"I": {"driver": "a", "driven": "b", "torque": "60 N*m", **more}}}, "case", Path()
    )


@pytest.mark.parametrize(("backup", "thin"), [(0.3, True), (0.7, True), (1.19, True), (1.21, False), (3.0, False)])
def test_a_rim_below_one_and_a_fifth_of_the_teeth_is_said_with_its_remedy(backup, thin):
    bore = ROOT - backup * 6.75
    said = bore_remarks(scene({"bore_radius": f"{bore} mm"}), "a")
    assert bool(said) == thin
    if thin:
        (text,) = said
        assert f"rim of {backup:.2g} tooth depths (below 1.2)" in text
        assert "root stress and deflection are underestimated" in text
        assert "body" in text
        assert 'width = "solid"' in text


def test_an_assumed_bore_and_a_ring_have_no_such_note():
    assert "underestimated" not in " ".join(bore_remarks(scene(), "a"))
    ring = {"internal": True, "teeth": 60, "cutter": {"teeth": 20}, "tip_diameter": "175.5 mm", "rim_thickness": "3 mm"}
    case = {"results": ["geometry"], "gear": {"r": {"module": "3 mm", "face_width": "10 mm", **ring}}}
    assert bore_remarks(build_scene(case, "case", Path()), "r") == ()


def test_crosscheck_refuses_a_rim_that_rating_refuses():
    """Y_B is defined above 0.5 tooth depths; such a gear counted as solid (Y_B = 1) in crosscheck."""
    made = scene({"bore_radius": f"{ROOT - 0.3 * 6.75} mm"}, "crosscheck")
    asked = iso_inputs(made, "I", None)
    assert any("no ISO 6336 root stress in crosscheck for gear a" in text for text in asked.said)
    assert asked.rims[0] == pytest.approx(0.3 * 6.75e-3, rel=1e-9)
    assert asked.rims[1] is None
    solid = [type("Known", (), {"largest_root_stress": lambda *_: ([1.0],)})()] * 2
    found = rated_spur_pair(made.pairs["I"], solid, 1e5, RatingChoice(2006, 6), asked.rims)
    thin, other = found.gears
    assert thin.rating.value is None
    assert math.isnan(thin.form_stress)
    assert "must exceed 0.5" in thin.reason
    assert other.rating.value.rim == 1.0


def test_a_rim_that_y_b_knows_is_taken_by_crosscheck():
    asked = iso_inputs(scene({"bore_radius": f"{ROOT - 0.7 * 6.75} mm"}, "crosscheck"), "I", None)
    assert asked.rims[0] == pytest.approx(0.7 * 6.75e-3, rel=1e-9)


OWN = {"material": "case-hardened-steel", "contact": "40 MPa", "bending": "30 MPa"}


@pytest.mark.parametrize("modulus", ["2.8 GPa", "45 GPa"])
def test_plastics_are_not_rated_as_steel(modulus):
    gear = {"strength": OWN, "material": {"young_modulus": modulus, "poisson_ratio": 0.35, "density": "1410 kg/m^3"}}
    with pytest.raises(InputError, match="steel and iron") as refused:
        gear_strength(scene(gear), "a", [])
    assert refused.value.key == "gear.a.strength.material"
    assert "VDI 2736" in str(refused.value)


@pytest.mark.parametrize(
    ("material", "modulus", "noted"),
    [
        ("case-hardened-steel", "206 GPa", False),
        ("case-hardened-steel", "175 GPa", False),
        ("case-hardened-steel", "120 GPa", True),
        ("grey-iron", "75 GPa", False),
    ],
)
def test_a_modulus_below_that_of_steels_is_said(material, modulus, noted):
    said = []
    numbers = {"contact": "400 MPa", "bending": "80 MPa", "hardness": "200 HV"}
    gear = {"strength": {"material": material, **numbers}, "material": {"young_modulus": modulus}}
    gear_strength(scene(gear), "a", said)
    assert any("below that of any steel" in text for text in said) == noted


@pytest.mark.parametrize(("bore", "body", "noted"), [(36.0, None, True), (20.0, None, False), (20.0, GearBody(
    34e-3, 24e-3, (-2e-3, 2e-3), (-5e-3, 5e-3)), False)])  # fmt: skip
def test_a_gear_solved_with_its_width_says_it_too_unless_it_has_a_body(bore, body, noted):
    gear = Gear(Tooth(28), 3e-3, bore * 1e-3, 10e-3, body=body)
    influence = SimpleNamespace(
        fine=SimpleNamespace(support=None, uneven=None, body=None, unknowns=0), settings=solid_settings(0.1), width=3.0,
        error={}, seconds={},
    )  # fmt: skip
    said = _present_solid(influence, SimpleNamespace(gear=gear, name="a", cut=False)).remarks
    assert any("underestimated" in text for text in said) == noted
