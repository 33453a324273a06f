"""What ordinary cases come by seldom: ends of searches, second fillets, other outlines, standards' other branches."""

import math
import re
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design import relief_design
from fegear.design.fillet.fillet_bench import Judged
from fegear.design.fillet.fillet_search import search
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.design.fillet.shared_bottom import BothSides
from fegear.design.load_range import LoadRange
from fegear.design.loading import LoadingFunction
from fegear.design.robustness.draw_statistics import percentile
from fegear.design.sizing import front
from fegear.design.sizing.space import SizingSpace
from fegear.design.tip_relief.grindable import _weights
from fegear.formulas.agma import agma2101
from fegear.formulas.iso6336.part3_strength import mean_stress_factor, mean_stress_ratio
from fegear.formulas.iso6336.part5_materials import MATERIALS
from fegear.formulas.many.roots import _mean_stress
from fegear.geometry.asymmetric_fillets import with_fillets
from fegear.geometry.asymmetric_internal_tooth import AsymmetricInternalTooth
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.both_flanks import touching_distance
from fegear.geometry.curves import Arc, Line, Stretched
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.fillet_curves import TurnedCurve, turned_curve
from fegear.geometry.fillet_shapes import ArcFillet, ControlFillet, EllipseOnSpace, PointsFillet
from fegear.geometry.gear import Gear
from fegear.geometry.internal_interference import _shortest_cut
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.mass import _ring
from fegear.geometry.outline import _turned_edge, rack_tooth, tool_in_gear, turned
from fegear.geometry.over_balls import over_balls, touching_ball
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief
from fegear.shafts.axial_factors import ribs_of

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25), 0.1, 0.02)
UNEVEN = AsymmetricTooth(
    28, AsymmetricRack(RackFlank(math.radians(28.0), 0.2), RackFlank(math.radians(18.0), 0.3)), 0.1, 0.02
)


# ---- fillets of both sides -------------------------------------------------------------------------------------------
class Bench:
    """Stresses of two fillets, two points each, as functions of three numbers; room for all."""

    def __init__(self, stress):
        self.stress, self.tried = stress, 0
        self.limits = SimpleNamespace(generated=False)

    def tooth(self, numbers):
        return numbers

    def judged(self, numbers):
        self.tried += 1
        return Judged(np.asarray(self.stress(*numbers)), np.ones(1), 2)


FAMILY = SimpleNamespace(
    spread=np.array([0.5, 0.02, 0.3]), lower=np.full(3, -2.0), upper=np.full(3, 2.0), shape=lambda numbers: numbers
)


@pytest.mark.parametrize("first", [1.0, 0.6])
def test_of_two_fillets_the_less_stressed_is_led_down_too(first):
    """Each has a kink of its own at its least; both share the third number, which the more stressed one decides."""

    def stress(a, b, c):
        x, y = a - 0.3, 10.0 * (b - 0.05)
        return [first + x + c, first - x + c, 0.8 + y - c, 0.8 - y - c]

    found = search(Bench(stress), FAMILY, 2.0, np.array([0.1, 0.0, 0.0]))
    assert found.numbers[:2] == pytest.approx([0.3, 0.05], abs=2e-3)
    # The largest stress of both is least where both are equal.
    assert found.numbers[2] == pytest.approx(0.5 * (0.8 - first), abs=2e-3)
    assert found.stress == pytest.approx(0.5 * (0.8 + first), abs=2e-3)
    assert found.kept


def test_numbers_of_both_sides_are_those_of_each_and_the_place_of_the_lowest_line():
    own, back = MovedEllipses(None, 1.0, "waves", 2), MovedEllipses(None, 1.0, "bumps", 3)
    both = BothSides(own, back)
    for name in ("lower", "upper", "spread"):
        found = getattr(both, name)
        assert found[:-1].tolist() == [*getattr(own, name), *getattr(back, name)]
    assert both.lower[-1] == -both.upper[-1] < -both.spread[-1] < 0.0
    start = both.start(0.4, 0.02)
    assert start[:-1].tolist() == [0.4, 0.02, 0.0, 0.4, 0.02, 0.0, 0.0]
    assert 0.0 < start[-1] < both.upper[-1]
    assert both.start(0.0, 0.02)[-1] == 0.0


