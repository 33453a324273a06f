"""The thickness of a tooth as drawings give it, there and back: what `geometry` prints, typed in again."""

from __future__ import annotations

import math
import random
from pathlib import Path

import pytest

from fegear.base.errors import FegearError, InputError
from fegear.case.gear import GearPart
from fegear.case.reading import build_scene
from fegear.case.settled import settled_gear
from fegear.formulas.din3967 import thickness_limits
from fegear.geometry.gear_data import GearData
from fegear.geometry.shift_of_thickness import ToothNumbers

SIZES = ("spur", "helical", "ring", "helical ring")


def scene_of(**gear):
    return build_scene({"results": ["geometry"], "gear": {"a": gear}}, "case", Path())


def mm(length):
    return f"{length * 1e3!r} mm"


def drawn(kind, draw):
    """Keys of a random gear, without its thickness."""
    ring = "ring" in kind
    keys = {"teeth": draw.randint(40, 120) if ring else draw.randint(14, 90), "face_width": "200 mm"}
    keys["pressure_angle"] = f"{draw.choice([17.5, 20.0, 25.0])} deg"
    module = f"{draw.uniform(0.5, 8.0)!r} mm"
    if "helical" in kind:
        keys |= {"helix_angle": f"{draw.uniform(3.0, 35.0)!r} deg", "hand": "left", "normal_module": module}
    else:
        keys["module"] = module
    if ring:
        keys |= {"internal": True, "cutter": {"teeth": 20, "addendum": 1.2}}
    return keys


def random_gears(kind, count, seed):
    """So many random gears: keys, and the same gear with its shift and allowance as numbers."""
    draw, found = random.Random(seed), 0  # noqa: S311
    while found < count:
        keys = drawn(kind, draw)
        size = float((keys.get("module") or keys["normal_module"]).split()[0]) * 1e-3
        keys["thickness_allowance"] = mm(draw.choice([0.0, draw.uniform(0.0, 0.05)]) * size)
        ring = "ring" in kind
        shift = draw.uniform(-0.4, 0.3) if ring else draw.uniform(0.0, 0.5)
        try:
            # tips as they are on the drawing: a ring's need not reach inside the base circle
            radius = 0.5 * keys["teeth"] / math.cos(math.radians(float(keys.get("helix_angle", "0 deg").split()[0])))
            tip = 2.0 * (radius - shift - 0.7 if ring else radius + shift + 0.95) * size
            keys["tip_diameter"] = mm(tip)
            gear = scene_of(**keys, profile_shift=shift).gears["a"]
        except FegearError:
            continue
        found += 1
        yield keys, shift, gear


@pytest.mark.dear
@pytest.mark.parametrize("kind", SIZES)
def test_what_geometry_prints_typed_in_again_is_the_same_gear(kind):
    """200 random gears, every dimension of each: profile shift and, given that, thickness allowance to 1e-9."""
    counts = dict.fromkeys(("tooth_thickness", "span", "over_balls", "over_pins", "chordal_thickness", "height"), 0)
    for keys, shift, gear in random_gears(kind, 50, 7):
        data = GearData(gear, True, None, None, {}, "a")
        typed = {"tooth_thickness": {"tooth_thickness": mm(data.tooth_thickness)}}
        if math.isfinite(data.span):
            typed["span"] = {"span": mm(data.span), "span_teeth": data.span_teeth}
        if math.isfinite(data.over_balls):
            ball = {"ball_diameter": mm(data.ball_diameter)}
            typed["over_balls"] = {"over_balls": mm(data.over_balls), **ball}
            if math.isfinite(data.over_pins):
                typed["over_pins"] = {"over_pins": mm(data.over_pins), **ball}
        if math.isfinite(data.chordal_thickness):
            typed["chordal_thickness"] = {"chordal_thickness": mm(data.chordal_thickness)}
            typed["height"] = {**typed["chordal_thickness"], "chordal_height": mm(data.chordal_height)}
        for name, measure in typed.items():
            part, (note,) = settled_gear(GearPart.model_validate({**keys, **measure}), "a")
            assert part.x == pytest.approx(shift, abs=1e-9), name
            assert f"derived from {next(iter(measure))} = " in note
            allowed = {**keys, **measure, "thickness_allowance": "derived", "profile_shift": shift}
            taken = settled_gear(GearPart.model_validate(allowed), "a")[0].allowance / gear.module
            assert taken == pytest.approx(gear.tooth.thickness_allowance, abs=1e-8), name
            counts[name] += 1
    ring = "ring" in kind
    least = {"tooth_thickness": 50, "over_balls": 30, "over_pins": 0 if kind == "helical ring" else 30}
    least |= {} if ring else {"span": 45, "chordal_thickness": 50, "height": 50}
    assert all(counts[name] >= count for name, count in least.items()), counts


