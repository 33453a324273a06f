"""Stated errors of random ring gears compared with solutions on edges a quarter as long."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

#: Level of what is judged, and of what it is compared with.
LEVEL, TRUE = -2, 2
WIDTH = np.full(9, 0.02)


def random_rings(count, seed):
    """Tooth, outer radius [modules] and Poisson's ratio of so many ring gears; what cannot exist is drawn again."""
    rng = np.random.default_rng(seed)
    found = []
    while len(found) < count:
        teeth, cutter_teeth = int(rng.integers(30, 140)), int(rng.integers(12, 30))
        shift, rounding = rng.uniform(-0.4, 0.6), float(rng.choice([0.0, 0.05]))
        cutter_shift, addendum, tip = rng.uniform(-0.2, 0.4), rng.uniform(1.1, 1.35), rng.uniform(0.1, 0.35)
        alpha, height = math.radians(rng.choice([17.5, 20.0, 22.5, 25.0])), rng.uniform(0.6, 1.0)
        rim, nu = rng.uniform(1.2, 8.0), rng.uniform(0.2, 0.4)
        try:
            cutter = PinionCutter(cutter_teeth, cutter_shift, addendum, tip_radius=tip)
            tip_radius = 0.5 * teeth - shift - height
            tooth = InternalTooth(teeth, cutter, alpha, shift, 0.0, tip_radius, tip_rounding=rounding)
        except FegearError:
            continue
        found.append((tooth, tooth.root_radius + rim, nu))
    return found


@pytest.mark.dear
@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 31))])
def test_the_stated_errors_of_a_random_ring_cover_the_true_ones(seed):
    """Those of neighbours were 1.9 times the stated ones, whose share was learned from external gears alone."""
    ((tooth, outer, nu),) = random_rings(1, seed)
    known = influence_of_shape(tooth, outer, nu, "strain", settings_at(LEVEL), 1, two_orders=True)
    coarser, patch = settings_at(LEVEL - 1), settings_at(LEVEL).patch_half_width
    lower = replace(known.lower, corner_distance=coarser.corner_distance)
    stated = Estimate(known, lower, patch, coarser.patch_half_width)
    truth = influence_of_shape(tooth, outer, nu, "strain", settings_at(TRUE), 1)
    least, most = tooth.involute_radii
    radii, finest = np.linspace(least + 0.03, most - 0.03, 9), settings_at(TRUE).patch_half_width

    def covered(value, error, wanted):
        assert np.abs(value - wanted).max() <= 1.5 * error.max()

    covered(known.self_compliance(radii, patch, WIDTH), stated.self_error(radii, WIDTH),
            truth.self_compliance(radii, finest, WIDTH))  # fmt: skip
    for k in (1, -1):
        covered(*stated.neighbour(k, radii, radii), truth.neighbour(k, radii, radii, finest))
    for side in SIDES:
        value, _, error = stated.root_stress(0, side, radii, WIDTH)
        covered(value, error, truth.largest_root_stress(0, side, radii, WIDTH)[0])
