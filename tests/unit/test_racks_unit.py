"""Racks of case files: the numbers of the mechanics, keys that contradict each other, racks in place of gears."""

import copy
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.base.errors import GeometryError, InputError
from fegear.case.built.rack import loaded_rack_inputs, rack_inputs
from fegear.case.reading import build_scene as scene_of
from fegear.contact.rack.over_stroke import _standing, positions
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso6336.part3_root_stress import rack_tooth as as_rack_tooth
from fegear.formulas.iso6336.part3_root_stress import root_form
from fegear.formulas.iso6336.rack_limit import rack_root_form
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.geometry.rack_and_pinion import RackAndPinion
from fegear.geometry.rack_outline import rack_outline
from fegear.geometry.rack_tooth import RackTooth
from fegear.output.export import export_gears
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
        ({"mounting_distance": "30.6 mm", "distance": "20.6 mm"}, "contradicts mounting_distance"),
        ({"mounting_distance": "30 mm"}, "rack.r.mounting_distance = 30 mm: places the tip"),
        ({"mounting_distance": "30.5 mm"}, "set mounting_distance to at least 30.6 mm"),
        ({"mounting_distance": "34 mm"}, "rack.r.mounting_distance = 34 mm: gives a contact ratio of"),
        ({"distance": "1 m"}, "rack.r.distance = 1000 mm: gives a contact ratio of"),
        ({"thickness_allowance": "30 mm"}, "rack.r.thickness_allowance = 30 mm: gives rack teeth"),
        ({"thickness_allowance": "30 mm"}, "use less than 3.14 mm"),
        ({"tip_chamfer": "3 mm"}, "rack.r.tip_chamfer = 3 mm: is too large"),
        ({"backlash": "5 mm"}, "rack.r.backlash = 5000 um: gives a contact ratio of"),
        ({"backlash": "5 mm"}, "reduce backlash"),
        ({"mounting_distance": "9 mm"}, "must exceed reference_height, 10 mm"),
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


RELIEVED = {"tip_relief": {"amount": "6 um", "height": "0.6 mm"}}


def relieved(amount, *, relief, **effects):
    """The results of the short rack with a relief of its pinion and of itself."""
    given = case(["rack-transmission-error"], tip_relief=RELIEVED["tip_relief"] | {"amount": amount})
    given |= {"accuracy": {"tolerance": 0.05}, "effects": {"relief": relief}}
    given["gear"]["p"]["relief"] = {"tip": {"amount": amount, "length": "1 mm"}}
    scene = build_scene(given)
    return run_plan(scene, make_plan(scene, STAGES))


@pytest.mark.dear
def test_relief_of_nothing_changes_nothing_and_relief_that_is_off_is_said(results):
    before = {value.name: value.value for value in results.values}
    none, off = relieved("0 um", relief=True), relieved("6 um", relief=False)
    for found in (none, off):
        assert all(value.value == before[value.name] for value in found.values)
    assert not any("relief" in one for one in none.remarks)
    assert any("gear.p.relief and rack.r.tip_relief neglected" in one for one in off.remarks)


def test_relief_delays_the_contact_of_corners(results):
    """The transmission error of the single pair stays; where tips enter and leave it changes."""
    before = {value.name: value.value for value in results.values}
    after = {value.name: value.value for value in relieved("6 um", relief=True).values}
    assert after["r.pinion_root_stress"] == pytest.approx(before["r.pinion_root_stress"], rel=1e-9)
    assert after["r.te_mean"] > before["r.te_mean"] + 0.2
    assert after["r.te_max"] > before["r.te_max"] + 2.0


@pytest.mark.parametrize(
    ("relief", "words"),
    [
        ({"amount": "6 um"}, "rack.r.tip_relief.height = (not given): must be specified, or length"),
        ({"amount": "6 um", "height": "1 mm", "length": "1 mm"}, "not both"),
        ({"amount": "6 um", "height": "5 mm"}, "rack.r.tip_relief.height = 5 mm: must be between"),
        ({"amount": "6 mm", "height": "1 mm"}, "rack.r.tip_relief.amount"),
        ({"amount": "6 um", "height": "1 mm", "shape": "round"}, "rack.r.tip_relief.shape"),
    ],
)
def test_reliefs_that_do_not_fit_a_rack_are_refused(relief, words):
    given = case(tip_relief=relief) | {"effects": {"relief": True}}
    with pytest.raises(InputError) as refused:
        rack_inputs(build_scene(given), "r")
    assert words in str(refused.value)


