"""A chart of reliefs: its amounts, lengths and loads with their defaults, the optimum that is ground, how far it is."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.design.load_range import LoadRange
from fegear.results.relief import relief_chart as module

DELTA, UNMODIFIED = 20e-6, "unmodified"


def computed(monkeypatch, *, over=None, tolerances=None, **asked):
    """The chart, and what was done with which progress."""
    done = []
    pair = Space(engagement=Space(unmodified=lambda: UNMODIFIED), loads=(300.0, 500.0), nominal=500.0)
    part = Space(**{name: asked.get(name) for name in ("loads", "amounts", "amounts_over_delta", "lengths")},
                 shape="parabolic")  # fmt: skip
    inputs = Space(part=part, over=over, limits="limits", tolerances=tolerances, metric="metric")

    def chart(e, amounts, lengths, loads, shape, weights):
        assert (e, shape) == (UNMODIFIED, "parabolic")
        done.append(("chart", np.asarray(amounts).tolist(), np.asarray(lengths).tolist(), loads.tolist(), weights))
        return Space(finer=lambda: (np.array([9.0]), np.array([8.0])), number=len(done))

    def unit(e, load):
        assert (e, load) == (UNMODIFIED, 500.0)
        return DELTA

    def best(*given, limits, cache):
        done.append(("best", *given, limits, cache))
        return "best"

    monkeypatch.setattr("fegear.design.charts.relief_chart", chart)
    monkeypatch.setattr("fegear.design.charts.unit_amount", unit)
    monkeypatch.setattr("fegear.design.tip_relief.grindable.grindable", best)
    monkeypatch.setattr("fegear.design.tip_relief.grindable.tolerated", best)
    work = Space(progress=lambda share: done.append(("progress", share)), cache="cache")
    return module._compute_chart(inputs, {"task": pair}, work), done, pair


@pytest.mark.parametrize("tolerances", [None, "tolerances"])
def test_without_numbers_a_chart_is_of_shares_of_the_deflection_under_the_loads_of_the_pair(monkeypatch, tolerances):
    found, done, pair = computed(monkeypatch, tolerances=tolerances)
    over = LoadRange((300.0, 500.0))
    (first, started, finer, refined, best) = done
    assert first[0] == finer[0] == "chart"
    assert first[1] == pytest.approx(DELTA * np.linspace(0.1, 1.6, 16))
    assert first[2] == pytest.approx(np.linspace(0.05, 1.3, 26))
    assert first[3:] == ([300.0, 500.0], over.weights)
    assert finer[1:] == ([9.0], [8.0], [300.0, 500.0], over.weights)
    assert (started, refined) == (("progress", 0.3), ("progress", 0.5))
    judged = "metric" if tolerances is None else tolerances
    assert best == ("best", UNMODIFIED, over, "parabolic", judged, "limits", "cache")
    assert (found.pair, found.best, found.delta, found.chart.number, found.finer.number) == (pair, "best", DELTA, 1, 3)


def test_given_numbers_are_put_in_order(monkeypatch):
    _, done, _ = computed(monkeypatch, amounts=[3e-6, 1e-6], lengths=[0.9, 0.4], loads=[100.0, 200.0, 300.0])
    assert done[0][1:4] == ([1e-6, 3e-6], [0.4, 0.9], [100.0, 200.0, 300.0])
    _, done, _ = computed(monkeypatch, amounts_over_delta=[0.5, 0.25])
    assert done[0][1] == pytest.approx([0.25 * DELTA, 0.5 * DELTA])
    over = LoadRange((50.0, 60.0), (0.3, 0.7))
    _, done, _ = computed(monkeypatch, over=over, loads=[100.0])
    assert done[0][3:] == ([50.0, 60.0], (0.3, 0.7))
