"""Pictures of loaded teeth: each is drawn, has a caption, and none is an empty page."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.output.figures import Drawing
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"

#: Coarse finite elements: what is drawn matters here, not the last digit. Mark's gears are as other tests solve them.
QUICK = {"calculix_pair": ("accuracy.tolerance=2e-2",), "nasa_relief_design": ("accuracy.tolerance=2e-2",)}


@pytest.mark.dear
@pytest.mark.parametrize(
    ("case", "names"),
    [
        (
            "calculix_pair",
            ["load_sharing", "transmission_error", "transmission_error_harmonics", "root_stress_history"],
        ),
        pytest.param(
            "nasa_relief_design",
            ["relief", "relief_candidates", "harris_map", "relief_chart", "robustness"],
            marks=pytest.mark.long,
        ),
        ("mark_minimum_excitation", ["relief", "relief_candidates", "harris_map"]),
    ],
)
def test_every_picture_shows_something(case, names, tmp_path):
    from matplotlib.image import imread

    wanted = ('results=["relief", "relief-chart", "robustness"]',) if case == "nasa_relief_design" else ()
    scene = read_scene(CASES / f"{case}.toml", (*QUICK.get(case, ()), *wanted))
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    drawing = Drawing(tmp_path / "plots")
    for task, outcome in results.outcomes.items():
        drawing.begin(task, outcome)
    drawn, missing = drawing.finish(lambda _fraction: None)
    assert not missing
    found = {picture.path.stem: picture for one in drawn for picture in one.pictures}
    for name in names:
        picture = found[f"{name}_I"]
        assert picture.title
        assert len(picture.caption) > 40
        pixels = imread(picture.path)[..., :3]
        assert np.mean(pixels.min(axis=2) < 0.9) > 0.01, name
