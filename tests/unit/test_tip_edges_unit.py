"""Contact lines that go on along tip edges: exact gaps, the plane's corner contact, no jump at small helix angles."""

import math

import numpy as np
import pytest

from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.meshing import Meshing
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.wide.compliance import flank_compliance
from fegear.contact.wide.error import flank_error
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.contact.wide.over_pitch import over_pitch
from fegear.contact.wide.rigid_flanks import touching_gaps
from fegear.contact.wide.tip_edges import edge_reach, usual_gap
from fegear.design.flanks import judge
from fegear.design.flanks.flank_tolerance import end_reliefs
from fegear.design.flanks.forms import GroundRelief
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import Bias
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE = 3e-3


def gear(beta, hand="right", teeth=20, width=9e-3, rounding=0.0):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta), tip_rounding=rounding)
    bore = 0.5 * tooth.root_radius * MODULE
    return Gear(tooth, MODULE, bore, width, STEEL, "strain", hand if beta else "spur")


def solid(one, settings=None, plane_strain=False):
    return solve_solid(
        one.tooth, one.twist * MODULE, one.face_width / MODULE, 0.3, one.bore_radius / MODULE,
        settings or SolidSettings().scaled(1.7), reach=1, plane_strain=plane_strain,
    )  # fmt: skip


def loaded(flanks, roll, load, most_gap):
    lines = contact_lines(flanks.pair, roll, flanks.panel * MODULE, (), most_gap)
    known = flank_compliance(flanks.pair, flanks.gears, lines, load)
    contact = solve_contact(known, FlankGaps().at(flanks.pair, lines), np.array([load]))
    return known, contact


@pytest.mark.parametrize(("beta", "teeth"), [(0.0, (20, 20)), (20.0, (23, 57))])
def test_gaps_are_those_of_the_helicoids(beta, teeth):
    """Least gap between both helicoids in space, the driven one fixed where the plane code takes the middle of both."""
    pair = GearPair(gear(beta, "right", teeth[0]), gear(beta, "left", teeth[1]))
    roll = pair.x_start + pair.base_pitch * (np.arange(8) + 0.5) / 8
    lines = contact_lines(pair, roll, 0.25 * MODULE, (), 30e-6)
    gap, least = lines.edges.gap, touching_gaps(pair, FlankGaps(), lines)
    near, far = (lines.present & (gap > 0.0) & on for on in (gap < 5e-6, gap >= 5e-6))
    assert far.any()
    np.testing.assert_allclose(least[near], gap[near], rtol=0.025, atol=1e-9)
    np.testing.assert_allclose(least[far], gap[far], rtol=0.06)
    on_path = lines.present & (gap == 0.0)
    assert np.abs(least[on_path]).max() < 1e-12
    assert gap[lines.present].max() <= 30e-6 * (1.0 + 1e-3)


def test_a_line_on_an_edge_stays_on_it_and_has_its_curvature():
    pair = GearPair(gear(20.0, "right", 23, rounding=0.1), gear(20.0, "left", 57, rounding=0.1))
    roll = pair.x_start + pair.base_pitch * (np.arange(8) + 0.5) / 8
    lines = contact_lines(pair, roll, 0.25 * MODULE, (), 30e-6)
    on = lines.present & (lines.edges.gap > 0.0) & (lines.x > 0.0)
    tip = lines.roll_length(pair, "driver")[on]
    np.testing.assert_allclose(tip, pair.flank_curvature_radius(pair.x_end, "driver"), rtol=1e-12)
    assert np.all(lines.roll_length(pair, "driven")[on] > pair.flank_curvature_radius(pair.x_end, "driven"))
    # a rounded edge is sharper than any flank, and never called sharp
    assert lines.edges.relative_radius[on].max() < 0.1 * MODULE
    assert not lines.at_edge[on].any()
    sharp = GearPair(gear(20.0, "right", 23), gear(20.0, "left", 57))
    lines = contact_lines(sharp, roll, 0.25 * MODULE, (), 30e-6)
    on = lines.present & (lines.edges.gap > 0.0)
    assert lines.at_edge[on].all()
    assert edge_reach(sharp, 0.0) == (0.0, 0.0)


