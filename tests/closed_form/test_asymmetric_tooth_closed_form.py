"""Teeth whose two flanks differ: an own rolling of the rack, equal flanks as ever, and flanks exchanged."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from fegear.atlas.family import Family
from fegear.base.errors import GeometryError, InputError
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.balls_on_two_flanks import ball_touching_at
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.gear_data import GearData
from fegear.geometry.inspection import span
from fegear.geometry.involute_tooth import InvoluteTooth
from fegear.geometry.mass import section_moments
from fegear.geometry.outline import tooth_outline
from fegear.geometry.over_balls import over_balls, touching_ball
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


def rack(drive, coast, radii=(0.25, 0.25), addendum=1.0, dedendum=1.25):
    flanks = (RackFlank(math.radians(a), r) for a, r in zip((drive, coast), radii, strict=True))
    return AsymmetricRack(*flanks, addendum, dedendum)


#: Teeth, rack, profile shift, allowance, helix angle [deg].
TEETH = {
    "20/30": (28, rack(20.0, 30.0, (0.25, 0.2)), 0.1, 0.0, 0.0),
    "28/18": (23, rack(28.0, 18.0, (0.2, 0.3)), 0.3, 0.05, 0.0),
    "35/20": (40, rack(35.0, 20.0, (0.15, 0.2)), 0.0, 0.0, 0.0),
    "35/20, helical": (31, rack(35.0, 20.0, (0.1, 0.22)), -0.1, 0.0, 18.0),
    "undercut on one flank": (13, rack(30.0, 17.0, (0.15, 0.25)), 0.1, 0.0, 0.0),
    "one rounding beyond the middle": (30, rack(38.0, 15.0, (0.25, 0.3), dedendum=1.1), 0.0, 0.0, 0.0),
}


def made(name, **more):
    teeth, tool, shift, allowance, helix = TEETH[name]
    return AsymmetricTooth(teeth, tool, shift, allowance, helix_angle=math.radians(helix), **more)


def rolled(tooth, sign):
    """Points that the rack's flank and rounding on one side cut, in the space's frame: clockwise angle and radius.

    The rack's tooth hangs into the space, its middle at u = 0; it is cut where the normal passes through the pitch
    point. `sign` is -1 on the rack's left, where it makes the drive flank of the tooth before the space.
    """
    one = tooth.rack.drive if sign < 0 else tooth.rack.coast
    alpha, rho, c, r = one.pressure_angle, one.tip_radius, math.cos(tooth.helix_angle), tooth.pitch_radius
    line = tooth.profile_shift - tooth.thickness_allowance / (
        math.tan(tooth.rack.drive.pressure_angle) + math.tan(tooth.rack.coast.pressure_angle)
    )
    v = np.linspace(line - tooth.rack.dedendum, line + 1.5, 4001)
    flank = np.stack([math.pi / 4 + (v - line) * math.tan(alpha), v])
    flank_normal = np.stack([np.full_like(v, math.cos(alpha)), np.full_like(v, -math.sin(alpha))])
    depth = line - tooth.rack.dedendum + rho
    middle = math.pi / 4 + (depth - line) * math.tan(alpha) - rho / math.cos(alpha)
    b = np.linspace(0.0, math.pi / 2 - alpha, 301)
    round_normal = np.stack([np.sin(b), -np.cos(b)])
    rounding = np.array([[middle], [depth]]) + rho * round_normal
    cut = []
    for (u, height), (nu, nv) in ((flank, flank_normal), (rounding, round_normal)):
        across = sign * u / c
        travel = height * sign * nu * c / nv - across
        x, y, turn = across + travel, r + height, travel / r
        # the gear has turned clockwise by `turn`; back to where it began
        cut.append((np.arctan2(x, y) - turn, np.hypot(x, y)))
    return cut, middle / c, b


@pytest.mark.parametrize("name", TEETH)
def test_an_own_rolling_of_the_rack_gives_both_flanks_and_fillets(name):
    tooth = made(name)
    found = {sign: rolled(tooth, sign) for sign in (-1, 1)}
    # the middle of the root land, from which the tooth's centre line lies half a pitch away
    middle = 0.5 * (found[1][1] - found[-1][1]) / tooth.pitch_radius
    for side, sign in ((tooth.drive, -1), (tooth.coast, 1)):
        ((angle, radius), (fillet_angle, fillet_radius)), _, b = found[sign]
        on = (radius > side.form_radius) & (radius < side.tip_radius)
        # a point ahead of the involute's cusp lies on its other branch
        on &= np.arange(on.size) >= np.argmin(radius)
        assert on.sum() > 100
        own = math.pi / tooth.teeth - sign * (angle[on] - middle)
        assert np.abs((own - side.flank_angle(radius[on])) * radius[on]).max() < 1e-9
        drawn = side.fillet.points(b)
        own = math.pi / tooth.teeth - sign * (fillet_angle - middle)
        assert np.hypot(*drawn) == pytest.approx(fillet_radius, abs=1e-9)
        assert np.abs((np.arctan2(*drawn) - own) * fillet_radius).max() < 1e-9


@pytest.mark.parametrize("name", TEETH)
def test_the_outline_has_no_gap_from_land_to_land(name):
    tooth = made(name)
    ends = []
    for side in (tooth.drive, tooth.coast):
        pieces = list(side.outline.values())
        for one, other in pairwise(pieces):
            assert one.points(one.end) == pytest.approx(other.points(other.start), abs=2e-9)
        ends.append(pieces)
    front, back = (pieces[-1].points(pieces[-1].end) for pieces in ends)
    assert front[0] == -back[0]
    assert front[1] == back[1]
    starts = [pieces[0].points(pieces[0].start) for pieces in ends]
    assert np.array_equal(*starts)
    assert math.atan2(*starts[0]) == pytest.approx(math.pi / tooth.teeth, rel=1e-14)


@pytest.mark.parametrize("name", TEETH)
def test_area_and_polar_moment_are_those_of_the_drawn_polygon(name):
    tooth = made(name, tip_chamfer=0.05)
    exact = section_moments(tooth.drive)
    x, y = tooth_outline(tooth.drive, 1e-7)
    # the triangles from the gear's centre to each chord: area, and polar moment about the centre
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    squares = x[:-1] ** 2 + x[:-1] * x[1:] + x[1:] ** 2 + y[:-1] ** 2 + y[:-1] * y[1:] + y[1:] ** 2
    assert -0.5 * tooth.teeth * cross.sum() == pytest.approx(exact.area, rel=1e-7)
    assert -tooth.teeth * (cross * squares).sum() / 12.0 == pytest.approx(exact.polar, rel=1e-7)
    turned_round = section_moments(tooth.coast)
    assert (turned_round.area, turned_round.polar) == pytest.approx((exact.area, exact.polar), rel=1e-14)


@pytest.mark.parametrize(
    "given",
    [
        {"teeth": 28},
        {"teeth": 10, "profile_shift": 0.1},
        {"teeth": 35, "helix_angle": 0.3, "thickness_allowance": 0.04, "tip_rounding": 0.1},
        {"teeth": 22, "tip_chamfer": 0.05, "profile_shift": 0.3},
    ],
)
def test_equal_flanks_are_the_symmetric_tooth_to_the_last_bit(given):
    usual = Tooth(rack=BasicRack(1.0, 1.25, 0.25, math.radians(20.0)), **given)
    tooth = AsymmetricTooth(rack=rack(20.0, 20.0), **given)
    assert tooth.tip_radius == usual.tip_radius
    assert tooth.least_profile_shift == pytest.approx(usual.least_profile_shift, abs=1e-13)
    assert np.array_equal(tooth_outline(tooth.drive)[:, 1:-1], tooth_outline(usual)[:, 1:-1])
    assert section_moments(tooth.drive).area == pytest.approx(section_moments(usual).area, rel=1e-14)
    for side in (tooth.drive, tooth.coast):
        assert side.outline == usual.outline
        for name in ("base_radius", "base_half_angle", "form_radius", "root_radius", "undercut", "tip_half_angle"):
            assert getattr(side, name) == getattr(usual, name)


@pytest.mark.parametrize("name", TEETH)
def test_a_tooth_turned_round_shows_its_other_flank(name):
    tooth = made(name, tip_rounding=0.05)
    other = tooth.reversed
    assert other.reversed == tooth
    assert other.drive.outline == tooth.coast.outline
    assert other.coast.outline == tooth.drive.outline
    assert tooth.drive.back is tooth.coast
    assert tooth.coast.back is tooth.drive


def test_the_steeper_flank_has_the_smaller_base_circle_and_the_flatter_one_is_cut_first():
    tooth = made("undercut on one flank")
    assert tooth.drive.base_radius < tooth.coast.base_radius
    assert tooth.coast.undercut
    assert not tooth.drive.undercut
    just = replace(tooth, profile_shift=tooth.least_profile_shift + 1e-6)
    below = replace(tooth, profile_shift=tooth.least_profile_shift - 1e-6)
    assert not just.coast.undercut
    assert not replace(tooth, profile_shift=tooth.least_profile_shift - 1e-13).coast.undercut
    assert below.coast.undercut


def test_what_takes_symmetric_teeth_only_is_not_given_others():
    tooth = made("20/30")
    assert not isinstance(tooth, InvoluteTooth)
    assert not isinstance(tooth.drive, InvoluteTooth)
    assert not hasattr(tooth, "half_thickness_angle")
    assert not hasattr(tooth.drive, "half_thickness_angle")


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: rack(20.0, 60.0), "rack.coast.pressure_angle"),
        (lambda: rack(40.0, 40.0), "pointed rack tooth"),
        (lambda: rack(28.0, 28.0, (0.3, 0.3)), "do not fit side by side"),
        (lambda: AsymmetricTooth(20, rack(30.0, 28.0, (0.1, 0.1)), 0.9), "pointed tooth"),
        (lambda: AsymmetricTooth(5, rack(14.0, 14.0), -0.5), "undercut from both sides"),
        (lambda: AsymmetricTooth(28, rack(20.0, 30.0, (0.2, 0.2)), tip_rounding=0.7), "is too large for the tip"),
        (lambda: AsymmetricTooth(28, rack(20.0, 30.0, (0.2, 0.2)), tip_radius=13.1), "larger base radius"),
    ],
)
def test_what_cannot_be_is_refused(build, said):
    with pytest.raises(GeometryError, match=said):
        build()


def test_full_fillet_of_two_angles_is_accepted_and_no_more():
    widest = rack(20.0, 30.0, (0.0, 0.0)).full_fillet_radius
    assert rack(20.0, 30.0, (widest, widest)).tip_land == pytest.approx(0.0, abs=1e-14)
    with pytest.raises(GeometryError, match="do not fit"):
        rack(20.0, 30.0, (widest + 1e-6, widest))


# ---- pairs ---------------------------------------------------------------------------------------------------------


def gear(tooth):
    """A gear of pure numbers: module 1, seen from its drive flank."""
    side = tooth.drive if isinstance(tooth, AsymmetricTooth) else tooth
    return Gear(side, 1.0, 0.5 * tooth.root_radius, 5.0, Material(1.0))


def pair_of(teeth, distance=math.nan):
    return GearPair(*map(gear, teeth), distance)


@pytest.mark.parametrize("name", TEETH)
def test_a_drawing_has_base_circles_of_both_flanks_by_their_angles(name):
    """d_b = d cos alpha_t of each flank."""
    tooth = made(name)
    module = 2e-3
    hand = "right" if tooth.helix_angle else "spur"
    side = Gear(tooth.drive, module, 0.5 * tooth.root_radius * module, hand=hand)
    data = GearData(side, bool(side.helix_angle), None, None, {}, name)
    reference = module * tooth.teeth / math.cos(side.helix_angle)
    both = (data.base_diameter, data.pressure_angle), (data.back_base_diameter, data.back_pressure_angle)
    for found, angle in both:
        transverse = math.atan(math.tan(angle) / math.cos(side.helix_angle))
        assert found == pytest.approx(reference * math.cos(transverse), rel=1e-12)
    assert data.pressure_angle != data.back_pressure_angle
    assert data.root_form_diameter == pytest.approx(2.0 * module * tooth.drive.form_radius)
    assert data.back_root_form_diameter == pytest.approx(2.0 * module * tooth.drive.back.form_radius)


NAMES = ("centre_distance", "tight_centre_distance", "circumferential_backlash", "normal_backlash", "free_backlash",
         "working_pressure_angle", "contact_ratio", "x_start", "x_end")  # fmt: skip


@pytest.mark.parametrize("distance", [math.nan, 26.4])
def test_a_pair_of_equal_flanks_is_the_usual_pair(distance):
    numbers = ((20, 0.25), (32, 0.0))
    usual = pair_of([Tooth(z, BasicRack(), x, 0.02) for z, x in numbers], distance)
    found = pair_of([AsymmetricTooth(z, rack(20.0, 20.0), x, 0.02) for z, x in numbers], distance)
    assert found.asymmetric
    assert not usual.asymmetric
    assert usual.from_the_back is usual
    for one in (found, found.from_the_back):
        for name in NAMES:
            assert getattr(one, name) == pytest.approx(getattr(usual, name), rel=1e-12, abs=1e-12), name


@pytest.mark.parametrize("teeth", [(24, 24), (17, 40), (22, 41), (31, 23)])
def test_a_pair_at_its_tight_distance_has_no_backlash_at_all(teeth):
    """Not -1.7e-15 mm, as a run printed."""
    for x in (-0.05, 0.1, 0.25):
        pair = pair_of([AsymmetricTooth(z, rack(25.0, 18.0, (0.2, 0.25)), x) for z in teeth])
        assert pair.normal_backlash == 0.0
        assert (
            pair_of(
                [AsymmetricTooth(z, rack(25.0, 18.0, (0.2, 0.25)), x) for z in teeth],
                pair.centre_distance * (1.0 + 1e-9),
            ).normal_backlash
            > 0.0
        )  # a nanometre is one


def test_a_pair_turned_round_drives_on_its_other_flanks():
    teeth = [AsymmetricTooth(z, rack(30.0, 20.0, (0.15, 0.3)), x) for z, x in ((22, 0.3), (41, -0.1))]
    distance = pair_of(teeth).centre_distance + 0.05
    pair, turned = pair_of(teeth, distance), pair_of([tooth.reversed for tooth in teeth], distance)
    for name in NAMES:
        assert getattr(pair.from_the_back, name) == pytest.approx(getattr(turned, name), rel=1e-13, abs=1e-13), name
    assert turned.circumferential_backlash == pytest.approx(pair.circumferential_backlash, abs=1e-13)
    # the steep flank has the shorter path of contact and, at one backlash, the smaller gap along its normal
    assert pair.contact_ratio < turned.contact_ratio
    assert turned.normal_backlash < pair.normal_backlash


def test_backlash_is_what_driven_points_of_both_flanks_leave_free():
    """Both gears' involutes laid through the pitch point in turn; the driven gear turns back until its others touch."""
    teeth = [AsymmetricTooth(z, rack(30.0, 20.0, (0.15, 0.3)), x, 0.03) for z, x in ((22, 0.3), (41, -0.1))]
    nominal = pair_of(teeth)
    pair = pair_of(teeth, nominal.centre_distance + 0.02)
    taken = 0.0
    for tooth in teeth:
        working = pair.centre_distance * tooth.teeth / (teeth[0].teeth + teeth[1].teeth)
        for side in (tooth.drive, tooth.coast):
            involute, roll = side.involute, float(side.roll(working))
            taken += working * math.atan2(*involute.points(roll))
    pitch = 2.0 * math.pi * pair.centre_distance / (teeth[0].teeth + teeth[1].teeth)
    assert pair.circumferential_backlash == pytest.approx(pitch - taken, abs=1e-12)
    back = pair.from_the_back.working_pressure_angle
    assert pair.normal_backlash == pytest.approx((pitch - taken) * math.cos(back), abs=1e-12)
    assert pair.free_backlash == pytest.approx((pitch - taken) * math.cos(pair.working_pressure_angle), abs=1e-12)
    assert pair_of(teeth, pair.tight_centre_distance).circumferential_backlash == pytest.approx(0.0, abs=1e-12)
    # without allowances the nominal distance is the tight one
    full = [replace(tooth, thickness_allowance=0.0) for tooth in teeth]
    assert pair_of(full).tight_centre_distance == pytest.approx(nominal.centre_distance, rel=1e-13)


