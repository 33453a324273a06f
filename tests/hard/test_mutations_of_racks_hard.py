"""Random mutations of racks: one sentence, or a rack whose numbers are finite (seeded: a number is one mutation)."""

from __future__ import annotations

import random
import traceback
import warnings
from pathlib import Path

import numpy as np
import pytest
from mutations import failures, mutated, sentence

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

GEARS = {
    "p": {"teeth": 20, "module": "2 mm", "profile_shift": 0.3, "face_width": "20 mm"},
    "h": {"teeth": 17, "normal_module": "2 mm", "helix_angle": "15 deg", "hand": "left", "face_width": "20 mm"},
}
RACKS = [
    {
        "pinion": "p", "teeth": 12, "reference_height": "10 mm", "face_width": "15 mm", "backlash": "40 um",
        "force": "2 kN", "positions": 16, "support": "pins", "pin_every": 4, "first_pin": 2, "pin_width": "3 mm",
        "thickness_allowance": "10 um", "tip_chamfer": "0.1 mm",
        "tip_relief": {"amount": "6 um", "height": "0.6 mm", "shape": "parabolic"},
        "basic_rack": {"addendum": 1.0, "dedendum": 1.25, "tip_radius": 0.3},
        "material": {"young_modulus": "70 GPa", "poisson_ratio": 0.33},
    },
    {
        "pinion": "p", "teeth": 5, "reference_height": "8 mm", "mounting_distance": "28.7 mm", "torque": "40 N*m",
        "tip_radius_rounding": "0.2 mm", "support": "back", "basic_rack": "ISO 53 A", "material": "42CrMo4",
        "tip_relief": {"amount": "6 um", "length": "1 mm"},
    },
    {
        "pinion": "h", "teeth": 7, "reference_height": "8 mm", "width": "solid", "face_width": "12 mm",
        "backlash": "20 um", "force": "1 kN", "tip_radius_rounding": "0.1 mm", "positions": 12,
        "support": "pins", "pin_every": 3,
    },
]  # fmt: skip


def judge(number):
    """Empty if a mutation is refused in a sentence, or gives finite numbers."""
    draw = random.Random(number)  # noqa: S311
    own = mutated(draw.choice(RACKS), draw)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            asked = {"results": ["rack-geometry"], "effects": {"relief": True}}
            scene = build_scene(asked | {"gear": GEARS, "rack": {"r": own}}, "racks", Path())
            results = run_plan(scene, make_plan(scene, STAGES))
            assert all(np.isfinite(value.si) for value in results.values)
    except FegearError as refusal:
        return sentence(refusal)
    except Exception:  # noqa: BLE001  (any other is what is looked for)
        return traceback.format_exc(limit=-4)
    return ""


def test_a_sample_of_mutated_racks_is_refused_in_a_sentence_or_answered():
    assert failures(judge, range(0, 100, 5)) == ""


@pytest.mark.long
def test_mutated_racks_are_refused_in_a_sentence_or_answered():
    assert failures(judge, range(200)) == ""
