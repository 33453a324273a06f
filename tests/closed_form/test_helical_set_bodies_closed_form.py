"""Helical planetary sets as rigid bodies in space: unequal places, planets that lift and sets without equilibrium.

Three planets at even places are a row of `fegear verify`, helical-sets-in-space.
"""

import math

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError
from fegear.dynamics.planetary.kinematics import axial_forces, running
from fegear.dynamics.planetary.planet_loads import planet_loads
from fegear.dynamics.planetary.planet_set import CENTRALS, PlanetarySet
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.verify.bodies import PIN, TWIST, bodies_in_space
from fegear.verify.planetary_sets import constant, meshed


@pytest.mark.parametrize("driving", ["sun", "ring", "carrier"])
@pytest.mark.parametrize("planets", [3, *(pytest.param(count, marks=pytest.mark.long) for count in (1, 2, 4))])
def test_forces_shares_and_moments_are_those_of_bodies_in_space(driving, planets):
    rng = np.random.default_rng(100 * planets + len(driving))
    solved = 0
    for _ in range(4):
        # Unequal places, and a planet whose working angles differ at sun and ring.
        z_s, z_p, z_r = 24, 28, 81
        step = math.tau / (z_s + z_r)
        places = np.sort(rng.choice(range(0, z_s + z_r, 15), planets, replace=False))  # seven parts of a cycle
        pitch = math.pi * 2e-3 * math.cos(math.radians(21.0))
        found = PlanetarySet(z_s, z_p, z_r, pitch, 52.6e-3, (places - places[0]) * step, 0.07)
        assert abs(found.sun_angle - found.ring_angle) > math.radians(1.0)
        bearings = [math.inf, 10.0 ** rng.uniform(7, 9)]
        supports = {name: float(rng.choice(bearings)) for name in CENTRALS}
        if planets > 2 and rng.random() < 0.5:
            supports["sun"] = 0.0  # floating
        springs = 10.0 ** rng.uniform(8, 9, 2)
        errors = rng.normal(0.0, float(rng.choice([1e-6, 40e-6])), (2, planets))
        torque = 300.0
        central = (CentralBody(bearing=supports[name]) for name in CENTRALS)
        made = SetModel(found, *central, PlanetBody(pin=PIN))
        run = meshed(made, constant(springs[0]), constant(springs[1]), torque=torque, driving=driving)
        outer = made.torque_load(torque)[[2, 5, 8]] * [found.lever(name) for name in CENTRALS]
        cos_b = math.cos(math.atan(TWIST))
        asked = bodies_in_space(found, supports, springs / cos_b**2, errors,
                                float(outer[CENTRALS.index(driving)]), driving)  # fmt: skip
        if asked is None:  # planets on one side of a sun that floats
            with pytest.raises(ConvergenceError, match="No equilibrium of the planets"):
                planet_loads(run, errors)
            continue
        normal, moments, along = asked
        loads = planet_loads(run, errors)
        mine = loads.mesh_force[..., 0]
        assert mine == pytest.approx(normal * cos_b, abs=1e-6 * run.mean_force)
        turning = running(found, "ring", "sun", 100.0, torque)
        equal = axial_forces(found, turning, TWIST)
        assert equal.sun == pytest.approx(-along[0].sum(), rel=1e-6)  # whatever the shares: the torque alone says it
        assert equal.tilting * loads.shares == pytest.approx(moments, rel=1e-5, abs=1e-6 * abs(equal.tilting))
        assert np.allclose(along.sum(axis=0), 0.0, atol=1e-6 * run.mean_force)  # both meshes of a planet cancel
        solved += 1
    assert solved > 1
