"""What of a gear is written to REXS: tools, modifications of both flanks, materials, and what is named as left out."""

from __future__ import annotations

import math
from types import SimpleNamespace as Space

import pytest

from fegear.exchange.rexs.written import Written
from fegear.exchange.rexs.written_gears import (
    _end_relief,
    _flank,
    _material,
    _modifications,
    _tip,
    _tool,
    left_out,
    write_elasticity,
)


class Given(Space):
    """A table of a case: what it was given, everything else is None."""

    def __getattr__(self, _name):
        return None

    @property
    def model_fields_set(self):
        return set(vars(self))


def said(part):
    """Attributes of a component with their units, numbers as such."""
    found = {}
    for name, unit, text in part.attributes:
        try:
            found[name] = (unit, pytest.approx(float(text)))
        except ValueError:
            found[name] = (unit, text)
    return found


def of_type(written, kind):
    return [said(part) for part in written.parts if part.type == kind]


RACK = Space(addendum=1.0, dedendum=1.25, tip_radius=0.38, protuberance=0.0, protuberance_angle=0.2)


def gear(**given):
    rack = Space(build=lambda angle, module: {(math.radians(20.0), 2e-3): RACK}[angle, module], grinding_allowance=0.05)
    usual = {"pressure_angle": math.radians(20.0), "rack": rack, "x": 0.3}
    return Given(**usual | given)


MADE = Space(module=2e-3, tip_radius=25e-3, tooth="tooth")


def test_keys_without_an_attribute_are_named_in_order_where_they_say_something():
    written = Written()
    left_out(written, "Gear p", Given(b=1, a=2.0, known=3, nothing=None, empty=[], table={}), {"known"})
    assert written.remarks == ["Gear p: a, b not written to REXS."]
    left_out(written, "Gear p", Given(known=3), {"known"})
    assert len(written.remarks) == 1


@pytest.mark.parametrize(
    ("given", "addendum", "tip"),
    [({}, 1.0, None), ({}, 1.0 + 1e-10, None), ({}, 1.1, 50e-3), ({"tip_diameter": 50e-3}, 1.0, 50e-3),
     ({"internal": True}, 1.0, 50e-3)],
)  # fmt: skip
def test_a_tip_diameter_is_written_unless_it_is_that_of_an_addendum_of_one_module(monkeypatch, given, addendum, tip):
    monkeypatch.setattr(RACK, "addendum", addendum)
    assert _tip(MADE, gear(**given)) == (None if tip is None else pytest.approx(tip))


def test_a_flank_has_its_angle_shift_stock_and_chamfer():
    found = said(_flank(Written(), MADE, gear(tip_chamfer=0.4e-3), "p, left"))
    assert found == {
        "normal_pressure_angle": ("deg", 20.0), "addendum_modification_coefficient": ("none", 0.3),
        "tooth_tip_chamfer": ("mm", 0.4), "grinding_allowance": ("mm", 0.1),
    }  # fmt: skip
    bare = gear()
    bare.rack.grinding_allowance = 0.0
    assert set(said(_flank(Written(), MADE, bare, "p, left"))) == {
        "normal_pressure_angle", "addendum_modification_coefficient",
    }  # fmt: skip


@pytest.mark.parametrize("protuberance", [0.0, 0.06])
def test_a_rack_s_addendum_makes_the_dedendum_of_the_gear(monkeypatch, protuberance):
    monkeypatch.setattr(RACK, "protuberance", protuberance)
    written = Written()
    flanks = [written.part("cylindrical_gear_flank", side) for side in ("left", "right")]
    _tool(written, MADE, gear(), flanks)
    (tool,) = of_type(written, "rack_shaped_tool")
    more = {"protuberance_amount_factor": ("none", 0.06), "protuberance_angle": ("deg", math.degrees(0.2))}
    assert tool == {
        "addendum_coefficient_reference_profile": ("none", 1.25), "tip_radius_factor": ("none", 0.38),
        "dedendum_coefficient_reference_profile": ("none", 1.0), "normal_module": ("mm", 2.0),
        "normal_pressure_angle": ("deg", 20.0), **(more if protuberance else {}),
    }  # fmt: skip
    assert [(kind, order, [part.type for _, part in roles]) for kind, order, roles in written.relations] == [
        ("manufacturing_step", 1,
         ["cylindrical_gear_flank", "rack_shaped_tool", "cylindrical_gear_manufacturing_settings"]),
    ] * 2  # fmt: skip
    assert [roles[0][1].name for *_, roles in written.relations] == ["left", "right"]


