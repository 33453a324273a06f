"""The rack of a fillet: an arc of the tool's tip radius where a rack has cut it, and what is cut where it is rolled."""

import functools
import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fegear.design.fillet.fillet_bench import FilletBench
from fegear.design.fillet.fillet_limits import Limits
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import EllipseOnSpace, PointsFillet
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(24, BasicRack(1.0, 1.25, 0.25), profile_shift=0.2)


def ellipse(up=0.0, tooth=TOOTH):
    """The tooth with an ellipse that ends so far above the base circle."""
    return with_fillet(tooth, EllipseOnSpace(tooth.base_radius + up, tooth.root_radius))


def elliptic_tip(b, tooth=TOOTH):
    """Half width and height of a tip that is an ellipse of half height b, touching the flank, and its normals."""
    alpha, h0 = tooth.pressure_angle, tooth.rack.dedendum - b
    a = math.sqrt((math.pi / 4 * math.cos(alpha) - h0 * math.sin(alpha)) ** 2 - (b * math.sin(alpha)) ** 2)
    a /= math.cos(alpha)
    t = np.linspace(0.0, math.atan2(a * math.cos(alpha), b * math.sin(alpha)), 81)
    normal = np.stack([b * np.sin(t), a * np.cos(t)]) / np.hypot(b * np.sin(t), a * np.cos(t))
    return np.stack([a * np.sin(t), h0 + b * np.cos(t)]), normal


def generated_by(tip, normal, tooth=TOOTH):
    """Points that a tip makes: each as its normal passes through the pitch point."""
    x, y = -tip[0], tooth.generating_shift - tip[1]  # right of the middle of the space, above the pitch line
    passes = x - y * normal[0] / normal[1]
    roll = passes / tooth.pitch_radius
    px, py, turn = x - passes, y + tooth.pitch_radius, math.pi / tooth.teeth + roll
    return np.stack([px * np.cos(turn) + py * np.sin(turn), py * np.cos(turn) - px * np.sin(turn)])


def with_elliptic_tip(b):
    points = generated_by(*elliptic_tip(b))
    return with_fillet(TOOTH, PointsFillet(tuple(map(tuple, points.T.tolist()))))


@settings(deadline=None, max_examples=40)
@given(
    st.integers(14, 200), st.floats(0.1, 0.38), st.floats(-0.1, 0.6), st.floats(-0.05, 0.0), st.floats(0.0, 0.6),
)  # fmt: skip
def test_the_rack_of_a_generated_fillet_is_the_tool(z, rho, x, allowance, beta):
    rack = BasicRack(1.0, 1.25, rho)
    shift = max(
        x, 1.05 * (1.25 - rho + rho * math.sin(rack.pressure_angle)) - z * 0.5 * math.sin(rack.pressure_angle) ** 2
    )
    tooth = Tooth(z, rack, shift, thickness_allowance=allowance, helix_angle=beta)
    tip, lean = conjugate_rack(tooth), math.cos(beta)
    # In the section across the rack's teeth its tip is a circle around the centre of its rounding.
    across, up = tip.half_width * lean, tip.height - (rack.dedendum - rho)
    middle = math.pi / 4 - (rack.dedendum - rho) * math.tan(rack.pressure_angle) - rho / math.cos(rack.pressure_angle)
    assert np.hypot(across - middle, up) == pytest.approx(rho, abs=1e-9)
    assert tip.height[0] == pytest.approx(1.25, abs=1e-9)
    assert tip.exists
    assert tip.smallest_radius > 0.0
    if beta < 1e-6:
        assert tip.smallest_radius == pytest.approx(rho, rel=1e-4)
    # It ends on the tool's straight flank.
    assert across[-1] == pytest.approx(math.pi / 4 - tip.height[-1] * math.tan(rack.pressure_angle), abs=1e-8)


@pytest.mark.parametrize("b", [0.3, 0.6, 1.0])
def test_the_rack_of_what_an_elliptic_tip_makes_is_the_ellipse(b):
    tip, normal = elliptic_tip(b)
    found = conjugate_rack(with_elliptic_tip(b))
    assert found.exists
    h0 = TOOTH.rack.dedendum - b
    t = np.arccos(np.clip((found.height - h0) / b, -1.0, 1.0))
    a = tip[0, -1] / math.sqrt(1.0 - ((tip[1, -1] - h0) / b) ** 2)
    assert found.half_width == pytest.approx(a * np.sin(t), abs=5e-5)
    assert found.half_width[-1] == pytest.approx(tip[0, -1], abs=1e-5)
    sharpest = min(a**2 / b, (a * b) ** 2 / math.hypot(a * normal[0, -1], b * normal[1, -1]) ** 3)
    assert found.smallest_radius == pytest.approx(sharpest, rel=0.05)


