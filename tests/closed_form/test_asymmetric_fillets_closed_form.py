"""Fillets of a user on teeth with two different flanks: one root circle, frames, mirror images, equal flanks."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_fillets import with_fillets
from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalTooth
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import ArcFillet, ControlFillet, EllipseOnSpace, PointsFillet
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import PinionCutter
from fegear.geometry.mass import section_moments
from fegear.geometry.outline import tooth_outline
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tip_interference import refuse_shaped


def rack(drive, coast, tips=(0.2, 0.3)):
    return AsymmetricRack(*(RackFlank(math.radians(a), tip) for a, tip in zip((drive, coast), tips, strict=True)))


TOOTH = AsymmetricTooth(28, rack(28.0, 18.0), 0.1, 0.02)
RING = AsymmetricInternalTooth(
    60, PinionCutter(25, 0.0, 1.25, math.nan, 0.15), math.radians(25.0), math.radians(20.0), 0.25
)


def points_of(side, count=61):
    fillet = side.fillet
    return PointsFillet(tuple(map(tuple, fillet.points(np.linspace(fillet.start, fillet.end, count)).T.tolist())))


#: Below the generated root circle, with a root land.
DEEP = TOOTH.root_radius - 0.03
ARC = ArcFillet((0.35,), None, DEEP)
TWO_ARCS = ArcFillet((1.5, 0.3), TOOTH.coast.form_radius + 0.05, DEEP)


FILLETS = {
    "drive ellipse": {"drive": EllipseOnSpace()},
    "coast arcs": {"coast": ArcFillet((1.5, 0.3), TOOTH.coast.form_radius + 0.03)},
    "both deeper": {"drive": ARC, "coast": TWO_ARCS},
    "points and ellipse": {"drive": points_of(TOOTH.drive), "coast": EllipseOnSpace()},
    "control points": {"drive": ControlFillet(with_fillets(
        TOOTH.drive, drive=points_of(TOOTH.drive, 9)).tooth._feet["drive"].fillet.control)},
}  # fmt: skip


@pytest.mark.parametrize("name", FILLETS)
def test_both_fillets_meet_at_one_root_circle_and_join_their_flanks(name):
    tooth = with_fillets(TOOTH.drive, **FILLETS[name])
    assert tooth.root_radius == tooth.back.root_radius
    assert tooth.root_land_half_angle == tooth.back.root_land_half_angle >= 0.0
    for side in (tooth, tooth.back):
        fillet, involute = side.fillet, side.involute
        ends = fillet.points(np.array([fillet.start, fillet.end]))
        assert math.hypot(*ends[:, 0]) == pytest.approx(tooth.root_radius, abs=1e-9)
        land = math.pi / tooth.teeth - math.atan2(*ends[:, 0])
        assert land == pytest.approx(side.root_land_half_angle, abs=1e-9)
        assert ends[:, 1] == pytest.approx(involute.points(np.array([involute.start]))[:, 0], abs=1e-9)
        normals = fillet.normals(np.array([fillet.start, fillet.end]))
        assert normals[:, 0] == pytest.approx(ends[:, 0] / tooth.root_radius, abs=1e-9)
        assert normals[:, 1] == pytest.approx(involute.normals(np.array([involute.start]))[:, 0], abs=1e-7)


@pytest.mark.parametrize("tooth", [TOOTH, RING], ids=["external", "internal"])
def test_generated_fillets_given_by_points_are_the_generated_tooth(tooth):
    """Root stress of both sides, and compliance."""
    usual = tooth.drive
    given = with_fillets(usual, drive=points_of(tooth.drive, 121), coast=points_of(tooth.coast, 121))
    found = []
    for one in (usual, given):
        bore = tooth.root_radius - 3.0 * one.side
        solved = solve_gear(Gear(one, 3e-3, bore * 3e-3, 0.01), settings_at(-5.0), reach=1, estimate_error=False)
        radius = np.linspace(*solved.gear.involute_radii, 7)[1:-1]
        found.append(np.stack([solved.largest_root_stress(0, side, radius)[0] for side in ("tension", "compression")]))
    assert found[1] == pytest.approx(found[0], rel=2e-5)


@pytest.mark.parametrize("shape", [EllipseOnSpace(), ArcFillet((0.5,)), PointsFillet(points_of(Tooth(28)).points)])
def test_equal_flanks_are_the_symmetric_tooth(shape):
    one = with_fillets(AsymmetricTooth(28, rack(20.0, 20.0, (0.25, 0.25))).drive, drive=shape, coast=shape)
    other = with_fillet(Tooth(28, BasicRack(1.0, 1.25, 0.25)), shape)
    for side in (one, one.back):
        for piece, curve in side.outline.items():
            same = other.outline[piece]
            u = np.linspace(0.0, 1.0, 30)
            here, there = (c.points(c.start + u * (c.end - c.start)) for c in (curve, same))
            assert here == pytest.approx(there, abs=1e-12), piece
    assert one.neck == pytest.approx(other.neck, rel=1e-12)
    stress = [
        solve_gear(Gear(side, 3e-3, 18e-3), settings_at(-6.0), reach=1, estimate_error=False).largest_root_stress(
            0, "tension", np.array([14.2 * 3e-3])
        )[0]
        for side in (one, other)
    ]
    assert stress[0] == pytest.approx(stress[1], rel=1e-9)


@pytest.mark.parametrize("name", ["drive ellipse", "both deeper", "points and ellipse"])
def test_a_reversed_tooth_has_its_fillets_exchanged(name):
    one = with_fillets(TOOTH.drive, **FILLETS[name])
    other = one.tooth.reversed
    assert other.coast.fillet_key == {"fillet": "coast_fillet", None: None}[one.fillet_key]
    assert tooth_outline(other.coast) == pytest.approx(tooth_outline(one), abs=1e-13)
    assert with_fillets(other.coast, drive=None, coast=None) == TOOTH.reversed.coast


def test_a_fillet_goes_on_to_where_the_other_one_ends():
    """The lowest line of the space moves, thickness of the tooth and the flanks' distance stay."""
    one = with_fillets(TOOTH.drive, drive=EllipseOnSpace())
    assert one.root_land_half_angle == 0.0
    assert one.turn == pytest.approx(-TOOTH.drive.root_land_half_angle, rel=1e-12)
    assert one.back.turn == -one.turn
    radius = TOOTH.pitch_radius
    assert one.thickness_angle(radius) == pytest.approx(float(TOOTH.drive.thickness_angle(radius)), rel=1e-13)
    moments = [section_moments(side).area for side in (one, TOOTH.drive)]
    assert 0.0 < abs(moments[0] / moments[1] - 1.0) < 0.01
    # The same by points from the generated middle, one half of the land beyond it.
    foot = one.tooth._feet["drive"].fillet
    by_points = PointsFillet(tuple(map(tuple, foot.points(np.linspace(foot.start, foot.end, 81)).T.tolist())))
    again = with_fillets(TOOTH.drive, drive=by_points)
    assert again.turn == pytest.approx(one.turn, rel=1e-6)
    assert again.smallest_radius == pytest.approx(one.smallest_radius, rel=1e-3)