def test_pins_of_an_odd_helical_gear_stand_opposite_each_other():
    """Found as a micrometer does: pins slide along their spaces until parallel planes about them are farthest apart."""
    keys = {"teeth": 21, "normal_module": "3 mm", "helix_angle": "20 deg", "hand": "left", "face_width": "60 mm"}
    gear = scene_of(**keys).gears["a"]
    data = GearData(gear, True, 5.3e-3, None, {}, "a")
    centre = 0.5 * (data.over_balls - 5.3e-3) / math.cos(0.5 * math.pi / 21)
    turned = [math.pi * (1.0 - 1.0 / 21) + abs(gear.twist) * height * 1e-5 for height in range(-2000, 2000)]
    # planes normal to the radius of the first pin: the centre of the second lies cos(turned) r_K beyond the axis
    farthest = max(centre - centre * math.cos(angle) for angle in turned) + 5.3e-3
    assert data.over_pins == pytest.approx(farthest, abs=1e-9)
    assert data.over_pins > data.over_balls + 1e-4


def test_a_chord_is_measured_where_the_drawing_says():
    """A caliper on a spur tooth: any point of the flank has a height and a chord, and gives the same profile shift."""
    gear = scene_of(teeth=24, module="3 mm", profile_shift=0.3, tip_diameter="79 mm").gears["a"]
    for radius in (35e-3, 36e-3, 38e-3):
        half = float(gear.tooth.half_thickness_angle(radius / 3e-3))
        height, chord = 39.5e-3 - radius * math.cos(half), 2.0 * radius * math.sin(half)
        keys = {"teeth": 24, "module": "3 mm", "tip_diameter": "79 mm"}
        made = scene_of(**keys, chordal_thickness=mm(chord), chordal_height=mm(height)).gears["a"]
        assert made.tooth.profile_shift == pytest.approx(0.3, abs=1e-12)


def test_limits_of_a_drawing_are_taken_in_their_middle():
    keys = {"teeth": 24, "module": "3 mm", "span_teeth": 3}
    both = scene_of(**keys, span=["23.33 mm", "23.37 mm"])
    assert both.gears == scene_of(**keys, span="23.35 mm").gears
    assert both.derived == ("Gear a: profile shift coefficient x = 0.09776 derived from span = 23.35 mm over 3 teeth.",)


def test_din_3967_gives_the_example_of_the_standard_and_its_middle():
    limits = thickness_limits("27cd", 0.1)
    assert (limits.upper, limits.upper + limits.tolerance) == pytest.approx((70e-6, 170e-6))
    for text in ("cd27", "27cd", "DIN 3967 cd27", "DIN 3967-27 cd"):
        gear = scene_of(teeth=50, module="2 mm", thickness_allowance=text).gears["a"]
        assert gear.tooth.thickness_allowance * gear.module == pytest.approx(120e-6)


def test_allowances_of_din_3967_change_where_its_rows_end():
    assert thickness_limits("a21", 10e-3).upper == pytest.approx(100e-6)
    assert thickness_limits("a21", 10.001e-3).upper == pytest.approx(135e-6)
    assert thickness_limits("h30", 10.0).tolerance == pytest.approx(2400e-6)
    series = ("a", "ab", "b", "bc", "c", "cd", "d", "e", "f", "g", "h")
    for low, high in zip((5e-3, 30e-3, 0.1, 0.2), (30e-3, 0.1, 0.2, 0.4), strict=True):
        for letter in series[:-1]:
            small, large = thickness_limits(f"{letter}25", low), thickness_limits(f"{letter}25", high)
            assert small.upper < large.upper
            assert small.tolerance < large.tolerance
    with pytest.raises(InputError, match="up to a reference diameter of 10000 mm"):
        thickness_limits("cd25", 10.1)


def test_other_names_of_the_module_and_of_the_pressure_angle():
    plain = scene_of(teeth=20, module="3 mm").gears["a"]
    assert scene_of(teeth=20, circular_pitch=mm(math.pi * 3e-3)).gears["a"].module == pytest.approx(plain.module)
    helical = {"teeth": 20, "helix_angle": "30 deg", "hand": "left", "face_width": "20 mm"}
    normal = scene_of(**helical, normal_module="3 mm", pressure_angle="20 deg").gears["a"]
    pitch = scene_of(**helical, normal_circular_pitch=mm(math.pi * 3e-3)).gears["a"]
    across = scene_of(
        **helical, transverse_module=mm(normal.transverse_module),
        transverse_pressure_angle=f"{math.degrees(normal.transverse_pressure_angle)!r} deg",
    )  # fmt: skip
    for made in (pitch, across.gears["a"]):
        assert made.module == pytest.approx(3e-3, rel=1e-14)
        assert made.base_radius == pytest.approx(normal.base_radius, rel=1e-14)
    assert len(across.derived) == 2


