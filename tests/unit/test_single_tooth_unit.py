"""Places of one tooth pair of a train: beside corners of the transmission error, whatever round-off makes of these."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.dynamics.train.periodic import Periodic
from fegear.dynamics.train.single_tooth import positions, summed_harmonics
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

GEAR = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3e-3, 0.02, 1e-2)


def places(moved):
    """101 even places, and those beside corners at .3 and .7 of a pitch, which three functions know as `moved`."""
    error = Periodic.through_points([0.0, 0.3, 0.7, 1.0], [0.0, 1e-6, -1e-6, 0.0])
    stiffness = [
        Periodic.through_points([0.0, 0.3 + off, 0.7 + off, 1.0], [1e8, 2e8, 2e8, 1e8]) for off in (moved, -1e-7, 1e-7)
    ]
    mesh = SimpleNamespace(pair=GearPair(GEAR, GEAR), error=error, excitation=SimpleNamespace(stiffness=stiffness))
    return positions(SimpleNamespace(meshes=[mesh]), 0, 101), mesh.pair


@pytest.mark.parametrize("steps", [-3, -1, 1, 4])
def test_round_off_of_a_corner_adds_no_place(steps):
    plain, pair = places(0.0)
    moved, _ = places(steps * 2.0**-53)
    assert moved == pytest.approx(plain, abs=1e-12 * pair.base_pitch)
    # one place on either side of each corner on the path, a little farther out than any function's end
    added = np.setdiff1d(plain, np.linspace(plain[0], plain[-1], 101)) / pair.base_pitch
    sides = added.reshape(-1, 2)
    assert np.ptp(sides, axis=1) == pytest.approx(4e-7, rel=1e-3)
    assert np.abs(np.abs(np.mod(sides.mean(axis=1), 1.0) - 0.5) - 0.2).max() < 1e-9


@pytest.mark.parametrize(
    ("pitches", "asked", "summed"),
    [((1,), 4, 256), ((1,), 300, 300), ((2,), 4, 128), ((3,), 4, 86), ((1, 28), 4, 10), ((28, 1), 40, 40)],
)
def test_lines_of_a_tooth_force_are_256_over_the_longest_cycle_at_least(pitches, asked, summed):
    """Mesh harmonics: where errors repeat after several pitches there are so many rotational lines to each."""
    data = SimpleNamespace(errors=[SimpleNamespace(pitches=count) for count in pitches])
    assert summed_harmonics(data, asked) == summed
