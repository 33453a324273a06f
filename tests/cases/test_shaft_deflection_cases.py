"""A two-stage gearbox on its shafts: forces of the meshes balance at the bearings, tilts by cause, what is refused."""

import copy
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.pair_checks import check_wide_pair
from fegear.case.built.shafts import gearbox_of
from fegear.case.reading import build_scene
from fegear.contact.wide.on_shafts import gaps_of_even_loads
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso6336.conditions import Replacement
from fegear.results.catalogue import STAGES

CASE = tomllib.loads(Path(__file__).parents[2].joinpath("cases", "two_stage_shafts.toml").read_text(encoding="utf-8"))


def _scene(**keys):
    case = copy.deepcopy(CASE)
    for path, value in keys.items():
        table, name, key = path.split("__")
        case[table][name][key] = value
    return build_scene(case, "box", Path())


def test_shafts_without_a_pair_bend_under_their_own_loads():
    """A gearbox whose gears are in no pair ended in a traceback."""
    case = {key: value for key, value in copy.deepcopy(CASE).items() if key not in ("pair", "effects", "rating")}
    case["results"] = ["shaft-deflection"]
    case["shaft"]["in"]["loads"] = [{"at": "30 mm", "force": ["0 N", "-800 N", "0 N"]}]
    scene = build_scene({key: case[key] for key in ("results", "gear", "shaft", "bearing")}, "box", Path())
    found = run_plan(scene, make_plan(scene, STAGES))
    (forces,) = (table for table in found.tables if table.name == "bearing_forces")
    # 30 mm from the left of bearings 10 and 110 mm from there: the stiff shaft's lever, but for tilting bearings
    np.testing.assert_allclose(forces["force_y [N]"], [640.0, 160.0, 0.0, 0.0, 0.0, 0.0], atol=1.0)
    assert forces["force_y [N]"].sum() == pytest.approx(800.0, rel=1e-9)


def test_bearings_take_what_the_meshes_press():
    box = gearbox_of(_scene())
    bent = dict(zip(box.names, box.under(box.even), strict=True))
    assert all(found.balance.max() < 1e-9 for found in bent.values())
    first, second = box.meshes
    # Driver right-handed and counter-clockwise: the driven gear is pushed up, away, and toward -z by F_t tan(beta).
    radius = first.found.driver.base_radius / math.cos(first.found.working_pressure_angle)
    tangential = 100.0 / radius
    assert first.force[1] == pytest.approx(tangential, rel=1e-12)
    assert first.force[2] == pytest.approx(-100.0 * first.found.driver.twist, rel=1e-12)
    assert second.force[1] == pytest.approx(-250.0 / 0.04, rel=1e-12)
    on_input = bent["in"].bearing_forces.sum(axis=0)
    assert on_input[:3] == pytest.approx(first.force, rel=1e-9)
    on_output = bent["out"].bearing_forces.sum(axis=0)
    assert on_output[:2] == pytest.approx(-second.force[:2], rel=1e-9)


def test_meshes_share_what_rounding_leaves_of_their_torques():
    """The first end of the last mesh's face took it: a mirror moved the gap of the second pair by 2e-5."""
    bare = [{**place, "stiffens": False} for place in CASE["shaft"]["mid"]["gears"]]  # bodies spread the load
    box = gearbox_of(_scene(pair__II__torque="250.005 N*m", shaft__mid__gears=bare))
    shaft = box.loaded(box.even)[box.names.index("mid")]
    torques = np.split(shaft.loads[:, 5], 2)
    assert abs(shaft.loads[:, 5].sum()) < 1e-12 * np.abs(shaft.loads[:, 5]).sum()
    for one, mesh in zip(torques, box.meshes, strict=True):
        share = mesh.even[0] / mesh.load
        assert one / share == pytest.approx(one.sum(), rel=1e-12)  # as even over the face as the load itself
        assert abs(one.sum()) == pytest.approx(250.0 * (1.0 + 1e-5), rel=1e-9)


def test_rigid_shafts_on_rigid_bearings_leave_parallel_axes():
    case = copy.deepcopy(CASE)
    for part in case["shaft"].values():
        part["rigid"] = True
        for place in part["bearings"]:
            place["bearing"] = "rigid"
        part["bearings"][0]["bearing"] = "locating"
    case["bearing"] = {"rigid": {}, "locating": {"fixed": True}}
    box = gearbox_of(build_scene(case, "box", Path()))
    bent = box.under(box.even)
    assert all(not one.over_face.any() and not one.in_plane.any() for one, _ in box.misalignment(bent, box.even))


