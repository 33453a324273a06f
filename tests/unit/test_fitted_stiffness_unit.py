"""The fitted stiffness of one tooth pair against an atlas, symmetry, and its range."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.formulas.fitted_stiffness import ERROR, single_stiffness
from fegear.formulas.iso6336.part1_stiffness import theoretical_stiffness
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

FACE, LOAD = 20e-3, 300e3


@pytest.mark.parametrize(("z", "x"), [((20, 43), (0.3, 0.1)), ((31, 31), (0.0, 0.0)), ((17, 120), (0.4, -0.2))])
def test_it_is_that_of_finite_elements_within_its_error(z, x):
    from fegear.atlas.shipped import shipped_atlas

    steel, rack = Material(2.06e11, 0.3), BasicRack(1.0, 1.25, 0.38)
    teeth = [Tooth(one[0], rack, one[1]) for one in zip(z, x, strict=True)]
    gears = [Gear(one, 3e-3, 1.5e-3 * one.root_radius, face_width=FACE, material=steel) for one in teeth]
    pair, atlas = GearPair(*gears), shipped_atlas("A")
    sources = [atlas.compliance(gear) for gear in gears]
    angle = math.acos(sum(gear.base_radius for gear in gears) / pair.centre_distance)
    at = [gear.base_radius * math.tan(angle) for gear in gears]
    width = math.sqrt(4.0 * LOAD / (math.pi / sum(1.0 / g.plane_modulus for g in gears)) / sum(1.0 / one for one in at))
    c = sum(
        float(source.own(0, np.hypot(gear.base_radius, one)))
        + source.log_slope * math.log(float(source.reference_half_width(0.0)) / width)
        for source, gear, one in zip(sources, gears, at, strict=True)
    )
    assert single_stiffness(*z, *x) == pytest.approx(1.0 / c, rel=ERROR[2])
    engagement = Engagement(PairCompliance(pair, *sources), corner_contact=False)
    state = engagement.solve(engagement.grid([0.0]), [LOAD * FACE])
    assert 1.0 / c < LOAD / float(state.transmission_error[0, 0]) * (1.0 + 1e-9)


def test_both_gears_count_alike_and_stiffness_is_that_of_a_tooth_pair():
    assert single_stiffness(20, 43, 0.3, 0.1) == pytest.approx(single_stiffness(43, 20, 0.1, 0.3), rel=1e-12)
    assert 0.75 < single_stiffness(30, 60) / (0.8 * theoretical_stiffness(30, 60)) < 1.25


@pytest.mark.parametrize("asked", [(11, 30, 0.0, 0.0), (20, 500, 0.0, 0.0), (20, 30, -0.6, 0.0), (20, 30, 0.0, 0.8)])
def test_outside_its_range_it_refuses(asked):
    with pytest.raises(RangeError, match="is outside the range of the fit"):
        single_stiffness(*asked)
