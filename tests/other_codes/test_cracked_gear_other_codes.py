"""Cracked teeth compared with whole gears by another mesh and another code (`tests/helpers/cracked_gear.py`)."""

import itertools
import json
import math
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.cracked_sector import cracked_sector
from fegear.fem.plane.odd.odd_influence import solve_odd_influence
from fegear.fem.plane.odd.tooth_kind import OddTooth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from tests.helpers.cracked_gear import Solved, cracked_gear

#: Teeth, basic rack, profile shift coefficient, bore [modules], tangent of the mouth and angle of the crack [deg], and
#: share of the way through.
GEARS = {
    "28 teeth": (28, "A", 0.0, 6.375, 30.0, 70.0, 0.3),
    "19 teeth": (19, "B", 0.3, 4.0, 45.0, 55.0, 0.45),
    "41 teeth": (41, "C", -0.1, 14.0, 35.0, 85.0, 0.15),
}
SETTINGS = settings_at(-2)
PATCH = SETTINGS.patch_half_width


def gear(name):
    """Tooth, bore, crack and loaded radii."""
    teeth, rack, shift, bore, tangent, angle, share = GEARS[name]
    tooth = Tooth(teeth, BasicRack.named(rack), shift)
    crack = straight_crack(tooth, mouth_at_tangent(tooth, math.radians(tangent)), math.radians(angle), share=share)
    low, high = tooth.form_radius, tooth.tip_radius
    return tooth, bore, crack, [low + part * (high - low) for part in (0.2, 0.5, 0.8)]


@pytest.mark.dear
@pytest.mark.parametrize(
    "name", ["19 teeth", *(pytest.param(name, marks=pytest.mark.long) for name in list(GEARS)[::2])]
)
def test_cracked_ring_is_the_whole_gear(name):
    """c_ij within 3e-4 of the largest, K within 2e-3, root tension of teeth beside it within 1e-3 of a loaded one's.

    Wherever it is largest: loads on other teeth have it near either end of the fillet, up to 0.96 of the way.
    """
    tooth, bore, crack, radii = gear(name)
    sector = cracked_sector(tooth, bore, SETTINGS, crack)
    found = solve_odd_influence(
        tooth, mesh_sector(tooth, bore, SETTINGS), {0: OddTooth(tooth, sector)}, 0.3, "strain", SETTINGS
    )
    whole = Solved(tooth, bore, cracked_gear(tooth, bore, crack.path(tooth), radii, 0.08, 0.025, 0.04))
    largest, apart = float(found.own(0, radii, PATCH, 0.02).max()), ~np.eye(3, dtype=bool)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            off = np.abs(found.between(i, j, radii, radii, PATCH) - whole.between(i, j))
            assert off[apart if i == j else slice(None)].max() < 3e-4 * largest
    keys = [(0, 0), (0, 1), (0, 2), (1, 1), (-1, 1)]
    k = np.hstack([found.stress_intensity(0, j, [radii[n]], PATCH)[0] for j, n in keys])
    released = whole.energy_release(keys, sector.tip, sector.way, 0.2 * sector.room, 0.7 * sector.room)
    assert np.sqrt(np.diag(released) / (1.0 - 0.3**2)) == pytest.approx(np.hypot(*k), rel=2e-3)
    assert released / (1.0 - 0.3**2) == pytest.approx(k.T @ k, abs=4e-3 * float((k.T @ k).max()))
    loaded = float(found.largest_root_stress(1, 1, "tension", [radii[1]], 0.02)[0][0])
    for i, j in itertools.product((-1, 1), (-1, 0, 1)):
        stress, _ = found.largest_root_stress(i, j, "tension", [radii[1]], 0.02)
        assert whole.root_tension(i, (j, 1)) == pytest.approx(stress[0], abs=1e-3 * loaded, rel=6e-3)


@pytest.mark.dear
def test_the_other_code_is_calculix():
    """The same mesh and loads in CalculiX 2.20 (CPE6, other quadrature at the tip): `make_cracked_gear_calculix.py`."""
    kept = json.loads((Path(__file__).parent / "cracked_gear_calculix.json").read_text())
    tooth, bore, crack, radii = gear("19 teeth")
    whole = Solved(tooth, bore, cracked_gear(tooth, bore, crack.path(tooth), radii, kept["size"], kept["tip"]))
    assert whole.between(0, 0)[0, 1] == pytest.approx(kept["c_00"], rel=5e-4)
    assert whole.between(1, 0)[0, 1] == pytest.approx(kept["c_10"], rel=1e-4)
