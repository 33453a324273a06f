"""Contact loss and friction that a motion neglects: reported with the size that the run with them has."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.case.built.neglected_in_motion import contact_loss_changes, friction_changes
from fegear.case.built.train import motion_spec
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
#: Speeds [rpm] from below resonance to above it, and loads [N]: the torque is the load times the base radius.
SPEEDS = "dynamics.speeds=['6000 rpm', '9500 rpm', '10500 rpm', '11500 rpm', '12500 rpm', '14500 rpm']"
BASE_RADIUS = 371.3294 / 8890.0


@functools.cache
def run(load: float, *overrides: str):
    loaded = (f"pair.I.load='{load} N'", f"train.torque={{ motor = '{load * BASE_RADIUS} N*m' }}")
    scene = read_scene(CASES / "lin_dynamic_factor.toml", ('results=["dynamic-factor"]', SPEEDS, *loaded, *overrides))
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def factors(results) -> np.ndarray:
    states = results.outcomes[Task("motion")].data.states
    return np.array([s.tooth_force[0] / results.outcomes[Task("gear-train")].data.forces[0] for s in states])


@pytest.mark.dear
@pytest.mark.parametrize(
    ("load", "relief", "effect", "changes"),
    [
        (1500.0, "false", "contact_loss", contact_loss_changes),
        (8890.0, "false", "contact_loss", contact_loss_changes),
        pytest.param(8890.0, "true", "contact_loss", contact_loss_changes, marks=pytest.mark.long),
        pytest.param(1500.0, "true", "friction", friction_changes, marks=pytest.mark.long),
        (8890.0, "true", "friction", friction_changes),
        (8890.0, "false", "friction", friction_changes),
    ],
)
def test_the_reported_size_is_that_of_the_run_with_the_effect_on(load, relief, effect, changes):
    off = run(load, f"effects.{effect}=false", f"effects.relief={relief}")
    on = run(load, f"effects.{effect}=true", f"effects.relief={relief}")
    data, states = off.outcomes[Task("gear-train")].data, off.outcomes[Task("motion")].data.states
    (change,) = changes(motion_spec(off.scene), data, states)
    true = factors(on) - factors(off)
    there = true[np.argmin(np.abs(np.array([s.model.speed for s in states]) - change.speed))]
    # at its own speed it is the run's
    assert change.size == pytest.approx(there, rel=0.05, abs=5e-4)
    assert any(f"{effect} is off" in r for r in off.remarks) == (change.share > 1e-3)
    if effect == "contact_loss" and relief == "false":  # teeth are pulled: this speed is the one that decides
        assert 0.5 < abs(change.size) / np.abs(true).max() < 2.0
    if effect == "friction":
        largest = factors(on).max() - factors(off).max()
        assert 0.5 * abs(largest) - 5e-4 < abs(change.size) < 2.0 * abs(largest) + 5e-4


def test_contact_loss_takes_force_away_where_teeth_are_pulled():
    """Perfect flanks at resonance: the linear train pulls, so teeth part, and the peak of the linear train is lost."""
    results = run(8890.0, "effects.contact_loss=false")
    states = results.outcomes[Task("motion")].data.states
    assert min(s.smallest[0] for s in states) < 0.0
    assert all(s.apart[0] == 0.0 and s.changes == 0 and s.periods == 1 for s in states)
    remark = next(r for r in results.remarks if "contact_loss is off" in r)
    assert "rpm of motor" in remark
    assert "Set contact_loss = true under [effects]." in remark


def test_linear_results_tell_how_far_their_force_falls_below_zero():
    results = run(8890.0, "effects.contact_loss=false", "effects.parametric=false")
    remark = next(r for r in results.remarks if "minimum linearised mesh force" in r)
    least = float(remark.split("minimum linearised mesh force ")[1].split(" N")[0])
    share = float(remark.split("(")[1].split(" %")[0])
    assert share == pytest.approx(-100.0 * least / 8890.0, abs=0.6)
    assert "contact_loss = true" in remark