@pytest.mark.parametrize(("teeth", "helix"), [(10, 0.0), (12, 0.0), (17, 0.0), (18, 0.0), (60, 0.0), (12, 25.0)])
def test_no_undercut_is_the_minimum_without(teeth, helix):
    keys = {"teeth": teeth, "module": "3 mm"}
    if helix:
        keys = {"teeth": teeth, "normal_module": "3 mm", "helix_angle": f"{helix} deg", "hand": "left"}
        keys["face_width"] = "20 mm"
    for more in ({}, {"thickness_allowance": "60 um"}, {"rack": "ISO 53 D"}):
        tooth = scene_of(**keys, **more, profile_shift="no-undercut").gears["a"].tooth
        assert not tooth.undercut
        if tooth.profile_shift > 0.0:
            assert scene_of(**keys, **more, profile_shift=tooth.profile_shift - 1.1e-4).gears["a"].tooth.undercut
        else:
            assert tooth.least_profile_shift < 0.0


def test_rings_take_the_sign_of_the_handbook():
    """KHK 16/24, m 3: x2 = 0.516 makes the ring larger, and a = 13.2 mm greater than that of x = 0, 12 mm."""
    ring = {"internal": True, "teeth": 24, "module": "3 mm", "cutter": {"teeth": 16}, "tip_diameter": "71 mm"}
    khk = scene_of(**ring, profile_shift=0.516, profile_shift_sign="khk")
    assert khk.gears == scene_of(**ring, profile_shift=-0.516).gears
    assert "x = -0.516 in the sign of ISO 21771" in khk.derived[0]
    assert "0.516 in that of KHK" in khk.derived[0]


REFUSED = [
    ({"profile_shift": 0.1, "span": "23.3 mm", "span_teeth": 3}, "gear.a.span", "contradicts profile_shift"),
    ({"span": "23.3 mm"}, "gear.a.span_teeth", "is required for span"),
    ({"span": "23.3 mm", "span_teeth": 3, "tooth_thickness": "4.7 mm"}, "gear.a.span", "contradicts tooth_thickness"),
    ({"over_balls": "80 mm"}, "gear.a.ball_diameter", "is required for over_balls"),
    ({"over_balls": "8 mm", "ball_diameter": "5 mm"}, "gear.a.over_balls", "puts the balls within the base circle"),
    ({"chordal_thickness": "4.7 mm", "chordal_height": "3 mm"}, "gear.a.tip_diameter", "is required"),
    ({"chordal_height": "3 mm"}, "gear.a.chordal_height", "requires chordal_thickness"),
    ({"thickness_allowance": "derived"}, "gear.a.thickness_allowance", "requires the thickness"),
    ({"thickness_allowance": "cd99"}, "gear.a.thickness_allowance", "neither a length nor"),
    ({"span": ["23 mm"], "span_teeth": 3}, "gear.a.span", "must be one length or both its limits"),
    ({"span": "43.3 mm", "span_teeth": 3}, "gear.a.span", "gives x = "),
    ({"span": "23.3 mm", "span_teeth": 9}, "gear.a.span", "gives x = "),
    ({"span_teeth": 9}, "gear.a.span_teeth", "outside the involute"),
    ({"circular_pitch": "9 mm"}, "gear.a.circular_pitch", "contradicts module"),
    (
        {"profile_shift": 0.0, "thickness_allowance": "derived", "tooth_thickness": "5 mm"}, "gear.a.tooth_thickness",
        "thicker than profile_shift does",
    ),
    ({"profile_shift": "least"}, "gear.a.profile_shift", "no-undercut"),
]  # fmt: skip


@pytest.mark.parametrize(("keys", "key", "rule"), REFUSED)
def test_contradictions_are_refused_in_one_sentence(keys, key, rule):
    with pytest.raises(InputError) as refused:
        scene_of(teeth=24, module="3 mm", **keys)
    assert refused.value.key == key
    assert rule in str(refused.value)
    assert "\n" not in str(refused.value)


def test_rings_are_measured_as_rings_can_be():
    ring = {"internal": True, "teeth": 60, "module": "3 mm", "cutter": {"teeth": 20}, "tip_diameter": "175 mm"}
    for keys in ({"span": "60 mm", "span_teeth": 7}, {"chordal_thickness": "4.7 mm"}):
        with pytest.raises(InputError, match="cannot be measured on an internal gear"):
            scene_of(**ring, **keys)
    with pytest.raises(InputError, match="applies only to external gears"):
        scene_of(**ring, profile_shift="no-undercut")


def test_numbers_of_a_tooth_are_those_of_the_tooth():
    gear = scene_of(teeth=33, normal_module="2 mm", helix_angle="18 deg", hand="left", face_width="20 mm").gears["a"]
    numbers = ToothNumbers(33, math.radians(20.0), math.radians(18.0))
    for name in ("pitch_radius", "base_radius"):
        assert getattr(numbers, name) == pytest.approx(getattr(gear.tooth, name), rel=1e-15)
    assert numbers.base_helix_cosine == pytest.approx(math.cos(gear.base_helix_angle), rel=1e-15)
