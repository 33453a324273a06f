"""Torque ripple of a case: what it changes and what it leaves alone, what is refused, and what is said."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASE = Path(__file__).parents[2] / "cases" / "torque_ripple.toml"
CACHE = SolutionCache()
LINEAR = (
    'results=["gear-train", "torque-ripple", "natural-modes", "mesh-force-spectrum", "tooth-force", "dynamic-factor"]'
)
STILL = ("effects.contact_loss=false", "effects.parametric=false", "train.mesh.I.backlash=unlimited")
QUIET = ("neglected=false", "dynamics.speeds=['2000 rpm', '2500 rpm']")
OFF = 'results=["mesh-force-spectrum", "tooth-force", "dynamic-factor"]'
MOTION = 'results=["dynamic-factor"]'


def result(*overrides, cache=CACHE):
    scene = read_scene(CASE, (*QUIET, *overrides))
    return run_plan(scene, make_plan(scene, STAGES), cache=cache)


@cache
def run(*overrides):
    found = result(*overrides)
    tables = {table.name: {column.head: column.values for column in table.columns} for table in found.tables}
    return tables, {value.name: value.value for value in found.values}, found


def test_every_linear_result_has_the_ripple_next_to_the_mesh():
    tables, values, _ = run(LINEAR, *STILL)
    lines = tables["torque_ripple"]
    assert lines["ripple"].tolist() == ["engine"] * 3 + ["load"]
    # the load once a turn of the machine, which turns half as fast
    assert lines["frequency [Hz]"] == pytest.approx(2500.0 / 60.0 * np.array([2, 4, 6, 0.5]))
    # 60, 25 and 8 N m, less what straight lines between entries 5 degrees apart cut off
    assert lines["torque [N.m]"] == pytest.approx([60.0, 25.0, 8.0, 0.05 * 240.0], rel=0.03)
    assert lines["phase [deg]"] == pytest.approx([0.0, 40.0, -20.0, 90.0], abs=0.01)
    spectrum = tables["torque_ripple_spectrum_I"]
    assert spectrum["force [N]"] == pytest.approx(lines["force_I [N]"], rel=1e-12)
    response = tables["torque_response_engine"]
    per_torque = np.hypot(response["force_I_re [N/(N.m)]"], response["force_I_im [N/(N.m)]"])
    near = np.interp(lines["frequency [Hz]"][0], response["frequency [Hz]"], per_torque)
    assert lines["force_I [N]"][0] == pytest.approx(lines["torque [N.m]"][0] * near, rel=0.01)
    critical = tables["torque_ripple_critical_speeds"]
    assert critical["speed [rpm]"][0] == pytest.approx(values["natural_frequency_1"] * 60.0 / 2.0)
    force = tables["tooth_force_I"]
    both = force["force [N]"] + force["increment_from_engine [N]"] + force["increment_from_load [N]"]
    assert force["force_with_others [N]"] == pytest.approx(both, rel=1e-12)
    factors = tables["dynamic_factor_I"]
    assert np.all(factors["dynamic_factor"] > 1.1 * factors["dynamic_factor_without_ripple"])
    plain = run(OFF, *STILL, "effects.torque_ripple=false")[0]["dynamic_factor_I"]
    assert np.array_equal(factors["dynamic_factor_without_ripple"], plain["dynamic_factor"])
    assert values["I.force_by_torque_ripple"] <= float(np.sum(lines["force_I [N]"])) * (1.0 + 1e-12)


@pytest.mark.dear("motion")
@pytest.mark.parametrize("effects", [STILL, ()], ids=["linear", "motion"])
def test_ripple_without_amplitude_and_ripple_that_is_off_change_no_bit(effects):
    silent = "train.torque_ripple={ a = { body = 'engine', order = 3, amplitude = '0 N*m' } }"
    off = run(OFF, *effects, "effects.torque_ripple=false")[0]
    none = run(OFF, *effects, silent)[0]
    never = run(OFF, *effects, "train.torque_ripple={}", "effects.torque_ripple=false")[0]
    for table in never:
        for head, column in never[table].items():
            assert np.array_equal(off[table][head], column, equal_nan=column.dtype.kind == "f"), (table, head)
            assert np.array_equal(none[table][head], column, equal_nan=column.dtype.kind == "f"), (table, head)
    assert set(never) == set(off) == set(none)


@pytest.mark.dear
def test_a_shared_cache_sees_every_key_and_the_content_of_files(tmp_path):
    shared = SolutionCache()
    base = ("results=['torque-ripple', 'mesh-force-spectrum']",)
    table = "train.torque_ripple={{ a = {{ body = 'engine', {} }} }}"
    ways = [
        "order = 2, amplitude = '10 N*m'", "order = 3, amplitude = '10 N*m'", "order = 2, amplitude = '11 N*m'",
        "order = 2, amplitude = '10 N*m', phase = '10 deg'", "order = 2, order_of = 'wheel', amplitude = '10 N*m'",
        "frequency = '70 Hz', amplitude = '10 N*m'", "order = 2, amplitude_over_mean = 0.1",
    ]  # fmt: skip
    seen = set()
    for way in ways:
        found = result(*base, table.format(way), cache=shared)
        seen.add(tuple(float(v.value) for v in found.values) + tuple(found.tables[0].columns[5].values.tolist()))
    assert len(seen) == len(ways)
    file = tmp_path / "torque.csv"
    key = table.format(f"file = '{file}', harmonics = 2")
    forces = []
    for size in (10.0, 20.0):
        file.write_text(f"angle [deg],torque [N*m]\n0,{size}\n90,{-size}\n180,{size}\n", "utf-8")
        forces.append(float(result(*base, key, cache=shared).values["I.force_by_torque_ripple"].value))
    assert forces[1] == pytest.approx(2.0 * forces[0], rel=1e-12)
    # the ripple asks for no new teeth
    before = shared.solutions.computed
    result(*base, key, "effects.torque_ripple=true", cache=shared)
    assert shared.solutions.computed == before


@pytest.mark.parametrize(
    ("way", "said"),
    [
        ("body = 'motor', order = 2, amplitude = '1 N*m'", 'is not a body of this case'),
        ("body = 'engine', order = 2, order_of = 'x', amplitude = '1 N*m'", "order_of.*is not a body"),
        ("body = 'engine', order = 0, amplitude = '1 N*m'", "must be greater than zero.*constant torque to"),
        ("body = 'engine', frequency = '0 Hz', amplitude = '1 N*m'", "must be greater than zero.*constant torque"),
        ("body = 'engine', order = -2, amplitude = '1 N*m'", "must be greater than zero"),
        ("body = 'engine', order = 1e5, amplitude = '1 N*m'", "exceeds 10,000"),
        ("body = 'engine', frequency = '2e6 Hz', amplitude = '1 N*m'", "exceeds 1,000,000 Hz"),
        ("body = 'engine', order = 2, amplitude = '-1 N*m'", "must not be negative"),
        ("body = 'engine', order = 2, amplitude_over_mean = -0.1", "greater than or equal to 0"),
        ("body = 'engine', order = 2, amplitude = '1 N'", "is not a torque"),
        ("body = 'engine', amplitude = '1 N*m'", "order.*is required, or frequency"),
        ("body = 'engine', order = 2, frequency = '10 Hz', amplitude = '1 N*m'", "order.*is required, or frequency"),
        ("body = 'engine', order = 2", r"amplitude = \(not given\): must be specified in one way"),
        ("body = 'engine', order = 2, amplitude = '1 N*m', amplitude_over_mean = 0.1",
            r"amplitude = \(both\): must be specified in one way"),
        ("body = 'wheel', order = 2, amplitude_over_mean = 0.1", "refers to the constant torque of body wheel"),
        ("body = 'engine', frequency = '10 Hz', order_of = 'wheel', amplitude = '1 N*m'",
            "is not used with a fixed frequency"),
        ("body = 'engine', file = 'data/engine_torque.csv', order = 2", "contradicts file"),
        ("body = 'engine', order = 2, amplitude = '1 N*m', harmonics = 4", "requires file"),
        ("body = 'engine', file = 'nowhere.csv'", "file not found"),
        ("body = 'engine', file = 'data/measured_pinion_lead.csv'", "requires the columns angle"),
        ("body = 'engine', order = 1e-40, amplitude = '1 N*m'", "is outside the plausible range"),
    ],
)  # fmt: skip
def test_nonsense_is_refused_with_its_key(way, said):
    with pytest.raises(InputError, match=said):
        result(LINEAR, *STILL, f"train.torque_ripple={{ a = {{ {way} }} }}")


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("0,1\n90,-1\n180,0.5", "begins with 1 N m and ends with 0.5 N m: not a full period"),
        ("0,1\n90,-1\n80,1", "with angle strictly increasing"),
        ("0,1\n180,1", "needs at least 3 lines"),
        ("0,1\n90,nan\n180,1", "is not finite"),
        ("0,1\n90,x\n180,1", "not a number"),
    ],
)
def test_files_that_are_no_period_are_refused(tmp_path, lines, said):
    file = tmp_path / "torque.csv"
    file.write_text(f"angle [deg],torque [N*m]\n{lines}\n", "utf-8")
    with pytest.raises(InputError, match=said):
        result(LINEAR, *STILL, f"train.torque_ripple={{ a = {{ body = 'engine', file = '{file}' }} }}")


def test_a_mean_torque_and_harmonics_that_are_left_out_are_said(tmp_path):
    file = tmp_path / "torque.csv"
    file.write_text("time [s],torque [N*m]\n0,12\n0.004,8\n0.006,8\n0.01,12\n", "utf-8")
    key = f"train.torque_ripple={{ a = {{ body = 'engine', file = '{file}', harmonics = 1 }} }}"
    found = result("results=['torque-ripple']", key)
    assert any("mean torque of 9.6 N m in its file ignored" in note for note in found.remarks)
    assert any("harmonics above 1 omitted" in note for note in found.remarks)
    assert found.tables[0].columns[3].values.tolist() == pytest.approx([100.0])


def test_an_effect_without_data_and_data_without_their_effect():
    with pytest.raises(InputError, match="has no effect: train\\.torque_ripple is not specified"):
        result(MOTION, "train.torque_ripple={}")
    with pytest.raises(
        InputError,
        match=r'is required by "torque-ripple": the torques of train\.torque_ripple are its load',
    ):
        result("results=['torque-ripple']", "effects.torque_ripple=false")
    with pytest.raises(InputError, match="is also the name of a mesh; excitations must have unique names"):
        result(MOTION, "train.torque_ripple={ I = { body = 'engine', order = 2, amplitude = '1 N*m' } }")
    said = result("results=['gear-train']", "effects={ start = 'none' }").remarks
    assert any("train.torque_ripple ignored because" in note for note in said)
    described = read_scene(CASE, ("effects={ start = 'described' }",)).case.effects
    assert described.torque_ripple
    without = read_scene(CASE, ("effects={ start = 'described' }", "train.torque_ripple={}")).case.effects
    assert not without.torque_ripple


@pytest.mark.dear
def test_motion_is_closed_over_the_common_period_or_says_what_it_shifts():
    tables, _, found = run(MOTION, "dynamics.speeds=['2500 rpm']")
    sweep = tables["dynamic_factor_I"]
    assert sweep["motion"].tolist() == ["periodic"]
    assert not any("mesh periods; nearest frequency with a common" in note for note in found.remarks)
    linear = ("effects.contact_loss=false", "train.mesh.I.backlash=unlimited")
    odd = "train.torque_ripple={ a = { body = 'engine', frequency = '61.23456 Hz', amplitude = '20 N*m' } }"
    shifted = result(MOTION, *linear, odd)
    assert any("no common period with the meshes within 2,000 mesh periods" in note for note in shifted.remarks)
    slow = "train.torque_ripple={ a = { body = 'engine', frequency = '0.01 Hz', amplitude = '20 N*m' } }"
    scene = read_scene(CASE, (*QUIET, MOTION, slow))
    with pytest.raises(InputError, match=r"^train.torque_ripple.a = 0.01 Hz.*treat so slow a torque as constant"):
        make_plan(scene, STAGES)


@pytest.mark.dear
def test_a_weak_ripple_in_motion_adds_what_the_linear_train_says():
    """Constant mesh stiffness: the largest mesh force grows by the ripple's line, for the mesh is much faster."""
    ripple = "train.torque_ripple={ a = { body = 'engine', order = 3, amplitude = '10 N*m' } }"
    line = run("results=['torque-ripple']", ripple, "dynamics.speed=2000 rpm")[0]["torque_ripple"]["force_I [N]"][0]
    still = "effects.parametric=false"
    tables, _, found = run(MOTION, ripple, still, "dynamics.speeds=['2000 rpm']", "dynamics.tolerance=1e-6")
    mean = 120.0 / (0.0345 * math.cos(math.radians(20.0)))
    more = (
        tables["dynamic_factor_I"]["mesh_force_factor"] - tables["dynamic_factor_I"]["mesh_force_factor_without_ripple"]
    )
    assert more[0] * mean == pytest.approx(line, rel=0.03)
    assert found.remarks