def test_two_equal_radii_are_one_arc():
    form, root = TOOTH.form_radius - 0.01, TOOTH.root_radius + 0.1
    single = with_fillet(TOOTH, ArcFillet((), form, root)).fillet
    radius = 1.0 / abs(float(single.curvatures(0.5 * (single.start + single.end))))
    two = with_fillet(TOOTH, ArcFillet((radius, radius), form, root)).fillet
    u = np.linspace(0.0, 1.0, 9)
    at, same = (one.start + u * (one.end - one.start) for one in (single, two))
    np.testing.assert_allclose(two.points(same), single.points(at), atol=1e-12)


# ---- curves and outlines ---------------------------------------------------------------------------------------------
@pytest.mark.parametrize("angle", [0.3, -0.7])
def test_arcs_that_are_turned_stay_arcs(angle):
    arc = Arc((0.4, 13.0), 0.3, 0.2, 1.1)
    found, wanted = turned_curve(arc, angle), TurnedCurve(arc, angle)
    u = np.linspace(0.0, 1.0, 7)
    at, same = (one.start + u * (one.end - one.start) for one in (found, wanted))
    np.testing.assert_allclose(found.points(at), wanted.points(same), atol=1e-13)
    np.testing.assert_allclose(found.normals(at), wanted.normals(same), atol=1e-13)
    assert isinstance(found, Arc)


@pytest.mark.parametrize("edge", [Arc((0.4, 13.0), 0.3, 0.2, 1.1), Line((0.3, 13.0), (0.1, 13.2))])
def test_edges_are_turned_with_the_tooth_they_belong_to(edge):
    """Toward the tooth's centre line, which is the second axis."""
    found = _turned_edge(edge, 0.2)
    u = np.linspace(0.0, 1.0, 5)
    at, same = (one.start + u * (one.end - one.start) for one in (found, edge))
    x, y = edge.points(same)
    turn = np.arctan2(x, y) - 0.2
    np.testing.assert_allclose(found.points(at), np.hypot(x, y) * np.stack([np.sin(turn), np.cos(turn)]), atol=1e-13)


def test_a_stretched_arc_is_moved_by_a_length_of_the_transverse_section():
    one = Stretched(Arc((0.4, 1.2), 0.3, 0.2, 1.1), 1.3)
    other, at = one.moved(0.25), np.linspace(0.2, 1.1, 5)
    np.testing.assert_allclose(other.points(at) - one.points(at), [[0.25] * 5, [0.0] * 5], atol=1e-14)
    assert (other.start, other.end) == (one.start, one.end)


@pytest.mark.parametrize("rolled", [0.0, 0.13])
def test_the_tool_of_a_tooth_with_another_fillet_is_that_of_the_tooth_as_generated(rolled):
    shaped = with_fillet(TOOTH, EllipseOnSpace(TOOTH.form_radius + 0.03))
    np.testing.assert_array_equal(tool_in_gear(shaped, rolled), tool_in_gear(TOOTH, rolled))
    deep = UNEVEN.root_radius - 0.03
    arcs = ArcFillet((1.5, 0.3), UNEVEN.coast.form_radius + 0.05, deep)
    side = with_fillets(UNEVEN.drive, drive=ArcFillet((0.35,), None, deep), coast=arcs)
    assert side.turn != 0.0
    np.testing.assert_allclose(
        tool_in_gear(side, rolled), turned(tool_in_gear(UNEVEN.drive, rolled), side.turn), atol=1e-13
    )
    with pytest.raises(TypeError, match="no tool available"):
        tool_in_gear("a tooth", rolled)


