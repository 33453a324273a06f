"""Idlers and planets with asymmetric teeth: each flank as in a pair of its own, in a mirror, and by own algebra."""

import copy
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

import fegear
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.dynamics.planetary.planet_set import PlanetarySet
from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
from fegear.dynamics.planetary.set_modes import set_modes
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

CACHE = SolutionCache()


def gear(teeth, flanks, **more):
    """A gear of 3 mm with these pressure angles and tip radii of drive and coast flank."""
    (drive, tip), (coast, beside) = flanks
    tool = "cutter" if more.get("internal") else "rack"
    more[tool] = {**more.get(tool, {}), "tip_radius": tip, "coast_tip_radius": beside}
    return {
        "teeth": teeth, "module": "3 mm", "pressure_angle": f"{drive} deg", "coast_pressure_angle": f"{coast} deg",
        "face_width": "20 mm", "thickness_allowance": "40 um", **more,
    }  # fmt: skip


STEEP, FLAT = (28, 0.15), (20, 0.25)
RESULTS = ["load-sharing", "transmission-error", "root-stress-history"]


def idler(results=RESULTS, pairs=None):
    """A pinion that drives an idler, and this a wheel."""
    gears = {
        "p": gear(19, (STEEP, FLAT), profile_shift=0.2, bore_radius="12 mm"),
        "i": gear(25, (STEEP, FLAT), bore_radius="20 mm"),
        "w": gear(31, (STEEP, FLAT), bore_radius="25 mm"),
    }
    meshes = {"I": {"driver": "p", "driven": "i", "load": "3 kN"}, "J": {"driver": "i", "driven": "w", "load": "3 kN"}}
    return {
        "results": list(results), "gear": gears, "pair": meshes if pairs is None else pairs,
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": 1e-2},
    }  # fmt: skip


def planets(
    flanks=(STEEP, FLAT), flank=None, results=("planet-load-sharing", "planet-root-stress", "planet-vibration")
):
    """Three planets, a floating sun, and a pin that is off its place."""
    gears = {
        "sun": gear(19, flanks, profile_shift=0.3, bore_radius="12 mm"),
        "planet": gear(23, flanks, profile_shift=0.3, bore_radius="16 mm"),
        "ring": gear(
            65, tuple((angle, 0.1) for angle, _ in flanks), internal=True, profile_shift=-0.9,
            cutter={"teeth": 25, "addendum": 1.25}, tip_diameter="195 mm", rim_thickness="12 mm",
        ),
    }  # fmt: skip
    carrier = {"mass": "3 kg", "inertia": "0.02 kg*m^2"}
    group = {
        "sun": "sun", "planet": "planet", "ring": "ring", "planets": 3, "fixed": "ring", "input": "sun",
        "torque": "200 N*m", "speed": "1500 rpm", "floating": ["sun"], "stiffness": {"pin": "400 N/um"},
        "body": {"carrier": carrier}, "pin_errors": {"tangential": ["20 um", "0 um", "5 um"]},
        "speeds": ["1500 rpm"], "damping_ratio": 0.03,
    }  # fmt: skip
    document = {**idler(results, {}), "gear": gears, "planetary": {"P": group}}
    if flank:
        document["pair"] = {"P_sun": {"driver": "sun", "driven": "planet", "flank": flank}}
    return document


def values(document):
    """All numbers of a run by their keys."""
    found = fegear.run(document, cache=CACHE).values
    return {key: float(one.value) for key, one in found.items() if isinstance(one.value, (int, float))}


def test_mates_load_opposite_flanks_of_an_idler():
    scene = build_scene(idler(), "case", Path())
    part = scene.case.pair
    assert (part["I"].driven, part["J"].driver, part["J"].driven) == ("i", "i-coast", "w")
    assert [scene.gears[name].tooth.flank for name in ("p", "i", "i-coast", "w")] == [
        "drive",
        "drive",
        "coast",
        "coast",
    ]
    assert scene.written == {"i-coast": "i"}
    for chosen, others in (({"J": "drive"}, {"I": "coast"}), ({"I": "coast"}, {"J": "drive"})):
        document = idler()
        for name, flank in chosen.items():
            document["pair"][name]["flank"] = flank
        pairs = build_scene(document, "case", Path()).pairs
        for name, flank in {**chosen, **others}.items():
            assert pairs[name].driver.tooth.flank == pairs[name].driven.tooth.flank == flank


