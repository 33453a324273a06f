"""Teeth cut by a rack with protuberance, against an envelope found by rolling the rack numerically."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from fegear.base.errors import GeometryError
from fegear.case.gear_tool import RackPart
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.formulas.iso6336 import part3_root_stress as iso
from fegear.formulas.root_section import section_at_tangent
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.generated_fillet import ProtuberanceFillet
from fegear.geometry.rack import BasicRack

DEG = math.pi / 180.0


def half_width(rack, depth):
    """Half the width of the rack's tooth at depths below its reference line, drawn from flank, ramp and circle."""
    a, p, rho = rack.pressure_angle, rack.protuberance_angle, rack.tip_radius
    left = rack.protuberance - rack.grinding_allowance
    below = rack.dedendum - rho
    centre = math.pi / 4 - below * math.tan(a) - (rho - left) / math.cos(a)
    ends = below + rho * math.sin(p)  # where the ramp runs into the circle
    ramp = centre + rho * math.cos(p) + (ends - depth) * math.tan(p)
    flank = math.pi / 4 - depth * math.tan(a)
    arc = centre + np.sqrt(np.maximum(rho**2 - (depth - below) ** 2, 0.0))
    deepest = below + rho * math.sin(a)  # where the circle stands out of the flank by what is left
    wide = np.maximum(
        np.where(depth < ends, ramp if left > 0.0 else flank, arc), np.where(depth < deepest, flank, -1.0)
    )
    return np.where(depth <= rack.dedendum, wide, -1.0)


def rolled_half_angles(tooth, radii, places=(2001, 401)):
    """Half the tooth's angle at radii: the widest angle at which some position of the rolling rack still cuts."""
    r, top = 0.5 * tooth.teeth, 0.5 * tooth.teeth + tooth.generating_shift
    low, high = np.zeros(radii.size), np.full(radii.size, 2.0 * math.pi / tooth.teeth)
    # The steepest part of the rack is met the farther from the pitch point the steeper it is.
    farthest = max(6.0, 2.0 / math.tan(tooth.rack.protuberance_angle)) / r
    span = np.tile([[-farthest], [farthest]], (1, radii.size))

    def reach(psi, turn):
        x, y = radii * np.sin(psi + turn), radii * np.cos(psi + turn)
        return half_width(tooth.rack, top - y) - np.abs(x - r * turn)

    for _ in range(44):
        psi, window = 0.5 * (low + high), span
        for count in places:
            turn = window[0] + (window[1] - window[0]) * np.linspace(0.0, 1.0, count)[:, None]
            inside = reach(psi, turn)
            best = turn[inside.argmax(axis=0), np.arange(radii.size)]
            step = (window[1] - window[0]) / (count - 1)
            window = np.stack([best - step, best + step])
        cut = inside.max(axis=0) > 0.0
        low, high = np.where(cut, psi, low), np.where(cut, high, psi)
    return math.pi / tooth.teeth - 0.5 * (low + high)


def outline_half_angles(tooth, radii):
    """Half the tooth's angle at radii by the tooth's own curves."""
    found = []
    for radius in radii:
        if radius >= tooth.form_radius:
            found.append(float(tooth.half_thickness_angle(radius)))
            continue
        u = np.linspace(tooth.fillet.start, tooth.fillet.end, 40_001)
        x, y = tooth.fillet.points(u)
        found.append(float(np.interp(radius, np.hypot(x, y), np.arctan2(x, y))))
    return np.array(found)


racks = st.builds(
    lambda a, d, rho, cut, stock, p: (a * DEG, d, rho, cut, stock, min(p, a - 2.0) * DEG),
    st.floats(15.0, 25.0), st.floats(1.2, 1.4), st.floats(0.15, 0.4), st.just(0.0) | st.floats(1e-3, 0.12),
    st.floats(0.0, 0.1),
    st.floats(3.0, 15.0),
)  # fmt: skip


@pytest.mark.examples(15, 400)
@given(racks, st.integers(12, 120), st.floats(-0.3, 0.6))
def test_the_outline_is_what_the_rolling_rack_leaves(numbers, teeth, shift):
    a, d, rho, cut, stock, p = numbers
    try:
        tooth = Tooth(teeth, BasicRack(1.0, d, rho, a, cut + stock, stock, p), shift)
    except GeometryError:  # pointed, necked or without room for the rounding
        assume(False)
    root, tip = tooth.root_radius, tooth.involute_tip_radius
    radii = np.concatenate([
        root + (tip - root) * np.linspace(0.05, 0.99, 9),
        tooth.form_radius * np.array([1.0 - 3e-4, 1.0 + 3e-4]),
    ])  # fmt: skip
    found, rolled = outline_half_angles(tooth, radii), rolled_half_angles(tooth, radii)
    assert found * radii == pytest.approx(rolled * radii, abs=2e-6)
    assert tooth.undercut or cut < 1e-3
    # Points, normals and lengths of the fillet fit together, also where the trochoid hands over to the ramp's involute.
    u = np.linspace(tooth.fillet.start, tooth.fillet.end, 2001)[1:-1]
    h = 1e-7
    step = (tooth.fillet.points(u + h) - tooth.fillet.points(u - h)) / (2.0 * h)
    assert np.hypot(*step) == pytest.approx(tooth.fillet.speed(u), rel=2e-3, abs=1e-6)
    assert np.abs((step * tooth.fillet.normals(u)).sum(axis=0)).max() < 1e-3 * np.hypot(*step).max()
    assert np.hypot(*(tooth.fillet.points(tooth.fillet.end) - tooth.involute.points(tooth.involute.start))) < 1e-9


