"""Span and chord of a gear against points of its flanks: a disc touches where its plane is tangent to the involute."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.inspection import chord, span, span_teeth, usual_span
from fegear.geometry.rack import BasicRack

MODULE = 3e-3


def gear(teeth=9, shift=0.5, helix=0.0, width=20e-3):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), shift, helix_angle=math.radians(helix))
    hand = "right" if helix else "spur"
    return Gear(tooth, MODULE, 0.4 * tooth.root_radius * MODULE, width, hand=hand)


def between_planes(one, teeth):
    """Smallest distance of two parallel planes that touch the outer flanks of so many teeth; spur gears."""
    z, base = one.tooth.teeth, one.base_radius
    pitch = one.tooth.pitch_radius * one.module
    half = 0.5 * one.module * (0.5 * math.pi + 2.0 * one.tooth.profile_shift * math.tan(math.radians(20.0))) / pitch
    inv = math.tan(math.radians(20.0)) - math.radians(20.0)
    outer = half + (teeth - 1) * math.pi / z  # of the last flank at the reference circle, from the middle of all teeth
    t = np.linspace(0.0, math.acos(base / one.involute_tip_radius) ** 0.5, 200001) ** 2  # pressure angle
    r, angle = base / np.cos(t), outer + inv - (np.tan(t) - t)
    return 2.0 * float((r * np.sin(angle)).max())


@pytest.mark.parametrize("teeth", [1, 2])
def test_a_span_is_the_distance_of_planes_that_touch_the_outer_flanks(teeth):
    one = gear()
    assert span(one, teeth) == pytest.approx(between_planes(one, teeth), rel=1e-9)


def test_a_span_grows_by_a_base_pitch_for_each_tooth_and_begins_with_one():
    one = gear(30, 0.0, 12.0)
    found = {teeth: span(one, teeth) for teeth in (3, 4, 5)}
    assert found[4] - found[3] == pytest.approx(one.base_pitch * math.cos(one.base_helix_angle), rel=1e-12)
    assert found[5] - found[4] == pytest.approx(found[4] - found[3], rel=1e-12)
    for wrong in (0, -1):
        with pytest.raises(GeometryError, match="must be at least 1"):
            span(gear(), wrong)
    with pytest.raises(GeometryError, match="outside the involute"):
        span(one, 9)


def test_discs_beside_a_helical_gear_need_a_face_as_wide_as_they_touch_apart():
    one = gear(30, 0.0, 25.0)
    apart = span(one, 5) * math.sin(one.base_helix_angle)
    assert span(gear(30, 0.0, 25.0, apart * (1.0 + 1e-9)), 5) == span(one, 5)
    narrow = gear(30, 0.0, 25.0, apart * (1.0 - 1e-9))
    with pytest.raises(GeometryError, match="over 5 teeth"):
        span(narrow, 5)
    assert usual_span(gear(30, 0.0, 25.0, 1e-3)) is None


@pytest.mark.parametrize("width", [20e-3, 10e-3, 7e-3, 5e-3, 3e-3, 2e-3])
@pytest.mark.parametrize(("teeth", "shift"), [(30, 0.0), (12, 0.5), (60, 0.0)])
def test_a_narrow_face_takes_as_many_teeth_as_it_can(teeth, shift, width):
    one, possible = gear(teeth, shift, 25.0, width), {}
    for k in range(1, span_teeth(one) + 1):
        try:
            possible[k] = span(one, k)
        except GeometryError:
            continue
    assert usual_span(one) == (max(possible.items()) if possible else None)


def test_neither_rings_nor_asymmetric_teeth_have_a_usual_span():
    for one in (Space(internal=True), Space(internal=False)):
        assert usual_span(Space(tooth=one, asymmetric=not one.internal)) is None
        assert all(map(math.isnan, chord(Space(tooth=one, asymmetric=not one.internal))))
    with pytest.raises(GeometryError, match="measurement between balls"):
        span(Space(tooth=Space(internal=True)), 3)


@pytest.mark.parametrize("one", [
    gear(), gear(17, 0.0), gear(40, 0.3), gear(41, 1.0), gear(44, 0.7), gear(30, 0.0, 15.0), gear(60, 0.1, 30.0, 0.5),
    gear(43, 0.5, 35.0, 0.5),
])  # fmt: skip
def test_the_usual_number_touches_nearest_to_the_middle_of_the_involute(one):
    middle = 0.5 * (one.form_radius + one.involute_tip_radius)
    off = {}
    for teeth in range(1, one.tooth.teeth // 2):
        try:
            lean = math.cos(one.base_helix_angle)
            off[teeth] = abs(math.hypot(one.base_radius, 0.5 * span(one, teeth) * lean) - middle)
        except GeometryError:
            continue
    assert span_teeth(one) == min(off, key=off.get)
    assert usual_span(one) == (span_teeth(one), span(one, span_teeth(one)))


def test_a_chord_lies_below_the_tip_by_its_height():
    one = gear(20, 0.2)
    thickness, height = chord(one)
    pitch = one.tooth.pitch_radius * MODULE
    arc = MODULE * (0.5 * math.pi + 0.4 * math.tan(math.radians(20.0)))
    # on a cylinder through the flanks at the reference circle
    assert thickness == pytest.approx(2.0 * pitch * math.sin(0.5 * arc / pitch), rel=1e-12)
    assert height == pytest.approx(one.tooth.tip_radius * MODULE - pitch * math.cos(0.5 * arc / pitch), rel=1e-12)


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_discs_touch_up_to_the_tip_and_no_farther(helix):
    """Where the normal of the flank that is half a span long meets the involute: r_b, and W / 2 cos(beta_b) across."""
    one = gear(30, 0.0, helix)
    touched = math.hypot(one.base_radius, 0.5 * span(one, 5) * math.cos(one.base_helix_angle)) / MODULE
    for off, good in ((1e-9, True), (-1e-9, False)):
        cut = replace(one, tooth=replace(one.tooth, tip_radius=touched * (1.0 + off)))
        if good:
            assert span(cut, 5) == pytest.approx(span(one, 5), rel=1e-12)
        else:
            with pytest.raises(GeometryError, match=f"{touched * MODULE * 1e3:.6g} mm, outside the involute"):
                span(cut, 5)
