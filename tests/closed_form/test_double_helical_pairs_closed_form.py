"""Double helical pairs of coupled slices: each half is today's helical pair, and the laws of both together."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import block_diag
from scipy.optimize import nnls

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.contact.double_helical.double_spec import DoubleHelicalSpec, mirrored, twist_between
from fegear.contact.double_helical.load_double import load_double
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.wide.lines import base_twist
from fegear.contact.wide.load_sharing import tangent_compliance
from fegear.contact.wide.maker import load_flanks
from fegear.contact.wide_spec import Misalignment, WideSpec
from fegear.fem.solid.influence import SolidInfluence
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import plane_section, solve_thin_slices
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import HelixSlope
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief_spec import BiasSpec
from fegear.geometry.shaft_tilt import ShaftTilt

MODULE, WIDTH, LOAD = 3e-3, 12e-3, 6000.0
SETTINGS = replace(SolidSettings().scaled(2.5), source="slices")
CACHE = SolutionCache()


def gear(teeth, hand, width=WIDTH):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(20.0))
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, width, hand=hand)


@cache
def section(teeth):
    """The plane section, which hands and widths share."""
    one = gear(teeth, "right")
    return plane_section(one.tooth, 0.3, one.bore_radius / MODULE, SETTINGS, 1)


def sliced(one):
    fine = solve_thin_slices(
        one.tooth, one.twist * MODULE, one.face_width / MODULE, 0.3, one.bore_radius / MODULE, SETTINGS,
        plane=section(one.teeth),
    )  # fmt: skip
    return SolidInfluence(fine, None, {})


def half(first="right", width=WIDTH, **errors):
    second = "left" if first == "right" else "right"
    pair = GearPair(gear(20, first, width), gear(31, second, width))
    wide = WideSpec(Misalignment(**errors), positions=6, panels=4)
    return PairSpec(pair, width="slices", wide=wide, misalignment=bool(errors))


def solved(*halves):
    return [[sliced(one) for one in (own.pair.driver, own.pair.driven)] for own in halves]


RIGHT = half()
LEFT = mirrored(RIGHT)


@pytest.fixture(scope="module")
def gears():
    return solved(RIGHT, LEFT)


def double(gears, halves=(RIGHT, LEFT), loads=(2000.0, LOAD), estimates=False, **given):
    return load_double(DoubleHelicalSpec(halves, loads, **given), gears, cache=CACHE, estimates=estimates)


@pytest.fixture(scope="module")
def floating(gears):
    return double(gears, floating="driver")


def alone(gears, number, spec, load_at):
    """The helical pair that a half is, made without the other one."""
    bodies = {member: one.fine for member, one in zip(MEMBERS, gears[number], strict=True)}
    _, _, found = load_flanks(spec.of_half(number), bodies, CACHE)
    return found, found.load.tolist().index(load_at)


def test_each_half_that_carries_all_is_the_helical_pair_to_the_last_bit(gears):
    for number, apex in ((0, 1e-3), (1, -1e-3)):
        both = double(gears, apex_offset=apex)
        found, i = alone(gears, number, both.spec, LOAD)
        carries, idle = both.halves[number], both.halves[1 - number]
        assert (both.share[number] == 1.0).all()
        assert (carries.contact.force[:, :, 1] == found.contact.force[:, :, i]).all()
        assert (carries.transmission_error[:, 1] == found.transmission_error[:, i]).all()
        assert (carries.face_load_factor[1] == found.face_load_factor[i]).all()
        assert not idle.contact.force.any()
        assert np.isnan(both.face_load_factors[1 - number]).all()
        assert both.load_factor == pytest.approx([2.0, 2.0])
        assert both.touches_back.all()  # a millimetre is more than the backlash of these gears
        moved = both.spec.seat.twist[number] * apex
        np.testing.assert_allclose(both.transmission_error, carries.transmission_error - moved, rtol=1e-12)


def test_each_half_of_a_floating_pair_is_the_helical_pair_under_half_of_the_load(gears, floating):
    for number in range(2):
        found, i = alone(gears, number, floating.spec, 0.5 * LOAD)
        assert (floating.halves[number].contact.force[:, :, 1] == found.contact.force[:, :, i]).all()
    assert (floating.share == 0.5).all()
    assert floating.load_factor == pytest.approx([1.0, 1.0], rel=1e-14)
    assert floating.axial_force == pytest.approx(0.0, abs=1e-9)


def test_equal_halves_need_no_float(gears, floating):
    located = double(gears)
    np.testing.assert_allclose(located.share, 0.5, atol=1e-9)
    np.testing.assert_allclose(located.transmission_error, floating.transmission_error, rtol=1e-9)
    assert np.abs(floating.axial_motion).max() < 1e-14
    assert floating.face_load_factors[0] == pytest.approx(floating.face_load_factors[1], rel=1e-6)


def test_a_gap_changes_nothing_of_straight_shafts(gears, floating):
    apart = double(gears, floating="driver", gap=20e-3)
    assert (apart.transmission_error == floating.transmission_error).all()


def test_apex_error_moves_load_and_a_floating_member_takes_it(gears, floating):
    """Both halves in contact: W_1 - W_2 by the tangent stiffness of both, within what the contact's widths change."""
    apex = 2e-6
    located, moved = double(gears, apex_offset=apex), double(gears, floating="driven", apex_offset=apex)
    span = 2.0 * abs(base_twist(RIGHT.pair))
    k = located.halves[0].contact.stiffness[:, 1]
    by_hand = 0.5 + 0.5 * k * span * apex / LOAD  # k_1 k_2 / (k_1 + k_2) of equal halves
    assert located.share[0, :, 1] == pytest.approx(by_hand, rel=2e-3)
    np.testing.assert_allclose(moved.transmission_error, floating.transmission_error, rtol=1e-9)
    np.testing.assert_allclose(moved.axial_motion, apex, rtol=1e-6)  # the driven follows the driver's apex
    # The driver turns clockwise seen from end II; the right-hand rule has its right-hand half thrust towards end I.
    assert RIGHT.pair.driver.hand == "right"
    assert located.share[0, 0, 1] > 0.5
    assert located.axial_force[0, 1] < 0.0
    assert "(K_gamma = 1." in located.answer()


