"""Tip reliefs of teeth with a width as results: what is searched and charted with what, and how it is shown."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.fourier import effective_error, fourier_series, panels
from fegear.design.flanks import tip_bench, tip_chart, tip_design, tip_search
from fegear.design.flanks.flank_tolerance import end_reliefs
from fegear.design.flanks.forms import GroundRelief
from fegear.design.load_range import LoadRange
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.engine.sheet.seen import Seen
from fegear.engine.stage import Forecast, Task
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.relief import relief_chart_over_face as charted
from fegear.results.relief import relief_over_face as designed
from fegear.results.relief.relief_over_face_data import TipReliefData, TipReliefInputs, TipsShown
from fegear.results.relief.relief_over_face_sheet import RELIEF_OVER_FACE_SHEET

RACK = BasicRack(1.0, 1.25, 0.38)
GEAR = Gear(Tooth(24, RACK), 2e-3, 0.01, face_width=0.02)
PAIR = GearPair(GEAR, replace(GEAR, tooth=Tooth(37, RACK)))
PRESENT = SimpleNamespace(name="of the driver"), SimpleNamespace(name="of the driven gear")


@dataclass(frozen=True)
class Trials:
    """Flanks on which what is pressed leaves its mean, times the load in kN."""

    loads: np.ndarray
    apart: object = None
    weights: object = None
    tip_power: float = 1.0
    points: object = "points"
    pair: object = PAIR
    made: tuple = ()

    @property
    def known(self):
        lines = SimpleNamespace(
            x=np.zeros((3, 2)), present=np.array([[True, False]] * 3),
            roll_angle=lambda pair, member: {"driver": 2.0, "driven": 3.0}[member],
        )  # fmt: skip
        return SimpleNamespace(lines=lines)

    @property
    def more(self):
        return replace(self, made=(*self.made, "more"))

    def over(self, over, power, apart):
        return replace(self, loads=np.array(over.loads), tip_power=power, made=(*self.made, over, apart))

    def gap(self, numbers):
        return np.full((3, 2), float(np.sum(numbers)) * self.tip_power)

    def of_gap(self, gap):
        return SimpleNamespace(te=1e-3 * (7.0 + np.mean(gap)) * np.linspace(0.0, 1.0, 5)[None, :, None] * self.loads)

    def of_numbers(self, numbers, near=None):
        return SimpleNamespace(peak_to_peak=1e-3 * np.sum(numbers) * self.loads[None])


@pytest.fixture
def bench(monkeypatch):
    """A loaded pair, and the design's tools made up; what they were asked for, in order."""
    asked = []
    apart = SimpleNamespace(
        at=lambda pair, lines, loads: ("apart", tuple(np.asarray(loads).tolist())) if pair is PAIR else None
    )
    gaps = SimpleNamespace(driver_relief=PRESENT[0], driven_relief=PRESENT[1], shafts=SimpleNamespace(given="bent"))
    flanks = SimpleNamespace(pair=PAIR)
    found = SimpleNamespace(
        pair=PAIR, flanks=flanks, known="known", gaps=gaps, nominal=500.0, loads=(900.0, 300.0, 600.0)
    )
    for place in (charted, designed):
        monkeypatch.setattr(
            place, "loaded_flanks", lambda upstream, name: asked.append((name, type(upstream))) or found
        )
    monkeypatch.setattr(tip_bench, "without_tips", lambda given: apart if given is gaps else None)
    monkeypatch.setattr(
        tip_bench, "tip_trials",
        lambda given, known, free, load: asked.append((given is flanks, known, free is apart, load))
        or Trials(np.array([load]), free),
    )  # fmt: skip
    best = SimpleNamespace(relief=GroundRelief(2.0, 3e-3, 4.0, 2e-3, tip_power=2.0), candidates=44, exact=5)
    monkeypatch.setattr(tip_search, "best_tips", lambda trials: asked.append(("best", trials.made[:1])) or best)
    return SimpleNamespace(asked=asked, found=found, apart=apart, best=best, fractions=[])


