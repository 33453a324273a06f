"""A set whose ring is a gear: its mesh from solved teeth, its room checked, its planets bent to either side."""

import copy

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

SIZE = {"module": "2 mm", "face_width": "25 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 83, "cutter": {"teeth": 30}, "tip_diameter": "162.4 mm", "rim_thickness": "10 mm"}
CASE = {
    "results": ["planet-set", "planet-load-sharing", "transmission-error"],
    "accuracy": {"tolerance": 1e-2},
    "effects": {"hertz": "linear"},
    "gear": {"s": SIZE | {"teeth": 25}, "p": SIZE | {"teeth": 29}, "r": SIZE | RING},
    "planetary": {
        "P": {
            "sun": "s",
            "planet": "p",
            "ring": "r",
            "planets": 1,
            "torque": "80 N*m",
            "floating": [],
            "fixed": "carrier",
        }
    },
}
CACHE = SolutionCache()  # each gear is solved once


def run(*results, gear=None, **keys):
    case = copy.deepcopy(CASE)
    case["planetary"]["P"] |= keys
    case["gear"]["r"] |= gear or {}
    if results:
        case["results"] = list(results)
    scene = build_scene(case, "case", None)
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def of(results, table):
    return {one.name: one.values for one in next(t for t in results.tables if t.name == table).columns}


@pytest.mark.parametrize("driving", ["sun", "ring"])
def test_one_planet_between_rigid_bearings_adds_up_both_transmission_errors(driving):
    """The sun turns by what both meshes give, the ring's delayed by its phase: whichever of them drives."""
    results = run(input=driving)
    found, phase = of(results, "planet_loads_P"), float(of(results, "planet_phases_P")["gamma_rn"][0])
    phase += next(value.si for value in results.values if value.name == "P.gamma_rs")
    s = found["s"] + 1e-7 * np.array([[0.0], [1.0], [-1.0]])
    expected = np.zeros_like(s)
    for mesh, delay in (("sun", 0.0), ("ring", phase)):
        one = of(results, f"transmission_error_P_{mesh}")
        pitch = results.scene.pairs[f"P_{mesh}"].base_pitch
        x, te = np.asarray(one["x"]) * 1e-3 / pitch, np.asarray(one["te"])
        expected += np.interp((s - delay - x[0]) % 1.0 + x[0], np.append(x, x[0] + 1.0), np.append(te, te[0]))
    jumps = np.ptp(expected, axis=0) > 0.001 * np.ptp(expected)  # which the table of the pair has at one place
    assert 0 < np.count_nonzero(jumps) < 0.1 * s.shape[1]
    assert np.max(np.abs(found["te"] - expected[0])[~jumps]) < 0.003 * np.ptp(expected)


def test_a_planet_is_loaded_alike_by_sun_and_ring():
    """Its pairs take torque, speed, contacts and centre distance from the set; forces along both lines are one."""
    scene = run("planet-set", planets=4, fixed="ring", speed="1000 rpm").scene
    sun, ring = scene.case.pair["P_sun"], scene.case.pair["P_ring"]
    assert (sun.driver, sun.driven, ring.driver, ring.driven) == ("s", "p", "p", "r")
    loads = [scene.case.pair[name].normal_load(scene.pairs[name]) for name in ("P_sun", "P_ring")]
    assert loads[0] == pytest.approx(loads[1], rel=1e-12)
    assert sun.speed * 25 == pytest.approx(ring.speed * 29)
    assert ring.operation.contacts == [1, 4]
    assert (sun.operation.idler, ring.operation.idler) == ("driven", "driver")
    assert scene.pairs["P_sun"].centre_distance == scene.pairs["P_ring"].centre_distance


def test_room_of_the_planets_in_their_ring_is_said_and_its_lack_refused():
    found = of(run("planet-set"), "planet_in_ring_P")
    margins = dict(zip(found["check"], found["margin"], strict=True))
    assert margins["tip clearance of the planet"] == pytest.approx(0.5274, abs=1e-3)  # 2 (41.5 + 1.25 - 42.5) mm
    with pytest.raises(FegearError, match=r"pair.P_ring.*interference with the root circle of the ring"):
        run("planet-set", gear={"cutter": {"teeth": 30, "addendum": 0.95, "tip_radius": 0.1}})


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"ring": "s"}, "must be an internal gear"),
        ({"sun": "r"}, "is an internal gear"),
        ({"ring": "x"}, "is not a gear of this case"),
        ({"ring_teeth": 83}, "contradicts ring_teeth"),
    ],
)
def test_rings_that_are_none_are_refused(keys, said):
    with pytest.raises(FegearError, match=said):
        run("planet-set", **keys)


def test_a_set_with_its_ring_as_a_gear_is_rated_at_the_sun():
    strong = {"material": "case-hardened-steel"}
    case = copy.deepcopy(CASE) | {"results": ["rating", "planet-load-sharing"]}
    for gear in ("s", "p"):
        case["gear"][gear]["strength"] = strong
    pins = {"tangential": ["20 um", "0 um", "-10 um", "0 um"]}
    case["planetary"]["P"] |= {
        "planets": 4, "speed": "1000 rpm", "pin_errors": pins, "stiffness": {"pin": "250 N/um"}, "floating": ["sun"],
    }  # fmt: skip
    scene = build_scene(case, "case", None)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    table = of(results, "rating_P_sun")
    factor = dict(zip(table["symbol"], table["driver"], strict=True))["K_gamma"]
    assert factor == next(one.si for one in results.values if one.name == "P.K_gamma")
    assert factor > 1.02
    assert "Pair P_ring not rated: gear.r.strength is not specified." in results.remarks
    case["gear"]["r"]["strength"] = {"material": "through-hardened-alloy-steel"}
    scene = build_scene(case, "case", None)
    both = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    assert of(both, "rating_P_sun")["driver"] == pytest.approx(table["driver"], nan_ok=True)
    mesh = of(both, "rating_P_ring")
    ring = dict(zip(mesh["symbol"], zip(mesh["driver"], mesh["driven"], strict=True), strict=True))
    assert ring["K_gamma"][0] == factor
    assert ring["u"][0] == pytest.approx(-83 / 29)
    assert ring["Y_M"][0] < 0.75 < ring["Y_M"][1] == 1.0  # the planet's teeth are bent to either side
    said = "\n".join(both.remarks)
    assert "P_ring: AGMA 2101 not evaluated" in said
    assert ".strength is not specified." not in said