def test_pairs_that_cannot_run_are_refused():
    one, other = (AsymmetricTooth(z, rack(a, 20.0, (0.15, 0.3))) for z, a in ((22, 30.0), (41, 28.0)))
    third = AsymmetricTooth(41, rack(30.0, 22.0, (0.15, 0.3)))
    with pytest.raises(GeometryError, match="base pitches"):
        pair_of([one, other])
    with pytest.raises(GeometryError, match="non-working flanks to mesh"):
        pair_of([one, third])
    with pytest.raises(GeometryError, match="non-working flanks to mesh"):
        pair_of([one, Tooth(41, BasicRack(tip_radius=0.1, pressure_angle=math.radians(30.0)))])
    with pytest.raises(GeometryError, match="leaves no backlash"):
        pair_of([one, one], 21.9)
    with pytest.raises(GeometryError, match="no flank contact"):
        pair_of([one, one], 24.2)


@pytest.mark.parametrize(
    "use",
    [
        lambda gear: gear.symmetric_tooth,
        lambda gear: gear.external_tooth,
        lambda gear: gear.half_base_tooth_angle,
        lambda gear: span(gear, 3),
        lambda gear: Family.of(gear),
        lambda gear: pair_stiffness(GearPair(gear, gear)),
    ],
)
def test_what_is_for_equal_flanks_says_so_of_others(use):
    with pytest.raises(InputError, match=r"coast_pressure_angle.*equal flanks only"):
        use(gear(made("20/30")))


