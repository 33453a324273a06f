"""A gauge behind another relief, or on a tooth of another pitch, names it; one that is displaced names nothing."""

import copy

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

pytestmark = pytest.mark.dear
TURN = 2.0 * np.pi
RELIEF = {"tip": {"amount": "25 um", "length": "3 mm"}}
CASE = {
    "results": ["gauge"],
    "gear": {
        "pinion": {"teeth": 24, "module": "4 mm", "face_width": "20 mm", "bore_radius": "22 mm", "relief": RELIEF},
        "wheel": {"teeth": 41, "module": "4 mm", "face_width": "20 mm", "relief": RELIEF},
    },
    "pair": {"test": {"driver": "pinion", "driven": "wheel", "torque": "300 N*m"}},
    "gauge": {"g": {"gear": "pinion", "grid_length": "0.6 mm"}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True, "relief": True},
    "accuracy": {"tolerance": 1e-2},
}  # fmt: skip
_CACHE = SolutionCache()


def ran(folder, *, trace="", **changes):
    document = copy.deepcopy(CASE)
    for key, value in changes.items():
        gear, _, what = key.partition("_")
        document["gear"][gear][what] = value
        document["effects"] |= {"spacing_errors": True} if what == "spacing_errors" else {}
    if trace:
        document["gauge"]["g"]["measured"] = {"file": trace, "fit": ["offset", "scale", "shift"]}
    scene = build_scene(document, "case", folder)
    return run_plan(scene, make_plan(scene, STAGES), cache=_CACHE).outcomes[Task("gauge", "g")]


def written(folder, history, strain, gain=1.005):
    """Three turns with an arbitrary zero of strain and angle, gauge factor and noise."""
    angle = np.arange(0.0, 3.0 * TURN, 4e-3)
    place = np.mod(angle - 1.0 + np.pi, TURN) - np.pi
    seen = gain * np.interp(place, history.angle, strain) + 4e-5
    seen += 5e-6 * np.random.default_rng(1).normal(size=angle.size)
    rows = zip(np.rad2deg(angle), 1e6 * seen, strict=True)
    (folder / "t.csv").write_text("angle [deg],strain [um/m]\n" + "".join(f"{a:.5f},{s:.3f}\n" for a, s in rows))


def test_a_relief_that_is_less_than_stated_is_named_first(tmp_path):
    less = {"tip": {"amount": "16 um", "length": "3 mm"}}
    history = ran(tmp_path, pinion_relief=less, wheel_relief=less).data.history
    written(tmp_path, history, history.strain[:, 0])
    found = ran(tmp_path, trace="t.csv")
    best = found.data.flank.found.best
    assert (best.of.kind, best.of.of) == ("tip relief", ("driver", "driven"))
    assert best.value == pytest.approx(16e-6, abs=3.0 * best.error)
    first = found.answer.sentences[0]
    assert first.startswith("Gauge g: the trace agrees with a tip relief of both gears of 1")
    assert " µm in place of 25 µm: RMS of the residual " in first


def test_a_single_pitch_deviation_of_its_tooth_is_named(tmp_path):
    spacing = [f"{8 * (k == 0)} um" for k in range(24)]
    history = ran(tmp_path, pinion_spacing_errors=spacing).data.history
    written(tmp_path, history, history.strain[:, 0])
    best = ran(tmp_path, trace="t.csv").data.flank.found.best
    assert (best.of.kind, best.of.tooth) == ("pitch", 0)
    assert best.value == pytest.approx(8e-6, abs=3.0 * best.error)


def test_a_displaced_grid_and_a_wrong_gauge_factor_name_no_relief(tmp_path):
    history = ran(tmp_path).data.history
    written(tmp_path, history, history.displaced[:, 0, int(np.argmin(np.abs(history.displacement - 0.07e-3)))])
    assert ran(tmp_path, trace="t.csv").data.flank is None
    written(tmp_path, history, history.strain[:, 0], gain=0.9)
    assert ran(tmp_path, trace="t.csv").data.flank is None
