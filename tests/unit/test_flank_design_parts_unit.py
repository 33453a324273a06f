"""How a design of loaded flanks goes on from step to step: every step by itself is tested elsewhere."""

import itertools
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks import flank_design
from fegear.design.flanks.designed_flanks import EXACT, ROBUST, UNRELIEVED, FlankDesign, FlankDesignTask, FlankState
from fegear.design.flanks.flank_design import design_flanks
from fegear.design.flanks.flank_tolerance import (
    FlankTolerance,
    LeadTolerance,
    decisive_tolerances,
    unrelieved_within,
    within_tolerances,
)
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import FAMILIES
from fegear.design.flanks.scatter import NOMINAL, Scatter
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.results.relief import flank_design_answer as answer
from fegear.results.relief.lead_charts import lead_chart

PITCH, START = 8e-3, -3e-3


TRIED = itertools.count(1)


@dataclass(frozen=True)
class Trials:
    """In place of trials: what they were made of."""

    pair: object
    known: object
    apart: object
    loads: object
    scatter: Scatter = NOMINAL
    weights: object = None

    def of_gap(self, gap):
        """What is tried later leaves less."""
        te = np.full((1, 3, np.size(self.loads)), float(np.sum(gap)))
        return SimpleNamespace(
            te=te,
            peak_to_peak=np.full((self.scatter.over_face.size, np.size(self.loads)), 1.0 / next(TRIED)),
            gap=gap,
            of=self,
        )


@dataclass(frozen=True)
class Best:
    """In place of the best of a family."""

    family: str
    relief: GroundRelief
    valleys: tuple
    made: tuple
    grid: str = ""


@pytest.fixture
def steps(monkeypatch):
    calls = {name: [] for name in ("best", "led_on", "compliance")}
    pair = SimpleNamespace(
        driver=SimpleNamespace(module=3e-3), path_length=14e-3, face_width=20e-3, base_pitch=PITCH,
        x_start=START, x_end=START + 14e-3,
        face_height=lambda member: 0.5e-3, roll_angle=lambda x, member: 10.0 * x,
    )  # fmt: skip
    flanks = SimpleNamespace(pair=pair, gears="gears", coupling=True, hertz="h", cache="c", panel=0.5)

    def put(name, made):
        monkeypatch.setattr(flank_design, name, made)

    def lines(name, roll=(0.0,)):
        weight = np.array([0.4, 0.3, 0.2, 0.1])
        return SimpleNamespace(
            name=name, roll=np.array(roll), x=np.array([1.0, 2.0]), z=np.array([0.1, 0.2]), edges=None,
            present=np.array([True, False]), roll_angle=lambda pair, member: np.array([10.0, 20.0]),
            mean=lambda values: np.tensordot(weight, values, axes=1),
        )  # fmt: skip

    put("design_lines", lambda *given: calls.update(design=given) or lines("design", [START + 0.2 * PITCH]))
    put(
        "flank_compliance",
        lambda pair, gears, at, load, **how: (
            calls["compliance"].append((at.name, load, how)) or SimpleNamespace(lines=at, name=at.name)
        ),
    )
    put(
        "station_relief",
        lambda own, gap, loading, load: calls.update(station=(own.name, gap, loading, load)) or "station",
    )
    put("table_nodes", lambda station, pair: ("x", "z"))
    put("tabulated", lambda *given: np.array([[1e-6, 4e-6]]))
    table = SimpleNamespace(removal=lambda roll, height: 100.0 * roll + height)
    put("topography", lambda *given: calls.update(topography=given) or table)
    put("usual_grid", lambda *given: calls.update(grid=given) or "usual")
    put("FlankTrials", Trials)
    put("design_force", lambda lines, loading, load: ("force", lines.name, load))

    def best(trials, family, grid, force, most, starts, scan, ahead=None):
        calls["best"].append((trials, family, grid, force, most, tuple(starts), scan))
        number = 1e-6 * (1 + list(FAMILIES).index(family))
        tips, leads = (number, 1e-3) if "profile" in family else (0.0, 0.0), number if "profile" not in family else 0.0
        valleys = tuple(GroundRelief(*(k * v for v in tips), crowning=k * leads) for k in (1, 2))
        return Best(family, valleys[0], valleys, ("best", family, trials.scatter.over_face.size), grid)

    def led_on(trials, one, grid, start, most):
        calls["led_on"].append((trials, one, grid, start, most))
        return replace(one, made=("led on", *one.made))

    put("best_of_family", best)
    put("led_on", led_on)
    judged = []

    def judge(gap):
        judged.append(gap(lines("judged")))
        number = SimpleNamespace(value=10.0 - len(judged), error=1e-3)
        return SimpleNamespace(peak_to_peak=number, mean_over_scatter=number)

    def left(gap):
        """What is judged later leaves less."""
        te = np.zeros((4, 2))
        te[1] = 10.0 - len(judged)
        return te, np.array([1e-3, 2e-3])

    def under(loads, apart):
        calls.update(under=(loads.tolist(), apart))
        known = SimpleNamespace(lines=lines("dense", START + PITCH * np.arange(4) / 4.0))
        dense = Trials(pair, known, "apart", loads)
        return SimpleNamespace(left=left, dense=dense)

    plain = Trials(
        pair, SimpleNamespace(lines=lines("plain", START + PITCH * np.arange(3) / 3.0)), "apart", np.array([1.0])
    )
    put(
        "flank_judge",
        lambda *given: calls.update(judge=given) or SimpleNamespace(judge=judge, plain=plain, under=under),
    )
    apart = SimpleNamespace(
        under=lambda load: SimpleNamespace(at=lambda pair, lines, loads=None: ("aligned", load, lines.name)),
        at=lambda pair, lines, loads: ("apart", lines.name, loads.tolist()),
    )
    known = SimpleNamespace(lines=lines("known", [START, START + 0.5 * PITCH]))
    return SimpleNamespace(flanks=flanks, apart=apart, known=known, calls=calls, judged=judged, plain=plain)


