"""The tool that stands for another processor: noise of one unit in the last place, where rounding enters."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

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


_SOLVED = """
import json
import fegear
gear = fegear.Gear(21, "2 mm", face_width="2 mm")
table = fegear.stiffness_table(gear, positions=3, tolerance=1e-1).tables["stiffness_a"]
print(json.dumps(table.to_pandas()["c_self [um.mm/N]"].tolist()))
"""


def test_a_process_that_is_started_under_noise_computes_with_it():
    def solved(seed):
        paths = [str(OTHER)] if seed else []
        paths += [p for p in sys.path if p]
        given = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "FEGEAR_LAST_BIT": str(seed)}
        if not seed:
            del given["FEGEAR_LAST_BIT"]
        run = subprocess.run([sys.executable, "-c", _SOLVED], env=given, capture_output=True, text=True, check=True)
        return np.array(json.loads(run.stdout))

    assert not np.array_equal(solved(0), solved(11))


def test_hard_cases_run_under_noise_whole_and_others_in_part():
    def collected(*options):
        files = ["tests/hard/test_pairs_hard.py", "tests/closed_form/test_hertz_closed_form.py"]
        usual = ["-n", "0", "-p", "no:cacheprovider", "--collect-only"]
        command = [sys.executable, "-m", "pytest", *usual, *options, *files]
        root = Path(__file__).parents[2]
        done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
        return [sum(line.startswith(file) for line in done.stdout.splitlines()) for file in files]

    every, noisy = collected(), collected("--last-bit", "1")
    assert noisy[0] == every[0]
    assert noisy[1] < every[1]
