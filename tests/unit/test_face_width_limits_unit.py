"""Widths of faces at their limits, and what averaging over the face makes of loads that stand on little of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.fem.solid.settings import SolidSettings, check_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.results.pair.load_distribution import limit_remarks

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))


def check(width):
    check_solid(TOOTH, 0.0, width, 0.3, SolidSettings(), None, 0)


def accepted(width):
    try:
        check(width)
    except RangeError:
        return False
    return True


@pytest.mark.parametrize("width", [0.6 / 3.0, 0.2, 0.00042 / 0.0021, 60.0, 0.18 / 0.003])
def test_a_face_as_wide_as_the_limit_is_solved_whatever_its_last_digit(width):
    assert accepted(width)
    assert not accepted(width * (1.0 - 1e-7 if width < 1.0 else 1.0 + 1e-7))


@pytest.mark.parametrize("width", [0.2 * (1.0 - 1e-7), 0.19, 60.0001])
def test_what_is_refused_is_not_written_as_the_limit(width):
    with pytest.raises(RangeError, match=r"must be between 0\.2 and 60 modules") as refused:
        check(width)
    assert not str(refused.value).startswith(("face_width = 0.2 modules", "face_width = 60 modules"))


@pytest.mark.parametrize(("factor", "said"), [(1.3, 0), (9.9, 0), (10.1, 1), (20.0, 1)])
def test_a_face_load_factor_near_the_most_that_its_averaging_allows_is_remarked_on(factor, said):
    """Ten modules in cells of half a module: 20 times the mean where one cell has all."""
    found = SimpleNamespace(face_load_factor=np.array([1.0, factor]), cells=np.linspace(-0.015, 0.015, 21))
    remarks = limit_remarks("I", found, 1)
    assert len(remarks) == said
    if said:
        assert "the maximum that can be resolved (20)" in remarks[0]
        assert "1.5 mm" in remarks[0]
