"""A default that is written out contradicts no other key; another value does."""

import pytest
from pydantic import ValidationError

from fegear.case.gear import GearPart
from fegear.case.shaft import BearingPart

BALLS = {"kind": "ball", "count": 9, "diameter": "12.7 mm", "pitch_diameter": "65 mm"}
RING = {
    "teeth": 60, "module": "3 mm", "internal": True, "tip_diameter": "176 mm", "rim_thickness": "10 mm",
    "cutter": {"teeth": 25, "addendum": 1.25, "tip_radius": 0.2},
}  # fmt: skip


def test_of_a_bearing_with_elements():
    written = BearingPart.model_validate({"elements": BALLS, "fixed": False})
    assert written.given == BearingPart.model_validate({"elements": BALLS}).given == {"elements"}
    with pytest.raises(ValidationError, match="contradicts other keys"):
        BearingPart.model_validate({"elements": BALLS, "fixed": True})


def test_of_an_internal_gear():
    assert GearPart.model_validate(RING | {"tooth_mesh_fillet": "rack"}).internal
    with pytest.raises(ValidationError, match="no meaning for an internal gear"):
        GearPart.model_validate(RING | {"rack": "ISO 53 C"})
