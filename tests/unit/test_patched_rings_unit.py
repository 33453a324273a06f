"""Rings whose sectors are partly meshed as one, coarse: the plain ring in the limit, reciprocity, what is refused."""

import math
from itertools import product

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane.chain import chain_of
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd.keyway import Keyway, keyed_patch
from fegear.fem.plane.odd.odd_ring import odd_ring, patched_ring
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.patched_influence import solve_patched_influence
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

TOOTH, BORE, MODULE, RADII = Tooth(25, BasicRack()), 7.0, 2e-3, np.array([12.1, 12.5, 13.0])
SETTINGS, WIDTH = settings_at(-6), 0.02
KEYWAY, HARDLY = Keyway(2.0, 1.0, math.radians(3.0)), Keyway(0.06, 0.06)
TEETH = range(-4, 5)


@pytest.fixture(scope="module")
def plain():
    return solve_gear(Gear(TOOTH, MODULE, MODULE * BORE, 20e-3, Material(206e9)), SETTINGS, reach=2)


def patched(plain, keyway, **known):
    half, fine = keyway.sectors_beside(25, BORE), plain.fine
    patch = keyed_patch(TOOTH, BORE, SETTINGS, keyway)
    return solve_patched_influence(
        TOOTH, fine.mesh, patch, half, 0.3, "strain", SETTINGS, reach=half + 3, two_orders=True, **known
    )


@pytest.mark.dear
def test_sectors_as_one_are_the_ring_that_they_were_and_know_what_the_gear_knew(plain):
    """With a keyway of next to nothing; solved from meshes, or from the ordinary sector's solution."""
    found, again, patch = patched(plain, HARDLY), patched(plain, HARDLY, known=plain.fine), SETTINGS.patch_half_width
    orders = [
        (found, again, plain.fine, 1e-3, 2e-2), (found.lower, again.lower, plain.fine.lower, 1e-3, 5e-2)
    ]  # fmt: skip
    for one, other, usual, near, of_stress in orders:
        scale = float(usual.self_compliance(RADII, patch).max())
        for i in TEETH:
            assert one.own(i, RADII, patch) == pytest.approx(usual.self_compliance(RADII, patch), rel=near)
        for i, j in product(TEETH, repeat=2):
            value = one.between(i, j, RADII, RADII, patch)
            assert value == pytest.approx(other.between(i, j, RADII, RADII, patch), rel=1e-12)
            if 0 < abs(i - j) <= 2:
                assert value == pytest.approx(usual.neighbour(i - j, RADII, RADII, patch), abs=1e-4 * scale)
            for side in SIDES if abs(i - j) <= 2 else ():
                stress = one.largest_root_stress(i, j, side, RADII, WIDTH)[0]
                own = np.abs(usual.largest_root_stress(0, side, RADII, WIDTH)[0])
                expected = usual.largest_root_stress(i - j, side, RADII, WIDTH)[0]
                assert (np.abs(stress - expected) < of_stress * own).all()
    assert found.lower.own(0, RADII, patch) != pytest.approx(found.own(0, RADII, patch), rel=1e-5)


def test_a_keyway_softens_the_teeth_above_it_most_and_all_is_reciprocal(plain):
    gear, width = solve_cracked_gear(plain, {7: KEYWAY}), np.full(3, 1e-4)
    radii, usual = MODULE * RADII, plain.self_compliance(MODULE * RADII, width)
    more = {i: float((gear.own(i, radii, width) / usual).mean()) - 1.0 for i in range(4, 11)}
    assert max(more, key=more.get) in (7, 8)
    assert more[8] > more[6]  # its middle lies toward the loaded flank
    assert more[4] < 0.8 * more[5] < 0.8 * more[6]
    for i, j in product((5, 7, 8, 10), repeat=2):
        assert gear.between(i, j, radii, radii) == pytest.approx(gear.between(j, i, radii, radii).T, rel=1e-11)


# ---- of stiffnesses made up ----------------------------------------------------------------------------------------
def sector():
    """A symmetric positive definite stiffness between two sides of three unknowns each."""
    found = np.random.default_rng(3).normal(size=(6, 6))
    return found @ found.T + 0.5 * np.eye(6)


@pytest.mark.parametrize(("half", "reach", "teeth"), [(1, 1, 9), (1, 3, 9), (2, 3, 9), (3, 3, 8)])
def test_ordinary_sectors_joined_to_one_leave_the_ring_as_it_is(half, reach, teeth):
    one = patched_ring(sector(), chain_of(sector(), 2 * half + 1), half, teeth, reach)
    usual = odd_ring(sector(), {}, teeth, reach)
    kept = [side + reach for side in range(-reach, reach + 2) if not -half < side <= half]
    assert one.motion[np.ix_(kept, range(3), kept)] == pytest.approx(usual.motion[np.ix_(kept, range(3), kept)])
    beyond = [k for k in range(-reach, reach + 1) if abs(k) > half]
    for i, j in product(beyond, repeat=2):
        assert one.between(i, j) == pytest.approx(usual.between(i, j))
    ends = one.between(0, 0)  # of the patch: its first side, and its last
    assert ends[:3, 3:] == pytest.approx(usual.motion[reach - half, :, reach + half + 1])
    assert np.array_equal(ends, one.between(half, -half))


@pytest.mark.parametrize(
    ("half", "reach", "said"), [(2, 1, "at least 2 and at most 3"), (1, 4, "at least 1 and at most 3")]
)
def test_a_patch_needs_its_own_sectors_and_one_beyond_them(half, reach, said):
    with pytest.raises(InputError, match=said):
        patched_ring(sector(), sector(), half, 9, reach)
    with pytest.raises(InputError, match="other nodes"):
        patched_ring(sector(), np.eye(8), half, 9, 3)
