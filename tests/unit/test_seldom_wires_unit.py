"""What goes where in lines that only long runs reach: places of REXS models, present designs, odd teeth in space."""

import base64
import math
import struct
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built import odd_solid_teeth
from fegear.design.flanks import flank_design
from fegear.exchange.rexs import places, reading
from fegear.exchange.rexs.written_shafts import write_shaft_results
from fegear.fem.solid.odd import odd_solid_influence
from fegear.results.gear import odd_solid_gear
from fegear.results.sizing import basis, sizing


# ---- REXS ------------------------------------------------------------------------------------------------------------
class Said:
    """What a model says, by component."""

    def __init__(self, version="1.4", across=(), **components):
        self.model = SimpleNamespace(version=version, of=lambda *kinds: [c for c in self.parts if c.type in kinds])
        self.parts, self.across = list(components.values()), across

    def vector(self, one, name):
        return one.says.get(name)

    word = yes = vector

    def number(self, one, _kind, name):
        return one.says.get(name)

    needed = number

    def linked(self, one, _role, _kind, other, *types):
        return [c for c in one.links.get(other, ()) if not types or c.type in types]


def component(number, kind, links=None, **says):
    return SimpleNamespace(id=number, type=kind, said=f"{kind} {number}", says=says, links=links or {})


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), None])
def test_the_middle_of_a_face_is_counted_from_the_left_end_of_its_shaft_in_its_own_sense(axis):
    """A shaft from 10 mm on, whichever way it runs; the gear is 30 mm along it."""
    forward = axis is None or axis[0] > 0.0
    shaft = component(1, "shaft", support_vector=(0.010, 0.0, 0.0), u_axis_vector=axis)
    gear = component(2, "gear", support_vector=(0.040 if forward else -0.020, 0.0, 0.0))
    assert places.middle_on_shaft(Said(), gear, shaft) == pytest.approx(0.030)


def test_a_coordinate_on_the_shaft_is_the_middle_of_the_face_but_in_files_of_version_1():
    shaft = component(1, "shaft", support_vector=(0.010, 0.0, 0.0), reference_component_for_position="casing")
    gear = component(2, "gear", support_vector=(0.040, 0.0, 0.0), u_coordinate_on_shaft=0.025, face_width=0.020)
    assert places.middle_on_shaft(Said(), gear, shaft) == 0.025  # vectors of two origins
    assert places.middle_on_shaft(Said(version="1.0"), gear, shaft) == pytest.approx(0.035)
    bare = component(3, "gear")
    assert places.middle_on_shaft(Said(), bare, shaft) is None


@pytest.mark.parametrize(("engaged", "joined"), [(None, True), (True, True), (False, False)])
def test_shafts_turn_together_through_engaged_couplings_and_stand_with_the_casing(engaged, joined):
    shafts = [component(n, "shaft") for n in (1, 2, 3, 4)]
    casing = component(9, "gear_casing")
    coupling = component(5, "coupling", {"inner_part": [shafts[0]], "outer_part": [shafts[2]]}, is_engaged=engaged)
    brake = component(6, "switchable_coupling", {"inner_part": [shafts[3]], "outer_part": [casing]}, is_engaged=engaged)
    said = Said(**{f"c{n}": one for n, one in enumerate([*shafts, casing, coupling, brake])})
    bodies, held = places.bodies_of(said)
    assert (bodies[1] == bodies[3]) is joined
    assert len({bodies[1], bodies[2], bodies[4]}) == 3
    assert held == ({bodies[4]} if joined else set())
    together, _ = places.bodies_of(said, [(shafts[1], shafts[3])])
    assert together[2] == together[4] != together[1]