def test_one_half_is_carried_free_at_its_closed_form(gears):
    """The share reaches 1 where (t_1 - t_2) q is what the half at end I gives under all of the load."""
    all_of_it = double(gears, apex_offset=1e-3)
    first = all_of_it.halves[0].transmission_error[:, 1]
    touch = 0.0  # unmodified flanks touch at no approach on the path
    ends = (first - touch) / (2.0 * base_twist(RIGHT.pair))
    below, above = (double(gears, loads=(LOAD,), apex_offset=part * one)
                    for part, one in ((0.999, ends.min()), (1.001, ends.max())))  # fmt: skip
    assert (below.share[0] < 1.0).all()
    assert (above.share[0] == 1.0).all()
    assert not above.touches_back.any() or RIGHT.pair.free_backlash == 0.0


def _all_at_once(found, p, gaps, load, extra):
    """Forces on the stations of both halves at one position, by non-negative least squares; no share is asked for.

    They make the elastic energy and the work against the gaps least; their sum is the load, and `extra` has none.
    """
    matrices, touching = [], []
    for number, half in enumerate(found.halves):
        known, on = half.known, half.lines.present[p]
        matrix = tangent_compliance(known, np.array([p]), half.contact.force[[p], :, 0])[0]
        matrices.append(matrix[np.ix_(on, on)])
        touching.append(np.full(int(on.sum()), gaps[number]))
    root = np.linalg.cholesky(block_diag(*matrices)).T
    gap, sizes = np.concatenate(touching), [one.size for one in touching]
    rows = [np.ones(gap.size)] + ([] if extra is None else [np.repeat(extra, sizes)])
    weight = 1e3 * np.abs(root).max()
    system = np.vstack([root, *(weight * row for row in rows)])
    right = np.concatenate([-np.linalg.solve(root.T, gap), [weight * load], [0.0] * (len(rows) - 1)])
    force, _ = nnls(system, right)
    return force[: sizes[0]], force[sizes[0] :]


