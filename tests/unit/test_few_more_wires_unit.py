"""Lines of pictures, jobs, gauges and cracks that a draw of wrong lines let pass, by what they stand for."""

import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.pair import gauge
from fegear.results.pair.stress_intensity import CrackOverMesh


def test_errors_of_a_crack_are_those_of_its_own_modes_and_rows():
    rows = SimpleNamespace(
        largest=2, least=0, k_1_error=np.array([1.0, 2.0, 3.0]), k_2_error=np.array([10.0, 20.0, 30.0])
    )
    one = CrackOverMesh("g", rows, 9.0, 5.0, -0.1)
    assert (one.k_1_max_error, one.k_2_there_error, one.k_1_min_error) == (3.0, 30.0, 1.0)
    assert one.closes
    assert not CrackOverMesh("g", rows, 9.0, 5.0, -0.08).closes
    rows.k_1_error = None
    assert (one.k_1_max_error, one.k_1_min_error, one.k_2_there_error) == (None, None, 30.0)


@pytest.mark.parametrize("neglected", [True, False])
@pytest.mark.parametrize("estimates", [True, False])
@pytest.mark.parametrize("measured", [None, 3.0])
@pytest.mark.parametrize("member", ["driver", "driven"])
def test_sizes_of_what_is_neglected_are_found_for_a_verdict_and_speeds_are_those_of_the_gauge(
    monkeypatch, neglected, estimates, measured, member
):
    given = SimpleNamespace(pair="I", member=member, measured=measured)
    monkeypatch.setattr(gauge, "gauge_of", lambda scene, name: given)
    monkeypatch.setattr(gauge, "sharper_strain", lambda scene, pair: "sharper")
    monkeypatch.setattr(gauge, "GaugeInputs", lambda *parts: parts)
    case = SimpleNamespace(
        pair={"I": SimpleNamespace(speed=100.0, halves=1)}, effects="effects", gauge={},
        accuracy=SimpleNamespace(tolerance=0.1), load_distribution=SimpleNamespace(positions=5),
    )  # fmt: skip
    scene = SimpleNamespace(
        case=case, pairs={"I": SimpleNamespace(ratio=2.5)}, wide_pairs=("I",), width_of=lambda pair: "solid",
        estimates=estimates, sizes_neglected=neglected,
    )  # fmt: skip
    found = gauge._inputs(scene, "gauge")
    assert found[10] == (neglected or (estimates and measured is not None))
    assert found[1] == (100.0 if member == "driver" else 40.0)
    assert found[6] == "increase load_distribution.positions (5)"
    scene.width_of = lambda pair: "slices"
    assert gauge._inputs(scene, "gauge")[6] == "sharper"


def test_a_run_in_the_window_has_taken_the_time_since_it_began(monkeypatch, tmp_path):
    from fegear.window import worker

    said, clock = [], iter([100.0, 103.5, 200.0])
    inbox = SimpleNamespace(say=lambda one: said.append((one.what, one.content)), look=lambda: None)
    monkeypatch.setattr(worker, "Inbox", lambda connection: inbox)
    for name in ("notes_of", "notes_by_task"):
        monkeypatch.setattr(worker, name, lambda results, name=name: name)
    made = worker.Worker(None, tmp_path)
    scene = SimpleNamespace(case=SimpleNamespace(accuracy=SimpleNamespace(tolerance=0.02)))
    results = SimpleNamespace(timings={}, scene=scene, remarks=("a",), answer=SimpleNamespace(sentences=("b",)))
    monkeypatch.setattr(made, "_results", lambda asked, told: results if told else None)
    monkeypatch.setattr(made, "_tell_later", lambda: None)
    monkeypatch.setattr(worker.time, "perf_counter", lambda: next(clock))
    made._wait_before = -1
    made._compute(SimpleNamespace(moving=True))
    ((what, content),) = said
    assert (what, content["seconds"], content["tolerance"], content["moving"]) == ("done", 3.5, 0.02, True)
    assert (content["notes"], content["told"], content["remarks"], content["answer"]) == (
        "notes_of", "notes_by_task", ["a"], ["b"]
    )  # fmt: skip


def test_the_tooth_of_the_picture_of_stiffness_fills_it_from_side_to_side():
    pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")
    from fegear.window import pictures

    drawn = pictures._stiffness()
    (line,) = re.findall(r'<path class="driver" d="M([^"]*)"', drawn)
    places = np.array(re.findall(r"-?\d+\.?\d*", line), dtype=float).reshape(-1, 2)
    wide = pictures._WIDE
    assert places[:, 0].min() == pytest.approx(0.0, abs=0.12 * wide)
    assert places[:, 0].max() == pytest.approx(wide, abs=0.12 * wide)
    assert places[:, 0].min() >= -0.01 * wide
    assert places[:, 0].max() <= 1.01 * wide
    tip = places[places[:, 1] <= places[:, 1].min() + 1.0]
    assert tip[:, 0].mean() == pytest.approx(0.5 * wide, abs=0.03 * wide)


def test_results_of_shafts_are_written_to_shafts_by_their_names(monkeypatch):
    from fegear.case.reading import read_scene
    from fegear.exchange.rexs import written_gearbox

    given = []
    monkeypatch.setattr(written_gearbox, "write_shaft_results", lambda written, shafts, tables: given.append(shafts))
    path = Path(__file__).parents[2] / "cases" / "two_stage_shafts.toml"
    scene = read_scene(path)
    written_gearbox.model_text(scene, "2026-01-01")
    (shafts,) = given
    assert set(scene.case.shaft) <= set(shafts)
    assert {one.type for one in shafts.values()} == {"shaft"}
    assert all(one.name == name for name, one in shafts.items())