@pytest.mark.parametrize(
    "more", [{"amount_over_delta": 1.0, "length": "1 mm"}, {"amount": "6 um", "normalised_length": 1.0}]
)
def test_reliefs_of_pairs_only_are_refused_for_the_pinion_of_a_rack(more):
    given = case() | {"effects": {"relief": True}}
    given["gear"]["p"]["relief"] = {"tip": more}
    with pytest.raises(InputError, match=r"gear\.p\.relief\..*requires a pair of gears"):
        rack_inputs(build_scene(given), "r")


def _outline(path):
    """Points of all entities of a drawing, and their number."""
    import ezdxf
    from ezdxf.path import make_path

    entities = list(ezdxf.readfile(path).modelspace())
    return [np.array([(v.x, v.y) for v in make_path(one).flattening(1e-4)]).T for one in entities]


@pytest.mark.parametrize("shape", [None, "linear", "parabolic"])
def test_drawings_of_a_rack_are_its_outline_with_its_relief(tmp_path, shape):
    """Closed, of the area of its outline, the relieved flank at the removal's distance."""
    relief = {} if shape is None else {"tip_relief": {"amount": "50 um", "height": "1 mm", "shape": shape}}
    scene = build_scene(case(tip_radius_rounding="0.2 mm", **relief))
    written = export_gears(scene, tmp_path, ("r",), "dxf").files
    assert written == ("r_rack_polyline.dxf", "r_rack_spline.dxf")
    (closed,), pieces = _outline(tmp_path / written[0]), _outline(tmp_path / written[1])
    ends = np.array([[one[:, 0], one[:, -1]] for one in pieces]).reshape(-1, 2)
    assert all(np.sort(np.hypot(*(ends - end).T))[1] < 1e-6 for end in ends)  # each end meets another
    area = 0.5 * float(np.sum(closed[0] * np.roll(closed[1], -1) - np.roll(closed[0], -1) * closed[1]))
    rack = rack_inputs(scene, "r").pair.rack
    x, y = rack_outline(rack) * 1e3
    generated = 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    wide = {None: 0.0, "linear": 1 / 2, "parabolic": 1 / 3}[shape]
    rounding = 0.2 * (1.0 - math.sin(rack.pressure_angle))  # moved inwards as it is
    ground = 0.0 if shape is None else 2 * rack.teeth * 0.05 / math.cos(rack.pressure_angle) * (wide + rounding)
    assert generated - area == pytest.approx(ground, rel=0.05, abs=1e-3)


def test_a_rack_in_a_script_answers_as_its_case(results):
    pinion = fegear.Gear(20, "2 mm", profile_shift=0.3, face_width="20 mm", name="p")
    rack = fegear.Rack(pinion, 6, "10 mm", name="r", positions=8)
    found = rack.transmission_error(force="2 kN", tolerance=0.05)
    assert found.values["r.te_mean"].value == {value.name: value.value for value in results.values}["r.te_mean"]
    assert rack == fegear.Rack(pinion, 6, "10 mm", name="r", positions=8) != fegear.Rack(pinion, 7, "10 mm", name="r")
    assert eval(repr(rack), {"Rack": fegear.Rack, "Gear": fegear.Gear}) == rack  # noqa: S307  (what it says of itself)
    with pytest.raises(InputError, match=r"rack\.r\.force = \(not given\)"):
        rack.transmission_error()
    with pytest.raises(InputError, match=r"must be a fegear\.Gear"):
        fegear.Rack("p", 6, "10 mm")
    with pytest.raises(InputError, match=r"rack\.r\.tip_relief\.amount"):
        fegear.Rack(pinion, 6, "10 mm", name="r", tip_relief={"amount": "3 mm", "length": "1 mm"})


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


def test_a_pitch_is_looked_at_where_a_relief_begins_and_where_pairs_come_and_go():
    """Breaks on other base pitches count where they lie within this one."""
    pair = SimpleNamespace(rack=SimpleNamespace(base_pitch=2.0), x_start=1.0, x_end=4.2)
    flanks = SimpleNamespace(breaks=lambda of: np.array([1.5, 3.7, 5.9, 1.0]) if of is pair else None)
    found = positions(SimpleNamespace(pair=pair), 4, flanks)
    assert (np.diff(found) > 0.0).all()
    ends = [1.0, 3.0, 2.2, 2.2]  # both ends of the pitch, and beside where the first pair leaves
    assert found == pytest.approx(sorted([1.25, 1.75, 2.25, 2.75, 1.5, 1.7, 1.9, *ends]), abs=1e-5)


def test_base_pitches_of_a_rack_are_alike_where_all_teeth_that_count_are():
    """Those in contact and one beside at either end; beyond the rack there is none."""
    rack = SimpleNamespace(reach=1, exists=lambda t: 0 <= t < 5, solved=SimpleNamespace(alike=[7, 8, 8, 8, 9]))
    found = SimpleNamespace(numbers=np.array([-1, 0, 1]))
    stand = {tooth: list(_standing(SimpleNamespace(driven=rack), found, tooth)) for tooth in (-1, 2, 4)}
    assert stand == {-1: [-1, -1, -1, 7, 8], 2: [7, 8, 8, 8, 9], 4: [8, 8, 9, -1, -1]}


