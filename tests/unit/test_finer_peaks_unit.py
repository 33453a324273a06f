"""Errors of the largest line load and pressure: looked for again where they may stand, on shorter panels."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError
from fegear.contact.wide.error import _LIKELY, finer_changes, likely_positions


def test_what_may_be_largest_is_looked_at_again_and_halfway_to_its_neighbours():
    roll = np.array([0.0, 0.2, 0.4, 0.6, 0.8])
    load = np.array([[1.0], [0.99 * _LIKELY], [0.0], [0.0], [0.0]])
    np.testing.assert_allclose(likely_positions(roll, 1.0, (load,)), [0.0, 0.1, 0.9])
    second = np.array([[0.0], [0.0], [0.0], [2.0], [0.0]])
    np.testing.assert_allclose(likely_positions(roll, 1.0, (load, second)), [0.0, 0.1, 0.5, 0.6, 0.7, 0.9])


def test_under_every_load_its_own_positions_count_and_nothing_stands_within_a_jump():
    roll = np.array([0.0, 0.4, 0.4 + 1e-9, 0.8])
    load = np.array([[1.0, 0.1], [1.0, 0.1], [0.1, 0.1], [0.1, 1.0]])
    np.testing.assert_allclose(likely_positions(roll, 1.0, (load,)), [0.0, 0.2, 0.4, 0.6, 0.8, 0.9])


class Flanks:
    """Flanks whose largest load is 100 at every position, and 130 about 0.5 on short panels; a tenth more if coarse."""

    def __init__(self, panel, *, converges=True, gears="fine"):
        self.panel, self.converges, self.gears, self.seen = panel, converges, gears, []

    def compliance(self, _about, roll):
        self.seen.extend(roll.tolist())
        return roll

    def solve(self, _load, _gaps, roll):
        if not self.converges:
            raise ConvergenceError("no set of stations")
        peak = np.abs(roll - 0.5) < 0.04
        softer = 1.1 if self.gears == "coarse" else 1.0
        return SimpleNamespace(
            largest_line_loads=softer * np.where(peak, 130.0, 100.0)[:, None],
            largest_pressures=softer * np.where(roll < 0.01, 7.5, 7.0)[:, None],
        )


@pytest.fixture
def over():
    roll = np.linspace(0.0, 0.95, 20)
    found = SimpleNamespace(
        load=np.ones(1), largest_line_loads=np.full((20, 1), 100.0), largest_pressures=np.full((20, 1), 6.0),
        largest_line_load=np.array([100.0]), largest_pressure=np.array([6.0]),
    )  # fmt: skip
    return SimpleNamespace(found=found, points=SimpleNamespace(x=roll, period=1.0))


@pytest.fixture
def shorter(monkeypatch):
    def of(flanks):
        found, coarse = (
            Flanks(0.5 * flanks.panel, converges=flanks.converges, gears=one) for one in ("fine", "coarse")
        )
        made = {(flanks, "panel", 0.5): found, (found, "gears", "coarse"): coarse}
        monkeypatch.setattr("fegear.contact.wide.error.replace", lambda of, **how: made[(of, *how.popitem())])
        return flanks, found, coarse

    return of


def test_a_peak_that_only_short_panels_between_the_positions_show_is_stated(shorter, over):
    flanks, again, coarse = shorter(Flanks(1.0))
    found = finer_changes(flanks, "coarse", None, over, 1.0)
    np.testing.assert_allclose(found["largest_line_load"], [[30.0], [13.0]])
    np.testing.assert_allclose(found["largest_pressure"], [[1.5], [0.75]])
    assert len(again.seen) == len(set(again.seen)) == 40
    # coarser gears where the largest of either stands, at no other position
    np.testing.assert_allclose(
        coarse.seen, [0.0, again.seen[int(np.argmax(np.abs(np.array(again.seen) - 0.5) < 0.04))]]
    )


def test_spots_that_find_no_balance_on_short_panels_keep_what_longer_ones_change(shorter, over):
    flanks, *_ = shorter(Flanks(1.0, converges=False))
    assert finer_changes(flanks, "coarse", None, over, 1.0) == {}
