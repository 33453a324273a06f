"""How a design of loaded flanks goes on from step to step: every step by itself is tested elsewhere."""

import itertools
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks import flank_design
from fegear.design.flanks.flank_design import EXACT, ROBUST, UNRELIEVED, FlankDesignTask, design_flanks
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import FAMILIES
from fegear.design.flanks.scatter import NOMINAL, Scatter

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
            te=te, peak_to_peak=np.full((1, np.size(self.loads)), 1.0 / next(TRIED)), gap=gap, of=self
        )


@dataclass(frozen=True)
class Best:
    """In place of the best of a family."""

    family: str
    relief: GroundRelief
    valleys: tuple
    made: tuple


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
        return SimpleNamespace(name=name, roll=np.array(roll), x=np.array([1.0, 2.0]), z=np.array([0.1, 0.2]),
                               present=np.array([True, False]))  # fmt: skip

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

    def best(trials, family, grid, force, most, starts, scan):
        calls["best"].append((trials, family, grid, force, most, tuple(starts), scan))
        number = 1e-6 * (1 + list(FAMILIES).index(family))
        tips, leads = (number, 1e-3) if "profile" in family else (0.0, 0.0), number if "profile" not in family else 0.0
        valleys = tuple(GroundRelief(*(k * v for v in tips), crowning=k * leads) for k in (1, 2))
        return Best(family, valleys[0], valleys, ("best", family, trials.scatter.over_face.size))

    def led_on(trials, one, grid, start, most):
        calls["led_on"].append((trials, one, grid, start, most))
        return replace(one, made=("led on", *one.made))

    put("best_of_family", best)
    put("led_on", led_on)
    judged = []

    def judge(gap):
        judged.append(gap(lines("judged")))
        return SimpleNamespace(peak_to_peak=SimpleNamespace(value=10.0 - len(judged)))

    plain = Trials(
        pair, SimpleNamespace(lines=lines("plain", START + PITCH * np.arange(3) / 3.0)), "apart", np.array([1.0])
    )
    put("flank_judge", lambda *given: calls.update(judge=given) or SimpleNamespace(judge=judge, plain=plain))
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
    assert told == pytest.approx([0.3, *(0.3 + 0.4 * k / len(FAMILIES) for k in range(1, len(FAMILIES) + 1)), 0.8])
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
    assert found.best.label != ROBUST


def test_only_families_that_are_asked_for_are_searched_on_a_grid_that_is_given(steps):
    first, last = next(iter(FAMILIES)), list(FAMILIES)[-1]
    found, told = designed(steps, families=(last, first), grid="own")
    assert list(found.found) == [first, last]
    assert found.grid == "own"
    assert "grid" not in steps.calls
    assert told == pytest.approx([0.3, 0.5, 0.7, 0.8])
    none, told = designed(steps, families=(), scatter=Scatter(np.array([-1e-6, 1e-6]), np.array([0.5, 0.5])))
    assert (none.found, told) == ({}, [0.3, 0.8])
