"""Gears, pairs and the everyday questions: the numbers are those of the case file that says the same."""

from __future__ import annotations

import inspect

import numpy as np
import pint
import pytest

import fegear
from fegear.base.errors import FegearError, InputError
from fegear.case.gear import GearPart
from fegear.case.pair import PairPart
from fegear.contact.load import load

PINION = {"teeth": 23, "module": "3 mm", "profile_shift": 0.3, "bore_radius": "15 mm", "face_width": "10 mm"}
WHEEL = {"teeth": 57, "module": "3 mm", "profile_shift": -0.1, "bore_radius": "40 mm", "face_width": "10 mm"}
#: What the questions switch on for closed-form compliances.
EFFECTS = {"hertz": "load-dependent", "corner_contact": True}
CASE = {
    "gear": {"pinion": PINION, "wheel": WHEEL},
    "pair": {"I": {"driver": "pinion", "driven": "wheel", "compliance": {"source": "weber-banaschek"}}},
    "effects": EFFECTS,
}


@pytest.fixture(scope="module")
def pair():
    return fegear.Pair(
        fegear.Gear(**PINION, name="pinion"), fegear.Gear(**WHEEL, name="wheel"), compliance="weber-banaschek"
    )


@pytest.fixture(scope="module")
def design(pair):
    return fegear.relief(pair, torque="90 N*m", design={"grind": ["linear"]})


def same(found, case, changes, results):
    """Every value and table of a question are those of the case."""
    other = fegear.run(case, changes, results=results)
    assert found.values.keys() == other.values.keys()
    for one, two in zip(found.values, other.values, strict=True):
        assert (one.unit, one.si_error) == (two.unit, two.si_error)
        assert one.si == pytest.approx(two.si, rel=1e-12, abs=0.0)
    for one, two in zip(found.tables, other.tables, strict=True):
        for a, b in zip(one.columns, two.columns, strict=True):
            assert a.head == b.head
            if a.si.dtype.kind == "f":
                assert a.si == pytest.approx(b.si, rel=1e-9, abs=1e-18, nan_ok=True)
    assert [
        remark for remark in found.remarks if not remark.startswith("Train not specified: gears with their own")
    ] == list(other.remarks)


def test_a_gear_is_the_one_of_the_case(pair):
    assert pair.driver.geometry == fegear.run(CASE, results=["geometry"]).scene.gears["pinion"]
    assert pair.geometry.contact_ratio == fegear.run(CASE, results=["geometry"]).scene.pairs["I"].contact_ratio
    same(pair.data, CASE, {"effects": {}}, ["geometry"])


@pytest.mark.parametrize("module", ["3 mm", 3e-3, np.float64(3e-3), pint.UnitRegistry().Quantity(3, "mm")])
def test_quantities_are_texts_pint_or_si(module, pair):
    gear = fegear.Gear(**{**PINION, "module": module}, name="pinion")
    assert gear.geometry.module == pytest.approx(3e-3, rel=1e-15)
    assert gear.geometry.pitch_radius == pytest.approx(pair.driver.geometry.pitch_radius, rel=1e-15)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: fegear.Gear(23, "3 mm", profil_shift=0.1), 'did you mean "profile_shift"'),
        (lambda: fegear.Gear(23), 'set module = "3.175 mm" or diametral_pitch = "8 / inch"'),
        (lambda: fegear.Gear(23, "3"), r'module = "3":'),
        (lambda: fegear.Gear(23, "3 kg"), "length"),
        (lambda: fegear.Gear(23, pint.UnitRegistry().Quantity(3, "kg")), "is not a length"),
        (lambda: fegear.Gear(23, True), "module"),
        (lambda: fegear.Gear("23", "3 mm"), "must be a whole number"),
        (lambda: fegear.Gear(23, "3 mm", pressure_angle=20.0), "must be between 5 and 45 deg"),
        (lambda: fegear.Pair(fegear.Gear(23, "3 mm"), fegear.Gear(20, "4 mm")), "must be equal for the gears to mesh"),
        (lambda: fegear.Pair(fegear.Gear(23, "3 mm"), "wheel"), "must be a fegear.Gear"),
        (
            lambda: fegear.Pair(fegear.Gear(23, "3 mm"), fegear.Gear(30, "3 mm"), "60 mm"),
            "leaves no backlash: both flanks are in",
        ),
        (lambda: fegear.root_stress([fegear.Gear(23, "3 mm")] * 2), "is the name of several gears"),
        (lambda: fegear.root_stress([]), "must be gears"),
        (lambda: fegear.root_stress("z20"), "must be gears"),
        (lambda: fegear.transmission_error(fegear.Gear(23, "3 mm"), torque=90.0), "must be a fegear.Pair"),
        (lambda: fegear.Gear(23, 3), "a module of 3 mm is 3e-3 m in SI"),
    ],
)
def test_what_cannot_be_is_refused_where_it_is_described(make, sentence):
    with pytest.raises(InputError, match=sentence):
        make()


