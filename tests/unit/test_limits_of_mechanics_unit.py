"""Numbers at the very limits of what the mechanics takes pass, those just beyond are refused by their keys."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.atlas.domain import Domain
from fegear.base.errors import InputError, RangeError
from fegear.contact.many.arrays import ManyReliefs
from fegear.contact.plane.tooth_table import root_table
from fegear.contact.unloaded.predesign import absorb_linear_error
from fegear.fem.plane.odd.keyway import Keyway, refuse_keyway
from fegear.fem.solid.settings import SolidSettings, check_solid, check_width, solid_settings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

TOOTH, HALF = Tooth(20, BasicRack(1.0, 1.25, 0.25)), math.pi / 20
SPUR = SimpleNamespace(twist=0.0)


def predesigned(face_share=0.9, cut=SPUR, parabola=1.0):
    """Of a pair that is refused for what comes after the limit in question."""
    return absorb_linear_error(SimpleNamespace(cut_pinion=cut, parabola=parabola), 0.0, face_share)


def checked(tau=0.0, width=10.0, ratio=0.3, held=None, reach=1):
    return check_solid(TOOTH, tau, width, ratio, SolidSettings(), held, reach)


STEEPEST = math.tan(math.radians(45.0)) / TOOTH.tip_radius
LIMITS = [
    # key, taken, refused
    ("face_share", lambda v: predesigned(v), (1.0, 1e-9), (1.0 + 1e-9, 0.0, -0.1, math.nan)),
    ("accuracy.room_share", lambda v: SolidSettings(room_share=v), (0.95, 0.01), (0.9501, 0.0)),
    ("accuracy.fewest_waves", lambda v: SolidSettings(fewest_waves=v), (2.0,), (1.999,)),
    ("accuracy.fewer_on_pieces", lambda v: SolidSettings(fewer_on_pieces=v), (0, 1), (-1,)),
    ("accuracy.least_degree", lambda v: SolidSettings(least_degree=v), (3,), (2,)),
    ("accuracy.least_piece_degree", lambda v: SolidSettings(least_piece_degree=v), (3,), (2,)),
    ("accuracy.wave_reach", lambda v: SolidSettings(wave_reach=v), (1e-3,), (0.0, math.inf, math.nan)),
    ("accuracy.tolerance", solid_settings, (1e-3, 0.1), (0.999e-3, 0.1001)),
    ("poisson_ratio", lambda v: checked(ratio=v), (-0.999, 0.499), (-1.0, 0.5, math.nan)),
    ("reach", lambda v: checked(reach=v), (0,), (-1,)),
    ("held", lambda v: checked(held=v), ((-5.0, 5.0), (0.0, 5.0)), ((-5.001, 0.0), (0.0, 5.001), (2.0, 2.0))),
    ("width", lambda v: refuse_keyway(TOOTH, 4.0, Keyway(v, 0.3)), (1.0,), (1e-6, 8.0)),
    ("angle", lambda v: refuse_keyway(TOOTH, 4.0, Keyway(1.0, 0.3, v)), (HALF, -HALF), (1.001 * HALF, -1.001 * HALF)),
    ("bore", lambda v: Domain((20, 30), (0.0, 0.1), bore=v), ((1e-6, 0.999),), ((0.0, 0.5), (0.5, 1.0), (0.6, 0.5))),
    ("shift", lambda v: Domain((20, 30), v, side="undercut"), ((-0.2, -1e-9),), ((-0.2, 0.0),)),
    ("relief.start", lambda v: ManyReliefs(np.ones(1), np.array([v]), np.ones(1)), (0.0, 0.999), (-1e-9, 1.0)),
    ("relief.power", lambda v: ManyReliefs(np.ones(1), np.zeros(1), np.array([v])), (1.0, 2.0), (0.999,)),
]  # fmt: skip


def refusal(given, value):
    """What a value is refused by; nothing if it is taken."""
    try:
        given(value)
    except (InputError, RangeError) as error:
        return error
    return None


@pytest.mark.parametrize(("key", "given", "taken", "refused"), LIMITS, ids=[one[0] for one in LIMITS])
def test_limits_belong_to_what_is_taken(key, given, taken, refused):
    """What is taken may be refused by what comes after."""
    assert [value for value in taken if getattr(refusal(given, value), "key", "") == key] == []
    assert [getattr(refusal(given, value), "key", "") for value in refused] == [key] * len(refused)


def test_what_a_predesign_needs_is_said_one_after_the_other():
    helical = SimpleNamespace(twist=-3.0)
    for key, how in {"helix_angle": {}, "parabola": {"cut": helical, "parabola": 0.0}}.items():
        with pytest.raises(RangeError) as error:
            predesigned(**how)
        assert error.value.key == key


def test_faces_from_the_narrowest_to_the_widest_are_taken():
    with pytest.raises(RangeError, match="must be between") as error:
        check_width(1e-9, SolidSettings())
    low, high = (float(one) for one in error.value.rule.removesuffix(" modules").split("between ")[1].split(" and "))
    few = replace(SolidSettings(), least_degree=3)
    for width in (low, high):
        assert "must be between" not in str(refusal(lambda one: check_width(one, few), width))
    for width in (0.9999 * low, 1.0001 * high):
        with pytest.raises(RangeError, match="must be between"):
            check_width(width, few)


@pytest.mark.parametrize(("coupled", "teeth"), [(True, [-1, 0, 1]), (False, [0])])
def test_a_table_of_root_tension_has_the_teeth_that_feel_a_load(coupled, teeth):
    """And at its radii what the source has there; of a tooth that the source knows nothing of there is nothing."""
    gear = Gear(TOOTH, 2e-3, 8e-3)

    def stress(i, j, radii, side):
        assert (j, side) == (0, "tension")
        assert abs(i) <= 1
        return np.outer([1.0, 2.0, 3.0], (i + 4.0) * radii)

    source = SimpleNamespace(reach=1, root_stress=stress, fillet_curve=lambda i, side: (i, side))
    low, high = gear.involute_radii
    table = root_table(source, gear, low, high, coupled=coupled)
    assert sorted(table.tension) == teeth
    assert table.reach == max(teeth)
    assert table.curve == (0, "tension")
    lengths = table.lowest + table.step * np.arange(len(table.tension[0]))
    radii = np.hypot(gear.base_radius, lengths)
    assert (radii[0], radii[-1]) == pytest.approx((low, high))
    for k in teeth:
        np.testing.assert_allclose(table.tension[k], np.outer((k + 4.0) * radii, [1.0, 2.0, 3.0]), rtol=1e-9)


def test_a_table_of_root_tension_is_cubic_in_the_roll_length_between_its_radii():
    gear = Gear(TOOTH, 2e-3, 8e-3)
    rb, (low, high) = gear.base_radius, gear.involute_radii

    def cubic(radius):
        length = np.sqrt(np.maximum((radius - rb) * (radius + rb), 0.0)) / gear.module
        return np.stack([1.0 + length, length**2 - 2.0, 0.5 * length**3], axis=-1)

    source = SimpleNamespace(
        reach=0, root_stress=lambda i, j, radii, side: cubic(radii).T, fillet_curve=lambda i, side: None
    )
    table = root_table(source, gear, low, high, coupled=True)
    inside = np.linspace(low, high, 57)
    np.testing.assert_allclose(table.root_stress(5, 5, inside, "tension").T, cubic(inside), rtol=1e-9, atol=1e-9)
    beyond = np.array([0.99 * low, 1.01 * high])
    np.testing.assert_allclose(table.at(0, beyond), cubic(np.array([low, high])), rtol=1e-9, atol=1e-9)
    assert table.root_stress(5, 6, inside, "tension").tolist() == [[0.0] * 57] * 3
    assert table.root_stress(5, 5, inside, "compression") is None
    assert table.fillet_curve(0, "compression") is None
