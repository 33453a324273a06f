"""Y_F and Y_S on the outline: the rack's formulas on external teeth, polygons on internal ones."""

import math

import numpy as np
import pytest

from fegear.base.errors import FegearError, RangeError
from fegear.formulas.iso6336.part3_internal import outline_root_form, ring_root_form, ring_tooth
from fegear.formulas.iso6336.part3_root_stress import rack_tooth, root_form
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.outline import tooth_outline


def test_external_teeth_have_the_form_of_the_racks_formulas():
    """50 random teeth: section at the 30 degree tangent, lever, fillet radius, both factors."""
    rng, seen = np.random.default_rng(63), 0
    while seen < 50:
        try:
            tooth = Tooth(int(rng.integers(18, 120)), profile_shift=rng.uniform(-0.1, 0.6))
            radius = rng.uniform(*tooth.involute_radii)
            asked = root_form(rack_tooth(tooth), 2.0 * radius)
        except FegearError:
            continue
        found = outline_root_form(tooth, 2.0 * radius)
        for key in ("root_chord", "fillet_radius", "moment_arm", "Y_F", "Y_S", "height"):
            assert getattr(found, key) == pytest.approx(getattr(asked, key), rel=1e-8), key
        assert found.load_angle == pytest.approx(abs(asked.load_angle), abs=1e-10)
        seen += 1


def by_polygon(tooth, radius):
    """Chord, lever and angle of the load from points of the outline alone."""
    line = tooth_outline(tooth, 1e-9)
    line = line[:, line[0] > 1e-9]
    line = line[:, np.append(True, np.hypot(*np.diff(line)) > 1e-12)]
    along = np.diff(line)
    middle, lean = 0.5 * (line[:, 1:] + line[:, :-1]), np.arctan2(np.abs(along[0]), np.abs(along[1]))
    on_fillet = np.hypot(*middle) > tooth.form_radius + 1e-9
    own, leans = middle[:, on_fillet], lean[on_fillet]
    at = np.flatnonzero((leans[:-1] - math.pi / 3) * (leans[1:] - math.pi / 3) <= 0.0)[-1]
    flank = int(np.argmin(np.abs(np.hypot(*middle) - radius)))
    px, py = middle[:, flank]
    normal = np.array([along[1, flank], -along[0, flank]])
    return 2.0 * own[0, at], abs(py - px * normal[1] / normal[0] - own[1, at]), lean[flank]


def test_internal_teeth_have_the_section_of_their_polygons():
    rng, seen = np.random.default_rng(64), 0
    while seen < 12:
        try:
            cutter = PinionCutter(int(rng.integers(18, 30)), 0.1, 1.25, tip_radius=rng.uniform(0.15, 0.3))
            tooth = InternalTooth(int(rng.integers(50, 120)), cutter, profile_shift=rng.uniform(-0.4, 0.3))
            low, high = tooth.involute_radii
            radius = low + rng.uniform(0.05, 0.4) * (high - low)
            found = outline_root_form(tooth, 2.0 * radius)
        except FegearError:
            continue
        chord, lever, load_angle = by_polygon(tooth, radius)
        assert found.root_chord == pytest.approx(chord, rel=1e-3)
        assert found.moment_arm == pytest.approx(lever, rel=2e-3)
        assert found.load_angle == pytest.approx(load_angle, abs=2e-3)
        y_f = 6.0 * lever * math.cos(load_angle) / (chord**2 * math.cos(tooth.pressure_angle))
        assert pytest.approx(y_f, rel=4e-3) == found.Y_F
        seen += 1


def test_loads_off_the_involute_are_refused():
    with pytest.raises(RangeError, match="is not on the involute"):
        outline_root_form(InternalTooth(60, PinionCutter(20), tip_radius=29.2), 2.0 * 31.0)


def test_loads_beside_the_root_section_are_refused():
    """The 60 degree tangent touches high on the fillet, so loads near the root have no lever."""
    tooth = InternalTooth(60, PinionCutter(25))
    assert outline_root_form(tooth, 2.0 * 30.45).moment_arm < 0.35
    with pytest.raises(RangeError, match="is at the root section \\(no bending moment arm\\)"):
        outline_root_form(tooth, 2.0 * 30.9)


def test_the_standards_ring_has_the_section_of_its_outline():
    """Random rings: the rack that stands for the cutter leaves chord and lever to 3 %, and a blunter fillet."""
    rng, seen = np.random.default_rng(65), 0
    while seen < 25:
        try:
            cutter = PinionCutter(int(rng.integers(25, 40)), 0.0, 1.25, tip_radius=rng.uniform(0.2, 0.35))
            tooth = InternalTooth(int(rng.integers(60, 160)), cutter, profile_shift=rng.uniform(-0.3, 0.3))
            low, high = tooth.involute_radii
            at = 2.0 * (low + rng.uniform(0.05, 0.3) * (high - low))
            outline, found = outline_root_form(tooth, at), ring_root_form(ring_tooth(tooth), at)
        except FegearError:
            continue
        assert found.root_chord == pytest.approx(outline.root_chord, rel=0.03)
        assert found.moment_arm == pytest.approx(outline.moment_arm, rel=0.03)
        assert found.load_angle == pytest.approx(outline.load_angle, abs=1e-9)
        assert 1.0 < found.fillet_radius / outline.fillet_radius < 1.6
        seen += 1


@pytest.mark.parametrize("degrees", [1e-4, 12.0, 25.0])
def test_helical_rings_go_through_their_virtual_tooth(degrees):
    """z_n of ISO 21771, cut as deep and shifted as the ring is; with the helix it goes to the spur ring."""
    beta, cutter = math.radians(degrees), PinionCutter(30, 0.05, 1.25, tip_radius=0.25)
    helical = ring_tooth(InternalTooth(75, cutter, profile_shift=0.1, helix_angle=beta, thickness_allowance=0.02))
    spur = ring_tooth(InternalTooth(75, cutter, profile_shift=0.1, thickness_allowance=0.02))
    base = math.asin(math.sin(beta) * math.cos(math.radians(20.0)))
    assert helical.teeth == pytest.approx(75.0 / (math.cos(base) ** 2 * math.cos(beta)), rel=1e-12)
    assert helical.profile_shift == pytest.approx(0.1 - 0.01 / math.tan(math.radians(20.0)), rel=1e-12)
    assert helical.dedendum == pytest.approx(spur.dedendum, abs=0.02)
    if degrees < 1.0:
        forms = [ring_root_form(one, one.load_diameter(one.teeth - 2.0, 1.6)) for one in (helical, spur)]
        assert pytest.approx(forms[1].Y_F, rel=1e-6) == forms[0].Y_F
        assert pytest.approx(forms[1].Y_S, rel=1e-6) == forms[0].Y_S