def test_a_load_is_needed_once(pair):
    with pytest.raises(InputError, match="is required, or load"):
        fegear.transmission_error(pair)
    with pytest.raises(InputError, match="is required, or load"):
        fegear.transmission_error(pair, torque="90 N*m", load="2 kN")
    with pytest.raises(InputError, match="is not a torque"):
        fegear.transmission_error(pair, torque="90 N")
    with pytest.raises(InputError, match='did you mean "relief"'):
        fegear.transmission_error(pair, torque="90 N*m", effects={"relif": True})
    with pytest.raises(TypeError, match="torqe"):
        fegear.transmission_error(pair, torqe="90 N*m")


def test_transmission_error_is_the_case_s(pair):
    found = fegear.transmission_error(pair, torque="90 N*m")
    same(found, CASE, {"pair.I.torque": "90 N*m"}, ["transmission-error"])


def test_several_torques_are_several_loads(pair):
    found = fegear.transmission_error(pair, torque=["50 N*m", 70.0, pint.UnitRegistry().Quantity(90, "N*m")])
    table = found.tables["transmission_error_summary_I"]
    assert table["driver_torque [N.m]"] == pytest.approx([50.0, 70.0, 90.0], rel=1e-12)
    assert np.all(np.diff(table["te_mean"]) > 0.0)
    alone = fegear.transmission_error(pair, torque="70 N*m")
    assert table["te_peak_to_peak"][1] == pytest.approx(alone.values["I.te_peak_to_peak"].value, rel=1e-9)
    assert found.values["I.te_mean"].value == pytest.approx(table["te_mean"][2], rel=1e-12)
    assert "transmission_error_summary_I" in found.figures
    loads = fegear.transmission_error(pair, load=table["total_load"])
    assert loads.tables["transmission_error_summary_I"]["te_mean"] == pytest.approx(table["te_mean"], rel=1e-9)


def test_a_question_asked_again_is_recalled(pair):
    fegear.transmission_error(pair, torque="80 N*m")
    again = fegear.transmission_error(pair, torque="80 N*m")
    assert {timing.origin for timing in again.timings.values()} == {"recalled"}


@pytest.mark.dear
def test_relief_is_the_case_s(pair, design):
    same(design, CASE, {"pair.I.torque": "90 N*m", "design": {"grind": ["linear"]}}, ["relief"])


@pytest.mark.dear
@pytest.mark.parametrize(
    ("shape", "left"),
    [("designed", "relief_tables"), ("linear", "linear_tip_relief")],
)
def test_a_designed_relief_leaves_what_the_design_says(pair, design, shape, left):
    relieved = pair.relieved(design, shape)
    found = fegear.transmission_error(relieved, torque="90 N*m").values["I.te_peak_to_peak"]
    assert found.si == pytest.approx(design.values[f"I.te_peak_to_peak.{left}"].si, rel=1e-6)
    assert len(repr(relieved)) < 1000
    with pytest.raises(InputError, match='choose from "designed", "linear"'):
        pair.relieved(design, "cubic")


def test_twins_get_reliefs_of_their_own():
    gear = fegear.Gear(28, "3 mm", face_width="10 mm")
    twins = fegear.Pair(gear, gear, compliance="weber-banaschek")
    design = fegear.relief(twins, load="2 kN", design={"grind": []})
    relieved = twins.relieved(design)
    assert relieved.names == ("driver", "driven")
    left = fegear.transmission_error(relieved, load="2 kN").values["I.te_peak_to_peak"]
    assert left.si == pytest.approx(design.values["I.te_peak_to_peak.relief_tables"].si, rel=1e-6)


