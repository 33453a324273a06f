"""Root stress of 3D teeth in motion: speed to zero, linear in the increment, plane teeth, the place that moves."""

import copy
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.contact.wide.roots_about_load import roots_about_load
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

FE = "fe"
_CACHE = SolutionCache()


def case_of(helix="20 deg", speed="4000 rpm", width="slices", results=("dynamic-root-stress",), **dynamics):
    gears = {
        name: {
            "teeth": teeth, "normal_module": "2 mm", "face_width": "8 mm", "profile_shift": shift,
            "bore_radius": "9 mm", "helix_angle": helix, "hand": hand,
        }
        for name, teeth, shift, hand in (("a", 24, 0.2, "right"), ("b", 36, 0.0, "left"))
    }  # fmt: skip
    if helix == "0 deg":
        for gear in gears.values():
            gear["module"] = gear.pop("normal_module")
            gear.pop("helix_angle"), gear.pop("hand")
    return {
        "results": list(results), "gear": gears,
        "pair": {"p": {"driver": "a", "driven": "b", "torque": "36 N*m", "width": width}},
        "train": {
            "body": {"one": {"inertia": "2e-4 kg*m^2"}, "two": {"inertia": "9e-4 kg*m^2"}},
            "mesh": {"m": {"pair": "p", "driver": "one", "driven": "two", "damping_ratio": 0.08}},
            "torque": {"one": "36 N*m"}, "balance": "two",
        },
        "dynamics": {"speed": speed, "harmonics": 256, **dynamics},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": 0.1},
    }  # fmt: skip


def ran(document):
    scene = build_scene(document, "case", Path())
    return {str(task): one for task, one in run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes.items()}


def stress_of(found, member="driver"):
    data = found["dynamic-root-stress of m"].data
    return data.force.force.x, data.stress[member][FE]


@cache
def helical():
    return ran(case_of())


def quasi_static(member):
    """Largest tension by the result for pairs, at the roll positions of the whole base pitch."""
    data = ran(case_of(results=("root-stress-history",)))["root-stress-history of p"].data
    return data.found.stress[member][FE]


@pytest.mark.dear
def test_at_speed_to_zero_it_is_the_root_stress_of_the_pair_at_rest():
    found = ran(case_of(speed="0.01 rpm"))
    for member in ("driver", "driven"):
        x, stress = stress_of(found, member)
        rest = quasi_static(member)
        inside = (rest.x > x[0]) & (rest.x < x[-1])
        peak = rest.tension.max()
        off = np.abs(np.interp(rest.x, x, stress.static) - rest.tension[:, 0])[inside] / peak
        # x of the train has no position at every corner of the pair's curve
        assert (np.median(off) < 1e-9, off.max() < 5e-3) == (True, True)
        assert stress.static.max() == pytest.approx(rest.largest_tension[0], rel=1e-4)
        # at jumps of the transmission error, where a line comes to bear, a Fourier series overshoots
        assert np.quantile(np.abs(stress.total - stress.static), 0.9) < 5e-4 * peak
        assert stress.total == pytest.approx(stress.own)
        assert stress.error.max() == pytest.approx(rest.error(0), rel=0.02)


@pytest.mark.dear
def test_stress_is_linear_in_the_increment_at_every_place_and_the_largest_convex():
    loaded, solved = (helical()[one].data for one in ("loaded-flanks of p", "solid-solution of a"))
    about = roots_about_load(loaded, "driver", solved, loaded.nominal)
    closer = 1e-6
    low, middle, high = (about.largest(np.full(about.x.size, s * closer)).tension for s in (-1.0, 0.0, 1.0))
    assert (low + high >= 2.0 * middle - 1e-9 * middle.max()).all()
    # where the largest stays where it is, it is linear, with the slope of a load a little larger
    assert np.quantile(np.abs(low + high - 2.0 * middle), 0.5) < 2e-3 * np.abs(high - middle).max()
    step = 1e-4
    near = [roots_about_load(loaded, "driver", solved, loaded.nominal * s) for s in (1.0 - step, 1.0 + step)]
    differences = near[1].stress - near[0].stress
    # all stations of a roll position come nearer by the same: the ratio of both is one number for each of them
    point = np.abs(about.slope[:, :, about.x.size // 2]).argmax()
    at = np.unravel_index(point, about.slope.shape[:2])
    one = differences[..., about.x.size // 2] / differences[(*at, about.x.size // 2)]
    other = about.slope[..., about.x.size // 2] / about.slope[(*at, about.x.size // 2)]
    assert np.abs(one - other).max() < 1e-3


@pytest.mark.dear
def test_even_slices_are_stressed_as_plane_teeth_in_motion():
    both = [stress_of(ran(case_of("0 deg", width=width))) for width in ("plane", "slices")]
    inside = np.linspace(-3e-3, 3e-3, 50)
    plane, slices = (np.interp(inside, x, stress.total) for x, stress in both)
    assert np.sqrt(np.mean((plane - slices) ** 2)) < 0.04 * plane.max()
    ratios = [stress.total.max() / stress.static.max() for _, stress in both]
    assert ratios[0] == pytest.approx(ratios[1], abs=0.02)
    assert abs(ratios[0] - 1.0) > 0.03
    assert both[0][1].z is None


@pytest.mark.dear
def test_the_largest_place_is_on_the_face_and_may_move():
    found = helical()
    x, stress = stress_of(found)
    assert np.abs(stress.z).max() <= 4e-3 * (1.0 + 1e-9)
    assert (stress.z != stress.static_z).any()
    tables = found["dynamic-root-stress of m"].tables
    table = next(one for one in tables if one.name.startswith("root_stress_history_m"))
    heads = [column.name for column in table.columns]
    assert {"stress_face_position", "static_stress_face_position", "stress_error"} <= set(heads)
    assert x.size == len(stress.total)


@pytest.mark.dear
def test_where_the_named_driven_gear_drives_a_tooth_runs_the_other_way():
    x, forth = stress_of(helical())
    document = copy.deepcopy(case_of())
    document["pair"]["p"] |= {"driver": "b", "driven": "a", "torque": "54 N*m"}
    document["train"]["mesh"]["m"] |= {"driver": "two", "driven": "one"}
    back_x, back = stress_of(ran(document), "driven")
    assert np.interp(x, back_x, back.total) == pytest.approx(forth.total, abs=3e-3 * forth.total.max())