def test_reliefs_and_crowns_are_of_both_flanks_with_their_ends():
    tip = Given(amount=20e-6, start_radius=24e-3, shape="linear")
    root = Given(amount=10e-6, length=1.5e-3, shape="parabolic")
    ends = [Given(end="I", amount=5e-6, length=2e-3, shape="linear"),
            Given(end="both", amount=7e-6, length=3e-3, shape="circular")]  # fmt: skip
    part = gear(
        relief=Given(tip=[tip], root=[root], crowning=[Given(amount=4e-6)]),
        lead=Given(crowning=8e-6, slope=-6e-6, end_relief=ends),
    )
    written = Written()
    flanks = [written.part("flank", side) for side in ("left", "right")]
    _modifications(written, "p", part, flanks)
    (tipped,) = of_type(written, "tip_relief")
    assert tipped == {
        "tip_relief_depth": ("mm", 0.02), "tip_relief_datum_diameter": ("mm", 48.0),
        "shape_of_relief": ("none", "linear"),
    }  # fmt: skip
    (rooted,) = of_type(written, "root_relief")
    assert rooted["root_relief_datum_length"] == ("mm", 1.5)
    assert rooted["shape_of_relief"] == ("none", "parabolic")
    (crown,) = of_type(written, "profile_crowning")
    assert crown == dict.fromkeys(("profile_crowning_at_tip", "profile_crowning_at_root"), ("mm", 4e-3))
    (lead,) = of_type(written, "helix_crowning")
    names = "helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"
    assert lead == dict.fromkeys(names, ("mm", 8e-3))
    assert of_type(written, "helix_slope") == [{"helix_slope": ("mm", -6e-3)}]
    datum, other = of_type(written, "end_relief_datum_face"), of_type(written, "end_relief_non_datum_face")
    assert [one["end_relief_length_datum_face"] for one in datum] == [("mm", 2.0), ("mm", 3.0)]
    assert [one["end_relief_length_non_datum_face"] for one in other] == [("mm", 3.0)]
    assert [one["shape_of_relief"][1] for one in (*datum, *other)] == ["linear", "circular", "circular"]
    made = written.parts[2:]
    assert [(roles[0][1].name, roles[1][1].id) for *_, roles in written.relations] == [
        (side, one.id) for one in made for side in ("left", "right")
    ]
    assert written.remarks == []
    before = len(written.parts)
    _modifications(written, "p", gear(lead=Given(crowning=0.0, slope=0.0, end_relief=[])), flanks)
    _modifications(written, "p", gear(), flanks)
    assert len(written.parts) == before


@pytest.mark.parametrize("given", [{"start_radius": 24e-3}, {"amount": 1e-5}, {"length": 1e-3}])
def test_a_relief_needs_an_amount_and_a_beginning(given):
    written = Written()
    assert _end_relief(written, "p", "tip", Given(**given)) is None
    assert written.remarks == [
        "Gear p, relief.tip: not written to REXS, which requires an amount, and start_radius or length."
    ]
    assert written.parts == []


def material(**given):
    return Given(**given)


def test_elasticity_is_written_as_far_as_it_is_given():
    found = said(write_elasticity(Written().part("material"), material(young_modulus=2.1e11, poisson_ratio=0.28)))
    assert found == {"elastic_modulus": ("N / mm^2", 210e3), "poisson_ratio": ("none", 0.28)}
    assert set(said(write_elasticity(Written().part("material"), material(density=7850.0)))) == {"density"}
    assert said(write_elasticity(Written().part("material"), material())) == {}


def test_a_gear_has_a_material_where_it_or_its_strength_is_given():
    written = Written()
    body = written.part("cylindrical_gear", "p")
    _material(written, "p", gear(material=material()), body)
    assert len(written.parts) == 1
    _material(written, "p", gear(material=material(density=7850.0)), body)
    assert [part.name for part in written.parts] == ["p", "p, material"]
    strength = Given(material="case-hardened-steel", quality="MQ", hardness=700.0, contact=1.5e9, bending=math.nan)
    _material(written, "p", gear(material=material(), strength=strength), body)
    found = said(written.parts[-1])
    assert found["surface_hardness_vickers"][1] == 700.0
    assert found["allowable_stress_number_contact_iso_6336_2016"] == ("N / mm^2", 1500.0)
    assert "nominal_stress_number_tooth_root_iso_6336_2016" not in found
    assert "heat_treated_material_type_iso_6336_2019" in found
    assert written.remarks == []
    odd = Given(material="brass", quality="ME", hardness=120.0)
    _material(written, "p", gear(material=material(), strength=odd), body)
    assert written.remarks == [
        "Gear p, strength: quality not written to REXS.", "Gear p: material type brass is not defined in REXS.",
    ]  # fmt: skip
    assert [(kind, roles[0][1].id) for kind, _, roles in written.relations] == [("reference", body.id)] * 3
