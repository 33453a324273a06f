"""How long a motion is followed: by work, told while it is spent, little where nothing would settle."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.motion import effort, steady_state
from fegear.dynamics.motion.effort import EFFORT, ENDLESS_EFFORT, Effort, effort_for, least_decay, of_one
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.moving_train import steady_motion
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.train import Body, Mesh, Shaft, Torque, Train, mesh_damping

RADIUS, INERTIA, STIFFNESS, FORCE = 0.05, 2e-3, 2e8, 500.0
NATURAL = math.sqrt(2.0 * STIFFNESS * RADIUS**2 / INERTIA)


def discs(ratio, zeta, *, depth=0.45, shaft_damping=None):
    """Two discs whose mesh stiffness swings, at a mesh frequency of `ratio` natural ones; a third on a soft shaft."""
    damping = mesh_damping(zeta, STIFFNESS, RADIUS, RADIUS, INERTIA, INERTIA)
    bodies, shafts, loaded = [Body("1", INERTIA), Body("2", INERTIA)], (), "2"
    if shaft_damping is not None:
        bodies.append(Body("3", INERTIA))
        shafts, loaded = (Shaft("s", "2", "3", 1e3, shaft_damping),), "3"
    train = Train(
        tuple(bodies), shafts=shafts, meshes=(Mesh("g", "1", "2", RADIUS, RADIUS, 30, 30, STIFFNESS, damping),),
        torques=(Torque("1", FORCE * RADIUS), Torque(loaded, FORCE * RADIUS)),
    )  # fmt: skip
    swing = Periodic.fit(lambda s: STIFFNESS * (1.0 + depth * np.cos(2 * np.pi * s)), degree=10, tolerance=1e-12)
    return MotionModel(train, (MeshExcitation.from_mesh(swing),), ratio * NATURAL / 30.0)


@pytest.mark.parametrize("zeta", [0.0, 1e-4, 0.02, 0.3])
@pytest.mark.parametrize("ratio", [0.3, 2.007])
def test_the_decay_of_one_oscillator_is_that_of_its_damping_ratio(zeta, ratio):
    """exp(-zeta w t) over the period 2 pi / (ratio w)."""
    expected = 2.0 * math.pi * zeta / ratio
    assert least_decay(pack(discs(ratio, zeta))) == pytest.approx(expected, rel=1e-9, abs=0.0)


def test_the_least_damped_vibration_counts_and_the_effort_follows_it():
    """A shaft that damps nothing lets its own vibration go on, however well the mesh damps its own."""
    bare, damped = (pack(discs(2.007, 0.1, shaft_damping=c)) for c in (0.0, 2.0))
    assert 0.0 <= least_decay(bare) < 1e-3 * least_decay(damped)
    work = 60
    assert effort_for(damped, work, None).limit == EFFORT
    assert effort_for(pack(discs(2.007, 0.0)), work, None).limit == ENDLESS_EFFORT
    # what dies away within the effort does not within one of a period that is so much more work
    assert effort_for(damped, math.ceil(2.0 * EFFORT * least_decay(damped)), None).limit == ENDLESS_EFFORT


def test_what_is_spent_is_told_as_it_grows_and_never_as_more_than_all():
    told = []
    spending = Effort(1000, told.append)
    for _ in range(12):
        spending.spend(100)
    assert told == pytest.approx([0.1 * k for k in range(1, 11)])
    assert spending.left == 0
    half = Effort(1000)
    for _ in range(5):
        half.spend(100)
    assert half.left == 5
    overall = []
    within = of_one(overall.append, 3, 4)
    assert of_one(None, 3, 4) is None
    for share in (0.0, 0.5, 1.0):
        within(share)
    assert overall == [0.75, 0.875, 1.0]


@pytest.mark.dear
def test_a_motion_that_cannot_settle_is_given_up_by_work_and_shows_what_was_seen(monkeypatch):
    """Two discs without damping at twice their natural frequency throw each other ever further apart."""
    monkeypatch.setattr(effort, "ENDLESS_EFFORT", 4_000)
    model, told = discs(2.007, 0.0), []
    state = steady_state.steady_state(model, tolerance=1e-3, measured=100, progress=told.append)
    assert state.kind == "not settled"
    assert not state.repeats
    assert 250 <= state.followed < 1000
    assert state.measured == 100
    least, largest = state.quantile(0.0)[0], state.tooth_force[0]
    assert 0.0 <= least < largest
    assert largest == state.per_period.max()
    assert told == sorted(told)
    assert 0.2 < told[-1] <= 1.0
    # by work alone: the same to the last bit when run again
    again = steady_state.steady_state(model, tolerance=1e-3, measured=100)
    assert (again.followed, again.kind) == (state.followed, state.kind)
    assert np.array_equal(again.per_period, state.per_period)


def test_an_effort_that_is_not_needed_changes_nothing(monkeypatch):
    """A damped motion repeats before any effort counts."""
    model = discs(0.7, 0.1)
    before = steady_state.steady_state(model, tolerance=1e-3)
    monkeypatch.setattr(effort, "EFFORT", 1)
    monkeypatch.setattr(effort, "ENDLESS_EFFORT", 1)
    after = steady_state.steady_state(model, tolerance=1e-3)
    assert before.kind == after.kind == "periodic"
    assert np.array_equal(before.tooth_force, after.tooth_force)


@pytest.mark.parametrize("method", ["averaging", "shooting"])
def test_a_steady_motion_is_found_by_the_method_that_the_case_names(method, monkeypatch):
    told = []
    for name in ("averaged_motion", "steady_state"):
        monkeypatch.setattr(
            f"fegear.dynamics.motion.moving_train.{name}",
            lambda model, name=name, **how: (told.append((name, how)), name)[1],
        )
    found = steady_motion(SimpleNamespace(method=method), "model", "static", 1e-3, None)
    wanted = "averaged_motion" if method == "averaging" else "steady_state"
    assert found == wanted
    assert told == [(wanted, {"start": "static", "tolerance": 1e-3, "progress": None})]
