"""What fegear hands out goes through pickle and back, is equal to its copies, and keeps nothing of its caller."""

from __future__ import annotations

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.arrays import same
from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Stage, Task
from fegear.results.catalogue import STAGES
from fegear.workbench.run import _scene as fegear_scene

ROOT = Path(__file__).parents[2]
#: Cases of a second at most, with results of most subjects between them.
QUICK = ("lin_table1", "mark_tip_relief", "litvin_profile_angle")
#: What takes minutes; one of its kind is among the others.
DEAR = {"helical_flank_design", "robust_pair", "root_stress_population", "nasa_relief_design"}
ALL = sorted(path.stem for path in (ROOT / "cases").glob("*.toml"))
#: Results that no case of the folder asks for, or only a dear one: case, and what is asked of it instead.
FURTHER = {
    "sources/lin_huston_coy_fig5a": {},
    "sources/lin_townsend_oswald_fig4": {},
    "sources/litvin_fig01": {},
    "sources/litvin_fig10": {},
    "sources/mark_fig03": {},
    "planetary_set": {"results": ["planet-motion"], "planetary.P.speeds.count": 3},
    "four_square_dynamics": {"results": ["dynamic-strain"], "gauge": {"t": {"gear": "test", "pair": "I"}}},
    "robust_pair": {"robustness": {"draws": 20}, "accuracy": {"tolerance": 0.05}},
    "nasa_relief_design": {"results": ["robustness"], "accuracy": {"tolerance": 0.05}},
    "two_stage_gearbox": {
        "results": ["gear-mesh-power-loss"],
        "pair.first.friction.coefficient": 0.05, "pair.second.friction.coefficient": 0.05,
    },
    "helical_flank_design": {
        "accuracy.tolerance": 0.1, "flank_design.positions": 12, "flank_design.largest_face_load_factor": 9,
        "gear.pinion.face_width": "6 mm", "gear.wheel.face_width": "6 mm", "pair.I.load": "1800 N",
        "flank_design.grid": {
            "tip_amounts": ["12 um"], "tip_lengths": ["4.5 mm"], "crownings": ["4 um"], "biases": ["-4 um"],
        },
        "flank_design.map.load_factors": [0.5, 1.0], "flank_design.scatter": {"over_face": "6 um", "levels": 2},
    },
}  # fmt: skip
WEB = {
    "results": ["stiffness", "body-modes"], "accuracy": {"tolerance": 0.1},
    "gear": {"a": {
        "teeth": 16, "module": "2 mm", "face_width": "6 mm", "bore_radius": "6 mm",
        "body": {"rim_thickness": "2 mm", "web_thickness": "2 mm"},
    }},
    "stiffness": {"positions": 2, "face_positions": 2},
}  # fmt: skip
#: Stages that the window alone asks for.
IN_MESH = ("stress-in-mesh", "deformed-in-mesh", "stress-inside")
CRACKED = Task("crack-shown", "pinion")
FE = {
    "results": ["geometry", "tooth-geometry-check", "stiffness", "root-stress"], "accuracy": {"tolerance": 0.05},
    "gear": {"Räd": {"teeth": 20, "module": "3 mm", "face_width": "10 mm"}},
    "stiffness": {"gear": "Räd", "positions": 3},
}  # fmt: skip


def through_pickle(thing):
    return pickle.loads(pickle.dumps(thing))  # noqa: S301  (what the line itself wrote)


def check_travels(found):
    """Every part of a result comes back with its content, figures included, and answers."""
    for travelled in (through_pickle(found), copy.deepcopy(found), copy.copy(found)):
        assert travelled == found
        assert travelled is not found
        for task, outcome in found.outcomes.items():
            assert same(travelled.outcomes[task], outcome), task
        assert [step.stage for step in travelled.plan.steps] == [step.stage for step in found.plan.steps]
        assert repr(travelled) == repr(found)
    for one, other in zip(through_pickle(found.figures), found.figures, strict=True):
        if hasattr(other, "make") and "gear" not in other.key:  # some are dear to describe: what describes them came
            continue
        assert one == other
    values = found.values[:1]
    assert (found == 3, bool(values) and values[0] == through_pickle(values[0])) == (False, bool(values))


@pytest.mark.parametrize("case", QUICK)
def test_results_go_through_pickle_and_equal_their_copies(case):
    """No Results could be pickled for the functions of its stages, and == of two raised for their arrays."""
    check_travels(fegear.run(ROOT / "cases" / f"{case}.toml"))


def test_results_of_finite_elements_go_through_pickle():
    check_travels(fegear.run(FE))


@pytest.mark.long
@pytest.mark.parametrize("case", [name for name in ALL if name not in QUICK and name not in DEAR])
def test_results_of_every_case_go_through_pickle(case):
    check_travels(fegear.run(ROOT / "cases" / f"{case}.toml"))


@pytest.mark.long
@pytest.mark.parametrize("case", FURTHER)
def test_results_of_further_kinds_go_through_pickle(case):
    check_travels(fegear.run(ROOT / "cases" / f"{case}.toml", FURTHER[case]))