def work(bench):
    return SimpleNamespace(progress=bench.fractions.append)


# ---- chart -----------------------------------------------------------------------------------------------------------
@pytest.fixture
def chart(bench, monkeypatch):
    made = []

    def tip_chart_(trials, quick, points, amounts, lengths):
        made.append(SimpleNamespace(
            trials=trials, quick=quick, points=points, amounts=np.asarray(amounts), lengths=np.asarray(lengths),
            finer=lambda: ("finer amounts", "finer lengths"),
        ))  # fmt: skip
        return made[-1]

    monkeypatch.setattr(tip_chart, "tip_chart", tip_chart_)
    monkeypatch.setattr(tip_chart, "quick_at_loads", lambda trials: ("quick", trials.made))
    monkeypatch.setattr(tip_chart, "chart_error", lambda chart, trials: 0.25 if chart is made[0] else None)

    def charted_of(**part):
        given = {"loads": None, "shape": "linear", "amounts": None, "amounts_over_delta": None, "lengths": None} | part
        inputs = SimpleNamespace(name="I", part=SimpleNamespace(**given), over=part.get("over"))
        return charted._compute_chart(inputs, {}, work(bench)), made

    return charted_of


def test_a_chart_has_loads_in_their_order_and_amounts_in_parts_of_the_largest_error(chart, bench):
    found, (whole, finer) = chart()
    assert bench.asked[:2] == [("I", dict), (True, "known", True, 500.0)]
    assert whole.trials.made == (LoadRange((300.0, 600.0, 900.0)), bench.apart, "more")
    assert whole.trials.tip_power == 1.0
    for one in (whole, finer):
        assert (one.trials, one.points, one.quick) == (whole.trials, "points", ("quick", whole.trials.made))
    # The error of flanks pressed by 500 N without relief: 3.5 m here, and 0.1 to 1.6 of it.
    assert found.delta == pytest.approx(7e-3 * 500.0)
    assert whole.amounts == pytest.approx(3.5 * np.arange(1, 17) * 0.1)
    assert whole.lengths == pytest.approx(0.05 * np.arange(1, 27))
    assert (finer.amounts.item(), finer.lengths.item()) == ("finer amounts", "finer lengths")
    # The best reliefs leave their sum times the largest load.
    assert found.optimum == found.left("peak_to_peak") == pytest.approx(1e-3 * (6.0 + 5e-3) * 900.0)
    assert found.reliefs == PRESENT
    assert dict(found.searched) == {"candidates": 44, "loaded_exactly": 5, "screening_error": 0.25}
    assert (found.chart, found.finer) == (whole, finer)
    assert bench.fractions == sorted(bench.fractions)
    assert 0.0 < bench.fractions[0] <= bench.fractions[-1] < 1.0
    driver, driven = found.tips
    assert ((driver.member, driver.relief), (driven.member, driven.relief)) == tuple(
        zip(("driver", "driven"), end_reliefs(bench.best.relief.numbers, PAIR, 2.0), strict=True)
    )
    assert (driver.relief.power, driver.relief.amount, driven.relief.amount) == (2.0, 2.0, 4.0)


@pytest.mark.parametrize(
    ("part", "amounts", "lengths", "loads", "power"),
    [
        ({"amounts": [3.0, 1.0], "lengths": [0.8, 0.2]}, [1.0, 3.0], [0.2, 0.8], (300.0, 600.0, 900.0), 1.0),
        ({"amounts_over_delta": [1.0, 0.5], "loads": [200.0, 100.0]}, [1.75, 3.5], None, (100.0, 200.0), 1.0),
        ({"shape": "parabolic", "over": LoadRange((50.0, 70.0))}, None, None, (50.0, 70.0), 2.0),
    ],
)  # fmt: skip
def test_a_chart_is_of_what_is_given(chart, part, amounts, lengths, loads, power):
    _, (whole, _) = chart(**part)
    assert whole.trials.loads.tolist() == list(loads)
    assert whole.trials.tip_power == power
    assert whole.amounts.tolist() == pytest.approx(amounts or 3.5 * np.linspace(0.1, 1.6, 16))
    assert whole.lengths.tolist() == pytest.approx(lengths or np.linspace(0.05, 1.3, 26))