def task(families=tuple(FAMILIES), scatter=NOMINAL, grid=None):
    return FlankDesignTask("loading", 1200.0, (900.0, 1200.0), families, grid, 1.4, scatter, 2e-6, 24,
                           (-1e-6, 0.0, 1e-6), (600.0, 1200.0))  # fmt: skip


def designed(steps, **how):
    told = []
    found = design_flanks(steps.flanks, "coarse", steps.known, steps.apart, task(**how), told.append)
    return found, told


def test_every_family_begins_with_the_valleys_of_those_that_it_holds_and_their_sums(steps):
    found, told = designed(steps)
    calls = steps.calls
    assert list(found.found) == list(FAMILIES)
    assert [one[1] for one in calls["best"]] == list(FAMILIES)
    searched, judged = len(FAMILIES), len(found.states)
    steps_of_search = [0.3 + 0.4 * k / searched for k in range(1, searched + 1)]
    assert told == pytest.approx([0.3, *steps_of_search, 0.8, *(0.8 + 0.2 * k / judged for k in range(1, judged + 1))])
    counts = dict(zip(FAMILIES, (0, 0, 2, 10, 12), strict=True))
    for trials, family, grid, force, most, starts, scan in calls["best"]:
        assert (grid, force, most) == ("usual", ("force", "known", 1200.0), 1.4)
        assert len(starts) == counts[family]
        assert scan.known is steps.known
        assert scan.apart == ("apart", "known", [900.0, 1200.0])
        assert trials.known is steps.plain.known
        assert trials.apart == ("apart", "plain", [900.0, 1200.0])
        assert trials.loads.tolist() == [900.0, 1200.0]
    both = calls["best"][3][5][-4:]
    assert [one.driver_tip for one in both] == [found.found["profile"].valleys[k].driver_tip for k in (0, 0, 1, 1)]
    assert [one.crowning for one in both] == [found.found["lead"].valleys[k].crowning for k in (0, 1, 0, 1)]
    assert calls["led_on"] == []
    assert calls["design"][1:] == ("loading", 24, pytest.approx(1.5e-3))
    assert calls["station"] == ("design", ("aligned", 1200.0, "design"), "loading", 1200.0)
    assert calls["grid"] == (pytest.approx(3e-6), 14e-3, 20e-3, PITCH)
    assert [one[1] for one in calls["compliance"]] == [1200.0]
    assert calls["compliance"][0][2] == {"coupling": True, "hertz": "h", "cache": "c"}
    assert calls["judge"][1:3] == ("coarse", calls["judge"][2])
    assert calls["judge"][3:] == (1200.0, 2e-6)


