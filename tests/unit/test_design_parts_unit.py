"""Parts of designs and of what they show: charts at each load, candidates, forecasts, straight steps; data made up."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.design.flanks.search import _Straight
from fegear.design.held_relief import Robustness
from fegear.engine.stage import Task
from fegear.geometry.relief import UNMODIFIED
from fegear.results.helical.pair_forced_response import _harmonics
from fegear.results.relief import tolerance_benches
from fegear.results.relief.relief_chart import ReliefChartData
from fegear.results.relief.relief_robustness import (
    RobustnessData,
    RobustnessInputs,
    _compute_robustness,
    _worst_in_words,
)


# ---- charts ----------------------------------------------------------------------------------------------------------
def test_a_chart_is_shown_at_each_load_the_nominal_one_first_and_no_best_length_stands_at_its_ends():
    lengths = np.array([0.2, 0.6, 1.0])
    best = np.array([[0.2, 0.6, 0.7], [0.5, 1.0, 0.9]])
    chart = SimpleNamespace(
        lengths=lengths, loads=np.array([100.0, 300.0, 200.0]), effective_error=np.arange(18.0).reshape(2, 3, 3),
        lowest=lambda values: best[:, [int(values[0, 0, 0])]], worst=lambda: np.full((2, 3), 1.0),
    )  # fmt: skip
    data = ReliefChartData(SimpleNamespace(nominal=200.0), chart, None, None, 1e-6)
    data.__dict__["marked"] = "marked"  # no finer chart here
    found = data.loads
    assert [one.label for one in found] == [
        "200 N (nominal)", "100 N", "300 N", "all loads, maximum relative to load",
    ]  # fmt: skip
    assert {one.marked for one in found} == {"marked"}
    np.testing.assert_array_equal(found[3].effective_error, np.full((2, 3), 1.0))
    np.testing.assert_array_equal(found[3].best_lengths, [0.6, np.nan])
    for one, k in zip(found, (2, 0, 1), strict=False):
        assert one.chart is chart
        np.testing.assert_array_equal(one.effective_error, chart.effective_error[:, :, k])
    np.testing.assert_array_equal(found[0].best_lengths, [0.7, 0.9])
    np.testing.assert_array_equal(found[1].best_lengths, [np.nan, 0.5])
    np.testing.assert_array_equal(found[2].best_lengths, [0.6, np.nan])
    assert data.limits == (0.0, 17.0)


@dataclass(frozen=True)
class Engaged:
    driver_spacing: object = "of the case"
    driven_spacing: object = "of the case"
    driver_relief: object = "best"
    driven_relief: object = "best"


@pytest.mark.parametrize(
    ("own", "given", "over", "factors"),
    [(False, (), None, "factors"), (True, (), None, "factors"), (False, (), (35.0, 70.0, 140.0), [0.5, 1.0, 2.0]),
     (False, ("load_factors",), (35.0, 70.0), "factors")],
)  # fmt: skip
def test_every_candidate_is_held_against_the_same_loads_and_errors(own, given, over, factors, monkeypatch):
    """Those of the range that the relief was designed for, where the case names no others."""
    asked, told = [], []

    def robustness(state, load, *given):
        asked.append((state, load, *given))
        return f"of {len(asked)}"

    monkeypatch.setattr("fegear.design.held_relief.robustness", robustness)
    ground = {shape: SimpleNamespace(applied=lambda of, shape=shape: (shape, of)) for shape in ("linear", "parabolic")}
    designed = SimpleNamespace(
        design=SimpleNamespace(
            designed=Engaged(),
            ground=ground,
            shapes=["parabolic", "linear"],
            task=SimpleNamespace(load=70.0, over=None if over is None else SimpleNamespace(loads=over), film=None),
            te={},  # nothing is known of the design load, so that the grid's own value stays
        ),
        pair=SimpleNamespace(engagement=Engaged()),
    )
    part = SimpleNamespace(given=given, load_factors="factors", spacing_errors="spacing", relief_errors="errors")
    upstream = {Task(name, "I"): found for name, found in (("loaded-pair", None), ("relief", designed))}
    data = _compute_robustness(
        RobustnessInputs(part, "metric", own, 0.03, "I"), upstream, SimpleNamespace(progress=told.append)
    )
    names = ["designed", "linear tip relief", "parabolic tip relief", *(["relief of the case"] if own else []),
             "no relief"]  # fmt: skip
    assert data.recommended == "parabolic tip relief"
    assert data.torque == pytest.approx(2.1)  # 70 N at 30 mm
    assert list(data.candidates) == names
    assert list(data.candidates.values()) == [f"of {k + 1}" for k in range(len(names))]
    assert [one[0] for one in asked[:3]] == [Engaged(), ("linear", Engaged()), ("parabolic", Engaged())]
    assert asked[-1][0] == Engaged(driver_relief=UNMODIFIED, driven_relief=UNMODIFIED)
    for one in asked:
        assert one[1:] == (70.0, factors, "spacing", "errors", "metric")
    if own:  # with its relief, but without the pitch errors that the candidates do not have either
        assert asked[3][0].driver_spacing.size == asked[3][0].driven_spacing.size == 0
    assert told == pytest.approx([(k + 1) / len(names) for k in range(len(names))])


def held(nominal, *values):
    """Excitation of two loads, two pitch deviations and one depth [um]."""
    return Robustness(
        np.array([0.5, 1.0]), np.array([0.0, 4e-6]), np.zeros(1), 1e-6 * np.reshape(values, (2, 2, 1)), nominal * 1e-6
    )


def test_the_answer_is_about_the_relief_to_grind_beside_no_relief():
    """It was about the relief with the smallest maximum, whatever the design says to grind; loads were factors."""
    none = held(3.0, 1.5, 5.0, 3.0, 8.0)
    every = {
        "linear tip relief": held(0.9, 1.2, 4.0, 0.9, 6.0), "parabolic tip relief": held(0.8, 1.6, 4.0, 0.8, 7.0),
        "no relief": none,
    }  # fmt: skip

    def said(label):
        return list(_worst_in_words(SimpleNamespace(name="I", data=RobustnessData(every, label, 260.0))))

    first, *rest = said("parabolic tip relief")
    assert first == (
        "Pair I, parabolic tip relief: 0.8 µm at 260 N m without deviations; with those of design.robustness (130 to "
        "260 N m, pitch deviation 0 to 4 µm, amount as designed) at most 7 µm (260 N m, pitch deviation 4 µm, amount "
        "as designed). Without relief 3 and at most 8 µm."
    )
    assert rest == [
        (
            "Pair I, parabolic tip relief: more than without relief in 1 of 4 combinations, e.g. 1.6, not 1.5 µm "
            "(130 N m, pitch deviation 0 µm, amount as designed)."
        ),
        "Pair I: linear tip relief gives the smallest maximum, 6 µm.",
    ]
    assert said("linear tip relief")[1:] == [
        "Pair I, linear tip relief: less than without relief in all 4 combinations."
    ]


# ---- forecasts -------------------------------------------------------------------------------------------------------
def test_draws_over_the_face_are_forecast_by_positions_panels_and_centre_distances(monkeypatch):
    part = SimpleNamespace(draws=250, reliefs=None)
    monkeypatch.setattr(tolerance_benches, "tolerance_part", lambda scene: part)
    spec = SimpleNamespace(face=SimpleNamespace(positions=8), panel_count=10)
    monkeypatch.setattr(tolerance_benches, "pair_spec", lambda scene, name: spec if name == "I" else None)
    limits = SimpleNamespace(centre_distance=0.0)
    monkeypatch.setattr(tolerance_benches, "limits_of", lambda scene, name, kinds: limits)
    scene = SimpleNamespace(wide_pairs={"I"}, case=SimpleNamespace(effects=SimpleNamespace(corner_contact=False)))
    found = tolerance_benches.forecast_draws(scene, "I")
    assert found.seconds == pytest.approx(8 * 100 * 6e-4 + 250 * 8 * 0.001)
    assert found.settings == {"draws": 250, "chunks": 3}
    limits.centre_distance = 1e-5
    found = tolerance_benches.forecast_draws(scene, "I")
    assert found.seconds == pytest.approx(3 * 8 * 100 * 6e-4 + 2 * 250 * 8 * 0.001)
    plane = tolerance_benches.forecast_draws(scene, "II")
    assert (plane.settings["chunks"], plane.seconds) == (10, pytest.approx(250 * 0.005))
    part.reliefs = SimpleNamespace(draws=20)
    scene.case.effects.corner_contact = True
    searched = tolerance_benches.forecast_draws(scene, "II")
    assert searched.settings["chunks"] == 30
    assert searched.seconds == pytest.approx(3 * 250 * 0.014 + 20 * 0.035)


# ---- harmonics -------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("size", [24, 25])
def test_harmonics_of_even_values_are_those_of_their_waves_and_of_every_second_one_too(size):
    turn = 2.0 * np.pi * np.arange(size) / size
    values = 7.0 + 3.0 * np.cos(turn) - 2.0 * np.sin(2.0 * turn)
    found = _harmonics(values, 1, 3)
    np.testing.assert_allclose(found, [3.0, 2.0j, 0.0], atol=1e-12)  # a cos + b sin: a - i b
    halved = _harmonics(values, 2, 3)
    assert halved.shape == (3,)
    # Of an odd number two neighbours are left beside each other: theirs is the smaller weight, by the trapezoidal rule.
    np.testing.assert_allclose(halved, [3.0, 2.0j, 0.0], atol=1e-12 if size == 24 else 0.15)
    at = np.arange(0, size, 2)
    gaps = np.diff(np.append(at, size))
    weights = 0.5 * (gaps + np.append(gaps[-1:], gaps[:-1]))
    assert weights.sum() == size
    wave = (weights * values[at] * np.exp(-2j * np.pi * at / size)).sum() * 2.0 / size
    assert halved[0] == pytest.approx(wave)


# ---- straight steps --------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Tried:
    """A relief of two free numbers: transmission errors and loads over the face, straight in them."""

    te: np.ndarray
    slope: np.ndarray
    over_face: np.ndarray
    over_face_slope: np.ndarray
    peak_to_peak: float = 0.0


TRIALS = SimpleNamespace(
    scatter=SimpleNamespace(weights=np.array([[1.0]])), proportion=np.array([1.0]), value=lambda one: 123.0
)
FREE = np.array([0, 2])


def straight(limit):
    """Errors of 4 and 1 um at two positions: the first number takes from the first, the second adds to the second."""
    te = 1e-6 * np.array([[[4.0], [1.0]]])
    slope = np.zeros((1, 3, 2, 1))
    slope[0, 0, 0], slope[0, 2, 1] = -1.0, 1.0
    slope[0, 1] = 77.0  # not free
    over_slope = np.zeros((1, 3, 2, 1))
    over_slope[0, 0, 0], over_slope[0, 2, 1] = 2e5, 1e5
    over_slope[0, 1] = 77.0
    tried = Tried(te, slope, np.array([[[1.0], [1.1]]]), over_slope)
    return _Straight.of(TRIALS, tried, FREE, limit)


def test_the_step_that_leaves_least_keeps_within_its_bounds():
    bounds = np.array([-1e-6, -1e-6]), np.array([1e-6, 0.5e-6])
    step, left = straight(None).least(*bounds)
    np.testing.assert_allclose(step, [1e-6, 0.5e-6], rtol=1e-6)
    assert left == pytest.approx(1.5e-6)


def test_no_step_goes_beyond_the_largest_load_over_the_face():
    bounds = np.array([-1e-6, -1e-6]), np.array([1e-6, 1e-6])
    step, left = straight(1.15).least(*bounds)
    # 1 + 2e5 a and 1.1 + 1e5 b at most 1.15.
    np.testing.assert_allclose(step, [0.75e-6, 0.5e-6], rtol=1e-6)
    assert left == pytest.approx(3e-6 - 1.25e-6)
    nowhere, left = straight(0.5).least(*bounds)
    assert nowhere.tolist() == [0.0, 0.0]
    assert left == 123.0


@pytest.mark.parametrize("limit", [None, 1.2])
def test_slopes_are_carried_through_what_was_found_ahead(limit):
    here, step = straight(limit), np.array([2e-7, 4e-7])
    ahead = replace(here.tried, te=here.tried.te + 1e-7, over_face=here.tried.over_face + 0.25)
    moved = here.corrected(ahead, step)
    np.testing.assert_allclose(moved.te[0, :, 0], 1e-6 * np.array([4.1 + 0.2, 1.1 - 0.4]))
    assert (moved.limit, moved.free is FREE, moved.tried is here.tried) == (limit, True, True)
    if limit is None:
        assert moved.over_face is None
    else:
        np.testing.assert_allclose(moved.over_face[0, :, 0], [1.25 - 0.04, 1.35 - 0.04])