def test_the_tool_of_uneven_flanks_has_each_flank_on_its_side():
    """Its outline seen from the other flank is the mirror image; flanks stand at their own pressure angles."""
    drive, coast = rack_tooth(UNEVEN.drive), rack_tooth(UNEVEN.coast)
    np.testing.assert_allclose(coast[:, ::-1] * [[-1.0], [1.0]], drive, atol=1e-12)
    half = drive.shape[1] // 2
    right, left = drive[:, :half], drive[:, half:]
    for (x, y), angle in ((right, 18.0), (left[:, ::-1], 28.0)):
        assert abs((x[1] - x[0]) / (y[1] - y[0])) == pytest.approx(math.tan(math.radians(angle)), rel=1e-9)
    # Both flanks together are as thick on the pitch line of the rack as its space: half the pitch.
    width = sum(
        abs(x[0]) - (y[0] - UNEVEN.generating_shift) * math.tan(math.radians(angle))
        for (x, y), angle in ((right, 18.0), (left[:, ::-1], 28.0))
    )
    assert width == pytest.approx(0.5 * math.pi, rel=1e-9)


# ---- rings, balls, distances -----------------------------------------------------------------------------------------
def test_a_cutter_known_by_the_root_circle_it_makes_is_the_one_known_by_its_addendum():
    def ring(**cutter):
        made = PinionCutter(25, profile_shift=0.1, tip_radius=0.1, **cutter)
        return AsymmetricInternalTooth(60, made, math.radians(28.0), math.radians(18.0), 0.15, -0.3, 0.02, 29.5)

    by_addendum = ring(addendum=1.25)
    by_root = ring(root_radius=by_addendum.root_radius)
    assert by_root.cutter.addendum == pytest.approx(1.25, abs=1e-12)
    assert by_root.root_radius == pytest.approx(by_addendum.root_radius, rel=1e-14)


def test_the_shortest_cut_is_where_there_is_just_room_and_what_cannot_be_has_none():
    def room(radius):
        if not 20.0 < radius < 22.0:
            raise GeometryError("tip", radius, "cannot be")
        return 21.4 - radius

    assert _shortest_cut(room, 22.0, 19.0) == pytest.approx(21.4, abs=1e-9)
    assert _shortest_cut(room, 22.0, 21.9) is None
    assert _shortest_cut(lambda radius: radius - 25.0, 22.0, 26.0) == pytest.approx(25.0, abs=1e-9)


def test_a_ring_without_thickness_weighs_nothing():
    assert _ring(7850.0, 0.03, 0.03, 0.0, 0.1) == (0.0, 0.0, 0.0, 0.0)
    assert _ring(7850.0, 0.02, 0.03, 0.0, 0.1) == (0.0, 0.0, 0.0, 0.0)
    assert _ring(7850.0, 0.03, 0.02, 0.0, 0.1)[0] == pytest.approx(7850.0 * math.pi * 0.1 * 5e-4)


@pytest.mark.parametrize("shift", [0.0, 1.2])
def test_a_ball_touches_at_the_v_circle_or_in_the_middle_of_the_involute(shift):
    tooth = Tooth(30, BasicRack(1.0, 1.25, 0.25), shift, tip_radius=15.9 if shift else math.nan)
    gear = Gear(tooth, 2e-3, 0.01, 0.02)
    low, high = tooth.involute_radii
    v_circle = tooth.pitch_radius + shift
    assert (low < v_circle < high) is (shift == 0.0)
    touches = v_circle if shift == 0.0 else 0.5 * (low + high)
    assert over_balls(gear, touching_ball(gear)).contact_radius == pytest.approx(2e-3 * touches, rel=1e-9)