def test_trials_under_one_load_have_its_gaps_and_weigh_nothing(bench):
    trials = Trials(np.array([1.0, 2.0]), "before", (1.0, 2.0))
    one = charted.tip_trials_at(trials, 40.0, bench.apart)
    assert (one.loads.tolist(), one.apart, one.weights) == ([40.0], ("apart", (40.0,)), None)


# ---- robustness ------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("own", [True, False])
def test_every_relief_is_tried_under_all_loads_and_at_last_under_that_of_the_design(bench, monkeypatch, own):
    tried = []
    monkeypatch.setattr(
        tip_chart, "tip_robustness",
        lambda trials, removal, factors, spacing, depth: tried.append((trials, removal, factors, spacing, depth))
        or len(tried),
    )  # fmt: skip
    for relief, factor in zip(PRESENT, (10.0, 100.0), strict=True):
        relief.removal = lambda roll, factor=factor: factor * roll
    best = {"linear": SimpleNamespace(relief=GroundRelief(1.0)),
            "parabolic": SimpleNamespace(relief=GroundRelief(5.0, tip_power=2.0))}  # fmt: skip
    design = SimpleNamespace(task=SimpleNamespace(load=200.0, over=None), found=best, shapes=["parabolic", "linear"])
    upstream = {Task("relief-chart-over-face", "I"): "a chart",
                Task("relief-over-face", "I"): SimpleNamespace(design=design)}  # fmt: skip
    part = SimpleNamespace(load_factors=[0.5, 1.0, 2.0], spacing_errors=[0.0, 3e-6], relief_errors=[-0.3], given=())
    inputs = SimpleNamespace(name="I", part=part, own_relief=own, base_radius=0.02)
    found = charted._compute_robustness(inputs, upstream, work(bench))
    labels = ["linear tip relief", "parabolic tip relief", *["relief of the case"] * own, "no relief"]
    assert dict(found.candidates) == {label: number for number, label in enumerate(labels, start=1)}
    assert (found.recommended, found.torque) == ("parabolic tip relief", 200.0 * 0.02)
    assert bench.asked == [("I", dict), (True, "known", True, 200.0)]
    for trials, _, factors, spacing, depth in tried:
        assert trials.loads.tolist() == [100.0, 200.0, 400.0, 200.0]
        assert trials.apart == ("apart", (100.0, 200.0, 400.0, 200.0))
        assert (factors, spacing, depth) == ([0.5, 1.0, 2.0], [0.0, 3e-6], [-0.3])
    removals = [removal for _, removal, *_ in tried]
    assert [one[0, 0] for one in removals] == [1.0, 10.0, *[10.0 * 2.0 + 100.0 * 3.0] * own, 0.0]
    if own:
        assert removals[2][:, 1].tolist() == [0.0, 0.0, 0.0]  # where no flank is
    assert bench.fractions == pytest.approx(np.arange(1, 4 + own) / (3 + own))


# ---- forecasts -------------------------------------------------------------------------------------------------------
@pytest.fixture
def scene(monkeypatch):
    asked = SimpleNamespace(
        panel_count=12, placed=SimpleNamespace(contact_ratio=1.5, total_contact_ratio=2.0),
        face=SimpleNamespace(positions=9),
    )  # fmt: skip
    for place in (charted, designed):
        monkeypatch.setattr(
            place, "pair_spec", lambda scene, name, over_face: asked if over_face and name == "I" else None
        )
    monkeypatch.setattr(charted.forecasts, "loads", lambda scene, name: 2 if name == "I" else None)
    made = SimpleNamespace(asked=asked, robustness=None)
    made.case = SimpleNamespace(design=None, robustness=None)
    return made


