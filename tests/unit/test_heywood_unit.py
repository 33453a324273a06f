"""Heywood's stress of a generated tooth: where on the fillet it is largest."""

import numpy as np
import pytest

from fegear.formulas.heywood import tooth_root_stress
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack


@pytest.mark.parametrize("radius", [14.2, 14.6, 14.9])
def test_the_place_has_the_digits_of_the_load_s_radius(radius):
    """Where a curve is largest it is flat: the largest of its values alone gives half of the digits."""
    tooth = Tooth(28, BasicRack(1.0, 1.34225, 0.22972))
    near, off = tooth_root_stress(tooth, radius), 1e-5
    before, after = (tooth_root_stress(tooth, radius * (1.0 + side * off)) for side in (-1.0, 1.0))
    rate = (after.tangent_angle - before.tangent_angle) / (2.0 * off)
    for step in np.array([-3.0, 1.0, 4.0]) * 1e-12:
        moved = tooth_root_stress(tooth, radius * (1.0 + step))
        assert moved.tangent_angle - near.tangent_angle == pytest.approx(rate * step, abs=2e-11)
        assert moved.stress == pytest.approx(near.stress, rel=1e-10)
