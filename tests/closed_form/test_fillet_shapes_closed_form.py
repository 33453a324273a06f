"""Fillets of a user: what touches, what is tangent, and generated teeth given by points of their fillets."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.iso6336.pair_geometry import of_pair
from fegear.formulas.iso6336.part3_internal import outline_root_form
from fegear.geometry.curves import arc_length
from fegear.geometry.custom_fillet_tooth import with_fillet, with_tip
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import ArcFillet, ControlFillet, EllipseOnSpace, PointsFillet
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.mass import section_moments
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.tip_interference import interference

RING = InternalTooth(60, PinionCutter(30, 0.0, 1.25, math.nan, 0.2))
FULL = Tooth(25, BasicRack.full_fillet(1.0, 1.25, math.radians(20.0)))
SHIFTED, WIDE = Tooth(28, profile_shift=0.2, thickness_allowance=0.02), Tooth(45, BasicRack(1.0, 1.25, 0.25))


def points_of(tooth, count=61):
    fillet = tooth.fillet
    return tuple(map(tuple, fillet.points(np.linspace(fillet.start, fillet.end, count)).T.tolist()))


def radius_of(tooth, roll=0.0):
    return math.hypot(*tooth.fillet.points(np.array([tooth.fillet.end]))[:, 0])


CONTROL = with_fillet(SHIFTED, PointsFillet(points_of(SHIFTED, 9))).fillet.control
SHAPES = {
    "ellipse": EllipseOnSpace(),
    "deep ellipse": EllipseOnSpace(None, SHIFTED.root_radius - 0.15),
    "arc": ArcFillet((0.45,)),
    "arc from the form circle": ArcFillet((), 13.2),
    "two arcs": ArcFillet((0.9, 0.45), SHIFTED.form_radius + 0.05),
    "points": PointsFillet(points_of(SHIFTED)),
    "control points": ControlFillet(CONTROL),
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_fillet_joins_root_circle_and_flank_along_their_tangents(name):
    tooth = with_fillet(SHIFTED, SHAPES[name])
    fillet, involute = tooth.fillet, tooth.involute
    ends = fillet.points(np.array([fillet.start, fillet.end]))
    assert math.hypot(*ends[:, 0]) == pytest.approx(tooth.root_radius, abs=1e-9)
    land = math.pi / tooth.teeth - math.atan2(*ends[:, 0])
    assert land == pytest.approx(tooth.root_land_half_angle, abs=1e-9)
    assert ends[:, 1] == pytest.approx(involute.points(np.array([involute.start]))[:, 0], abs=1e-9)
    normals = fillet.normals(np.array([fillet.start, fillet.end]))
    assert normals[:, 0] == pytest.approx(ends[:, 0] / tooth.root_radius, abs=1e-9)
    assert normals[:, 1] == pytest.approx(involute.normals(np.array([involute.start]))[:, 0], abs=1e-7)
    assert not tooth.undercut


@pytest.mark.parametrize("name", SHAPES)
def test_normals_speed_and_curvature_are_those_of_the_points(name):
    fillet = with_fillet(SHIFTED, SHAPES[name]).fillet
    step = 1e-5 * (fillet.end - fillet.start)
    u = np.linspace(fillet.start, fillet.end, 40)[1:-1]
    ahead, behind, here = (fillet.points(at) for at in (u + step, u - step, u))
    slope = (ahead - behind) / (2.0 * step)
    assert np.hypot(*slope) == pytest.approx(np.abs(fillet.speed(u)), rel=1e-6)
    along = slope / np.hypot(*slope) * math.copysign(1.0, step)
    assert fillet.normals(u) == pytest.approx(np.stack([along[1], -along[0]]), abs=1e-6)
    bend = (ahead - 2.0 * here + behind) / step**2
    cross = (slope[0] * bend[1] - slope[1] * bend[0]) / np.hypot(*slope) ** 3
    smooth = np.abs(np.gradient(fillet.curvatures(u))) < 0.3  # not across the joint of two arcs
    assert smooth.sum() > 30
    assert cross[smooth] == pytest.approx(fillet.curvatures(u)[smooth], rel=2e-3, abs=2e-3)


def test_an_ellipse_obeys_its_equation():
    tooth = with_fillet(SHIFTED, EllipseOnSpace())
    e = tooth.fillet
    x, y = e.points(np.linspace(0.0, e.end, 50))
    turn = math.pi / tooth.teeth
    beside, along = y * math.sin(turn) - x * math.cos(turn), y * math.cos(turn) + x * math.sin(turn)
    up = along - tooth.root_radius
    assert (beside / e.beside) ** 2 + (up / e.along - 1.0) ** 2 == pytest.approx(np.ones(50), abs=1e-12)
    assert -e.curvatures(0.0) == pytest.approx(e.along / e.beside**2, rel=1e-12)


def test_two_arcs_touch_each_other():
    arcs = with_fillet(SHIFTED, ArcFillet((0.9, 0.45), SHIFTED.form_radius + 0.05)).fillet.arcs
    assert [abs(arc.radius) for arc in arcs] == pytest.approx([0.45, 0.9])
    assert math.dist(arcs[0].centre, arcs[1].centre) == pytest.approx(0.45)
    assert arcs[0].points(np.array([arcs[0].end])) == pytest.approx(
        arcs[1].points(np.array([arcs[1].start])), abs=1e-12
    )


@pytest.mark.parametrize(
    ("tooth", "bore"),
    [(SHIFTED, 8.0), (Tooth(12), 2.5), (FULL, 7.0), (RING, 35.0)],
    ids=["land", "undercut", "full", "ring"],
)  # fmt: skip
def test_a_generated_fillet_given_by_points_is_the_generated_tooth(tooth, bore):
    given = with_fillet(tooth, PointsFillet(points_of(tooth)))
    assert given.form_radius == pytest.approx(tooth.form_radius, rel=1e-12)
    assert given.root_land_half_angle == pytest.approx(tooth.root_land_half_angle, abs=1e-9)
    assert given.undercut == tooth.undercut
    assert given.dedendum == pytest.approx(tooth.dedendum, abs=1e-9)
    assert section_moments(given).area == pytest.approx(section_moments(tooth).area, rel=1e-9)
    found = {}
    for name, one in (("given", given), ("made", tooth)):
        solved = solve_gear(Gear(one, 3e-3, bore * 3e-3, 0.01), settings_at(-5.0), reach=1, estimate_error=False)
        radius = np.linspace(solved.lowest_radius, solved.highest_radius, 12)[3:-1]
        found[name] = np.stack([solved.largest_root_stress(k, side, radius)[0]
                                for k in (0, 1) for side in ("tension", "compression")])  # fmt: skip
    assert found["given"] == pytest.approx(found["made"], rel=1e-5)


def test_points_of_the_space_in_any_order_are_the_same():
    one = PointsFillet(points_of(SHIFTED))
    x, y = np.array(one.points).T
    polar, radius = math.pi / 28 - np.arctan2(x, y), np.hypot(x, y)
    of_space = np.stack([-radius * np.sin(polar), radius * np.cos(polar)]).T[::-1]
    usual, other = (with_fillet(SHIFTED, shape).fillet for shape in (
        one, PointsFillet(tuple(map(tuple, of_space)), of_space=True)))  # fmt: skip
    u = np.linspace(0.0, 1.0, 30)
    assert other.points(u * other.end) == pytest.approx(usual.points(u * usual.end), abs=1e-9)


def test_points_beyond_the_form_circle_belong_to_the_flank():
    flank = SHIFTED.involute.points(np.linspace(SHIFTED.involute.start, SHIFTED.involute.end, 20)[1:]).T.tolist()
    whole = (*points_of(SHIFTED), *map(tuple, flank))
    tooth = with_fillet(SHIFTED, PointsFillet(whole, form_radius=SHIFTED.form_radius))
    assert tooth.form_radius == pytest.approx(SHIFTED.form_radius, rel=1e-12)
    assert arc_length(tooth.fillet)[1][-1] == pytest.approx(arc_length(SHIFTED.fillet)[1][-1], rel=1e-6)


def test_scattered_points_are_smoothed_within_their_scatter():
    exact = np.array(points_of(SHIFTED, 121))
    rng = np.random.default_rng(4)
    seen = exact + rng.uniform(-1.0, 1.0, exact.shape) * 3e-4
    smooth = with_fillet(SHIFTED, PointsFillet(tuple(map(tuple, seen)), scatter=5e-4))
    rough = exact + rng.uniform(-1.0, 1.0, exact.shape) * 1e-5
    through = with_fillet(SHIFTED, PointsFillet(tuple(map(tuple, rough))))
    exact_radius = with_fillet(SHIFTED, PointsFillet(points_of(SHIFTED))).smallest_radius
    assert smooth.smallest_radius == pytest.approx(exact_radius, rel=0.1)
    assert through.swings > 10 > smooth.swings
    x, y = smooth.fillet.points(np.linspace(smooth.fillet.start, smooth.fillet.end, 4001))
    off = np.min(np.hypot(x - exact[:, :1], y - exact[:, 1:]), axis=1)
    assert off.max() < 6e-4


@pytest.mark.parametrize("shape", [EllipseOnSpace(), ArcFillet((0.3,)), PointsFillet(points_of(WIDE))])
def test_clearance_is_that_of_rolling_the_mating_tooth(shape):
    tooth = with_fillet(WIDE, shape) if isinstance(shape, PointsFillet) else with_fillet(Tooth(38), shape)
    mate = Tooth(21, thickness_allowance=0.03)
    pair = GearPair(Gear(mate, 1e-3, 5e-3), Gear(tooth, 1e-3, 9e-3), (21 + tooth.teeth) / 2 * 1e-3)
    own = rolled_gap(tooth, mate, pair)
    assert interference(pair, "driver", 6001).fillet_gap * 1e3 == pytest.approx(own, abs=5e-5)


def rolled_gap(tooth, mate, pair):
    """Least room along the circle between a fillet and the mating tip corner, which rolls with its flank in contact."""
    centre, half = pair.centre_distance * 1e3, float(mate.half_thickness_angle(mate.tip_radius))
    rolling = centre * mate.teeth / (mate.teeth + tooth.teeth)
    play = 0.5 * pair.circumferential_backlash * 1e3 / rolling
    turn = np.linspace(-0.4, 0.4, 20001)
    x, y = tooth.fillet.points(np.linspace(tooth.fillet.start, tooth.fillet.end, 4001))
    radius, polar = np.hypot(x, y), math.pi / tooth.teeth - np.arctan2(x, y)  # from the middle of the space
    least = math.inf
    for side in (1.0, -1.0):  # the corner that touches this side of the space, and the other one
        angle = math.pi + side * half + play - turn * tooth.teeth / mate.teeth
        px, py = mate.tip_radius * np.sin(angle), centre + mate.tip_radius * np.cos(angle)
        c, s = np.cos(turn), np.sin(turn)
        qx, qy = c * px - s * py, s * px + c * py
        r = np.hypot(qx, qy)
        inside = (r > radius[0]) & (r < radius[-1])
        for flank in (1.0, -1.0):
            gap = (np.interp(r, radius, polar) - flank * np.arctan2(qx, qy)) * r
            if inside.any():
                least = min(least, float(gap[inside].min()))
    return least


def test_the_standards_root_is_that_of_the_outline():
    pinion, wheel = Tooth(21, BasicRack(1.0, 1.25, 0.3), 0.2), Tooth(38, profile_shift=0.1)
    given = with_fillet(pinion, PointsFillet(points_of(pinion)))
    one, other = (outline_root_form(tooth, 2.0 * (tooth.pitch_radius + 0.5)) for tooth in (given, pinion))
    assert pytest.approx((other.Y_F, other.Y_S), rel=1e-6) == (one.Y_F, one.Y_S)
    gears = Gear(given, 2e-3, 8e-3, 0.02), Gear(wheel, 2e-3, 8e-3, 0.02)
    shape = of_pair(GearPair(*gears)).gears[0]
    assert shape.formed is given
    assert shape.dedendum == pytest.approx(1.25)


def test_the_tip_moves_and_the_fillet_stays():
    tooth = with_fillet(SHIFTED, EllipseOnSpace())
    shorter = with_tip(tooth, tooth.tip_radius - 0.3)
    assert shorter.tip_radius == tooth.tip_radius - 0.3
    assert shorter.fillet == tooth.fillet
    assert with_tip(SHIFTED, 14.9) == replace(SHIFTED, tip_radius=14.9)


def moved(points, count, off):
    """The last `count` points turned about the axis by an arc `off` [modules]."""
    p = np.array(points)
    p[-count:, 0] += off
    return tuple(map(tuple, p))


GOOD = points_of(SHIFTED)
NOTCH = (*((x + 0.004 * n, y) for n, (x, y) in enumerate(GOOD[:-1:6])), GOOD[-1])


@pytest.mark.parametrize(
    ("shape", "key", "said"),
    [
        (PointsFillet(moved(GOOD, 61, 0.05)), "fillet.points", "outside the tooth (limit"),
        (PointsFillet(moved(GOOD, 61, -0.05)), "fillet.points", "the points cross the flank"),
        (PointsFillet((GOOD[0], GOOD[30], GOOD[-1])), "fillet.points", "must be at least 4"),
        (PointsFillet(GOOD[:40]), "fillet.points", "base radius"),
        (PointsFillet((*GOOD[:30], GOOD[20], *GOOD[30:])), "fillet.points", "closer to the root"),
        (PointsFillet(NOTCH), "fillet.points", "in a notch of"),
        (PointsFillet(tuple((x * (-1) ** n, y) for n, (x, y) in enumerate(GOOD))), "fillet.points", "one side"),
        (EllipseOnSpace(SHIFTED.tip_radius + 0.1), "fillet.form_diameter", "no ellipse"),
        (EllipseOnSpace(SHIFTED.base_radius - 0.1), "fillet.form_diameter", "base radius"),
        (EllipseOnSpace(None, SHIFTED.form_radius + 0.1), "fillet.root_diameter", "must be below"),
        (ArcFillet((2.5,)), "fillet.radii", "beyond the middle of the tooth space"),
        (ArcFillet((0.05,)), "fillet.radii", "below its base circle"),
        (ArcFillet((0.02, 5.0), SHIFTED.form_radius), "fillet.radii", ""),
    ],
)  # fmt: skip
def test_fillets_that_cannot_be_are_refused_with_the_limit(shape, key, said):
    with pytest.raises(GeometryError) as problem:
        with_fillet(SHIFTED, shape)
    assert problem.value.key == key
    assert said in str(problem.value)