def chart_part(**given):
    plain = {"amounts": None, "amounts_over_delta": None, "lengths": None, "loads": None}
    return SimpleNamespace(chart=SimpleNamespace(**plain | given), robustness=None)


def test_a_chart_takes_as_long_as_its_reliefs_and_loads_say(scene, monkeypatch):
    monkeypatch.setattr(
        charted, "over_face_forecast",
        lambda scene, name, shapes, loads: Forecast({}, 10.0 * shapes * loads),
    )  # fmt: skip
    plain = charted._chart_forecast(scene, "I")
    assert plain.settings == {"candidates": 16 * 26, "loads": 2}
    assert plain.seconds == pytest.approx(20.0 + 1e-3 * (16 * 26 + 2500) * 2)
    for part, size, loads in (
        (chart_part(amounts=[1.0, 2.0]), 2 * 26, 2), (chart_part(amounts_over_delta=[1.0] * 3), 3 * 26, 2),
        (chart_part(lengths=[1.0] * 5, loads=[1.0] * 7), 16 * 5, 7),
    ):  # fmt: skip
        scene.case.design = part
        found = charted._chart_forecast(scene, "I")
        assert found.settings == {"candidates": size, "loads": loads}
        assert found.seconds == pytest.approx(10.0 * loads + 1e-3 * (size + 2500) * loads)
    scene.asked.panel_count = 24
    assert charted._chart_forecast(scene, "I").seconds - 70.0 == pytest.approx(2.0 * (found.seconds - 70.0))


def test_robustness_takes_as_long_as_its_combinations(scene, monkeypatch):
    monkeypatch.setattr(
        charted, "over_face_forecast",
        lambda scene, name, shapes, loads: Forecast({}, 10.0 if (shapes, loads) == (0.0, 1) else None),
    )  # fmt: skip
    assert charted._robustness_forecast(scene, "I").settings == {"deviations": 15}
    scene.case.design = SimpleNamespace(
        robustness=SimpleNamespace(load_factors=[1.0] * 2, spacing_errors=[0.0] * 3, relief_errors=[0.0] * 4)
    )
    found = charted._robustness_forecast(scene, "I")
    assert found.settings == {"deviations": 24}
    assert found.seconds == pytest.approx(3.0 + 0.024 * 24)


def test_draws_inside_tolerances_alone_ask_for_no_design(scene, monkeypatch):
    monkeypatch.setattr(charted, "pairs_over_face", lambda scene: ("I", "J"))
    for robustness, design, pairs in ((None, None, ("I", "J")), ("r", "d", ("I", "J")), ("r", None, ())):
        scene.case.robustness, scene.case.design = robustness, design
        assert charted._robustness_pairs(scene) == pairs


def test_a_search_takes_longer_with_shapes_loads_and_stations(scene, monkeypatch):
    lines = designed.over_face_forecast(scene, "I", 0.0, 5)
    assert lines.settings == {"positions": 9, "panels": 12}
    one = designed.over_face_forecast(scene, "I", 1.0, 1).seconds - lines.seconds
    assert one == pytest.approx(7.0 * (30.0 / 34.0) ** 1.5)  # 12 panels on two and a half pairs of teeth
    assert lines.seconds == pytest.approx(0.02 * 240.0 * 3.0 * 30.0 / 34.0)
    assert designed.over_face_forecast(scene, "I", 3.0, 2).seconds - lines.seconds == pytest.approx(6.0 * one)
    monkeypatch.setattr(designed, "design_part", lambda scene: SimpleNamespace(grind=["linear", "parabolic"]))
    for over, loads in ((None, 1), (LoadRange((1.0, 2.0, 3.0)), 4)):
        monkeypatch.setattr(designed, "design_range", lambda scene, name, over=over: over)
        assert designed._forecast(scene, "I").seconds - lines.seconds == pytest.approx(2.0 * loads * one)


