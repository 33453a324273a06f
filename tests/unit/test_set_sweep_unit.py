"""Motions of a set over speeds: which number of which mesh is said, and where each speed starts; motions made up."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.dynamics.planetary import set_motion
from fegear.dynamics.planetary.set_motion import SetSweep, set_sweep

#: Two speeds of a set of three planets: sun meshes first, then ring meshes.
LARGEST = np.array([[2.0, 5.0, 3.0, 7.0, 1.0, 4.0], [8.0, 6.0, 9.0, 2.0, 3.0, 1.0]])
APART = LARGEST / 100.0
BEHIND = np.array([[0.1, 0.3, 0.2, 0.0, 0.4, 0.1], [0.6, 0.5, 0.0, 0.1, 0.2, 0.3]])
TOOTH = np.array([[9.0, 1.0, 2.0, 3.0, 4.0, 5.0], [1.0, 2.0, 3.0, 4.0, 12.0, 5.0]])


def states():
    return tuple(
        SimpleNamespace(
            model=SimpleNamespace(speed=speed, static=np.full(6, 2.0)), largest=LARGEST[k], smallest=-LARGEST[k],
            tooth_force=TOOTH[k], apart=APART[k], behind=BEHIND[k], periods=(1, 0)[k], repeats=k == 0,
        )
        for k, speed in enumerate((20.0, 50.0))
    )  # fmt: skip


def test_each_column_is_of_its_own_mesh_and_the_worst_planet():
    found = SetSweep(states(), 2.0, 1e-3, np.array([0.02, 0.03]))
    np.testing.assert_allclose(found.mesh_frequency, np.array([20.0, 50.0]) / (2.0 * math.pi))
    np.testing.assert_allclose(found.sun_factor, [2.5, 4.5])
    np.testing.assert_allclose(found.ring_factor, [3.5, 1.5])
    np.testing.assert_allclose(found.tooth_factor, [4.5, 6.0])
    np.testing.assert_allclose(found.apart_sun, [0.05, 0.09])
    np.testing.assert_allclose(found.apart_ring, [0.07, 0.03])
    np.testing.assert_allclose(found.behind, [0.4, 0.6])
    assert found.periods.tolist() == [1, 0]
    assert found.error[0] == pytest.approx(0.021)
    assert math.isnan(found.error[1])  # of what does not repeat a sample is known


@dataclass(frozen=True)
class Run:
    mesh_frequency: float
    linear: object


@pytest.mark.parametrize(
    ("direction", "starts"),
    [
        ("up", ["static", ("x1", "v1"), ("x2", "v2")]),
        ("down", ["static", ("x3", "v3"), ("x2", "v2")]),
        ("static", ["static"] * 3),
        ("rest", ["rest"] * 3),
    ],
)
def test_each_speed_starts_from_the_one_before_or_afresh(direction, starts, monkeypatch):
    asked, told = [], []

    def steady(model, *, start, tolerance, progress):
        assert (tolerance, model.linear) == (2e-4, linear)
        asked.append((model.mesh_frequency, start))
        number = int(model.mesh_frequency / 100.0)
        progress(0.5)
        return SimpleNamespace(x=f"x{number}", v=f"v{number}", model=model)

    model = SimpleNamespace(found=SimpleNamespace(ring_lever=1.0))
    linear = SimpleNamespace(meshed=SimpleNamespace(mean_force=4.0, model=model))
    monkeypatch.setattr(set_motion, "steady_state", steady)
    vibration = SimpleNamespace(
        shift=lambda of: np.array([0.4, 0.8, 1.2]) if of(SimpleNamespace(largest_force=7)) else None
    )
    monkeypatch.setattr(set_motion, "forced_response", lambda one, at: vibration if one is linear else None)
    speeds = np.array([100.0, 200.0, 300.0])
    found = set_sweep(Run(1.0, linear), speeds, 2e-4, direction, told.append)
    order = [300.0, 200.0, 100.0] if direction == "down" else [100.0, 200.0, 300.0]
    assert asked == list(zip(order, starts, strict=True))
    assert [one.model.mesh_frequency for one in found.states] == [100.0, 200.0, 300.0]
    assert (found.mean_force, found.tolerance) == (4.0, 2e-4)
    np.testing.assert_allclose(found.by_teeth, [0.1, 0.2, 0.3])
    assert told == pytest.approx([1 / 6, 1 / 3, 1 / 2, 2 / 3, 5 / 6, 1.0])

    def bare(one, at):
        raise RangeError("speed", 1.0, "meets a resonance")

    monkeypatch.setattr(set_motion, "forced_response", bare)
    assert np.isnan(set_motion._by_teeth(linear, speeds)).all()


def test_a_set_turns_at_its_mesh_frequency_and_is_the_same_at_another_speed():
    meshed = SimpleNamespace(model=SimpleNamespace(count=3), mean_forces=(7.0, 5.0))
    linear = SimpleNamespace(meshed=meshed, damping_ratio=0.3)
    run = set_motion.SetMotion(linear, 50.0)
    assert run.speed == pytest.approx(100.0 * math.pi)
    assert run.period == 0.02
    assert run.static.tolist() == [7.0] * 3 + [5.0] * 3
    assert run.at_speed(20.0 * math.pi).mesh_frequency == pytest.approx(10.0)
    with pytest.raises(RangeError, match="must be positive"):
        replace(run, mesh_frequency=0.0)
