"""Litvin, Lu, Townsend, Hawkins, NASA TM-107451: the drive of sections 2 and 3 and what the paper says of it.

The paper's figures are pictures without numbers; what it states in words is asserted. Face and addendum are not
stated: abs(z) <= L/2 and 1/P_n. Pinion errors run all of its Appendix 2 again.
"""

import dataclasses
import math

import numpy as np
import pytest
from helical_gears import helical_gear

from fegear.base.errors import RangeError
from fegear.contact.unloaded.contact_ellipse import bearing_contact
from fegear.contact.unloaded.manufacture import ProfileAngleEffects, as_cut
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.contact.unloaded.predesign import absorb_linear_error, linear_error
from fegear.contact.unloaded.tooth_contact import mesh_cycle, tooth_contact

INCH, ARCMIN, ARCSEC = 0.0254, math.pi / 10800.0, math.pi / 648000.0


def drive(shaft=0.0, lead=0.0, profile=0.0, parabola=0.0):
    """30/100 teeth, alpha_n = 20 deg, P_n = 5/in, lambda_p = 60 deg, L = 1.6 in; errors in arc-min, a_c in 1/in."""
    pinion, gear = (
        helical_gear(n, INCH / 5.0, math.radians(20.0), math.radians(30.0), 1.6 * INCH, hand)
        for n, hand in ((30, "left"), (100, "right"))
    )
    errors = Misalignment(shaft * ARCMIN, lead * ARCMIN, profile * ARCMIN)
    return HelicalPair(pinion, gear, errors, parabola=parabola / INCH)


def slopes(result):
    """Mean slope [arcsec per pitch] of each kind of contact in the cycle."""
    kinds = result.mesh.kind
    pitch = result.pair.pinion.angular_pitch
    return {k: float(result.mesh.slope[kinds == k].mean()) * pitch / ARCSEC for k in set(kinds) - {"corner"}}


def test_aligned_gears_have_no_transmission_error_and_line_contact():
    result = tooth_contact(drive(), 100)
    assert np.abs(result.error).max() < 1e-12
    assert np.abs(result.single.error).max() < 1e-12
    assert set(result.mesh.kind) == {"surface"}
    assert result.mesh.ill_defined.all(), "a line has no one contact point"


@pytest.mark.dear("errors0")
@pytest.mark.parametrize("errors", [{"shaft": 3.0}, {"lead": 3.0}])
def test_shaft_or_lead_alone_gives_edge_contact_and_two_linear_pieces(errors):
    """Figs. 2 and 3: edge contact, two almost linear pieces of opposite slope."""
    result = tooth_contact(drive(**errors), 400)
    assert "surface" not in result.mesh.kind
    edges = slopes(result)
    assert edges["gear tip"] == pytest.approx(19.6, abs=0.1)
    face = edges.get("gear face end", edges.get("pinion face end"))
    assert face == pytest.approx(-5.54, abs=0.03)
    for kind in ("gear tip", "gear face end", "pinion face end"):
        part = result.mesh.slope[result.mesh.kind == kind]
        if part.size:
            assert np.ptp(part) < 2e-3 * np.abs(part).max(), "almost linear"
    assert result.peak_to_peak / ARCSEC == pytest.approx(4.30, abs=0.01)


@pytest.mark.dear
def test_shaft_and_lead_alone_give_the_same_function():
    """Fig. 3 is one figure for both errors."""
    shaft, lead = tooth_contact(drive(shaft=3.0), 200, 0.0), tooth_contact(drive(lead=3.0), 200, 0.0)
    # They differ in second order only: by 3e-4 of the error, the size of the angles themselves.
    assert np.abs(shaft.error - lead.error).max() < 0.03 * ARCSEC
    assert shaft.peak_to_peak == pytest.approx(lead.peak_to_peak, rel=5e-4)


def test_profile_angle_error_moves_the_contact_but_makes_no_transmission_error():
    """Fig. 4."""
    result = tooth_contact(drive(profile=3.0), 200)
    assert result.peak_to_peak < 1e-6 * ARCSEC
    assert set(result.mesh.kind) == {"gear tip"}
    opposite = tooth_contact(drive(profile=-3.0), 200)
    assert opposite.peak_to_peak < 1e-6 * ARCSEC
    assert set(opposite.mesh.kind) == {"pinion tip"}


def test_shaft_3_and_lead_minus_4_give_edge_contact_with_two_slopes():
    """Figs. 5 and 6."""
    result = mesh_cycle(drive(shaft=3.0, lead=-4.0), 400)
    assert "surface" not in result.mesh.kind
    found = slopes(result)
    assert found["pinion tip"] == pytest.approx(-6.5, abs=0.1)
    assert found["gear face end"] == pytest.approx(1.85, abs=0.02)


def test_profile_3_and_lead_minus_2_put_the_contact_on_the_end_of_the_tooth():
    """Figs. 7 and 8: contact on the edge of the tooth length, an almost linear function."""
    result = mesh_cycle(drive(profile=3.0, lead=-2.0), 400)
    end = result.mesh.kind == "pinion face end"
    assert end.mean() > 0.9
    assert np.ptp(result.mesh.slope[end]) < 2e-3 * np.abs(result.mesh.slope[end]).max()


