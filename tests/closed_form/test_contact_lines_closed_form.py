"""Lines of contact of aligned helical pairs: both flanks touch along them; their length and the field of contact."""

import dataclasses
import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import given
from hypothesis import strategies as st

from fegear.base.errors import InputError
from fegear.contact.unloaded.contact_lines import aligned, contact_lines, line_contact, line_ends, line_length
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.geometry.helicoid import InvoluteHelicoid

DEG = math.pi / 180.0


def make(n1=30, n2=100, beta=30.0, hand="left", width=0.04064, width_2=0.04064, offset=0.0, apart=0.0, shift=0.0):
    other = {"left": "right", "right": "left", "spur": "spur"}[hand]
    a = helical_gear(n1, 5.08e-3, 20.0 * DEG, beta * DEG, width, hand, profile_shift=shift)
    b = helical_gear(n2, 5.08e-3, 20.0 * DEG, beta * DEG, width_2, other)
    return HelicalPair(a, b, Misalignment(centre_distance=apart), axial_offset=offset)


pairs = st.builds(
    make, st.integers(19, 60), st.integers(19, 120), st.sampled_from([0.5, 12.0, 30.0, 45.0]),
    st.sampled_from(["left", "right"]), st.floats(0.005, 0.1), st.floats(0.005, 0.1), st.sampled_from([0.0, 1e-3]),
    st.sampled_from([0.0, 2e-4]), st.sampled_from([0.0, 0.4]),
)  # fmt: skip


def in_fixed_frame(pair, found):
    """Points and normals (3, ...) of both flanks, turned by their angles."""
    result = []
    # The gear turns the other way about its own axis, and its x axis points at the pinion.
    for gear, axis, t, turn, sign in (
        (pair.pinion, "space", found.t_1, found.phi_1, 1.0),
        (pair.gear, "tooth", found.t_2, -found.phi_2, -1.0),
    ):
        flank = InvoluteHelicoid.of(gear, axis)
        for x, y, z in (flank.points(t, found.z), flank.normals(t, found.z), flank.generators(t, found.z)):
            w = sign * (x + 1j * y) * np.exp(1j * turn)
            result.append(np.stack([w.real, w.imag, z]))
    result[3][0] += pair.centre_distance
    return result


@given(pairs)
def test_both_flanks_touch_all_along_a_line_that_is_tangent_to_both_base_helices(pair):
    found = contact_lines(pair, 5, 4)
    point_1, normal_1, along_1, point_2, normal_2, along_2 = in_fixed_frame(pair, found)
    assert np.abs(point_1 - point_2).max() < 1e-14 * pair.centre_distance / math.sin(pair.pinion.base_helix_angle)
    assert np.abs(normal_1 + normal_2).max() < 1e-12
    assert np.abs(along_1 - along_2).max() < 1e-12
    # The line is straight and runs along the generators: u grows by what the point moves.
    for points, along, u in ((point_1, along_1, found.u_1), (point_2, along_2, found.u_2)):
        way = points[:, :, -1] - points[:, :, 0]
        length = np.linalg.norm(way, axis=0)
        assert way == pytest.approx(along[:, :, 0] * length, abs=1e-13)
        assert np.abs(np.abs(u[:, -1] - u[:, 0]) - length).max() < 1e-11
    assert found.u_1 * math.sin(pair.pinion.base_helix_angle) == pytest.approx(found.t_1, rel=1e-12)
    # A.3.5 and A.3.7: z of both flanks from (u, theta), and no transmission error but the play of a wrong distance.
    assert np.ptp(found.phi_2 - pair.ratio * found.phi_1) < 1e-14


@given(pairs)
def test_the_lines_lie_on_both_flanks_and_end_at_their_ends(pair):
    found = contact_lines(pair, 7, 3)
    for r, gear in ((found.r_1, pair.pinion), (found.r_2, pair.gear)):
        assert r.min() >= gear.form_radius * (1.0 - 1e-12)
        assert r.max() <= gear.tip_radius * (1.0 + 1e-12)
    low, high = pair.overlap
    assert low - 1e-15 <= found.z.min() <= found.z.max() <= high + 1e-15
    beyond = line_ends(pair, np.array(pair.engagement) + np.array([-1e-9, 1e-9]))
    assert (beyond[0] == beyond[1]).all(), "no line outside of the engagement"


@given(pairs)
def test_the_mean_length_is_that_of_the_field_of_contact_over_the_base_pitch(pair):
    found = line_length(pair, 512)
    low, high = pair.overlap
    mean = (high - low) * pair.transverse_contact_ratio / math.cos(pair.pinion.base_helix_angle)
    assert found.mean == pytest.approx(mean, rel=1e-10)
    # A plain sum over pairs on the grid never leaves the extremes, and comes near to them.
    near = 3.0 * (high - low) * (pair.engagement[1] - pair.engagement[0]) / pair.pinion.angular_pitch / 512
    slack = 1e-12
    assert found.least - slack <= found.total.min() <= found.least + near + mean / 512 * 8
    assert found.largest + slack >= found.total.max() >= found.largest - near - mean / 512 * 8


def test_a_whole_overlap_ratio_leaves_the_length_constant():
    pair = make()
    width = pair.pinion.angular_pitch / abs(pair.pinion.twist)  # the axial pitch
    found = line_length(make(width=width, width_2=width))
    assert found.largest - found.least < 1e-12
    assert found.total == pytest.approx(found.mean, rel=1e-12)


def test_a_spur_gear_has_lines_along_its_face_that_come_and_go():
    pair = make(beta=0.0, hand="spur")
    found, length = contact_lines(pair, 4, 3), line_length(pair, 1000)
    assert np.isinf(found.u_1).all()
    assert (np.ptp(found.r_1, axis=1) == 0.0).all()
    assert (length.least, length.largest) == pytest.approx((0.04064, 2 * 0.04064), rel=1e-12)
    assert length.mean == pytest.approx(0.04064 * pair.transverse_contact_ratio, rel=1e-12)
    assert set(length.lines) == {1, 2}
    assert np.mean(length.lines == 2) == pytest.approx(pair.transverse_contact_ratio - 1.0, abs=2e-3)


def test_lines_are_where_the_contact_search_finds_no_gap():
    """The search knows nothing of Appendix 3: its gear angle is that of the line, for a drive with play too."""
    for apart, shift in ((0.0, 0.0), (3e-4, 0.0), (0.0, 0.5)):
        pair = make(apart=apart, shift=shift)
        found = contact_lines(pair, 9, 2)
        searched = pair_contact(pair, found.phi_1[:, 0])
        assert searched.error + pair.ratio * searched.phi_1 == pytest.approx(found.phi_2[:, 0], abs=1e-13)


def test_pairs_without_lines_are_refused_and_made_aligned():
    crossed = dataclasses.replace(make(apart=1e-4), errors=Misalignment(1e-3, centre_distance=1e-4), parabola=1.0)
    for pair in (crossed, make().with_modification(parabola=1.0), make().with_modification(parabola=0.0, crown=0.1)):
        with pytest.raises(InputError, match="no lines of contact"):
            line_contact(pair, 0.0, 0.0)
    assert aligned(crossed) == make(apart=1e-4)
