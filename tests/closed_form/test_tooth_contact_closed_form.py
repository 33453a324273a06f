"""Tooth contact analysis against closed forms, against the paper's equations and against plain search."""

import math

import numpy as np
import pytest
from helical_gears import helical_gear
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import root

from fegear.base.errors import GeometryError
from fegear.contact.unloaded.manufacture import as_cut
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.contact.unloaded.roots import falling_bracket, falling_root
from fegear.contact.unloaded.tooth_contact import mesh_cycle, tooth_contact
from fegear.geometry.rack_cutter import RackFlank

DEG, ARCMIN, ARCSEC = math.pi / 180.0, math.pi / 10800.0, math.pi / 648000.0


def make(n1=30, n2=100, beta=30.0, hand="left", width=0.04064, mn=5.08e-3, alpha=20.0, errors=None, **more):
    other = {"left": "right", "right": "left", "spur": "spur"}[hand]
    a = helical_gear(n1, mn, alpha * DEG, beta * DEG, width, hand)
    b = helical_gear(n2, mn, alpha * DEG, beta * DEG, more.pop("width_2", width), other)
    return HelicalPair(a, b, errors or Misalignment(), **more)


def in_gear_frame(pair, s, z, phi_1):
    g = pair.errors.shaft_angle
    x, y, z1 = pair.flank.points(s, z)
    c, d = math.cos(phi_1), math.sin(phi_1)
    x, y = c * x - d * y, d * x + c * y
    y2, z2 = -y * math.cos(g) - z1 * math.sin(g), z1 * math.cos(g) - y * math.sin(g)
    return np.stack([pair.centre_distance - x, y2, z2])


def largest_gear_angle(pair, phi_1, n=161, zooms=9):
    """Plain search: the largest gear angle over a grid of facing pinion points, then over ever finer ones."""
    flank, helicoid = pair.flank, pair.mating_flank
    half_1, half_2 = 0.5 * pair.pinion.face_width, 0.5 * pair.gear.face_width
    box = [flank.s_form, flank.s_tip, -half_1, half_1]
    best = -math.inf
    for _ in range(zooms):
        s, z = np.meshgrid(np.linspace(*box[:2], n), np.linspace(*box[2:], n))
        x2, y2, z2 = in_gear_frame(pair, s, z, phi_1)
        r2 = np.hypot(x2, y2)
        facing = (
            (r2 <= pair.gear.tip_radius) & (r2 >= pair.gear.form_radius) & (np.abs(z2 - pair.axial_offset) <= half_2)
        )
        if not facing.any():
            return best
        angle = np.full(s.shape, -np.inf)
        angle[facing] = -helicoid.separation_angle(np.stack([x2, y2, z2])[:, facing])
        i = np.unravel_index(np.argmax(angle), angle.shape)
        best = max(best, float(angle[i]))
        ds, dz = (box[1] - box[0]) / (n - 1), (box[3] - box[2]) / (n - 1)
        box = [
            max(s[i] - 4 * ds, flank.s_form), min(s[i] + 4 * ds, flank.s_tip),
            max(z[i] - 4 * dz, -half_1), min(z[i] + 4 * dz, half_1),
        ]  # fmt: skip
    return best


@given(
    st.integers(19, 60), st.integers(19, 120), st.sampled_from([0.0, 1e-6, 5.0, 20.0, 35.0]),
    st.floats(0.01, 0.15), st.sampled_from(["left", "right"]), st.sampled_from([0.0, 2e-4]),
)  # fmt: skip
@pytest.mark.examples(12, 400)
def test_aligned_drives_transmit_exactly(n1, n2, beta, width, hand, apart):
    pair = make(n1, n2, beta, hand if beta else "spur", width, errors=Misalignment(centre_distance=apart))
    assume(pair.transverse_contact_ratio > 1.02)
    result = tooth_contact(pair, 24)
    variation = result.error - result.error[0]
    assert np.abs(variation).max() < 1e-12
    assert result.peak_to_peak < 1e-12
    if apart == 0.0:
        assert np.abs(result.error).max() < 1e-12
    # Near the change of pairs a spur gear touches at a tip; elsewhere a line of contact has no one contact point.
    assert result.mesh.ill_defined[result.mesh.kind == "surface"].all()


