"""Shafts, flank modifications and flow of REXS models, part by part: lengths, sides, equilibrium and rolling."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.exchange.rexs import modifications, shafts
from fegear.exchange.rexs.drive import Mesh, PlanetSet, Torque, driven
from fegear.exchange.rexs.places import Place
from fegear.exchange.rexs.shafts import OnShaft, Section, diameter_below, hole_below, sections_of


class Said:
    """A model whose parts are linked to everything, with their numbers and words as attributes."""

    def __init__(self, *parts):
        self.parts, self.notes = parts, []

    def number(self, component, _quantity, *names):
        return next((component.of[name] for name in names if name in component.of), None)

    def needed(self, component, quantity, *names):
        return self.number(component, quantity, *names)

    def word(self, component, *names):
        return self.number(component, "", *names)

    def yes(self, component, name):
        return component.of.get(name)

    def linked(self, _component, *_links_and_type):
        kind = _links_and_type[3] if len(_links_and_type) > 3 else None
        return [one for one in self.parts if kind is None or one.type == kind]


def part(kind, **of):
    return Space(type=kind, id=id(of), said=kind, name="", of=of)


def section(length, outer, **more):
    return part("shaft_section", length=length, outer_diameter_begin=outer, **more)


SHAFT = part("shaft")


# ---- sections --------------------------------------------------------------------------------------------------------
def test_sections_follow_each_other_and_keep_their_diameters():
    said = Said(
        section(0.1, 0.05, inner_diameter_begin=0.01, inner_diameter_end=0.02),
        section(0.2, 0.06, outer_diameter_end=0.04), section(0.05, 0.03, u_coordinate_on_shaft=-0.05),
    )  # fmt: skip
    assert sections_of(said, SHAFT) == (
        Section(-0.05, 0.05, (0.03, 0.03), (0.0, 0.0)), Section(0.0, 0.1, (0.05, 0.05), (0.01, 0.02)),
        Section(0.1, 0.2, (0.06, 0.04), (0.0, 0.0)),
    )  # fmt: skip
    found = sections_of(said, SHAFT)
    assert found[2].end == pytest.approx(0.3)
    assert [diameter_below(found, at) for at in (-0.02, 0.05, 0.25)] == pytest.approx([0.03, 0.05, 0.045])
    assert [hole_below(found, at) for at in (-0.02, 0.05, 0.08, 0.25)] == pytest.approx([0.0, 0.015, 0.018, 0.0])
    for below in (hole_below, diameter_below):
        assert [below(found, at) for at in (-0.051, 0.301)] == [None, None]


@pytest.mark.parametrize(("gap", "outcome"), [(5e-8, "as it is"), (1.9e-4, "closed"), (2.1e-4, "leave a gap"),
                                              (-1e-6, "overlap"), (-5e-8, "as it is")])  # fmt: skip
def test_small_gaps_are_closed_and_others_refused(gap, outcome):
    said = Said(section(0.1, 0.05), section(0.2, 0.06, u_coordinate_on_shaft=0.1 + gap))
    if outcome in ("overlap", "leave a gap"):
        with pytest.raises(InputError, match=f"{outcome} at 100 mm"):
            sections_of(said, SHAFT)
        return
    one, two = sections_of(said, SHAFT)
    assert one.length == (pytest.approx(0.1 + gap, abs=1e-12) if outcome == "closed" else 0.1)
    assert (two.begin, two.length) == (0.1 + gap, 0.2)
    assert said.notes == (["shaft: gap of 0.19 mm between sections closed."] if outcome == "closed" else [])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": 0.0, "outer_diameter_begin": 0.05}, "must be positive"),
        ({"length": 0.1, "outer_diameter_begin": 0.05, "outer_diameter_end": 0.0}, "must be positive"),
        ({"length": 0.1, "outer_diameter_begin": 0.05, "inner_diameter_begin": 0.05}, "must be below its outer"),
        ({"length": 0.1, "outer_diameter_begin": 0.05, "inner_diameter_end": -0.01}, "must be below its outer"),
        ({"length": 400.0, "outer_diameter_begin": 0.05}, "of shaft "),
    ],
)
def test_shafts_of_no_size_are_refused(given, said):
    with pytest.raises(InputError, match=said):
        sections_of(Said(part("shaft_section", **given)), SHAFT)


@pytest.mark.parametrize("reverse", [False, True])
def test_places_on_a_shaft_count_from_its_left_end_in_the_gearbox(monkeypatch, reverse):
    material = part("material", elastic_modulus=2e11, yield_strength=3e8)
    said = Said(section(0.1, 0.05, outer_diameter_end=0.04), section(0.2, 0.06), material)
    monkeypatch.setattr(shafts, "_loads", lambda _said, _shaft, along, _twisting: along(0.05))
    monkeypatch.setattr(shafts, "elasticity", lambda _said, _material: {"young_modulus": '"200 GPa"'})
    place, origin = Place(1.0, 0.2, 0.3, reversed=reverse), Place(0.4, 0.05, 0.1, reversed=False)
    bearing = Space(component=part("bearing"), at=0.02, name="B", seats=(("B", True, True), ("B2", False, True),
                                                                         ("B3", True, False)))  # fmt: skip
    on = OnShaft((("g", 0.25),), coupling=0.3, around={"B": "outer"})
    table = shafts.shaft_table(said, SHAFT, "S", place, on, [bearing], origin, clockwise=True)
    keys = {one.name: one.value for one in table.keys}
    assert table.name == "shaft.S"
    assert keys["axis"] == '["150 mm", "200 mm"]'
    assert keys["start"] == ('"300 mm"' if reverse else '"600 mm"')  # 1 m - 0.3 m - 0.4 m, or from its own begin
    long, tapered = '{ length = "200 mm", outer = "60 mm" }', ("40 mm", "50 mm") if reverse else ("50 mm", "40 mm")
    short = f'{{ length = "100 mm", outer = "{tapered[0]}", outer_end = "{tapered[1]}" }}'
    at = [keys["sections"].find(one) for one in (short, long)]
    assert min(at) >= 0
    assert (at[0] > at[1]) == reverse
    assert f'at = "{50 if reverse else 250} mm"' in keys["gears"]
    assert keys["bearings"].count(f'at = "{280 if reverse else 20} mm"') == 3
    lines = [one for one in keys["bearings"].split("{") if "bearing" in one]
    assert ["reversed = true" in one for one in lines] == [not reverse, reverse, False]
    assert ['around = "outer"' in one for one in lines] == [True] * 3
    assert keys["coupling"] == ('"0 mm"' if reverse else '"300 mm"')
    assert keys["loads"] == ('"250 mm"' if reverse else '"50 mm"')
    assert (keys["clockwise"], keys["yield_strength"]) == ("true", '"300 MPa"')
    assert "rigid" not in keys
    material.of["elastic_modulus"] = 1.01e13
    table = shafts.shaft_table(said, SHAFT, "S", place, OnShaft(()), [], origin, clockwise=False)
    keys = {one.name: one.value for one in table.keys}
    assert keys["rigid"] == "true"
    assert not keys.keys() & {"material", "gears", "coupling", "clockwise"}
    with pytest.raises(InputError, match="places gear g outside shaft, 0 to 300 mm"):
        shafts.shaft_table(said, SHAFT, "S", place, OnShaft((("g", 0.3001),)), [], origin, clockwise=False)


# ---- modifications ---------------------------------------------------------------------------------------------------
def keys_of(*parts, far=None):
    said = Said(*parts)
    found = modifications.modification_keys(said, part("gear"), part("flank"), far)
    return {one.name: one.value for one in found}, said.notes


def test_reliefs_have_their_depth_their_start_and_their_shape():
    keys, notes = keys_of(
        part("tip_relief", tip_relief_depth=2e-5, tip_relief_datum_diameter=0.08, shape_of_relief="parabolic"),
        part("root_relief", root_relief_depth=1e-5, root_relief_datum_length=2e-3),
        part("profile_crowning", profile_crowning_at_root=4e-6),
    )
    assert '{ amount = "20 um", start_radius = "40 mm", shape = "parabolic" }' in keys["relief"]
    assert '{ amount = "10 um", length = "2 mm" }' in keys["relief"]
    assert '{ amount = "4 um" }' in keys["relief"]
    assert (notes, list(keys)) == ([], ["relief"])
    keys, notes = keys_of(part("tip_relief", tip_relief_depth=2e-5), part("root_relief", root_relief_datum_length=1e-3),
                          part("profile_slope"))  # fmt: skip
    assert keys == {}
    assert notes == [
        "gear: profile_slope not imported; add it to relief, lead or topography.",
        "gear: tip_relief without start ignored.",
    ]
    keys, notes = keys_of(
        part("tip_relief", tip_relief_depth=2e-5, tip_relief_datum_length=1e-3, shape_of_relief="arc")
    )
    assert 'shape = "parabolic"' in keys["relief"]
    assert notes == ["gear: shape arc of tip_relief approximated as parabolic."]


@pytest.mark.parametrize(("far", "slope", "ends"), [("II", "7 um", ("I", "II")), ("I", "-7 um", ("II", "I")),
                                                    (None, "7 um", ("I", "II"))])  # fmt: skip
def test_slopes_and_reliefs_of_ends_count_from_the_datum_face(far, slope, ends):
    keys, notes = keys_of(
        part("helix_slope", helix_slope=7e-6), part("helix_crowning", helix_crowning_amount_non_datum_face=3e-6),
        part("end_relief_datum_face", end_relief_depth_datum_face=9e-6, end_relief_length_datum_face=2e-3),
        part("end_relief_non_datum_face", end_relief_depth_non_datum_face=8e-6, end_relief_length_non_datum_face=1e-3),
        far=far,
    )  # fmt: skip
    lead = keys["lead"]
    assert f'slope = "{slope}"' in lead
    assert 'crowning = "3 um"' in lead
    assert f'{{ amount = "9 um", length = "2 mm", end = "{ends[0]}" }}' in lead
    assert f'{{ amount = "8 um", length = "1 mm", end = "{ends[1]}" }}' in lead
    assert notes == ([] if far else ["gear: datum face not specified; end I assumed."])


def test_reliefs_of_ends_without_length_are_told_and_crownings_have_no_side():
    keys, notes = keys_of(part("end_relief_datum_face", end_relief_depth_datum_face=9e-6))
    assert (keys, notes) == ({}, ["gear: end_relief_datum_face without length ignored."])
    keys, notes = keys_of(part("helix_crowning", helix_crowning_amount_datum_face=3e-6))
    assert (list(keys), notes) == (["lead"], [])
    assert modifications.modification_keys(Said(), part("gear"), None, None) == []


# ---- flow ------------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("seed", range(4))
def test_torques_balance_every_body_and_speeds_roll(seed):
    """A chain of random teeth, one torque given at one end."""
    chance = np.random.default_rng(seed)
    count = int(chance.integers(2, 6))
    teeth = [tuple(int(one) for one in chance.integers(17, 90, 2)) for _ in range(count)]
    if seed % 2:
        teeth[0] = teeth[0][0], -teeth[0][1] - 100  # a ring
    meshes = [Mesh((n, n + 1), one) for n, one in enumerate(teeth)]
    found = driven(count + 1, meshes, (), [Torque(0, 50.0), Torque(count, None)], {0: 10.0})
    speed, torque = 10.0, -50.0
    for n, (one, other) in enumerate(teeth):
        assert found.mesh_torque[n] == pytest.approx(torque)
        assert found.speed[n] == pytest.approx(speed)
        speed *= -one / other
        torque *= -other / one
    assert found.speed[count] == pytest.approx(speed)
    assert found.outside == pytest.approx((50.0, torque))
    assert found.outside[1] * speed == pytest.approx(-50.0 * 10.0)  # what goes in comes out
    assert not found.shared


def test_paths_beside_each_other_share_a_torque_evenly_and_say_so():
    """0 to 3 over 1 or 2, all of 20 teeth: 5 N m each."""
    meshes = [Mesh(bodies, (20, 20)) for bodies in ((0, 1), (0, 2), (1, 3), (2, 3))]
    found = driven(4, meshes, (), [Torque(0, 10.0), Torque(3, None)], {0: 5.0})
    assert found.mesh_torque == pytest.approx((-5.0, -5.0, 5.0, 5.0))
    assert found.shared == frozenset(range(4))
    assert found.speed == pytest.approx((5.0, -5.0, -5.0, 5.0))
    assert found.outside == pytest.approx((10.0, -10.0))


@pytest.mark.parametrize("fixed", ["ring", "carrier", "sun"])
def test_a_planetary_set_keeps_willis_and_its_torques(fixed):
    sun, ring = 20, 70
    body = {"sun": 0, "ring": 1, "carrier": 2}
    source, goal = (one for one in ("sun", "ring", "carrier") if one != fixed)
    found = driven(3, (), [PlanetSet(0, 1, 2, (sun, ring))], [Torque(body[source], 30.0), Torque(body[goal], None)],
                   {body[source]: 9.0}, [body[fixed]])  # fmt: skip
    w = found.speed
    assert sun * w[0] + ring * w[1] == pytest.approx((sun + ring) * w[2])
    assert w[body[fixed]] == pytest.approx(0.0, abs=1e-12)
    share = {"sun": 1.0, "ring": ring / sun, "carrier": -(sun + ring) / sun}
    assert found.set_torque[0] == pytest.approx(-30.0 / share[source])
    assert found.outside[1] == pytest.approx(-found.set_torque[0] * share[goal])
    assert found.outside[1] * w[body[goal]] == pytest.approx(-30.0 * 9.0)


def test_what_contradicts_the_teeth_is_refused_and_what_nothing_gives_is_unknown():
    meshes = [Mesh((0, 1), (20, 40))]
    with pytest.raises(InputError, match="speeds inconsistent with the gear ratios"):
        driven(2, meshes, (), (), {0: 10.0, 1: -6.0})
    with pytest.raises(InputError, match="torques not in equilibrium"):
        driven(2, meshes, (), [Torque(0, 10.0), Torque(1, -10.0)], {})
    assert driven(2, meshes, (), [Torque(0, 10.0), Torque(1, 20.0)], {}).mesh_torque == pytest.approx((-10.0,))
    found = driven(4, [*meshes, Mesh((2, 3), (20, 40))], (), [Torque(0, 10.0), Torque(1, None)], {0: 10.0})
    assert found.speed[:2] == pytest.approx((10.0, -5.0))
    assert all(math.isnan(one) for one in found.speed[2:])
    assert all(math.isnan(one) for one in itertools.chain(driven(2, meshes, (), (), {}).mesh_torque))


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize("off", [-9e-8, -1e-17, 0.0, 6e-17, 9e-8])
def test_what_stands_at_the_ends_of_a_shaft_but_for_round_off_stands_at_its_ends(monkeypatch, reverse, off):
    """Reversed, the right end of 100 and 200 mm was 5.55e-14 mm, and beyond it a place that a case refuses."""
    monkeypatch.setattr(shafts, "_loads", lambda *_given: None)
    said = Said(section(0.1, 0.05), section(0.2, 0.06))
    place = Place(0.0, 0.0, 0.0, reversed=reverse)
    on = OnShaft((("a", off), ("b", 0.1 + 0.2 + off), ("c", 1.1e-7)))
    table = shafts.shaft_table(said, SHAFT, "S", place, on, [], Place(0.0, 0.0, 0.0, reversed=False), clockwise=False)
    (gears,) = (one.value for one in table.keys if one.name == "gears")
    places = [float(one.split(" mm")[0]) for one in gears.split('at = "')[1:]]
    assert places[:2] == ([300.0, 0.0] if reverse else [0.0, 300.0])
    assert places[2] == pytest.approx(300.0 - 1.1e-4 if reverse else 1.1e-4)