def test_states_are_judged_in_order_and_the_best_is_the_one_that_leaves_least(steps):
    found, _ = designed(steps)
    assert [state.label for state in found.states] == [UNRELIEVED, EXACT, *FAMILIES]
    assert (found.unrelieved.label, found.exact.label, found.robust) == (UNRELIEVED, EXACT, ())
    assert found.exact.relief is None
    assert found.best.label == list(FAMILIES)[-1]  # the later the less, here
    # What is not on a line has no gap; a table is over roll angle and height.
    np.testing.assert_allclose(steps.judged[1], [100.0 * 10.0 * 1.0 + 0.1 + 0.5e-3, 0.0])
    np.testing.assert_allclose(steps.judged[0], [0.0, 0.0])
    state = found.exact
    np.testing.assert_allclose(state.te, np.full(3, 1000.1005))
    assert state.mapped.of.scatter.over_face.tolist() == [-1e-6, 0.0, 1e-6]
    assert state.mapped.of.scatter.weights.tolist() == pytest.approx([1.0 / 3.0] * 3)
    assert state.mapped.of.loads.tolist() == [600.0, 1200.0]
    assert state.over_peak_to_peak.shape == state.over_first.shape == (2,)
    assert state.over_error.tolist() == [1e-3, 2e-3]
    # Positions count as the part of a base pitch that they stand for: 0.3 of the second, a quarter of it on.
    phase = np.exp(-2j * np.pi * (START / PITCH + np.arange(4) / 4.0))
    left = np.array([0.0, 1.0, 0.0, 0.0]) - 0.3
    first = 2.0 * abs(np.array([0.4, 0.3, 0.2, 0.1]) @ (phase * left))
    np.testing.assert_allclose(state.over_first, first * state.over_peak_to_peak)
    assert steps.calls["under"] == ([900.0, 1200.0], steps.apart)


def test_scatter_has_a_relief_of_its_own_and_leads_the_freest_family_on(steps):
    scatter = Scatter(np.array([-1e-6, 0.0, 1e-6]), np.array([0.25, 0.5, 0.25]))
    found, _ = designed(steps, scatter=scatter)
    last = list(FAMILIES)[-1]
    assert list(found.found) == [*FAMILIES, ROBUST]
    assert found.found[ROBUST].made == ("best", last, 3)
    assert found.found[last].made == ("led on", "best", last, 1)
    trials, family, *_, starts, scan = steps.calls["best"][-1]
    assert (family, trials.scatter, scan.scatter) == (last, scatter, scatter)
    assert len(starts) == len([one for one in (*flank_design.held_by(last), last) if one in FAMILIES])
    assert steps.calls["led_on"][0][0].scatter is NOMINAL
    assert [state.label for state in found.robust] == [ROBUST]


def test_only_families_that_are_asked_for_are_searched_on_a_grid_that_is_given(steps):
    first, last = next(iter(FAMILIES)), list(FAMILIES)[-1]
    found, told = designed(steps, families=(last, first), grid="own")
    assert list(found.found) == [first, last]
    assert found.grid == "own"
    assert "grid" not in steps.calls
    assert told == pytest.approx([0.3, 0.5, 0.7, 0.8, 0.85, 0.9, 0.95, 1.0])
    none, told = designed(steps, families=(), scatter=Scatter(np.array([-1e-6, 1e-6]), np.array([0.5, 0.5])))
    assert (none.found, told) == ({}, [0.3, 0.8, 0.9, 1.0])


def left_by(*found):
    """A design for one load by what each of its ways leaves, with which error: label, relief, value, error [um]."""

    def state(label, relief, value, error):
        judged = SimpleNamespace(peak_to_peak=SimpleNamespace(value=value * 1e-6, error=error * 1e-6))
        at = np.full(2, value * 1e-6)
        return FlankState(label, relief, np.zeros(1), judged, None, at, at, at)

    none = state(UNRELIEVED, GroundRelief(), 0.9, 0.01)
    alone = replace(task(), load=1200.0, loads=(1200.0,))
    return FlankDesign(
        alone, "station", np.zeros(1), np.zeros(1), np.zeros((1, 1)), np.zeros(1),
        (none, none, *(state(*one) for one in found)), {label: "best" for label, *_ in found}, "grid",
    )  # fmt: skip


