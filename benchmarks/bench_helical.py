"""Tooth contact analysis (aim: 0.5 s for a cycle of 400 positions), transmissibility (0.1 s for 2000 frequencies)."""

import math

import numpy as np
import pytest

from fegear.contact.unloaded import HelicalGear
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.contact.unloaded.tooth_contact import tooth_contact
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters
from fegear.dynamics.helical_pair.model import HelicalPairModel, RigidGear
from fegear.dynamics.helical_pair.transmissibility import transmissibility

ARCMIN = math.pi / 10800.0


def drive(**errors):
    pinion, gear = (
        HelicalGear(n, 0.0254 / 5.0, math.radians(20.0), math.radians(30.0), 1.6 * 0.0254, hand)
        for n, hand in ((30, "left"), (100, "right"))
    )
    return HelicalPair(pinion, gear, Misalignment(**{key: size * ARCMIN for key, size in errors.items()}))


CASES = {
    "aligned": drive(),
    "shaft": drive(shaft_angle=3.0),
    "combined": drive(shaft_angle=3.0, lead_angle=-4.0),
    "profile and lead": drive(profile_angle=3.0, lead_angle=-2.0),
}


@pytest.mark.parametrize("name", list(CASES))
def test_three_pairs_at_400_positions(benchmark, name):
    pair = CASES[name]
    benchmark(pair_contact, pair, np.linspace(*pair.engagement, 1200))


@pytest.mark.parametrize("name", list(CASES))
def test_whole_analysis_of_400_positions_with_exact_extremes(benchmark, name):
    benchmark(tooth_contact, CASES[name], 400)


@pytest.mark.parametrize("method", ["direct", "state-space"])
def test_transmissibility_at_2000_frequencies(benchmark, method):
    bearing = np.diag([6e8, 1.5e8, 2e5, 4e5, 0.0])
    gears = [
        RigidGear(m, (0.4 * m * a * a, 0.5 * m * a * a, 0.6 * m * a * a), a, 0.02, bearing, 1e-6 * bearing)
        for m, a in ((2.0, 0.05), (5.0, 0.09))
    ]
    model = HelicalPairModel(*gears, MeshParameters(3e8, 0.5, 1.0 / 3.0, 0.5), 1e-6, 0.02)
    frequency = model.natural_frequency * np.linspace(0.01, 3.0, 2000)
    benchmark(transmissibility, model, frequency, method)