def test_two_mates_that_an_idler_drives_load_one_flank():
    document = idler()
    document["gear"]["v"] = {**document["gear"]["w"], "teeth": 27}
    document["pair"]["K"] = {"driver": "i", "driven": "v", "load": "1 kN"}
    pairs = build_scene(document, "case", Path()).pairs
    assert [pairs[name].driver.tooth.flank for name in "IJK"] == ["drive", "coast", "coast"]


@pytest.mark.dear
def test_each_mesh_of_an_idler_is_the_pair_alone():
    both = values(idler())
    for name, flank in (("I", "drive"), ("J", "coast")):
        alone = values(idler(pairs={name: {**idler()["pair"][name], "flank": flank}}))
        assert len(alone) > 8
        assert {key: both[key] for key in alone} == alone


@pytest.mark.dear
def test_a_set_with_exchanged_flanks_is_the_same_set():
    one, other = values(planets()), values(planets((FLAT, STEEP), "coast"))
    assert len(one) > 15
    assert one.keys() == other.keys()
    for key, value in one.items():
        assert other[key] == pytest.approx(value, rel=1e-12, abs=1e-15), key
    assert abs(one["P.planet_sun_side.stress_ratio"] / one["P.planet_ring_side.stress_ratio"] - 1.0) > 1e-2


@pytest.mark.dear
def test_the_flanks_of_a_planet_are_those_of_pairs_of_its_own():
    """The ring's mesh of a set is the coast flank of planet and ring alone, under the torque of an equal share."""
    document = planets(results=RESULTS)
    both, pairs = values(document), build_scene(document, "case", Path()).case.pair
    alone = copy.deepcopy(document)
    del alone["planetary"], alone["gear"]["sun"]
    part = pairs["P_ring"]
    alone["pair"] = {
        "P_ring": {
            "driver": "planet", "driven": "ring", "flank": "coast", "torque": f"{part.torque!r} N*m",
            "centre_distance": f"{part.centre_distance!r} m",
        }
    }  # fmt: skip
    found = values(alone)
    assert len(found) > 6
    for key, value in found.items():
        assert both[key] == pytest.approx(value, rel=1e-12), key


def model(ring_pitch=math.nan, half=math.nan):
    """A set of planets whose flanks at sun and ring have other base circles, all on springs."""
    pitch, angles = 11.5e-3, np.array([0.0, 1.7, 4.0])
    step = 2.0 * math.pi / 84
    angles = np.rint(angles / step) * step
    found = PlanetarySet(19, 23, 65, pitch, 0.0862, angles, 0.09, 0.0, ring_pitch, half)
    return SetModel(
        found, CentralBody(1.3, 1.1e-3, 3e6, 0.0), CentralBody(5.0, 0.12, 9e7, 2e5), CentralBody(3.0, 0.02, 6e7, 0.0),
        PlanetBody(0.9, 1e-3, 4e8),
    )  # fmt: skip


def across(angle, body, point, centre):
    """Row of the way of a point of a body at `centre` in a direction: of x, y and rotation."""
    n, arm = np.array([math.cos(angle), math.sin(angle)]), np.subtract(point, centre)
    return body, np.array([n[0], n[1], n[1] * arm[0] - n[0] * arm[1]])


