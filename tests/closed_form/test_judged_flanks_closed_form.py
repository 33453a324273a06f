"""Judging designed flanks: means and percentiles over a normal misalignment, errors from fewer places and panels."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import norm

from fegear.design.flanks import judge
from fegear.design.flanks.judge import FlankJudge, flank_judge, over_scatter
from fegear.design.flanks.scatter import NOMINAL, Scatter

LEVELS = np.linspace(-3.5, 3.5, 15)  # standard deviations


def test_what_grows_straight_with_the_misalignment_has_the_normal_distribution_s_percentile():
    found = over_scatter(2.0 + 3.0 * LEVELS, 0.95, 0.25)
    inside = norm.cdf(3.5) - norm.cdf(-3.5)
    wanted = norm.ppf(norm.cdf(-3.5) + 0.95 * inside)
    assert found.value == pytest.approx(2.0 + 3.0 * wanted, abs=0.01)
    assert found.error == pytest.approx(0.25, abs=1e-9)  # every second level says the same
    assert over_scatter(2.0 + 3.0 * LEVELS, None, 0.5) == (pytest.approx(2.0, abs=1e-12), pytest.approx(0.5, abs=1e-9))
    falling = over_scatter(2.0 - 3.0 * LEVELS, 0.95, 0.0)
    assert falling.value == pytest.approx(found.value, rel=1e-9)


def test_what_bends_is_followed_over_it_and_known_less_well_from_every_second_level():
    """Straight lines over steps h of a square lie h^2/6 above it in the mean: of h = 1/2, and of 1."""
    found = over_scatter(LEVELS**2, None, 0.0)
    place = np.linspace(-3.5, 3.5, 70_001)
    density = norm.pdf(place) / norm.pdf(place).sum()
    assert found.value == pytest.approx(float(density @ np.interp(place, LEVELS, LEVELS**2)), abs=2e-3)
    half = float(density @ np.interp(place, LEVELS[::2], LEVELS[::2] ** 2))
    assert found.error == pytest.approx(0.5 * (half - found.value), rel=0.02)
    one_sided = over_scatter(LEVELS**2, 0.95, 0.0)
    assert one_sided.value == pytest.approx(norm.ppf(0.975) ** 2, rel=0.02)


@dataclass(frozen=True)
class Trials:
    """Three numbers at each misalignment: of the relief, and of the places, panels and gears that it is tried on."""

    more: tuple[float, float, float]
    known: object = None
    scatter: Scatter = NOMINAL

    def of_gap(self, gap):
        assert gap == f"gap on {self.known.lines}"
        at = self.scatter.over_face[:, None]
        ripple, factor, pressure = self.more
        return SimpleNamespace(
            peak_to_peak=ripple + 2.0 * at,
            face_load_factor=factor + 0.5 * np.abs(at) + 0.0 * at,
            pressure=pressure + at,
        )


def judged(deviation):
    def on(name, *more):
        return Trials(more, SimpleNamespace(lines=name))

    found = FlankJudge(
        on("dense", 10.0, 1.5, 100.0), on("plain", 9.0, 1.4, 90.0), on("thin", 9.5, 1.45, 96.0),
        on("soft", 8.8, 1.3, 89.0), deviation,
    )  # fmt: skip
    return found.judge(lambda lines: f"gap on {lines}")


def test_half_of_what_places_and_panels_change_and_all_that_gears_change_is_the_error():
    found = judged(0.0)
    assert found.peak_to_peak == (10.0, pytest.approx(0.5 * 1.0 + 0.5 * 0.5 + 0.2))
    assert found.face_load_factor == (1.5, pytest.approx(0.05 + 0.025 + 0.1))
    assert found.pressure == (100.0, pytest.approx(5.0 + 3.0 + 1.0))
    # Without scatter that is all.
    assert found.mean_over_scatter == found.most_over_scatter == found.peak_to_peak
    assert found.factor_over_scatter == found.face_load_factor


def test_what_is_stated_over_the_scatter_is_of_the_dense_places():
    deviation = 0.7
    found = judged(deviation)
    assert found.peak_to_peak.value == 10.0  # aligned as given: the middle one of three
    assert found.peak_to_peak.error == pytest.approx(0.95)
    assert found.mean_over_scatter.value == pytest.approx(10.0, abs=1e-9)
    assert found.mean_over_scatter.error == pytest.approx(0.95)
    assert found.most_over_scatter.value == pytest.approx(10.0 + 2.0 * deviation * norm.ppf(0.95), abs=0.02)
    assert found.factor_over_scatter.value == pytest.approx(1.5 + 0.5 * deviation * norm.ppf(0.975), abs=0.02)
    assert found.factor_over_scatter.error == pytest.approx(0.175, abs=0.02)


def test_a_pair_is_judged_at_four_times_as_many_places_on_panels_of_a_fourth_and_on_softer_gears(monkeypatch):
    asked = []

    def lines_of(pair, x, panel, weights, most_gap):
        asked.append((len(x), panel, weights, most_gap))
        return f"lines {len(asked)}"

    monkeypatch.setattr(judge, "edge_reach", lambda pair, most_gap: ("beyond", most_gap))

    def points_of(pair, count, beyond):
        assert beyond == ("beyond", 30e-6)
        return SimpleNamespace(x=np.arange(count), weights=np.full(count, 3.0), period=6.0 * count)

    monkeypatch.setattr(judge, "roll_points", points_of)
    monkeypatch.setattr(judge, "contact_lines", lines_of)
    monkeypatch.setattr(
        judge,
        "flank_compliance",
        lambda pair, gears, lines, load, **how: SimpleNamespace(gears=gears, lines=lines, how=how, load=load),
    )
    flanks = SimpleNamespace(
        pair=SimpleNamespace(driver=SimpleNamespace(module=2e-3)), panel=0.5, gears="gears", coupling=True, hertz="h",
        cache="cache", most_gap=30e-6,
    )  # fmt: skip
    apart = SimpleNamespace(at=lambda pair, lines: ("apart", lines))
    found = flank_judge(flanks, "coarse", apart, 1200.0, 3e-6)
    assert [(count, panel) for count, panel, *_ in asked] == [
        (192, 1e-3), (48, 1e-3), (48, pytest.approx(0.25e-3)), (48, 1e-3),
    ]  # fmt: skip
    assert {most_gap for *_, most_gap in asked} == {30e-6}
    for count, _, weights, _ in asked:
        np.testing.assert_allclose(weights, np.full(count, 0.5 / count))
    four = found.dense, found.plain, found.thin, found.soft
    assert [one.known.gears for one in four] == ["gears", "gears", "gears", "coarse"]
    assert [one.known.lines for one in four] == [f"lines {k}" for k in (1, 2, 3, 4)]
    assert [one.apart for one in four] == [("apart", f"lines {k}") for k in (1, 2, 3, 4)]
    assert {one.known.load for one in four} == {1200.0}
    assert [one.loads.tolist() for one in four] == [[1200.0]] * 4
    assert four[0].known.how == {"coupling": True, "hertz": "h", "cache": "cache"}
    assert found.deviation == 3e-6
    assert replace(found, deviation=0.0).deviation == 0.0
    assert math.isclose(judge.PERCENTILE, 0.95)
