"""Lines that no other ordinary test executes, each judged by what it is for."""

from __future__ import annotations

import math
import threading
from collections import deque
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.contact.compared import odd_cycle
from fegear.contact.plane import fe_compliance, odd_compliance
from fegear.dynamics.train import matrices, train_spec
from fegear.engine.stage import Task
from fegear.results.gear import crosscheck
from fegear.results.pair import error_otherwise, train_power_loss
from fegear.results.pair.measured_error_data import TraceBeside
from fegear.verify import cracked_strip
from fegear.window.job_queue import Inbox


# ---- crosscheck of odd teeth -----------------------------------------------------------------------------------------
class _Odd:
    def __init__(self, name, cracks, flanks):
        self.name, self.cracks, self.flanks = name, cracks, flanks

    def crack_tips(self, teeth):
        return f"tips of {self.name} among {teeth}"


def test_cracked_teeth_come_before_pitted_ones_of_either_gear(monkeypatch):
    pits, worn = Space(pits=("pit",)), Space(pits=())
    odd = {
        "a": _Odd("a", ((3, "crack"), (1, "crack")), ((5, pits), (6, worn))),
        "b": _Odd("b", (), ((2, pits),)),
    }  # fmt: skip
    gears = {"driver": Space(teeth=17), "driven": Space(teeth=40)}
    scene = Space(case=Space(pair={"I": Space(driver="a", driven="b")}), pairs={"I": Space(gear=gears.__getitem__)})
    monkeypatch.setattr(crosscheck, "odd_gears_of", lambda _scene, _name: tuple(odd))
    monkeypatch.setattr(crosscheck, "odd_teeth_in", lambda _scene, _name, gear: odd[gear])
    found = crosscheck.odd_teeth_of_pair(scene, "I")
    told = [(one.member, one.tooth, one.what) for one in found.teeth]
    assert told == [
        ("driver", 3, "cracked"),
        ("driver", 1, "cracked"),
        ("driver", 5, "pitted"),
        ("driven", 2, "pitted"),
    ]
    assert found.tips == {"driver": "tips of a among 17", "driven": "tips of b among 40"}
    assert found.flanks == {"driver": {5: pits, 6: worn}, "driven": {2: pits}}
    odd.pop("a")
    assert [one.member for one in crosscheck.odd_teeth_of_pair(scene, "I").teeth] == ["driven"]


@pytest.mark.parametrize("cracked", [(), ("a",), ("b",), ("a", "b")])
def test_passages_use_the_cracked_solutions_of_the_gears_that_have_one(monkeypatch, cracked):
    seen = []
    stage = next(iter(crosscheck.ODD_SOLUTIONS))
    upstream = {Task(stage, gear): f"cracked {gear}" for gear in cracked}
    upstream[Task("stiffness", "b")] = "a table"
    monkeypatch.setattr(crosscheck, "solution_of", lambda _upstream, gear: f"solved {gear}")
    monkeypatch.setattr(fe_compliance, "finite_element_compliance", lambda one: f"compliance of {one}")
    monkeypatch.setattr(odd_compliance, "odd_compliance", lambda one: f"odd compliance of {one}")
    monkeypatch.setattr(odd_cycle, "odd_passages", lambda *given: seen.append(given) or ("passage",))
    asked = Space(pairs={"I": Space(pair="pair", gears=("a", "b"), line_load=100.0)}, odd={"I": "teeth"})
    assert crosscheck._odd_passages(asked, "I", upstream) == ("passage",)
    ordinary = tuple(f"compliance of solved {gear}" for gear in "ab")
    odd = tuple(f"odd compliance of cracked {g}" if g in cracked else f"compliance of solved {g}" for g in "ab")
    assert seen == [("pair", odd, ordinary, 100.0, "teeth")]


def test_where_no_pair_is_in_contact_there_are_no_passages(monkeypatch):
    def refuse(*_given):
        raise RangeError("x", 0.0, "is outside", "")

    monkeypatch.setattr(crosscheck, "solution_of", lambda _upstream, gear: gear)
    monkeypatch.setattr(fe_compliance, "finite_element_compliance", lambda one: one)
    monkeypatch.setattr(odd_cycle, "odd_passages", refuse)
    asked = Space(pairs={"I": Space(pair="pair", gears=("a", "b"), line_load=100.0)}, odd={"I": "teeth"})
    assert crosscheck._odd_passages(asked, "I", {}) == ()


# ---- traces of encoders ----------------------------------------------------------------------------------------------
def _trace(**otherwise):
    told = {"better": (), "mate_teeth": 0, "ratio": 0.0, "low_pass": None, "speed": None, "counted": ""} | otherwise
    found = Space(teeth=24, spectrum=Space(turns=3.0))
    return Space(estimated=True, fitted=Space(gain=1.0), computed_peak_to_peak=1e-6, found=found,
                 otherwise=Space(**told, said=lambda *_: ""))  # fmt: skip