def test_tilt_falls_with_stiffness_in_order_one():
    tilts = []
    for stiffness in ("1e3 N/um", "1e4 N/um"):
        case = copy.deepcopy(CASE)
        for part in case["shaft"].values():
            part["rigid"] = True
            for place in part["bearings"]:
                place["bearing"] = "linear"
        case["bearing"] = {"linear": {"radial": stiffness, "axial": stiffness}}
        box = gearbox_of(build_scene(case, "box", Path()))
        tilts.append(box.misalignment(box.under(box.even), box.even)[0][0].over_face)
    assert tilts[1] == pytest.approx(tilts[0] / 10.0, rel=1e-9, abs=1e-18)


def _idler(pin_bearings, idler_bearings=()):
    """The middle shaft as a sleeve round a pin that stands in the housing."""
    case = copy.deepcopy(CASE)
    case["shaft"]["mid"] |= {"sections": [{"length": "120 mm", "outer": "40 mm", "inner": "26 mm"}]}
    case["shaft"]["mid"]["bearings"] = list(idler_bearings)
    case["shaft"]["pin"] = {
        "axis": ["108.75 mm", "0 mm"], "start": "-20 mm", "sections": [{"length": "160 mm", "outer": "18 mm"}],
        "bearings": [{"bearing": "plain", "at": "5 mm"}, {"bearing": "fixed", "at": "155 mm"}, *pin_bearings],
    }  # fmt: skip
    case["bearing"]["stout"] = {"radial": "1e9 N/um", "axial": "1e9 N/um"}
    return case


def test_an_idler_on_a_pin_brings_its_forces_to_the_housing():
    on_pin = [{"bearing": "stout", "at": f"{at} mm", "around": "mid"} for at in (30, 130)]
    box = gearbox_of(build_scene(_idler(on_pin), "box", Path()))
    bent = dict(zip(box.names, box.under(box.even), strict=True))
    assert max(one.balance.max() for one in bent.values()) < 1e-9
    # What the sleeve gets from its meshes the pin brings to the housing.
    of_meshes = bent["mid"].loaded.loads[:, :3].sum(axis=0)
    assert bent["pin"].bearing_forces[:2, :3].sum(axis=0) == pytest.approx(-of_meshes, rel=1e-9, abs=1e-6)
    # The pin sits in the stiff bearings of the sleeve: both move alike there.
    apart = bent["mid"].at([0.01, 0.11]) - bent["pin"].at([0.03, 0.13])
    assert np.abs(apart[:, :2]).max() < 1e-4 * np.abs(bent["pin"].at([0.03, 0.13])[:, :2]).max()
    every = box.by_cause(tuple(bent.values()))
    for (name, one), causes, places in zip(bent.items(), every, box.places, strict=True):
        whole, found = one.at(places), causes.sum(axis=0)
        assert found == pytest.approx(whole, rel=1e-7, abs=1e-7 * np.abs(whole).max(initial=0.0)), name


@pytest.mark.parametrize(
    ("around", "word"),
    [("md", 'did you mean "mid"'), ("out", "is 130 mm from the axis of pin"), ("pin", "not another shaft")],
)
def test_bearings_in_shafts_that_are_not_around_are_refused(around, word):
    with pytest.raises(InputError, match=word):
        gearbox_of(build_scene(_idler([{"bearing": "stout", "at": "30 mm", "around": around}]), "box", Path()))


def test_a_sleeve_on_one_ball_joint_is_loose():
    on_pin = [{"bearing": "stout", "at": "30 mm", "around": "mid"}]
    with pytest.raises(InputError, match=r"shaft\.mid\.bearings.*do not support the shaft in tilt"):
        gearbox_of(build_scene(_idler(on_pin), "box", Path()))


