"""Traces of gauges as rigs have them: output of the bridge in place of the strain, time in place of the angle."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.units import to_si, unit_size
from fegear.case.built.angle_of_time import _between, steady_turning
from fegear.case.built.gauges import check_gauge, gauge_of
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

FIT = ["offset", "scale", "shift"]
RPM = math.pi / 30.0
_CACHE = SolutionCache()


def case(measured=None, **pair):
    gauge = {"gear": "b", "grid_length": "0.3 mm"}
    return {
        "results": ["gauge"],
        "gear": {
            "a": {"teeth": 20, "module": "2 mm", "face_width": "10 mm", "profile_shift": 0.1},
            "b": {"teeth": 31, "module": "2 mm", "face_width": "10 mm"},
        },
        "pair": {"p": {"driver": "a", "driven": "b", "torques": ["8 N*m", "16 N*m"], **pair}},
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


def written(folder, heads, *columns):
    rows = "".join(",".join(f"{value:.9g}" for value in row) + "\n" for row in zip(*columns, strict=True))
    (folder / "t.csv").write_text(f"{heads}\n{rows}")


ANGLE = np.arange(-30.0, 31.0)
STRAIN = 4e-4 - 1e-6 * ANGLE**2 / 4.0


@pytest.mark.parametrize(
    ("head", "size", "more"),
    [
        ("mV/V", 1e-3, {}),
        ("uV/V", 1e-6, {"active_arms": 2}),
        ("mV/V", 1e-3, {"active_arms": 2.6, "amplification": 500.0}),
        ("V/V", 1.0, {"active_arms": 4}),
        ("mV", 1e-3, {"excitation": "2500 mV"}),
        ("V", 1.0, {"excitation": "5 V", "amplification": 1000}),
    ],
)
def test_the_output_of_a_bridge_is_four_times_it_over_gauge_factor_and_arms(head, size, more, tmp_path):
    """In the unit of the head, and in one that the case gives."""
    k, n = 2.07, more.get("active_arms", 1)
    volts = to_si(more["excitation"], "voltage") if "excitation" in more else 1.0
    out = STRAIN * k * n / 4.0 * more.get("amplification", 1.0) * volts / size
    for file_head, given in ((f"strain [{head}]", {}), ("strain", {"strain": head})):
        written(tmp_path, f"angle [deg],{file_head}", ANGLE, out)
        found = read(case({"file": "t.csv", "gauge_factor": k, **given, **more}), tmp_path)
        assert found.strain == pytest.approx(STRAIN, rel=1e-7)
        assert f"strain from {head} with gauge factor 2.07 and {n} active arm" in found.reading


def test_kinds_of_units_without_a_dimension_are_told_apart():
    assert unit_size("mV/V", "bridge_output") == 1e-3
    for unit, kind in (("mV/V", "strain"), ("um/m", "bridge_output"), ("V", "strain"), ("V/m", "bridge_output")):
        with pytest.raises(InputError, match="is not a "):
            unit_size(unit, kind)


@pytest.mark.parametrize(
    ("heads", "measured", "rule"),
    [
        ("angle [deg],strain [mV/V]", {}, ("gauge_factor = (not given): is required: column strain is the output of "
         "the bridge (mV/V); set gauge_factor = 2.05 (from the package of the gauge) and active_arms = 1 (quarter")),
        ("angle [deg],strain [mV]", {"gauge_factor": 2.0}, ('excitation = (not given): is required: column strain is a '
         'voltage (mV); set excitation = "5 V"')),
        ("angle [deg],strain [mV/V]", {"gauge_factor": 2.0, "excitation": "5 V"}, "excitation = 5 V: has no effect"),
        ("angle [deg],strain [um/m]", {"gauge_factor": 2.0}, ("gauge_factor = 2: has no effect: column strain is a "
         'strain (um/m); remove it, or set strain = "mV/V"')),
        ("angle [deg],strain [um/m]", {"active_arms": 2}, "active_arms = 2: has no effect"),
        ("angle [deg],strain [mV/V]", {"gauge_factor": -2.0}, "greater than 0"),
        ("angle [deg],strain [mV/V]", {"gauge_factor": 2.0, "active_arms": 5}, "less than or equal to 4"),
        ("angle [deg],strain [mV/V]", {"gauge_factor": 2.0, "amplification": 0}, "greater than 0"),
        ("angle [deg],strain [MPa]", {}, "is not a strain"),
        ("angle [deg],strain [mA]", {}, 'unknown unit "mA"'),
        ("time [s],strain [um/m]", {}, ('speed = (not given): is required: "t.csv" has the time in column time and no '
         "column angle; set speed to the constant speed of the gear of the gauge")),
        ("angle [deg],strain [um/m]", {"speed": "100 rpm"}, 'speed = 100 rpm: has no effect: "t.csv" has the angle'),
        ("t [s],strain [um/m]", {"speed": "100 rpm"}, "requires a column angle; it has"),
        ("angle [deg],strain [um/m]", {"time_column": "t"}, "requires a column t"),
        ("time [mm],strain [um/m]", {"speed": "100 rpm"}, "is not a time"),
        ("angle [deg],strain [um/m]", {"time_column": "angle"}, "is the column of the angle"),
        ("angle [deg],strain [um/m]", {"torque_column": "time"}, "is the column of the torque"),
    ],
)  # fmt: skip
def test_refusals_are_one_sentence(heads, measured, rule, tmp_path):
    written(tmp_path, heads, ANGLE, 1e6 * STRAIN if "um/m" in heads else STRAIN)
    with pytest.raises(InputError) as refused:
        read(case({"file": "t.csv", **measured}), tmp_path)
    assert rule in str(refused.value)
    assert str(refused.value).startswith("gauge.g.measured")
    assert "\n" not in str(refused.value)


def test_times_have_to_ascend(tmp_path):
    written(tmp_path, "time [ms],strain [um/m]", np.abs(ANGLE), 1e6 * STRAIN)
    with pytest.raises(InputError, match=r"must have ascending times in column time; sort the lines"):
        read(case({"file": "t.csv", "speed": "100 rpm"}), tmp_path)


@pytest.fixture(scope="module")
def history():
    return ran(case()).data.history


def over_time(history, turned, torque, arms=2, k=2.11):
    """Output of a half bridge [mV/V] over rotations of gear b [rad]: gain 1.02, 37 deg lag, noise of 2 um/m."""
    place = np.mod(turned - math.radians(37.0) + math.pi, 2.0 * math.pi) - math.pi
    low, high = (np.interp(place, history.angle, one, left=0.0, right=0.0) for one in history.strain.T)
    strain = 1.02 * np.where(torque < 12.0, low, high) * torque / np.where(torque < 12.0, 8.0, 16.0)
    noise = np.random.default_rng(5).normal(0.0, 2e-6, turned.size)
    return (strain + 25e-6 + noise) * k * arms / 4.0 * 1e3


def test_a_trace_in_mv_per_v_over_time_is_recovered(history, tmp_path):
    """A staircase of the torque at 981.6 rpm of the driver, where 1000 rpm are said: over 13 turns some 90 deg."""
    turns, samples = 13, 400
    turned = np.arange(turns * samples) / samples * 2.0 * math.pi
    torque = np.where(turned < 6.5 * 2.0 * math.pi, 8.0, 16.0)
    speed = 981.6 * RPM * 20 / 31
    out = over_time(history, turned, torque)
    written(tmp_path, "time [ms],strain [mV/V],torque [N*m]", 1e3 * turned / speed + 500.0, out, torque)
    measured = {"file": "t.csv", "fit": FIT, "gauge_factor": 2.11, "active_arms": 2}
    outcome = ran(case(measured, speed="1000 rpm"), tmp_path)
    found = {value.name.removeprefix("g."): value.value for value in outcome.values}
    assert found["measured_scale"] == pytest.approx(1.02, abs=3.5 * found["measured_scale_standard_error"])
    assert found["measured_shift"] == pytest.approx(37.0, abs=0.3)
    # a tenth of a degree over the trace is left, and all torques share one shift
    assert [level.gain for level in outcome.data.over_torque.levels] == pytest.approx([1.02] * 2, abs=8e-3)
    (said,) = (note for note in outcome.remarks if "file of the trace read with" in note)
    of_gear, of_driver = (
        read(case({**measured, "speed": speed, **more}), tmp_path).reading
        for speed, more in (("638.7 rpm", {}), ("990 rpm", {"shaft": "driver"}))
    )
    for reading in (said, of_gear, of_driver):
        read_speed = float(reading.split("rotation from the time at ")[1].split()[0])
        assert read_speed == pytest.approx(981.6 * 20 / 31, rel=2e-5)
        assert "rpm, the period of the trace (stated: 6" in reading
        assert "not constant" not in reading
        assert "strain from mV/V with gauge factor 2.11 and 2 active arms (half bridge)" in reading


def test_one_turn_takes_the_speed_as_stated(history, tmp_path):
    turned = np.linspace(0.0, 2.0 * math.pi, 700)
    written(tmp_path, "t [s],strain [mV/V]", turned / (500.0 * RPM), over_time(history, turned, np.full(700, 16.0)))
    measured = {"file": "t.csv", "fit": FIT, "gauge_factor": 2.11, "active_arms": 2, "time_column": "t"}
    found = read(case({**measured, "speed": "500 rpm"}), tmp_path)
    assert found.angle == pytest.approx(turned, abs=1e-7)
    assert "rotation from the time at 500 rpm, the stated speed" in found.reading
    of_pair = read(case(measured, speed="775 rpm"), tmp_path)
    assert of_pair.angle == pytest.approx(turned, abs=1e-7)
    assert "rotation from the time at 500 rpm, the speed of pair p" in of_pair.reading


def test_a_speed_that_is_not_constant_is_said_and_noise_has_no_period():
    time = np.linspace(0.0, 1.2, 20_000)
    turns = time * 1000.0 / 60.0

    def pulse(at):
        return np.exp(-((np.mod(at + 0.3, 1.0) - 0.5) ** 2) / 2e-4)

    noise = np.random.default_rng(2).normal(0.0, 0.02, time.size)
    wandering = steady_turning(time, pulse(turns + 0.01 * np.sin(5.0 * time)) + noise, 1000.0 * RPM)
    assert wandering.found
    assert 1.5 < math.degrees(wandering.wander) < 6.0
    steady = steady_turning(time, pulse(1.03 * turns) + noise, 1000.0 * RPM)
    assert steady.speed == pytest.approx(1030.0 * RPM, rel=2e-5)
    assert math.degrees(steady.wander) < 1.0
    for signal in (noise, pulse(1.08 * turns)):  # nothing, and a speed that is too far from the stated one
        found = steady_turning(time, signal, 1000.0 * RPM)
        assert (found.speed, found.found) == (1000.0 * RPM, False)


@pytest.mark.parametrize("vertex", [-0.4, 0.0, 0.3])
def test_a_minimum_between_steps_is_that_of_the_parabola_through_three(vertex):
    steps = np.arange(-3.0, 4.0)
    values = 2.0 + 5.0 * (steps - vertex) ** 2
    assert _between(values, 3) == pytest.approx(vertex, abs=1e-12)
    assert _between(values, 0) == _between(values, 6) == 0.0  # at an end there is none
    assert _between(-values, 3) == 0.0