def test_the_range_of_figure_8_is_that_of_a_plain_search():
    """TM-107451, Fig. 8 (profile angle 3', lead -2'): both extremes are what a search over all pairs finds there."""
    pair = make(errors=Misalignment(0.0, -2 * ARCMIN, 3 * ARCMIN))
    result, pitch = tooth_contact(pair, 60), pair.pinion.angular_pitch
    assert result.peak_to_peak / ARCSEC == pytest.approx(1.53561, abs=1e-5)
    for extreme in (result.maximum, result.minimum):
        own = [extreme.angle - k * pitch for k in range(-2, 3)]
        found = max(largest_gear_angle(pair, phi, 61) - pair.ratio * phi for phi in own)
        assert found == pytest.approx(extreme.value, abs=1e-5 * ARCSEC)


angles = st.floats(-6.0, 6.0).map(lambda a: a * ARCMIN)


@pytest.mark.dear
@pytest.mark.examples(25, 1000)
@given(
    st.integers(19, 60), st.integers(19, 120), st.sampled_from([0.0, 0.5, 12.0, 30.0]), angles, angles, angles,
    st.sampled_from([0.0, 1e-4]), st.sampled_from([0.0, 2.0]), st.sampled_from([0.0, 4.0]), st.floats(0.0, 1.0),
)  # fmt: skip
def test_earliest_contact_is_the_largest_gear_angle_of_a_plain_search(
    n1, n2, beta, shaft, lead, profile, apart, parabola, crown, where
):
    errors = Misalignment(shaft, lead, profile, apart)
    pair = make(
        n1, n2, beta, "left" if beta else "spur", 0.03, errors=errors, width_2=0.035, parabola=parabola, crown=crown,
        axial_offset=0.003,
    )  # fmt: skip
    lo, hi = pair.engagement
    phi = lo + where * (hi - lo)
    found = pair_contact(pair, [phi])
    searched = largest_gear_angle(pair, phi) - pair.ratio * phi
    assert found.error[0] >= searched - 1e-12, "nothing may touch earlier"
    if found.kind[0] == "none":
        return
    # ... and the contact is a point of the pinion's flank that faces the gear's, at the angle that makes it touch.
    assert pair.flank.s_form <= found.s[0] <= pair.flank.s_tip
    assert abs(found.z1[0]) <= 0.015 * (1.0 + 1e-12)
    assert abs(found.z2[0] - 0.003) <= 0.0175 * (1.0 + 1e-12)
    assert pair.gear.form_radius * (1.0 - 1e-12) <= found.r2[0] <= pair.gear.tip_radius * (1.0 + 1e-12)
    touching = -pair.mating_flank.separation_angle(in_gear_frame(pair, found.s, found.z1, phi))
    assert found.error[0] + pair.ratio * phi == pytest.approx(touching[0], abs=1e-14)


@pytest.mark.parametrize(
    ("teeth", "beta", "errors", "where"),
    [
        ((24, 73), 0.01, Misalignment(150 * ARCMIN * 0.2, 0.0, -30 * ARCMIN), 0.0),
        ((155, 64), 1e-7, Misalignment(0.0, 30 * ARCMIN, 30 * ARCMIN, -1e-4), 0.0),
        ((40, 31), 45.0, Misalignment(-120 * ARCMIN, 3 * ARCMIN, 0.0), 0.93),
        ((20, 20), 0.0, Misalignment(120 * ARCMIN, 0.0, 1e-6 * ARCMIN), 0.5),
    ],
)
def test_corners_and_slivers_where_the_reach_closes(teeth, beta, errors, where):
    """Large errors on narrow or wide faces, at the very ends of engagement."""
    for width in (0.005, 0.15):
        pair = make(*teeth, beta, "left" if beta else "spur", width, alpha=20.0, errors=errors, width_2=0.15)
        lo, hi = pair.engagement
        phi = lo + where * (hi - lo)
        found = pair_contact(pair, [phi])
        searched = largest_gear_angle(pair, phi) - pair.ratio * phi
        assert found.error[0] >= searched - 1e-12


