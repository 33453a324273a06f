"""A pair whose driven gear has holes in its web: with the mean of its teeth, the stiffest, and the softest."""

import re

import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

SIZE = {"module": "2 mm", "face_width": "2.4 mm"}
HOLES = {"count": 4, "circle_diameter": "19 mm", "diameter": "5 mm"}
BODY = {"rim_thickness": "2.5 mm", "web_thickness": "2.4 mm"}
CACHE = SolutionCache()  # all teeth follow from one solution


def run(**holes):
    body = BODY | {"holes": HOLES | holes}
    case = {
        "results": ["load-distribution"],
        "gear": {"a": SIZE | {"teeth": 17}, "b": SIZE | {"teeth": 18, "bore_radius": "6 mm", "body": body}},
        "pair": {"I": {"driver": "a", "driven": "b", "load": "300 N", "width": "solid"}},
        "accuracy": {"tolerance": 0.1},
        "load_distribution": {"positions": 8},
    }
    scene = build_scene(case, "case", None)
    found = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    (said,) = (remark for remark in found.remarks if "holes of its web" in remark)
    return next(value.si for value in found.values if value.name == "I.te_mean"), said


@pytest.mark.long  # what one tooth stands for is a law of the solution, which the ordinary run has
def test_a_pair_takes_the_mean_or_one_tooth():
    mean, said = run()
    assert ". Tables, pairs and planetary sets use the mean of all teeth." in said
    stiffest, softest = (int(found) for found in re.findall(r"of tooth (\d+), the s", said))
    assert "compliance varies over 9 consecutive teeth" in said
    (stiff, one), (soft, _) = (run(tooth=tooth) for tooth in (stiffest, softest))
    assert f"those of tooth {stiffest} for all teeth" in one
    assert stiff < mean < soft
    assert soft / stiff > 1.001
    # Two turns of the holes on, the same tooth comes again.
    assert run(tooth=stiffest + 9)[0] == pytest.approx(stiff, rel=1e-6)
