"""Values known at few radii, at the radius of each position and load: numpy's own interpolation is the other way."""

from __future__ import annotations

import numpy as np

from fegear.contact.plane.tooth_stress import _interpolated


def test_values_at_few_radii_are_straight_between_them_and_beyond():
    rng = np.random.default_rng(4)
    few = np.array([10.0, 10.5, 11.5, 13.0])
    radius = np.array([10.0, 10.2, 10.5, 11.0, 12.9, 13.0])
    values = rng.normal(size=(radius.size, 2, few.size))
    found = _interpolated(values.reshape(-1, few.size), few, radius)
    expected = [[np.interp(r, few, row) for row in each] for r, each in zip(radius, values, strict=True)]
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    lines = (3.0 + 2.0 * few) * np.ones((2, 1))  # round-off may lie beyond the ends
    np.testing.assert_allclose(_interpolated(lines, few, np.array([9.9, 13.2])), [[22.8], [29.4]])
