"""The rack-cutter's way to the flanks, step by step: TM-107451, Appendix 5, against the flanks in closed form."""

import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import given
from hypothesis import strategies as st

from fegear.geometry.helicoid import InvoluteHelicoid
from fegear.geometry.rack_cutter import RackCutter, RackFlank

DEG, MODULE = math.pi / 180.0, 5.08e-3


def gear(beta=30.0, hand="left", teeth=30, **more):
    return helical_gear(teeth, MODULE, 20.0 * DEG, beta * DEG, 0.04, hand if beta else "spur", **more)


cutters = st.builds(
    lambda beta, hand, teeth, cuts, a, x: RackCutter(gear(beta, hand, teeth, **x), cuts, a),
    st.sampled_from([0.0, 5.0, 30.0, 45.0]), st.sampled_from(["left", "right"]), st.integers(20, 120),
    st.sampled_from(["pinion", "gear"]), st.sampled_from([0.0, 1.0, 3.15]),
    st.sampled_from([{}, {"profile_shift": 0.4}, {"profile_shift": -0.2, "thickness_allowance": 0.02}]),
)  # fmt: skip
places = st.floats(-1.0, 1.0).map(lambda x: x * MODULE)
lengths = st.floats(-0.02, 0.02)


@given(u=places, l=lengths, a=st.sampled_from([0.0, 3.15]))
def test_the_surfaces_are_those_of_the_printed_matrices(u, l, a):  # noqa: E741
    alpha, beta, a_m = 20.0 * DEG, 30.0 * DEG, 0.25 * math.pi * MODULE
    sin, cos = math.sin(beta), math.cos(beta)
    # A.5.6 and A.5.9 for the left-hand pinion, with +sin(beta) as element (3, 2); A.5.1 and A.5.5 for the gear.
    x, y = -u * math.cos(alpha) - a * u * u * math.sin(alpha), u * math.sin(alpha) - a * u * u * math.cos(alpha) - a_m
    matrix = np.array([[1, 0, 0, 0], [0, cos, -sin, -l * sin], [0, sin, cos, l * cos], [0, 0, 0, 1]])
    assert RackCutter(gear(), "pinion", a).points(u, l) == pytest.approx((matrix @ [x, y, 0, 1])[:3], abs=1e-16)
    r_c2 = [u * math.cos(alpha), a_m - u * math.sin(alpha), 0, 1]
    matrix = np.array([[1, 0, 0, 0], [0, cos, sin, l * sin], [0, -sin, cos, l * cos], [0, 0, 0, 1]])
    assert RackCutter(gear(hand="right"), "gear").points(u, l) == pytest.approx((matrix @ r_c2)[:3], abs=1e-16)


@given(cutters, places, lengths)
def test_normals_are_those_of_the_surface(cutter, u, l):  # noqa: E741
    d = 1e-7
    n = cutter.normals(u)
    along = cutter.points(u, l + d) - cutter.points(u, l - d)
    across = cutter.points(u + d, l) - cutter.points(u - d, l)
    N = np.cross(along, across)  # Eq. 20
    assert np.linalg.norm(n) == pytest.approx(1.0, rel=1e-14)
    assert n == pytest.approx(N / np.linalg.norm(N), abs=1e-7)


def test_the_printed_normal_is_no_unit_vector():
    """A.5.11 has cosines where sines belong."""
    alpha, beta, a, u = 20.0 * DEG, 30.0 * DEG, 3.15, 0.004
    y = -(math.cos(alpha) + 2 * a * u * math.cos(alpha)) * math.cos(beta)
    printed = np.array([-math.sin(alpha) + 2 * a * u * math.cos(alpha), y, y]) / math.sqrt(1 + 4 * a * a * u * u)
    assert abs(np.linalg.norm(printed) - 1.0) > 0.1
    assert np.linalg.norm(RackCutter(gear(), "pinion", a).normals(u)) == pytest.approx(1.0, rel=1e-14)


@given(cutters, places, lengths)
def test_the_normal_meets_the_instantaneous_axis_and_the_relative_velocity_has_no_part_along_it(cutter, u, l):  # noqa: E741
    side, psi, r = 1.0 if cutter.cuts == "gear" else -1.0, float(cutter.roll_angle(u, l)), cutter.gear.pitch_radius
    (x, y, _), n = cutter.points(u, l), cutter.normals(u)
    # A.5.13 with X = 0, Y = r_p2 psi_2 or -r_p1 psi_1.
    assert -x * n[1] == pytest.approx((side * r * psi - y) * n[0], abs=1e-14)
    d = 1e-6  # Eq. 22 in the gear's frame
    velocity = (cutter.rolled(cutter.points(u, l), psi + d) - cutter.rolled(cutter.points(u, l), psi - d)) / (2.0 * d)
    w = (n[0] + 1j * n[1]) * np.exp(1j * side * psi)
    assert velocity @ [w.real, w.imag, n[2]] == pytest.approx(0.0, abs=1e-9 * r)


@given(cutters, places, lengths)
def test_what_is_generated_lies_on_the_flank_in_closed_form(cutter, u, l):  # noqa: E741
    point = cutter.generated(u, l)
    if cutter.cuts == "pinion":
        flank = RackFlank(cutter.gear, cutter.parabola)
        assert point == pytest.approx(flank.points(-u, point[2]), abs=1e-15)
    if cutter.parabola == 0.0:
        axis = "space" if cutter.cuts == "pinion" else "tooth"
        if np.hypot(*point[:2]) > cutter.gear.base_radius:
            apart = InvoluteHelicoid.of(cutter.gear, axis).separation_angle(point)
            # Beside the base circle the involute's angle goes with the 3/2 power of the distance.
            assert apart * cutter.gear.pitch_radius == pytest.approx(0.0, abs=1e-12)
    assert cutter.along(u, point[2]) == pytest.approx(l, abs=1e-15)


@pytest.mark.parametrize("x", [0.0, 0.3])
def test_both_cutters_are_one_tool_and_touch_along_the_reference_line(x):
    pinion = RackCutter(gear(profile_shift=x), "pinion", 3.15)
    mate = RackCutter(gear(hand="right", profile_shift=-x), "gear")
    u = np.linspace(-MODULE, MODULE, 11)
    turned = -mate.normal_profile(u)  # the mate's cutter in the pinion's frame: turned by half a turn about z
    apart = np.hypot(*(pinion.normal_profile(u) - turned))
    assert apart == pytest.approx(3.15 * u**2, abs=1e-16)
    line = np.linspace(-0.02, 0.02, 5)
    x, y, z = mate.points(0.0, line)
    assert pinion.points(0.0, line) == pytest.approx(np.stack([-x, -y, z]), abs=1e-16)
