"""A planetary set whose ring is a gear: with one planet its error is that of both meshes, each at its phase."""

import copy

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.built.planetary import set_inputs
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASE = {
    "results": ["planet-load-sharing"],
    "gear": {
        "s": {"teeth": 19, "module": "4 mm", "profile_shift": 0.3, "face_width": "40 mm"},
        "p": {"teeth": 23, "module": "4 mm", "profile_shift": 0.3, "face_width": "40 mm"},
        "r": {
            "internal": True, "teeth": 65, "module": "4 mm", "profile_shift": -0.9, "face_width": "40 mm",
            "cutter": {"teeth": 25}, "tip_diameter": "260 mm", "thickness_allowance": "80 um",
        },
    },
    "planetary": {"P": {"sun": "s", "planet": "p", "ring": "r", "planets": 1, "torque": "1300 N*m", "floating": []}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 1e-2},
}  # fmt: skip


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


@pytest.mark.parametrize(
    ("drive", "corners"),
    [
        ({}, False),
        pytest.param({}, True, marks=pytest.mark.long),
        pytest.param({"input": "carrier"}, True, marks=pytest.mark.long),
        pytest.param({"input": "carrier", "fixed": "sun"}, True, marks=pytest.mark.long),
    ],
)
def test_error_of_one_planet_is_that_of_both_meshes_one_behind_the_other(cache, drive, corners):
    """Both meshes carry the whole load, and their contact is solved anew at the places that the phases give."""
    case = copy.deepcopy(CASE)
    case["planetary"]["P"] |= drive
    case["effects"]["corner_contact"] = corners
    scene = build_scene(case, "case", None)
    results = run_plan(scene, make_plan(scene, STAGES), cache=cache)
    data = results.outcomes[Task("planet-load-sharing", "P")].data
    force, total = float(data.mean_force), np.zeros(data.s.size)
    phases = set_inputs(scene, "P").phases
    for pair, behind in (("P_sun", 0.0), ("P_ring", float(phases.ring_behind_sun))):
        engagement = results.outcomes[Task("loaded-pair", pair)].data.engagement
        x = engagement.meshing.reduced((data.s - behind) * scene.pairs[pair].base_pitch)
        total += engagement.solve(engagement.grid(x), [force]).transmission_error[:, 0]
    ratio = float(np.mean(data.te) / np.mean(total))
    assert np.asarray(data.te) == pytest.approx(ratio * total, rel=2e-5)
    if not drive:  # the ring stands still: the sun turns by both
        assert ratio == pytest.approx(1.0, rel=1e-5)
