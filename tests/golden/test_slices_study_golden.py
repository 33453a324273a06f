"""The table of what slices get wrong, docs/studies/slices.csv: whole, what its page says of it, and one corner anew."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

_PLACE = Path(__file__).parents[2] / "benchmarks" / "slices_study.py"
_spec = importlib.util.spec_from_file_location("slices_study", _PLACE)
study = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(study)


@pytest.fixture(scope="module")
def table():
    return {
        (float(r["helix_angle [deg]"]), float(r["face_width [modules]"]), r["body"]): np.array(
            [float(r[name]) for name in study.HEAD[3:]]
        )
        for r in study.table()
    }


def test_no_combination_is_missing(table):
    assert set(table) == {(float(a), float(w), b) for a in study.ANGLES for w in study.WIDTHS for b in study.SOLVERS}
    values = np.array(list(table.values()))
    assert np.isfinite(values).all()
    assert (values > 0.0).all()
    assert values[:, 2:].min() >= 1.0 - 1e-9


@pytest.mark.dear("thin slices")
@pytest.mark.parametrize("body", [pytest.param("solid", marks=pytest.mark.long), "thin slices"])
def test_a_corner_of_the_table_is_what_comes_out_now(table, body):
    """Narrow and moderately helical, where slices are farthest off: means to .5 %, the others to 2 %."""
    now = np.array(study.row(20.0, 4.0, body)[3:], dtype=float)
    assert now == pytest.approx(table[20.0, 4.0, body], rel=2e-2)
    assert now[0] == pytest.approx(table[20.0, 4.0, body][0], rel=5e-3)


@pytest.mark.long
@pytest.mark.parametrize(("angle", "width"), [(0.0, 16.0), (35.0, 8.0)])
def test_finer_settings_leave_the_table_as_it_is(table, angle, width):
    """What its settings leave: means within 1 %, K_Hbeta within 3 %."""
    finer = study.row(angle, width, "solid", tolerance=1e-2, positions=48, panel=0.25)
    assert finer[3] == pytest.approx(table[angle, width, "solid"][0], rel=1e-2)
    assert finer[5:] == pytest.approx(table[angle, width, "solid"][2:], rel=3e-2)
