"""The case of two meshes on three shafts as a run has it: what stages hand on, what is said, what a train feels."""

import copy
import tomllib
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASE = tomllib.loads(Path(__file__).parents[2].joinpath("cases", "gearbox_misaligned.toml").read_text(encoding="utf-8"))


def _run(case, *results):
    scene = build_scene(copy.deepcopy(case) | {"results": list(results)}, "box", Path())
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes


@pytest.mark.long
def test_flanks_are_loaded_with_the_gaps_of_the_shafts_and_the_rating_takes_them():
    case = copy.deepcopy(CASE)
    for gear in case["gear"].values():
        gear |= {"strength": {"material": "case-hardened-steel"}, "tolerance_class": 6}
    spectrum = [{"load_factor": 1.0, "share": 0.4}, {"load_factor": 0.3, "share": 0.6}]
    case["pair"]["I"]["speed"] = "1400 rpm"
    case["pair"]["II"] |= {"speed": "588 rpm", "operation": {"life": "1000 h", "spectrum": spectrum}}
    case["rating"] = {"beside": ["computed"]}
    found = _run(case, "misalignment", "load-distribution", "rating")
    shafts = found[Task("loaded-shafts", "all")].data
    assert any(state.scale == 0.3 for state in shafts.states)
    for number, mesh in enumerate(shafts.gearbox.meshes):
        loaded = found[Task("loaded-flanks", mesh.pair)].data
        assert (loaded.gaps.shafts.gap == shafts.gaps_of(mesh.pair).gap).all()
        # What the flanks carry over the face is what bent the shafts.
        lines, force = loaded.found.lines, loaded.found.contact.force[:, :, loaded.at]
        moment = float(lines.mean((force * np.where(lines.present, lines.z, 0.0)).sum(axis=1)))
        nodal = shafts.nominal.forces[number][0] @ mesh.heights
        assert moment == pytest.approx(float(nodal), rel=1e-3, abs=1e-4 * mesh.load * mesh.found.face_width)
        assert sum(shafts.nominal.forces[number][0]) == pytest.approx(mesh.load, rel=1e-9)
    rated = found[Task("rating", "II")].data
    loads = found[Task("loaded-flanks", "II")].data
    aligned = _run(case | {"effects": case["effects"] | {"misalignment": False}}, "load-distribution")
    said = aligned[Task("loaded-flanks", "II")]
    assert any("misalignment is off" in one for one in said.remarks)
    assert rated.computed.replacement.K_Hbeta == pytest.approx(loads.stated.face_load_factor[loads.at], rel=0.05)


@pytest.mark.long
def test_a_bearing_that_changed_solves_no_gear_again():
    first = _run(CASE, "misalignment")
    case = copy.deepcopy(CASE)
    case["bearing"]["plain"]["radial"] = "350 N/um"
    scene = build_scene(case | {"results": ["misalignment"]}, "box", Path())
    again = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    key = Task("misalignment", "all")
    assert again.outcomes[key].values[1].si != first[key].values[1].si
    solved = [task for task, timing in again.timings.items() if task.stage == "solid-solution" and not timing.recalled]
    assert not solved