def test_dynamic_factor_is_the_case_s(pair):
    speeds = ["9000 rpm"]
    found = fegear.dynamic_factor(pair, torque="90 N*m", speeds=speeds[0])
    train = {
        "body": {"driver": {"gears": ["pinion"]}, "driven": {"gears": ["wheel"]}},
        "mesh": {"I": {"driver": "driver", "driven": "driven", "damping_ratio": 0.1}},
        "torque": {"driver": "90 N*m"}, "balance": "driven",
    }  # fmt: skip
    more = {"train": train, "dynamics": {"speeds": speeds, "speed_of": "driver"}, "pair.I.torque": "90 N*m"}
    same(found, CASE, {**more, "effects": {**EFFECTS, "parametric": True, "contact_loss": True}}, ["dynamic-factor"])
    assert found.tables["dynamic_factor_I"]["speed [rpm]"] == pytest.approx([9000.0], rel=1e-12)
    assert any("Damping ratio of the mesh not specified, 0.1 assumed" in remark for remark in found.remarks)
    assert not any("speed_of" in remark for remark in found.remarks)  # those of the driver, as the function says


def test_speeds_of_another_body_and_of_a_train_of_one_s_own(pair):
    linear = {"contact_loss": False, "parametric": False}
    asked = {"torque": "90 N*m", "damping_ratio": 0.05, "effects": linear}
    driver = fegear.dynamic_factor(pair, speeds="5700 rpm", **asked)
    driven = fegear.dynamic_factor(pair, speeds="2300 rpm", dynamics={"speed_of": "driven"}, **asked)
    factors = [one.tables["dynamic_factor_I"]["dynamic_factor"][0] for one in (driver, driven)]
    assert factors[0] == pytest.approx(factors[1], rel=1e-6)
    train = {
        "body": {"motor": {"gears": ["pinion"]}, "brake": {"gears": ["wheel"]}},
        "mesh": {"I": {"driver": "motor", "driven": "brake", "damping_ratio": 0.05}},
        "torque": {"motor": "90 N*m"}, "balance": "brake",
    }  # fmt: skip
    own = fegear.dynamic_factor(pair, torque="90 N*m", speeds="5700 rpm", train=train, effects=linear)
    assert own.tables["dynamic_factor_I"]["dynamic_factor"][0] == pytest.approx(factors[0], rel=1e-9)
    assert any("speed_of not specified: speeds refer to motor" in remark for remark in own.remarks)


def test_speeds_may_be_a_range(pair):
    given = {"start": "4000 rpm", "stop": "9000 rpm", "count": 3}
    linear = {"contact_loss": False, "parametric": False}
    found = fegear.dynamic_factor(pair, torque="90 N*m", speeds=given, damping_ratio=0.05, effects=linear)
    assert not any("Damping ratio of the mesh not specified" in remark for remark in found.remarks)
    assert found.tables["dynamic_factor_I"]["speed"] == pytest.approx([4000.0, 6500.0, 9000.0], rel=1e-12)


def test_stiffness_and_root_stress_are_the_case_s():
    gear = {**PINION, "teeth": 17}
    found = fegear.root_stress(fegear.Gear(**gear, name="p"), positions=3, tolerance=1e-2)
    case = {"results": ["crosscheck"], "gear": {"p": gear}, "stiffness": {"positions": 3}}
    same(found, case, {"accuracy.tolerance": 1e-2}, ["crosscheck"])
    table = fegear.stiffness_table(fegear.Gear(**gear, name="p"), ["25 mm", 0.026], tolerance=1e-2).tables[0]
    case["stiffness"] = {"gear": "p", "radii": ["25 mm", "26 mm"]}
    other = fegear.run(case, {"accuracy.tolerance": 1e-2}, results=["stiffness"]).tables["stiffness_p"]
    assert table["c_self"] == pytest.approx(other["c_self"], rel=1e-9)


#: Gears of a helical pair, and a spur pair that is loaded with its width: what both need and what each adds.
TIP = {"tip": {"amount": "12 um", "length": "1.5 mm"}}
HELICAL = {"teeth": 20, "normal_module": "3 mm", "helix_angle": "15 deg", "face_width": "8 mm", "relief": TIP}
WIDE_PAIRS = {
    "helical": (
        {**HELICAL, "hand": "right"},
        {**HELICAL, "hand": "left", "relief": None, "lead": {"crowning": "5 um"}},
        {"line_error": {"over_face": "8 um"}},
    ),
    "spur with its width": (
        {"teeth": 20, "module": "3 mm", "face_width": "10 mm", "relief": TIP},
        {"teeth": 33, "module": "3 mm", "face_width": "10 mm"},
        {"width": "slices"},
    ),
}
DOORS = {
    "transmission-error": fegear.transmission_error,
    "load-sharing": fegear.load_sharing,
    "root-stress-history": fegear.root_stress,
}


