"""What helical gears and pairs refuse, and in which words."""

import math

import pytest
from helical_gears import helical_gear

from fegear.base.errors import GeometryError, InputError, RangeError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.unloaded.pair import HelicalPair, Misalignment
from fegear.contact.unloaded.pair_contact import pair_contact
from fegear.contact.unloaded.tooth_contact import tooth_contact
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness, theoretical_stiffness
from fegear.formulas.iso6336.part3_pair import RatingChoice, rate_spur
from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.formulas.root_stress_formulas import root_stress_table
from fegear.geometry.pair import GearPair

DEG = math.pi / 180.0


def gear(teeth=30, hand="left", beta=30.0, **more):
    return helical_gear(teeth, 5e-3, 20.0 * DEG, beta * DEG, 0.04, hand, **more)


@pytest.mark.parametrize(
    ("build", "error", "words"),
    [
        (lambda: gear(teeth=2), InputError, "between 4 and 1000"),
        (lambda: gear(teeth=30.5), InputError, "whole number"),
        (lambda: gear(hand="spur"), InputError, "contradicts the helix angle"),
        (lambda: gear(beta=0.0), InputError, "contradicts the helix angle"),
        (lambda: gear(beta=-30.0), InputError, "the hand defines the sign"),
        (lambda: gear(hand="both"), InputError, "must be"),
        (lambda: gear(tip_radius=0.05), GeometryError, "must exceed the base radius"),
        (lambda: gear(tip_radius=0.2), GeometryError, "exceeds the intersection of the flanks at"),
        (lambda: helical_gear(30, -1.0, 0.35, 0.5, 0.04, "left"), InputError, "module.*positive"),
        (lambda: helical_gear(30, 5e-3, 0.35, 0.5, math.inf, "left"), InputError, "finite"),
        (lambda: helical_gear(30, 5e-3, 1.0, 0.5, 0.04, "left"), InputError, "between 5 and 45"),
        (lambda: HelicalPair(gear(), gear(100, "left")), GeometryError, "opposite hands"),
        (lambda: HelicalPair(gear(), gear(100, "right", 20.0)), GeometryError, "equal by design"),
        (
            lambda: HelicalPair(gear(), gear(100, "right"), axial_offset=0.04),
            GeometryError,
            "leaves no common face width",
        ),
        (lambda: HelicalPair(gear(), gear(100, "right"), Misalignment(centre_distance=0.02)), GeometryError, "no path"),
        (
            lambda: HelicalPair(gear(), gear(100, "right"), Misalignment(centre_distance=-0.1)),
            GeometryError,
            "base radii",
        ),
        (lambda: HelicalPair(gear(), gear(100, "right"), parabola=1e3), GeometryError, "no regular flank"),
        (lambda: HelicalPair(gear(), gear(100, "right"), crown=100.0), GeometryError, "tenth of the pitch"),
        (lambda: Misalignment(shaft_angle=math.radians(3.01)), RangeError, "is not small"),
        (lambda: Misalignment(lead_angle=-math.radians(3.01)), RangeError, "is not small"),
        (lambda: Misalignment(profile_angle=math.nan), RangeError, "is not small"),
        (lambda: Misalignment(shaft_angle=0.2), RangeError, "is not small"),
        (lambda: Misalignment(lead_angle=math.nan), RangeError, "is not small"),
        (lambda: Misalignment(centre_distance=math.nan), InputError, "finite"),
        (lambda: tooth_contact(HelicalPair(gear(), gear(100, "right")), 1), InputError, "at least 2"),
        (lambda: pair_contact(HelicalPair(gear(), gear(100, "right")), [math.nan]), InputError, "finite"),
    ],
)
def test_nonsense_is_refused_with_value_and_rule(build, error, words):
    with pytest.raises(error, match=words):
        build()


def test_errors_of_three_degrees_are_small():
    for sign in (-1.0, 1.0):
        found = Misalignment(*(sign * math.radians(3.0),) * 3)
        assert not found.aligned
    assert Misalignment(centre_distance=1e-3).aligned


def test_results_are_read_only():
    result = tooth_contact(HelicalPair(gear(), gear(100, "right")), 8)
    with pytest.raises(ValueError, match="read-only"):
        result.error[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        result.mesh.r1[0] = 1.0


def spur(teeth):
    return helical_gear(teeth, 5e-3, 20.0 * DEG, 0.0, 0.04, "spur")


def test_interference_below_the_form_circle_is_reported():
    assert HelicalPair(spur(30), spur(40)).interferes == (False, False)
    assert HelicalPair(spur(12), spur(80)).interferes == (True, False)
    assert HelicalPair(spur(80), spur(12)).interferes == (False, True)


def test_flanks_out_of_reach_are_named_none():
    pair = HelicalPair(gear(), gear(100, "right"))
    far = pair_contact(pair, [1.5])
    assert far.kind[0] == "none"
    assert far.error[0] == -math.inf


def test_what_knows_plane_teeth_alone_refuses_helical_ones():
    """Gears are of one kind now: a formula for spur teeth would have taken the section for the tooth."""
    pair = GearPair(gear(30), gear(40, "right"))
    tooth, radius = pair.driver.tooth, pair.driver.tooth.involute_tip_radius
    for answers in root_stress_table(tooth, [radius]).values():
        assert "must be zero (formula for spur gears;" in answers[0].reason
    with pytest.raises(RangeError, match="helix angle = 30 deg: must be zero"):
        rate_spur(pair, "driver", 1e5, RatingChoice())
    source = closed_form_compliance(GearPair(spur(30), spur(40)).driver, "weber-banaschek")
    with pytest.raises(InputError, match="is not possible in the plane \\(2D\\) model"):
        PairCompliance(pair, source, source)


def test_iso_stiffness_of_a_helical_pair_is_that_of_its_virtual_teeth():
    # ISO 6336-1, 9.3: c' falls with cos(beta), z_n takes the place of z
    pair = GearPair(gear(30), gear(40, "right"))
    straight = GearPair(spur(30), spur(40))
    found, known = pair_stiffness(pair), pair_stiffness(straight)
    z_n = [virtual_teeth(z, 30.0 * DEG, 20.0 * DEG) for z in (30, 40)]
    ratio = theoretical_stiffness(*z_n, 0.0, 0.0) / theoretical_stiffness(30, 40, 0.0, 0.0) * math.cos(30.0 * DEG)
    assert found.single / known.single == pytest.approx(ratio, rel=1e-12)