@pytest.mark.parametrize(
    ("side", "half_angles", "said", "remedy"),
    [
        (1, (0.01, 0.01), "is too negative: no working pressure angle", "increase"),
        (1, (9.0, 1.0), "is too large: working pressure angle above 76 deg", "reduce"),
        (-1, (0.1, 0.1), "is too large: no working pressure angle", "reduce"),
        (-1, (0.01, 0.01), None, ""),
        (-1, (0.0, -2.0), "is too negative: working pressure angle above 76 deg", "increase"),
    ],
)
def test_teeth_that_touch_at_no_distance_are_too_thick_or_too_thin(side, half_angles, said, remedy):
    """By half tooth thicknesses on the base circles: of a ring gear the pinion is too thick, or everything too thin."""

    def flank(teeth, side, half, shift):
        one = SimpleNamespace(
            teeth=teeth, side=side, base_half_angle=half, base_radius=0.5 * teeth * math.cos(math.radians(20.0)),
            profile_shift=shift, thickness_allowance=0.0,
        )  # fmt: skip
        one.back = one
        return one

    one, other = flank(20, 1, half_angles[0], 0.25), flank(60, side, half_angles[1], 0.5)
    if said is None:
        distance = touching_distance(one, other, allowance=True)
        angle = math.acos((60 - 20) * 0.5 * math.cos(math.radians(20.0)) / distance)
        # z_1 and z_2 count against each other: half thicknesses fill what the working pressure angle leaves.
        free = 2.0 * math.pi - 2.0 * (20 * half_angles[0] + 60 * half_angles[1])
        assert 80.0 * (math.tan(angle) - angle) == pytest.approx(free, rel=1e-9)
        return
    with pytest.raises(GeometryError, match=said) as refused:
        touching_distance(one, other, allowance=True)
    assert refused.value.remedy == f"{remedy} one of them"
    assert refused.value.value == "sum 0.75"


# ---- sizing ----------------------------------------------------------------------------------------------------------
def test_fronts_are_the_same_however_few_costs_are_compared_at_once(monkeypatch):
    monkeypatch.setattr(front, "_AT_ONCE", 1)
    rng = np.random.default_rng(5)
    for columns in (1, 2, 3, 4, 5):
        for kind in (lambda c: c, np.round, lambda c: np.column_stack([*c[:, :-1].T, np.round(c[:, -1])])):
            costs = kind(2.0 * rng.normal(size=(90, columns)))
            seen = front.rounded_costs(costs)
            wanted = [
                i for i, one in enumerate(seen) if not ((seen <= one).all(axis=1) & (seen < one).any(axis=1)).any()
            ]
            assert front.pareto_front(costs).tolist() == wanted
    # Halves about a value that is the largest of many.
    costs = np.column_stack([rng.random(40), rng.random(40), np.where(np.arange(40) < 5, 0.0, 1.0)])
    wanted = [i for i, one in enumerate(costs) if not ((costs <= one).all(axis=1) & (costs < one).any(axis=1)).any()]
    assert front.pareto_front(costs).tolist() == wanted


def space(**changed):
    given = {
        "modules": (2e-3, 3e-3), "alphas": (0.35,), "betas": (0.0, 0.2, 0.3), "heights": (1.0,), "widths": (),
        "relative_widths": (0.6, 0.8), "pinion_teeth": (18, 20), "ratio": 2.5, "tolerance": 0.1, "hunting": False,
        "shifts": (0.0, 0.3, 0.6), "sums": (-0.2, 0.1, 0.4), "distances": None, "shift_sum_limits": (-2.0, 2.0),
    }  # fmt: skip
    return SizingSpace(**(given | changed))


@pytest.mark.parametrize("fixed", [False, True])
def test_what_lies_on_its_bounds_is_what_the_pair_of_that_number_has_least_or_most_of(fixed):
    made = space(distances=(0.1, 0.1) if fixed else None)
    pairs = made.pairs(np.arange(made.count))
    assert made.count == 2 * 3 * 2 * len(made.pairs_of_teeth) * 3 * (1 if fixed else 3)
    values = {
        "normal_modules": (pairs.module, made.modules), "helix_angles": (pairs.helix_angle, made.betas),
        "width_ratios": (None, made.relative_widths), "pinion_teeth": (pairs.teeth[0], made.pinion_teeth),
        "pinion_shifts": (pairs.profile_shift[0], made.shifts),
    }  # fmt: skip
    if not fixed:
        values["shift_sums"] = (pairs.profile_shift.sum(axis=0), made.sums)
    seen = set()
    for number in range(0, made.count, 7):
        said = made.on_bounds(number)
        seen.update(said)
        for name, (given, ends) in values.items():
            if given is None:
                continue
            expected = [
                f"{name} ({word})"
                for end, word in ((min(ends), "minimum"), (max(ends), "maximum"))
                if given[number] == pytest.approx(end, abs=1e-12)
            ]
            assert [one for one in said if one.startswith(name)] == expected
    words = [f"{name} ({word})" for name in values for word in ("minimum", "maximum")]
    assert seen == set(words)
    of_widths = space(widths=(20e-3, 30e-3))
    assert {one.split()[0] for n in range(of_widths.count) for one in of_widths.on_bounds(n)} >= {"face_width"}