@pytest.mark.parametrize(("counts", "order"), [("twice", "12, half"), ("half", "48, twice")])
def test_an_encoder_that_counts_otherwise_has_the_mesh_at_another_order(counts, order):
    said = TraceBeside._verdict(_trace(counted=counts), brief=True)
    assert str(said).startswith(
        f"the mesh order of the trace is {order} the number of teeth: the encoder counts {counts}"
    )


def test_the_frequency_that_a_filter_has_to_pass_is_that_of_the_mesh():
    of = TraceBeside._mesh_frequency.fget
    assert of(_trace(speed=2.0 * math.pi * 50.0)) == " (mesh frequency 1200 Hz)"
    assert of(_trace()) == ""


def test_an_order_beyond_the_spectrum_has_no_amplitude():
    order = np.arange(0.0, 10.0, 0.5)
    amplitude = np.where(order == 4.5, 3.0, np.where(order == 9.5, 7.0, 1.0))
    found = Space(spectrum=Space(order=order, amplitude=amplitude))
    near = error_otherwise._near
    assert [near(found, one) for one in (4.2, 5.0, 5.4, 3.4, 9.5, 9.51, 20.0)] == [3.0, 3.0, 1.0, 1.0, 7.0, 0.0, 0.0]
    assert near(found, 0.0) == 1.0


# ---- losses of trains ------------------------------------------------------------------------------------------------
def test_a_train_without_a_speed_turns_at_that_of_the_first_pair_that_has_one(monkeypatch):
    """17/34 and 20/50 teeth; the second pair's driver turns at 100 rad/s, the first shaft twice as fast."""
    pairs = {"1": Space(driver=Space(teeth=17), base_pitch=0.01), "2": Space(driver=Space(teeth=20), base_pitch=0.02)}
    orders, speeds = np.array([17.0, 10.0]), {"I": 0.0, "II": 100.0}
    train = Space(
        mesh_orders=orders, torque=[10.0, 0.0, -45.0], ratios=[1.0, -0.5, 0.2],
        mesh_frequencies=lambda speed: orders * speed / (2.0 * math.pi),
    )  # fmt: skip
    part = Space(mesh=("1", "2"), pair_of={"1": "I", "2": "II"}.get, loaded_pair_of={"1": "I", "2": "II"}.get)
    monkeypatch.setattr(train_power_loss, "train_part", lambda _scene: part)
    monkeypatch.setattr(train_power_loss, "train_inputs", lambda _scene: Space(spec=Space(pairs=pairs)))
    monkeypatch.setattr(train_spec, "build_train", lambda _spec: train)
    monkeypatch.setattr(train_spec, "speed_ratio", lambda _spec, _train: 4.0)
    monkeypatch.setattr(matrices, "static_forces", lambda _train: np.array([-300.0, 200.0]))
    monkeypatch.setattr(train_power_loss, "pair_speed", lambda _scene, pair: speeds[pair])
    scene = Space(case=Space(dynamics=Space(one_speed=0.0)))
    found = train_power_loss._train_inputs(scene, "")
    speed = 200.0
    power = [300.0 * 17 * speed * 0.01, 200.0 * 10 * speed * 0.02]
    assert found.power == pytest.approx(tuple(one / (2.0 * math.pi) for one in power))
    assert (found.pairs, found.meshes, found.doubtful) == (("I", "II"), ("1", "2"), ("1",))
    assert found.driving == pytest.approx(2000.0)  # 10 N m at 200 rad/s; 45 N m at 40 rad/s brake
    scene.case.dynamics.one_speed = 400.0  # of a shaft that turns four times as fast as the first
    found = train_power_loss._train_inputs(scene, "")
    assert found.power == pytest.approx(tuple(one / (4.0 * math.pi) for one in power))
    assert found.doubtful == ("1", "2")


# ---- rows of verify --------------------------------------------------------------------------------------------------
def test_strips_of_verify_are_pulled_evenly_and_bent_about_their_middle():
    x = np.linspace(0.0, 1.0, 5)
    np.testing.assert_array_equal(cracked_strip._tension(x), np.ones(5))
    np.testing.assert_allclose(cracked_strip._bending(x), [1.0, 0.5, 0.0, -0.5, -1.0])


# ---- queue of the window ---------------------------------------------------------------------------------------------
def test_a_queue_is_empty_until_something_waits():
    queue = object.__new__(Inbox)
    queue._jobs, queue._news = deque(), threading.Condition()
    assert queue.empty is True
    queue._jobs.append("job")
    assert queue.empty is False
