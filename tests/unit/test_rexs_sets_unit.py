"""Planetary stages of REXS models: places of planets, bores, rims, pins, bearings, carrier, loads of their pairs."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from rexs_boxes import rotated
from rexs_cases import case, imported, more, put, same, text_of, there_and_back
from rexs_models import in_json, link, part, planetary_set, ring_stage

from fegear.base.errors import InputError
from fegear.exchange.rexs.model_to_case import case_of
from fegear.exchange.rexs.reading import model_of

#: Uneven places that the 18 + 66 teeth allow: 0, 30 and 56 of 84 steps.
UNEVEN = (0.0, 30 * 360 / 84, 240.0)


def degrees(found: dict) -> list[float]:
    return [float(one.removesuffix(" deg")) for one in found["planetary"]["P"]["angles"]]


def test_uneven_planets_stand_where_their_shafts_do():
    """They were taken as even."""
    found = case(planetary_set(angles=UNEVEN))
    assert "planets" not in found["planetary"]["P"]
    assert degrees(found) == pytest.approx(UNEVEN, abs=1e-9)
    # counted from the first planet, wherever the drawing begins and whichever way it lies in space
    for start in (17.0, -123.4):
        assert degrees(case(planetary_set(angles=[a + start for a in UNEVEN]))) == pytest.approx(UNEVEN, abs=1e-9)
    assert "planets" in case(planetary_set(angles=(30.0, 150.0, 270.0)))["planetary"]["P"]


@pytest.mark.parametrize("seed", [1, 2])
def test_a_set_turned_in_space_is_the_same(seed):
    angles = case(rotated(planetary_set(angles=UNEVEN), seed))["planetary"]["P"]["angles"]
    turned = [float(one.removesuffix(" deg")) for one in angles]
    # the axis about which angles count may point either way: the spacing is the same, or its mirror image
    gaps = np.diff([*turned, turned[0] + 360.0])
    wanted = np.diff([*UNEVEN, 360.0])
    assert any(np.allclose(np.roll(side, n), wanted, atol=1e-6) for n in range(3) for side in (gaps, gaps[::-1]))


def test_planets_without_shaft_places_stand_by_the_angles_of_their_stages():
    tree = planetary_set(angles=UNEVEN)
    for n, angle in enumerate(UNEVEN):
        tree = without(tree, 41 + n, "support_vector")
        # rotating_angle_around_neg_u_axis counts from w toward v
        tree = put(tree, 21 + n, rotating_angle_around_neg_u_axis=(90.0 - angle, "deg"))
    assert degrees(case(tree)) == pytest.approx(UNEVEN, abs=1e-9)
    assert case(planetary_set(angles=(0.0, 0.0, 0.0)))["planetary"]["P"]["planets"] == 3
    assert ": all planets at the same position; equal" in text_of(planetary_set(angles=(0.0, 0.0, 0.0)))


def test_planets_at_impossible_places_are_refused():
    with pytest.raises(InputError, match="are at the same position"):
        case(planetary_set(angles=(0.0, 120.0, 120.0)))
    with pytest.raises(InputError, match="deg off an integer multiple of 360/"):
        case(planetary_set(angles=(0.0, 122.0, 240.0)))
    tree = put(planetary_set(), 42, support_vector=([0.0, -30.0, 30.0], "mm"))
    with pytest.raises(InputError, match="contradicts the distance of its shafts,"):
        case(tree)


def test_places_that_were_rounded_are_moved_to_where_the_teeth_fit():
    angles = [a + e for a, e in zip(UNEVEN, (0.0, 0.02, -0.03), strict=True)]
    assert degrees(case(planetary_set(angles=angles))) == pytest.approx(UNEVEN, abs=1e-9)
    assert "corrected by at most 0.03 deg" in text_of(planetary_set(angles=angles))


def without(tree: dict, number: int, name: str) -> dict:
    parts = [
        {**one, "attributes": [a for a in one["attributes"] if a["id"] != name]} if one["id"] == number else one
        for one in tree["components"]
    ]
    return {**tree, "components": parts}


def held(tree: dict, *bearings: tuple[int, int, float | None]) -> dict:
    """The set with bearings in its casing: number, shaft, radial stiffness [N/m]."""
    made = [
        part(n, "concept_bearing", f"b {n}", u_coordinate_on_shaft_inner_side=(0.0, "mm"),
             **({} if size is None else {"radial_stiffness": (size, "N/m")}))
        for n, _, size in bearings
    ]  # fmt: skip
    links = tuple(link(900 + n, "side", assembly=n, inner_part=on, outer_part=2) for n, on, _ in bearings)
    return more(tree, *made, relations=links)


def test_bearings_of_planets_are_pins_and_those_in_the_casing_hold_the_members():
    tree = planetary_set()
    assert not {"floating", "stiffness"} & case(tree)["planetary"]["P"].keys()
    for n in range(3):
        tree = put(tree, 61 + n, radial_stiffness=(3e8, "N/m"))
        second = part(71 + n, "concept_bearing", radial_stiffness=(2e5, "N/mm"))
        tree = more(
            tree, second, relations=(link(971 + n, "side", assembly=71 + n, outer_part=41 + n, inner_part=51 + n),)
        )
    assert case(tree)["planetary"]["P"]["stiffness"] == {"pin": "500 N/um"}
    tree = put(tree, 7, rotational_stiffness=(2e9, "N mm/rad"))
    one = case(held(tree, (81, 5, 4e8), (82, 5, 1e8)))["planetary"]["P"]
    assert one["stiffness"] == {"pin": "500 N/um", "carrier": "500 N/um", "turning": "2000000 N*m/rad"}
    assert one["floating"] == ["sun"]
    one = case(held(tree, (81, 5, None), (82, 3, 7e7)))["planetary"]["P"]
    assert one["floating"] == []
    assert one["stiffness"]["sun"] == "70 N/um"
    assert "unequal pin stiffness; mean value 533.3" in text_of(put(tree, 61, radial_stiffness=(4e8, "N/m")))
    assert "pin" not in case(put(tree, 61, radial_stiffness=(1e20, "N/m")))["planetary"]["P"]["stiffness"]


def solid(number: int, on: int, outer: float, inner: float = 0.0) -> tuple[dict, dict]:
    made = part(number, "shaft_section", length=(100.0, "mm"), outer_diameter_begin=(outer, "mm"),
                inner_diameter_begin=(inner, "mm"))  # fmt: skip
    return made, link(700 + number, "ordered_assembly", assembly=on, part=number)


def test_bores_and_rims_are_those_of_the_shafts():
    made = [solid(601, 3, 14.0), solid(602, 4, 156.0, 140.0), *(solid(603 + n, 41 + n, 32.0, 30.0) for n in range(3))]
    tree = more(planetary_set(), *(one for one, _ in made), relations=tuple(one for _, one in made))
    gears = case(tree)["gear"]
    assert gears["gear_11"]["bore_radius"] == "7 mm"
    assert gears["gear_120"]["bore_radius"] == "15 mm"  # the hole of its sleeve, which turns on the pin
    assert gears["gear_15"]["outer_radius"] == "78 mm"
    # a rigid sleeve holds the planet at its outside
    links = tuple(link(960 + n, "reference", origin=41 + n, referenced=650) for n in range(3))
    rigid = more(tree, part(650, "material", elastic_modulus=(2.1e8, "N/mm^2")), relations=links)
    assert case(rigid)["gear"]["gear_120"]["bore_radius"] == "16 mm"
    thin = put(tree, 602, outer_diameter_begin=(136.0, "mm"), inner_diameter_begin=(130.0, "mm"))
    assert "leaves no rim" in text_of(thin)
    assert case(put(tree, 15, outer_diameter=(180.0, "mm")))["gear"]["gear_15"]["outer_radius"] == "90 mm"


def test_a_carrier_weighs_what_its_plates_shafts_and_pins_do():
    plate = part(660, "side_plate", length=(10.0, "mm"), outer_diameter=(120.0, "mm"), inner_diameter=(40.0, "mm"))
    made = [solid(661, 5, 30.0), *(solid(662 + n, 51 + n, 12.0) for n in range(3))]
    links = (*(one for _, one in made), link(970, "assembly", assembly=10, part=660))
    tree = more(planetary_set(), plate, *(one for one, _ in made), relations=links)
    cone = put(tree, 661, outer_diameter_end=(20.0, "mm"))

    def numbers(tree: dict) -> tuple[float, float]:
        body = case(tree)["planetary"]["P"]["body"]["carrier"]
        return float(body["mass"].split()[0]), float(body["inertia"].split()[0])

    for model, radius in ((tree, lambda s: 0.015 + 0.0 * s), (cone, lambda s: 0.015 - 0.005 * s)):
        s = (np.arange(20_000) + 0.5) / 20_000
        area = math.pi * np.array([(0.06**2 - 0.02**2) * 0.01, (radius(s) ** 2).mean() * 0.1, 3 * 0.006**2 * 0.1])
        turn = [(0.06**2 + 0.02**2) / 2, (radius(s) ** 4).mean() / (radius(s) ** 2).mean() / 2, 0.006**2 / 2 + 0.042**2]
        assert numbers(model) == pytest.approx((7850 * area.sum(), 7850 * area @ np.array(turn)), rel=1e-5)
    assert "body" not in case(planetary_set())["planetary"]["P"]


def test_oil_and_application_factor_reach_the_pairs_of_a_set():
    tree = put(planetary_set(), 21, application_factor=(1.4, "none"), temperature_lubricant=(63.0, "C"))
    found = case(tree)
    assert found["pair"]["P_sun"]["operation"]["application_factor"] == 1.4
    assert found["pair"]["P_sun"]["lubricant"]["temperature"] == "63 degC"
    assert found["pair"]["P_ring"]["operation"]["application_factor"] == 1
    assert "torque" not in found["pair"]["P_sun"]  # that of the set
    assert {"rating", "load-distribution"} <= set(found["results"])


def test_a_ring_stage_is_rated_and_its_load_over_the_face_computed():
    found = case(ring_stage())
    assert {"rating", "load-distribution"} <= set(found["results"])
    assert "width" not in found["pair"]["I"]  # of internal spur pairs the plane section is taken
    assert found["pair"]["I"]["centre_distance"] == "40 mm"  # written with either sign
    assert {"lubricant", "operation"} <= found["pair"]["I"].keys()


def test_a_set_that_turns_backward_says_so():
    tree = put(planetary_set(angles=UNEVEN), 3, rotational_speed=(-1000.0, "1/min"))
    tree = put(tree, 31, torque_around_u_axis=(-90.0, "N m"))
    assert case(tree)["planetary"]["P"]["clockwise"] is True
    assert "clockwise" not in case(planetary_set())["planetary"]["P"]


def test_uneven_sets_on_springs_go_there_and_back():
    tree = held(planetary_set(angles=UNEVEN), (81, 5, 4e8), (82, 3, 7e7))
    for n in range(3):
        tree = put(tree, 61 + n, radial_stiffness=(3e8, "N/m"))
    tree = put(put(tree, 7, rotational_stiffness=(2e9, "N mm/rad")), 15, outer_diameter=(180.0, "mm"))
    for stage in (21, 22, 23):
        tree = put(tree, stage, application_factor=(1.4, "none"), temperature_lubricant=(63.0, "C"))
    scene = imported(put(tree, 1, operating_time=(8000.0, "h")))
    again, remarks = there_and_back(scene)
    assert remarks == ()
    assert same(again.case.planetary["P"], scene.case.planetary["P"])
    assert scene.case.pair["P_sun"].operation.life == 8000.0 * 3600.0
    assert all(same(again.case.pair[name], pair) for name, pair in scene.case.pair.items())
    assert all(same(again.gears[name], gear) for name, gear in scene.gears.items())


def under_loads(tree: dict, *cases: tuple[float, float]) -> dict:
    """Load cases of a share of the time [%] and a torque on the first shaft [N m]."""
    listed = [
        {"id": n, "components": [part(1, "gear_unit", load_duration_fraction=(share, "%")),
                                 part(31, "external_load", torque_around_u_axis=(torque, "N m"))]}
        for n, (share, torque) in enumerate(cases, 1)
    ]  # fmt: skip
    return {**tree, "load_spectrum": {"id": 1, "load_cases": listed}}


def test_load_cases_with_shares_of_the_time_are_the_spectrum():
    tree = under_loads(planetary_set(), (60.0, 90.0), (40.0, 45.0))
    text = text_of(tree)
    assert "Torques and speeds from load case 1; other load cases in the model: 2." in text
    assert "The 2 load cases with their durations are used as load spectrum" in " ".join(text.split())
    found = case(tree)
    bins = found["pair"]["P_sun"]["operation"]["spectrum"]
    assert [one["load_factor"] for one in bins] == pytest.approx([1.0, 0.5])
    assert [one["share"] for one in bins] == pytest.approx([0.6, 0.4])
    # relative to the carrier the sun turns 66/84 of its 1000 rpm, and the planet 18/24 of that
    assert float(bins[0]["speed"].split()[0]) == pytest.approx(1000 * 66 / 84)
    ring = found["pair"]["P_ring"]["operation"]["spectrum"]
    assert float(ring[0]["speed"].split()[0]) == pytest.approx(1000 * 66 / 84 * 18 / 24)
    model = model_of(in_json(tree), Path("model.rexs"))
    for asked in (case_of(model, spectrum=False), case_of(model, 2)):
        assert "spectrum" not in tomllib.loads(asked)["pair"]["P_sun"]["operation"]
    assert tomllib.loads(case_of(model, 2))["planetary"]["P"]["torque"] == "45 N*m"


def test_load_cases_that_do_not_say_how_long_they_last_are_no_spectrum():
    tree = under_loads(planetary_set(), (60.0, 90.0), (40.0, 45.0))
    tree["load_spectrum"]["load_cases"][1]["components"].pop(0)
    assert "spectrum" not in case(tree)["pair"]["P_sun"]["operation"]
    assert "The 2 load cases are not used as a load spectrum" in text_of(tree)
    with pytest.raises(InputError, match="do not all have a duration"):
        case_of(model_of(in_json(tree), Path("model.rexs")), spectrum=True)