@pytest.mark.parametrize("floating", [None, "driver"])
def test_all_stations_of_both_halves_solved_at_once_carry_the_same(gears, floating):
    """Contacts of one width: a linear problem whose least energy is found without halves, shares or positions."""
    halves = tuple(replace(one, hertz="none", corner_contact=False) for one in (RIGHT, LEFT))
    apex = 0.0 if floating else 4e-6
    found = double(gears, halves, loads=(LOAD,), floating=floating, apex_offset=apex)
    twist = np.array(found.spec.seat.twist)
    for p in (0, 3):
        gaps = -twist * apex  # the half that the apex error closes has the smaller gap
        forces = _all_at_once(found, p, gaps, LOAD, twist if floating else None)
        for half, force in zip(found.halves, forces, strict=True):
            own = half.contact.force[p, half.lines.present[p], 0]
            np.testing.assert_allclose(own, force, atol=2e-6 * LOAD)
    assert (found.share[0, 0, 0] == 0.5) == (floating is not None)


def test_exchanged_halves_exchange_their_shares(gears):
    there = double(gears, apex_offset=1.5e-6)
    back = double(gears[::-1], (LEFT, RIGHT), apex_offset=1.5e-6)
    np.testing.assert_allclose(back.share[::-1], there.share, rtol=1e-9)
    np.testing.assert_allclose(back.transmission_error, there.transmission_error, rtol=1e-9)


def test_a_tilt_of_the_axes_counts_with_the_gap_and_a_float_takes_its_even_part(gears):
    """Half the sum of both faces and the gap is the arm: kappa (g + b) of the halves' gaps differ."""
    tilt = ShaftTilt(out_of_plane=1e-4)
    halves = half(tilt=tilt), half("left", tilt=tilt)
    arm = 30e-3 + WIDTH
    kappa = tilt.in_plane_of_action(RIGHT.pair)
    located = double(gears, halves, gap=30e-3)
    apex = -kappa * arm / (2.0 * base_twist(RIGHT.pair))
    against = double(gears, halves, gap=30e-3, apex_offset=apex)
    even = double(gears, halves, gap=30e-3, floating="driver")
    assert located.load_factor[1] > 1.05
    assert against.load_factor[1] == pytest.approx(1.0, abs=2e-3)
    assert (even.share == 0.5).all()
    assert (even.face_load_factors > 1.02).all()
    mean = even.mean(even.axial_motion)[1]
    assert mean == pytest.approx(apex, rel=0.01)


def test_a_tilt_over_a_long_gap_is_an_apex_error_until_one_half_carries_all(gears):
    """Over metres a tilt that is nothing within a half opens one of them."""
    for tilt, alone_ in ((1e-6, False), (2e-5, True)):
        axes = ShaftTilt(out_of_plane=tilt)
        tilted = double(gears, (half(tilt=axes), half("left", tilt=axes)), loads=(LOAD,), gap=3.0)
        apex = axes.in_plane_of_action(RIGHT.pair) * (3.0 + WIDTH) / (2.0 * base_twist(RIGHT.pair))
        shifted = double(gears, loads=(LOAD,), apex_offset=apex)
        np.testing.assert_allclose(tilted.share, shifted.share, atol=2e-3)
        np.testing.assert_allclose(tilted.balance.separation, shifted.balance.separation, atol=3e-7)
        assert (tilted.share[0] == 1.0).all() == alone_


