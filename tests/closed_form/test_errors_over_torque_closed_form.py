"""Estimated errors of the transmission error under every load are those of a case that has this load only."""

from pathlib import Path

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

TORQUES = (10.0, 20.0, 30.0)
_CACHE = SolutionCache()


def outcome(width, **loads):
    document = {
        "results": ["transmission-error"],
        "gear": {
            "a": {"teeth": 24, "module": "2 mm", "profile_shift": 0.2, "face_width": "8 mm", "bore_radius": "9 mm"},
            "b": {"teeth": 36, "module": "2 mm", "face_width": "8 mm", "bore_radius": "9 mm"},
        },
        "pair": {"p": {"driver": "a", "driven": "b", "width": width, **loads}},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": 0.1},
    }  # fmt: skip
    scene = build_scene(document, "case", Path())
    outcomes = run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes
    return next(one for task, one in outcomes.items() if task.stage == "transmission-error")


@pytest.mark.dear
@pytest.mark.parametrize(("width", "rel"), [("plane", 1e-9), ("slices", 0.3)])
def test_errors_over_torque_are_those_of_each_torque_alone(width, rel):
    several = outcome(width, torques=[f"{one} N*m" for one in TORQUES])
    (summary,) = (one for one in several.tables if one.name.startswith("transmission_error_summary"))
    columns = {column.name: np.asarray(column.values) for column in summary.columns}
    stated = {one.name.removeprefix("p."): one for one in several.values}
    for name in ("te_mean", "te_peak_to_peak", "te_effective"):
        errors = columns[f"{name}_error"]
        assert errors.shape == (len(TORQUES),)
        assert (errors > 0.0).all()
        # the nominal load is the largest
        assert errors[-1] == pytest.approx(stated[name].error, rel=1e-12)
    for i, torque in enumerate(TORQUES[:-1]):
        alone = {one.name.removeprefix("p."): one for one in outcome(width, torque=f"{torque} N*m").values}
        for name in ("te_mean", "te_peak_to_peak", "te_effective"):
            assert columns[f"{name}_error"][i] == pytest.approx(alone[name].error, rel=rel)