@pytest.mark.parametrize("teeth", [17, 25, 60])
@pytest.mark.parametrize(("pr", "q"), [(0.1, 0.06), (0.1, 0.0), (0.02, 0.0)])
def test_iso_6336s_section_holds_s_pr_exactly(teeth, pr, q):
    # The auxiliary equations of ISO 6336-3, 6.2, with s_pr = pr - q against the tangent of the generated trochoid.
    tooth = Tooth(teeth, BasicRack(1.0, 1.4, 0.39, 20.0 * DEG, pr, q, 10.0 * DEG), 0.2)
    f = iso.root_form(iso.rack_tooth(tooth), 2.0 * tooth.tip_radius)
    p = section_at_tangent(tooth, math.pi / 6)
    assert f.root_chord == pytest.approx(p.thickness, rel=1e-11)
    assert f.fillet_radius == pytest.approx(p.fillet_radius, rel=1e-11)
    plain = Tooth(teeth, BasicRack(1.0, 1.4, 0.39), 0.2)
    assert f.root_chord < iso.root_form(iso.rack_tooth(plain), 2.0 * plain.tip_radius).root_chord


def test_stock_as_thick_as_the_protuberance_leaves_the_plain_tooth():
    plain, ground = (Tooth(25, BasicRack(1.0, 1.4, 0.39, 20.0 * DEG, pr, pr)) for pr in (0.0, 0.07))
    assert ground.form_radius == plain.form_radius
    assert ground.fillet == plain.fillet
    nearly = Tooth(25, BasicRack(1.0, 1.4, 0.39, 20.0 * DEG, 1e-9, 0.0))
    assert nearly.form_radius == pytest.approx(plain.form_radius, abs=1e-3)  # goes with the square root


@pytest.mark.parametrize("angle", [3.0, 10.0, 17.0])
def test_the_elements_follow_the_generated_outline(angle):
    tooth = Tooth(28, BasicRack(1.0, 1.4, 0.35, 20.0 * DEG, 0.08, 0.02, angle * DEG))
    assert isinstance(tooth.fillet, ProtuberanceFillet) == (angle == 17.0)
    # A flatter ramp hands over to its own involute; a steep one leaves the rounding to come out of the flank by itself.
    mesh = mesh_sector(tooth, 8.0, MeshSettings().scaled(1.5))
    for name, curve in (("fillet", tooth.fillet), ("flank", tooth.involute)):
        nodes = mesh.points[:, np.unique(mesh.edges[name])]
        u = np.linspace(curve.start, curve.end, 20_001)
        x, y = curve.points(u)
        radius, polar = np.hypot(*nodes), np.arctan2(*nodes)
        expected = np.interp(radius, np.hypot(x, y), np.arctan2(x, y))
        # Middle nodes lie on the curve too; interpolation of the table itself leaves 1e-8.
        assert polar == pytest.approx(expected, abs=2e-6)


def test_a_case_names_the_protuberance_in_modules():
    part = RackPart.model_validate(
        {"profile": "ISO 53 D", "protuberance": 0.1, "grinding_allowance": 0.06, "protuberance_angle": "8 deg"}
    )
    rack = part.build(20.0 * DEG)
    assert rack.residual_undercut == pytest.approx(0.04, rel=1e-12)
    assert rack.protuberance_angle == pytest.approx(8.0 * DEG, rel=1e-12)
    assert (rack.dedendum, rack.tip_radius) == (1.40, 0.39)
    full = RackPart.model_validate({"tip_radius": "full", "protuberance": 0.05}).build(20.0 * DEG)
    assert full.tip_centre_offset == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"protuberance": -0.1}, "must not be negative"),
        ({"protuberance": 0.05, "grinding_allowance": 0.06}, "exceeds the protuberance of"),
        ({"protuberance": 0.1, "protuberance_angle": 20.0 * DEG}, "below the pressure angle"),
        ({"protuberance": 0.3}, "tip radius of"),
    ],
)
def test_racks_that_no_grinder_can_follow_are_refused(change, words):
    with pytest.raises(GeometryError, match=words):
        BasicRack(tip_radius=0.25, **change)


@pytest.mark.parametrize("left", [2e-17, 1e-16])
@pytest.mark.parametrize("stock", [0.0, 0.05])
def test_a_protuberance_that_is_lost_in_round_off_leaves_the_plain_tooth(left, stock):
    """Half of one unit in the last place: nowhere does it come out of the flank."""
    rack = BasicRack(1.0, 1.4, 0.3, protuberance=stock + left, grinding_allowance=stock)
    plain, found = Tooth(28, BasicRack(1.0, 1.4, 0.3), 0.1), Tooth(28, rack, 0.1)
    assert found.form_radius == pytest.approx(plain.form_radius, rel=1e-12)
    assert found.root_radius == pytest.approx(plain.root_radius, rel=1e-12)
