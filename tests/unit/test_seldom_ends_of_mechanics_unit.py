"""Ends of the mechanics at which no other cheap test comes out, each by a law or numbers of its own."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError, GeometryError
from fegear.design.fillet.fillet_bench import Judged
from fegear.design.fillet.fillet_search import _programme
from fegear.design.flanks import lead_correction, quick
from fegear.design.sizing import front
from fegear.dynamics.motion.averaging import averaged_motion
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.tooth_strain import ToothStrain
from fegear.dynamics.train.train import Body, Mesh, Torque, Train
from fegear.fem.plane.odd.other_outline import OtherTip
from fegear.fem.plane.odd.other_sector import shorter_sector
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.supported_section import assemble_section, of_web, supported_sector
from fegear.geometry.curves import Arc, Stretched
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_shapes import PointsFillet
from fegear.geometry.gear import Gear
from fegear.geometry.internal_interference import _shortest_cut
from fegear.geometry.pair import GearPair
from fegear.geometry.rim_support import RimSupport
from fegear.geometry.shift_of_thickness import ToothNumbers
from fegear.geometry.shift_sum import MeshNumbers


# ---- geometry --------------------------------------------------------------------------------------------------------
def test_what_cannot_be_made_has_no_room():
    def room(radius):
        if radius < 20.0:
            raise GeometryError("tip", radius, "cannot be")
        return 21.4 - radius

    assert _shortest_cut(room, 22.0, 0.0) is None  # tried are 21.56 and, from 19.8 on, gears that cannot be


@pytest.mark.parametrize("helix", [0.0, 0.4])
def test_the_backlash_normal_to_the_flanks_is_that_of_the_pair(helix):
    a, b = (Tooth(z, profile_shift=x, thickness_allowance=0.03, helix_angle=helix) for z, x in ((19, 0.3), (44, 0.1)))
    hands = ("left", "right") if helix else ("spur", "spur")
    pair = GearPair(*(Gear(tooth, 1e-3, 0.004, 0.02, hand=hand) for tooth, hand in zip((a, b), hands, strict=True)))
    numbers = MeshNumbers(*(ToothNumbers(tooth.teeth, math.radians(20.0), helix) for tooth in (a, b)))
    found = numbers.normal_backlash(pair.centre_distance / 1e-3, pair.circumferential_backlash / 1e-3)
    assert found > 0.01
    assert found == pytest.approx(pair.normal_backlash / 1e-3, rel=1e-9)


SHIFTED = Tooth(28, profile_shift=0.2, thickness_allowance=0.02)


def fillet_points(off, count=61):
    """The generated fillet, of which the first points lie farther from the tooth, the more the nearer to the root."""
    u = np.linspace(0.0, 1.0, count)
    x, y = SHIFTED.fillet.points(SHIFTED.fillet.start + u * (SHIFTED.fillet.end - SHIFTED.fillet.start))
    angle, radius = np.arctan2(x, y) + off * (1.0 - u) ** 4, np.hypot(x, y)
    return tuple(zip((radius * np.sin(angle)).tolist(), (radius * np.cos(angle)).tolist(), strict=True))


def test_a_fillet_beyond_the_middle_of_the_space_says_by_how_much():
    half = math.pi / SHIFTED.teeth
    first = math.atan2(*fillet_points(0.0)[0])
    for by in (0.02, 0.1):  # modules along the root circle
        off = half - first + by / SHIFTED.root_radius
        with pytest.raises(GeometryError, match=f"is {by:g} modules beyond the middle of the tooth space"):
            with_fillet(SHIFTED, PointsFillet(fillet_points(off)))


def test_the_rounding_of_a_helical_rack_moves_as_it_is():
    edge = Stretched(Arc((0.6, 0.8), 0.2, 1.2, 0.0), 1.0 / math.cos(0.5))
    at = np.linspace(0.0, 1.2, 5)
    np.testing.assert_allclose(edge.moved(-0.07).points(at), edge.points(at) - [[0.07], [0.0]], atol=1e-15)


# ---- design ----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("values", [2, 3, 40])
def test_fronts_found_in_parts_of_any_size_are_those_of_comparing_all(monkeypatch, values):
    """In parts of two with comparisons by ones: ties of all columns, of the last, and of none."""
    monkeypatch.setattr(front, "_FEW", 2)
    monkeypatch.setattr(front, "_AT_ONCE", 1)
    rng = np.random.default_rng(values)
    for columns in range(1, 6):
        for _ in range(12):
            costs = rng.integers(0, values, (25, columns)).astype(float)
            expected = [i for i, one in enumerate(costs)
                        if not ((costs <= one).all(axis=1) & (costs < one).any(axis=1)).any()]  # fmt: skip
            assert front.pareto_front(costs).tolist() == expected


def test_numbers_far_outside_their_limits_stay_where_they_are():
    """No step within the trust leads back: none is made, and none is promised to gain."""
    at = Judged(np.array([2e8, 1.5e8]), np.array([0.1]))
    family = SimpleNamespace(spread=np.array([1.0, 1.0]), lower=np.array([0.0, 0.0]), upper=np.array([1.0, 1.0]))
    slopes = np.array([[1e7, 0.0], [0.0, 1e7]]), np.zeros((1, 2))
    step, gain = _programme(at, slopes, 2e8, np.array([3.0, 0.5]), family, 0.5)
    assert (step.tolist(), gain) == ([0.0, 0.0], 0.0)
    step, gain = _programme(at, slopes, 2e8, np.array([0.9, 0.5]), family, 0.5)
    assert step[0] == pytest.approx(-0.5)  # the larger stress falls by 1e7 times half a spread
    assert gain == pytest.approx(0.5 * 1e7 / 2e8, rel=0.1)


def test_tilt_and_sag_of_a_gap_are_taken_away():
    height = np.linspace(-0.012, 0.012, 9)
    mesh = SimpleNamespace(flanks=SimpleNamespace(pair=SimpleNamespace(driver=SimpleNamespace(face_width=0.024))))

    def shafts(gap, *, given=True):
        return SimpleNamespace(under=lambda load: SimpleNamespace(
            given=given, height=height, gap=np.stack([np.ones(9), load * gap])[:, None, :].swapaxes(1, 1)
        ))  # fmt: skip

    gap = 3e-6 + 0.002 * height + 0.05 * height**2
    found = lead_correction._tilt_and_sag(mesh, shafts(gap), 2.0)
    assert found == pytest.approx((-2.0 * 0.002 * 0.024, -2.0 * 0.05 * 0.012**2), rel=1e-9)
    assert lead_correction._tilt_and_sag(mesh, shafts(gap, given=False), 2.0) == (0.0, 0.0)


@pytest.mark.parametrize("many", [12, 0, -1])
def test_few_stations_carry_the_load_with_no_pull_and_no_overlap(monkeypatch, many):
    """Signorini's laws; the changes one by one come to the same, and the approach grows as its differences say."""
    monkeypatch.setattr(quick, "_MANY_AT_ONCE", many)
    rng = np.random.default_rng(5)
    root = rng.normal(size=(3, 11, 11))
    matrix = (np.einsum("pij,pkj->pik", root, root) + 4.0 * np.eye(11)) * 1e-9
    present = np.ones((3, 11), dtype=bool)
    present[1, 7:] = False
    known = quick.QuickFlanks(None, None, present, matrix, np.zeros((3, 11)), None)
    gap, load = np.abs(rng.normal(scale=3e-6, size=(4, 3, 11))), 300.0
    z, force, growth = known.contact(gap, load)
    left = np.einsum("pij,cpj->cpi", matrix, force) + gap - z[:, :, None]
    assert force.sum(axis=2) == pytest.approx(load)
    assert (force >= 0.0).all()
    assert not force[:, ~present].any()
    on = force > 0.0
    assert 0.2 < on.mean() < 0.7
    np.testing.assert_allclose(left[on], 0.0, atol=1e-15)
    assert (left[:, present][~on[:, present]] > -1e-15).all()
    for place in range(11):
        more = gap.copy()
        more[:, :, place] += 1e-12
        np.testing.assert_allclose(
            (known.contact(more, load)[0] - z) / 1e-12, growth[:, :, place] * present[:, place], atol=2e-4
        )


