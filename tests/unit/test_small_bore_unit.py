"""Gears on small bores turn as a whole by far more than their teeth give way; how they share loads does not show it."""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.case.reading import build_scene
from fegear.contact.plane.maker import finite_element_compliance
from fegear.contact.plane.shifted_compliance import neighbours_shifted_by_error, shifted_by_error
from fegear.engine.plan import make_plan
from fegear.fem.plane.bore import check_bore
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES

TOOTH = Tooth(28)


def solved(bore):
    """A gear with such a bore [root radius]."""
    return solve_gear(Gear(TOOTH, 3e-3, bore * TOOTH.root_radius * 3e-3, 0.01), settings_at(-5.0))


def own_less_neighbours(source, radius):
    """What a tooth gives way more than the next one under the same load, with E = 1."""
    return (source.own(0, radius) - source.between(1, 0, radius, radius)) * Material().young_modulus


@pytest.fixture(scope="module")
def on_a_small_bore():
    return finite_element_compliance(solved(0.002))


@pytest.mark.dear
def test_the_difference_between_teeth_does_not_know_how_far_the_gear_turns(on_a_small_bore):
    """At the start of the flank a tooth gave way by 200 tooth deflections less than the next one."""
    usual = finite_element_compliance(solved(0.05))
    low, high = usual.influence.gear.involute_radii
    radius = np.linspace(low, high, 15)
    wanted = own_less_neighbours(usual, radius)
    assert own_less_neighbours(on_a_small_bore, radius)[1:] == pytest.approx(wanted[1:], rel=0.03)
    assert own_less_neighbours(on_a_small_bore, radius)[0] == pytest.approx(wanted[0], rel=0.2)


@pytest.mark.dear
def test_the_gear_turns_as_the_closed_form_of_a_disc_says(on_a_small_bore):
    gear = on_a_small_bore.influence.gear
    inverse_squares = 1.0 / gear.bore_radius**2 - 1.0 / (TOOTH.root_radius * gear.module) ** 2
    turned = gear.base_radius**2 * (1.0 + gear.material.poisson_ratio) / (2.0 * math.pi) * inverse_squares
    value, error = on_a_small_bore.influence.neighbour_with_error(1, gear.base_radius * 1.04, gear.base_radius * 1.04)
    modulus = gear.material.young_modulus
    assert abs(value[0, 0] * modulus - turned) < 1.5 * error[0, 0] * modulus + 1e-3 * turned


@pytest.mark.dear
@pytest.mark.parametrize("shifted", [shifted_by_error, neighbours_shifted_by_error])
def test_what_all_teeth_err_by_alike_is_no_error_of_how_they_share_a_load(on_a_small_bore, shifted):
    """The largest load was stated as 500 +- 200 N, and at smaller bores the compliances were not positive definite."""
    low, high = on_a_small_bore.influence.gear.involute_radii
    radius = np.linspace(low, high, 15)
    off = own_less_neighbours(shifted(on_a_small_bore), radius) - own_less_neighbours(on_a_small_bore, radius)
    assert np.abs(off).max() < 0.05
    assert (shifted(on_a_small_bore).own(0, radius) > on_a_small_bore.own(0, radius)).all()  # the mean knows it


@pytest.mark.dear
def test_few_teeth_on_a_small_bore_are_meshed_by_shorter_edges_in_the_body():
    """Nine teeth were refused: increase rim thickness, which was nearly the whole radius."""
    tooth = Tooth(9, BasicRack(0.612, 0.891, 0.5, math.radians(14.5)))
    small, usual = (
        solve_gear(Gear(tooth, 3e-3, bore * 3e-3, 0.02), settings_at(-6.0), estimate_error=False)
        for bore in (0.0274, 1.45)
    )
    radius = np.array([4.6, 5.0]) * 3e-3
    stress, wanted = (one.largest_root_stress(0, "tension", radius)[0] for one in (small, usual))
    assert stress == pytest.approx(wanted, rel=0.03)


def test_a_plan_refuses_a_bore_that_a_run_cannot_solve():
    case = {
        "results": ["stiffness"], "stiffness": {"gear": "a", "positions": 3},
        "gear": {"a": {"teeth": 28, "module": "3.175 mm", "bore_radius": "0.0047625 mm", "face_width": "10 mm"}},
    }  # fmt: skip
    with pytest.raises(RangeError, match=r"too close to the centre .*choose between 0\.0202") as refused:
        make_plan(build_scene(case, "case", Path()), STAGES)
    assert str(refused.value).startswith("gear.a.bore_radius = 0.0047625 mm")


@pytest.mark.parametrize("module", [0.37e-3, 3.175e-3, 41e-3])
def test_what_is_said_of_a_bore_or_rim_that_is_refused_is_taken_and_is_nearly_all_that_is(module):
    """The remedy's two radii, in mm with six digits, and what lies a thousandth beyond them."""
    gears = Tooth(28), InternalTooth(60, PinionCutter(24, tip_radius=0.2), tip_radius=29.0)
    for tooth in gears:
        said = []
        for radius in (1e-4 * tooth.root_radius, tooth.root_radius, 1e3 * tooth.root_radius):
            try:
                check_bore(tooth, radius, module)
            except RangeError as error:
                said.append([float(word) * 1e-3 / module for word in re.findall(r"[\d.]+", error.remedy)[:2]])
        assert len(said) >= 2
        for low, high in said:
            for inside, outside in ((low, low / 1.002), (high, high * 1.0001)):
                check_bore(tooth, inside, module)
                with pytest.raises(RangeError):
                    check_bore(tooth, outside, module)


def test_a_bore_for_more_teeth_is_refused_with_the_default_that_follows_them():
    """19 teeth have a root radius of twice the bore, 11 teeth one of the bore."""
    tooth = Tooth(11, BasicRack.named("C"))
    with pytest.raises(RangeError, match=r"remove bore_radius \(default: half the root radius\)"):
        check_bore(tooth, tooth.root_radius, 4.5e-3)
    check_bore(tooth, 0.5 * tooth.root_radius, 4.5e-3)