@pytest.mark.dear("0.0")
@pytest.mark.parametrize("rounding", [0.0, pytest.param(0.1, marks=pytest.mark.long)])
def test_a_spur_pair_meets_its_tips_as_in_the_plane(rounding):
    one = gear(0.0, rounding=rounding)
    plane = finite_element_compliance(solve_gear(one, reach=1))
    flank = solid(one, SolidSettings().scaled(1.5), plane_strain=True)
    pair = GearPair(one, one)
    engagement = Engagement(PairCompliance(pair, plane, plane), corner_contact=True)
    load = 300e3 * one.face_width
    roll = pair.x_end - pair.base_pitch + np.array([-0.3e-3, -0.02e-3, 0.02e-3, 0.2e-3, 0.5e-3])
    known, contact = loaded(FlankPair(pair, {"driver": flank, "driven": flank}, panel=1.5), roll, load, 60e-6)
    wanted = engagement.solve(engagement.grid(roll), [load])
    np.testing.assert_allclose(contact.approach, wanted.transmission_error, rtol=8e-3)
    ahead = (contact.force[:, :, 0] * ((known.lines.pair == 1) & known.lines.present)).sum(axis=1) / load
    number = wanted.grid.contacts.number.tolist().index(1)
    np.testing.assert_allclose(ahead, wanted.shared.loads[number, :, 0] / load, atol=6e-3)
    # the pair leaves along its tip edge, slowly
    assert ahead[-1] > 0.03
    assert np.all(np.diff(ahead) < 0.0)


def largest(beta, most_gap):
    """Largest pressure off the edges as the line ahead crosses the tip of the driver from one face end to the other."""
    hands = [gear(beta, hand, width=15e-3) for hand in ("right", "left")]
    pair = GearPair(*hands)
    solids = [solid(one, SolidSettings().scaled(2.2)) for one in (hands if beta else hands[:1])]
    flanks = FlankPair(pair, {"driver": solids[0], "driven": solids[-1]}, panel=0.5)
    slope = abs(pair.driver.twist * pair.driver.base_radius) * 0.5 * pair.face_width
    roll = pair.x_end - pair.base_pitch - 1e-9 + slope * np.array([-1.5, -0.5, 0.0, 0.5])
    known, contact = loaded(flanks, roll, 300e3 * pair.face_width, most_gap)
    support = np.where(known.lines.support > 0.0, known.lines.support, 1.0)
    pressure = known.pressure(contact.force / support[:, :, None])[:, :, 0]
    return float(np.where(known.lines.present & ~known.lines.at_edge, pressure, 0.0).max())


@pytest.mark.dear
def test_the_largest_pressure_does_not_jump_at_a_small_helix_angle():
    spur, edged, ending = largest(0.0, 60e-6), largest(0.1, 60e-6), largest(0.1, 0.0)
    assert edged == pytest.approx(spur, rel=0.02)
    assert ending > 1.15 * spur  # what lines that end at tips make of it


def test_lines_without_tip_edges_are_what_they_were():
    pair = GearPair(gear(20.0, "right", 23), gear(20.0, "left", 57))
    lines = contact_lines(pair, np.array([0.0]), 1e-3)
    assert lines.edges is None
    np.testing.assert_array_equal(lines.roll_length(pair, "driven"), pair.flank_curvature_radius(lines.x, "driven"))
    assert usual_gap(pair, 1000.0) == pytest.approx(2.0 * usual_gap(pair, 500.0))


@pytest.mark.long
@pytest.mark.parametrize("beta", [0.0, 10.0, 20.0, 30.0])
@pytest.mark.parametrize("most_gap", [0.0, 50e-6])
def test_errors_are_honest_against_finer_everything(beta, most_gap):
    """Finer meshes with more functions, a fourth of the panel's length, twice the roll positions."""
    hands = [gear(beta, hand, width=15e-3) for hand in ("right", "left")]
    pair = GearPair(*hands)
    base = SolidSettings().scaled(1.7)
    solids = [
        [solid(one, settings) for one in hands]
        for settings in (base, base.coarser(15e-3 / pair.driver.module), SolidSettings().scaled(0.9))
    ]
    usual, coarse, fine = (dict(zip(("driver", "driven"), two, strict=True)) for two in solids)
    flanks = FlankPair(pair, usual, panel=0.25, positions=16, most_gap=most_gap)
    finer = FlankPair(pair, fine, panel=0.0625, positions=32, most_gap=most_gap)
    load = 250e3 * pair.face_width
    z = np.linspace(-0.5, 0.5, 33) * pair.face_width
    crowned = FlankGaps(face_position=z, line_gap=8e-6 * (2.0 * z / pair.face_width) ** 2)
    misaligned = FlankGaps(face_position=z, line_gap=10e-6 * (z / pair.face_width + 0.5))
    known, better = flanks.compliance(load), finer.compliance(load)
    for gaps in (FlankGaps(), crowned, misaligned):
        found, wanted = flanks.solve([load], gaps, known), finer.solve([load], gaps, better)
        over = over_pitch(flanks, found, gaps, load)
        error = flank_error(flanks, found, coarse, gaps, over, load)
        for key, stated in (
            ("mean_transmission_error", error.mean), ("face_load_factor", error.face_load_factor),
            ("largest_line_load", error.largest_line_load), ("largest_pressure", error.largest_pressure),
        ):  # fmt: skip
            off = abs(float(getattr(over.found, key)[0] - getattr(wanted, key)[0]))
            assert off < 1.2 * float(stated[0]), (key, off, stated)
        off = abs(float(over.stated.peak_to_peak[0] - np.ptp(wanted.transmission_error)))
        assert off < 1.2 * float(error.peak_to_peak[0])
        # and they are no blanket
        assert error.mean[0] < 0.03 * found.mean_transmission_error[0]
        assert error.face_load_factor[0] < 0.08 * found.face_load_factor[0]