# ---- what is left of nothing -----------------------------------------------------------------------------------------
def test_a_percentile_of_no_results_is_unknown_and_may_be_anything():
    found = percentile(np.array([np.nan, np.inf]), 95.0)
    assert math.isnan(found.value)
    assert (found.percent, found.low, found.high) == (95.0, -math.inf, math.inf)


def test_loads_without_weight_do_not_count_and_equal_weights_are_none():
    loads = np.array([1.0, 2.0, 3.0])
    for weights, counted, counts in (
        ([1.0, 1.0, 0.0], None, [True, True, False]), ([1.0, 0.5, 0.0], [1.0, 0.5], [True, True, False]),
        ([0.0, 0.0, 2.0], None, [False, False, True]), (None, None, [True] * 3),
    ):  # fmt: skip
        found, which = _weights(weights, loads)
        assert (found if found is None else found.tolist()) == counted
        assert which.tolist() == counts


# ---- standards' other branches ---------------------------------------------------------------------------------------
@pytest.mark.parametrize("group", dict.fromkeys(MATERIALS.values()))
@pytest.mark.parametrize("static", [False, True])
def test_mean_stress_of_many_gears_is_that_of_each(group, static):
    y_s, ratio = np.array([1.6, 2.1]), (-1.1, 0.0)
    asked = SimpleNamespace(duty=SimpleNamespace(mean_stress=None, stress_ratio=ratio))
    found = _mean_stress(SimpleNamespace(group=group), asked, 0, y_s, static=static)
    wanted = [mean_stress_factor(mean_stress_ratio(group, one, static=static), ratio[0]) for one in y_s]
    np.testing.assert_allclose(np.broadcast_to(found, 2), wanted, rtol=1e-14)
    assert _mean_stress(SimpleNamespace(group=group), asked, 1, y_s, static=static) == 1.0


def test_only_softer_wheels_are_hardened_by_their_pinion():
    """Z_W of AGMA 2101: 1 unless the wheel is through-hardened and its pinion is as well or has a hard case."""

    def factor(*treatments):
        allowed = [
            SimpleNamespace(treatment=one, brinell=hard) for one, hard in zip(treatments, (380.0, 250.0), strict=True)
        ]
        pair, service = SimpleNamespace(ratio=2.0), SimpleNamespace(pinion_roughness=0.5e-6)
        return agma2101._hardness(pair, service, tuple(allowed))

    soft, hard = "through-hardened", next(iter(agma2101.HARD_CASES))
    assert factor(hard, hard) == factor(soft, hard) == factor("cast iron", soft) == 1.0
    assert factor(hard, soft) == agma2101.work_hardening_factor(0.5e-6, 250.0) > 1.0
    assert factor(soft, soft) == agma2101.hardness_ratio_factor(2.0, 380.0, 250.0) > 1.0


# ---- designs for a range ---------------------------------------------------------------------------------------------
def test_loads_of_a_design_count_as_its_range_says():
    task = relief_design.DesignTask(None, 200.0, False, (), "peak_to_peak", (100.0, 200.0, 400.0), 16, 5)
    assert task.over_loads == (100.0, 200.0, 400.0)
    assert task.over_weights.tolist() == [0.0, 1.0, 0.0]
    assert replace(task, over=LoadRange((50.0, 90.0))).over_weights.tolist() == [1.0, 1.0]
    weighted = replace(task, over=LoadRange((50.0, 90.0), (0.25, 1.0)))
    assert (weighted.over_loads, weighted.over_weights.tolist()) == ((50.0, 90.0), [0.25, 1.0])