def test_shaft_3_and_lead_minus_3_cancel():
    """Fig. 9: surface contact of crossed helicoids along a straight line, no transmission error."""
    result = tooth_contact(drive(shaft=3.0, lead=-3.0), 200)
    assert set(result.mesh.kind) == {"surface"}
    assert np.abs(result.error).max() < 1e-10 * ARCMIN
    assert result.mesh.ill_defined.all()
    single = result.single
    inner = (single.kind == "surface") & (single.z1 > -5e-3) & (single.z1 < 5e-3)
    assert inner.sum() > 50
    # The path climbs from the root to the tip of the pinion while it moves along the tooth.
    line = np.polynomial.Polynomial.fit(single.s[inner], single.z1[inner], 1)
    assert single.z1[inner] == pytest.approx(line(single.s[inner]), abs=2e-5)
    assert np.ptp(single.z1[inner]) / np.ptp(single.s[inner]) == pytest.approx(1.29, abs=0.02)
    # "Even a small difference will cause an edge contact and transmission errors".
    assert "surface" not in mesh_cycle(drive(shaft=3.0, lead=-3.001), 50).mesh.kind


def test_localised_contact_has_an_almost_linear_error_whose_slope_does_not_depend_on_the_parabola():
    """Figs. 12 and 13."""
    found = []
    for a_c in (0.04, 0.06, 0.1):
        result = mesh_cycle(drive(shaft=3.0, parabola=a_c), 200)
        inside = result.mesh.kind == "surface"
        found.append(slopes(result)["surface"])
        assert np.ptp(result.mesh.slope[inside]) < 1e-3 * abs(result.mesh.slope[inside].mean())
        assert not result.mesh.ill_defined[inside].any()
        # The path stays near the mean line and runs along the tooth.
        assert np.abs(result.mesh.s[inside]).max() < 1.5e-3 * 0.04 / a_c
        assert np.ptp(result.mesh.s[inside]) < 1e-5
    assert found == pytest.approx([19.593] * 3, abs=2e-3)


def test_a_parabola_too_flat_leaves_the_contact_on_the_edge():
    result = mesh_cycle(drive(shaft=3.0, parabola=0.005), 100)
    assert "surface" not in result.mesh.kind
    with pytest.raises(RangeError, match="gives edge contact"):
        linear_error(drive(shaft=3.0, parabola=0.005))


@pytest.mark.dear
@pytest.mark.parametrize(
    "errors", [{"shaft": 3.0}, *(pytest.param(one, marks=pytest.mark.long) for one in ({"shaft": -3.0}, {"lead": 2.0}))]
)
def test_predesigned_parabola_absorbs_the_linear_error(errors):
    plain = drive(**errors, parabola=0.08)
    design = absorb_linear_error(plain)
    result = tooth_contact(design.pair, 200)
    assert set(result.mesh.kind) == {"surface"}
    # The estimate takes the loss as a_c s^2; at this parabola it is some 4 % less.
    assert result.peak_to_peak == pytest.approx(design.peak_to_peak, rel=0.06)
    aligned = tooth_contact(design.pair.with_errors(Misalignment()), 200)
    assert result.peak_to_peak == pytest.approx(aligned.peak_to_peak, rel=0.01), "the linear error is absorbed"
    # Second differences tell the parabola; pairs change where it has fallen by its height.
    same = result.leader[1:] == result.leader[:-1]
    bend = np.diff(result.mesh.slope)[same] / np.diff(result.phi_1)[same]
    assert bend == pytest.approx(np.full(bend.size, -2.0 * design.error_parabola), rel=0.1)
    assert result.peak_to_peak < tooth_contact(plain, 100).peak_to_peak


def test_predesign_refuses_what_it_cannot_do():
    with pytest.raises(RangeError, match="must be positive"):
        absorb_linear_error(drive(shaft=3.0))
    stub = drive(parabola=0.08)
    low = dataclasses.replace(stub.pinion.tooth, tip_radius=(stub.pinion.pitch_radius + 1.5e-3) / stub.pinion.module)
    short = dataclasses.replace(stub.pinion, tooth=low)
    stub = dataclasses.replace(stub, pinion=short)
    with pytest.raises(RangeError, match="gives a contact path that leaves the active profile at tip and root"):
        absorb_linear_error(stub, slope=0.01, face_share=0.1)
    spur = [helical_gear(30, 5e-3, 0.35, 0.0, 0.04, "spur") for _ in range(2)]
    with pytest.raises(RangeError, match="use helical gears"):
        absorb_linear_error(HelicalPair(*spur, parabola=1.0))


