"""Traces of gauges with a column of the torque: levels told apart, run-up left out, gain over torque."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of
from fegear.base.printed import figures
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.gauges import check_gauge, gauge_of
from fegear.case.built.trace_levels import change_along
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

TORQUES = (8.0, 16.0, 24.0)
FIT = ["offset", "scale", "shift"]
_CACHE = SolutionCache()


def case(measured=None, torques=TORQUES):
    gauge = {"gear": "a", "grid_length": "0.3 mm"}
    return {
        "results": ["gauge"],
        "gear": {
            "a": {"teeth": 20, "module": "2 mm", "face_width": "10 mm", "profile_shift": 0.1},
            "b": {"teeth": 31, "module": "2 mm", "face_width": "10 mm"},
        },
        "pair": {"p": {"driver": "a", "driven": "b", "torques": [f"{one} N*m" for one in torques]}},
        "gauge": {"g": gauge if measured is None else gauge | {"measured": measured}},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
        "accuracy": {"tolerance": 1e-2},
    }


def ran(document, folder=Path()):
    scene = build_scene(document, "case", folder)
    results = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE)
    return next(one for task, one in results.outcomes.items() if str(task) == "gauge of g")


def read(document, folder):
    scene = build_scene(document, "case", folder)
    check_gauge(scene, "g")
    return gauge_of(scene, "g").measured


@pytest.fixture(scope="module")
def history():
    return ran(case()).data.history


def written(folder, history, torque, *, gain=lambda torque: 1.02 + 0.0 * torque, sensor=lambda torque: torque):
    """A trace of a rig that holds its torque for `steps` of 0.5 deg; strain between the levels by interpolation."""
    angle = 0.5 * np.arange(torque.size)
    place = np.mod(np.radians(angle - 50.0) + math.pi, 2.0 * math.pi) - math.pi
    levels = np.stack([np.interp(place, history.angle, one, left=0.0, right=0.0) for one in history.strain.T])
    per_torque = np.stack([levels[k] / TORQUES[k] for k in range(len(TORQUES))])
    at = np.clip(np.interp(torque, TORQUES, range(len(TORQUES))), 0.0, len(TORQUES) - 1.0)
    below = np.minimum(at.astype(int), len(TORQUES) - 2)
    own = per_torque[below, range(at.size)] * (1.0 - at + below) + per_torque[below + 1, range(at.size)] * (at - below)
    noise = np.random.default_rng(7)
    strain = 30.0 + 1e6 * gain(torque) * torque * own + noise.normal(0.0, 2.0, at.size)
    said = sensor(torque) * (1.0 + noise.normal(0.0, 0.01, at.size))
    rows = "".join(f"{a % 360.0:.2f},{s:.4f},{t:.4f}\n" for a, s, t in zip(angle, strain, said, strict=True))
    (folder / "t.csv").write_text("angle [deg],strain [um/m],torque [N*m]\n" + rows)


def staircase(*levels, turns=3, ramp=0.3):
    """Torque of each sample, from zero up to one level after the other."""
    parts, last = [], 0.0
    for level in levels:
        parts += [np.linspace(last, level, int(720 * ramp)), np.full(720 * turns, level)]
        last = level
    return np.concatenate(parts)


def values(outcome):
    return {one.name.removeprefix("g."): one.value for one in outcome.values}


def test_levels_are_told_apart_and_the_gain_is_found_at_each(history, tmp_path):
    written(tmp_path, history, staircase(*TORQUES))
    outcome = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    found = values(outcome)
    assert found["measured_scale"] == pytest.approx(1.02, abs=3.5 * found["measured_scale_standard_error"])
    assert found["measured_shift"] == pytest.approx(50.0, abs=0.05)
    levels = outcome.data.over_torque.levels
    assert [one.torque for one in levels] == pytest.approx(TORQUES)
    for one in levels:
        assert one.gain == pytest.approx(1.02, abs=3.5 * one.gain_scatter)
        assert one.mean_torque == pytest.approx(one.torque, rel=5e-3)
        assert one.turns == pytest.approx(3.0, abs=0.1)
    assert levels[-1].found is outcome.data.compared  # the verdict is that at the nominal torque
    assert abs(found["gain_change_over_torque"]) < 0.01
    assert outcome.data.over_torque.left_out == ""
    partly = replace(outcome.data.over_torque, partial=("8 N m", "40 N m"))
    assert partly.left_out == "samples at 8 N m, 40 N m do not cover the engagement of the tooth; left out"
    (linear,) = (one for one in outcome.remarks if "over 3 torques" in one)
    assert ", linear: the largest change from the nominal torque is " in linear
    (said,) = (one for one in outcome.remarks if "file of the trace read with" in one)
    left_out = int(said.split("read with ")[1].split()[0])
    assert 0.8 * 3 * 216 < left_out < 3 * 216  # ramps without their ends, which are within the band
    table = next(one for one in outcome.tables if one.name == "gauge_torques_g")
    assert len(table.columns) == 11
    assert any(one.key == "gauge_torques_g" for one in outcome.figures)


@pytest.mark.parametrize("too_high", [1.5, -1.5])
def test_a_torque_that_reads_too_much_is_said_with_how_much(history, tmp_path, too_high):
    """At the torque read the strain is that of the torque that was there."""
    written(tmp_path, history, staircase(*TORQUES) - too_high, sensor=lambda torque: torque + too_high)
    outcome = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    found, gain = outcome.data.over_torque.torque_zero
    assert found == pytest.approx(too_high, abs=0.15)
    assert gain == pytest.approx(1.02, abs=5e-3)
    (said,) = (one for one in outcome.remarks if "over 3 torques" in one)
    assert class_of(said) is NoteClass.FAILS
    assert f"check the zero of the torque: a torque that reads {figures(abs(found), 2)} N m too " in said
    assert said.endswith(f"too {'high' if too_high > 0.0 else 'low'} would explain it, measured / computed strain then "
                         f"{gain:.3f}.")  # fmt: skip
    assert "; measured / computed strain is not linear over torque." in outcome.answer.sentences[0]
    # behind verdicts that fail themselves, where its own does not
    assert NoteClass.FAILS <= outcome.answer.rank < NoteClass.BEYOND_TOLERANCE


def test_a_gain_that_no_zero_of_the_torque_explains_names_none(history, tmp_path):
    """It falls and rises again."""
    written(tmp_path, history, staircase(*TORQUES), gain=lambda torque: 1.0 - 0.1 * (np.abs(torque - 16.0) < 2.0))
    outcome = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    assert not outcome.data.over_torque.linear
    assert outcome.data.over_torque.torque_zero is None
    assert any(one.endswith("(load, scatter); check the zero of the torque.") for one in outcome.remarks)


@pytest.mark.parametrize("restarts", [True, False])
def test_the_angle_may_be_that_of_the_mate(tmp_path, restarts):
    """31 of its turns are 20 of the gear's turns the other way round: gauge on a, 20 teeth, encoder on b, 31 teeth."""
    turned = np.arange(0.0, 3.0 * 360.0, 0.5)
    said = np.mod(turned, 360.0) if restarts else turned
    rows = "".join(f"{a:.2f},{100.0 + k % 7}\n" for k, a in enumerate(said))
    (tmp_path / "t.csv").write_text("angle [deg],strain [um/m]\n" + rows)
    of_mate, of_gear = (
        read(case({"file": "t.csv", "fit": FIT, "shaft": shaft}), tmp_path).angle for shaft in ("driven", "driver")
    )
    assert of_mate == pytest.approx(np.radians(turned) * 31.0 / 20.0, abs=1e-9)
    assert of_gear == pytest.approx(np.radians(turned), abs=1e-9)


