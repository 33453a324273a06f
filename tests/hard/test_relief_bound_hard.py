"""Designs that ask for more relief than a tooth can take are refused, and the remedy that they name does."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fegear.base.errors import InputError, RangeError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.loading import LoadingFunction, Ramp
from fegear.design.minimum_excitation import minimum_excitation
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.plausible_flanks import deepest_relief
from fegear.geometry.rack import BasicRack


def engaged(z1=28, z2=28, module=3.175e-3, rack=None, shift=0.0, face=6.35e-3):
    rack = BasicRack(1.0, 1.25, 0.25) if rack is None else rack
    gears = [
        Gear(Tooth(z, rack, profile_shift=x), module, 0.1 * z * module, face) for z, x in ((z1, shift), (z2, -shift))
    ]
    return Engagement(PairCompliance(GearPair(*gears), *(closed_form_compliance(g, "cornell") for g in gears)))


def loading(engagement, ratio, ramp=None, **options):
    pair = engagement.pair
    ramp = Ramp() if ramp is None else ramp
    centre = options.pop("centre", 0.5 * (pair.x_start + pair.x_end))
    return LoadingFunction(ratio * pair.base_pitch, pair.base_pitch, centre, ramp, **options)


STANDARD = engaged()
LONG = engaged(50, 50, 3e-3, BasicRack(1.3, 1.55, 0.2), face=10e-3)


def normal_room(gear, radius):
    """Half the tooth's thickness over cos(alpha_r), from the involute function itself."""
    alpha = np.arccos(gear.base_radius / radius)
    at_pitch = (
        0.5 * math.pi / gear.teeth + 2.0 * gear.tooth.generating_shift * math.tan(math.radians(20.0)) / gear.teeth
    )
    half_angle = at_pitch + math.tan(math.radians(20.0)) - math.radians(20.0) - (np.tan(alpha) - alpha)
    return radius * half_angle * np.cos(alpha)


def test_the_room_of_a_tooth_is_half_its_thickness_along_the_normal():
    gear = engaged(12, 40, shift=0.6).pair.driver
    radius = np.linspace(gear.form_radius, gear.involute_tip_radius, 40)
    roll = np.sqrt((radius / gear.base_radius) ** 2 - 1.0)
    room = np.minimum(0.1 * gear.module, normal_room(gear, radius))
    np.testing.assert_allclose(deepest_relief(gear, roll), room, rtol=1e-10)
    assert room[-1] < 0.1 * gear.module  # the pointed tip has less to give than a tenth of the module


@pytest.mark.parametrize("ratio", [1.0, 1.0 + 1e-13, 1.0001, 1.001, 1.005])
@pytest.mark.parametrize("ramp", [Ramp(1.0), Ramp(2.0), Ramp(7.0, 7), Ramp(0.5, 3)])
def test_contact_ratios_just_above_one_are_refused(ratio, ramp):
    """2.84 m of relief at 1.0 and 3.1 mm at 1.001 were printed as if they could be ground."""
    with pytest.raises(
        RangeError, match=r"design\.contact_ratio = 1.*times the maximum of.*choose at least 1\."
    ) as told:
        minimum_excitation(STANDARD, loading(STANDARD, ratio, ramp), 1615.0)
    least = float(re.search(r"at least ([\d.]+)", str(told.value))[1])
    minimum_excitation(STANDARD, loading(STANDARD, least, ramp), 1615.0)
    with pytest.raises(RangeError):
        minimum_excitation(STANDARD, loading(STANDARD, least - 0.002, ramp), 1615.0)


def test_contact_ratios_just_above_two_are_refused():
    """There the pair's load starts with a jump of 1 - F; with F = 1 there is none, and the design stands."""
    with pytest.raises(RangeError, match=r"choose at least 2\."):
        minimum_excitation(LONG, loading(LONG, 2.0), 3000.0)
    minimum_excitation(LONG, loading(LONG, 2.0, peak=1.0), 3000.0)
    minimum_excitation(LONG, loading(LONG, 2.1), 3000.0)


def test_loads_beyond_steel_are_refused_with_the_load_that_would_do():
    with pytest.raises(RangeError, match=r"design\.load = 1e\+06 N.*reduce the load.*limit") as told:
        minimum_excitation(STANDARD, loading(STANDARD, 1.6), 1e6)
    allowed = float(re.search(r"limit is ([\d.e+]+) N ", str(told.value))[1])
    longest = loading(STANDARD, STANDARD.pair.contact_ratio)
    minimum_excitation(STANDARD, longest, 0.99 * allowed)


def test_a_zone_pushed_to_one_end_of_the_path_names_the_middle():
    p = STANDARD.pair
    with pytest.raises(RangeError, match=r"design\.centre.*choose the middle of the path"):
        minimum_excitation(STANDARD, loading(STANDARD, 1.003, centre=p.x_end - 0.503 * p.base_pitch), 1615.0)


@pytest.mark.parametrize("load", [0.0, -5.0, math.nan, math.inf])
def test_loads_that_are_none_are_refused(load):
    with pytest.raises(InputError, match=r"design\.load"):
        minimum_excitation(STANDARD, loading(STANDARD, 1.3), load)


@settings(max_examples=40, deadline=None)
@given(
    z1=st.integers(12, 60), z2=st.integers(17, 100), module=st.floats(1e-3, 8e-3), shift=st.floats(0.0, 0.4),
    where=st.floats(0.0, 1.0) | st.floats(0.0, 1e-3), slope=st.floats(0.0, 1.0),
    exponent=st.sampled_from([None, 3, 7, 25]), line_load=st.floats(1e4, 1e7),
)  # fmt: skip
def test_no_design_takes_more_than_the_tooth_has(z1, z2, module, shift, where, slope, exponent, line_load):
    """Whatever is designed, the flank stays on its side of the tooth, by less than a tenth of the module."""
    if z1 < 17:
        shift = max(shift, (17 - z1) / 17)
    e = engaged(z1, z2, module, shift=shift, face=10 * module)
    ratio = 1.0 + where * (e.pair.contact_ratio - 1.0) * 0.999
    ramp = Ramp(slope * (2.0 if exponent is None else exponent), exponent)
    try:
        designed = minimum_excitation(e, loading(e, ratio, ramp), line_load * e.compliance.face_width)
    except RangeError:
        return
    x = np.linspace(e.pair.x_start, e.pair.x_end, 997)
    for member, relief in (("driver", designed.driver_relief), ("driven", designed.driven_relief)):
        gear = e.pair.gear(member)
        room = np.minimum(0.1 * gear.module, normal_room(gear, e.pair.radius(x, member)))
        assert (relief.at(x) <= 1.02 * room).all()


def test_ordinary_designs_stay_as_they_were():
    designed = minimum_excitation(STANDARD, loading(STANDARD, 1.312), 1615.0)
    assert designed.driver_relief.at(STANDARD.pair.x_end) < 0.01 * STANDARD.pair.driver.module
    assert replace(designed.driver_relief, load=1600.0).offset < designed.driver_relief.offset
