"""The table of what the last bit changes, docs/studies/last_bit.csv: as the page has it, and within what is asked."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

_spec = importlib.util.spec_from_file_location(
    "last_bit_study", Path(__file__).parents[2] / "benchmarks" / "last_bit_study.py"
)
study = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(study)


def test_the_page_has_the_table_that_is_kept():
    lines = study.PAGE.read_text("utf-8").splitlines()
    start, rows = lines.index(study.PAGE_HEAD[0]), study.page_lines()
    assert lines[start : start + len(rows)] == rows
    assert not lines[start + len(rows)].startswith("|")


def test_what_moves_is_compared_with_its_error_or_its_size():
    """Of two numbers with an error the one by half of it, of three without the largest by a thousandth of it."""
    exact = {"a": ([1.0, 2.0], [0.1, 0.0], 2.0), "b": ([10.0, 0.0], None, 10.0)}
    other = {"a": ([1.05, 2.0], None, 0.0), "b": ([10.0, 0.01], None, 0.0)}
    stated, ratio, which, bare, of_size, bare_which = study.spread(exact, [exact, other])
    assert (stated, which, bare, bare_which) == (1, "a", 3, "b")
    assert (ratio, of_size) == pytest.approx((0.5, 1e-3))
    # another number of rows, a refusal, and a number that is none any more
    for lost in ({"a": ([1.0], None, 0.0)}, "refused", {"a": ([np.nan, 2.0], None, 0.0)}):
        assert study.spread(exact, [lost])[1] == np.inf


def test_noise_of_the_inputs_moves_quantities_and_no_counts():
    text = 'teeth = 28\nmodule = "3.175 mm"\nx = 0.25 # 0.5 mm\n# "3 mm"\nname = "pair 2"\n'
    moved = study.off_by(text, 1, lambda x, seed: np.nextafter(x, np.inf))
    assert moved.splitlines()[0] == "teeth = 28"
    assert float(moved.split('"')[1].split()[0]) == pytest.approx(3.175 * (1.0 + 1e-12), rel=1e-15)
    assert moved.splitlines()[3:] == ['# "3 mm"', 'name = "pair 2"']
