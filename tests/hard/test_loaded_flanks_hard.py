"""Loaded flanks where little or very much touches: many stations, feathers and sledgehammers, a helix of nothing."""

import math

import numpy as np
import pytest

from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import solve_thin_slices
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

STEEL = Material(206.8e9, 0.3, 7850.0)
MODULE, WIDTH = 3e-3, 18e-3
MISALIGNED = FlankGaps(face_position=np.array([-0.5, 0.5]) * WIDTH, line_gap=np.array([0.0, 40e-6]))


def flanks(beta, panel):
    def gear(hand):
        tooth = Tooth(20, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
        return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, WIDTH, STEEL, "strain", hand if beta else "spur")

    def body(one):
        m = one.module
        return solve_thin_slices(
            one.tooth, one.twist * m, one.face_width / m, 0.3, one.bore_radius / m, SolidSettings().scaled(1.7), reach=3
        )

    pair = GearPair(gear("right"), gear("left"))
    return FlankPair(pair, {"driver": body(pair.driver), "driven": body(pair.driven)}, panel=panel, positions=4)


@pytest.mark.dear
@pytest.mark.parametrize(("beta", "panel"), [(15.0, 0.03), (1e-6, 0.5), (35.0, 0.5)])
def test_loads_of_every_size_find_their_stations(beta, panel):
    """200 stations a line, hardly a helix, 35 degrees; 1e-4 to 5000 N/mm, ends of the face that never touch."""
    pair = flanks(beta, panel)
    loads = np.array([1e-4, 1.0, 5e3]) * WIDTH * 1e3
    known = pair.compliance(float(loads[-1]))
    assert known.lines.present.sum(axis=1).max() >= (350 if panel < 0.1 else 10)
    for gaps in (FlankGaps(), MISALIGNED):
        found = pair.solve(loads, gaps, known)
        force = found.contact.force
        assert np.isfinite(force).all()
        assert np.isfinite(found.contact.approach).all()
        assert np.isfinite(found.contact.stiffness).all()
        assert force.min() >= 0.0
        assert found.equilibrium.max() < 1e-10
        assert found.contact.residual.max() < 1e-9
        # each problem alone gives what the batch does
        for i in (0, 2):
            one = solve_contact(known, gaps.at(pair.pair, known.lines), loads[i : i + 1])
            np.testing.assert_allclose(one.approach[:, 0], found.contact.approach[:, i], rtol=1e-12)
            np.testing.assert_allclose(one.force[:, :, 0], force[:, :, i], atol=1e-12 * loads[i])
    assert (force[:, :, 0] > 0.0).sum() < (force[:, :, 2] > 0.0).sum()
