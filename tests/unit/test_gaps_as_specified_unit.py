"""From a spec to what keeps flanks with a width apart: each effect puts in its own fields, of its own gear, only."""

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import pytest

from fegear.contact.odd_flank import OddFlank, Pit, ToothProfile
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.wide.flanks import as_specified, missing_parts, open_gaps
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide_spec import Misalignment, WideSpec
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.flank_modification import HelixSlope
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec
from fegear.geometry.shaft_tilt import ShaftTilt

M, WIDTH = 3e-3, 20e-3


def gear(teeth, hand, width):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(12.0))
    return Gear(tooth, M, 0.3 * teeth * M, width, hand=hand)


PAIR = GearPair(gear(17, "right", WIDTH), gear(23, "left", 1.4 * WIDTH), axial_offset=3e-3)


def spec(driver=None, driven=None, wide=None, **effects):
    given = {"relief": False, "misalignment": False, "spacing_errors": False, **effects}
    flanks = {"driver": driver or FlankSpec(), "driven": driven or FlankSpec(), "wide": wide or WideSpec()}
    return PairSpec(PAIR, (1000.0,), width="solid", **flanks, **given)


def filled(gaps):
    """Fields of gaps that are not empty, by name."""
    bare = FlankGaps()
    different = {}
    for one in fields(gaps):
        value, usual = getattr(gaps, one.name), getattr(bare, one.name)
        alike = np.array_equal(value, usual) if isinstance(value, np.ndarray) else value == usual
        if not alike:
            different[one.name] = value
    return different


LEADS = tuple(HelixSlope(amount, WIDTH) for amount in (3e-6, 5e-6, 7e-6, 9e-6))
RELIEF = ReliefSpec(tip=(TipReliefSpec(amount=6e-6, length=0.8e-3),))
WHOLE = WideSpec(
    Misalignment(np.array([-1.0, 1.0]), np.array([0.0, 4e-6]), ShaftTilt(1e-5, 2e-5), (LEADS[2],)), (LEADS[3],),
    base_pitch=5,
)  # fmt: skip
BOTH = (
    FlankSpec(RELIEF, np.full(17, 2e-6), (LEADS[0],)), FlankSpec(RELIEF, np.full(23, 3e-6), (LEADS[1],)),
)  # fmt: skip


def test_nothing_is_apart_where_no_effect_counts():
    assert filled(open_gaps(spec(*BOTH, WHOLE))) == {}


def test_relief_is_that_of_each_gear_with_what_the_pinion_s_cutter_leaves():
    found = filled(open_gaps(spec(*BOTH, WHOLE, relief=True)))
    assert found.pop("driver_flank") == (LEADS[0], LEADS[3])
    assert found.pop("driven_flank") == (LEADS[1],)
    assert found.keys() == {"driver_relief", "driven_relief"}
    for member, one in zip(MEMBERS, found.values(), strict=True):
        middle, tip = 0.5 * (PAIR.x_start + PAIR.x_end), PAIR.x_end if member == "driver" else PAIR.x_start
        roll = np.array([float(PAIR.roll_angle(x, member)) for x in (middle, tip)])
        assert one.removal(roll) == pytest.approx([0.0, 6e-6], abs=1e-12)
    other = filled(open_gaps(spec(FlankSpec(), BOTH[1], relief=True)))
    assert other.keys() >= {"driven_relief", "driven_flank"}
    assert "driver_flank" not in other


def test_misalignment_is_that_of_the_pair_with_what_grinding_leaves_on_the_driver():
    found = filled(open_gaps(spec(*BOTH, WHOLE, misalignment=True)))
    assert found.pop("face_position").tolist() == [-1.0, 1.0]
    assert found.pop("line_gap").tolist() == [0.0, 4e-6]
    assert found == {"tilt": ShaftTilt(1e-5, 2e-5), "driver_flank": (LEADS[2],)}
    assert filled(open_gaps(spec(*BOTH, WHOLE, misalignment=True, relief=True)))["driver_flank"] == (
        LEADS[0], LEADS[3], LEADS[2],
    )  # fmt: skip