@pytest.mark.dear
@given(st.sampled_from([0.0, 15.0, 30.0]), angles, angles, angles, st.sampled_from([0.0, 2.0]))
@pytest.mark.examples(8, 150)
def test_mirrored_hands_with_mirrored_shafts_have_the_same_error(beta, shaft, lead, profile, parabola):
    assume(beta > 0.0 or lead == 0.0)  # a lead error gives a spur gear a hand
    hands = ("left", "right") if beta else ("spur", "spur")
    mirrored = [
        mesh_cycle(make(31, 57, beta, hand, errors=Misalignment(sign * shaft, lead, profile), parabola=parabola), 24)
        for hand, sign in zip(hands, (1.0, -1.0), strict=True)
    ]
    assert mirrored[0].error == pytest.approx(mirrored[1].error, abs=1e-12)
    sharp = ~(mirrored[0].mesh.ill_defined | mirrored[1].mesh.ill_defined) & (mirrored[0].mesh.kind != "none")
    sharp &= mirrored[0].leader == mirrored[1].leader
    assert mirrored[0].mesh.r1[sharp] == pytest.approx(mirrored[1].mesh.r1[sharp], abs=2e-7)


@pytest.mark.long
def test_error_vanishes_linearly_with_the_misalignment():
    sizes = 3.0 * 10.0 ** -np.arange(0.0, 7.0, 2.0)  # arc-min, down to 3e-6
    for name in ("shaft_angle", "lead_angle", "profile_angle"):
        results = [mesh_cycle(make(errors=Misalignment(**{name: a * ARCMIN})), 32) for a in sizes]
        scaled = [np.abs(r.error).max() / a for r, a in zip(results, sizes, strict=True)]
        # First order in the misalignment, until round-off (1e-16 rad of some 1e-10) shows.
        assert scaled == pytest.approx([scaled[1]] * 4, rel=2e-3), name
    tiny = tooth_contact(make(errors=Misalignment(shaft_angle=1e-6 * ARCMIN)), 32)
    assert 0.0 < tiny.peak_to_peak < 1e-4 * ARCSEC


@pytest.mark.dear
@pytest.mark.parametrize("errors", [
    Misalignment(shaft_angle=3 * ARCMIN),
    pytest.param(Misalignment(shaft_angle=3 * ARCMIN, lead_angle=-4 * ARCMIN), marks=pytest.mark.long),
    pytest.param(Misalignment(profile_angle=3 * ARCMIN, lead_angle=-2 * ARCMIN), marks=pytest.mark.long),
])  # fmt: skip
def test_extremes_do_not_depend_on_the_grid_and_bound_every_sample(errors):
    pair = make(errors=errors)
    runs = [tooth_contact(pair, n, start) for n, start in ((5, None), (37, 0.017), (1000, -3.0))]
    for run in runs:
        assert run.maximum.value == pytest.approx(runs[0].maximum.value, abs=1e-3 * ARCSEC)
        assert run.minimum.value == pytest.approx(runs[0].minimum.value, abs=1e-3 * ARCSEC)
        assert run.error.max() <= run.maximum.value + run.maximum.error + 1e-13
        assert run.error.min() >= run.minimum.value - run.minimum.error - 1e-13
    assert runs[-1].error.max() == pytest.approx(runs[-1].maximum.value, abs=0.02 * ARCSEC)


def test_slope_is_the_derivative_of_the_error_for_every_kind_of_contact():
    seen = set()
    for errors, parabola in (
        (Misalignment(shaft_angle=3 * ARCMIN), 0.0), (Misalignment(3 * ARCMIN, -4 * ARCMIN), 0.0),
        (Misalignment(shaft_angle=-3 * ARCMIN), 2.0),
        (Misalignment(profile_angle=3 * ARCMIN, lead_angle=-2 * ARCMIN), 0.0),
    ):  # fmt: skip
        pair = make(errors=errors, parabola=parabola)
        lo, hi = pair.engagement
        phi, h = np.linspace(lo, hi, 60), 1e-6
        mid, up, down = (pair_contact(pair, phi + d) for d in (0.0, h, -h))
        smooth = (mid.bounds == up.bounds).all(axis=0) & (mid.bounds == down.bounds).all(axis=0) & (mid.kind != "none")
        difference = (up.error - down.error) / (2.0 * h)
        assert difference[smooth] == pytest.approx(mid.slope[smooth], abs=2e-8)
        seen |= set(mid.kind[smooth])
    assert {"surface", "gear tip", "pinion tip", "pinion face end", "gear face end"} <= seen