def left_by(tooth, half_width, height, radii):
    """Polar angles from the tooth's centre line to what the rolling tip leaves of it, by chords of a dense outline."""
    x, y = -half_width, tooth.generating_shift - height + tooth.pitch_radius
    angles = np.full(radii.size, math.inf)
    for roll in np.linspace(-0.3, 0.05, 501):
        u, turn = x + tooth.pitch_radius * roll, math.pi / tooth.teeth - roll
        px, py = u * math.cos(turn) + y * math.sin(turn), y * math.cos(turn) - u * math.sin(turn)
        radius, polar = np.hypot(px, py), np.arctan2(px, py)
        first = np.searchsorted(radii, np.minimum(radius[1:], radius[:-1]))
        last = np.searchsorted(radii, np.maximum(radius[1:], radius[:-1]))
        for i in np.flatnonzero(last > first):
            here = slice(first[i], last[i])
            share = (radii[here] - radius[i]) / (radius[i + 1] - radius[i])
            angles[here] = np.minimum(angles[here], polar[i] + share * (polar[i + 1] - polar[i]))
    return angles


@pytest.mark.parametrize("worn", [0.0, 0.01])
def test_the_rolled_tip_leaves_the_fillet_and_a_worn_one_a_fillet_that_is_higher_by_what_is_worn(worn):
    tooth = with_elliptic_tip(0.6)
    tip = conjugate_rack(tooth, 121)
    along = np.gradient(np.stack([tip.half_width, tip.height]), axis=1)  # from the middle of the tip to the flank
    out = np.stack([-along[1], along[0]]) / np.hypot(*along)
    half_width, height = np.stack([tip.half_width, tip.height]) - worn * out
    fillet = tooth.fillet
    u = np.linspace(fillet.start, fillet.end, 101)[20:-5]  # lower down, radii say little of where they are met
    wanted = fillet.points(u) + worn * fillet.normals(u)
    radii, polar = np.hypot(*wanted), np.arctan2(*wanted)
    assert np.all(np.diff(radii) > 0.0)
    assert (left_by(tooth, half_width, height, radii) - polar) * radii == pytest.approx(0.0, abs=4e-5)


def test_a_fillet_that_no_rack_makes_has_no_room():
    """An ellipse that ends at the base circle turns faster there than any rack that rolls on it and the flank."""
    made, not_made = with_elliptic_tip(0.6), ellipse(0.02)
    assert conjugate_rack(made).room(0.4).min() > 0.0
    assert conjugate_rack(made).room(0.45).min() < 0.0
    assert not conjugate_rack(not_made).exists
    assert conjugate_rack(not_made).room(0.0).min() < 0.0
    assert conjugate_rack(TOOTH).room(0.25).min() == pytest.approx(0.0, abs=1e-5)


def _bench(limits):
    """As much of a bench as its limits ask for."""
    corner = np.array([0.0, 99.0]), np.array([9.0, 9.0])
    gear = SimpleNamespace(tooth=TOOTH)
    made = SimpleNamespace(limits=limits, corner=corner, gear=gear, both=False, other=None)
    made._room = functools.partial(FilletBench._room, made)
    return made


def test_a_search_looks_at_the_tool_only_where_a_rack_is_to_make_the_fillet():
    plain, asked = _bench(Limits()), _bench(Limits(generated=True, smallest_tool_radius=0.3))
    for tooth in (with_elliptic_tip(0.6), ellipse(0.02)):
        free, found = FilletBench.room(plain, tooth), FilletBench.room(asked, tooth)
        assert np.array_equal(found[: free.size], free)
        assert np.array_equal(found[free.size :], conjugate_rack(tooth).room(0.3))


def test_more_points_are_the_same_rack():
    tooth = with_elliptic_tip(0.6)
    few, many = conjugate_rack(tooth, 65), conjugate_rack(tooth, 257)
    assert many.half_width[::4] == pytest.approx(few.half_width, abs=1e-12)
    assert many.along.sum() == pytest.approx(few.along.sum(), rel=1e-3)
    assert many.turned.sum() == pytest.approx(few.turned.sum(), rel=1e-12)
