"""Random mutations of the keys by which a drawing is typed in: one sentence, or a gear whose numbers are finite.

The mutator is seeded, so that what it finds can be found again: number `n` is always the same mutation.
"""

from __future__ import annotations

import math
import random
import traceback
import warnings
from pathlib import Path

import pytest
from mutations import failures, mutated, processor_seconds, sentence

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.geometry.gear_data import GearData

SPUR = {"teeth": 24, "face_width": "30 mm"}
HELIX = {**SPUR, "helix_angle": "18 deg", "hand": "left"}
RING = {"teeth": 61, "module": "3 mm", "internal": True, "cutter": {"teeth": 20}, "tip_diameter": "179 mm"}
#: Gears, and keys of one of them that are mutated; keys of the pair of two gears.
DRAWN = [
    (SPUR, {"module": "3 mm", "span": ["23.33 mm", "23.37 mm"], "span_teeth": 3}),
    (SPUR, {"module": "3 mm", "over_balls": "80.2 mm", "ball_diameter": "5.3 mm", "thickness_allowance": "cd25"}),
    (SPUR, {"circular_pitch": "9.42 mm", "tooth_thickness": "4.9 mm", "rack": "DIN 867"}),
    (SPUR, {"module": "3 mm", "chordal_thickness": "4.9 mm", "chordal_height": "3.2 mm", "tip_diameter": "78.4 mm"}),
    (SPUR, {"module": "3 mm", "profile_shift": 0.2, "thickness_allowance": "derived", "tooth_thickness": "5 mm"}),
    (SPUR, {"module": "3 mm", "profile_shift": "no-undercut", "rack": "1.25/0.38/1.0", "tolerance_class": "ISO 1328 6",
     }),
    (SPUR, {"module": "3 mm", "rack": "DIN 3972 II", "material": "18CrNiMo7-6", "strength": {"steel": "16MnCr5"}}),
    (SPUR, {"module": "3 mm", "material": {"name": "POM", "poisson_ratio": 0.35}}),
    (HELIX, {"transverse_module": "3.2 mm", "transverse_pressure_angle": "21 deg", "over_pins": "89.2 mm",
             "ball_diameter": "5.6 mm"}),
    (HELIX, {"normal_circular_pitch": "9.42 mm", "span": "32.3 mm", "span_teeth": 4}),
    (RING, {"profile_shift": 0.3, "profile_shift_sign": "khk"}),
    (RING, {"over_balls": "174.7 mm", "ball_diameter": "5.3 mm"}),
]  # fmt: skip
PAIRED = [
    {"power": "4 hp", "speed": "1450 rpm"},
    {"shift_distribution": "equal-sliding", "centre_distance": "92 mm"},
    {"shift_distribution": "driven", "centre_distance": "91 mm", "normal_backlash": "80 um"},
    {"shift_distribution": "equal", "centre_distance": "91 mm", "circumferential_backlash": "0.1 mm"},
]


def drawn(number):
    """Tables of a case with mutated keys of a drawing."""
    draw = random.Random(number)  # noqa: S311
    if number % 4 == 0:
        gears = {name: {**SPUR, "module": "3 mm", "teeth": teeth} for name, teeth in (("a", 24), ("b", 36))}
        return {"gear": gears, "pair": {"I": {"driver": "a", "driven": "b", **mutated(draw.choice(PAIRED), draw)}}}
    kept, keys = draw.choice(DRAWN)
    return {"gear": {"a": {**kept, **mutated(keys, draw)}}}


def judge(number):
    """Empty if a mutation is refused in a sentence, or gives a gear with finite numbers."""
    try:
        with processor_seconds(20.0), warnings.catch_warnings():
            warnings.simplefilter("error")
            scene = build_scene({"results": ["geometry"], **drawn(number)}, "mutated", Path())
            for name, gear in scene.gears.items():
                data = GearData(gear, True, None, None, {}, name)
                assert math.isfinite(data.profile_shift)
                assert math.isfinite(data.tooth_thickness)
                assert scene.case.gear[name].allowance >= 0.0
            assert all(note.endswith(".") and "nan" not in note for note in scene.derived), scene.derived
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001  (any other is what is looked for)
        return traceback.format_exc(limit=-4)
    return ""


def test_what_is_not_mutated_is_a_gear():
    for kept, keys in DRAWN:
        assert build_scene({"results": ["geometry"], "gear": {"a": {**kept, **keys}}}, "case", Path()).gears


def test_a_sample_of_mutated_drawings_is_refused_in_a_sentence_or_answered():
    assert failures(judge, range(0, 500, 10)) == ""


@pytest.mark.long
def test_mutated_drawings_are_refused_in_a_sentence_or_answered():
    assert failures(judge, range(500)) == ""