# ---- design ----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("load", "present"), [(None, True), (750.0, False)])
def test_a_design_is_made_of_the_loaded_pair_and_the_coarser_gears(bench, monkeypatch, load, present):
    asked = {}
    bodies = {"p": SimpleNamespace(fine="fine p", coarse="coarse p"), "w": SimpleNamespace(fine="fine w", coarse=None)}
    monkeypatch.setattr(designed, "solid_solution_of", lambda upstream, gear: bodies[gear])

    def design_tips(flanks, coarse, known, gaps, task, **more):
        asked.update(flanks=flanks, coarse=coarse, known=known, gaps=gaps, task=task, **more)
        return "design"

    monkeypatch.setattr(tip_design, "design_tips", design_tips)
    part = SimpleNamespace(load=load, grind=["linear"])
    tolerances = (TipTolerance(1e-6, 1e-4, 0.0), TipTolerance(2e-6, 1e-4, 0.0))
    inputs = TipReliefInputs(part, "over", tolerances, present, "I", {"driver": "p", "driven": "w"})
    run = work(bench)
    found = designed._compute(inputs, {}, run)
    assert found == TipReliefData(PAIR, "design", PRESENT if present else None, "bent")
    assert asked["coarse"] == {"driver": "coarse p", "driven": "fine w"}
    assert (asked["known"], asked["present"], asked["progress"]) == ("known", present, run.progress)
    assert asked["flanks"] is bench.found.flanks
    assert asked["gaps"] is bench.found.gaps
    task = asked["task"]
    assert (task.load, task.over, task.grind, task.map_loads) == (
        load or 500.0,
        "over",
        ("linear",),
        (900.0, 300.0, 600.0),
    )
    assert task.tolerance.tips == tolerances
    upstream = {Task("loaded-flanks", "I"): 1, Task("relief-over-face", "I"): 2}
    assert designed.relief_data(upstream) == 2


# ---- what is shown ---------------------------------------------------------------------------------------------------
POINTS = panels(0.0, 1.0)


def read(height, loads):
    """A wave as high as the load says; errors of a hundredth of it."""
    te = height * np.outer(np.sin(2.0 * np.pi * POINTS.x) + 3.0, loads)
    series = fourier_series(POINTS, te, 12)
    return SimpleNamespace(
        te=te, series=series, peak_to_peak=np.ptp(te, axis=0), error=1e-2 * height * np.asarray(loads)
    )


@dataclass
class Design:
    over: object = None
    grind: tuple = ("linear", "parabolic")
    loads: tuple = (100.0, 200.0, 400.0)
    proven: dict = field(default_factory=lambda: {"linear": True, "parabolic": True})

    def shown(self):
        task = SimpleNamespace(load=200.0, over=self.over, loads=self.loads, tolerance=None)
        left = {"no relief": read(3e-8, self.loads), "parabolic tip relief": read(2e-8, self.loads),
                "linear tip relief": read(1e-8, self.loads)}  # fmt: skip
        found = {
            shape: SimpleNamespace(
                relief=GroundRelief(*(1e-6 * k * v for v in (10.0, 1e3, 20.0, 2e3)), tip_power=power),
                proven=self.proven[shape],
            )
            for k, (shape, power) in enumerate((("parabolic", 2.0), ("linear", 1.0)), start=1)
        }  # fmt: skip
        design = SimpleNamespace(
            task=task, points=POINTS, found=found, left=left, shapes=["linear", "parabolic"],
            most={"linear": np.array([5.0, 6.0, 7.0]), "parabolic": np.array([8.0, 9.0, 10.0])}, finer=2,
            unrelieved_most=None, decisive=("a", None, "c"),
        )  # fmt: skip
        tolerances = (TipTolerance(1e-6, 1e-4, 0.0), TipTolerance(3e-6, 1e-4, 0.0))
        asked = TipReliefInputs(None, self.over, tolerances, False, "I", {"driver": "p", "driven": "w"})
        return TipsShown(TipReliefData(PAIR, design, None, False), asked)