def absolute(found):
    """Rows of sun's and ring's meshes and of pins in x, y and angle of every body: sun, ring, carrier, planets."""
    a, z = found.centre_distance, (found.sun_teeth, found.planet_teeth, found.ring_teeth)
    rows = {"sun": [], "ring": [], "pin": []}
    for n, psi in enumerate(found.angles):
        out = np.array([math.cos(psi), math.sin(psi)])
        centre, own = a * out, 3 + n
        for mesh, at, angle in (
            ("sun", a * z[0] / (z[0] + z[1]), 0.5 * math.pi - found.sun_angle),
            ("ring", a * z[2] / (z[2] - z[1]), 0.5 * math.pi + found.ring_angle),
        ):
            row = np.zeros((3 + found.count, 3))
            for body, part in (
                across(psi + angle, 0 if mesh == "sun" else 1, at * out, (0.0, 0.0)),
                across(psi + angle, own, at * out, centre),
            ):
                row[body] += part if body < 3 else -part
            rows[mesh].append(row.ravel())
        for angle in (0.0, 0.5 * math.pi):
            row = np.zeros((3 + found.count, 3))
            row[2] += across(angle, 2, centre, (0.0, 0.0))[1]
            row[own] -= across(angle, own, centre, centre)[1]
            rows["pin"].append(row.ravel())
    return {key: np.array(one) for key, one in rows.items()}


def test_modes_of_planets_with_two_base_circles_in_absolute_coordinates():
    one = model(12.3e-3, 0.07)
    found, rows = one.found, absolute(one.found)
    stiffness = {"sun": 3.1e8, "ring": 4.7e8, "pin": one.planet.pin}
    k = sum(value * rows[key].T @ rows[key] for key, value in stiffness.items())
    mass = []
    for at, body in enumerate((one.sun, one.ring, one.carrier)):
        k[3 * at, 3 * at] += body.bearing
        k[3 * at + 1, 3 * at + 1] += body.bearing
        k[3 * at + 2, 3 * at + 2] += body.turning
        mass += [body.mass, body.mass, body.inertia]
    mass += [one.planet.mass, one.planet.mass, one.planet.inertia] * found.count
    wanted = np.sqrt(np.maximum(eigh(k, np.diag(mass), eigvals_only=True), 0.0)) / (2.0 * math.pi)
    # no member turns freely: the ring is held, and sun and carrier by the teeth
    assert set_modes(one, 3.1e8, 4.7e8).frequency[1:] == pytest.approx(wanted[1:], rel=1e-9)
    other = set_modes(model(), 3.1e8, 4.7e8).frequency[1:]
    assert np.abs(other / wanted[1:] - 1.0).max() > 1e-2


def test_outer_torques_are_in_balance_with_equal_shares():
    for one in (model(), model(12.3e-3, 0.07)):
        found, load = one.found, one.torque_load(50.0)
        at_sun = 50.0 / (found.base_radius("sun") * found.count)
        forces = np.array([at_sun, at_sun / found.ring_lever])
        turned = np.einsum("a,ani->i", forces, one.mesh_rows)[[2, 5, 11, 14, 17]]
        assert turned == pytest.approx([load[2], load[5], 0.0, 0.0, 0.0], abs=1e-9 * load[2])
        levers = [found.lever(member) for member in ("sun", "ring", "carrier")]
        assert float(load[[2, 5, 8]] @ levers) == pytest.approx(0.0, abs=1e-12 * 50.0)


def test_equal_flanks_given_twice_are_the_set_as_ever():
    usual = model()
    twice = model(usual.found.base_pitch, usual.found.planet_base_half_angle)
    assert np.array_equal(usual.mesh_rows, twice.mesh_rows)
    assert np.array_equal(usual.torque_load(50.0), twice.torque_load(50.0))
    assert np.array_equal(usual.masses, twice.masses)


@pytest.mark.dear
def test_an_idler_is_bent_as_a_planet_of_the_same_meshes():
    """The pairs of a set as pairs of no set: one idler between an external and a ring gear."""
    document = planets()
    document["planetary"]["P"] |= {"pin_errors": {}}
    of_set, pairs = values(document), build_scene(document, "case", Path()).case.pair
    alone = {**document, "results": ["idler-root-stress"]}
    del alone["planetary"]
    alone["pair"] = {
        key: {
            "driver": driver, "driven": driven, "torque": f"{pairs[f'P_{mesh}'].torque!r} N*m",
            "centre_distance": f"{pairs['P_ring'].centre_distance!r} m",
        }
        for key, mesh, driver, driven in (("S", "sun", "sun", "planet"), ("R", "ring", "planet", "ring"))
    }  # fmt: skip
    found = values(alone)
    for side, mesh in (("driven", "sun"), ("driving", "ring")):
        for quantity in ("stress_range", "stress_mean", "stress_ratio"):
            wanted = of_set[f"P.planet_{mesh}_side.{quantity}"]
            assert found[f"planet.{side}_side.{quantity}"] == pytest.approx(wanted, rel=1e-9)


