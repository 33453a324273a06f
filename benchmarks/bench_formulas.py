"""Closed-form tables of 100 load positions; the aim is under 20 ms each."""

import numpy as np
import pytest

from fegear.formulas.root_stress_formulas import root_stress_table
from fegear.formulas.sources import SOURCES
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack


def usual() -> Gear:
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 3.175e-3, 0.5 * tooth.root_radius * 3.175e-3, 6.35e-3)


@pytest.mark.parametrize("name", list(SOURCES))
def test_stiffness_table(benchmark, name):
    gear = usual()
    radii = np.linspace(gear.form_radius, gear.involute_tip_radius, 100)
    benchmark(SOURCES[name].tooth, gear, radii)


def test_root_stress_table(benchmark):
    tooth = usual().tooth
    benchmark(root_stress_table, tooth, np.linspace(tooth.form_radius, tooth.involute_tip_radius, 10))
