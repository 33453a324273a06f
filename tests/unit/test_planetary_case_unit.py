"""``[planetary.NAME]``: from the table to numbers, and what is refused."""

import copy

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.planetary import set_inputs
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

BODIES = {"carrier": {"mass": "3 kg", "inertia": "0.01 kg*m^2"}}
CASE = {
    "results": ["planet-set", "planet-load-sharing", "planet-modes", "planet-vibration"],
    "gear": {
        "s": {"teeth": 25, "module": "2 mm", "face_width": "25 mm"},
        "p": {"teeth": 29, "module": "2 mm", "face_width": "25 mm"},
    },
    "planetary": {
        "P": {
            "sun": "s", "planet": "p", "ring_teeth": 83, "planets": 4, "torque": "320 N*m", "speed": "1800 rpm",
            "speeds": ["1000 rpm", "2000 rpm"], "body": BODIES,
            "stiffness": {"sun_mesh": "300 N/um", "ring_mesh": "480 N/um", "pin": "250 N/um", "carrier": "150 N/um"},
            "pin_errors": {"tangential": ["20 um", "0 um", "-10 um", "0 um"]},
        }
    },
}  # fmt: skip


def changed(**keys):
    case = copy.deepcopy(CASE)
    part = case["planetary"]["P"] | keys
    case["planetary"]["P"] = {key: one for key, one in part.items() if one is not None}
    return case


def run(case, cache=None):
    scene = build_scene(case, "case", None)
    return run_plan(scene, make_plan(scene, STAGES), cache=cache or SolutionCache())


def values(results):
    return {value.name: value.si for value in results.values}


@pytest.fixture(scope="module")
def ran():
    return run(CASE)


def test_the_case_gives_what_the_mechanics_does(ran):
    """K_gamma by the closed form: opposite pins 20 um ahead and 10 um behind, the sun takes up the rest."""
    found = values(ran)
    alpha = np.radians(20.0)
    k = 1.0 / (1.0 / 300e6 + 1.0 / 480e6 + (2.0 * np.cos(alpha)) ** 2 / 250e6)
    force = 320.0 / (25e-3 * np.cos(alpha)) / 4.0
    assert found["P.K_gamma"] == pytest.approx(1.0 + 2.0 * np.cos(alpha) * k * 10e-6 / 4.0 / force, rel=1e-9)
    assert found["P.ratio"] == pytest.approx(1.0 + 83.0 / 25.0)
    assert found["P.mesh_frequency"] == pytest.approx(30.0 * 83.0 * 25.0 / 108.0)
    assert {table.name for table in ran.tables} >= {"planet_phases_P", "planet_shares_P", "planet_modes_P",
                                                    "planet_vibration_P", "planet_sidebands_P"}  # fmt: skip


def test_what_phases_and_equal_planets_cancel_is_drawn_as_nothing(ran):
    """Round-off was drawn as a curve of 1e-13 micrometres; a picture without bars now says why."""
    equal = {one.key: one for one in run(changed(pin_errors=None)).figures}
    across = [np.asarray(curve.y) for curve in equal["planet_vibration_P"].panels[1].items]
    assert all(not one.any() or one.max() > 1e-6 for one in across)
    bars = equal["planet_forces_P"].panels[0]
    assert ("cancel" in bars.title) == (not any(np.any(one.y) for one in bars.items))


def test_each_arrangement_runs_and_shares_alike():
    """Fixed ring, sun or carrier, driven from either side, either way round: loads follow the torque on the sun."""
    for fixed, driving in (("ring", "carrier"), ("carrier", "sun"), ("sun", "ring"), ("sun", "carrier")):
        for clockwise in (False, True):
            case = changed(fixed=fixed, input=driving, clockwise=clockwise, body=BODIES | {
                "ring": {"mass": "5 kg", "inertia": "0.04 kg*m^2"}})  # fmt: skip
            found = values(run(case | {"results": ["planet-load-sharing"]}))
            assert 1.0 < found["P.K_gamma"] < 1.5


def test_a_changed_pin_error_solves_nothing_else_again():
    cache = SolutionCache()
    run(CASE, cache)
    results = run(changed(pin_errors={"tangential": ["30 um", "0 um", "0 um", "0 um"]}), cache)
    again = [str(task) for task, timing in results.timings.items() if timing.origin == "computed"]
    assert again == ["planet-load-sharing of P"]


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"planets": 5, "pin_errors": {}}, "108 / 5 = 21.6 is not an integer"),
        ({"planets": 6, "pin_errors": {}}, "adjacent planets interfere: tip circles overlap by"),
        ({"planets": None}, "must be specified in one way"),
        ({"input": "ring"}, "is fixed as well"),
        ({"sun": "q"}, "is not a gear of this case"),
        ({"pin_errors": {"tangential": ["1 um"]}}, "has 1 entries for 4 planets"),
        ({"floating": ["carrier"]}, "contradicts the floating carrier"),
        ({"stiffness": {"sun_mesh": "300 N/um"}}, "stiffness.ring_mesh"),
        ({"speeds": None}, "planetary.P.speeds"),
        ({"body": {}}, "planetary.P.body.carrier"),
        ({"ring_teeth": 20}, "must have more teeth"),
    ],
)
def test_what_is_refused_names_its_key_and_remedy(keys, said):
    with pytest.raises(FegearError) as caught:
        run(changed(**keys))
    assert said in str(caught.value)