@pytest.fixture(scope="module", params=WIDE_PAIRS)
def wide(request):
    """A pair that is loaded with its width, and the case file that says the same."""
    driver, driven, keys = WIDE_PAIRS[request.param]
    driven = {key: value for key, value in driven.items() if value is not None}
    pair = fegear.Pair(fegear.Gear(**driver, name="p"), fegear.Gear(**driven, name="w"), **keys)
    effects = {"neighbour_coupling": True, "relief": True, "misalignment": "line_error" in keys, **EFFECTS}
    case = {
        "gear": {"p": driver, "w": driven},
        "pair": {"I": {"driver": "p", "driven": "w", "load": "3 kN", **keys}},
        "effects": effects,
        "accuracy": {"tolerance": 0.1},
    }
    return pair, case


@pytest.mark.dear
@pytest.mark.parametrize("result", DOORS)
def test_every_door_takes_pairs_with_a_width_and_gives_what_the_case_file_does(wide, result):
    pair, case = wide
    assert pair.is_wide
    found = DOORS[result](pair, load="3 kN", tolerance=0.1)
    assert [step.task.stage for step in found.plan.steps][-2:] == ["loaded-flanks", result]
    same_here = fegear.run(case, {"neglected": False}, results=[result], cache=pair.known)
    assert {one.origin for one in same_here.timings.values()} == {"recalled"}  # key by key the same case
    assert [(one.name, one.si) for one in found.values] == [(one.name, one.si) for one in same_here.values]
    assert list(found.remarks) == list(same_here.remarks)


@pytest.mark.parametrize("result", DOORS)
def test_every_door_takes_plane_teeth(pair, result):
    question = {"torque": "90 N*m", "effects": {"relief": False}}
    pair = fegear.Pair(
        pair.driver, pair.driven, compliance="weber-banaschek", root_stress={"source": "iso-6336-3"}
    )  # fmt: skip
    assert not pair.is_wide
    more = {"pair.I.torque": "90 N*m", "pair.I.root_stress": {"source": "iso-6336-3"}}
    same(DOORS[result](pair, **question), CASE, more, [result])


def test_root_stress_is_of_gears_or_of_a_pair(pair):
    with pytest.raises(InputError, match=r"positions.*applies to gears only"):
        fegear.root_stress(pair, torque="90 N*m", positions=5)
    with pytest.raises(InputError, match=r"torque.*applies to pairs"):
        fegear.root_stress(pair.driver, torque="90 N*m")


def test_a_helical_pair_is_described_and_refused_where_its_description_is_not_enough():
    keys = {"normal_module": "3 mm", "helix_angle": "15 deg", "face_width": "20 mm"}
    helical = fegear.Pair(fegear.Gear(23, hand="right", **keys), fegear.Gear(57, hand="left", **keys))
    assert helical.geometry.overlap_ratio == pytest.approx(helical.flanks.overlap_ratio) != 0.0
    assert not helical.driver.is_spur
    assert helical.driver.geometry.base_helix_angle > 0.0
    assert "overlap ratio" in helical._repr_html_()
    spur = fegear.Pair(fegear.Gear(23, "3 mm"), fegear.Gear(57, "3 mm"))
    with pytest.raises(InputError, match="is required for tooth contact analysis"):
        spur.flanks  # noqa: B018


def outline(path) -> np.ndarray:
    """Corners of the drawn tooth [mm]."""
    ezdxf = pytest.importorskip("ezdxf")
    (line,) = ezdxf.readfile(path).modelspace().query("LWPOLYLINE")
    return np.array([point[:2] for point in line.get_points()])


@pytest.mark.long
def test_a_drawing_carries_the_relief_and_a_mesh_says_that_it_does_not(tmp_path, pair):
    relief = {"tip": {"amount": "200 um", "start_radius": "36 mm"}}
    relieved = fegear.Pair(pair.driver.changed(relief=relief), pair.driven, compliance="weber-banaschek")
    plain, ground = (outline(one.export(tmp_path / name)[0]) for name, one in (("a", pair), ("b", relieved)))
    tip = pair.driver.geometry.tip_radius * 1e3
    thickness = [np.ptp(corners[np.hypot(*corners.T) > tip - 1e-6, 0]) for corners in (plain, ground)]
    assert thickness[0] - thickness[1] == pytest.approx(0.4, rel=0.3)  # both flanks, .2 mm each along their normals
    with pytest.warns(UserWarning, match="without the relief of the case"):
        relieved.driver.export(tmp_path / "mesh", "inp")


