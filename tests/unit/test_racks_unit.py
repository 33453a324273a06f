"""Racks of case files: the numbers of the mechanics, keys that contradict each other, racks in place of gears."""

import copy
import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.rack import loaded_rack_inputs, rack_inputs
from fegear.case.reading import build_scene as scene_of
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso6336.part3_root_stress import rack_tooth as as_rack_tooth
from fegear.formulas.iso6336.part3_root_stress import root_form
from fegear.formulas.iso6336.rack_limit import rack_root_form
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_outline import rack_outline
from fegear.geometry.rack_tooth import RackTooth
from fegear.results.catalogue import STAGES

CASE = {
    "results": ["rack-geometry"],
    "gear": {"p": {"teeth": 20, "module": "2 mm", "profile_shift": 0.3, "face_width": "20 mm"}},
    "rack": {"r": {"pinion": "p", "teeth": 6, "reference_height": "10 mm", "force": "2 kN", "positions": 8}},
}


def build_scene(given):
    """The scene of a case given as plain tables."""
    return scene_of(given, "racks", Path())


def case(results=("rack-geometry",), **more):
    """The case with keys of the rack changed; None removes one."""
    found = copy.deepcopy(CASE)
    found["results"] = list(results)
    found["rack"]["r"] |= more
    found["rack"]["r"] = {key: value for key, value in found["rack"]["r"].items() if value is not None}
    return found


def test_a_case_says_what_the_mechanics_takes():
    pair = rack_inputs(build_scene(case(backlash="40 um", thickness_allowance="10 um", support="pins")), "r").pair
    assert pair.backlash == pytest.approx(40e-6)
    assert pair.rack.pins.holds(4)
    assert pair.rack.pins.width == pytest.approx(4e-3)
    assert pair.rack.tooth.rack == pair.pinion.tooth.rack
    by_distance = rack_inputs(build_scene(case(distance=f"{pair.distance!r} m", thickness_allowance="10 um")), "r").pair
    assert by_distance.backlash == pytest.approx(40e-6)


def test_torque_on_the_pinion_is_force_times_reference_radius():
    found = loaded_rack_inputs(build_scene(case(force=None, torque="40 N*m")), "r")
    assert found.force == pytest.approx(2000.0)


def test_nominal_root_stress_factors_are_the_limit_of_gears():
    """Y_F and Y_S of part 3 for 1e7 teeth."""
    basic, height = BasicRack(), 0.4
    many = as_rack_tooth(Tooth(1000, basic))
    z = 1e7
    limit = root_form(type(many)(z, 0.0, basic.dedendum, basic.tip_radius, basic.pressure_angle), z + 2.0 * height)
    found = rack_root_form(RackTooth(basic), height)
    assert found.s_Fn == pytest.approx(limit.root_chord, rel=1e-5)
    assert found.h_Fe == pytest.approx(limit.moment_arm, rel=1e-5)
    assert found.rho_F == pytest.approx(limit.fillet_radius, rel=1e-5)
    assert pytest.approx(limit.Y_S, rel=1e-5) == found.Y_S


def test_outline_encloses_teeth_and_body():
    """Its area: that of the body, and of the teeth by their thickness (without rounding corrections, 1 %)."""
    rack = rack_inputs(build_scene(case()), "r").pair.rack
    x, y = rack_outline(rack)
    area = 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    teeth = 0.5 * rack.pitch * (rack.tooth.tip_height - rack.tooth.root_height) * rack.module
    off = math.tan(rack.pressure_angle) * (rack.tooth.root_height**2 - rack.tooth.tip_height**2) * rack.module**2
    assert area == pytest.approx(rack.length * rack.body + rack.teeth * (teeth + off), rel=0.01)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"pinion": "q"}, 'rack.r.pinion = "q": is not a gear'),
        ({"teeth": 0}, "rack.r.teeth"), ({"reference_height": "2 mm"}, "rack.r.reference_height"),
        ({"backlash": "-10 um"}, "rack.r.backlash = -10 um: must not be negative"),
        ({"backlash": "1 um", "distance": "20 mm"}, "contradicts distance"),
        ({"torque": "1 N*m"}, "contradicts force"), ({"pin_every": 3}, "is used with pins only"),
        ({"support": "pins", "first_pin": 9}, "rack.r.first_pin = 9"),
        ({"support": "pins", "pin_width": "9 mm"}, "rack.r.pin_width"), ({"distance": "30 mm"}, "rack.r.distance"),
        ({"basic_rack": {"addendum": 1.4}}, "rack.r.distance"), ({"tip_chamfer": "3 mm"}, "rack.r.tip_chamfer"),
        ({"basic_rack": {"coast_tip_radius": 0.2}}, "rack.r.basic_rack.coast_tip_radius = 0.2"),
        ({"material": {"poisson_ratio": 0.7}}, "rack.r.material.poisson_ratio"), ({"face": 1}, "rack.r.face"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_under_its_key(more, words):
    with pytest.raises(InputError) as refused:
        rack_inputs(build_scene(case(**more)), "r")
    assert words in str(refused.value)


@pytest.mark.parametrize(
    ("gear", "words"),
    [
        ({"helix_angle": "10 deg", "hand": "left", "module": None, "normal_module": "2 mm"}, "spur"),
        ({"coast_pressure_angle": "25 deg"}, "equal flanks"),
    ],
)
def test_pinions_that_no_rack_takes_are_refused(gear, words):
    given = case()
    given["gear"]["p"] = {key: value for key, value in (given["gear"]["p"] | gear).items() if value is not None}
    with pytest.raises(InputError, match=words):
        rack_inputs(build_scene(given), "r")


def test_a_rack_is_no_gear_of_a_pair_and_loads_need_a_force():
    given = case(["load-sharing"])
    given["pair"] = {"I": {"driver": "p", "driven": "r", "torque": "10 N*m"}}
    with pytest.raises(InputError, match=r'pair\.I\.driven = "r": is not a'):
        build_scene(given)
    with pytest.raises(InputError, match=r"rack\.r\.force"):
        make_plan(build_scene(case(["rack-transmission-error"], force=None)), STAGES)


@pytest.fixture(scope="module")
def results():
    """All results of a short rack on coarse elements."""
    given = case(["rack-geometry", "rack-stiffness", "rack-transmission-error"]) | {"accuracy": {"tolerance": 0.05}}
    scene = build_scene(given)
    return run_plan(scene, make_plan(scene, STAGES))


def test_results_state_errors_and_ends(results):
    values = {value.name: value for value in results.values}
    assert values["r.te_mean"].value == pytest.approx(5.0, rel=0.1)
    assert 0.0 < values["r.te_mean"].error < 0.03 * values["r.te_mean"].value
    assert values["r.rack_root_stress"].value > 1.2 * values["r.middle_root_stress"].value  # the first tooth
    tables = {table.name: table for table in results.tables}
    assert {"rack_geometry_r", "rack_transmission_error_r", "rack_root_stress_r", "rack_stiffness_r_1"} <= set(tables)
    te = tables["rack_transmission_error_r"]
    column = {one.name: one.si for one in te.columns}
    assert np.all(np.diff(column["travel"]) > 0.0)
    assert column["pairs_in_contact"][0] == column["pairs_in_contact"][-1] == 1
    assert column["te"][0] > 1.5e-6 * values["r.te_mean"].value
    ends = {one.name: one.si for one in tables["rack_stiffness_r_1"].columns}
    assert np.isnan(ends["c_prev"]).all()
    assert (ends["c_next"] != 0.0).all()
