"""What a design chart draws and tells: the envelope, the length for several amounts, points without a result."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.train.dynamic_factor import factor_line
from fegear.engine.figure.items import Curve, Points
from fegear.results.train import design_chart
from fegear.results.train.design_chart_sheet import CHART_SHEET, DesignChartData, UnequalRelief

LENGTHS = np.array([0.5, 0.75, 1.0, 1.25])
FACTOR = np.array([[1.8, 1.7, 1.6, 1.5], [1.6, 1.3, 1.1, 1.2], [1.4, 1.05, 1.5, 1.9]])


def chart(factor=FACTOR, amounts=(0.5, 1.0, 1.5), **changes):
    error = (factor - 0.95) * 1.3e-5
    made = DesignChartData(
        np.array(amounts), LENGTHS, factor, error, 1000.0 * factor, 0.0 * factor, 0.0 * factor,
        np.array([error / (2.0 + n) for n in range(4)]), ("",) * factor.size, (), factor_line(error, factor),
        2.1, 1.5e-5, 2.8e-5, "motor",
    )  # fmt: skip
    return replace(made, **changes)


def shown_of(made):
    """What a chart of mesh I shows."""
    return CHART_SHEET.present(made, SimpleNamespace(mesh="I", motion=SimpleNamespace(speeds=np.zeros(5))))


def test_the_envelope_joins_the_least_factors_amount_by_amount():
    """Not by length: two amounts with one best length would make a zigzag."""
    (drawn, *_) = shown_of(chart(np.vstack([FACTOR[:2, ::-1], FACTOR[2]]))).figures
    (envelope,) = (i for i in drawn.panels[0].items if isinstance(i, Curve) and i.name == "minimum of each amount")
    assert np.asarray(envelope.x).tolist() == [0.5, 0.75, 0.75]
    assert np.asarray(envelope.y).tolist() == [1.5, 1.1, 1.05]


def test_the_length_for_all_amounts_is_where_their_worst_is_least():
    """1.00 and 1.50 Delta cross between 0.75 and 1: 1.3 - 0.8 t = 1.05 + 1.8 t."""
    made = chart(FACTOR[1:], (1.0, 1.5))
    length, factor = made.best_for_all()
    crossing = 0.75 + 0.25 / 2.6
    assert length == pytest.approx(crossing, abs=4e-4)
    assert factor == pytest.approx(1.3 - 0.8 * (crossing - 0.75), abs=1e-3)
    values = {value.name: value.value for value in shown_of(made).values}
    assert values["design_chart.best_length_for_all"] == length
    (drawn, *_) = shown_of(made).figures
    (star,) = (i for i in drawn.panels[0].items if isinstance(i, Points))
    assert np.asarray(star.x).tolist() == [length]


def test_a_flat_optimum_is_reported_with_its_range():
    """Lengths within 1 % of the least on either side of it; one beyond ends it, or one without result."""
    rows = np.array([[1.5, 1.009, 1.0, 1.01], [1.0, 1.2, 1.001, 1.3], [1.004, np.nan, 1.0, 1.02]])
    made = chart(rows)
    assert [made.flat_range(k) for k in range(3)] == [(0.75, 1.25), (0.5, 0.5), (1.0, 1.0)]
    values = {value.name: value.value for value in shown_of(made).values}
    assert (values["design_chart.flat_from_0.5"], values["design_chart.flat_to_0.5"]) == (0.75, 1.25)
    assert (values["design_chart.flat_from_1.5"], values["design_chart.flat_to_1.5"]) == (1.0, 1.0)


def test_points_without_a_result_are_named_and_left_out():
    factor = FACTOR.copy()
    factor[1, 2] = np.nan
    reasons = [""] * factor.size
    reasons[6] = "the motion grows"
    gone = UnequalRelief(1.0, 1.5, 0.75, np.nan, np.nan, np.nan, np.nan, "the motion grows too")
    made = chart(factor, reasons=tuple(reasons), unequal=(gone,))
    table, unequal = shown_of(made).tables
    assert table.column("failure").values[6] == "the motion grows"
    assert unequal.column("failure").values[0] == "the motion grows too"
    names = {value.name for value in shown_of(made).values}
    assert "design_chart.best_length_for_all" not in names
    assert "design_chart.factor_1_1.5_0.75" not in names
    assert {value.name: value.value for value in shown_of(made).values}["design_chart.best_length_1"] == 1.25
    assert made.line.scatter < 1e-9
    assert len(shown_of(made).figures) == 3


def test_where_the_line_misses_most_is_said():
    factor = FACTOR.copy()
    made = chart(factor)
    off = factor.copy()
    off[2, 3] = 3.0
    (sentence,) = shown_of(replace(made, dynamic_factor=off)).remarks
    assert "at 1.5 Delta, L_n = 1.25: 3, predicted 1.9" in sentence
    assert shown_of(replace(made, line=None)).remarks == ()


@pytest.mark.parametrize("unequal", [0, 1, 4])
def test_a_forecast_counts_the_unmodified_pair_the_grid_and_three_for_each_unequal_relief(monkeypatch, unequal):
    monkeypatch.setattr(design_chart.forecasts, "seconds_per_speed", lambda _: 0.5)
    chart = SimpleNamespace(amounts=[1, 2], lengths=[1, 2, 3], unequal=[None] * unequal)
    scene = SimpleNamespace(case=SimpleNamespace(dynamics=SimpleNamespace(chart=chart, speed_values=np.ones(5))))
    found = design_chart._forecast(scene, "")
    assert found.settings == {"points": 7 + 3 * unequal, "speeds": 5}
    assert found.seconds == pytest.approx((7 + 3 * unequal) * 2.6)