def test_gears_never_change(pair):
    other = pair.driver.changed(profile_shift=0.0, bore_radius=None)
    assert "bore_radius" not in other.keys
    assert pair.driver.keys["profile_shift"] == 0.3
    assert other != pair.driver
    assert pair.driver == fegear.Gear(**PINION, name="pinion")


def test_a_notebook_shows_the_drawing_and_its_data(pair):
    for shown in (pair.driver._repr_html_(), pair._repr_html_()):
        assert shown.count("data:image/png;base64,") == 1
        assert "root_radius [mm]" in shown


def test_the_functions_say_what_they_take():
    for name in ("transmission_error", "relief", "dynamic_factor", "root_stress", "stiffness_table", "run"):
        function = getattr(fegear, name)
        text = inspect.getdoc(function)
        for parameter in inspect.signature(function).parameters:
            assert parameter in text, (name, parameter)
    assert issubclass(InputError, FegearError)


def test_a_rating_is_the_case_s():
    steel = {"material": "case-hardened-steel", "hardness": "60 HRC"}
    one, other = (
        fegear.Gear(z, "4 mm", face_width="40 mm", strength=steel, tolerance_class=6, name=f"z{z}") for z in (21, 62)
    )
    pair = fegear.Pair(one, other)
    found = fegear.rating(pair, torque="520 N*m", speed="1480 rpm", operation={"life": "20000 h"}, progress=False)
    case = {
        "title": "t", "results": ["rating"], "gear": {"z21": dict(one.keys), "z62": dict(other.keys)},
        "pair": {"I": {"driver": "z21", "driven": "z62", "torque": "520 N*m", "speed": "1480 rpm",
                       "operation": {"life": "20000 h"}}},
    }  # fmt: skip
    by_case = fegear.run(case, progress=False)
    for key in ("I.driver.S_H", "I.driven.S_F", "I.driver.S_F_agma"):
        assert found.values[key].value == by_case.values[key].value
    with pytest.raises(fegear.InputError, match=r"pair\.I\.speed"):
        fegear.rating(pair, torque="520 N*m", progress=False)
    with pytest.raises(fegear.InputError, match="is required, or load"):
        fegear.rating(pair, speed="1480 rpm")
    with pytest.raises(fegear.InputError, match=r"must be a fegear\.Pair"):
        fegear.rating(one, torque="1 N*m")


@pytest.mark.parametrize(("kind", "part"), [(fegear.Gear, GearPart), (fegear.Pair, PairPart)])
def test_signature_and_help_have_every_key_of_a_case(kind, part):
    parameters = inspect.signature(kind).parameters
    assert set(part.model_fields) <= set(parameters) - {"keys"}
    assert list(parameters)[:2] in (["teeth", "module"], ["driver", "driven"])
    for key in set(part.model_fields) - set(inspect.signature(kind.__init__).parameters):
        assert f"\n{key}\n    {part.model_fields[key].description}" in kind.__doc__


def test_every_key_of_a_pair_reaches_the_case():
    gear = fegear.Gear(20, "2 mm", bore_radius="10 mm", face_width="10 mm")
    for key in set(PairPart.model_fields) - {"driver", "driven", "centre_distance", "compliance"}:
        with pytest.raises(fegear.InputError, match=rf"pair\.I\.{key}"):
            fegear.Pair(gear, gear, **{key: "no such thing"})


def test_a_pair_has_a_spec_that_the_mechanics_loads():
    first, second = (
        fegear.Gear(20, "2 mm", bore_radius="10 mm", face_width="10 mm"),
        fegear.Gear(31, "2 mm", face_width="10 mm"),
    )
    pair = fegear.Pair(first, second, compliance="weber-banaschek")
    spec = pair.spec(torque="20 N*m")
    assert spec.pair == pair.geometry
    assert spec.nominal == pytest.approx(20.0 / pair.geometry.driver.base_radius, rel=1e-14)
    assert (spec.corner_contact, spec.hertz, spec.neighbour_coupling, spec.relief) == (
        True,
        "load-dependent",
        False,
        False,
    )
    found = load(spec).transmission_error()
    asked = fegear.transmission_error(pair, torque="20 N*m")
    assert found.te_peak_to_peak[0] == pytest.approx(asked.values["I.te_peak_to_peak"].si, rel=1e-12)