@pytest.mark.parametrize(
    ("keys", "word"),
    [
        ({"shaft__out__axis": ["230 mm", "0 mm"]}, "centre distance of pair II"),
        ({"shaft__out__bearings": [{"bearing": "plain", "at": "10 mm"}]}, "do not support the shaft"),
        ({"shaft__out__bearings": []}, "do not support the shaft"),
        ({"shaft__out__bearings": [{"bearing": "fixed", "at": "130 mm"}]}, "is outside the shaft, 0 to"),
        ({"shaft__out__bearings": [{"bearing": "bal", "at": "10 mm"}]}, 'did you mean "ball"'),
        ({"shaft__out__sections": []}, "must not be empty"),
        ({"shaft__out__gears": [{"gear": "a", "at": "80 mm"}]}, "is already mounted on shaft in"),
        ({"pair__II__torque": "200 N*m"}, "is an unbalanced torque about the shaft axis"),
    ],
)
def test_bad_gearboxes_are_refused_in_one_sentence(keys, word):
    with pytest.raises(InputError, match=word) as error:
        gearbox_of(_scene(**keys))
    assert "\n" not in str(error.value)


def test_axes_to_a_hundredth_of_a_millimetre_are_taken_and_a_refusal_names_the_place_that_fits():
    """130 mm at 40 degrees below the horizontal: 99.586, -83.562 mm beyond the middle shaft."""
    gearbox_of(_scene(shaft__out__axis=["208.34 mm", "-83.56 mm"]))  # 130.002 mm
    with pytest.raises(InputError) as error:
        gearbox_of(_scene(shaft__out__axis=["208.3 mm", "-83.5 mm"]))
    fitting = re.search(r'axis = \["([-.\d]+) mm", "([-.\d]+) mm"\]', str(error.value))
    assert fitting
    x, y = (float(one) for one in fitting.groups())
    assert math.hypot(x - 108.75, y) == pytest.approx(130.0, abs=1e-4)
    assert y / (x - 108.75) == pytest.approx(-83.5 / (208.3 - 108.75), rel=1e-5)
    gearbox_of(_scene(shaft__out__axis=[f"{x} mm", f"{y} mm"]))


def test_gears_that_stand_askew_on_their_shafts_are_refused_where_flanks_are_loaded():
    case = copy.deepcopy(CASE)
    case["effects"] = {"misalignment": True}
    case["shaft"]["mid"]["gears"][0]["at"] = "43 mm"
    with pytest.raises(InputError, match=r"pair.I.axial_offset.*offset by 3 mm.*set axial_offset = \"3 mm\""):
        check_wide_pair(build_scene(case, "box", Path()), "I")
    case["pair"]["I"]["axial_offset"] = "3 mm"
    check_wide_pair(build_scene(case, "box", Path()), "I")


def test_method_c_takes_the_misalignment_of_computed_shafts():
    """f_sh is the straight part of what the shafts open under an even load, in proportion to F_m/b."""
    from fegear.case.built.rated_pair import pair_to_rate
    from fegear.formulas.iso6336.safety import rate_pair

    case = copy.deepcopy(CASE)
    for gear in case["gear"].values():
        gear["strength"] = {"material": "case-hardened-steel"}
    case["pair"]["II"] |= {"speed": "600 rpm", "operation": {"application_factor": 1.25, "life": "1000 h"}}
    scene = build_scene(case, "box", Path())
    rating = rate_pair(pair_to_rate(scene, "II").conditions, Replacement())
    box = gearbox_of(scene)
    shares, _ = box.misalignment(box.under(box.even), box.even)[1]
    more = 1.25 * rating["K_v"].value
    assert rating["f_sh"].value == pytest.approx(more * abs(shares.over_face[0]), rel=1e-9)
    case["pair"]["II"]["shafts"] = {"deformation": "5 um"}
    assert rate_pair(pair_to_rate(build_scene(case, "box", Path()), "II").conditions, Replacement())[
        "f_sh"
    ].value == pytest.approx(5e-6)


def _many_shafts(case):
    for n in range(1_000):
        case["shaft"][f"s{n}"] = {"sections": [{"length": "1 m", "outer": "20 mm"}], "bearings": []}


def _loop(case):
    case["shaft"]["in"]["gears"].append({"gear": "d", "at": "80 mm"})
    case["shaft"]["out"]["gears"] = []