def test_modifications_below_their_tolerances_are_not_ground_for_what_they_gain():
    given = FlankTolerance((TipTolerance(5e-6, None, 0.0),) * 2, LeadTolerance(6e-6, 4e-6, 5e-6))
    design = left_by(("profile", TIPS, 0.40, 0.01), ("profile-and-lead", WITH_LEAD, 0.30, 0.01))
    assert design.best.label == "profile-and-lead"
    allowed = replace(design, task=replace(design.task, tolerance=given))
    assert (allowed.best.label, allowed.least.label) == ("profile", "profile-and-lead")
    # One amount that a shop can hold is worth it; so is all that is needed to be better than no relief.
    large = left_by(("profile", TIPS, 0.40, 0.01), ("profile-and-lead", replace(WITH_LEAD, slope=-7e-6), 0.30, 0.01))
    assert replace(large, task=allowed.task).best.label == "profile-and-lead"
    worse = left_by(("profile", TIPS, 0.95, 0.01), ("profile-and-lead", WITH_LEAD, 0.30, 0.01))
    assert replace(worse, task=allowed.task).best.label == "profile-and-lead"


def test_where_misalignment_scatters_the_mean_over_it_decides():
    design = left_by(("profile", TIPS, 0.40, 0.01), (ROBUST, WITH_LEAD, 0.45, 0.01))
    assert [s.label for s in design.chosen] == ["profile", ROBUST]
    means = {"profile": 0.9e-6, ROBUST: 0.6e-6}
    states = tuple(
        replace(s, judged=SimpleNamespace(**vars(s.judged), mean_over_scatter=SimpleNamespace(
            value=means.get(s.label, 2e-6), error=1e-8)))
        for s in design.states
    )  # fmt: skip
    scatter = Scatter(np.array([-1e-6, 0.0, 1e-6]), np.array([0.25, 0.5, 0.25]))
    over = replace(design, states=states, task=replace(design.task, scatter=scatter))
    assert (over.best.label, len(over.chosen)) == (ROBUST, 1)
    assert sentences(answer._scattered, over, [120.0], {"profile": [0.4e-6], ROBUST: [0.45e-6]}) == [
        (
            "Pair I: robust is chosen by the mean over the scatter of misalignment: 2 -> 0.6 µm at 120 N m; aligned as "
            "specified profile leaves less, 0.4 µm at 120 N m."
        )
    ]


def test_where_misalignment_scatters_fewer_modifications_are_not_ground_at_the_cost_of_their_tolerances():
    """Crowning leaves as much as tip reliefs on the mean, but twice as much within its tolerances."""
    given = FlankTolerance((TipTolerance(5e-6, None, 0.0),) * 2, LeadTolerance(6e-6, 4e-6, 5e-6))
    crowned = GroundRelief(crowning=4.8e-6)
    scatter = Scatter(np.array([-1e-6, 0.0, 1e-6]), np.array([0.25, 0.5, 0.25]))

    def best(crowning, tips):
        design = left_by(("profile", TIPS, 0.40, 0.01), ("crowning-and-end-relief", crowned, 0.41, 0.01))
        mean = {"profile": 0.500e-6, "crowning-and-end-relief": 0.505e-6}
        most = {"profile": np.full(1, tips), "crowning-and-end-relief": np.full(1, crowning)}
        states = tuple(
            replace(s, over_most=most.get(s.label), judged=SimpleNamespace(
                **vars(s.judged), mean_over_scatter=SimpleNamespace(value=mean.get(s.label, 2e-6), error=1e-8)))
            for s in design.states
        )  # fmt: skip
        return replace(design, states=states, task=replace(design.task, scatter=scatter, tolerance=given)).best.label

    assert best(1.0e-6, 0.56e-6) == "profile"
    assert best(0.58e-6, 0.56e-6) == "crowning-and-end-relief"  # alike within the tolerances, too
    assert best(0.4e-6, 0.56e-6) == "crowning-and-end-relief"


class Valley:
    """In place of trials: what is left grows with every amount and shrinks with every length, load by load."""

    loads, tip_power = np.array([1.0, 2.0]), 1.0
    slopes = np.array(
        [[1.0, -1e-3, 1.0, -1e-3, 1.0, 1.0, 0.0, 1.0, 1.0], [-1.0, 1e-3, 1.0, -1e-3, -1.0, 1.0, 0.0, -1.0, 1.0]]
    )

    def of_numbers(self, numbers, near=None):
        return SimpleNamespace(peak_to_peak=(self.slopes @ numbers)[None, :])