def test_a_pair_of_the_case_may_stand_for_the_sun_mesh():
    case = CASE | {"pair": {"P_sun": {"driver": "s", "driven": "p", "speed": "1000 rpm"}}}
    scene = build_scene(case, "case", None)
    assert scene.case.pair["P_sun"].torque == pytest.approx(80.0)
    with pytest.raises(FegearError, match="with s driving p"):
        build_scene(CASE | {"pair": {"P_sun": {"driver": "p", "driven": "s"}}}, "case", None)


def rated_set(**operation):
    strong = {"strength": {"material": "case-hardened-steel"}}
    case = changed() | {"results": ["rating"], "gear": {name: one | strong for name, one in CASE["gear"].items()}}
    if operation:
        case["pair"] = {"P_sun": {"driver": "s", "driven": "p", "operation": operation}}
    results = run(case)
    table = next(one for one in results.tables if one.name == "rating_P_sun")
    symbols, pinion, wheel = (list(table.column(key).values) for key in ("symbol", "driver", "driven"))
    return {name: (one, two) for name, one, two in zip(symbols, pinion, wheel, strict=True)}, results


def test_a_rating_takes_what_its_planetary_set_knows(ran):
    found, results = rated_set()
    assert found["K_gamma"][0] == pytest.approx(values(ran)["P.K_gamma"], rel=1e-12)
    assert found["Y_M"][0] == 1.0
    assert found["Y_M"][1] < 0.8  # of a planet bent to either side
    assert any("; K_gamma from its planet-load-sharing" in one for one in results.remarks)
    own, _ = rated_set(mesh_load_factor=1.5, reversed_load=0.0)
    assert own["K_gamma"][0] == 1.5
    assert own["Y_M"] == (1.0, 1.0)
    ratio = np.prod([own[key][0] / found[key][0] for key in ("K_gamma", "K_v", "K_Hbeta", "K_Halpha")])
    assert own["sigma_H"][0] / found["sigma_H"][0] == pytest.approx(ratio**0.5, rel=1e-9)


def test_the_pair_of_a_set_turns_as_relative_to_the_carrier():
    shares = {
        ("ring", "sun"): 83 / 108, ("carrier", "sun"): 1.0, ("ring", "carrier"): 83 / 25,
        ("sun", "carrier"): 1.0, ("sun", "ring"): 83 / 108, ("carrier", "ring"): 83 / 25,
    }  # fmt: skip
    for (fixed, driving), share in shares.items():
        scene = build_scene(changed(fixed=fixed, input=driving), "case", None)
        run = set_inputs(scene, "P").run
        pair = scene.case.pair["P_sun"]
        teeth = scene.gears[pair.driver].teeth
        assert pair.speed == pytest.approx(188.49555921538757 * share * 25 / teeth)
        assert pair.speed * teeth == pytest.approx(abs(run.sun_turns) * 25)
        assert pair.operation.contacts == ([4, 1] if pair.driver == "s" else [1, 4])


def motion(results=("planet-motion",), dynamics=None, **keys):
    three = {"planets": 3, "pin_errors": {}} | keys
    results = run(changed(**three) | {"results": list(results), "dynamics": dynamics or {}})
    found = next((one for one in results.tables if one.name == "planet_motion_P"), None)
    return results, {} if found is None else {column.name: column.values for column in found.columns}


def test_a_set_of_constant_stiffness_runs_as_it_stands():
    """Nothing excites it: the motion is the equilibrium, with its shares of the load."""
    pins = CASE["planetary"]["P"]["pin_errors"]
    results, found = motion(
        ("planet-motion", "planet-load-sharing"), speeds=["1500 rpm"], planets=4, pin_errors=pins
    )  # fmt: skip
    for mesh in ("sun", "ring"):
        assert found[f"{mesh}_factor"] == pytest.approx(values(results)["P.largest_share"], abs=1e-6)
        assert found[f"apart_{mesh}"] == 0.0


def test_teeth_part_at_a_resonance_and_the_stated_error_holds():
    stiff = CASE["planetary"]["P"]["stiffness"] | {"sun_mesh": ["180 N/um", "420 N/um", "420 N/um", "180 N/um"]}
    speed = [f"{4299.0 * 60.0 / 25.0 * 108.0 / 83.0:.6g} rpm"]  # of a mode in which the members move across the axis
    results, rough = motion(stiffness=stiff, speeds=speed, damping_ratio=0.02)
    assert rough["apart_sun"][0] > 0.05
    assert rough["sun_factor"][0] > 2.0
    assert any("loss of contact at 1 of 1 speeds" in one for one in results.remarks)
    assert rough["motion"][0] == "periodic"
    _, fine = motion(stiffness=stiff, speeds=speed, damping_ratio=0.02, dynamics={"tolerance": 1e-8})
    assert abs(rough["sun_factor"] - fine["sun_factor"])[0] <= rough["error"][0]