@pytest.mark.parametrize("unit", [1.0, 1.3, 1.7, 0.1])
def test_zero_is_the_gap_of_flanks_on_the_path_alone(unit):
    """Past its end a gap was zero or not by the last bit, and Mark's stiffness counted another pair or did not."""
    planet, wheel = (gear(0.0, teeth=teeth) for teeth in (23, 60))
    pair = GearPair(*(Gear(one.tooth, unit * MODULE, unit * one.bore_radius, unit * one.face_width, STEEL, "strain")
                      for one in (planet, wheel)))  # fmt: skip
    past = pair.base_pitch * np.logspace(-9, -2, 200)
    gap = Meshing(pair, corner_contact=True).touching(np.concatenate([pair.x_end + past, pair.x_start - past])).gap
    assert np.all(gap > 0.0)


@pytest.mark.parametrize("wider", ["driver", "driven"])
def test_designed_reliefs_are_those_of_the_gears_along_tip_edges(wider):
    """There a flank touches its mate's edge, not the place that its station has on the line of action.

    The gear that has the twist of the flank is the one with the common face.
    """
    widths = (12e-3, 9e-3) if wider == "driver" else (9e-3, 12e-3)
    pair = GearPair(gear(20.0, "right", 23, widths[0]), gear(20.0, "left", 57, widths[1]))
    roll = pair.x_start + pair.base_pitch * (np.arange(8) + 0.5) / 8
    lines = contact_lines(pair, roll, 0.25 * MODULE, (), 30e-6)
    relief = GroundRelief(20e-6, 4e-3, 15e-6, 5e-3, bias=12e-6)
    bearer = "driven" if wider == "driver" else "driver"
    first, last = sorted(float(pair.roll_angle(x, bearer)) for x in (pair.x_start, pair.x_end))
    twist = Bias(12e-6 if bearer == "driver" else -12e-6, first, last, pair.face_width)
    tips = end_reliefs(relief.numbers, pair, 1.0)
    gaps = FlankGaps(*tips, **{f"{bearer}_flank": (twist,)})
    wanted = gaps.at(pair, lines) - lines.edges.gap + 0.25 * relief.bias
    on_edge = lines.present & (lines.edges.gap > 0.0)
    assert on_edge.any()
    found = relief.removal_on(pair, lines)
    np.testing.assert_allclose(found[lines.present], wanted[lines.present], atol=1e-12)
    plain = relief.removal(pair, lines.x, lines.z)
    assert np.abs(plain - wanted)[on_edge].max() > 1e-7
    on_path = lines.present & ~on_edge
    np.testing.assert_allclose(plain[on_path], wanted[on_path], atol=1e-12)


@pytest.mark.dear
def test_designs_are_judged_with_contact_along_tip_edges(monkeypatch):
    """As the pair that has the relief is loaded; without tip edges no relief leaves more than there is."""
    for name, count in (("SEARCHED", 9), ("JUDGED", 12)):
        monkeypatch.setattr(judge, name, count)
    gears = gear(15.0), gear(15.0, "left", 31)
    pair = GearPair(*gears)
    load = 250e3 * pair.face_width
    solids = {member: solid(one) for member, one in zip(("driver", "driven"), gears, strict=True)}
    flanks = FlankPair(pair, solids, positions=12, most_gap=usual_gap(pair, load))
    relief = GroundRelief(10e-6, 4e-3, 12e-6, 5e-3)
    judged = judge.flank_judge(flanks, solids, FlankGaps(), load, 0.0)
    left = {}
    for label, numbers, gaps in (
        ("none", GroundRelief(), FlankGaps()), ("tips", relief, FlankGaps(*end_reliefs(relief.numbers, pair, 1.0))),
    ):  # fmt: skip
        te, _ = judged.left(lambda lines, own=numbers: own.removal_on(pair, lines))
        loaded = flanks.solve([load], gaps)
        np.testing.assert_allclose(judged.dense.known.lines.roll, loaded.lines.roll, rtol=1e-12)
        np.testing.assert_allclose(te, loaded.transmission_error, rtol=1e-9)
        left[label] = np.ptp(te)
    bare = judge.flank_judge(FlankPair(pair, solids, positions=12), solids, FlankGaps(), load, 0.0)
    without = np.ptp(bare.left(lambda lines: np.zeros(lines.x.shape))[0])
    assert left["tips"] < 0.8 * left["none"] < 0.8 * 0.98 * without