def test_what_each_relief_leaves_at_the_design_load_and_on_the_map():
    shown = Design().shown()
    assert shown.load == 200.0
    assert list(shown.left) == ["no relief", "parabolic tip relief", "linear tip relief"]
    one = shown.left["linear tip relief"]
    assert one.peak_to_peak == pytest.approx(1e-8 * 200.0 * np.ptp(np.sin(2.0 * np.pi * POINTS.x)))
    assert one.error == pytest.approx(1e-2 * 1e-8 * 200.0)
    wave = one.minus_mean
    assert np.average(wave, weights=POINTS.weights) == pytest.approx(0.0, abs=1e-6 * np.abs(wave).max())
    assert np.ptp(wave) == pytest.approx(one.peak_to_peak)
    assert one.effective == pytest.approx(float(effective_error(one.read.series)[1]))
    assert one.effective == pytest.approx(2e-8 * 200.0, rel=1e-6)  # of one wave twice its amplitude
    assert one.x.tolist() == POINTS.x.tolist()
    assert one.words == f"{one.peak_to_peak * 1e6:.3g} µm"
    assert replace(one, read=read(1e-16, (100.0, 200.0, 400.0))).words == "0"
    assert one.map.load.tolist() == [100.0, 200.0, 400.0]
    assert one.map.transmission_error.shape == one.map_error.shape == (3, POINTS.x.size)
    assert one.map.peak_to_peak == pytest.approx(one.peak_to_peak * np.array([0.5, 1.0, 2.0]))
    assert (one.map_error / one.map.peak_to_peak[:, None]).std() < 1e-12  # both grow with the load
    assert (one.map.at, one.map.word, one.map.over, one.map.nearest) == (200.0, "design", (), (1,))
    assert list(shown.maps) == ["linear tip relief", "parabolic tip relief", "no relief"]
    assert all(one is shown.left[label].map for label, one in shown.maps.items())
    assert shown.unproven == ""
    assert Design(proven={"linear": False, "parabolic": True}).shown().unproven == "linear"


@pytest.mark.parametrize(
    ("over", "loads", "weights", "ends"),
    [
        (None, [100.0, 200.0, 400.0], [0.0, 1.0, 0.0], (1,)),
        (LoadRange((100.0, 400.0)), [100.0, 400.0], [1.0, 1.0], (1, 0)),
        (LoadRange((100.0, 400.0), (3.0, 1.5)), [100.0, 400.0], [1.0, 0.5], (1, 0)),
    ],
)
def test_a_range_has_its_own_loads_of_those_of_the_map(over, loads, weights, ends):
    shown = Design(over).shown()
    assert shown.ends == ends
    for label, found in shown.over_range.items():
        chosen = [shown.design.task.loads.index(one) for one in loads]
        assert found.load.tolist() == loads
        assert found.torque == pytest.approx(np.array(loads) * PAIR.driver.base_radius)
        assert found.weight == pytest.approx(weights)
        left = shown.design.left[label]
        assert found.peak_to_peak == pytest.approx(left.peak_to_peak[chosen])
        assert found.first == pytest.approx(found.peak_to_peak / 2.0, rel=0.02)
        assert found.errors == pytest.approx(left.error[chosen])
        of_best = label == "linear tip relief"
        assert found.finer == (2 if of_best else 0)
        assert found.decisive == (tuple(shown.design.decisive[k] for k in chosen) if of_best else ())
        if label == "no relief":
            assert found.most is None
        else:
            assert found.most.tolist() == [(5.0 if of_best else 8.0) + k for k in chosen]
    (map_,) = {one.map.over for one in shown.left.values()}
    assert map_ == (() if over is None else (100.0, 400.0))