def test_a_design_for_a_range_is_compared_with_reliefs_for_one_load_and_with_the_present_one(monkeypatch):
    """Each on the pair without reliefs and spacing errors of its own; searches are made up."""
    rack = BasicRack(1.0, 1.25, 0.2)
    gears = [Gear(Tooth(z, rack), 3e-3, 0.02, 0.03) for z in (24, 36)]
    load = 4000.0
    pair = GearPair(*gears)
    plain = Engagement(PairCompliance(pair, *(closed_form_compliance(one, "cornell") for one in gears)))
    tip = float(gears[0].symmetric_tooth.roll(gears[0].tooth.tip_radius))
    present, other = (EndRelief(amount, tip - 0.1, tip) for amount in (8e-6, 20e-6))
    asked = []

    @dataclass(frozen=True)
    class Ground:
        driver: EndRelief
        driven: EndRelief
        objective: float = 1.0
        undeviated: None = None

        def applied(self, engagement):
            return replace(engagement, driver_relief=self.driver)

    def grindable(engagement, load, shape, metric, *, banded=True, limits=None, cache=None):
        asked.append((load, shape, metric, banded))
        return Ground(other if banded else present, EndRelief(0.0, tip - 0.1, tip))

    monkeypatch.setattr(relief_design, "grindable", grindable)
    loading = LoadingFunction(1.3 * pair.base_pitch, pair.base_pitch, 0.5 * (pair.x_start + pair.x_end))
    task = relief_design.DesignTask(
        loading, load, False, ("linear",), "peak_to_peak", (load,), 12, 5,
        over=LoadRange((0.5 * load, load)),
    )  # fmt: skip
    own = replace(plain, driver_relief=present, driver_spacing=np.full(24, 5e-6), driven_spacing=np.zeros(36))
    progress = []
    found = relief_design.design_relief(own, (), task, progress.append)
    assert asked == [(task.over, "linear", "peak_to_peak", True), (load, "linear", "peak_to_peak", False)]
    assert progress == pytest.approx([0.1, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.85, 0.95])
    wanted = {
        "no relief": plain, "linear tip relief": replace(plain, driver_relief=other),
        "linear tip relief for one load": replace(plain, driver_relief=present),
        "present relief": replace(plain, driver_relief=present),
    }  # fmt: skip
    for label, state in wanted.items():
        assert found.te[label].peak_to_peak == pytest.approx(transmission_error(state, load, 5).peak_to_peak, rel=1e-9)
        assert [one.peak_to_peak for one in found.over_range[label]] == pytest.approx(
            [transmission_error(state, one, 12).peak_to_peak for one in (0.5 * load, load)], rel=1e-3
        )
    left = [one.peak_to_peak for one in found.over_range["linear tip relief"]]
    assert found.rounded["linear"] == pytest.approx(left, rel=2e-3)  # 20 um, and a diameter to a thousandth
    assert found.rounded["linear"].tolist() != left
    assert list(found.for_one_load) == ["linear"]
    assert found.finer == 0


def angle_between(one, other):
    """Of two unit vectors [deg]."""
    return math.degrees(math.asin(abs(float(one[0] * other[1] - one[1] * other[0]))))


def controlled(end, degrees):
    """The generated fillet by control points, one end's leg turned about its end."""
    fillet = TOOTH.fillet
    points = fillet.points(np.linspace(fillet.start, fillet.end, 9)).T
    control = np.array(with_fillet(TOOTH, PointsFillet(tuple(map(tuple, points)))).fillet.control).T
    at, beside = (0, 1) if end == "root" else (-1, -2)
    turn = math.radians(degrees)
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    control[:, beside] = control[:, at] + matrix @ (control[:, beside] - control[:, at])
    return with_fillet(TOOTH, ControlFillet(tuple(map(tuple, control.T))))


@pytest.mark.parametrize("end", ["root", "flank"])
@pytest.mark.parametrize("degrees", [-2.0, -0.3, 0.3, 2.0])
def test_a_fillet_of_control_points_touches_flank_and_root_circle_where_it_nearly_does(end, degrees):
    """Three degrees off it is refused; less is taken for round-off of a drawing."""
    tooth = controlled(end, degrees)
    fillet, flank = tooth.fillet, tooth.involute
    assert angle_between(fillet.normals(fillet.end), flank.normals(flank.start)) < 1e-6
    assert angle_between(fillet.normals(fillet.start), fillet.points(fillet.start) / tooth.root_radius) < 1e-6
    with pytest.raises(GeometryError, match="deg"):
        controlled(end, 3.0 if end == "flank" else math.copysign(3.2, degrees))


