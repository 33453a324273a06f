"""Gauges in motion: at speed to zero the quasi-static strain, tooth by tooth, and a trace found again."""

import copy
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASE = {
    "results": ["gauge", "dynamic-strain"],
    "gear": {
        "a": {"teeth": 24, "module": "2 mm", "profile_shift": 0.2, "face_width": "10 mm"},
        "b": {"teeth": 36, "module": "2 mm", "face_width": "10 mm"},
    },
    "pair": {"p": {"driver": "a", "driven": "b", "torque": "30 N*m"}},
    "train": {
        "body": {"one": {"inertia": "2e-4 kg*m^2"}, "two": {"inertia": "9e-4 kg*m^2"}},
        "mesh": {"p": {"driver": "one", "driven": "two", "damping_ratio": 0.08}},
        "torque": {"one": "30 N*m"}, "balance": "two",
    },
    "dynamics": {"speed": "0.01 rpm", "harmonics": 64},
    "gauge": {
        "t": {"gear": "a", "grid_length": "0.3 mm"},
        "c": {
            "gear": "b", "fillet": "compression", "grid_length": "0.2 mm", "grid_width": "0.3 mm",
            "direction": "20 deg",
        },
    },
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 1e-2},
}  # fmt: skip
_CACHE = SolutionCache()


def ran(document, folder=Path()):
    scene = build_scene(document, "case", folder)
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes
    return {str(task): one for task, one in outcomes.items()}


def apart(found, name):
    """Largest differences of the static part and of the whole from the quasi-static curve, of its peak."""
    history, motion = (found[f"{stage} of {name}"].data for stage in ("gauge", "dynamic-strain"))
    history, motion = history.history, motion.found
    quasi = np.interp(motion.x, history.x, history.strain[:, 0])
    path = (motion.x > history.x[0]) & (motion.x < history.x[-1])
    # a jump of the load is between two positions
    jumps = np.concatenate([[history.pair.x_start, history.pair.x_end], history.x[1:][np.diff(history.x) < 1e-8]])
    path &= np.abs(motion.x[:, None] - jumps).min(axis=1) > 1e-6
    peak = np.abs(history.strain).max()
    return tuple(float(np.abs(one - quasi)[path].max() / peak) for one in (motion.static, motion.total))


@pytest.mark.dear("t")
@pytest.mark.parametrize("name", ["t", "c"])
def test_at_speed_to_zero_the_strain_is_the_quasi_static_one(name):
    static, whole = apart(ran(CASE), name)
    assert static < 2e-3  # the train interpolates its pair's curves
    assert whole < 2e-2  # 64 harmonics


@pytest.mark.dear
def test_more_harmonics_come_nearer():
    off = []
    for harmonics in (64, 1024):
        document = copy.deepcopy(CASE)
        document["dynamics"]["harmonics"] = harmonics
        off.append(apart(ran(document), "t")[1])
    assert off[1] < 0.3 * off[0]


@pytest.mark.dear
def test_pitch_deviations_belong_to_the_same_tooth_in_motion():
    document = copy.deepcopy(CASE)
    document["gear"]["a"]["spacing_errors"] = [f"{d} um" for d in [0, 0, 0, 4, 0, -3] + [0] * 18]
    document["effects"]["spacing_errors"] = True
    means = []
    for tooth in (4, 6):
        document["gauge"]["t"]["tooth"] = tooth
        found = ran(document)
        assert apart(found, "t")[0] < 5e-3
        means.append(found["dynamic-strain of t"].data.found.static.mean())
    assert means[1] > 1.05 * means[0]  # the tooth with more material carries more


def test_near_resonance_the_strain_is_larger():
    document = copy.deepcopy(CASE)
    document["dynamics"]["speed"] = "4000 rpm"
    found = ran(document)["dynamic-strain of t"].data.found
    assert abs(found.ratio - 1.0) > 0.01
    assert found.displaced[:, found.displacement.tolist().index(0.0)] == pytest.approx(found.total)


@pytest.mark.dear
def test_a_trace_taken_in_motion_is_found_again(tmp_path):
    document = copy.deepcopy(CASE)
    document["dynamics"]["speed"], document["results"] = "4000 rpm", ["dynamic-strain"]
    found = ran(document)["dynamic-strain of t"].data.found
    at = np.arange(0.0, 720.0, 0.4)
    place = np.mod(np.radians(at + 50.0) + math.pi, 2.0 * math.pi) - math.pi
    strain = 30.0 + 0.98e6 * np.interp(place, found.angle, found.total, left=0.0, right=0.0)
    strain += np.random.default_rng(2).normal(0.0, 4.0, at.size)
    rows = "".join(f"{a:.2f},{s:.4f}\n" for a, s in zip(at, strain, strict=True))
    (tmp_path / "t.csv").write_text("angle [deg],strain [um/m]\n" + rows)
    document["gauge"]["t"]["measured"] = {"file": "t.csv", "fit": ["offset", "scale", "shift"]}
    outcome = ran(document, tmp_path)["dynamic-strain of t"]
    values = {one.name.removeprefix("t."): one.value for one in outcome.values}
    for name, wanted in (("offset", 30.0), ("scale", 0.98), ("shift", -50.0)):
        error = values[f"dynamic_measured_{name}_standard_error"]
        assert abs(values[f"dynamic_measured_{name}"] - wanted) < 3.5 * error
    assert replace(outcome.data, gains={}).verdict.startswith("measured strain agrees with")
    # as at rest the verdict depends on what is not computed, and says so
    change = outcome.data.neglected["corner_contact"]
    at_rest = ran({**document, "results": ["gauge"]}, tmp_path)["gauge of t"].data
    assert change == pytest.approx(at_rest.neglected["corner_contact"], rel=1e-9)
    assert any(one.startswith("Gauge t, in motion: corner_contact is off; including it changes the quasi-static peak")
               for one in outcome.remarks)  # fmt: skip
    assert "computed without corner_contact" in outcome.data.verdict
    assert not ran(copy.deepcopy(CASE))["dynamic-strain of t"].data.neglected  # nothing is judged
    assert {table.name for table in outcome.tables} == {"dynamic_strain_t", "dynamic_measured_t"}


def test_a_gauge_whose_pair_is_in_no_train_is_refused():
    document = copy.deepcopy(CASE)
    document["pair"]["q"] = document["pair"]["p"]
    document["gauge"]["t"]["pair"], document["gauge"]["c"]["pair"] = "q", "p"
    with pytest.raises(InputError, match=r'gauge\.t\.pair = "q": is not a mesh of the train'):
        ran(document)
    del document["train"], document["dynamics"]
    with pytest.raises(InputError, match="train"):
        ran(document)
