"""Fields at the nodes of a whole gear: each sector's own, turned to its place, and one value on every seam."""

import math

import numpy as np
import pytest

from fegear.fem.plane.loaded_gear import loaded_gear, nodal_fields
from fegear.fem.plane.settings import MeshSettings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear

LINE_LOAD = 2e5


@pytest.fixture(scope="module")
def solved():
    gear = Gear(Tooth(12), 2e-3, 6e-3, 10e-3)
    return gear, *loaded_gear(gear, MeshSettings().scaled(2.5))


def test_sectors_agree_on_their_seams(solved):
    """What one sector says of a node that it shares with the next is what that one says."""
    gear, whole, field = solved
    found = nodal_fields(gear, whole, field, LINE_LOAD)["displacement"]
    scale = LINE_LOAD / gear.material.young_modulus * 1e3
    largest = np.abs(found).max()
    shared = 0
    for k, nodes in enumerate(whole.sector_nodes):
        turn = 2.0 * math.pi * k / gear.teeth  # clockwise
        x, y = field.displacement[k] * scale
        own = np.array([math.cos(turn) * x + math.sin(turn) * y, math.cos(turn) * y - math.sin(turn) * x]).T
        np.testing.assert_allclose(found[nodes, :2], own, atol=1e-9 * largest)
        shared += nodes.size
    assert shared > found.shape[0]
    assert (found[:, 2] == 0.0).all()


def test_stress_on_a_seam_is_the_mean_of_both_sides(solved):
    gear, whole, field = solved
    found = nodal_fields(gear, whole, field, LINE_LOAD)["von_mises"] * gear.module / LINE_LOAD * 1e6
    sides = [[] for _ in found]
    for nodes, stress in zip(whole.sector_nodes, field.von_mises, strict=True):
        for node, one in zip(nodes, stress, strict=True):
            sides[node].append(one)
    np.testing.assert_allclose(found, [np.mean(one) for one in sides], rtol=1e-12)
    assert {len(one) for one in sides} == {1, 2}