def crossed_contact(pair, phi_1):
    """Surface-to-surface contact of crossed involute helicoids: Appendix 4, steps 1 to 7, as a linear system."""
    a, b, g = pair.cut_pinion, pair.gear, pair.errors.shaft_angle
    l1, l2 = 0.5 * math.pi - a.base_helix_angle, 0.5 * math.pi - b.base_helix_angle
    p1, p2, mu, eta = (
        1.0 / abs(a.twist),
        1.0 / abs(b.twist),
        a.half_base_space_angle,
        b.half_base_tooth_angle,
    )
    F2 = math.acos((math.cos(l1) - math.cos(l2) * math.cos(g)) / (math.sin(l2) * math.sin(g)))
    F1 = math.asin(math.sin(l2) * math.sin(F2) / math.sin(l1))
    theta_1 = F1 - mu + phi_1
    # x_f, y_f and z_f of both surfaces agree: three linear equations for u1, u2, theta_2.
    A = np.array([
        [math.cos(l1) * math.sin(F1), math.cos(l2) * math.sin(F2), 0.0],
        [math.cos(l1) * math.cos(F1), math.cos(l2) * math.cos(F2) * math.cos(g) + math.sin(l2) * math.sin(g),
         -p2 * math.sin(g)],
        [-math.sin(l1), math.cos(l2) * math.cos(F2) * math.sin(g) - math.sin(l2) * math.cos(g), p2 * math.cos(g)],
    ])  # fmt: skip
    rb1, rb2 = a.base_radius, b.base_radius
    rhs = np.array([
        pair.centre_distance - rb2 * math.cos(F2) - rb1 * math.cos(F1),
        rb1 * math.sin(F1) + rb2 * math.sin(F2) * math.cos(g),
        -p1 * theta_1 + rb2 * math.sin(F2) * math.sin(g),
    ])  # fmt: skip
    u1, _, theta_2 = np.linalg.solve(A, rhs)
    return math.hypot(rb1, u1 * math.cos(l1)), -u1 * math.sin(l1) + p1 * theta_1, F2 - theta_2 + eta


@pytest.mark.parametrize(("shaft", "lead"), [(3.0, -3.0), (60.0, -60.0), (150.0, -150.0)])
def test_crossed_helicoids_touch_where_the_closed_form_says(shaft, lead):
    pair = make(errors=Misalignment(shaft_angle=shaft * ARCMIN, lead_angle=lead * ARCMIN))
    lo, hi = pair.engagement
    phi = np.linspace(0.6 * lo + 0.4 * hi, 0.4 * lo + 0.6 * hi, 7)
    found = pair_contact(pair, phi)
    reference = np.array([crossed_contact(pair, f) for f in phi])
    assert (found.kind == "surface").all()
    assert found.error + pair.ratio * phi == pytest.approx(reference[:, 2], abs=2e-13 if shaft > 3 else 1e-11)
    # Where lead and shaft error nearly cancel the place is ill-conditioned (3e9 at 3 arc-min), the error is not.
    assert found.r1 == pytest.approx(reference[:, 0], abs=1e-8 if shaft > 3.0 else 2e-6)
    assert found.z1 == pytest.approx(reference[:, 1], abs=1e-8 if shaft > 3.0 else 2e-6)
    assert found.ill_defined.all() == (shaft == 3.0)