def test_the_worst_within_tolerances_has_lead_and_tips_at_their_ends_and_nothing_that_is_not_ground():
    gear = SimpleNamespace(base_radius=0.03, face_width=0.02)
    pair = SimpleNamespace(
        x_start=-5e-3, x_end=5e-3, path_length=10e-3, gear=lambda member: gear, face_width=0.02,
        face_height=lambda member: 0.0,
        roll_angle=lambda x, member: (12e-3 + (x if member == "driver" else -x)) / 0.03,
    )  # fmt: skip
    given = FlankTolerance((TipTolerance(5e-6, 0.4e-3, 0.0),) * 2, LeadTolerance(6e-6, 4e-6, 5e-6))
    numbers = np.array([20e-6, 3e-3, 10e-6, 2e-3, 8e-6, 0.0, 0.0, -2e-6, 0.0])
    found = within_tolerances(Valley(), pair, numbers, given)
    off = np.array([5e-6, -0.4e-3, 5e-6, -0.4e-3, 4e-6, 0.0, 0.0, 6e-6, 0.0])
    np.testing.assert_allclose(found[0], numbers + off, atol=1e-12)
    np.testing.assert_allclose(found[1], numbers + off * [-1, -1, 1, 1, -1, 1, 1, -1, 1], atol=1e-12)
    decides = decisive_tolerances(Valley(), pair, numbers, given, np.diag(found @ Valley.slopes.T))
    assert [(one.member, one.number, one.given) for one in decides] == [("driver", "slope", 6e-6)] * 2
    # Without relief what is ground is off from zero, the tips' tolerance as a slope over the whole path.
    off = np.array([5e-6, 10e-3, 5e-6, 10e-3, 4e-6, 0.0, 0.0, 6e-6, 0.0])
    level = Valley()
    level.slopes = Valley.slopes.copy()
    level.slopes[:, [1, 3]] = 0.0
    bare = unrelieved_within(level, pair, numbers, given)
    np.testing.assert_allclose(bare[0], off, atol=1e-12)
    np.testing.assert_allclose(bare[1], off * [-1, 1, 1, 1, -1, 1, 1, -1, 1], atol=1e-12)
    none = FlankTolerance((TipTolerance(0.0, 0.0, 0.0),) * 2)
    np.testing.assert_array_equal(unrelieved_within(level, pair, numbers, none), np.zeros((2, 9)))
    np.testing.assert_allclose(within_tolerances(Valley(), pair, numbers, none), [numbers, numbers], atol=1e-12)


def test_a_lead_chart_has_the_amounts_and_the_band_of_their_tolerances():
    pair = SimpleNamespace(face_width=20e-3, x_start=-5e-3, x_end=5e-3, path_length=10e-3,
                           face_height=lambda member: 1e-3)  # fmt: skip
    allowed = LeadTolerance(6e-6, 4e-6, 5e-6)
    assert lead_chart("a", TIPS, pair, "driver", allowed) is None
    chart = lead_chart("a", replace(TIPS, crowning=3e-6, slope=2e-6), pair, "driver", allowed)
    assert chart.z[[0, -1]] == pytest.approx([-9e-3, 11e-3])
    assert chart.lead[[0, 100, -1]] == pytest.approx([-2e-6, 0.0, -4e-6])
    assert chart.upper[[0, 100, -1]] == pytest.approx([5e-6, 0.0, 3e-6])
    assert chart.lower[[0, 100, -1]] == pytest.approx([-9e-6, 0.0, -11e-6])
    assert chart.words == "crowning -1 to 7 µm (nominal 3), helix slope -4 to 8 µm (nominal 2)"


TIPS = GroundRelief(12.7e-6, 2.5e-3, 18.6e-6, 3e-3)
WITH_LEAD = replace(TIPS, crowning=0.2e-6, slope=0.17e-6)


def test_a_modification_more_has_to_leave_clearly_less():
    alike = left_by(("profile", TIPS, 0.403, 0.015), ("profile-and-lead", WITH_LEAD, 0.402, 0.018))
    assert (alike.best.label, alike.least.label) == ("profile", "profile-and-lead")
    assert [s.modifications for s in alike.states] == [0, 0, 2, 4]
    # More than 2 % is a gain, whatever the error; so is less than that, beyond the error.
    for value, error in ((0.394, 0.015), (0.400, 0.002)):
        clear = left_by(("profile", TIPS, 0.403, error), ("profile-and-lead", WITH_LEAD, value, error))
        assert clear.best is clear.least
        assert clear.best.label == "profile-and-lead"
    # Of equally many modifications the one that leaves least; what would take more is never chosen for more.
    fewer = left_by(
        ("lead", TIPS, 0.4, 0.02), ("profile", TIPS, 0.401, 0.02), ("profile-and-lead", WITH_LEAD, 0.403, 0.02)
    )
    assert fewer.best.label == "lead"


