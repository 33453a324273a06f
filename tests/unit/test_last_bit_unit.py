"""The tool that stands for another processor: noise of one unit in the last place, where rounding enters."""

import inspect
import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fegear

OTHER = Path(__file__).parents[1] / "helpers" / "other_processor"


@pytest.fixture
def noisy(monkeypatch):
    monkeypatch.syspath_prepend(str(OTHER))
    import last_bit

    return last_bit.noisy


def test_noise_is_of_one_unit_in_the_last_place_and_moves_two_numbers_of_three(noisy):
    x = np.random.default_rng(1).normal(size=(300, 100))
    steps = (noisy(x, 1) - x) / np.spacing(np.abs(x))
    assert np.abs(steps).max() <= 1.0
    for step in (-1.0, 0.0, 1.0):
        assert np.mean(np.round(steps) == step) == pytest.approx(1 / 3, abs=0.02)
    assert np.mean(noisy(x, 1) != noisy(x, 2)) == pytest.approx(2 / 3, abs=0.03)


def test_noise_depends_on_the_digits_alone(noisy):
    x = np.random.default_rng(2).normal(size=1000)
    once = noisy(x, 3)
    assert np.array_equal(noisy(x[:10], 3), once[:10])
    assert np.array_equal(noisy(-x, 3), -once)
    assert np.array_equal(noisy(1024.0 * x, 3), 1024.0 * once)
    kept = np.array([0.0, -0.0, np.inf, -np.inf])
    assert np.array_equal(noisy(kept, 3), kept)


def solved():
    gear = fegear.Gear(21, "2 mm", face_width="2 mm")
    table = fegear.stiffness_table(gear, positions=3, tolerance=1e-1).tables["stiffness_a"]
    return table.to_pandas()["c_self [um.mm/N]"].tolist()


@pytest.mark.dear
@pytest.mark.skipif("last_bit" in sys.modules, reason="the process of this test computes with noise itself")
def test_a_process_that_is_started_under_noise_computes_with_it():
    paths = os.pathsep.join([str(OTHER), *filter(None, sys.path)])
    given = {**os.environ, "PYTHONPATH": paths, "FEGEAR_LAST_BIT": "11"}
    program = f"import json, fegear\n{inspect.getsource(solved)}\nprint(json.dumps(solved()))"
    run = subprocess.run([sys.executable, "-c", program], env=given, capture_output=True, text=True, check=True)
    found = json.loads(run.stdout)
    assert found == pytest.approx(solved(), rel=1e-6)
    assert found != solved()


def test_hard_cases_run_under_noise_whole_and_others_in_part(request):
    """What `--last-bit` keeps of what is collected; that it computes with noise then is the test above."""
    root = Path(__file__).parents[1] / "conftest.py"
    (ours,) = (one for one in request.config.pluginmanager.get_plugins() if getattr(one, "__file__", "") == str(root))

    def kept(marked):
        item = SimpleNamespace(get_closest_marker=lambda name: (marked and name == "last_bit") or None)
        return [ours._is_for_last_bit(request.config, setattr(item, "nodeid", f"a.py::b[{i}]") or item)
                for i in range(2000)]  # fmt: skip

    assert all(kept(marked=True))
    assert np.mean(kept(marked=False)) == pytest.approx(1.0 / request.config.getoption("last_bit_every"), abs=0.02)
    assert kept(marked=False) == kept(marked=False)
