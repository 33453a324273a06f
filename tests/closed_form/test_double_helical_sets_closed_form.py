"""Planetary sets of double helical gears: twice one half, in all that a set says."""

import copy

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CACHE = SolutionCache()
TEETH = {
    "normal_module": "3 mm",
    "helix_angle": "20 deg",
    "face_width": "12 mm",
    "strength": {"material": "case-hardened-steel"},
}
HALF = {
    "results": ["planet-set", "planet-load-sharing", "planet-modes", "rating"],
    "gear": {
        "s": TEETH | {"teeth": 22, "hand": "right", "bore_radius": "14 mm"},
        "p": TEETH | {"teeth": 20, "hand": "left", "bore_radius": "13 mm"},
    },
    "planetary": {"P": {
        "sun": "s", "planet": "p", "ring_teeth": 62, "planets": 4, "torque": "120 N*m", "speed": "1500 rpm",
        "stiffness": {"pin": "300 N/um", "ring_mesh": "260 N/um"},
        "pin_errors": {"tangential": ["8 um", "0 um", "0 um", "0 um"]},
        "body": {"carrier": {"mass": "4 kg", "inertia": "0.012 kg*m^2"}},
    }},
    "pair": {
        "P_sun": {"driver": "s", "driven": "p", "width": "slices", "operation": {"face_load_factor": 1.2}},
    },
    "load_distribution": {"positions": 16},
    "accuracy": {"tolerance": 0.1},
}  # fmt: skip


def both_halves(case):
    """The same set with two halves: all that is not teeth twice as heavy, stiff and loaded."""
    double = copy.deepcopy(case)
    double["planetary"]["P"] |= {
        "double_helical": True, "torque": "240 N*m", "stiffness": {"pin": "600 N/um", "ring_mesh": "520 N/um"},
        "body": {"carrier": {"mass": "8 kg", "inertia": "0.024 kg*m^2"}},
    }  # fmt: skip
    return double


def gears(case):
    for one in case["gear"].values():
        del one["hand"], one["helix_angle"]
        yield one


def run(case):
    scene = build_scene(case, "case", None)
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def of(found, stage):
    return next(one.data for task, one in found.outcomes.items() if task.stage == stage)


@pytest.mark.dear
def test_two_halves_are_twice_one():
    one, two = run(HALF), run(both_halves(HALF))
    loads, twice = of(one, "planet-load-sharing"), of(two, "planet-load-sharing")
    assert twice.mesh_force == pytest.approx(2.0 * loads.mesh_force, rel=1e-9)
    assert twice.pin_force == pytest.approx(2.0 * loads.pin_force, rel=1e-9, abs=1e-6)
    assert twice.te == pytest.approx(loads.te, rel=1e-10)
    assert np.ptp(loads.shares) > 0.02  # the pin error is felt
    assert twice.te_peak_to_peak_error == pytest.approx(loads.te_peak_to_peak_error, rel=1e-6)
    modes, heavy = of(one, "planet-modes"), of(two, "planet-modes")
    assert heavy.stiffness == pytest.approx(2.0 * np.array(modes.stiffness), rel=1e-12)
    assert heavy.modes.frequency == pytest.approx(modes.modes.frequency, rel=1e-9, abs=1e-3)
    values, of_both = ({value.name: value.value for value in found.values} for found in (one, two))
    safeties = [key for key in values if key.startswith("P_sun") and ("S_H" in key or "S_F" in key)]
    assert len(safeties) >= 4
    for key in safeties:
        assert of_both[key] == pytest.approx(values[key], rel=1e-9)


def test_axial_forces_of_halves_balance():
    case = both_halves(HALF) | {"results": ["planet-set"]}
    found, single = run(case), run(HALF | {"results": ["planet-set"]})
    forces = ("P.axial_force", "P.tilting_moment")
    assert {one.name for one in single.values}.issuperset(forces)
    assert {one.name for one in found.values}.isdisjoint(forces)
    assert any("both halves carry the same load" in one for one in found.remarks)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        (lambda case: case["pair"]["P_sun"].update(double_helical={"gap": "20 mm"}), "pair.P_sun.double_helical"),
        (lambda case: [one.update(module=one.pop("normal_module")) for one in gears(case)],
         "planetary.P.sun"),
        (lambda case: case["results"].append("double-helical"), "planetary.P.double_helical"),
        (lambda case: case["pair"]["P_sun"].update(axial_offset="2 mm"), "pair.P_sun.axial_offset"),
    ],
)  # fmt: skip
def test_what_two_halves_in_a_set_cannot_have_is_refused_by_its_key(change, key):
    case = both_halves(HALF)
    change(case)
    with pytest.raises(InputError) as refusal:
        make_plan(build_scene(case, "case", None), STAGES)
    assert str(refusal.value).startswith(key)