def test_plateaus_that_the_pair_does_not_have_are_named(history, tmp_path):
    """And those of which a longer run is compared: a staircase up and down again."""
    written(tmp_path, history, staircase(8.0, 16.0, 24.0, 16.0, 8.0, turns=2))
    one = read(case({"file": "t.csv", "fit": FIT}, torques=(24.0,)), tmp_path)
    assert re.search(
        r"left out \(steady at (8|8\.0\d), (16|15\.9|16\.1) N m: add to pair\.p\.torques to comp", one.reading
    )
    every = read(case({"file": "t.csv", "fit": FIT}), tmp_path)
    assert [level.level for level in every.levels] == pytest.approx(TORQUES)
    assert re.search(r"left out \(shorter runs at (8|8\.0\d), (16|15\.9|16\.1) N m\)", every.reading)
    with pytest.raises(InputError, match=r'\.torques \(\["8[.0-9]* N\*m", "1[.0-9]+ N\*m", "2[.0-9]+ N'):
        read(case({"file": "t.csv"}, torques=(40.0,)), tmp_path)


@pytest.mark.dear
def test_a_staircase_without_a_column_of_the_torque_is_recognised(history, tmp_path):
    for name, levels in (("steps", TORQUES), ("steady", (24.0, 24.0, 24.0))):
        written(tmp_path, history, staircase(*levels, turns=2, ramp=0.0))
        text = (tmp_path / "t.csv").read_text().replace("torque [N*m]", "moment")
        (tmp_path / f"{name}.csv").write_text(text)
    steps, steady = (ran(case({"file": f"{name}.csv", "fit": FIT}), tmp_path) for name in ("steps", "steady"))
    (said,) = (one for one in steps.remarks if "from turn to turn" in one)
    assert said.endswith("file per torque), or bond or leads of the gauge came loose.")
    assert any("torque or gauge were not steady from turn to turn" in one for one in steps.answer.sentences)
    assert not any("from turn to turn" in one for one in steady.remarks)


