"""The generated tooth against the definitions of its curves."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.base.errors import GeometryError
from fegear.geometry.curves import arc_length
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.inspection import span, span_teeth
from fegear.geometry.involute import polar_angle, roll_of_polar_angle
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tip_interference import interference

racks = st.sampled_from(
    [
        BasicRack(1.0, 1.25, 0.25),
        BasicRack.named("A"),
        BasicRack.named("D"),
        BasicRack(1.0, 1.25, 0.0),
        BasicRack.full_fillet(),
    ]
)


@st.composite
def teeth(draw):
    z = draw(st.integers(8, 500))
    shift = draw(st.floats(-0.5, 0.8))
    rack = draw(racks)
    try:
        return Tooth(z, rack, shift, thickness_allowance=draw(st.sampled_from([0.0, 0.024])))
    except GeometryError:
        assume(False)


@given(teeth())
def test_fillet_and_involute_meet_in_one_point_and_tangent(tooth):
    junction = tooth.fillet.points(tooth.fillet.end) - tooth.involute.points(tooth.involute.start)
    assert np.abs(junction).max() < 1e-12 * max(1.0, tooth.teeth / 28)
    if not tooth.undercut:
        turn = tooth.fillet.normals(tooth.fillet.end) - tooth.involute.normals(tooth.involute.start)
        assert np.abs(turn).max() < 1e-9


@given(teeth())
def test_trochoid_lies_at_the_tip_radius_from_the_path_of_the_tip_centre(tooth):
    beta = np.linspace(tooth.fillet.start, tooth.fillet.end, 50)
    distance = np.hypot(*(tooth.fillet.points(beta) - tooth.fillet.centres(beta)))
    assert np.abs(distance - tooth.rack.tip_radius).max() < 1e-12 * max(1.0, tooth.teeth / 28)


@given(teeth())
def test_outline_is_closed_and_its_derivatives_agree_with_differences(tooth):
    pieces = list(tooth.outline.values())
    for left, right in itertools.pairwise(pieces):
        assert np.allclose(left.points(left.end), right.points(right.start), atol=1e-11)
    for piece in pieces:
        u = np.linspace(piece.start, piece.end, 9)[1:-1]
        h = 1e-4 * (piece.end - piece.start)
        d = (piece.points(u + h) - piece.points(u - h)) / (2 * h)
        assert np.allclose(np.hypot(*d), piece.speed(u), rtol=1e-5)
        assert np.allclose((d * piece.normals(u)).sum(axis=0) / np.hypot(*d), 0.0, atol=1e-5)


def test_observed_order_of_the_curvature_against_differences_of_the_normal():
    tooth = Tooth(17, BasicRack.named("A"), 0.1)
    piece, u = tooth.fillet, np.linspace(0.1, 0.9, 5)
    errors = []
    for h in (1e-2, 5e-3):
        dn = (piece.normals(u + h) - piece.normals(u - h)) / (2 * h)
        dp = (piece.points(u + h) - piece.points(u - h)) / (2 * h)
        errors.append(np.abs((dn * dp).sum(axis=0) / piece.speed(u) ** 2 - piece.curvatures(u)).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("roll", [1e-9, 1e-4, 0.01, 0.1499, 0.1501, 0.36, 1.0, 3.0])
def test_involute_function_keeps_its_digits_near_the_base_circle(roll):
    with mpmath.workdps(40):
        exact = mpmath.mpf(roll) - mpmath.atan(mpmath.mpf(roll))
    assert float(polar_angle(roll)) == pytest.approx(float(exact), rel=5e-15 if roll < 0.15 else 1e-13)
    assert float(roll_of_polar_angle(float(exact))) == pytest.approx(roll, rel=2e-14)


def test_full_fillet_rack_leaves_no_root_land():
    tooth = Tooth(30, BasicRack.full_fillet())
    assert tooth.root_land is None
    assert np.arctan2(*tooth.fillet.points(0.0)) == pytest.approx(math.pi / 30, abs=1e-14)


def test_the_widest_rack_tip_that_a_refusal_names_is_accepted():
    with pytest.raises(GeometryError, match="full fillet") as refused:
        BasicRack(1.0, 1.25, 0.5)
    widest = float(refused.value.remedy.split("at most ")[1].split()[0])
    assert BasicRack(1.0, 1.25, widest).full_fillet_radius == pytest.approx(widest, abs=1e-6)


def test_fillet_radius_at_the_root_circle_is_the_textbook_one():
    # Radius of curvature of a rack-cut trochoid at the root: rho + d^2 / (r + d), d = depth of the tip centre.
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    d = 1.0
    assert -1.0 / tooth.fillet.curvatures(0.0) == pytest.approx(0.25 + d * d / (14.0 + d), rel=1e-14)


def test_undercut_starts_at_the_textbook_tooth_number():
    # z_min = 2 (h_fP - rho (1 - sin alpha)) / sin^2 alpha = 17.097 for 20 deg and a working depth of one module.
    depth = 1.25 - 0.38 * (1.0 - math.sin(math.radians(20.0)))
    limit = 2.0 * depth / math.sin(math.radians(20.0)) ** 2
    assert Tooth(math.floor(limit), BasicRack.named("A")).undercut
    assert not Tooth(math.ceil(limit), BasicRack.named("A")).undercut


def test_tip_rounding_is_tangent_to_flank_and_tip_circle():
    tooth = Tooth(28, tip_rounding=0.12)
    edge = tooth.tip_edge
    assert np.allclose(edge.normals(edge.start), tooth.involute.normals(tooth.involute.end), atol=1e-13)
    assert np.hypot(*edge.points(edge.end)) == pytest.approx(15.0, rel=1e-14)
    assert np.allclose(edge.points(edge.start), tooth.involute.points(tooth.involute.end), atol=1e-13)


def test_chamfer_takes_as_much_off_the_tip_as_off_the_height():
    tooth = Tooth(28, tip_chamfer=0.1)
    sharp = Tooth(28)
    assert tooth.involute_tip_radius == pytest.approx(14.9)
    assert (float(sharp.half_thickness_angle(14.9)) - tooth.tip_half_angle) * 15.0 == pytest.approx(0.1, rel=1e-12)


def test_arc_length_of_the_involute_is_half_the_roll_squared():
    flank = Tooth(28).involute
    assert arc_length(flank)[1][-1] == pytest.approx(flank.base_radius * (flank.end**2 - flank.start**2) / 2, rel=1e-13)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"teeth": 28.5}, "whole number"),
        ({"teeth": 3}, "between 5"),
        ({"teeth": 28, "profile_shift": 3.0}, "choose"),
        ({"teeth": 10, "profile_shift": 0.9}, "pointed"),
        ({"teeth": 28, "tip_radius": 13.0}, "base radius"),
        ({"teeth": 28, "tip_radius": 13.2}, "no involute"),
        ({"teeth": 28, "tip_rounding": 0.7}, "tip"),
        ({"teeth": 28, "tip_rounding": 0.1, "tip_chamfer": 0.1}, "either"),
        ({"teeth": 28, "tip_chamfer": -0.1}, "negative"),
        ({"teeth": 28, "profile_shift": math.nan}, "finite"),
        ({"teeth": 28, "profile_shift": -3.0}, "thickness"),
    ],
)
def test_teeth_that_cannot_exist_are_refused_in_words(arguments, word):
    with pytest.raises(GeometryError, match=word):
        Tooth(**arguments)


@pytest.mark.parametrize(
    ("arguments", "word"),
    [((1.0, 1.25, 0.6, 0.35), "full fillet"), ((1.0, 4.0, 0.1, 0.35), "pointed"), ((1.0, -1.0, 0.1, 0.35), "positive")],
)
def test_racks_that_cannot_exist_are_refused_in_words(arguments, word):
    with pytest.raises(GeometryError, match=word):
        BasicRack(*arguments)


def _gear(teeth, shift=0.0, module=1e-3, **more):
    return Gear(Tooth(teeth, BasicRack.named("A"), shift, **more), module, 0.3 * teeth * module)


@given(st.integers(15, 120), st.integers(15, 120), st.floats(-0.2, 0.5), st.floats(0.0, 0.5))
def test_both_gears_see_the_same_path_of_contact(z1, z2, x1, x2):
    pair = GearPair(_gear(z1, x1), _gear(z2, x2))
    back = pair.reversed()
    assert back.x_start == pytest.approx(-pair.x_end, abs=1e-14)
    assert back.contact_ratio == pytest.approx(pair.contact_ratio, rel=1e-12)
    assert abs(pair.normal_backlash) < 1e-12
    x = np.linspace(pair.x_start, pair.x_end, 7)
    total = pair.flank_curvature_radius(x, "driver") + pair.flank_curvature_radius(x, "driven")
    assert np.allclose(total, pair.centre_distance * math.sin(pair.working_pressure_angle), rtol=1e-12)
    assert np.allclose(pair.x_of_radius(pair.radius(x, "driven"), "driven"), x, atol=1e-12)


def test_rack_cut_gears_without_undercut_run_clear_of_each_other_and_a_deep_tip_does_not():
    pair = GearPair(_gear(20), _gear(60))
    assert interference(pair, "driven").sentence == ""
    assert interference(pair, "driven").fillet_gap > 0.0
    long_tip = GearPair(_gear(20), _gear(60, tip_radius=31.24))
    assert "interferes" in interference(long_tip, "driven").sentence
    over = GearPair(_gear(20), _gear(60, tip_radius=31.3))
    assert "root circle" in interference(over, "driven").sentence


def test_contact_at_zero_backlash_distance_and_jammed_below_it():
    a, b = _gear(20, 0.3), _gear(30, 0.2)
    tight = GearPair(a, b)
    with pytest.raises(GeometryError, match="leaves no backlash"):
        GearPair(a, b, tight.centre_distance * 0.999)
    wide = GearPair(a, b, tight.centre_distance * 1.002)
    assert wide.normal_backlash > 0.0
    assert wide.contact_ratio < tight.contact_ratio


def test_bore_outside_the_body_and_unequal_base_pitches_are_refused():
    with pytest.raises(GeometryError, match="root radius"):
        Gear(Tooth(28), 1e-3, 13e-3)
    with pytest.raises(GeometryError, match="equal"):
        GearPair(_gear(20), _gear(20, module=1.1e-3))


@pytest.mark.parametrize(("z", "k", "span_1"), [(20, 3, 7.660439), (30, 4, 10.752626), (50, 6, 16.937000)])
def test_span_over_k_teeth_is_that_of_the_textbooks_tables(z, k, span_1):
    gear = Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25)), module=3e-3, bore_radius=1e-3)
    assert span_teeth(gear) == k
    assert span(gear, k) == pytest.approx(span_1 * 3e-3, rel=1e-6)


@given(teeth())
def test_span_is_the_distance_of_parallel_tangents_to_opposite_flanks(tooth):
    gear = Gear(tooth, module=1.0, bore_radius=0.1, material=Material(1.0))
    k = span_teeth(gear)
    length = span(gear, k)
    # The discs touch the outer flanks of k teeth, where these are parallel: the chord between both points is the span.
    radius = math.hypot(gear.base_radius, length / 2)
    turn = math.pi / tooth.teeth * (k - 1) + float(tooth.half_thickness_angle(radius))
    assert 2.0 * radius * math.sin(turn) == pytest.approx(length, rel=1e-10)


def test_span_beyond_the_involute_is_refused():
    gear = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), module=1e-3, bore_radius=1e-3)
    with pytest.raises(GeometryError, match="measure over 4 teeth"):
        span(gear, 8)