def test_spacing_is_that_of_each_gear_from_the_base_pitch_asked_for():
    found = filled(open_gaps(spec(*BOTH, WHOLE, spacing_errors=True)))
    assert found.pop("driver_spacing").tolist() == [2e-6] * 17
    assert found.pop("driven_spacing").tolist() == [3e-6] * 23
    assert found == {"base_pitch": 5}


@pytest.mark.parametrize("odd", MEMBERS)
def test_an_odd_tooth_of_one_gear_is_one_of_that_gear_only(odd):
    flank = OddFlank(missing=True)
    one = {odd: FlankSpec(odd=((3, flank),), profiles=((4, ToothProfile(RELIEF)),))}
    assert filled(open_gaps(spec(**one))) == {f"{odd}_odd": ((3, flank),)}
    # profiles of its own count with the reliefs
    found = filled(open_gaps(spec(**one, relief=True)))[f"{odd}_odd"]
    assert [tooth for tooth, _ in found] == [3, 4]
    assert found[1][1].relief is not None
    both = filled(open_gaps(spec(*(FlankSpec(odd=((k, flank),)) for k in (3, 8)))))
    assert both == {"driver_odd": ((3, flank),), "driven_odd": ((8, flank),)}


@pytest.mark.parametrize("member", MEMBERS)
def test_a_pit_lies_where_its_gear_touches_at_its_radii_and_heights(member):
    one = PAIR.gear(member)
    low, high = one.involute_radii
    inside = 0.7 * low + 0.3 * high, 0.4 * low + 0.6 * high
    pits = (Pit(*inside, 0.5, 1e-3, 2e-3), Pit(0.5 * low, 2.0 * high))
    part, whole = missing_parts(OddFlank(pits=pits), PAIR, member)
    # the driven gear's face is 3 mm farther on, the common face is the pinion's, 3 mm off the wheel's middle
    middle = 2e-3 if member == "driver" else 2e-3 + 3e-3
    assert part.z == pytest.approx((middle - 0.25 * one.face_width, middle + 0.25 * one.face_width))
    for x, r in zip(part.x, inside if member == "driver" else inside[::-1], strict=True):
        roll = math.sqrt(r**2 - one.base_radius**2) / one.base_radius
        assert PAIR.roll_angle(x, member) == pytest.approx(roll)
    assert part.x[0] < part.x[1]
    ends = low, high
    assert whole.x == pytest.approx(sorted(float(PAIR.x_of_radius(r, member)) for r in ends))


def test_flanks_are_those_of_the_spec_with_what_is_missing_of_every_odd_tooth():
    @dataclass(frozen=True)
    class Flanks:
        panel: float
        pair: Any = None
        coupling: bool = False
        hertz: str = ""
        missing: tuple = ()

    low, high = (min(PAIR.gear(one).involute_radii[k] for one in MEMBERS) for k in (0, 1))
    pits = tuple(OddFlank(pits=(Pit(low, high, share),)) for share in (0.2, 0.3, 0.4))
    odd = {"driver": FlankSpec(odd=((3, pits[0]), (9, pits[1]))), "driven": FlankSpec(odd=((1, pits[2]),))}
    asked = spec(**odd, neighbour_coupling=True, hertz="linear")
    found = as_specified(asked, Flanks(0.25))
    assert (found.panel, found.pair, found.coupling, found.hertz) == (0.25, PAIR, True, "linear")
    each = [(pits[0], "driver"), (pits[1], "driver"), (pits[2], "driven")]
    assert found.missing == tuple(part for flank, member in each for part in missing_parts(flank, PAIR, member))
    assert as_specified(spec(neighbour_coupling=False), Flanks(0.25)).missing == ()