@pytest.mark.parametrize("part", [1.0 / 3.0, 0.5])
def test_staggered_teeth_have_the_halves_curve_moved_by_it(gears, floating, part):
    """Floating: zeta is the mean of both halves' curves, here of one curve and of itself a part of a pitch on."""
    staggered = double(gears, floating="driver", stagger=part)
    pitch = RIGHT.pair.base_pitch
    found, i = alone(gears, 0, staggered.spec, 0.5 * LOAD)
    ahead = np.interp(staggered.points.x + part * pitch, found.lines.roll, found.transmission_error[:, i], period=pitch)
    own = staggered.halves[0].transmission_error[:, 1]
    assert staggered.peak_to_peak[1] < floating.peak_to_peak[1]
    np.testing.assert_allclose(staggered.transmission_error[:, 1], 0.5 * (own + ahead), rtol=1e-12)
    # The driver moves so far that the approaches differ by twice the half of their difference.
    apart = (own - ahead) / (2.0 * base_twist(RIGHT.pair))
    np.testing.assert_allclose(staggered.axial_motion[:, 1], apart, rtol=1e-9, atol=1e-15)
    assert staggered.halves[1].lines.weight.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(("member", "sign"), [("driver", -1.0), ("driven", 1.0)])
def test_the_halves_hold_what_pushes_the_floating_member(gears, member, sign):
    """The mesh pushes the driver with `axial_force` and the driven with the opposite, against the coupling's force."""
    found = double(gears, floating=member, axial_force=150.0)
    np.testing.assert_allclose(found.axial_force, sign * 150.0, rtol=1e-9)
    assert (found.load_factor > 1.0).all()


def test_halves_of_unequal_width_carry_by_their_width():
    wide = half("left", 1.5 * WIDTH)
    both = double(solved(RIGHT, wide), (RIGHT, wide), loads=(LOAD,))
    assert both.mean(both.share[1])[0] == pytest.approx(0.6, abs=0.02)
    # Where the faces meet, contact lines of both halves do.
    ends = [one.lines.roll - base_twist(one.pair) * side * 0.5 * one.pair.face_width
            for one, side in zip(both.halves, (1.0, -1.0), strict=True)]  # fmt: skip
    apart = (ends[0][:, None] - ends[1]) / RIGHT.pair.base_pitch
    assert np.abs(apart - apart.round()).min(axis=1) == pytest.approx(0.0, abs=1e-9)
    even = double(solved(RIGHT, wide), (RIGHT, wide), loads=(LOAD,), floating="driver")
    assert (even.share == 0.5).all()
    assert even.load_factor[0] == pytest.approx(1.25)
    assert even.halves[1].mean_over_face.mean() * 1.5 * WIDTH == pytest.approx(0.5 * LOAD, rel=0.02)


def test_errors_cover_more_panels_and_vanish_with_what_is_even(gears):
    """Shares of balanced halves have none; those of an apex error move with panels, within what is stated."""
    even = double(gears, floating="driver", estimates=True).error
    assert (even.share == 0.0).all()
    assert even.load_factor == pytest.approx(0.0, abs=1e-14)
    assert (even.mean > 0.0).all()
    found = double(gears, apex_offset=2e-6, estimates=True)
    halves = [replace(one, wide=replace(one.wide, panels=12)) for one in (RIGHT, LEFT)]
    finer = double(gears, halves, apex_offset=2e-6)
    for key in ("load_factor", "mean_transmission_error", "share_of_first"):
        own = {"mean_transmission_error": "mean", "share_of_first": "share"}.get(key, key)
        off = np.abs(getattr(finer, key) - getattr(found, key))
        assert (off <= getattr(found.error, own)).all(), key


def test_shafts_that_twist_between_the_halves_unload_the_half_away_from_the_coupling(gears):
    """A tube's twist by hand; where both halves touch the shares are those of springs in series; a float feels none."""
    gap, pair = 40e-3, RIGHT.pair
    lag = twist_between(pair, gap, "I", "II")
    shear = pair.driver.material.young_modulus / 2.6
    tube = math.pi / 2.0 * (pair.driver.root_radius**4 - pair.driver.bore_radius**4)
    assert lag[1] == pytest.approx(pair.driver.base_radius**2 * gap / (shear * tube))
    assert lag[0] < lag[1]  # the larger gear twists less
    both_at_one = twist_between(pair, gap, "I", "I")
    assert both_at_one == (0.0, pytest.approx(sum(lag)))
    found = double(gears, gap=gap, twist_compliance=both_at_one)
    k = found.halves[0].contact.stiffness[:, 1]
    softer = both_at_one[1] * k  # of a half, with the tube in series: s / (1 - s) = 1 + softer
    assert found.share[0, :, 1] == pytest.approx((1.0 + softer) / (2.0 + softer), rel=5e-3)
    assert (found.share[0] > 0.51).all()
    even = double(gears, gap=gap, twist_compliance=both_at_one, floating="driver")
    assert (even.share == 0.5).all()
    none = double(gears, floating="driver").transmission_error
    np.testing.assert_allclose(
        even.transmission_error - none, 0.25 * both_at_one[1] * even.load[None] * np.ones((6, 1))
    )


