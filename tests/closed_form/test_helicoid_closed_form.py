"""Helical flanks against the paper's own formulas, against each other and against differences of their points."""

import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import given
from hypothesis import strategies as st

from fegear.contact.unloaded.manufacture import as_cut
from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.rack_cutter import RackFlank

DEG = math.pi / 180.0


@st.composite
def helical_gears(draw, low_teeth=18):
    beta = draw(st.sampled_from([0.0, 1e-9, 0.01, 0.3, 0.6]))
    hand = "spur" if beta == 0.0 else draw(st.sampled_from(["left", "right"]))
    return helical_gear(
        draw(st.integers(low_teeth, 200)), draw(st.sampled_from([1e-3, 5e-3])), 20.0 * DEG, beta, 0.03, hand,
        profile_shift=draw(st.sampled_from([0.0, 0.4, -0.25])), thickness_allowance=draw(st.sampled_from([0.0, 0.02])),
    )  # fmt: skip


def grid(flank, n=6):
    s = np.linspace(flank.s_form + 0.02 * (flank.s_tip - flank.s_form), flank.s_tip, n)
    half = 0.5 * flank.gear.face_width
    return np.meshgrid(s, np.linspace(-half, half, n))


def test_surfaces_are_those_of_appendix_1():
    gear = helical_gear(30, 5.08e-3, 20.0 * DEG, 30.0 * DEG, 0.04, "left")
    rb, mu, p = gear.base_radius, gear.half_base_space_angle, 1.0 / abs(gear.twist)
    lb = math.atan(p / rb)
    assert lb == pytest.approx(
        math.atan(1.0 / math.tan(gear.helix_angle) / math.cos(gear.transverse_pressure_angle)), abs=1e-15
    )
    u, theta = np.meshgrid(np.linspace(0.02, 0.05, 5), np.linspace(-0.2, 0.9, 5))
    a = theta + mu
    paper = np.stack([
        rb * np.cos(a) + u * math.cos(lb) * np.sin(a), -rb * np.sin(a) + u * math.cos(lb) * np.cos(a),
        -u * math.sin(lb) + p * theta,
    ])  # fmt: skip
    normal = -np.stack([math.sin(lb) * np.sin(a), math.sin(lb) * np.cos(a), np.full_like(a, math.cos(lb))])
    flank = InvoluteHelicoid.of(gear, "space")
    assert np.abs(flank.points(u * math.cos(lb), paper[2]) - paper).max() < 1e-15
    assert np.abs(flank.normals(u * math.cos(lb), paper[2]) + normal).max() < 1e-14  # the paper's point inward

    gear = helical_gear(100, 5.08e-3, 20.0 * DEG, 30.0 * DEG, 0.04, "right")
    rb, eta, p = gear.base_radius, gear.half_base_tooth_angle, 1.0 / gear.twist
    a = theta - eta
    paper = np.stack([
        rb * np.cos(a) + u * math.cos(lb) * np.sin(a), -rb * np.sin(a) + u * math.cos(lb) * np.cos(a),
        u * math.sin(lb) - p * theta,
    ])  # fmt: skip
    normal = np.stack([math.sin(lb) * np.sin(a), math.sin(lb) * np.cos(a), np.full_like(a, -math.cos(lb))])
    flank = InvoluteHelicoid.of(gear, "tooth")
    assert np.abs(flank.points(u * math.cos(lb), paper[2]) - paper).max() < 1e-15
    assert np.abs(flank.normals(u * math.cos(lb), paper[2]) - normal).max() < 1e-14


@given(helical_gears())
def test_straight_rack_generates_the_involute_helicoid(gear):
    flank, helicoid = RackFlank(gear), InvoluteHelicoid.of(gear, "space")
    s, z = grid(flank)
    X = flank.points(s, z)
    assert np.abs(helicoid.separation_angle(X)).max() < 2e-15
    t = helicoid.tangent_length(np.hypot(X[0], X[1]))
    assert np.abs(helicoid.normals(t, z) - flank.normals(s, z)).max() < 1e-10
    assert flank.profile_curvature(s) * t == pytest.approx(np.ones_like(t), rel=1e-9)