def test_contacts_that_never_settle_are_said(monkeypatch):
    monkeypatch.setattr(quick, "_MOST_STEPS", 1)  # the first ends with a change
    known = quick.QuickFlanks(None, None, np.ones((1, 3), dtype=bool), np.eye(3)[None], np.zeros((1, 3)), None)
    with pytest.raises(ConvergenceError, match="for 1 problems"):
        known.contact(np.array([[[0.0, 1.2, 2.4]]]), 1.0)


# ---- dynamics --------------------------------------------------------------------------------------------------------
def strain(x, total, own, static, error, displaced):
    pair = SimpleNamespace(gear=lambda member: SimpleNamespace(base_radius={"driver": 0.02, "driven": 0.05}[member]))
    return ToothStrain(pair, "driven", np.array([-1e-4, 0.0, 1e-4]), displaced, error, x, x / 10.0, total, own, static)


def test_a_half_bridge_in_motion_reads_the_difference_of_its_gauges():
    x = np.linspace(-5e-3, 5e-3, 11)
    pulse = np.exp(-((x / 3e-3) ** 2))
    places = np.array([0.8, 1.0, 1.1])
    first = strain(x, 5e-4 * pulse, 4e-4 * pulse, 3e-4 * pulse, np.full(11, 1e-6), 5e-4 * pulse[:, None] * places)
    at = np.linspace(-6e-3, 6e-3, 7)  # straight lines, which other positions give as they are
    second = strain(at, -2.0 * at, -3.0 * at, 0.25 * at, np.full(7, 2e-6), -2.0 * at[:, None] * places[::-1])
    bridge = first.less(second)
    assert bridge.total == pytest.approx(first.total + 2.0 * x)
    assert bridge.own == pytest.approx(first.own + 3.0 * x)
    assert bridge.static == pytest.approx(first.static - 0.25 * x)
    assert bridge.error == pytest.approx(np.full(11, 3e-6))
    assert bridge.displaced == pytest.approx(first.displaced + 2.0 * x[:, None])
    assert first.less_displaced(second) == pytest.approx(first.total[:, None] + 2.0 * x[:, None] * places[::-1])
    assert (bridge.displacement == first.displacement).all()
    assert bridge.angle == pytest.approx(x / 0.05)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_peak_in_motion_is_in_the_sense_of_the_quasi_static_one_and_other_places_are_beside_it(sense):
    """In compression, too; what swings the other way, farther, is no peak."""
    total = sense * np.array([1.0, -9.0, 4.0, 6.0, 2.0]) * 1e-5
    static = sense * np.array([0.0, 1.0, 3.0, 5.0, -4.0]) * 1e-5
    displaced = total[:, None] * [0.7, 1.0, 1.25]
    displaced[2, 0] = sense * 5e-5  # there the peak is at another position
    x = np.linspace(0.0, 4e-3, 5)
    found = strain(x, total, total, static, np.array([np.nan, 1.0, 2.0, 3.0, 4.0]) * 1e-7, displaced)
    assert found.peak == pytest.approx(6e-5 * sense)
    assert found.peak_angle == pytest.approx(3e-3 / 0.05)
    assert found.peak_error == pytest.approx(3e-7)
    assert found.ratio == pytest.approx(6.0 / 5.0)
    assert found.peak_of_places == pytest.approx(sense * np.array([5e-5, 6e-5, 7.5e-5]))
    assert found.reach_of_placement == pytest.approx((1e-5, 1.5e-5))
    assert found.change_by_placement == pytest.approx(1.5e-5)