@pytest.mark.parametrize(("apart", "equal"), [(1.5e-6, False), (0.5e-6, True)])
def test_points_of_a_fillet_closer_than_a_millionth_of_a_module_are_equal(apart, equal):
    """What is less close may be refused for other reasons."""
    fillet = TOOTH.fillet
    points = fillet.points(np.linspace(fillet.start, fillet.end, 9)).T
    more = np.insert(points, 4, points[3] + apart * (points[4] - points[3]) / math.dist(points[4], points[3]), axis=0)
    with pytest.raises(GeometryError) as refused:
        with_fillet(TOOTH, PointsFillet(tuple(map(tuple, more))))
    assert (refused.value.value == "two equal points") is equal


def test_ribs_that_carry_axial_force_follow_from_the_series():
    """NUP 2 and 3 are narrow, NUP 22 and 23 wide; other bearings of cylindrical rollers have none."""
    for narrow, wide in (("NUP205", "NUP2205"), ("NUP310", "NUP2310")):
        assert ribs_of(narrow) == (0.6, 0.2)
        assert ribs_of(wide) == (0.4, 0.3)
    assert ribs_of("NU2205") is ribs_of("6205") is None


RING = InternalTooth(
    60, PinionCutter(25, profile_shift=0.1, addendum=1.25, tip_radius=0.2), profile_shift=-0.3, tip_radius=29.5
)


@pytest.mark.parametrize(("tooth", "off"), [(TOOTH, 0.3), (RING, 0.2)])
def test_the_root_circle_named_for_an_ellipse_is_the_deepest_that_has_one(tooth, off):
    form = tooth.form_radius + tooth.side * off
    with pytest.raises(GeometryError, match="no ellipse that is tangent") as refused:
        with_fillet(tooth, EllipseOnSpace(form, tooth.root_radius - 0.3 * tooth.side))
    said = re.search(r"must be (above|below) ([0-9.]+) modules", refused.value.rule)
    assert said[1] == ("above" if tooth.side > 0 else "below")
    limit = 0.5 * float(said[2])
    made = with_fillet(tooth, EllipseOnSpace(form, limit + 2e-3 * tooth.side))
    assert made.root_radius == limit + 2e-3 * tooth.side
    with pytest.raises(GeometryError, match="no ellipse that is tangent"):
        with_fillet(tooth, EllipseOnSpace(form, limit - 2e-3 * tooth.side))


@pytest.mark.parametrize("radii", [(1.5, 0.3), (0.6, 0.3)])
@pytest.mark.parametrize("tooth", [TOOTH, RING], ids=["gear", "ring"])
def test_two_arcs_have_their_radii_and_touch_flank_root_circle_and_each_other(tooth, radii):
    made = with_fillet(tooth, ArcFillet(radii, tooth.form_radius + 0.02 * tooth.side))
    fillet = made.fillet
    ends = fillet.start, fillet.end
    assert angle_between(fillet.normals(fillet.end), made.involute.normals(made.involute.start)) < 1e-6
    bottom = np.array(fillet.points(fillet.start))
    assert angle_between(fillet.normals(fillet.start), bottom / np.hypot(*bottom)) < 1e-6
    assert np.hypot(*bottom) == pytest.approx(tooth.root_radius, rel=1e-12)
    found = [1.0 / abs(float(fillet.curvatures(end))) for end in ends]
    assert found == pytest.approx([radii[1], radii[0]], rel=1e-9)
    u = np.linspace(*ends, 2001)
    normals = fillet.normals(u)
    turns = np.abs(normals[0, 1:] * normals[1, :-1] - normals[1, 1:] * normals[0, :-1])
    assert turns.max() < 3.0 * math.pi / 2000.0  # nowhere a corner
    assert (np.diff(np.hypot(*fillet.points(u))) * tooth.side > -1e-12).all()