@pytest.mark.dear
def test_an_idler_between_equal_mates_is_bent_alike_to_either_side():
    """By whichever mate it is driven; symmetrical teeth, whose contacts pass a mesh that drives the other way round."""
    document = idler(["idler-root-stress"])
    for one in document["gear"].values():
        del one["coast_pressure_angle"]
        one |= {"pressure_angle": "20 deg", "rack": {"tip_radius": 0.25}}
    document["gear"]["w"] = document["gear"]["p"]
    found = values(document)
    for quantity in ("stress_range", "stress_mean", "stress_ratio"):
        driven, driving = (found[f"i.{side}_side.{quantity}"] for side in ("driven", "driving"))
        assert driven == pytest.approx(driving, rel=2e-3, abs=0.1)
    assert -1.6 < found["i.driven_side.stress_ratio"] < -1.0


def test_motion_knows_no_contact_of_asymmetric_back_flanks():
    document = idler(["dynamic-factor"])
    document["effects"] |= {"contact_loss": True, "parametric": True}
    document["dynamics"] = {"speeds": ["1000 rpm"]}
    lever = 3e3 * 0.5 * 3e-3 * 19 * math.cos(math.radians(28.0))
    document["train"] = {
        "body": {name: {"gears": [name]} for name in "piw"}, "torque": {"p": f"{lever!r} N*m"}, "balance": "w",
        "mesh": {
            name: {"driver": pair["driver"], "driven": pair["driven"], "damping_ratio": 0.05}
            for name, pair in document["pair"].items()
        },
    }  # fmt: skip
    del document["pair"]["J"]["load"]
    document["pair"]["J"]["torque"] = f"{lever * 25 / 19!r} N*m"
    refused = r"train\.mesh\.I\.backlash = .*requires back_pair .*backlash = \"unlimited\""
    with pytest.raises(InputError, match=refused):
        make_plan(build_scene(document, "case", Path()), STAGES)
    for mesh in document["train"]["mesh"].values():
        mesh["backlash"] = "unlimited"
    make_plan(build_scene(document, "case", Path()), STAGES)
    # named against the power in one mesh only, the idler would be loaded on one flank twice
    document["train"]["mesh"]["J"] |= {"driver": "w", "driven": "i"}
    document["pair"]["J"] |= {"driver": "w", "driven": "i", "torque": f"{lever * 31 / 19!r} N*m"}
    with pytest.raises(InputError, match=r'train\.mesh\.J\.driver = "w": is driven where mesh I runs as named'):
        make_plan(build_scene(document, "case", Path()), STAGES)
    group = planets(results=["planet-motion"])
    group["planetary"]["P"] |= {"speeds": ["1000 rpm"], "backlash": "50 um"}
    with pytest.raises(InputError, match=r"planetary\.P\.backlash = 0\.05 mm"):
        make_plan(build_scene(group, "case", Path()), STAGES)


def test_what_is_no_idler_is_said():
    lone = idler(["idler-root-stress"], {"I": idler()["pair"]["I"]})
    with pytest.raises(InputError, match=r"add \[pair\.NAME\] in which a gear drives that is driven in another"):
        make_plan(build_scene(lone, "case", Path()), STAGES)
    wide = idler(["idler-root-stress"])
    wide["pair"]["J"]["width"] = "solid"
    with pytest.raises(InputError, match=r'pair\.J\.width = "solid"'):
        make_plan(build_scene(wide, "case", Path()), STAGES)
    formula = idler(["idler-root-stress"])
    for one in formula["gear"].values():
        del one["coast_pressure_angle"]
        one |= {"pressure_angle": "20 deg", "rack": {"tip_radius": 0.25}}
    formula["pair"]["I"]["root_stress"] = {"source": ["iso-6336-3", "fe"]}
    with pytest.raises(InputError, match=r'put "fe" first'):
        make_plan(build_scene(formula, "case", Path()), STAGES)
