"""Contact ellipse against Hertz's closed limits and its own equations, relative curvature against the gap itself."""

import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ellipe, ellipk

from fegear.base.errors import InputError
from fegear.contact.unloaded.contact_ellipse import contact_ellipse
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.contact.unloaded.parting import parting
from fegear.contact.unloaded.placement import Placement


def test_circle_is_the_ball_on_a_plane():
    R, F, E = 0.01, 50.0, 1.1e11
    found = contact_ellipse(1.0 / R, 1.0 / R, F, E)
    a = (3.0 * F * R / (4.0 * E)) ** (1.0 / 3.0)
    assert float(found.long) == pytest.approx(a, rel=1e-12)
    assert float(found.short) == pytest.approx(a, rel=1e-12)
    assert float(found.pressure) == pytest.approx(1.5 * F / (math.pi * a * a), rel=1e-12)
    assert float(found.approach) == pytest.approx(a * a / R, rel=1e-12)


def test_a_long_ellipse_is_hertzian_line_contact_across():
    R, F, E = 0.01, 50.0, 1.1e11
    found = contact_ellipse(1.0 / R, 1e-7, F, E)
    # Across a long ellipse the load per length at its middle is that of a line contact: b = sqrt(4 p R/(pi E*)).
    line_load = 0.5 * math.pi * float(found.pressure) * float(found.short)
    assert float(found.short) == pytest.approx(math.sqrt(4.0 * line_load * R / (math.pi * E)), rel=1e-4)


@given(st.floats(0.0, 6.0), st.floats(1e-2, 1e5))
def test_axes_solve_hertz_equations(decades, load):
    large, E = 80.0, 1.1e11
    small = large * 10.0**-decades
    found = contact_ellipse(large, small, load, E)
    a, b, p0 = float(found.long), float(found.short), float(found.pressure)
    e2 = (1.0 - b / a) * (1.0 + b / a)
    if 1e-3 < e2 < 1.0 - 1e-6:  # the textbook form cancels outside
        K, L = ellipk(e2), ellipe(e2)
        front = p0 / E * b / (e2 * a * a)
        assert 2.0 * front * (K - L) == pytest.approx(small, rel=1e-7)
        assert 2.0 * front * ((a / b) ** 2 * L - K) == pytest.approx(large, rel=1e-7)
        assert float(found.approach) == pytest.approx(p0 / E * b * K, rel=1e-9)
    assert p0 * 2.0 * math.pi * a * b / 3.0 == pytest.approx(load, rel=1e-12)


def test_nonsense_is_refused():
    for arguments, words in (((1.0, 0.0, 1.0, 1.0), "positive"), ((1.0, 2.0, 1.0, 1.0), "no larger"),
                             ((1.0, 1.0, -1.0, 1.0), "positive"), ((1.0, 1.0, 1.0, 0.0), "positive")):  # fmt: skip
        with pytest.raises(InputError, match=words):
            contact_ellipse(*arguments)


@pytest.mark.parametrize(("beta", "crown"), [(30.0, 2.0), (10.0, 3.0), (0.0, 3.0)])
def test_relative_curvature_is_that_of_the_gap(beta, crown):
    hands = ("left", "right") if beta else ("spur", "spur")
    a, b = (
        helical_gear(n, 5e-3, math.radians(20.0), math.radians(beta), 0.04, h)
        for n, h in zip((31, 57), hands, strict=True)
    )
    pair = HelicalPair(a, b, Misalignment(shaft_angle=5e-4), parabola=3.0, crown=crown)
    contact = pair_contact(pair, [0.05])
    assert contact.kind[0] == "surface"
    p = Placement.of(pair)
    gap = parting(p, pair.flank, contact.phi_1, contact.s, contact.z1)
    # Walk from the contact point over the pinion's flank and see how far outside the gear's flank one comes.
    s0, z0, phi = contact.s[0], contact.z1[0], contact.phi_1[0]
    h = 2e-4
    s, z = np.meshgrid(s0 + h * np.linspace(-1, 1, 5), z0 + h * np.linspace(-1, 1, 5))
    w = pair.flank.profile(s.ravel())[0] * np.exp(1j * phi)
    outside = (contact.error[0] + pair.ratio * phi) - p.gear_angle(w, z.ravel())
    distance = outside * b.base_radius * math.cos(b.base_helix_angle)
    points = p.turned(w, z.ravel())
    offset = np.stack([points.real, points.imag, z.ravel()]) - contact.point
    along, across = (gap.along[:, 0] @ offset), (gap.across[:, 0] @ offset)
    expected = 0.5 * (gap.small * along**2 + gap.large * across**2)
    assert distance == pytest.approx(expected, rel=0.03, abs=2e-3 * expected.max())