# ---- balls ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("teeth", "shift"), [(28, 0.2), (35, 0.0)])
def test_balls_on_equal_flanks_are_the_usual_ones(teeth, shift):
    usual, found = gear(Tooth(teeth, BasicRack(), shift, 0.02)), gear(AsymmetricTooth(teeth, rack(20, 20), shift, 0.02))
    ball = touching_ball(usual)
    assert touching_ball(found) == pytest.approx(ball, rel=1e-10)
    for name, value in over_balls(usual, ball)._asdict().items():
        assert getattr(over_balls(found, ball), name) == pytest.approx(value, rel=1e-12), name


@pytest.mark.parametrize("name", ["20/30", "28/18", "35/20"])
def test_a_ball_touches_both_drawn_flanks_and_cuts_neither(name):
    one = gear(made(name))
    ball = ball_touching_at(one.tooth, one.tooth.pitch_radius + one.tooth.profile_shift)
    x, y = tooth_outline(one.tooth, 1e-8)
    pitch = 2.0 * math.pi / one.teeth
    right = np.stack([x[x > 0.0], y[x > 0.0]])
    left = np.stack([x[x < 0.0], y[x < 0.0]])
    c, s = math.cos(pitch), math.sin(pitch)
    left = np.stack([c * left[0] + s * left[1], c * left[1] - s * left[0]])  # of the next tooth clockwise

    def gaps(angle):
        centre = ball.centre * np.array([[math.sin(angle)], [math.cos(angle)]])
        return [float(np.hypot(*(side - centre)).min()) - 0.5 * ball.diameter for side in (right, left)]

    low, high = 0.0, pitch
    for _ in range(60):  # where it stands as near to one as to the other
        angle = 0.5 * (low + high)
        first, second = gaps(angle)
        low, high = (angle, high) if first < second else (low, angle)
    assert gaps(angle) == pytest.approx([0.0, 0.0], abs=2e-8)
    assert 0.5 * sum(ball.contact_radii) == pytest.approx(one.tooth.pitch_radius + one.tooth.profile_shift, rel=1e-9)
    assert not ball.trouble


@pytest.mark.parametrize(("diameter", "said"), [(0.5, "so small"), (9.0, "so large"), (4.0, "rests on the tips")])
def test_balls_of_no_use_are_refused_with_one_of_use(diameter, said):
    with pytest.raises(GeometryError, match=rf"{said}.*choose about"):
        over_balls(gear(made("28/18")), diameter)