@pytest.mark.parametrize(("engaged", "other", "found"), [
    (None, True, (0.1,)), (True, True, (0.1,)), (False, True, ()), (None, False, ()),
])  # fmt: skip
@pytest.mark.parametrize("side", ["inner", "outer"])
def test_torque_enters_through_engaged_couplings_between_two_shafts(engaged, other, found, side):
    far = "outer" if side == "inner" else "inner"
    joint = component(
        5, "coupling", {f"{far}_part": [component(2, "shaft")] if other else []}, is_engaged=engaged,
        **{f"u_coordinate_on_shaft_{side}_side": 0.1, f"u_coordinate_on_shaft_{far}_side": 0.7},
    )  # fmt: skip
    shaft = component(1, "shaft")

    class Sided(Said):
        def linked(self, one, role, kind, name, *types):
            if one is shaft:
                return [joint] if role == f"{side}_part" and "coupling" in types else []
            return super().linked(one, role, kind, name, *types)

    assert places.joints_of(Sided(), shaft) == found


class Part:
    def __init__(self, name):
        self.name, self.told = name, {}

    def say(self, _kind, **values):
        self.told |= values
        return self


def test_forces_of_a_run_are_written_to_the_bearing_of_their_shaft():
    shafts = {name: Part(name) for name in ("one", "two")}
    seats = {(shaft, bearing): Part(bearing) for shaft in shafts for bearing in ("A", "B")}
    relations = [
        ("side", None, (("assembly", seat), ("inner_part", shafts[shaft]), ("outer_part", Part("casing"))))
        for (shaft, _), seat in seats.items()
    ]
    relations += [("assembly", None, (("assembly", shafts["one"]), ("part", Part("A")))), ("side", None, (("x", 1),))]
    forces = {
        "shaft": ["one", "two", "two", "gone"], "bearing": ["A", "B", "A", "A"], "force_axial": [1.0, 2.0, 3.0, 9.0],
        "force_x": [10.0, 20.0, 30.0, 90.0], "force_y": [100.0, 200.0, 300.0, 900.0],
    }  # fmt: skip
    line = {"z": [0.0, 0.1], "along": [1.0, 2.0], "x": [3.0, 4.0], "y": [5.0, 6.0], "twist": [7.0, 8.0]}
    written = SimpleNamespace(relations=relations)
    write_shaft_results(written, shafts, {"bearing_forces": forces, "shaft_deflection_two": line})
    told = {key: tuple(seat.told.values()) for key, seat in seats.items()}
    assert told == {
        ("one", "A"): (1.0, 10.0, 100.0), ("one", "B"): (), ("two", "A"): (3.0, 30.0, 300.0),
        ("two", "B"): (2.0, 20.0, 200.0),
    }  # fmt: skip
    assert list(seats["two", "A"].told) == [f"force_acting_on_inner_component_{one}" for one in "uvw"]
    assert shafts["one"].told == {}
    names = ["displacement_u_of_nodes", "displacement_v_of_nodes", "displacement_w_of_nodes", "torsion_u"]
    assert [shafts["two"].told[name] for name in names] == [line[name] for name in ("along", "x", "y", "twist")]
    for seat in seats.values():
        seat.told.clear()
    without = {name: column for name, column in forces.items() if name != "force_y"}
    write_shaft_results(written, shafts, {"bearing_forces": without})
    assert not any(seat.told for seat in seats.values())


# ---- sizing ----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("beta", [0.0, 0.25])
@pytest.mark.parametrize("shorten", [True, False])
def test_a_present_design_has_its_own_tip_circles_or_those_of_the_variants(monkeypatch, beta, shorten):
    """Of both gears, with shifts and tips that differ; otherwise tips are shortened by what the shifts are more."""
    monkeypatch.setattr(basis, "space_of", lambda _part: SimpleNamespace(fixed=False, distances=None))
    part = SimpleNamespace(shorten_tips=shorten, root_clearance=0.25, rack_tip_radius=0.38)
    present = SimpleNamespace(
        teeth=(20, 61), normal_module=2e-3, helix_angle=beta, pressure_angle=math.radians(20.0), addendum=1.1,
        profile_shift=(0.4, 0.1), face_width=20e-3, tip_diameter=(47e-3, 129e-3),
    )  # fmt: skip
    made = basis.present_pair(part, present)
    np.testing.assert_allclose(made.tip_diameters[:, 0], [47e-3, 129e-3], rtol=1e-12)
    present.tip_diameter = None
    usual = basis.present_pair(part, present)
    root = usual.diameters - 2.0 * 2e-3 * (1.1 + 0.25 - usual.profile_shift)
    np.testing.assert_allclose(usual.root_diameters, root)
    low = usual.diameters + 2.0 * 2e-3 * (1.1 + usual.profile_shift)
    # by Y = (a - a_d) / m - sum x both tips are drawn back, so that the clearance is that of the rack
    off = float(usual.centre_distance[0] - usual.diameters.sum() / 2.0) / 2e-3 - 0.5 if shorten else 0.0
    np.testing.assert_allclose(usual.tip_diameters, low + 2.0 * 2e-3 * off, rtol=1e-12)
    if shorten:
        np.testing.assert_allclose(usual.tip_clearances, 0.25, rtol=1e-9)