@pytest.mark.parametrize(
    ("fillets", "key", "said"),
    [
        ({"drive": EllipseOnSpace(root_radius=12.5)}, "fillet.root_diameter", "of the other fillet"),
        ({"coast": EllipseOnSpace(root_radius=12.5)}, "coast_fillet.root_diameter", "of the other fillet"),
        ({"coast": ArcFillet((0.9,))}, "coast_fillet.radii", "beyond the other fillet"),
        ({"drive": PointsFillet(points_of(TOOTH.drive).points[20:])}, "fillet.points", "must be that of the other"),
        ({"drive": ARC, "coast": EllipseOnSpace(root_radius=DEEP + 0.1)}, "coast_fillet.root_diameter", "of the other"),
        ({"coast": EllipseOnSpace(TOOTH.tip_radius + 0.1)}, "coast_fillet.form_diameter", "has no ellipse"),
    ],
)
def test_fillets_that_do_not_go_together_are_refused_by_their_side(fillets, key, said):
    with pytest.raises(GeometryError) as refused:
        with_fillets(TOOTH.drive, **fillets)
    assert refused.value.key == key
    assert said in str(refused.value)


def test_the_mating_tip_is_followed_on_either_flank():
    gears = [Gear(AsymmetricTooth(z, rack(28.0, 18.0), 0.0, 0.02).drive, 1e-3, 5e-3) for z in (28, 41)]
    for flank, key in (("drive", "driver.fillet"), ("coast", "driver.coast_fillet")):
        side = gears[0].tooth
        high = EllipseOnSpace(side.tooth.side(flank).form_radius, None)
        refuse_shaped(GearPair(replace(gears[0], tooth=with_fillets(side, **{flank: high})), gears[1]))
        late = EllipseOnSpace(side.tooth.side(flank).form_radius + 0.35, None)
        pair = GearPair(replace(gears[0], tooth=with_fillets(side, **{flank: late})), gears[1])
        for seen in (pair, pair.from_the_back):
            with pytest.raises(GeometryError, match="active root diameter") as refused:
                refuse_shaped(seen)
            assert refused.value.key == key