@pytest.mark.long
def test_body_modes_go_through_pickle():
    check_travels(fegear.run(WEB))


@pytest.mark.long
def test_what_the_window_shows_goes_through_pickle():
    scene = read_scene(ROOT / "cases" / "pinion_and_wheel.toml", ["accuracy.tolerance=0.05"])
    plan = make_plan(scene, STAGES, [Task(stage, "I") for stage in IN_MESH])
    for task, outcome in run_plan(scene, plan).outcomes.items():
        assert same(through_pickle(outcome).data, outcome.data), task


@pytest.mark.dear
def test_what_the_window_shows_of_cracked_teeth_travels():
    scene = read_scene(ROOT / "cases" / "cracked_tooth.toml", ["accuracy.tolerance=0.05", 'results=["geometry"]'])
    outcome = run_plan(scene, make_plan(scene, STAGES, [CRACKED])).outcomes[CRACKED]
    assert same(through_pickle(outcome).data, outcome.data)


@pytest.mark.long
def test_no_stage_is_forgotten_here():
    scenes = [read_scene(ROOT / "cases" / f"{name}.toml") for name in ALL if name not in DEAR]
    scenes += [fegear_scene(ROOT / "cases" / f"{name}.toml", changes) for name, changes in FURTHER.items()]
    plans = [make_plan(scene, STAGES) for scene in [*scenes, fegear_scene(WEB, {}), fegear_scene(FE, {})]]
    plans.append(
        make_plan(read_scene(ROOT / "cases" / "pinion_and_wheel.toml"), STAGES, [Task(s, "I") for s in IN_MESH])
    )
    plans.append(make_plan(read_scene(ROOT / "cases" / "cracked_tooth.toml"), STAGES, [CRACKED]))
    assert {stage.name for stage in STAGES} == {step.task.stage for plan in plans for step in plan.steps}


def test_every_stage_travels_by_its_name():
    assert all(through_pickle(stage) is stage for stage in STAGES)
    assert len({stage.name for stage in STAGES}) == len(STAGES)
    own = Stage(tuple, len, max, min, name="own")  # one that no catalogue has
    assert through_pickle(own).name == "own"


def pair(**keys):
    gears = (fegear.Gear(z, "3 mm", face_width="10 mm", name=name, **keys) for z, name in ((20, "a"), (23, "Ζ")))
    return fegear.Pair(*gears, compliance="weber-banaschek")


def answer(asked):
    return fegear.transmission_error(asked, torque="90 N*m")


def test_gears_and_pairs_go_through_pickle_before_and_after_they_were_asked():
    asked = pair()
    for _ in range(2):
        for one in (asked.driver, asked):
            again = through_pickle(one)
            assert again == one
            assert again.data == one.data
            assert same(again.geometry, one.geometry)
    assert asked != pair(profile_shift=0.1)
    assert answer(through_pickle(asked)) == answer(asked)


@pytest.mark.dear
def test_a_process_hands_an_answer_back():
    asked = pair()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = pool.submit(answer, asked).result(timeout=120)
    assert found == answer(asked)


def test_results_differ_where_a_number_does():
    one = answer(pair())
    assert one == answer(pair())  # in another time
    assert one != fegear.transmission_error(pair(), torque="91 N*m")
    assert one.tables[0] != one.tables[1]
    column = one.tables["transmission_error_I"].column("te")
    assert column == through_pickle(column)
    nan = type(column)("te", np.array([np.nan, 1.0]), "um")
    assert nan == through_pickle(nan)
    assert nan != type(column)("te", np.array([np.nan, 2.0]), "um")


def test_a_gear_keeps_nothing_of_its_caller():
    """A dictionary that was changed afterwards had the gear and its pair answer for two gears."""
    tip = {"amount": "10 um", "length": "1 mm"}
    relief, shifts = {"tip": tip}, np.zeros(20)
    compliance = {"source": "weber-banaschek"}
    gear = fegear.Gear(20, "3 mm", face_width="10 mm", relief=relief, spacing_errors=shifts)
    asked = fegear.Pair(gear, fegear.Gear(23, "3 mm", face_width="10 mm", name="b"), compliance=compliance)
    before = (repr(gear), repr(asked), answer(asked))
    tip["amount"], compliance["source"], shifts[3] = "90 um", "cornell", 1e-5
    relief["root"] = gear.keys["relief"]["tip"]
    gear.keys["relief"]["tip"]["amount"] = asked.keys["compliance"]["source"] = "x"
    assert (repr(gear), repr(asked), answer(asked)) == before
    assert answer(fegear.Pair(gear, asked.driven, compliance="weber-banaschek")) == before[2]