def test_contact_ellipses_lie_along_the_tooth():
    pair = drive(shaft=3.0, parabola=0.08)
    result = mesh_cycle(pair, 50)
    bearing = bearing_contact(pair, result.mesh, 1000.0, 115e9)
    ellipse = bearing.ellipse
    assert (ellipse.long > 5.0 * ellipse.short).all()
    point = result.mesh.point[:, bearing.index]
    assert np.abs((bearing.long_axis * bearing.short_axis).sum(0)).max() < 1e-12
    assert point.shape == bearing.long_axis.shape
    with pytest.raises(RangeError, match="no contact ellipse"):
        bearing_contact(drive(), mesh_cycle(drive(), 10).mesh, 1000.0, 115e9)


def test_equations_15_to_17_are_the_derivatives_of_appendix_2():
    pinion, step = drive().pinion, 1e-5
    low, high = (as_cut(pinion, profile_angle=sign * step) for sign in (-1, 1))
    alpha_n, alpha_t = pinion.normal_pressure_angle, pinion.transverse_pressure_angle
    lambda_b = 0.5 * math.pi - pinion.base_helix_angle
    by_alpha_n = math.sin(2.0 * alpha_t) / math.sin(2.0 * alpha_n)  # (15)
    for attribute, sign, printed in (
        ("transverse_pressure_angle", 1.0, by_alpha_n),
        ("base_helix_angle", -1.0, 0.5 * math.sin(2.0 * lambda_b) * math.tan(alpha_t) * by_alpha_n),  # (16)
        ("base_radius", 1.0, -pinion.pitch_radius * math.sin(alpha_t) * by_alpha_n),  # (17)
    ):
        slope = sign * (getattr(high, attribute) - getattr(low, attribute)) / (2.0 * step)
        assert slope == pytest.approx(printed, rel=1e-8), attribute
        key = {"transverse_pressure_angle": "transverse_angle", "base_helix_angle": "base_lead_angle"}
        found = getattr(ProfileAngleEffects.by_equations(pinion, step), key.get(attribute, attribute))
        assert found == pytest.approx(printed * step, rel=1e-13), attribute


def test_what_equations_15_to_17_miss_is_of_second_order():
    """Ten times the error, a hundred times the difference from Appendix 2 with the wrong angle; none of it at zero."""
    pinion = drive().pinion
    missed = []
    for error in (1.0 * ARCMIN, 10.0 * ARCMIN):
        lines, cut = (
            np.array(dataclasses.astuple(way(pinion, error)))
            for way in (ProfileAngleEffects.by_equations, ProfileAngleEffects.as_cut)
        )
        assert np.all(lines * cut > 0.0)
        missed.append(lines - cut)
    np.testing.assert_allclose(missed[1] / missed[0], 100.0, rtol=0.01)
    assert dataclasses.astuple(ProfileAngleEffects.as_cut(pinion, 0.0)) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("minutes", [0.01, 3.0, 60.0])
@pytest.mark.parametrize("where", [0.086, 0.088, 0.091])
def test_appendix_4_is_the_whole_solution_where_both_errors_are_of_one_size(minutes, where):
    """A.4.1 to A.4.8 as printed: in the paper they begin an iteration."""
    pair = drive(shaft=minutes, lead=-minutes)
    a, b, gamma = pair.cut_pinion, pair.gear, pair.errors.shaft_angle
    (la, pa), (lb, pb) = ((0.5 * math.pi - g.base_helix_angle, 1.0 / abs(g.twist)) for g in (a, b))
    Phi_2 = math.acos((math.cos(la) - math.cos(lb) * math.cos(gamma)) / (math.sin(lb) * math.sin(gamma)))
    Phi_1 = math.asin(math.sin(lb) / math.sin(la) * math.sin(Phi_2))
    u1 = math.sqrt(where**2 - a.base_radius**2) / math.cos(la)
    x1 = a.base_radius * math.cos(Phi_1) + u1 * math.cos(la) * math.sin(Phi_1)
    y1 = -a.base_radius * math.sin(Phi_1) + u1 * math.cos(la) * math.cos(Phi_1)
    u2 = (pair.centre_distance - b.base_radius * math.cos(Phi_2) - x1) / (math.cos(lb) * math.sin(Phi_2))
    y2 = u2 * math.cos(lb) * math.cos(Phi_2) - b.base_radius * math.sin(Phi_2)
    theta_2 = (y1 + u2 * math.sin(lb) * math.sin(gamma) + y2 * math.cos(gamma)) / (pb * math.sin(gamma))
    z = (u2 * math.sin(lb) - pb * theta_2) * math.cos(gamma) - y2 * math.sin(gamma)
    theta_1 = (z + u1 * math.sin(la)) / pa
    phi_1, phi_2 = (
        theta_1 + a.half_base_space_angle - Phi_1,
        Phi_2 - theta_2 + b.half_base_tooth_angle,
    )
    found = pair_contact(pair, [phi_1])
    assert found.kind[0] == "surface"
    # A.4.1 takes the difference of two cosines over a small sine: what is left of it is 1e-16 over the error.
    loss = 1e-15 / gamma
    assert found.error[0] == pytest.approx(phi_2 - pair.ratio * phi_1, abs=1e-10 * ARCMIN + loss)
    if minutes >= 3.0:
        assert (found.r1[0], found.z1[0]) == pytest.approx((where, z), abs=1e-8)
