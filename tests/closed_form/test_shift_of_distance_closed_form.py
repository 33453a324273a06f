"""Profile shifts from a centre distance, allowances from a backlash, torque from a power: there and back."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from fegear.base.errors import FegearError, InputError
from fegear.case.reading import build_scene
from fegear.formulas.iso6336.part3_pair import RatingChoice, rate_spur
from fegear.geometry.path_of_contact import specific_sliding

RULES = ("driver", "driven", "equal", "equal-sliding", "equal-root-stress")


def scene_of(gears, **pair):
    return build_scene(
        {"results": ["geometry"], "gear": gears, "pair": {"I": {"driver": "a", "driven": "b", **pair}}}, "case", Path()
    )


def spur(teeth, **keys):
    return {"teeth": teeth, "module": "3 mm", "face_width": "20 mm", **keys}


def mm(length):
    return f"{length * 1e3!r} mm"


def random_gears(draw):
    """Two gears without shifts: external or one of them a ring, spur or helical."""
    kind, first = draw.choice(["spur", "helical", "ring"]), draw.randint(17, 40)
    size = {"pressure_angle": f"{draw.choice([20.0, 22.5, 25.0])} deg", "face_width": "20 mm"}
    if kind == "helical":
        size |= {"normal_module": "2 mm", "helix_angle": f"{draw.uniform(5.0, 30.0)!r} deg"}
        return {"a": {"teeth": first, "hand": "left", **size}, "b": {"teeth": 57, "hand": "right", **size}}
    if kind == "spur":
        return {"a": {"teeth": first, "module": "2 mm", **size}, "b": {"teeth": 57, "module": "2 mm", **size}}
    ring = {"teeth": 97, "module": "2 mm", "internal": True, "cutter": {"teeth": 30}, "tip_diameter": "191.5 mm"}
    return {"a": {"teeth": first, "module": "2 mm", **size}, "b": {**ring, **size}}


@pytest.mark.dear
def test_random_pairs_there_and_back():
    """Shifts give a distance, which gives their sum again; allowances a backlash, which gives them again: 1e-9."""
    draw, found = random.Random(3), 0  # noqa: S311
    while found < 60:
        gears, shifts = random_gears(draw), (draw.uniform(0.0, 0.4), draw.uniform(-0.1, 0.3))
        thinner = draw.uniform(0.0, 60e-6)
        shifted = {name: {**keys, "profile_shift": x} for (name, keys), x in zip(gears.items(), shifts, strict=True)}
        thin = {name: {**keys, "thickness_allowance": mm(thinner)} for name, keys in shifted.items()}
        try:
            pair = scene_of(thin).pairs["I"]
        except FegearError:
            continue
        found += 1
        distance = mm(pair.centre_distance)
        half = {"a": shifted["a"], "b": gears["b"]}
        made = scene_of(half, centre_distance=distance, shift_distribution="driven")
        assert made.gears["b"].tooth.profile_shift == pytest.approx(shifts[1], abs=1e-9)
        assert "shift_distribution = driven" in made.derived[0]
        even = scene_of(gears, centre_distance=distance, shift_distribution="equal").gears
        assert even["a"].tooth.profile_shift == pytest.approx(0.5 * sum(shifts), abs=1e-9)
        for key, given in (("normal_backlash", {}), ("circumferential_backlash", {"centre_distance": distance})):
            again = scene_of(shifted, **{key: mm(getattr(pair, key))}, **given)
            for gear in again.gears.values():
                assert gear.tooth.thickness_allowance * gear.module == pytest.approx(thinner, abs=2e-12)
            assert getattr(again.pairs["I"], key) == pytest.approx(getattr(pair, key), abs=1e-12)


def test_sliding_is_equal_at_the_ends_of_the_path():
    for teeth, distance in ((17, 101.5e-3), (25, 114e-3), (40, 136e-3)):
        scene = scene_of(
            {"a": spur(teeth), "b": spur(50)}, centre_distance=mm(distance), shift_distribution="equal-sliding"
        )
        pair = scene.pairs["I"]
        ends = [float(specific_sliding(pair, x, who)) for x, who in
                ((pair.x_start, "driver"), (pair.x_end, "driven"))]  # fmt: skip
        assert ends[0] == pytest.approx(ends[1], rel=1e-9)
        assert pair.normal_backlash == pytest.approx(0.0, abs=1e-12)


def test_root_stress_by_the_standard_is_equal():
    gears = {"a": spur(19), "b": spur(60)}
    pair = scene_of(gears, centre_distance="119.5 mm", shift_distribution="equal-root-stress").pairs["I"]
    one, other = (rate_spur(pair, member, 1e5, RatingChoice(2019)).stress for member in ("driver", "driven"))
    assert one == pytest.approx(other, rel=1e-5)
    for more in (-0.1, 0.1):  # a thicker driver has less of it
        first = pair.driver.tooth.profile_shift + more
        moved = {"a": spur(19, profile_shift=first), "b": gears["b"]}
        other = scene_of(moved, centre_distance="119.5 mm", shift_distribution="driven").pairs["I"]
        one, two = (rate_spur(other, member, 1e5, RatingChoice(2019)).stress for member in ("driver", "driven"))
        assert (one < two) == (more > 0.0)


def test_equal_gears_share_evenly_by_every_rule():
    gears = {"a": spur(30), "b": spur(30)}
    for rule in RULES[2:]:
        made = scene_of(gears, centre_distance="91 mm", shift_distribution=rule).gears
        assert made["a"].tooth.profile_shift == pytest.approx(made["b"].tooth.profile_shift, abs=1e-9)


def test_handbook_rows_give_their_printed_shifts():
    """Printed: 12/24, m 3, a = 56.4999 mm: 0.6 + 0.36 (spur); 12/60, beta 30, a = 125 mm: 0.09809 + 0."""
    spurs = scene_of(
        {"a": spur(12, profile_shift=0.6), "b": spur(24)}, centre_distance="56.4999 mm", shift_distribution="driven"
    )
    assert spurs.gears["b"].tooth.profile_shift == pytest.approx(0.36, abs=5e-5)
    helical = {"normal_module": "3 mm", "helix_angle": "30 deg", "face_width": "20 mm"}
    gears = {"a": {"teeth": 12, "hand": "left", **helical}, "b": {"teeth": 60, "hand": "right", **helical}}
    made = scene_of(gears, centre_distance="125 mm", shift_distribution="driver").gears["a"]
    assert made.tooth.profile_shift == pytest.approx(0.09809, abs=5e-6)


def test_a_ring_of_the_handbook_in_its_own_sign():
    """Printed: 16/24, m 3, x2 = 0.5 outwards: alpha_w = 31.0937 deg, a = 13.1683 mm."""
    ring = {"teeth": 24, "module": "3 mm", "internal": True, "cutter": {"teeth": 16}, "tip_diameter": "69.6 mm"}
    khk = {**ring, "profile_shift": 0.5, "profile_shift_sign": "khk"}
    pair = scene_of({"a": {"teeth": 16, "module": "3 mm"}, "b": khk}).pairs["I"]
    assert math.degrees(pair.working_pressure_angle) == pytest.approx(31.0937, abs=1e-4)
    assert pair.centre_distance == pytest.approx(13.1683e-3, abs=5e-8)


@pytest.mark.parametrize(
    ("power", "watts"), [("40 kW", 40e3), ("4 hp", 4 * 745.69987158227), ("5 PS", 5 * 735.49875), ("900 W", 900.0)]
)
def test_a_power_is_a_torque_at_its_speed(power, watts):
    gears = {"a": spur(22), "b": spur(40)}
    scene = scene_of(gears, power=power, speed="1450 rpm")
    torque = watts / (1450 * math.pi / 30)
    assert scene.case.pair["I"].torque == pytest.approx(torque, rel=1e-14)
    pair = scene.pairs["I"]
    assert scene.case.pair["I"].normal_load(pair) == pytest.approx(torque / pair.driver.base_radius, rel=1e-14)
    assert "derived from power" in scene.derived[0]


def test_a_chain_takes_its_backlashes_one_after_the_other():
    gears = {"a": spur(20), "b": spur(30), "c": spur(40)}
    document = {
        "results": ["geometry"], "gear": gears,
        "pair": {"I": {"driver": "a", "driven": "b", "normal_backlash": "80 um"},
                 "II": {"driver": "b", "driven": "c", "normal_backlash": "100 um"}},
    }  # fmt: skip
    pairs = build_scene(document, "case", Path()).pairs
    assert [pair.normal_backlash for pair in pairs.values()] == pytest.approx([80e-6, 100e-6], abs=1e-12)


THICK = {"thickness_allowance": "50 um"}
REFUSED = [
    ({}, {"power": "4 kW"}, "pair.I.speed", "is required for power"),
    ({}, {"power": "4 kW", "speed": "10 rpm", "torque": "4 N*m"}, "pair.I.power", "contradicts torque"),
    ({}, {"power": "4 N*m", "speed": "10 rpm"}, "pair.I.power", "is not a power"),
    ({}, {"shift_distribution": "equal"}, "pair.I.centre_distance", "is required for shift_distribution"),
    ({}, {"shift_distribution": "equal", "centre_distance": "60 mm"}, "pair.I.centre_distance", "must be at least"),
    ({"profile_shift": 0.1}, {"shift_distribution": "driver", "centre_distance": "91 mm"}, "pair.I.shift_distribution",
     "contradicts gear.a.profile_shift"),
    ({"span": "32 mm", "span_teeth": 4}, {"shift_distribution": "equal", "centre_distance": "91 mm"},
     "pair.I.shift_distribution", "contradicts gear.a.span"),
    ({}, {"normal_backlash": "1 um", "centre_distance": "91 mm"}, "pair.I.normal_backlash", "is less than"),
    ({}, {"normal_backlash": "1 um", "circumferential_backlash": "1 um"}, "pair.I.circumferential_backlash",
     "contradicts normal_backlash"),
    ({}, {"shift_distribution": "best", "centre_distance": "91 mm"}, "pair.I.shift_distribution", "equal-sliding"),
]  # fmt: skip


@pytest.mark.parametrize(("gear", "pair", "key", "rule"), REFUSED)
def test_contradictions_are_refused_in_one_sentence(gear, pair, key, rule):
    with pytest.raises(InputError) as refused:
        scene_of({"a": spur(30, **gear), "b": spur(30)}, **pair)
    assert refused.value.key == key
    assert rule in str(refused.value)


def test_allowances_of_both_gears_and_a_backlash_contradict():
    with pytest.raises(InputError, match="contradicts thickness_allowance of a and b"):
        scene_of({"a": spur(30, **THICK), "b": spur(30, **THICK)}, normal_backlash="80 um")
