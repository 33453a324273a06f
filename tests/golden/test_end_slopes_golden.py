"""The table of end faces against the solid teeth that it comes from, and against what is known exactly."""

import importlib.util
from pathlib import Path

import pytest

from fegear.fem.solid.bands import end_slope

_spec = importlib.util.spec_from_file_location("make_end_slopes", Path(__file__).parent / "make_end_slopes.py")
generator = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(generator)


@pytest.mark.dear
def test_a_square_end_of_a_body_that_does_not_contract_is_its_mirror():
    assert end_slope(0.0, 0.0) == pytest.approx(0.0, abs=1e-12)
    found = generator.end_slopes(0.0, 0.0, degree=4, edge=0.2, wide=0.25, narrow=0.15)
    assert found == pytest.approx([0.0, 0.0], abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize(("angle", "poisson_ratio"), [(0.0, 0.3), (24.0, 0.3), (12.0, 0.22), (36.0, 0.4)])
def test_the_table_is_what_solid_teeth_give(angle, poisson_ratio):
    acute, obtuse = generator.end_slopes(angle, poisson_ratio)
    radians = angle * 3.141592653589793 / 180.0
    assert end_slope(radians, poisson_ratio) == pytest.approx(acute, rel=0.02, abs=0.004)
    assert end_slope(-radians, poisson_ratio) == pytest.approx(obtuse, rel=0.02, abs=0.004)