def test_edge_contact_solves_the_papers_equations_10_and_11():
    pair = make(errors=Misalignment(shaft_angle=3 * ARCMIN, lead_angle=-4 * ARCMIN))
    found = pair_contact(pair, np.linspace(*pair.engagement, 80))
    flank, helicoid, g = pair.flank, pair.mating_flank, pair.errors.shaft_angle
    tip = np.flatnonzero(found.kind == "pinion tip")
    assert tip.size > 10

    for i in tip[2:-2:4]:
        phi_1 = found.phi_1[i]

        def tip_edge(z, phi_1=phi_1):
            x, y, z = flank.points(flank.s_tip, z)
            return np.stack([
                math.cos(phi_1) * x - math.sin(phi_1) * y, math.sin(phi_1) * x + math.cos(phi_1) * y, z,
            ])  # fmt: skip

        def fixed(v, phi_2):
            x, y, z = v
            x, y = math.cos(phi_2) * x + math.sin(phi_2) * y, -math.sin(phi_2) * x + math.cos(phi_2) * y
            return np.stack([-x, -y * math.cos(g) - z * math.sin(g), z * math.cos(g) - y * math.sin(g)])

        def residual(unknowns, tip_edge=tip_edge, fixed=fixed):
            z1, t2, z2, phi_2 = unknowns
            z1, t2, z2 = z1 * 1e-2, t2 * 1e-2, z2 * 1e-2
            edge = tip_edge(z1)
            other = fixed(helicoid.points(t2, z2), phi_2) + np.array([pair.centre_distance, 0.0, 0.0])
            h = 1e-6
            tangent = (tip_edge(z1 + h) - tip_edge(z1 - h)) / (2.0 * h)
            return [*(100.0 * (edge - other)), float(tangent @ fixed(helicoid.normals(t2, z2), phi_2))]

        phi_2 = found.error[i] + pair.ratio * phi_1
        t2 = math.sqrt(found.r2[i] ** 2 - pair.gear.base_radius**2)
        guess = [found.z1[i] * 100 + 0.01, t2 * 100 - 0.01, found.z2[i] * 100, phi_2 + 1e-5]
        solution = root(residual, guess, method="lm", options={"xtol": 1e-15, "ftol": 1e-15}).x
        assert np.abs(residual(solution)).max() < 1e-11
        assert solution[3] == pytest.approx(phi_2, abs=1e-12)
        assert solution[0] / 100 == pytest.approx(found.z1[i], abs=1e-8)


@given(st.integers(19, 60), st.integers(19, 90), angles)
@pytest.mark.examples(15, 300)
def test_spur_gears_with_a_shaft_angle_touch_at_a_face_end(n1, n2, shaft):
    assume(abs(shaft) > 0.1 * ARCMIN)
    pair = make(n1, n2, 0.0, "spur", 0.03, errors=Misalignment(shaft_angle=shaft))
    result = mesh_cycle(pair, 16)
    assert set(result.mesh.kind) <= {"pinion face end", "gear face end", "corner"}
    # To first order the flank end lies shaft L/2 sin(alpha)... nearer: the separation along the normal.
    expected = 0.5 * 0.03 * abs(shaft) * math.cos(pair.working_pressure_angle) / pair.gear.base_radius
    assert result.error == pytest.approx(np.full(16, expected), rel=0.02)


def test_face_ends_that_stick_out_change_the_edge_not_the_slope():
    errors = Misalignment(shaft_angle=3 * ARCMIN)
    wide = pair_contact(make(errors=errors, width_2=0.06), np.linspace(0.0, 0.05, 9))
    narrow = pair_contact(make(errors=errors, width=0.06, width_2=0.04064), np.linspace(0.0, 0.05, 9))
    assert "gear face end" not in wide.kind
    assert "pinion face end" not in narrow.kind
    with pytest.raises(GeometryError):
        make(axial_offset=0.05)


@given(st.lists(st.floats(-2.0, 2.0), min_size=1, max_size=20), st.floats(1e-6, 1e3))
def test_bracketed_roots_are_found_or_pinned_to_the_end(centres, steep):
    c = np.array(centres)
    lo, hi = np.full(c.size, -1.0), np.full(c.size, 1.0)

    def function(x, c):
        return steep * np.arctan(50.0 * (c - x)), -50.0 * steep / (1.0 + (50.0 * (c - x)) ** 2)

    x = falling_root(function, lo, hi, 0.0 * c, (c,))
    assert x == pytest.approx(np.clip(c, -1.0, 1.0), abs=1e-14)
    a, b = falling_bracket(lambda x, c: np.where(x < c, 1.0, -1.0), lo, hi, (c,), np.full(c.size, 1e-15))
    assert (a <= np.clip(c, -1, 1) + 1e-15).all()
    assert (b >= np.clip(c, -1, 1) - 1e-15).all()
    assert (b - a <= 1e-15).all()


def test_flank_of_the_pair_is_the_cut_one():
    pair = make(errors=Misalignment(lead_angle=3 * ARCMIN), parabola=1.0)
    assert pair.flank == RackFlank(as_cut(pair.pinion, lead_angle=3 * ARCMIN), 1.0)