def test_averages_of_a_motion_that_grows_without_bound_are_those_of_a_growing_motion():
    """Stiffness that swings at the natural frequency (Mathieu), no damping, and flanks that never part."""
    k, r, j, force = 2e8, 0.05, 2e-3, 500.0
    natural = math.sqrt(2.0 * k * r * r / j)
    train = Train(
        (Body("1", j), Body("2", j)), meshes=(Mesh("g", "1", "2", r, r, 30, 30, k),),
        torques=(Torque("1", force * r), Torque("2", force * r)),
    )  # fmt: skip
    stiffness = Periodic.fit(lambda s: k * (1.0 + 0.9 * np.cos(2.0 * np.pi * s)), degree=10, tolerance=1e-10)
    nothing = Periodic.fit(lambda s: 0.0 * s, degree=2, tolerance=1e-10)
    excitation = MeshExcitation.from_mesh(stiffness, nothing).never_parting(force)
    model = MotionModel(train, (excitation,), natural / 30)
    found = averaged_motion(model, tolerance=1e-5, repetitions=2000)
    assert found.kind == "growing"
    assert 5 < found.followed < 2000
    again, before = (averaged_motion(model, repetitions=found.followed - one, tolerance=1e-5) for one in (0, 1))
    assert (again.kind, before.kind) == ("growing", "not settled")


# ---- finite elements -------------------------------------------------------------------------------------------------
TOOTH, COARSE = Tooth(23), settings_at(0.1)


def area(mesh):
    (x0, x1, x2), (y0, y1, y2) = mesh.points[:, mesh.triangles[:3]]
    return 0.5 * float(np.abs((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)).sum())


def test_the_sector_of_a_shorter_tooth_has_lost_what_stood_above_its_tip_circle():
    tip = TOOTH.tip_radius - 0.3
    tooth, mesh = shorter_sector(TOOTH, 5.0, COARSE, OtherTip(tip))
    whole = supported_sector(TOOTH, 5.0, COARSE, None)
    assert tooth.tip_radius == tip
    assert float(np.hypot(*mesh.points).max()) == pytest.approx(tip, rel=1e-12)
    radius = np.linspace(tip, TOOTH.tip_radius, 2001)
    width = 2.0 * radius * TOOTH.half_thickness_angle(radius)
    cut = float(np.trapezoid(width, radius))
    assert area(whole) - area(mesh) == pytest.approx(cut, rel=2e-3)


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_a_web_is_assembled_the_same_by_scikit_fem(plane):
    """The web in plane stress at its own thickness, whatever the rim is in."""
    support = RimSupport(web=0.3, inner_radius=4.0)
    mesh = supported_sector(TOOTH, 8.5, COARSE, support)
    assert of_web(mesh).any()
    own, other = (assemble_section(mesh, 0.3, plane, 2, solver, support) for solver in ("condensed", "scikit-fem"))
    push = np.random.default_rng(2).normal(size=other.whole.shape[0])
    inside = np.where(own.element_dofs < 0, 0.0, push[own.element_dofs])
    energy = np.einsum("ei,eij,ej->", inside, own.stiffness, inside)
    assert energy == pytest.approx(push @ (other.whole @ push), rel=1e-10)