@pytest.mark.parametrize("atlas", [None, "atlas"])
def test_a_present_design_has_what_an_atlas_says_of_it_among_its_costs(monkeypatch, atlas):
    from dataclasses import make_dataclass

    sized = make_dataclass("Sized", ["pairs", "estimate", "relief", "costs"], frozen=True)
    monkeypatch.setattr(sizing, "present_pair", lambda part, present: (part, present))
    monkeypatch.setattr(sizing, "_sized", lambda _asked, number, pairs: sized((number, *pairs), None, None, ()))
    monkeypatch.setattr(sizing, "of_one", lambda pairs, atlas, *, relieved: ((pairs, atlas), relieved))
    monkeypatch.setattr(sizing, "_costs", lambda _asked, one: (one.estimate, one.relief))
    part = SimpleNamespace(present="design")
    found = sizing._present(SimpleNamespace(part=part, atlas=atlas, relieved=7))
    assert found.pairs == (None, part, "design")
    pairs = (part, "design")
    wanted = (None, None, ()) if atlas is None else ((pairs, "atlas"), 7, ((pairs, "atlas"), 7))
    assert (found.estimate, found.relief, found.costs) == wanted


# ---- odd teeth in space, tolerances of flanks ------------------------------------------------------------------------
def test_a_gear_with_odd_teeth_is_solved_in_its_modules(monkeypatch):
    gear = SimpleNamespace(
        symmetric_tooth="tooth", tooth="other", flank_twist=50.0, module=2e-3, face_width=12e-3, teeth=24,
        material=SimpleNamespace(poisson_ratio=0.3), bore_radius=7e-3, body_in_modules="body",
    )  # fmt: skip
    solid = SimpleNamespace(gear=gear, name="a", settings="settings", reach=2)
    teeth = SimpleNamespace(name="a", in_solid=lambda count: ("teeth", count))
    given = []
    monkeypatch.setattr(
        odd_solid_influence, "odd_solid_influence", lambda *one, **more: given.append((one, more)) or "solved"
    )
    monkeypatch.setattr(odd_solid_teeth, "keys_of_the_case", lambda _name: nullcontext())
    monkeypatch.setattr(odd_solid_teeth, "solid_gear_to_solve", lambda scene, name: solid if scene else name)
    monkeypatch.setattr(odd_solid_teeth, "odd_teeth_of", lambda scene, name: teeth if scene else name)
    asked = odd_solid_teeth.odd_solid_to_solve("scene", "a")
    assert asked.name == "a"
    assert odd_solid_gear._compute(asked, {}, SimpleNamespace(cache="cache")) == "solved"
    ((tooth, twist, width, poisson, bore, settings, odd), more) = given[0]
    assert (tooth, settings, odd) == ("tooth", "settings", ("teeth", 24))
    assert (twist, width, poisson, bore) == pytest.approx((0.1, 6.0, 0.3, 3.5))
    assert more == {"reach": 2, "body": "body", "cache": "cache"}


