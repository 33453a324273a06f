"""A gauge behind another relief, or on a tooth of another pitch, names it; one that is displaced names nothing."""

import copy

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.contact.trace_low_pass import filtered
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


def ran(folder, *, trace="", tolerance="0.1 mm", **changes):
    document = copy.deepcopy(CASE)
    document["gauge"]["g"]["placement_tolerance"] = tolerance
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
    best = found.data.otherwise.ranked.found.best
    assert (best.of.kind, best.of.of) == ("tip relief", ("driver", "driven"))
    assert best.value == pytest.approx(16e-6, abs=3.0 * best.error)
    first = found.answer.sentences[0]
    assert first.startswith("Gauge g: the trace agrees with a tip relief of both gears of 1")
    assert " µm in place of 25 µm: RMS of the residual " in first


def test_a_single_pitch_deviation_of_its_tooth_is_named(tmp_path):
    spacing = [f"{8 * (k == 0)} um" for k in range(24)]
    history = ran(tmp_path, pinion_spacing_errors=spacing).data.history
    written(tmp_path, history, history.strain[:, 0])
    best = ran(tmp_path, trace="t.csv").data.otherwise.ranked.found.best
    assert (best.of.kind, best.of.tooth) == ("pitch", 0)
    assert best.value == pytest.approx(8e-6, abs=3.0 * best.error)


def test_a_grid_within_its_tolerance_names_nothing_and_a_wrong_gauge_factor_no_relief(tmp_path):
    history = ran(tmp_path).data.history
    written(tmp_path, history, history.displaced[:, 0, int(np.argmin(np.abs(history.displacement - 0.07e-3)))])
    found = ran(tmp_path, trace="t.csv").data
    assert found.otherwise.ranked is None or found.otherwise.ranked.found.best is None
    assert "agrees with the computed one" in found.judged
    written(tmp_path, history, history.strain[:, 0], gain=0.9)
    found = ran(tmp_path, trace="t.csv").data
    assert "does not agree with the computed one" in found.judged
    assert "gauge factor or bridge supply" in found.judged
    assert "relief" not in found.judged


def test_a_grid_three_tolerances_off_is_named_before_a_torque_that_leaves_more(tmp_path):
    history = ran(tmp_path).data.history
    place = int(np.argmin(np.abs(history.displacement - history.displacement[-1])))
    written(tmp_path, history, history.displaced[:, 0, place], gain=1.0)
    found = ran(tmp_path, trace="t.csv", tolerance="0.03 mm")
    best = found.data.otherwise.ranked.found.best
    assert best.of.kind == "place"
    assert best.value == pytest.approx(history.displacement[place], abs=3.0 * best.error)
    assert found.data.judged.word.startswith("grid 0.")
    assert "times placement_tolerance" in found.data.judged.word
    assert found.data.described.scale == pytest.approx(1.0, abs=0.004)  # of the curve of the grid that is displaced


def test_a_low_pass_is_named_with_its_limit_and_its_delay(tmp_path):
    history = ran(tmp_path).data.history
    lag = np.radians(2.5)
    written(tmp_path, history, np.interp(history.angle, *filtered(history.angle, history.strain[:, 0], lag)), gain=1.0)
    found = ran(tmp_path, trace="t.csv").data
    best = found.otherwise.ranked.found.best
    assert best.of.kind == "filter"
    assert np.exp(best.value) == pytest.approx(lag, rel=0.1)
    assert found.described.shift == pytest.approx(1.0, abs=0.01)
    assert found.described.offset == pytest.approx(4e-5, abs=3e-6)