@pytest.mark.dear
def test_the_run_up_does_not_count(history, tmp_path):
    """One torque only: with its run-up taken for samples at the torque the gain is a tenth too small at least."""
    written(tmp_path, history, staircase(24.0, turns=1, ramp=1.0))
    nominal = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    text = (tmp_path / "t.csv").read_text()
    (tmp_path / "whole.csv").write_text(text.replace("torque [N*m]", "moment"))
    whole = ran(case({"file": "whole.csv", "fit": FIT}), tmp_path)
    assert whole.data.compared.scale < 0.9
    assert values(nominal)["measured_scale"] == pytest.approx(1.02, rel=5e-3)
    assert "gain_change_over_torque" not in values(nominal)
    assert not any(one.key == "gauge_torques_g" for one in nominal.figures)


def test_a_gain_that_changes_with_the_torque_is_named(history, tmp_path):
    """A torque sensor with a zero of 0.8 N m: what it calls 8 N m is 7.2."""
    written(tmp_path, history, staircase(7.2, 15.2, 23.2), sensor=lambda torque: torque + 0.8)
    outcome = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    changes = [one.gain_at_mean for one in outcome.data.over_torque.levels]
    assert changes == pytest.approx([1.02 * (t - 0.8) / t for t in TORQUES], rel=6e-3)
    assert values(outcome)["gain_change_over_torque"] == pytest.approx(changes[0] / changes[2] - 1.0, rel=1e-9)
    (said,) = (one for one in outcome.remarks if "over 3 torques" in one)
    assert "not linear: at 8 N m it is 6." in said
    assert "below that at the nominal torque, beyond ±" in said
    assert any("not linear" in one for one in outcome.answer.sentences)


def test_a_mean_torque_off_the_level_is_said_and_taken_out_between_torques(history, tmp_path):
    written(tmp_path, history, staircase(8.0, 16.0, 24.6))
    outcome = ran(case({"file": "t.csv", "fit": FIT}), tmp_path)
    last = outcome.data.over_torque.levels[-1]
    assert last.gain == pytest.approx(1.02 * 24.6 / 24.0, rel=3e-3)
    assert last.gain_at_mean == pytest.approx(1.02, rel=4e-3)
    (said,) = (one for one in outcome.remarks if "mean of the measured torque" in one)
    assert "% above the nominal 24 N m" in said


def test_a_ramp_through_a_torque_is_no_level(history, tmp_path):
    slow = np.concatenate([np.linspace(1.0, 24.0, 720 * 15), np.full(720 * 2, 24.0)])
    written(tmp_path, history, slow)
    measured = read(case({"file": "t.csv"}), tmp_path)
    assert [one.level for one in measured.levels] == pytest.approx([24.0])
    assert "samples at 16 N m left out (torque changes by " in measured.reading
    assert change_along(np.linspace(95.0, 105.0, 400)) == pytest.approx(0.1, rel=1e-2)
    assert change_along(np.full(50, 3.0)) == pytest.approx(0.0, abs=1e-12)


def test_signs_and_senses_do_not_change_levels(history, tmp_path):
    written(tmp_path, history, staircase(*TORQUES, turns=1))
    one, other = (read(case({"file": "t.csv", "reverse": way}), tmp_path) for way in (False, True))
    assert [a.strain.size for a in one.levels] == [a.strain.size for a in other.levels]
    assert np.array_equal(one.angle, -other.angle)


@pytest.mark.parametrize(
    ("torque", "measured", "rule"),
    [
        (staircase(8.0, 16.0), {}, "of the nominal torque of pair p, 24 N m; it has runs at 8, 16 N m; set pair"),
        (staircase(3.0), {}, "add the measured torques to pair.p.torques"),
        (-staircase(24.0), {}, "specify positive torques"),
        (staircase(24.0 * 31 / 20), {}, "on the driven gear is 24 N*m (divided by the ratio 1.55)"),
        (staircase(24.0), {"torque_column": "strain"}, "is the column of the strain"),
        (staircase(24.0), {"torque_column": "load"}, "requires a column load"),
        (staircase(24.0), {"torque_band": 0.6}, "less than or equal to 0.5"),
    ],
)  # fmt: skip
def test_refusals_are_one_sentence(torque, measured, rule, history, tmp_path):
    rows = "".join(f"{0.5 * i % 360.0},{i % 97},{t:.3f}\n" for i, t in enumerate(torque))
    (tmp_path / "t.csv").write_text("angle [deg],strain [um/m],torque [N*m]\n" + rows)
    with pytest.raises(InputError) as refused:
        read(case({"file": "t.csv", **measured}), tmp_path)
    assert rule in str(refused.value)
    assert str(refused.value).startswith("gauge.g.measured")
    assert "\n" not in str(refused.value)
