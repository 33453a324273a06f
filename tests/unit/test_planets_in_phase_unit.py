"""Which meshes of a set are in phase at all planets."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest

from fegear.dynamics.compound.compound_set import Planets, Shaft, Toothed, Wheel
from fegear.dynamics.compound.tooth_search import _in_phase


@pytest.mark.parametrize(("teeth", "count", "in_phase"), [(24, 3, True), (25, 3, False), (26, 4, False), (28, 4, True)])
@pytest.mark.parametrize("turned", [0.0, 0.7])
def test_a_mesh_is_in_phase_where_planets_stand_whole_pitches_apart(teeth, count, in_phase, turned):
    angles = tuple(turned + 2.0 * math.pi * n / count for n in range(count))
    planet, sun = Wheel("p", 17), Wheel("s", teeth)
    planets = Planets("P", "carrier", (planet,), angles)
    named = SimpleNamespace(name="p-s")
    meshes = [
        Toothed(named, planets, planet, Shaft("sun", (sun,)), sun),
        Toothed(named, planets, planet, planets, sun),  # two planets have no phase of their own to the housing
    ]
    assert _in_phase(meshes) == (["p-s"] if in_phase else [])