@given(helical_gears(), st.sampled_from([0.0, 1.5, -0.5]), st.sampled_from([0.0, 5.0]))
def test_derivative_normal_and_curvature_of_the_generated_flank_agree_with_differences(gear, parabola, crown):
    flank = RackFlank(gear, parabola, crown)
    s, z = grid(flank)
    s = s - 0.01 * (flank.s_tip - flank.s_form)
    h = 1e-6 * gear.module
    ws = (flank.profile(s + h)[0] - flank.profile(s - h)[0]) / (2.0 * h)
    assert np.abs(ws - flank.profile(s)[1]).max() < 1e-7
    xs = (flank.points(s + h, z) - flank.points(s - h, z)) / (2.0 * h)
    xz = (flank.points(s, z + h) - flank.points(s, z - h)) / (2.0 * h)
    n = flank.normals(s, z)
    assert np.abs(np.linalg.norm(n, axis=0) - 1.0).max() < 1e-14
    assert np.abs((n * xs).sum(0)).max() < 1e-7
    assert np.abs((n * xz).sum(0)).max() < 1e-6
    d = flank.profile(s)[1]
    turn = np.angle(flank.profile(s + h)[1] / flank.profile(s - h)[1]) / (2.0 * h)
    assert -turn / np.abs(d) * gear.module == pytest.approx(
        flank.profile_curvature(s) * gear.module, rel=1e-5, abs=1e-7
    )


@given(helical_gears())
def test_helicoid_is_developable_and_its_separation_is_a_distance(gear):
    flank = InvoluteHelicoid.of(gear, "tooth")
    t, z = np.meshgrid(np.linspace(0.2, 0.6, 5) * gear.base_radius, np.linspace(-0.01, 0.01, 5))
    X, n, g = flank.points(t, z), flank.normals(t, z), flank.generators(t, z)
    length = 0.01 * gear.base_radius
    assert np.abs(flank.separation_angle(X + length * g)).max() < 1e-13, "generators lie in the surface"
    across = np.cross(n, g, axis=0)
    h = 1e-3 * gear.base_radius
    # Along the other principal direction the surface falls away by curvature h^2/2; separation = distance / (r_b cos).
    bend = flank.separation_angle(X + h * across) * gear.base_radius * math.cos(flank.base_helix_angle)
    assert 2.0 * bend / h**2 == pytest.approx(flank.curvature(t), rel=2e-2)
    off = flank.separation_angle(X + h * n) * gear.base_radius * math.cos(flank.base_helix_angle)
    assert off == pytest.approx(np.full_like(off, h), rel=1e-9)


@given(helical_gears(low_teeth=11))
def test_the_generated_flank_reaches_from_the_form_circle_to_the_tip(gear):
    flank = RackFlank(gear)
    ends = [abs(complex(flank.profile(s)[0])) for s in (flank.s_form, flank.s_tip)]
    assert ends == pytest.approx([gear.form_radius, gear.involute_tip_radius], rel=1e-9)


def test_parabola_removes_what_the_cutter_adds():
    gear = helical_gear(30, 5.08e-3, 20.0 * DEG, 30.0 * DEG, 0.04, "left")
    a_c = 0.02  # small: the common normal turns by 2 a_c s, so that the loss is a_c s^2 to first order only
    flank, helicoid = RackFlank(gear, a_c), InvoluteHelicoid.of(gear, "space")
    s = np.linspace(flank.s_form, flank.s_tip, 41)
    depth = (
        -helicoid.separation_angle(flank.points(s, 0.0 * s)) * gear.base_radius * math.cos(helicoid.base_helix_angle)
    )
    # Generation keeps distances along the common normal: what the cutter adds is what the flank loses.
    assert depth == pytest.approx(a_c * s**2, rel=2e-3, abs=1e-13)
    crowned = RackFlank(gear, 0.0, 3.0)
    z = np.linspace(-0.02, 0.02, 11)
    assert helicoid.separation_angle(crowned.points(0.0 * z, z)) == pytest.approx(-3.0 * z**2, abs=1e-15)


def test_relations_of_appendix_2():
    gear = helical_gear(30, 0.0254 / 5.0, 20.0 * DEG, 30.0 * DEG, 0.04, "left")
    h = 1e-6
    # (15) to (17), differentials of the design parameters by the profile angle.
    up, down = as_cut(gear, profile_angle=h), as_cut(gear, profile_angle=-h)
    alpha_n, alpha_t = gear.normal_pressure_angle, gear.transverse_pressure_angle
    d_alpha_t = (up.transverse_pressure_angle - down.transverse_pressure_angle) / (2.0 * h)
    assert d_alpha_t == pytest.approx(math.sin(2.0 * alpha_t) / math.sin(2.0 * alpha_n), rel=1e-8)
    d_rb = (up.base_radius - down.base_radius) / (2.0 * h)
    assert d_rb == pytest.approx(-gear.pitch_radius * math.sin(alpha_t) * d_alpha_t, rel=1e-8)
    lb = 0.5 * math.pi - gear.base_helix_angle
    d_lb = -(up.base_helix_angle - down.base_helix_angle) / (2.0 * h)
    assert d_lb == pytest.approx(0.5 * math.sin(2.0 * lb) * math.tan(alpha_t) * d_alpha_t, rel=1e-8)
    assert 1.0 / abs(gear.twist) == pytest.approx(gear.pitch_radius / math.tan(gear.helix_angle), rel=1e-14)