def test_python_takes_the_same_tables():
    found = fegear.run(
        str(CASE), {"results": ["torque-ripple"], "train.torque_ripple": {
            "a": {"body": "engine", "order": 2, "amplitude": "10 N*m"}}},
    )  # fmt: skip
    assert found.values["I.force_by_torque_ripple"].value > 0.0


@pytest.mark.dear
def test_root_stress_and_design_charts_take_it_too():
    """Root stress at the worst phases bounds that at the case's; a chart's unmodified gears have the sweep's factor."""
    stress = ("results=['dynamic-root-stress']", "pair.I.root_stress={ source = 'heywood' }", *STILL)
    tables, values, _ = run(*stress)
    _, plain, _ = run(*stress, "effects.torque_ripple=false")
    history = tables["root_stress_history_I_pinion"]
    added = history["stress [MPa]"] - history["stress_own_mesh [MPa]"]
    assert np.abs(added).max() > 0.02 * history["stress_own_mesh [MPa]"].max()
    largest = "I.driver.largest_dynamic_root_tension"
    assert values[f"{largest}_own_mesh"] == plain[largest]
    assert values[f"{largest}_any_phase"] > values[f"{largest}_own_mesh"]
    speed = "dynamics.speeds=['3000 rpm']"
    chart = ("results=['design-chart']", "dynamics.chart={ amounts = [1.0], lengths = [1.0] }", speed)
    with_it = run(*chart)[1]["design_chart.unmodified"]
    assert with_it == pytest.approx(run(MOTION, speed)[1]["I.largest_dynamic_factor"], rel=1e-3)
    assert with_it > 1.02 * run(*chart, "effects.torque_ripple=false")[1]["design_chart.unmodified"]