def test_under_several_loads_the_share_of_the_error_counts():
    design = left_by(("profile", TIPS, 0.403, 0.015), ("profile-and-lead", WITH_LEAD, 0.402, 0.018))
    over = replace(design, task=replace(design.task, loads=(600.0, 1200.0)), states=tuple(
        replace(s, over_peak_to_peak=np.array([0.3, 1.0]) * s.judged.peak_to_peak.value) for s in design.states
    ))  # fmt: skip
    assert over.error_of(over.best) == pytest.approx(0.015e-6)
    worse_below = replace(over.states[2], over_peak_to_peak=np.array([0.21e-6, 0.403e-6]))
    assert replace(over, states=(*over.states[:2], worse_below, over.states[3])).best.label == "profile-and-lead"


def sentences(of, design, torque, over=None, robust=None):
    """What is said of a design whose driver has a base radius of 100 mm; pair I."""
    states = {s.label: s for s in design.states}
    over_range = {
        label: SimpleNamespace(
            torque=np.array(torque),
            peak_to_peak=np.array((over or {}).get(label, [0.0])),
            share=None,
            slopes=None,
            named=(len(torque) - 1, 0)[: len(torque)],
        )
        for label in states
    }
    pair = SimpleNamespace(driver=SimpleNamespace(base_radius=0.1))
    data = SimpleNamespace(design=design, over_range=over_range, load=design.task.load, grinding=(),
                           data=SimpleNamespace(pair=pair))  # fmt: skip
    return list(of(SimpleNamespace(name="I", data=data, asked=SimpleNamespace(over=None))))


def test_the_answer_says_where_theory_leaves_more_than_no_relief_and_why_fewer_modifications_are_ground():
    design = left_by(("profile", TIPS, 0.403, 0.015), ("profile-and-lead", WITH_LEAD, 0.402, 0.018))
    exact = replace(design.exact, label=EXACT, judged=SimpleNamespace(peak_to_peak=SimpleNamespace(value=0.04e-6)))
    design = replace(design, states=(design.states[0], exact, *design.states[2:]))
    assert sentences(answer._exact, design, [120.0]) == [
        "Pair I: the exact topography reduces the transmission error from 0.9 to 0.04 µm at 120 N m."
    ]
    over = {UNRELIEVED: [0.353e-6, 0.9e-6], EXACT: [0.386e-6, 0.04e-6]}
    assert sentences(answer._exact, design, [45.0, 120.0], over) == [
        (
            "Pair I: the exact topography reduces the transmission error from 0.9 to 0.04 µm at 120 N m; at "
            "45 N m it is 0.39 µm, more than without relief (0.35 µm)."
        )
    ]
    assert sentences(answer._grind, design, [120.0]) == [
        "Pair I: grind nothing: transmission error 0.9 -> 0.4 µm at 120 N m, peak to peak.",
        (
            "Pair I: profile-and-lead (4 modifications) is only 0.25 % better than profile (2), within the estimated "
            "error."
        ),
    ]


def test_values_of_one_torque_say_where_another_design_is_better_as_drawn_and_worse_within_tolerances():
    """They were scaled to the largest torque: 5.1 µm where the table had 2.6 µm at half of it."""
    design = left_by(("profile", TIPS, 1.3, 0.001), ("profile-and-lead", WITH_LEAD, 1.0, 0.001))
    over = {"profile": ([0.6, 1.3], [1.79, 3.0]), "profile-and-lead": ([0.5, 1.0], [2.62, 3.1])}
    design = replace(design, task=replace(design.task, loads=(600.0, 1200.0)), states=tuple(
        replace(s, over_peak_to_peak=1e-6 * np.array(over[s.label][0]), over_most=1e-6 * np.array(over[s.label][1]))
        if s.label in over else s for s in design.states
    ))  # fmt: skip
    assert (design.best.label, design.least.label) == ("profile", "profile-and-lead")
    found = {label: [1e-6 * x for x in over[label][0]] for label in over} | {UNRELIEVED: [3e-6, 6e-6]}
    drawn = sentences(lambda seen: [answer._drawn(seen, design.best, design.least)], design, [150.0, 300.0], found)
    within = sentences(lambda seen: [answer._within(seen, design.best, design.least)], design, [150.0, 300.0], found)
    assert drawn == [" (1, not 1.3 µm at 300 N m)"]
    assert within == [" (at most 2.6, not 1.8 µm at 150 N m)"]