def test_coarser_gears_add_to_the_errors(gears):
    stiffer = [[replace(one, coarse=replace(one.fine, compliance={k: 0.9 * c for k, c in one.fine.compliance.items()}))
                for one in own] for own in gears]  # fmt: skip
    plain, more = (double(one, floating="driver", estimates=True).error for one in (gears, stiffer))
    found = double(gears, floating="driver")
    assert (more.mean - plain.mean > 0.05 * found.mean_transmission_error).all()
    assert (more.mean - plain.mean < 0.11 * found.mean_transmission_error).all()


def test_the_answer_says_who_carries_and_what_is_at_its_stop(gears, floating):
    assert floating.answer() == (
        f"Double helical pair: the half at end I carries 50 % of {LOAD:.0f} N (K_gamma = 1.000); the driver moves 0 µm "
        f"along its axis over the base pitch; transmission error {floating.peak_to_peak[1] * 1e6:.3g} µm peak-to-peak."
    )
    stopped = double(gears, floating="driven", apex_offset=8e-6, axial_play=12e-6)
    assert not stopped.balance.free.any()
    assert stopped.axial_motion == pytest.approx(6e-6)  # after the driver's apex, as far as it can
    assert ", touching a stop of its play;" in stopped.answer()
    apart = double(gears, apex_offset=-1e-3).answer()
    assert "the half at end II carries 100 % of 6000 N (K_gamma = 2.000); both members located" in apart
    assert "the half at end I carries no load at some mesh positions; its non-working flanks are in contact" in apart


def test_the_other_half_has_mirrored_flanks_and_the_same_axes():
    z = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, 5)
    flank = FlankSpec(face=(HelixSlope(5e-6, WIDTH),), bias=BiasSpec(4e-6))
    tilted = replace(half(tilt=ShaftTilt(1e-5)), driver=flank)
    other = mirrored(tilted)
    assert other.face.errors.tilt == tilted.face.errors.tilt  # a deviation of both halves' axes
    (slope,) = other.driver.face
    np.testing.assert_array_equal(slope.removal(0.5, z), flank.face[0].removal(0.5, -z))
    assert other.driver.bias.amount == -4e-6
    assert mirrored(other) == tilted
    assert mirrored(LEFT) == RIGHT
    with pytest.raises(InputError, match="must not have a gap over the face to be mirrored; specify the deviations"):
        mirrored(half(face_position=z, line_gap=np.abs(z) * 1e-3))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"gap": -1e-3}, "gap = -0.001: must be finite and not negative"),
        ({"axial_play": 1e-4}, 'axial_play = 0.0001: requires a floating member; set floating = "driver" or "driven"'),
        ({"floating": "driver", "axial_play": -1.0}, "axial_play = -1.0: must not be negative"),
        ({"twist_compliance": (0.0, -1e-9)}, "twist_compliance = 0 and -1e-09: must be finite and not negative"),
        ({"stagger": 1.0}, "stagger = 1: must be at least 0 and below 1"),
        ({"loads": ()}, r"loads = \(not given\): must be positive and finite"),
        ({"halves": (RIGHT, RIGHT)}, "hand = right in both halves: must be opposite"),
        ({"halves": (RIGHT, replace(RIGHT, width="plane"))}, 'halves = width "plane"'),
    ],
)
def test_what_is_no_double_helical_pair_is_refused(given, message):
    with pytest.raises(InputError, match=message):
        DoubleHelicalSpec(**{"halves": (RIGHT, LEFT), "loads": (1.0,), **given})
