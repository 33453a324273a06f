"""Gauges on 3D teeth in motion: slopes by differences, plane teeth in motion, speed to zero, power turned round."""

import copy
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.contact.wide.gauge_on_face import gauge_about_load
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.gauge import Grid
from fegear.results.catalogue import STAGES

GRID = {"grid_length": "0.3 mm", "grid_width": "0.5 mm", "placement_tolerance": "0.1 mm"}
_CACHE = SolutionCache()


def case_of(helix="0 deg", speed="4000 rpm", width="slices", harmonics=256):
    gears = {
        name: {
            "teeth": teeth, "normal_module": "2 mm", "face_width": "12 mm", "profile_shift": shift,
            "bore_radius": "9 mm", "helix_angle": helix, "hand": hand,
        }
        for name, teeth, shift, hand in (("a", 24, 0.2, "right"), ("b", 36, 0.0, "left"))
    }  # fmt: skip
    if helix == "0 deg":
        for gear in gears.values():
            gear["module"] = gear.pop("normal_module")
            gear.pop("helix_angle"), gear.pop("hand")
    return {
        "results": ["gauge", "dynamic-strain"], "gear": gears,
        "pair": {"p": {"driver": "a", "driven": "b", "torque": "36 N*m", "width": width}},
        "train": {
            "body": {"one": {"inertia": "2e-4 kg*m^2"}, "two": {"inertia": "9e-4 kg*m^2"}},
            "mesh": {"p": {"driver": "one", "driven": "two", "damping_ratio": 0.08}},
            "torque": {"one": "36 N*m"}, "balance": "two",
        },
        "dynamics": {"speed": speed, "harmonics": harmonics},
        "gauge": {"t": {"gear": "a", **GRID}, "c": {"gear": "b", "fillet": "compression", **GRID}},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": 0.1},
    }  # fmt: skip


def ran(document):
    scene = build_scene(document, "case", Path())
    return {str(task): one for task, one in run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes.items()}


@cache
def helical():
    return ran(case_of("20 deg"))


@pytest.mark.dear
def test_the_slope_is_that_between_two_loads():
    found = helical()
    loaded, solved = (found[one].data for one in ("loaded-flanks of p", "solid-solution of a"))
    asked = ("driver", "tension", Grid(3e-4, 5e-4, 0.0), 1e-3, np.array([0.0, 1e-4]), 1e-3, solved)
    load, step = loaded.nominal, 1e-4
    about = gauge_about_load(loaded, *asked, load)
    near = [loaded.flanks.solve([load * s], loaded.gaps, loaded.known) for s in (1.0 - step, 1.0 + step)]
    rolled = loaded.found.lines.roll
    # a followed tooth's place less whole base pitches is the roll position
    phase = np.mod((about.x - rolled[0]) / loaded.pair.base_pitch + 1e-9, 1.0) * loaded.pair.base_pitch + rolled[0]
    roll = np.abs(rolled[:, None] - phase).argmin(axis=0)
    closer = (near[1].transmission_error - near[0].transmission_error)[roll, 0]
    low, high = (gauge_about_load(loaded, *asked, load * s).strain for s in (1.0 - step, 1.0 + step))
    differences = (high - low) / closer[:, None]
    assert np.abs(about.slope).max() > 0.0
    # where a station comes to bear between the two loads there is no slope
    off = np.abs(about.slope - differences).max(axis=1) / np.abs(about.slope).max()
    assert np.quantile(off, 0.9) < 1e-3
    assert np.median(off) < 1e-5


@pytest.mark.dear
def test_at_speed_to_zero_the_strain_is_the_quasi_static_one():
    off = []
    for harmonics in (256, 1024):
        found = ran(case_of("20 deg", "0.01 rpm", harmonics=harmonics))
        for name in ("t", "c"):
            history, motion = (found[f"{stage} of {name}"].data for stage in ("gauge", "dynamic-strain"))
            history, motion = history.history, motion.found
            quasi = np.interp(motion.x, history.x, history.strain[:, 0])
            peak = np.abs(quasi).max()
            assert np.abs(motion.static - quasi).max() < 1e-9 * peak
            # at jumps of the transmission error, where a line comes to bear, a Fourier series overshoots
            assert np.abs(motion.total - quasi).max() < 2e-2 * peak
            off.append(np.quantile(np.abs(motion.total - quasi), 0.9) / peak)
    assert max(off) < 2e-4
    assert max(off[2:]) < 0.5 * min(off[:2])


@pytest.mark.dear
def test_plane_teeth_in_motion_see_what_even_slices_do():
    both = [ran(case_of(width=width)) for width in ("plane", "slices")]
    inside = np.linspace(-4e-3, 4e-3, 60)
    for name in ("t", "c"):
        plane, slices = (one[f"dynamic-strain of {name}"].data.found for one in both)
        one, other = (np.interp(inside, found.x, found.total) for found in (plane, slices))
        assert np.sqrt(np.mean((one - other) ** 2)) < 0.03 * np.abs(one).max()
        assert slices.ratio == pytest.approx(plane.ratio, abs=0.02)
        assert abs(plane.ratio - 1.0) > 0.04


@pytest.mark.dear
def test_where_the_named_driven_gear_drives_a_tooth_runs_the_other_way():
    forth = ran(case_of())["dynamic-strain of t"].data.found
    document = copy.deepcopy(case_of())
    document["pair"]["p"] |= {"driver": "b", "driven": "a", "torque": "54 N*m"}
    document["train"]["mesh"]["p"] |= {"driver": "two", "driven": "one"}
    back = ran(document)["dynamic-strain of t"].data.found
    assert back.member == "driver"
    assert np.interp(forth.x, back.x, back.total) == pytest.approx(forth.total, abs=2e-3 * np.abs(forth.total).max())
