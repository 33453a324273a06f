"""ISO 1328-1:2013 flank tolerances: formulas, classes, rounding and ranges."""

import math
from itertools import pairwise

import pytest

from fegear.base.errors import RangeError
from fegear.formulas.iso1328 import flank_tolerances, rounded, tolerances_of
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

UM = 1e-6
NAMES = (
    "single_pitch", "cumulative_pitch", "profile_slope", "profile_form", "profile_total", "helix_slope", "helix_form",
    "helix_total",
)  # fmt: skip


def in_um(tolerances):
    return [getattr(tolerances, name) / UM for name in NAMES]


def test_class_5_by_hand():
    """d = 100 mm, b = 25 mm, m_n = 4 mm: every root is a whole number, so the formulas can be worked on paper."""
    expected = [6.7, 20.5, 5.7, 7.2, math.sqrt(5.7**2 + 7.2**2), 6.25, 6.95, math.sqrt(6.25**2 + 6.95**2)]
    assert in_um(flank_tolerances(5, 0.1, 4e-3, 25e-3)) == pytest.approx(expected, rel=1e-12)
    assert in_um(flank_tolerances(5, 0.1, 4e-3, 25e-3).rounded) == pytest.approx([6.5, 21, 5.5, 7, 9, 6.5, 7, 9.5])


def test_class_6_as_another_program_rounds_it():
    """d = 120 mm, m_n = 3 mm, class 6: f_pT 9.0, F_pT 29, F_alphaT 12 um, values of an open-source calculator."""
    values = flank_tolerances(6, 0.12, 3e-3, 30e-3).rounded
    assert values.single_pitch / UM == pytest.approx(9.0)
    assert values.cumulative_pitch / UM == pytest.approx(29.0)
    assert values.profile_total / UM == pytest.approx(12.0)


def test_two_classes_double_every_tolerance():
    all_classes = [flank_tolerances(one, 0.3, 5e-3, 80e-3) for one in range(1, 12)]
    for fine, coarse in zip(all_classes, all_classes[2:], strict=False):
        assert in_um(coarse) == pytest.approx([2.0 * value for value in in_um(fine)], rel=1e-14)
    for fine, coarse in pairwise(all_classes):
        assert all(a < b for a, b in zip(in_um(fine), in_um(coarse), strict=True))


@pytest.mark.parametrize(
    ("exact", "printed"),
    [(0.04, 0.0), (4.949, 4.9), (4.95, 5.0), (5.0, 5.0), (5.24, 5.0), (5.25, 5.5), (9.74, 9.5), (9.75, 10.0),
     (10.0, 10.0), (10.4, 10.0), (10.5, 11.0), (123.5, 124.0)],
)  # fmt: skip
def test_rounding(exact, printed):
    assert rounded(exact * UM) / UM == pytest.approx(printed, abs=1e-9)


def test_base_pitch_is_the_pitch_along_the_line_of_action():
    values = flank_tolerances(7, 0.1, 4e-3, 25e-3)
    assert values.base_pitch(math.radians(20.0)) == pytest.approx(values.single_pitch * math.cos(math.radians(20.0)))


@pytest.mark.parametrize(
    ("change", "key"),
    [({"tolerance_class": 0}, "tolerance_class"), ({"tolerance_class": 12}, "tolerance_class"),
     ({"reference_diameter": 4.9e-3}, "reference_diameter"), ({"reference_diameter": 15.1}, "reference_diameter"),
     ({"normal_module": 0.49e-3}, "normal_module"), ({"normal_module": 71e-3}, "normal_module"),
     ({"face_width": 3.9e-3}, "face_width"), ({"face_width": 1.21}, "face_width")],
)  # fmt: skip
def test_outside_the_ranges_nothing_is_extrapolated(change, key):
    inside = {"tolerance_class": 6, "reference_diameter": 0.1, "normal_module": 3e-3, "face_width": 20e-3}
    with pytest.raises(RangeError) as refused:
        flank_tolerances(**(inside | change))
    assert refused.value.key == key


def test_limits_themselves_are_inside():
    finest, coarsest = flank_tolerances(1, 5.0 * 1e-3, 0.5e-3, 4.0 * 1e-3), flank_tolerances(11, 15.0, 70e-3, 1.2)
    for name in ("single_pitch", "cumulative_pitch", "profile_total", "helix_total"):
        assert 0.0 < getattr(finest, name) < getattr(coarsest, name) < 3e-3


def test_a_gear_is_taken_by_its_reference_diameter_and_normal_module():
    gear = Gear(Tooth(40, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(30.0)), 3e-3, 10e-3, 30e-3, hand="left")
    d = 40 * 3e-3 / math.cos(math.radians(30.0))
    assert tolerances_of(gear, 6) == flank_tolerances(6, d, 3e-3, 30e-3)
