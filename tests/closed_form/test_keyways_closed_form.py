"""A keyway in the bore: whole gears by another mesh and code, laws, and sentences of what has no room."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.odd.keyway import DIN_6885, Keyway, din_6885, keyed_patch, refuse_keyway
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.patched_influence import solve_patched_influence
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack
from tests.helpers.cracked_gear import Solved, cracked_gear

TOOTH, BORE, RADII = Tooth(25, BasicRack()), 7.0, [12.1, 12.5, 13.0]
GEAR = Gear(TOOTH, 2e-3, 2e-3 * BORE, 20e-3, Material(206e9))
KEYWAY = Keyway(4.0, 1.65, math.radians(3.0))


@pytest.mark.dear
def test_a_gear_with_a_keyway_is_the_whole_gear():
    """c_ij within 3e-4 of the largest, root stress of the teeth above it within 3e-3."""
    settings, half = settings_at(-3), KEYWAY.sectors_beside(25, BORE)
    found = solve_patched_influence(
        TOOTH, mesh_sector(TOOTH, BORE, settings), keyed_patch(TOOTH, BORE, settings, KEYWAY), half, 0.3, "strain",
        settings, reach=half + 2,
    )  # fmt: skip
    shape = KEYWAY.width, KEYWAY.depth, KEYWAY.angle
    whole = Solved(TOOTH, BORE, cracked_gear(TOOTH, BORE, None, RADII, 0.12, fillet=0.06, keyway=shape))
    patch = settings.patch_half_width
    largest, apart = float(found.own(0, RADII, patch, 0.02).max()), ~np.eye(3, dtype=bool)
    for i in (-1, 0, 1):
        for j in (-1, 0, 1):
            off = np.abs(found.between(i, j, RADII, RADII, patch) - whole.between(i, j))
            assert off[apart if i == j else slice(None)].max() < 3e-4 * largest
    for i in (0, 1):
        stress = found.largest_root_stress(i, i, "tension", [RADII[1]], 0.02)[0]
        assert whole.root_tension(i, (i, 1)) == pytest.approx(stress[0], rel=3e-3)


@pytest.mark.dear
def test_a_small_keyway_is_none_and_all_is_reciprocal():
    plain = solve_gear(GEAR, settings_at(-4), reach=2, estimate_error=False)
    radii, width = np.array([24e-3, 25e-3, 26e-3]), np.full(3, 1e-4)
    small, found = (solve_cracked_gear(plain, {3: one}) for one in (Keyway(0.06, 0.06), KEYWAY))
    usual = plain.self_compliance(radii, width)
    for tooth in (2, 3, 4, 6):
        assert small.own(tooth, radii, width) == pytest.approx(usual, rel=3e-4)
        assert (found.own(tooth, radii, width) > 1.03 * usual).all()
    for i, j in ((3, 4), (1, 4), (3, 7), (0, 3)):
        one, other = found.between(i, j, radii, radii), found.between(j, i, radii, radii).T
        assert one == pytest.approx(other, rel=1e-11, abs=1e-13 * usual.max())
    # the teeth on the side of the middle of the keyway give way more, and mirrored the other ones
    ahead, behind = (found.own(tooth, radii, width) for tooth in (4, 2))
    assert (ahead > behind).all()
    assert len(found.touched) == 2 * (KEYWAY.sectors_beside(25, BORE) + 5) + 1
    assert KEYWAY.mirrored().angle == -KEYWAY.angle


def test_keys_of_din_6885():
    assert din_6885(28e-3) == pytest.approx((8e-3, 3.3e-3))
    assert din_6885(50e-3) == pytest.approx((14e-3, 3.8e-3))
    assert din_6885(50.001e-3) == pytest.approx((16e-3, 4.3e-3))
    bores, widths, _ = np.array(DIN_6885).T
    assert (np.diff(bores) > 0.0).all()
    assert (np.diff(widths) > 0.0).all()
    for bore in (6e-3, 231e-3):
        with pytest.raises(InputError, match="above 6 and at most 230 mm"):
            din_6885(bore)


@pytest.mark.parametrize(
    ("keyway", "rule"),
    [
        (Keyway(12.0, 1.0), r"width = 12 modules: must be 0.05 to 11.2 modules"),
        (Keyway(4.0, 0.01), r"depth = 0.01 modules: must be at least"),
        (Keyway(4.0, 4.0), r"leaves 0.0696601 modules between a corner of the keyway and the root circle; at least"),
        (Keyway(4.0, 1.0, 0.2), r"angle = 11.4592 deg: must be between -7.2 and 7.2 deg"),
    ],
)
def test_keyways_without_room_are_refused(keyway, rule):
    with pytest.raises(InputError, match=rule):
        refuse_keyway(TOOTH, BORE, keyway)