def test_odd_teeth_in_space_are_checked_with_the_gear(monkeypatch):
    done = []
    monkeypatch.setattr(odd_solid_gear, "check_solid_gear", lambda *asked: done.append(("gear", *asked)))
    monkeypatch.setattr(odd_solid_gear, "check_odd_solid_gear", lambda *asked: done.append(("teeth", *asked)))
    odd_solid_gear._check("scene", "a")
    assert done == [("gear", "scene", "a"), ("teeth", "scene", "a")]


@pytest.mark.parametrize("lacks", ["tolerance", "found", "relief", "most", None])
def test_which_tolerance_decides_is_asked_of_what_is_to_be_ground(monkeypatch, lacks):
    monkeypatch.setattr(flank_design, "decisive_tolerances", lambda *asked: asked)
    monkeypatch.setattr(flank_design, "classes_finer", lambda most, none, _finer, finest: (most, none, finest))
    tolerance = SimpleNamespace(finest=3)
    best = SimpleNamespace(
        relief=None if lacks == "relief" else SimpleNamespace(numbers="numbers"),
        over_most=None if lacks == "most" else np.array([3.0, 3.0]),
    )  # fmt: skip
    design = SimpleNamespace(
        task=SimpleNamespace(tolerance=None if lacks == "tolerance" else tolerance),
        found={} if lacks == "found" else {"profile": best}, best=best,
        unrelieved=SimpleNamespace(over_peak_to_peak=np.full(2, 2.0)), unrelieved_most=np.array([3.0, 6.0]),
    )  # fmt: skip
    over = SimpleNamespace(searched="searched", judge=SimpleNamespace(dense=None))
    decisive, finer = flank_design._decisive(over, "pair", design), flank_design._classes_finer(over, "pair", design)
    if lacks:
        assert (decisive, finer) == ((), 0)
    else:
        assert decisive[:4] == ("searched", "pair", "numbers", tolerance)
        assert decisive[4] == pytest.approx([3.0, 3.0])
        assert [finer[0], finer[1]] == [pytest.approx([1.0, 0.5]), pytest.approx([1.0, 1.0])]  # of no relief at most
        assert finer[2] == 3


@pytest.mark.parametrize(
    ("code", "kind", "numbers"),
    [
        ("float64", "d", (1.5, -2.25, 1e300)),
        ("float32", "f", (1.5, -2.25)),
        ("int32", "i", (7, -8, 9, 10)),
        ("float64", "d", ()),
    ],
)
def test_packed_numbers_of_a_model_are_read_and_matrices_left_out(code, kind, numbers):
    """REXS 1.6: little-endian numbers in base64."""

    def read(**value):
        return reading._attribute({"id": "x", "unit": "mm", "value": value}, 3, Path("m.rexs")).value

    packed = base64.b64encode(struct.pack(f"<{len(numbers)}{kind}", *numbers)).decode()
    assert read(code=code, value=packed) == numbers
    assert read(code=code, value=packed, rows=2) == "(matrix)"
    assert read(code="complex128", value=packed) == "(matrix)"
    assert read(code=code, value=[packed]) == "(matrix)"
    for damaged in (packed + "?", base64.b64encode(b"123").decode()):
        with pytest.raises(InputError, match="damaged data for x of component 3"):
            read(code=code, value=damaged)


def test_rows_of_a_matrix_are_not_read_and_numbers_are():
    def read(value):
        return reading._attribute({"id": "x", "values": value}, 3, Path("m.rexs"))

    assert read([1.0, 2, "a", [3.0]]).value == (1.0, 2, "a", "(row)")
    assert (read(4.5).value, read("a").value, read(None).value) == (4.5, "a", "")
    assert read(1).unit == ""


@pytest.mark.parametrize(("given", "number"), [(5, 5), (5.0, 5), ("5", 5), (" 5 ", 5)])
def test_numbers_of_components_are_whole_however_they_are_written(given, number):
    assert reading._number({"id": given}, "id", Path("m.rexs")) == number


@pytest.mark.parametrize("given", [5.5, True, None, "x", math.inf, [5]])
def test_what_is_no_whole_number_is_refused(given):
    with pytest.raises(InputError, match="has a component, relation or load case"):
        reading._number({"id": given}, "id", Path("m.rexs"))