HELICAL = {"helix_angle": "20 deg", "hand": "left", "module": None, "normal_module": "2 mm"}


def helical_case(results=("rack-geometry",), **more):
    """The case with a helical pinion."""
    given = case(results, **more)
    gear = given["gear"]["p"] | HELICAL
    given["gear"]["p"] = {key: value for key, value in gear.items() if value is not None}
    return given


def test_a_helical_rack_has_the_other_hand_and_the_transverse_section_of_its_pinion():
    found = rack_inputs(build_scene(helical_case(backlash="40 um")), "r")
    pair, beta = found.pair, math.radians(20.0)
    assert found.wide
    assert pair.rack.hand == "right"
    assert pair.rack.slide == pytest.approx(-math.tan(beta))
    assert pair.rack.pitch == pytest.approx(math.pi * 2e-3 / math.cos(beta))
    assert math.tan(pair.rack.pressure_angle) == pytest.approx(math.tan(math.radians(20.0)) / math.cos(beta))
    assert pair.backlash == pytest.approx(40e-6)
    assert pair.rack.base_pitch == pytest.approx(pair.pinion.base_pitch)
    assert pair.overlap_ratio == pytest.approx(20e-3 * math.sin(beta) / (math.pi * 2e-3))
    assert pair.travel_per_turn == pytest.approx(20 * pair.rack.pitch)


def test_positions_and_width_of_racks_by_their_kind():
    assert rack_inputs(build_scene(case(positions=None)), "r").positions == 32
    assert rack_inputs(build_scene(case(positions=None, width="solid")), "r").positions == 24
    assert not rack_inputs(build_scene(case(width="plane")), "r").wide
    with pytest.raises(InputError, match="spur racks only"):
        rack_inputs(build_scene(helical_case(width="plane")), "r")


def test_a_rack_of_another_helix_or_hand_is_refused():
    pair = rack_inputs(build_scene(helical_case()), "r").pair
    spur = rack_inputs(build_scene(case()), "r").pair
    with pytest.raises(InputError, match="helix_angle"):
        RackAndPinion(pair.pinion, spur.rack, pair.distance)
    with pytest.raises(InputError, match="hand"):
        RackAndPinion(pair.pinion, replace(pair.rack, hand="left"), pair.distance)
    with pytest.raises(GeometryError, match="hand"):
        replace(pair.rack, hand="spur")


def test_3d_racks_want_a_face_width_that_is_solved():
    given = case(["rack-stiffness"], width="solid")
    del given["gear"]["p"]["face_width"]
    with pytest.raises(InputError, match="face_width"):
        make_plan(build_scene(given), STAGES)
    with pytest.raises(InputError, match=r"rack\.r\.face_width"):
        make_plan(build_scene(case(["rack-stiffness"], width="solid", face_width="0.1 mm")), STAGES)
    with pytest.raises(InputError, match=r"rack\.r\.reference_height"):
        make_plan(build_scene(case(["rack-stiffness"], width="solid", reference_height="200 mm")), STAGES)


def test_unequal_teeth_of_a_pinion_are_refused_not_neglected():
    given = helical_case(["rack-transmission-error"])
    given["gear"]["p"]["odd_tooth"] = [{"tooth": 1, "missing": True}]
    with pytest.raises(InputError, match=r"gear\.p\.odd_tooth.*pinion of a rack"):
        make_plan(build_scene(given), STAGES)


@pytest.mark.dear
def test_results_of_a_helical_rack():
    """A narrow rack of two teeth, coarse: tables over the face, and what the standard does not say left out."""
    asked = ["rack-transmission-error", "rack-stiffness"]
    given = helical_case(asked, teeth=2, face_width="3 mm", force="500 N", reference_height="6 mm", positions=8)
    scene = build_scene(given | {"accuracy": {"tolerance": 0.05}})
    results = run_plan(scene, make_plan(scene, STAGES))
    tables, values = {one.name: one for one in results.tables}, {one.name: one for one in results.values}
    assert "r.sigma_F0" not in values
    assert 0.0 < values["r.te_mean"].error < 1.0  # in µm
    assert values["r.te_max"].si > values["r.te_mean"].si
    lines = tables["rack_line_load_r"]
    assert {column.name for column in lines.columns} >= {"face_position", "line_load", "height", "tooth"}
    assert {"rack_stiffness_over_face_r_1", "rack_stiffness_over_face_r_2"} <= set(tables)