def _wide_clearance(case):
    case["bearing"]["loose"] = {"radial": "100 N/um", "radial_clearance": "5 mm"}
    case["shaft"]["in"]["bearings"] = [{"bearing": "fixed", "at": "10 mm"}, {"bearing": "loose", "at": "110 mm"}]


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (_many_shafts, r"shaft = 1,003 in all: exceeds the number that can be solved together; specify at most 100"),
        (_loop, "shaft = in, mid: form a closed loop of drives; choose one shaft as the input"),
        (lambda case: case["shaft"]["in"].pop("sections"), r"shaft.in.sections = \(not given\): is required"),
        (
            lambda case: case["shaft"]["in"].update(sections=[{"length": "1 um", "outer": "30 mm"}] * 10_000),
            "requests 10,000 sections, above the limit; reduce to at most 1,000",
        ),
        (
            lambda case: [place.update(bearing="plain") for place in case["shaft"]["in"]["bearings"]],
            "shaft.in.bearings.*do not support the shaft axially; specify a bearing",
        ),
        (_wide_clearance, r"shaft.in = tilt of 2.3.* deg at its gears: is not small; must stay within 0.5 deg"),
    ],
)
def test_bad_models_are_refused_in_one_sentence(change, word):
    case = copy.deepcopy(CASE)
    change(case)
    with pytest.raises(InputError, match=word) as error:
        gaps_of_even_loads(gearbox_of(build_scene(case, "box", Path())), "I")
    assert "\n" not in str(error.value)


def test_a_shaft_without_a_mesh_and_one_of_a_thousand_loads_are_solved():
    case = copy.deepcopy(CASE)
    case["shaft"]["idle"] = {
        "sections": [{"length": "100 mm", "outer": "20 mm"}],
        "bearings": [{"bearing": "fixed", "at": "0 mm"}, {"bearing": "plain", "at": "100 mm"}],
    }
    whole = gaps_of_even_loads(gearbox_of(build_scene(case, "box", Path())), "I")
    assert whole.gap == pytest.approx(gaps_of_even_loads(gearbox_of(_scene()), "I").gap, rel=1e-9, abs=1e-18)
    one, many = copy.deepcopy(CASE), copy.deepcopy(CASE)
    one["shaft"]["in"]["loads"] = [{"at": "60 mm", "force": ["0 N", "1000 N", "0 N"]}]
    many["shaft"]["in"]["loads"] = [{"at": "60 mm", "force": ["0 N", "1 N", "0 N"]}] * 1000
    gaps = [gaps_of_even_loads(gearbox_of(build_scene(case, "box", Path())), "I").gap for case in (one, many)]
    assert gaps[1] == pytest.approx(gaps[0], rel=1e-9, abs=1e-18)


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_planet_and_its_ring_stand_on_shafts(clockwise):
    """Both turn the same way, the ring's shaft carries what the planet's does, and couplings take both torques."""
    case = tomllib.loads(Path(__file__).parents[2].joinpath("cases", "planet_and_ring.toml").read_text("utf-8"))
    case["results"] = ["misalignment"]
    held = [{"bearing": "fixed", "at": "0 mm"}, {"bearing": "plain", "at": "100 mm"}]
    distance = build_scene(case, "ring", Path()).pairs["I"].centre_distance
    case["bearing"] = {"plain": {"radial": "200 N/um"}, "fixed": {"radial": "200 N/um", "fixed": True}}
    case["shaft"] = {
        name: {
            "axis": ["0 mm", f"{y * 1e3!r} mm"], "sections": [{"length": "100 mm", "outer": "40 mm"}],
            "gears": [{"gear": name, "at": "60 mm"}], "bearings": held, "coupling": "0 mm",
        }
        for name, y in (("planet", distance), ("ring", 0.0))
    }  # fmt: skip
    case["shaft"]["planet"]["clockwise"] = clockwise
    box = gearbox_of(build_scene(case, "ring", Path()))
    planet, ring = box.under(box.even)
    force = planet.bearing_forces[:, :3].sum(axis=0)
    assert force == pytest.approx(-ring.bearing_forces[:, :3].sum(axis=0), rel=1e-9, abs=1e-9)
    assert all(one.balance.max() < 1e-9 for one in (planet, ring))
    pair = box.meshes[0].found
    torques = [one.loaded.loads[-1, 5] for one in (planet, ring)]
    assert torques[1] / torques[0] == pytest.approx(-pair.driven.teeth / pair.driver.teeth, rel=1e-9)
    assert torques[0] * (-1.0 if clockwise else 1.0) == pytest.approx(500.0)  # the coupling drives the planet
    assert np.isfinite(box.misalignment((planet, ring), box.even)[0][0].over_face).all()
