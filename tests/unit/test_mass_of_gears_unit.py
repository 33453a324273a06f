"""Mass and inertia of gears in results: `geometry` prints them, sets and trains say which they use."""

from pathlib import Path

import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

SIZE = {"module": "45 mm", "rack": "ISO 53 A", "face_width": "491 mm"}
SUN = {"teeth": 19, "profile_shift": 0.617, "tip_diameter": "978.808 mm", "bore_radius": "241.17 mm", **SIZE}
PLANET = {"teeth": 17, "profile_shift": 0.8021, "tip_diameter": "905.470 mm", "bore_radius": "204.5 mm", **SIZE}
SET = {
    "sun": "sun", "planet": "planet", "ring_teeth": 56, "planets": 3, "fixed": "ring", "input": "carrier",
    "torque": "3946 kN*m", "speed": "12.1 rpm", "centre_distance": "863 mm",
    "stiffness": {"sun_mesh": "6000 N/um", "ring_mesh": "6500 N/um", "pin": "5000 N/um", "carrier": "5000 N/um"},
}  # fmt: skip
CARRIER = {"mass": "20000 kg", "inertia": "20000 kg*m^2"}


def run(results, gears=None, **more):
    case = {"results": results, "gear": gears or {"sun": SUN, "planet": PLANET}, **more}
    scene = build_scene(case, "case", Path())
    return run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())


def of_set(**body):
    found = run(["planet-modes"], planetary={"P": {**SET, "body": {"carrier": CARRIER, **body}}})
    return {value.name: value for value in found.values}


def test_a_set_takes_the_inertia_of_its_teeth_or_the_given_one_and_says_so():
    own, given = of_set(), of_set(planet={"mass": "1531.0053989 kg", "inertia": "165.459102262 kg*m^2"})
    assert own["P.planet.inertia"].si == pytest.approx(165.4591, rel=1e-6)
    assert own["P.sun.inertia"].si == pytest.approx(229.6569, rel=1e-6)
    assert own["P.planet.inertia"].meaning.endswith("from teeth and body of gear planet")
    assert own["P.carrier.mass"].si == 20000.0
    assert own["P.carrier.mass"].meaning.endswith("from body.carrier")
    assert given["P.planet.mass"].meaning.endswith("from body.planet")
    frequencies = [name for name in own if "natural_frequency" in name]
    assert frequencies
    for name in frequencies:
        assert given[name].si == pytest.approx(own[name].si, rel=1e-8)


def test_heavier_planets_lower_the_frequencies_by_what_discs_of_the_reference_circle_hid():
    disc = of_set(planet={"mass": "1286 kg", "inertia": "118.7 kg*m^2"})
    own = of_set()
    falls = [disc[name].si / own[name].si - 1.0 for name in own if "natural_frequency" in name]
    assert min(falls) > -1e-9
    assert 0.02 < max(falls) < 0.2


def test_a_train_states_the_inertia_of_each_body_and_its_sources():
    found = run(
        ["gear-train"], pair={"I": {
            "driver": "planet", "driven": "sun", "torque": "1000 N*m", "compliance": {"source": "weber-banaschek"},
        }},
        train={
            "torque": {"in": "1000 N*m"}, "balance": "out",
            "body": {"in": {"gears": ["planet"]}, "out": {"gears": ["sun"], "inertia": "10 kg*m^2"}},
            "mesh": {"I": {"driver": "in", "driven": "out", "stiffness": "6000 N/um"}},
        },
    )  # fmt: skip
    values = {value.name: value for value in found.values}
    assert values["in.inertia"].si == pytest.approx(165.4591, rel=1e-6)
    assert values["out.inertia"].si == pytest.approx(239.6569, rel=1e-6)
    assert values["out.inertia"].meaning == "moment of inertia of body out: gear sun + inertia"


def test_geometry_prints_mass_and_says_what_it_took_for_granted():
    ring = {"internal": True, "teeth": 60, "module": "3 mm", "cutter": {"teeth": 20}, "tip_diameter": "175.5 mm"}
    gears = {"given": PLANET, "bored": {"teeth": 20, "module": "2 mm"}, "ring": {**ring, "face_width": "20 mm"}}
    found = run(["geometry"], gears)
    (table,) = (one for one in found.tables if one.name == "mass_and_inertia")
    assert table.printed
    assert table["mass"][0] == pytest.approx(1531.0054, rel=1e-7)
    assert table["inertia"][0] == pytest.approx(165.4591, rel=1e-6)
    assert (table["centre_of_gravity"] == 0.0).all()
    said = [one for one in found.remarks if ": mass and inertia computed with the default" in one]
    assert len(said) == 2
    assert "bore_radius = 8.75 mm and face_width = 1 mm" in said[0]
    assert "outer_radius = " in said[1]
