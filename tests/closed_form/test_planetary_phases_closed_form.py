"""Laws of the phases of planetary sets; those of polygons that touch are a row of `fegear verify`, planetary-phases."""

import math

import numpy as np
import pytest

from fegear.dynamics.planetary.phases import common_parts, mesh_phases, phasing
from fegear.dynamics.planetary.planet_set import PlanetarySet, even_angles
from fegear.verify.polygons import SETS, apart, described


def test_both_meshes_of_a_planet_that_fits_have_one_delay():
    for one in SETS:
        found = mesh_phases(described(one))
        assert apart(found.sun, found.ring) < 1e-9
        assert np.allclose((found.sun * common_parts(described(one)) + 0.5) % 1.0, 0.5, atol=1e-8)


def test_other_flanks_and_the_other_way_round():
    """Seen from behind, a set turns the other way: planets meet in the mirrored order."""
    found = described(SETS[2])
    forward, backward = mesh_phases(found), mesh_phases(found, clockwise=True)
    assert apart(forward.sun, -backward.sun) < 1e-12
    assert apart(forward.ring_behind_sun, backward.ring_behind_sun) < 1e-12
    assert apart(forward.ring_behind_sun, -mesh_phases(found, sun_drives=False).ring_behind_sun) < 1e-12


@pytest.mark.parametrize("planets", [3, 4, 5, 7])
def test_the_rule_of_evenly_spaced_planets(planets):
    for sun in range(planets * 6, planets * 7):
        ring = planets * 30 - sun
        found = PlanetarySet(sun, 12, ring, 1.0, 0.55 * ring / math.pi, even_angles(planets), 0.1)
        rule = phasing(found, 2 * planets)
        left = (rule.harmonic * sun) % planets
        assert np.allclose(rule.torque, left == 0, atol=1e-12)
        beside = (left == 1) | (left == planets - 1)
        assert np.allclose(rule.force, beside, atol=1e-12)
        assert rule.excites == tuple(np.where(left == 0, "rotation", np.where(beside, "translation", "planets")))
