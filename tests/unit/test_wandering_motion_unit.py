"""How a motion that comes to no orbit is followed, what it is called and what is measured of it; its motion is made up.

A script says what each window does: how fast neighbours part, whether the spread drifts, whether it came to an orbit.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.motion import steady_state
from fegear.dynamics.motion.coexisting import Window

PACKED = SimpleNamespace(model="train", free=np.array([True]))
#: Rates of growth of what is chaotic, of a torus, and of neighbours that close in.
CHAOS, TORUS, CLOSES = 0.05, 0.0, -0.05


class Script:
    """A motion by hand; what was asked of it, in order."""

    def __init__(self, monkeypatch, *, growth, drifting=(), settled=(), bounded=(), effort=10**9):
        self.growths, self.drifts = list(growth), list(drifting)
        self.settlings, self.bounds = list(settled), list(bounded)
        self.effort, self.asked, self.windows = SimpleNamespace(left=effort), [], 0
        for name in ("growth", "follow", "drifting", "_settled", "_bounded"):
            monkeypatch.setattr(steady_state, name, getattr(self, f"take_{name.strip('_')}"))
        monkeypatch.setattr(steady_state, "_growing", lambda _packed, rate: ("growing", rate))
        monkeypatch.setattr(steady_state, "stable_motions", lambda model, step: ())

    def take_growth(self, _packed, x, _v, step, windows=250):
        self.asked.append(("growth", x, windows))
        assert step == 1e-9
        return self.growths.pop(0)

    def take_follow(self, _packed, x, _v, length, step, *, peaks, effort=None):
        assert (step, effort in (None, self.effort)) == (1e-9, True)
        self.windows += 1
        self.asked.append(("follow", x, length, peaks, effort is not None))
        spread = float(self.windows)
        passages = tuple(
            SimpleNamespace(
                tooth_force=np.array([10.0 * self.windows + k]), largest=np.array([20.0 + k]),
                smallest=np.array([-3.0 - k]), apart=np.array([0.1 + 0.2 * k]), behind=np.array([0.01 * (k + 1)]),
                changes=3,
            )
            for k in range(2)
        )  # fmt: skip
        states = np.tile([[spread], [-spread]], (length // 2, 1))
        return Window(states, passages, f"x{self.windows}", f"v{self.windows}")

    def take_drifting(self, before, after, *, chaotic=False):
        self.asked.append(("drifting", before.x, after.x, chaotic))
        return self.drifts.pop(0)

    def take_settled(self, _packed, states, x, v, step):
        self.asked.append(("settled", x, states.shape[0]))
        found = self.settlings.pop(0) if self.settlings else None
        return found, None, (x, v)

    def take_bounded(self, _packed, window):
        return self.bounds.pop(0) if self.bounds else True

    def run(self, measured=1000):
        return steady_state._wander(PACKED, "x0", "v0", 1e-9, measured, self.effort)

    def of(self, kind):
        return [one[1:] for one in self.asked if one[0] == kind]


def test_a_motion_on_a_torus_is_followed_over_two_windows_and_measured(monkeypatch):
    script = Script(monkeypatch, growth=[TORUS, TORUS], drifting=[False])
    found = script.run()
    assert found.kind == "quasi-periodic"
    assert script.of("follow") == [("x0", 250, False, True), ("x1", 500, False, True), ("x2", 1000, True, False)]
    assert script.of("growth") == [("x0", 250), ("x2", 1000)]
    assert script.of("drifting") == [("x1", "x2", False)]
    assert script.of("settled") == [("x1", 250), ("x3", 1000)]  # the measured periods, too, may have come to an orbit
    assert (found.followed, found.periods, found.growth, found.x, found.v) == (750, 0, TORUS, "x2", "v2")
    # Two passages of the third window: largest and smallest of all, means of shares, sums of changes.
    assert (found.tooth_force[0], found.largest[0], found.smallest[0]) == (31.0, 21.0, -4.0)
    assert (found.apart[0], found.behind[0], found.changes) == (pytest.approx(0.2), pytest.approx(0.015), 6)
    assert found.per_period.ravel().tolist() == [30.0, 31.0]
    assert found.drift == pytest.approx(3.0 / 2.0 - 1.0)
    assert found.multipliers.size == 0
    assert np.isnan(found.residual)


@pytest.mark.parametrize(
    ("rate", "kind"), [(CLOSES, "long-period"), (0.009, "quasi-periodic"), (-0.009, "quasi-periodic")]
)
def test_where_neighbours_close_in_a_motion_repeats_after_all(rate, kind, monkeypatch):
    assert Script(monkeypatch, growth=[TORUS, rate], drifting=[False]).run().kind == kind


def test_what_drifts_is_followed_further_over_twice_as_many_periods(monkeypatch):
    script = Script(monkeypatch, growth=[TORUS, TORUS], drifting=[True, True, True, True, True, False])
    found = script.run()
    assert [one[1] for one in script.of("follow")] == [250, 500, 1000, 2000, 4000, 4000, 4000, 1000]
    assert found.followed == 250 + 500 + 1000 + 2000 + 4000 + 4000 + 4000
    assert script.of("growth") == [("x0", 250), ("x7", 1000)]  # not before it stands


def test_chaos_is_measured_once_it_spreads_no_further_and_comes_to_no_orbit(monkeypatch):
    script = Script(monkeypatch, growth=[CHAOS, CHAOS], drifting=[False, False])
    found = script.run()
    assert (found.kind, found.growth, found.followed) == ("chaotic", CHAOS, 750)
    assert script.of("growth") == [("x0", 250), ("x2", 250)]
    assert script.of("drifting") == [("x1", "x2", True), ("x2", "x3", True)]
    assert [one[0] for one in script.of("settled")] == ["x1"]


def test_chaos_that_spread_while_it_was_measured_is_followed_on_from_there(monkeypatch):
    script = Script(monkeypatch, growth=[CHAOS] * 3, drifting=[False, True, False, False])
    found = script.run(400)
    assert [(one[0], one[1]) for one in script.of("follow")] == [
        ("x0", 250), ("x1", 500), ("x2", 400), ("x3", 800), ("x4", 400),
    ]  # fmt: skip
    assert (found.kind, found.followed, found.x) == ("chaotic", 250 + 500 + 400 + 800, "x4")


def test_growth_of_a_transient_is_no_chaos(monkeypatch):
    script = Script(monkeypatch, growth=[CHAOS, TORUS, TORUS], drifting=[False, False])
    found = script.run()
    assert (found.kind, found.followed) == ("quasi-periodic", 1750)
    assert script.of("drifting") == [("x1", "x2", True), ("x2", "x3", False)]
    assert script.of("growth")[1:] == [("x2", 250), ("x3", 1000)]


@pytest.mark.parametrize(("rate", "followed"), [(CHAOS, 15_750), (TORUS, 63_750)])
def test_patience_ends_sooner_with_chaos(rate, followed, monkeypatch):
    """250, 500, 1000, 2000 and then 4000 at a time, until 12,000 or 60,000 are reached; not longer measured."""
    script = Script(monkeypatch, growth=[rate], drifting=[True] * 40)
    found = script.run()
    assert (found.kind, found.followed) == ("not settled", followed)
    assert script.of("follow")[-1][1:] == (1000, True, False)


def test_an_effort_that_is_spent_ends_it_and_what_was_followed_is_shown(monkeypatch):
    script = Script(monkeypatch, growth=[TORUS], drifting=[], effort=499)
    found = script.run()
    assert (found.kind, found.followed) == ("not settled", 250)
    assert [one[1] for one in script.of("follow")] == [250, 250]  # no more than it was followed
    script = Script(monkeypatch, growth=[TORUS, TORUS], drifting=[False], effort=500)
    assert script.run().kind == "quasi-periodic"


def test_an_orbit_that_it_comes_to_is_what_is_found(monkeypatch):
    assert Script(monkeypatch, growth=[TORUS], settled=["orbit"]).run() == "orbit"
    assert Script(monkeypatch, growth=[CHAOS], drifting=[True], settled=[None, "orbit"]).run() == "orbit"
    late = Script(monkeypatch, growth=[TORUS, TORUS], drifting=[False], settled=[None, "orbit"])
    assert late.run() == "orbit"
    assert late.of("settled")[-1] == ("x3", 1000)


def test_what_leaves_all_bounds_grows(monkeypatch):
    assert Script(monkeypatch, growth=[0.3], bounded=[False]).run() == ("growing", 0.3)
    assert Script(monkeypatch, growth=[0.3, 0.4], drifting=[False, False], bounded=[True, False]).run() == (
        "growing",
        0.4,
    )