def test_numbers_and_arrays_of_numpy_and_pint_are_those_of_python():
    import pint

    unit = pint.UnitRegistry()
    one = fegear.Gear(
        np.int64(20), np.float64(3e-3), profile_shift=np.float32(0.5), spacing_errors=np.arange(20) * 1e-6
    )
    assert one == fegear.Gear(20, 3e-3, profile_shift=0.5, spacing_errors=tuple(i * 1e-6 for i in range(20)))
    asked = pair()
    several = fegear.transmission_error(asked, torque=np.array([50.0, 90.0]))
    assert several == fegear.transmission_error(asked, torque=unit.Quantity(np.array([50.0, 90.0]), "N*m"))
    assert several == fegear.transmission_error(asked, torque=["50 N*m", unit.Quantity(90.0, "N*m")])
    zero = unit.Quantity(np.array(90.0), "N*m")
    assert fegear.transmission_error(asked, torque=zero).tables == answer(asked).tables


GEAR = {"results": ["geometry"], "gear": {"a": {"teeth": 20, "module": "3 mm"}}}
HOLDS_ITSELF: dict[str, object] = {}
HOLDS_ITSELF["tip"] = HOLDS_ITSELF
REFUSED = {
    "bytes for a torque": (lambda p: fegear.transmission_error(p, torque=b"90 N*m"), "is bytes, not text"),
    "a numpy truth for a shift": (lambda p: p.driver.changed(profile_shift=np.bool_(True)), "must be a number"),
    "a truth for a shift": (lambda p: p.driver.changed(profile_shift=True), "must be a number"),
    "10**400": (lambda p: p.driver.changed(module=10**400), "is outside the plausible range"),
    "10**5000": (lambda p: p.driver.changed(teeth=10**5000), "is outside the plausible range"),
    "310 digits": (lambda p: fegear.run(GEAR, {"gear.a.profile_shift": 10**309}), "is outside the plausible range"),
    "an array of modules": (lambda p: p.driver.changed(module=np.array([1.0, 2.0])), "must be a length"),
    "a set": (lambda p: p.driver.changed(rack={"addendum"}), "unordered"),
    "keys that are no texts": (lambda p: p.driver.changed(relief={1: 2}), "is not a text key"),
    "a table that holds itself": (lambda p: p.driver.changed(relief=HOLDS_ITSELF), "is nested more than"),
    "half a character": (lambda p: fegear.Gear(20, "3 mm", name="\ud800"), "contains an invalid character"),
    "a list for a name": (lambda p: p.driver.changed(name=[]), "must be a text"),
    "no teeth": (lambda p: fegear.Gear.of("a", {}), "teeth = .not given.: is required"),
    "effects as a list": (lambda p: fegear.transmission_error(p, torque=1.0, effects=["relief"]), "must be a mapping"),
    "a dictionary as cache": (lambda p: fegear.transmission_error(p, torque=1.0, cache={}), "must be a SolutionCache"),
    "a text for a gear": (lambda p: fegear.stiffness_table("x"), "must be a fegear.Gear"),
    "a number for gears": (lambda p: fegear.root_stress(3), "must be gears"),
    "None for a case": (lambda p: fegear.run(None), "is not a case"),
    "a list for a case": (lambda p: fegear.run([]), "is not a case"),
    "NUL in a path": (lambda p: fegear.run("a\0b"), "contains a character not allowed in file names"),
    "changes as a list": (lambda p: fegear.run(GEAR, ["x"]), "must be a mapping"),
    "a number for results": (lambda p: fegear.run(GEAR, results=3), "must be a text or a list of texts"),
    "a number for a scheduler": (lambda p: fegear.run(GEAR, scheduler=3), "is not a valid address"),
    "a number for a compliance": (lambda p: fegear.Pair(p.driver, p.driven, compliance=3), "must be a mapping"),
    "a list for a train": (
        lambda p: fegear.dynamic_factor(p, torque=1.0, speeds=90.0, train=["x"]), "must be a mapping",
    ),
    "a number for a design": (lambda p: fegear.relief(p, torque=1.0, design=3), "must be a mapping"),
    "a number beside": (lambda p: fegear.rating(p, torque=1.0, beside=3), "must be a text or a list"),
    "a number for a folder": (lambda p: p.data.save(3), "is not a path"),
    "cannot be used as a folder (": (lambda p: p.data.save(""), "must not be empty"),
    "no folder for pictures": (lambda p: p.data.plot().save(""), "must not be empty"),
    "a place that is not there": (lambda p: p.data.values[999], "is not a position among these"),
}  # fmt: skip


@pytest.mark.parametrize("ask", REFUSED)
def test_what_no_argument_can_be_is_refused_in_a_sentence(ask):
    call, words = REFUSED[ask]
    with pytest.raises(InputError, match=words) as refused:
        call(pair())
    assert len(str(refused.value)) < 500
    assert "\n" not in str(refused.value)


def test_a_gear_needs_no_working_folder(tmp_path, monkeypatch):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    assert fegear.Gear(20, "3 mm").data.values is not None
    with pytest.raises(InputError, match="is not writable \\("):
        fegear.Gear(20, "3 mm").data.save("x")