def test_tips_rows_and_charts_are_of_both_gears_the_best_shape_first():
    shown = Design().shown()
    assert [(one.shape, one.member) for one in shown.tips] == [
        ("linear", "driver"), ("linear", "driven"), ("parabolic", "driver"), ("parabolic", "driven")
    ]  # fmt: skip
    assert [one.relief.amount * 1e6 for one in shown.tips] == pytest.approx([20.0, 40.0, 10.0, 20.0])
    assert [one.relief.power for one in shown.tips] == [1.0, 1.0, 2.0, 2.0]
    rows = [(row.gear, row.design, row.amount * 1e6, row.amount_tolerance * 1e6) for row in shown.grinding]
    assert [(gear, design) for gear, design, *_ in rows] == [
        (gear, f"{shape} tip relief") for shape in ("linear", "parabolic") for gear in ("p", "w")
    ]
    assert [one for *_, one, _ in rows] == pytest.approx([20.0, 40.0, 10.0, 20.0])
    assert [one for *_, one in rows] == pytest.approx([1.0, 3.0, 1.0, 3.0])
    charts = shown.profile_charts
    assert list(charts) == ["linear tip relief", "parabolic tip relief"]
    for (label, both), (one, other) in zip(charts.items(), ((20.0, 40.0), (10.0, 20.0)), strict=True):
        assert [chart.gear for chart in both] == ["p", "w"], label
        assert [-chart.profile.min() * 1e6 for chart in both] == pytest.approx([one, other])
        assert [(chart.profile.min() - chart.lower.min()) * 1e6 for chart in both] == pytest.approx([1.0, 3.0])
        assert all(chart.present is None for chart in both)
    present = (
        SimpleNamespace(removal=lambda roll: 0.0 * roll + 7.0),
        SimpleNamespace(removal=lambda roll: 0.0 * roll + 8.0),
    )
    now = replace(shown, data=replace(shown.data, present=present)).profile_charts
    assert [chart.present.max() for both in now.values() for chart in both] == [-7.0, -8.0, -7.0, -8.0]


def test_figures_and_tables_draw_what_each_relief_leaves():
    shown = Design().shown()
    seen = Seen(shown, shown.asked, "I")
    figures = {one.name: one.made() for chart in RELIEF_OVER_FACE_SHEET.figures for one in chart.figures(seen)}
    (panel,) = figures["relief_candidates_I"].panels
    for curve, (label, one) in zip(panel.items, shown.left.items(), strict=True):
        np.testing.assert_allclose(curve.x, 1e3 * one.x)
        np.testing.assert_allclose(curve.y, 1e6 * one.minus_mean)
        assert curve.name == f"{label}: {one.words} peak to peak"
    views = figures["harris_map_I"].views
    assert [view.label for view in views] == list(shown.maps)
    for view, one in zip(views, shown.maps.values(), strict=True):
        curves = [item for item in view.panels[0].items if len(item.y) == POINTS.x.size]
        assert len(curves) == 3
        for curve, te in zip(curves, one.transmission_error, strict=True):
            np.testing.assert_allclose(curve.y, 1e6 * te)
    tables = {table.name: table for one in RELIEF_OVER_FACE_SHEET.tables for table in one.tables(seen)}
    columns = {column.name: column.si for column in tables["harris_map_I"].columns}
    for label, one in shown.left.items():
        name = f"te_{label.replace(' ', '_')}"
        assert columns[name].tolist() == one.map.transmission_error.ravel().tolist()
        assert columns[f"{name}_error"].tolist() == one.map_error.ravel().tolist()
    numbers = {value.name: value for one in RELIEF_OVER_FACE_SHEET.values for value in one.values(seen)}
    best = shown.left["linear tip relief"]
    for name, value in (("te_peak_to_peak", best.peak_to_peak), ("te_effective", best.effective)):
        one = numbers[f"I.{name}.linear_tip_relief"]
        assert (one.si, one.si_error) == (pytest.approx(value), pytest.approx(best.error))
    settings = RELIEF_OVER_FACE_SHEET.settings
    for number, one in enumerate(shown.design.found.values(), start=1):
        one.candidates, one.exact = 10 * number, number
    assert (settings["combinations"](seen), settings["loaded_exactly"](seen)) == (30, 3)
